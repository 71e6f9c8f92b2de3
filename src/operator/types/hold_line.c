#include "operator/hold.h"

typedef struct arguments {
    ax_holding hold;
} arguments;

static void defaults(void* given)
{
    arguments* a = given;
    a->hold.weight = 1;
}

static const ax_field fields[] = {
    AX_HOLD_NAME(arguments),
    AX_HOLD_HINGES(arguments, .required = true),
    AX_HOLD_WEIGHT(arguments),
    AX_HOLD_SUPPORT(arguments),
};

static ax_status apply(const ax_operator_context* context, const void* given, ax_error* error)
{
    const arguments* a = given;
    ax_form_constraint constraint = {.kind = AX_HELD_LINE};
    return ax_hold_put(context, &a->hold, 3, &constraint, error);
}

const ax_operator_type ax_operator_hold_line = {
    .name = "hold_line",
    .title = "Hold on a line",
    .doc = "Holds hinges on one straight line, whichever fits best.",
    .group = "constraint",
    .fields = fields,
    .field_count = AX_COUNT(fields),
    .size = sizeof(arguments),
    .defaults = defaults,
    .settles = true,
    .apply = apply,
};
