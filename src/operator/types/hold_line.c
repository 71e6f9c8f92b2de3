#include "operator/hold.h"

static ax_status apply(const ax_operator_context* context, const void* given, ax_error* error)
{
    ax_form_constraint constraint = {.kind = AX_HELD_LINE};
    return ax_hold_put(context, &((const ax_hold_arguments*)given)->hold, 3, &constraint, error);
}

const ax_operator_type ax_operator_hold_line = {
    .name = "hold_line",
    .title = "Hold on a line",
    .doc = "Holds hinges on one straight line, whichever fits best.",
    .group = "constraint",
    .fields = ax_hold_fields,
    .field_count = AX_HOLD_FIELDS,
    .size = sizeof(ax_hold_arguments),
    .defaults = ax_hold_defaults,
    .settles = true,
    .apply = apply,
};
