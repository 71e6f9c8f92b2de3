#include "operator/hold.h"

static ax_status apply(const ax_operator_context* context, const void* given, ax_error* error)
{
    ax_form_constraint constraint = {.kind = AX_HELD_PLANE};
    return ax_hold_put(context, &((const ax_hold_arguments*)given)->hold, 4, &constraint, error);
}

const ax_operator_type ax_operator_hold_plane = {
    .name = "hold_plane",
    .title = "Hold in a plane",
    .doc = "Holds hinges in one plane, whichever fits best: an arch.",
    .group = "constraint",
    .fields = ax_hold_fields,
    .field_count = AX_HOLD_FIELDS,
    .size = sizeof(ax_hold_arguments),
    .defaults = ax_hold_defaults,
    .settles = true,
    .apply = apply,
};
