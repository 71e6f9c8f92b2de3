#include "operator/start.h"

typedef struct arguments {
    double width, height, centre[2];
    ax_start start;
} arguments;

static void defaults(void* given)
{
    arguments* a = given;
    a->start = ax_start_default();
}

static const ax_field fields[] = {
    AX_NUMBER(arguments, width, "Width", "length", 0, 1e9, .open = true, .required = true,
              .doc = "Extent of the sheet along x."),
    AX_NUMBER(arguments, height, "Height", "length", 0, 1e9, .open = true, .required = true,
              .doc = "Extent of the sheet along y."),
    AX_VECTOR(arguments, centre, "Centre", "length", 2, .doc = "Centre of the sheet."),
    AX_START_FIELDS(arguments),
    AX_START_FILLET(arguments),
};

static ax_status apply(const ax_operator_context* context, const void* given, ax_error* error)
{
    const arguments* a = given;
    double x = a->width / 2, y = a->height / 2, cx = a->centre[0], cy = a->centre[1];
    const double outline[4][2] = {{cx - x, cy - y}, {cx + x, cy - y}, {cx + x, cy + y}, {cx - x, cy + y}};
    return ax_start_form(context, &a->start, 4, outline, error);
}

const ax_operator_type ax_operator_start_rectangle = {
    .name = "start_rectangle",
    .title = "Start from a rectangle",
    .doc = "A uniform linkage over a rectangular sheet with sides along x and y.",
    .group = "start",
    .fields = fields,
    .field_count = AX_COUNT(fields),
    .size = sizeof(arguments),
    .defaults = defaults,
    .starts = true,
    .apply = apply,
};
