#include "operator/operator.h"

typedef struct arguments {
    double pressure;
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
    a->pressure = ax_design_options_default().load.pressure;
}

static const ax_field fields[] = {
    AX_NUMBER(arguments, pressure, "Pressure", "Pa", 0, 1e9, .open = true,
              .doc = "For forces only, the shape does not depend on it."),
    AX_FLAG(arguments, adapt, "Sizes adapt",
            .doc = "Panel sizes may give way a little, so that holes open fully within rim and constraints."),
    AX_NUMBER(arguments, give, "Give", "", 0, 100, .doc = "How easily sizes give way."),
    AX_FLAG(arguments, adopt, "Shape is the design",
            .doc = "Finishing takes the loaded shape as the designed one, instead of the fully open one beside it."),
    AX_INTEGER(arguments, steps, "Steps", 0, 100000, .doc = "Iterations; 0: until the form is at rest."),
};

static ax_status apply(const ax_operator_context* context, const void* given, ax_error* error)
{
    (void)error;
    const arguments* a = given;
    ax_form_dynamics dynamics = *ax_form_get_dynamics(*context->form);
    dynamics.kind = AX_DYNAMICS_INFLATION;
    dynamics.load = (ax_load){.kind = AX_LOAD_INFLATION, .pressure = a->pressure};
    dynamics.adapt = a->adapt;
    dynamics.adopt = a->adopt;
    dynamics.give = a->give;
    ax_form_set_dynamics(*context->form, &dynamics);
    return AX_OK;
}

const ax_operator_type ax_operator_inflation = {
    .name = "inflation",
    .title = "Inflation",
    .doc = "Inflates the form with a pressure from below.",
    .group = "dynamics",
    .fields = fields,
    .field_count = AX_COUNT(fields),
    .size = sizeof(arguments),
    .defaults = defaults,
    .settles = true,
    .apply = apply,
};
