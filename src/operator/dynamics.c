#include "operator/dynamics.h"

ax_motion ax_motion_default(void)
{
    const ax_form_dynamics usual = ax_form_dynamics_default();
    return (ax_motion){.adapt = usual.adapt, .give = usual.give};
}

void ax_motion_set(const ax_operator_context* context, ax_dynamics_kind kind, const ax_load* load,
                   const ax_motion* motion)
{
    ax_form_dynamics dynamics = *ax_form_get_dynamics(*context->form);
    dynamics.kind = kind;
    dynamics.load = *load;
    dynamics.adapt = motion->adapt;
    dynamics.adopt = motion->adopt;
    dynamics.give = motion->give;
    ax_form_set_dynamics(*context->form, &dynamics);
}
