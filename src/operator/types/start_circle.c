#include "operator/start.h"

typedef struct arguments {
    double radius, centre[2];
    ax_start start;
} arguments;

static void defaults(void* given)
{
    arguments* a = given;
    a->start = ax_start_default();
}

static const ax_field fields[] = {
    AX_NUMBER(arguments, radius, "Radius", "length", 0, 1e9, .open = true, .required = true,
              .doc = "Radius of the sheet."),
    AX_VECTOR(arguments, centre, "Centre", "length", 2, .doc = "Centre of the sheet."),
    AX_START_FIELDS(arguments),
};

enum { CORNERS = 720 }; // the circle as a polygon: off by 1e-5 of the radius

static ax_status apply(const ax_operator_context* context, const void* given, ax_error* error)
{
    const arguments* a = given;
    double outline[CORNERS][2];
    for (int k = 0; k < CORNERS; ++k) {
        outline[k][0] = a->centre[0] + a->radius * cos(2 * AX_PI * k / CORNERS);
        outline[k][1] = a->centre[1] + a->radius * sin(2 * AX_PI * k / CORNERS);
    }
    return ax_start_form(context, &a->start, CORNERS, (const double(*)[2])outline, error);
}

const ax_operator_type ax_operator_start_circle = {
    .name = "start_circle",
    .title = "Start from a circle",
    .doc = "A uniform linkage over a circular sheet.",
    .group = "start",
    .fields = fields,
    .field_count = AX_COUNT(fields),
    .size = sizeof(arguments),
    .defaults = defaults,
    .starts = true,
    .apply = apply,
};
