#include "operator/start.h"

#include "constraint/place.h"

const char* const ax_unit_words[3] = {[AX_MILLIMETRE] = "mm", [AX_CENTIMETRE] = "cm", [AX_METRE] = "m"};

ax_start ax_start_default(void)
{
    return (ax_start){.triangles = 600, .scale = 1.3, .unit = AX_METRE};
}

// The outline with rounded corners, every arc of points; counted in *count, owned by the caller.
static double (*round_outline(const double (*outline)[2], double fillet, int* count))[2]
{
    enum { POINTS = 8 }; // an eighth of a right angle's half strays by a thousandth of the radius
    double(*corners)[3] = ax_calloc((size_t)*count, sizeof *corners);
    for (int k = 0; k < *count; ++k)
        memcpy(corners[k], outline[k], sizeof *outline);
    ax_curve* curve = ax_curve_rounded((const double(*)[3])corners, *count, true, fillet);
    *count = POINTS * (int)ax_curve_extent(curve).to;
    double(*rounded)[2] = ax_alloc((size_t)*count, sizeof *rounded);
    for (int k = 0; k < *count; ++k) {
        double x[3];
        ax_curve_point(curve, (double)k / POINTS, x);
        memcpy(rounded[k], x, sizeof *rounded);
    }
    ax_curve_free(curve);
    ax_free(corners);
    return rounded;
}

ax_status ax_start_form(const ax_operator_context* context, const ax_start* start, int count,
                        const double (*outline)[2], ax_error* error)
{
    double(*rounded)[2] = start->fillet > 0 ? round_outline(outline, start->fillet, &count) : NULL;
    const ax_form_start wanted = {.outline_count = count,
                                  .outline = rounded ? (const double(*)[2])rounded : outline,
                                  .triangles = start->triangles,
                                  .edge = start->edge,
                                  .scale = start->scale,
                                  .angle = start->angle * AX_PI / 180,
                                  .inside = start->inside,
                                  .unit = (ax_unit)start->unit};
    ax_form* form;
    ax_status status = ax_form_make(&wanted, &form, error);
    ax_free(rounded);
    if (status == AX_OK) {
        ax_form_free(*context->form);
        *context->form = form;
    }
    return status;
}
