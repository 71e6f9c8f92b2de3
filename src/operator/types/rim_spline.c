#include "operator/rim.h"

static const ax_field fields[] = {
    AX_RIM_HINGES(ax_rim_through),
    AX_POINTS(ax_rim_through, points, "Control points", 3, 2, .hi = 10000, .required = true,
              .doc = "Control points of the curve in space, in order, the way the rim runs: counter-clockwise."),
    AX_RIM_CLOSED,
};

static ax_status apply(const ax_operator_context* context, const void* given, ax_error* error)
{
    return ax_rim_slide_through(context, given, AX_CURVE_SPLINE, error);
}

const ax_operator_type ax_operator_rim_spline = {
    .name = "rim_spline",
    .title = "Rim on a spline",
    .doc = "Lets hinges of the rim slide on a spline through control points, in their order.",
    .group = "boundary",
    .fields = fields,
    .field_count = AX_COUNT(fields),
    .size = sizeof(ax_rim_through),
    .defaults = ax_rim_through_defaults,
    .check = ax_rim_through_check,
    .settles = true,
    .apply = apply,
};
