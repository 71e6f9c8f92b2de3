#include "operator/hold.h"

typedef struct arguments {
    ax_holding hold;
    double point[3], normal[3];
} arguments;

static void defaults(void* given)
{
    arguments* a = given;
    a->hold.weight = 1;
}

static const ax_field fields[] = {
    AX_HOLD_NAME(arguments),
    AX_HOLD_HINGES(arguments, .required = true),
    AX_VECTOR(arguments, point, "Point", "length", 3, .doc = "A point of the plane."),
    AX_VECTOR(arguments, normal, "Normal", "", 3, .required = true, .doc = "Of the plane, of any length."),
    AX_HOLD_WEIGHT(arguments),
    AX_HOLD_SUPPORT(arguments),
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
    ax_form_constraint constraint = {.kind = AX_HELD_PLANE_GIVEN};
    memcpy(constraint.point, a->point, sizeof a->point);
    memcpy(constraint.direction, a->normal, sizeof a->normal);
    return ax_hold_put(context, &a->hold, 1, &constraint, error);
}

const ax_operator_type ax_operator_hold_plane_given = {
    .name = "hold_plane_given",
    .title = "Hold in a given plane",
    .doc = "Holds hinges in a plane that is given.",
    .group = "constraint",
    .fields = fields,
    .field_count = AX_COUNT(fields),
    .size = sizeof(arguments),
    .defaults = defaults,
    .check = check,
    .settles = true,
    .apply = apply,
};
