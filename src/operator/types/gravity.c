#include "operator/operator.h"

typedef struct arguments {
    double direction[3], density;
    bool adapt, adopt;
    double give;
    int steps;
} arguments;

static void defaults(void* given)
{
    arguments* a = given;
    const ax_form_dynamics usual = ax_form_dynamics_default();
    a->adapt = usual.adapt;
    a->give = usual.give;
    a->direction[2] = -1;
    a->density = ax_design_options_default().load.density;
}

static const ax_field fields[] = {
    AX_VECTOR(arguments, direction, "Direction", "", 3, .doc = "In which it pulls, of any length."),
    AX_NUMBER(arguments, density, "Weight of panels", "kg/m2", 0, 1e6, .open = true,
              .doc = "Mass of a panel by area; for forces only, the shape does not depend on it."),
    AX_FLAG(arguments, adapt, "Sizes adapt",
            .doc = "Panel sizes may give way a little, so that holes open fully within rim and constraints."),
    AX_NUMBER(arguments, give, "Give", "", 0, 100, .doc = "How easily sizes give way."),
    AX_FLAG(arguments, adopt, "Shape is the design",
            .doc = "Finishing takes the loaded shape as the designed one, instead of the fully open one beside it."),
    AX_INTEGER(arguments, steps, "Steps", 0, 100000, .doc = "Iterations; 0: until the form is at rest."),
};

static const char* check(const void* given, int* field)
{
    const arguments* a = given;
    *field = 0;
    return ax_norm3(a->direction) > 0 ? NULL : "\"direction\" has no length.";
}

static ax_status apply(const ax_operator_context* context, const void* given, ax_error* error)
{
    (void)error;
    const arguments* a = given;
    ax_form_dynamics dynamics = *ax_form_get_dynamics(*context->form);
    double length = ax_norm3(a->direction);
    dynamics.kind = AX_DYNAMICS_GRAVITY;
    dynamics.load = (ax_load){.kind = AX_LOAD_GRAVITY, .density = a->density};
    for (int d = 0; d < 3; ++d)
        dynamics.load.direction[d] = a->direction[d] / length;
    dynamics.adapt = a->adapt;
    dynamics.adopt = a->adopt;
    dynamics.give = a->give;
    ax_form_set_dynamics(*context->form, &dynamics);
    return AX_OK;
}

const ax_operator_type ax_operator_gravity = {
    .name = "gravity",
    .title = "Gravity",
    .doc = "Lets the form hang under its own weight from what holds it.",
    .group = "dynamics",
    .fields = fields,
    .field_count = AX_COUNT(fields),
    .size = sizeof(arguments),
    .defaults = defaults,
    .check = check,
    .settles = true,
    .apply = apply,
};
