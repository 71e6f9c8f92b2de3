#include "operator/dynamics.h"

typedef struct arguments {
    ax_motion motion;
    int steps;
} arguments;

static void defaults(void* given)
{
    arguments* a = given;
    a->motion = ax_motion_default();
}

static const ax_field fields[] = {
    AX_MOTION_ADAPT(arguments),
    AX_MOTION_GIVE(arguments),
    AX_STEPS(arguments),
};

static ax_status apply(const ax_operator_context* context, const void* given, ax_error* error)
{
    (void)error;
    const arguments* a = given;
    const ax_load none = {.kind = AX_LOAD_NONE};
    ax_motion_set(context, AX_DYNAMICS_EXPAND, &none, &a->motion);
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
