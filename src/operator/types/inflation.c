#include "operator/dynamics.h"

typedef struct arguments {
    double pressure;
    ax_motion motion;
    int steps;
} arguments;

static void defaults(void* given)
{
    arguments* a = given;
    a->motion = ax_motion_default();
    a->pressure = ax_design_options_default().load.pressure;
}

static const ax_field fields[] = {
    AX_NUMBER(arguments, pressure, "Pressure", "Pa", 0, 1e9, .open = true,
              .doc = "For forces only, the shape does not depend on it."),
    AX_MOTION_ADAPT(arguments),
    AX_MOTION_GIVE(arguments),
    AX_MOTION_ADOPT(arguments),
    AX_STEPS(arguments),
};

static ax_status apply(const ax_operator_context* context, const void* given, ax_error* error)
{
    (void)error;
    const arguments* a = given;
    const ax_load load = {.kind = AX_LOAD_INFLATION, .pressure = a->pressure};
    ax_motion_set(context, AX_DYNAMICS_INFLATION, &load, &a->motion);
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
