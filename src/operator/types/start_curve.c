#include "input/outline.h"
#include "operator/start.h"

typedef struct arguments {
    const char *file, *curve;
    double size;
    ax_start start;
} arguments;

static void defaults(void* given)
{
    arguments* a = given;
    a->start = ax_start_default();
}

static const ax_field fields[] = {
    AX_TEXT(arguments, file, "File", .required = true, .doc = "SVG or DXF drawing that holds the outline."),
    AX_TEXT(arguments, curve, "Curve", .fallback = "the largest closed one",
            .doc = "Name of the curve: id of the SVG element or its group, layer of the DXF entity."),
    AX_NUMBER(arguments, size, "Size", "length", 0, 1e9, .open = true, .fallback = "as drawn",
              .doc = "Larger extent of the sheet, to which the curve is scaled about its centre, at the origin."),
    AX_START_FIELDS(arguments),
};

// Brings the middle of the curve's extents to the origin and the larger extent to `size`.
static void resize(ax_outline_curve* curve, double size)
{
    double lo[2] = {INFINITY, INFINITY}, hi[2] = {-INFINITY, -INFINITY};
    for (int k = 0; k < curve->count; ++k)
        for (int d = 0; d < 2; ++d) {
            lo[d] = fmin(lo[d], curve->points[k][d]);
            hi[d] = fmax(hi[d], curve->points[k][d]);
        }
    double by = size / fmax(hi[0] - lo[0], hi[1] - lo[1]);
    for (int k = 0; k < curve->count; ++k)
        for (int d = 0; d < 2; ++d)
            curve->points[k][d] = by * (curve->points[k][d] - (lo[d] + hi[d]) / 2);
}

static ax_status apply(const ax_operator_context* context, const void* given, ax_error* error)
{
    const arguments* a = given;
    ax_outline drawing;
    char* path = ax_operator_path(context, a->file);
    ax_status status = ax_outline_read(path, ax_unit_in_metres((ax_unit)a->start.unit), 0, &drawing, error);
    ax_free(path);
    if (status != AX_OK)
        return status;
    int found = ax_outline_find(&drawing, a->curve, true);
    if (found < 0)
        status = ax_fail(error, AX_BAD_INPUT, "%s has no closed curve%s%s%s.", a->file, a->curve ? " \"" : "",
                         a->curve ? a->curve : "", a->curve ? "\"" : "");
    else {
        ax_outline_curve* curve = &drawing.curves[found];
        if (a->size > 0)
            resize(curve, a->size);
        status = ax_start_form(context, &a->start, curve->count, (const double(*)[2])curve->points, error);
    }
    ax_outline_free(&drawing);
    return status;
}

const ax_operator_type ax_operator_start_curve = {
    .name = "start_curve",
    .title = "Start from a drawn curve",
    .doc = "A uniform linkage over a closed curve from an SVG or DXF file.",
    .group = "start",
    .fields = fields,
    .field_count = AX_COUNT(fields),
    .size = sizeof(arguments),
    .defaults = defaults,
    .starts = true,
    .apply = apply,
};
