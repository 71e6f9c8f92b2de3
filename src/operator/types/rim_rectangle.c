#include "operator/rim.h"

typedef struct arguments {
    const char* hinges;
    double width, height, turn, centre[3], fillet;
} arguments;

static void defaults(void* given)
{
    arguments* a = given;
    *a = (arguments){.hinges = "rim"};
}

static const ax_field fields[] = {
    AX_RIM_HINGES(arguments),
    AX_NUMBER(arguments, width, "Width", "length", 0, 1e9, .open = true, .required = true,
              .doc = "Along x, if not turned."),
    AX_NUMBER(arguments, height, "Height", "length", 0, 1e9, .open = true, .required = true, .doc = "Along y."),
    AX_NUMBER(arguments, turn, "Turn", "deg", -360, 360, .doc = "About the vertical through the centre."),
    AX_VECTOR(arguments, centre, "Centre", "length", 3, .doc = "Of the rectangle."),
    AX_RIM_FILLET(arguments),
};

static ax_status apply(const ax_operator_context* context, const void* given, ax_error* error)
{
    const arguments* a = given;
    double c = cos(a->turn * AX_PI / 180), s = sin(a->turn * AX_PI / 180), points[4][3];
    for (int k = 0; k < 4; ++k) {
        double x = (k == 1 || k == 2 ? 0.5 : -0.5) * a->width, y = (k >= 2 ? 0.5 : -0.5) * a->height;
        points[k][0] = a->centre[0] + c * x - s * y;
        points[k][1] = a->centre[1] + s * x + c * y;
        points[k][2] = a->centre[2];
    }
    const ax_curve_shape curve = {.kind = AX_CURVE_POLYLINE,
                                  .closed = true,
                                  .fillet = a->fillet,
                                  .count = 4,
                                  .points = (const double(*)[3])points};
    return ax_rim_slide(context, a->hinges, &curve, error);
}

const ax_operator_type ax_operator_rim_rectangle = {
    .name = "rim_rectangle",
    .title = "Rim on a rectangle",
    .doc = "Lets hinges of the rim slide on a level rectangle, in their order.",
    .group = "boundary",
    .fields = fields,
    .field_count = AX_COUNT(fields),
    .size = sizeof(arguments),
    .defaults = defaults,
    .settles = true,
    .apply = apply,
};
