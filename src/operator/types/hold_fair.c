#include "operator/hold.h"

typedef struct arguments {
    ax_holding hold;
} arguments;

static void defaults(void* given)
{
    arguments* a = given;
    a->hold.weight = 0.05;
    a->hold.hinges = "all";
}

static const ax_field fields[] = {
    AX_HOLD_NAME(arguments),
    AX_HOLD_HINGES(arguments),
    AX_HOLD_WEIGHT(arguments),
};

static ax_status apply(const ax_operator_context* context, const void* given, ax_error* error)
{
    const arguments* a = given;
    ax_form_constraint constraint = {.kind = AX_HELD_FAIR};
    return ax_hold_put(context, &a->hold, 1, &constraint, error);
}

const ax_operator_type ax_operator_hold_fair = {
    .name = "hold_fair",
    .title = "Hold fair",
    .doc = "Makes kagome lines run straight at hinges: no wrinkles, at the price of a little stiffness.",
    .group = "constraint",
    .fields = fields,
    .field_count = AX_COUNT(fields),
    .size = sizeof(arguments),
    .defaults = defaults,
    .settles = true,
    .apply = apply,
};
