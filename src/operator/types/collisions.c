#include "operator/operator.h"

typedef struct arguments {
    bool on;
    int steps;
} arguments;

static void defaults(void* given)
{
    arguments* a = given;
    a->on = true;
}

static const ax_field fields[] = {
    AX_FLAG(arguments, on, "On", .doc = "Whether the sheet may grow."),
    AX_STEPS(arguments),
};

static ax_status apply(const ax_operator_context* context, const void* given, ax_error* error)
{
    (void)error;
    const arguments* a = given;
    ax_form_dynamics dynamics = *ax_form_get_dynamics(*context->form);
    dynamics.collisions = a->on;
    ax_form_set_dynamics(*context->form, &dynamics);
    return AX_OK;
}

const ax_operator_type ax_operator_collisions = {
    .name = "collisions",
    .title = "Collisions",
    .doc = "Lets the flat sheet grow until no panels overlap, or stops doing so.",
    .group = "dynamics",
    .fields = fields,
    .field_count = AX_COUNT(fields),
    .size = sizeof(arguments),
    .defaults = defaults,
    .settles = true,
    .apply = apply,
};
