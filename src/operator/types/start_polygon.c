#include "operator/start.h"

typedef struct arguments {
    int sides;
    double radius, turn, centre[2];
    ax_start start;
} arguments;

enum { MOST_SIDES = 64 };

static void defaults(void* given)
{
    arguments* a = given;
    a->sides = 6;
    a->start = ax_start_default();
}

static const ax_field fields[] = {
    AX_INTEGER(arguments, sides, "Sides", 3, MOST_SIDES, .doc = "Number of sides."),
    AX_NUMBER(arguments, radius, "Radius", "length", 0, 1e9, .open = true, .required = true,
              .doc = "Distance of the corners from the centre."),
    AX_NUMBER(arguments, turn, "Turn", "deg", -360, 360, .doc = "Direction of the first corner against the x axis."),
    AX_VECTOR(arguments, centre, "Centre", "length", 2, .doc = "Centre of the sheet."),
    AX_START_FIELDS(arguments),
    AX_START_FILLET(arguments),
};

static ax_status apply(const ax_operator_context* context, const void* given, ax_error* error)
{
    const arguments* a = given;
    double outline[MOST_SIDES][2];
    for (int k = 0; k < a->sides; ++k) {
        double angle = a->turn * AX_PI / 180 + 2 * AX_PI * k / a->sides;
        outline[k][0] = a->centre[0] + a->radius * cos(angle);
        outline[k][1] = a->centre[1] + a->radius * sin(angle);
    }
    return ax_start_form(context, &a->start, a->sides, (const double(*)[2])outline, error);
}

const ax_operator_type ax_operator_start_polygon = {
    .name = "start_polygon",
    .title = "Start from a regular polygon",
    .doc = "A uniform linkage over a regular polygon.",
    .group = "start",
    .fields = fields,
    .field_count = AX_COUNT(fields),
    .size = sizeof(arguments),
    .defaults = defaults,
    .starts = true,
    .apply = apply,
};
