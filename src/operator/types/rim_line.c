#include "operator/rim.h"

typedef struct arguments {
    const char* hinges;
    double point[3], direction[3];
} arguments;

static void defaults(void* given)
{
    arguments* a = given;
    *a = (arguments){.hinges = "rim"};
}

static const ax_field fields[] = {
    AX_RIM_HINGES(arguments),
    AX_VECTOR(arguments, point, "Point", "length", 3, .required = true, .doc = "A point of the line."),
    AX_VECTOR(arguments, direction, "Direction", "", 3, .required = true, .doc = "Of the line, of any length."),
};

static const char* check(const void* given, int* field)
{
    const arguments* a = given;
    *field = 2;
    return ax_norm3(a->direction) > 0 ? NULL : "\"direction\" has no length.";
}

static ax_status apply(const ax_operator_context* context, const void* given, ax_error* error)
{
    const arguments* a = given;
    double points[2][3];
    memcpy(points[0], a->point, sizeof points[0]);
    memcpy(points[1], a->direction, sizeof points[1]);
    const ax_curve_shape curve = {.kind = AX_CURVE_LINE, .count = 2, .points = (const double(*)[3])points};
    return ax_rim_slide(context, a->hinges, &curve, error);
}

const ax_operator_type ax_operator_rim_line = {
    .name = "rim_line",
    .title = "Rim on a line",
    .doc = "Lets hinges of the rim slide on a straight line, in their order.",
    .group = "boundary",
    .fields = fields,
    .field_count = AX_COUNT(fields),
    .size = sizeof(arguments),
    .defaults = defaults,
    .check = check,
    .settles = true,
    .apply = apply,
};
