#include "operator/rim.h"

typedef ax_control arguments;

static void defaults(void* given)
{
    ax_control* a = given;
    a->hinges = "rim";
}

static const ax_field fields[] = {
    AX_CONTROL_PART(arguments),
    AX_INTEGER(arguments, point, "Control point", 0, 9999, .required = true, .doc = "Its number, from 0."),
    AX_VECTOR(arguments, at, "To", "length", 3, .required = true, .doc = "Where it goes."),
};

static ax_status apply(const ax_operator_context* context, const void* given, ax_error* error)
{
    return ax_rim_control(context, given, AX_CONTROL_MOVE, error);
}

const ax_operator_type ax_operator_rim_point_move = {
    .name = "rim_point_move",
    .title = "Move a control point",
    .doc = "Moves a control point of the spline or polyline that a part of the rim slides on.",
    .group = "boundary",
    .fields = fields,
    .field_count = AX_COUNT(fields),
    .size = sizeof(arguments),
    .defaults = defaults,
    .settles = true,
    .apply = apply,
};
