#include "operator/rim.h"

typedef struct arguments {
    const char* hinges;
    ax_points points;
    bool closed;
} arguments;

static void defaults(void* given)
{
    arguments* a = given;
    *a = (arguments){.hinges = "rim", .closed = true};
}

static const ax_field fields[] = {
    AX_RIM_HINGES(arguments),
    AX_POINTS(arguments, points, "Corners", 3, 2, .hi = 10000, .required = true,
              .doc = "Corners of the curve in space, in order, the way the rim runs: counter-clockwise."),
    AX_FLAG(arguments, closed, "Closed", .doc = "Whether the last is joined to the first."),
};

static const char* check(const void* given, int* field)
{
    const arguments* a = given;
    *field = 1;
    return a->closed && a->points.count < 3 ? "a closed curve needs three points." : NULL;
}

static ax_status apply(const ax_operator_context* context, const void* given, ax_error* error)
{
    const arguments* a = given;
    const ax_curve_shape curve = {.kind = AX_CURVE_POLYLINE,
                                  .closed = a->closed,
                                  .count = a->points.count,
                                  .points = (const double(*)[3])a->points.values};
    return ax_rim_slide(context, a->hinges, &curve, error);
}

const ax_operator_type ax_operator_rim_polyline = {
    .name = "rim_polyline",
    .title = "Rim on a polyline",
    .doc = "Lets hinges of the rim slide on a polyline, in their order.",
    .group = "boundary",
    .fields = fields,
    .field_count = AX_COUNT(fields),
    .size = sizeof(arguments),
    .defaults = defaults,
    .check = check,
    .settles = true,
    .apply = apply,
};
