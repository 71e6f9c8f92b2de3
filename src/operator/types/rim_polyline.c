#include "operator/rim.h"

static const ax_field fields[] = {
    AX_RIM_HINGES(ax_rim_through),
    AX_POINTS(ax_rim_through, points, "Corners", 3, 2, .hi = 10000, .required = true,
              .doc = "Corners of the curve in space, in order, the way the rim runs: counter-clockwise."),
    AX_RIM_CLOSED,
    AX_RIM_FILLET(ax_rim_through),
};

static ax_status apply(const ax_operator_context* context, const void* given, ax_error* error)
{
    return ax_rim_slide_through(context, given, AX_CURVE_POLYLINE, error);
}

const ax_operator_type ax_operator_rim_polyline = {
    .name = "rim_polyline",
    .title = "Rim on a polyline",
    .doc = "Lets hinges of the rim slide on a polyline, in their order.",
    .group = "boundary",
    .fields = fields,
    .field_count = AX_COUNT(fields),
    .size = sizeof(ax_rim_through),
    .defaults = ax_rim_through_defaults,
    .check = ax_rim_through_check,
    .settles = true,
    .apply = apply,
};
