#include "operator/start.h"

typedef struct arguments {
    ax_points points;
    ax_start start;
} arguments;

static void defaults(void* given)
{
    arguments* a = given;
    a->start = ax_start_default();
}

static const ax_field fields[] = {
    AX_POINTS(arguments, points, "Corners", 2, 3, .hi = 100000, .required = true,
              .doc = "Corners of the sheet in order, either way round; the last is joined to the first."),
    AX_START_FIELDS(arguments),
    AX_START_FILLET(arguments),
};

static ax_status apply(const ax_operator_context* context, const void* given, ax_error* error)
{
    const arguments* a = given;
    return ax_start_form(context, &a->start, a->points.count, (const double(*)[2])a->points.values, error);
}

const ax_operator_type ax_operator_start_outline = {
    .name = "start_outline",
    .title = "Start from a free outline",
    .doc = "A uniform linkage over a polygon drawn freely.",
    .group = "start",
    .fields = fields,
    .field_count = AX_COUNT(fields),
    .size = sizeof(arguments),
    .defaults = defaults,
    .starts = true,
    .apply = apply,
};
