#include "operator/rim.h"

typedef struct arguments {
    const char* hinges;
    double centre[3], a[3], b[3];
} arguments;

static void defaults(void* given)
{
    arguments* a = given;
    *a = (arguments){.hinges = "rim"};
}

static const ax_field fields[] = {
    AX_RIM_HINGES(arguments),
    AX_VECTOR(arguments, a, "First half axis", "length", 3, .required = true,
              .doc = "From the centre to the ellipse: direction and length."),
    AX_VECTOR(arguments, b, "Second half axis", "length", 3, .required = true, .doc = "At a right angle to the first."),
    AX_VECTOR(arguments, centre, "Centre", "length", 3, .doc = "Of the ellipse."),
};

static const char* check(const void* given, int* field)
{
    const arguments* a = given;
    double lengths = ax_norm3(a->a) * ax_norm3(a->b);
    *field = 2;
    return lengths > 0 && fabs(ax_dot3(a->a, a->b)) <= 1e-6 * lengths ? NULL
                                                                      : "\"a\" and \"b\" must be at a right angle.";
}

static ax_status apply(const ax_operator_context* context, const void* given, ax_error* error)
{
    const arguments* a = given;
    double points[3][3];
    memcpy(points[0], a->centre, sizeof points[0]);
    memcpy(points[1], a->a, sizeof points[1]);
    memcpy(points[2], a->b, sizeof points[2]);
    const ax_curve_shape curve = {
        .kind = AX_CURVE_ELLIPSE, .closed = true, .count = 3, .points = (const double(*)[3])points};
    return ax_rim_slide(context, a->hinges, &curve, error);
}

const ax_operator_type ax_operator_rim_ellipse = {
    .name = "rim_ellipse",
    .title = "Rim on an ellipse",
    .doc = "Lets hinges of the rim slide on an ellipse, in their order.",
    .group = "boundary",
    .fields = fields,
    .field_count = AX_COUNT(fields),
    .size = sizeof(arguments),
    .defaults = defaults,
    .check = check,
    .settles = true,
    .apply = apply,
};
