#include "operator/operator.h"

typedef struct arguments {
    bool adapt;
    double give;
    int steps;
} arguments;

static void defaults(void* given)
{
    arguments* a = given;
    const ax_form_dynamics usual = ax_form_dynamics_default();
    a->adapt = usual.adapt;
    a->give = usual.give;
}

static const ax_field fields[] = {
    AX_FLAG(arguments, adapt, "Sizes adapt",
            .doc = "Panel sizes may give way a little, so that holes open fully within rim and constraints."),
    AX_NUMBER(arguments, give, "Give", "", 0, 100, .doc = "How easily sizes give way."),
    AX_INTEGER(arguments, steps, "Steps", 0, 100000, .doc = "Iterations; 0: until the form is at rest."),
};

static ax_status apply(const ax_operator_context* context, const void* given, ax_error* error)
{
    (void)error;
    const arguments* a = given;
    ax_form_dynamics dynamics = *ax_form_get_dynamics(*context->form);
    dynamics.kind = AX_DYNAMICS_EXPAND;
    dynamics.load = (ax_load){.kind = AX_LOAD_NONE};
    dynamics.adapt = a->adapt;
    dynamics.give = a->give;
    ax_form_set_dynamics(*context->form, &dynamics);
    return AX_OK;
}

const ax_operator_type ax_operator_expand = {
    .name = "expand",
    .title = "Expand",
    .doc = "Opens every hole as far as rim and constraints allow: with a free rim, to the natural shape.",
    .group = "dynamics",
    .fields = fields,
    .field_count = AX_COUNT(fields),
    .size = sizeof(arguments),
    .defaults = defaults,
    .settles = true,
    .apply = apply,
};
