#include "operator/rim.h"

typedef struct arguments {
    const char* hinges;
    double radius, centre[3], normal[3];
} arguments;

static void defaults(void* given)
{
    arguments* a = given;
    *a = (arguments){.hinges = "rim", .normal = {0, 0, 1}};
}

static const ax_field fields[] = {
    AX_RIM_HINGES(arguments),
    AX_NUMBER(arguments, radius, "Radius", "length", 0, 1e9, .open = true, .required = true, .doc = "Of the circle."),
    AX_VECTOR(arguments, centre, "Centre", "length", 3, .doc = "Of the circle."),
    AX_VECTOR(arguments, normal, "Normal", "", 3, .doc = "Of its plane, of any length."),
};

static const char* check(const void* given, int* field)
{
    const arguments* a = given;
    *field = 3;
    return ax_norm3(a->normal) > 0 ? NULL : "\"normal\" has no direction.";
}

static ax_status apply(const ax_operator_context* context, const void* given, ax_error* error)
{
    const arguments* a = given;
    double points[3][3] = {{0}, {0}, {a->radius, 0, 0}};
    memcpy(points[0], a->centre, sizeof points[0]);
    memcpy(points[1], a->normal, sizeof points[1]);
    const ax_curve_shape curve = {
        .kind = AX_CURVE_CIRCLE, .closed = true, .count = 3, .points = (const double(*)[3])points};
    return ax_rim_slide(context, a->hinges, &curve, error);
}

const ax_operator_type ax_operator_rim_circle = {
    .name = "rim_circle",
    .title = "Rim on a circle",
    .doc = "Lets hinges of the rim slide on a circle, in their order.",
    .group = "boundary",
    .fields = fields,
    .field_count = AX_COUNT(fields),
    .size = sizeof(arguments),
    .defaults = defaults,
    .check = check,
    .settles = true,
    .apply = apply,
};
