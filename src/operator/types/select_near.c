#include "operator/selection.h"

typedef struct arguments {
    const char* name;
    ax_points points;
    bool closed;
    double distance;
} arguments;

static const ax_field fields[] = {
    AX_TEXT(arguments, name, "Name", .required = true, .doc = "Name of the selection; one of this name is replaced."),
    AX_POINTS(arguments, points, "Curve", 2, 1, .hi = 10000, .required = true,
              .doc = "Points of the curve on the sheet, in order; one point is a disc."),
    AX_NUMBER(arguments, distance, "Distance", "length", 0, 1e9, .open = true, .required = true,
              .doc = "On the sheet, up to which hinges are chosen."),
    AX_FLAG(arguments, closed, "Closed", .doc = "Whether the last point is joined to the first."),
};

static const char* check(const void* given, int* field)
{
    const arguments* a = given;
    *field = 0;
    return ax_is_name(a->name) ? NULL : ax_no_name;
}

static ax_status apply(const ax_operator_context* context, const void* given, ax_error* error)
{
    const arguments* a = given;
    ax_form_view view = ax_form_look(*context->form);
    ax_hinges set = ax_hinges_make(view.linkage);
    ax_select_near(&view, a->points.count, (const double(*)[2])a->points.values, a->closed, a->distance, &set);
    ax_status status = AX_OK;
    if (set.count)
        ax_form_name_selection(*context->form, a->name, set.count, set.hinges);
    else
        status = ax_fail(error, AX_BAD_INPUT, "No hinge lies within %.4g of the curve.", a->distance);
    ax_hinges_free(&set);
    return status;
}

const ax_operator_type ax_operator_select_near = {
    .name = "select_near",
    .title = "Select near a curve",
    .doc =
        "Gives a name to the hinges within a distance of a curve drawn on the sheet, in as many rows as lie within it; "
        "for one row whatever the number of panels, select curve((x,y),(x,y)).",
    .group = "selection",
    .fields = fields,
    .field_count = AX_COUNT(fields),
    .size = sizeof(arguments),
    .check = check,
    .apply = apply,
};
