#include "operator/rim.h"

typedef ax_control arguments;

static void defaults(void* given)
{
    ax_control* a = given;
    a->hinges = "rim";
}

static const ax_field fields[] = {
    AX_CONTROL_PART(arguments),
    AX_INTEGER(arguments, point, "Before", 0, 9999, .required = true,
               .doc = "Number of the point before which it comes; their count to put it at the end."),
    AX_VECTOR(arguments, at, "At", "length", 3, .required = true, .doc = "Where it is."),
};

static ax_status apply(const ax_operator_context* context, const void* given, ax_error* error)
{
    return ax_rim_control(context, given, AX_CONTROL_ADD, error);
}

const ax_operator_type ax_operator_rim_point_add = {
    .name = "rim_point_add",
    .title = "Add a control point",
    .doc = "Adds a control point to the spline or polyline that a part of the rim slides on.",
    .group = "boundary",
    .fields = fields,
    .field_count = AX_COUNT(fields),
    .size = sizeof(arguments),
    .defaults = defaults,
    .settles = true,
    .apply = apply,
};
