#include "operator/dynamics.h"

typedef struct arguments {
    double direction[3], density;
    ax_motion motion;
    int steps;
} arguments;

static void defaults(void* given)
{
    arguments* a = given;
    a->motion = ax_motion_default();
    a->direction[2] = -1;
    a->density = ax_design_options_default().load.density;
}

static const ax_field fields[] = {
    AX_VECTOR(arguments, direction, "Direction", "", 3, .doc = "In which it pulls, of any length."),
    AX_NUMBER(arguments, density, "Weight of panels", "kg/m2", 0, 1e6, .open = true,
              .doc = "Mass of a panel by area; for forces only, the shape does not depend on it."),
    AX_MOTION_ADAPT(arguments),
    AX_MOTION_GIVE(arguments),
    AX_MOTION_ADOPT(arguments),
    AX_STEPS(arguments),
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
    double length = ax_norm3(a->direction);
    ax_load load = {.kind = AX_LOAD_GRAVITY, .density = a->density};
    for (int d = 0; d < 3; ++d)
        load.direction[d] = a->direction[d] / length;
    ax_motion_set(context, AX_DYNAMICS_GRAVITY, &load, &a->motion);
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
