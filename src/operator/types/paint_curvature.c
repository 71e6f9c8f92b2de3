#include "operator/brush.h"
#include "operator/scale_field.h"

typedef struct arguments {
    ax_brush brush;
    double curvature;
} arguments;

static void defaults(void* given)
{
    arguments* a = given;
    a->brush = ax_brush_default();
    a->brush.falloff = AX_FALLOFF_FLAT;
}

static const ax_field fields[] = {
    AX_NUMBER(arguments, curvature, "Curvature", "1/length2", -1e9, 1e9, .required = true,
              .doc =
                  "Gaussian curvature to add along the stroke: 1 / R^2 is a sphere of radius R, negative is a saddle."),
    AX_BRUSH_FIELDS(arguments),
};

static ax_status apply(const ax_operator_context* context, const void* given, ax_error* error)
{
    const arguments* a = given;
    ax_sheet sheet;
    double* distance;
    ax_status status = ax_brush_take(context, &a->brush, &sheet, &distance, error);
    if (status != AX_OK)
        return status;
    double *u = AX_NEW(double, sheet.count), *density = distance, largest = 0, smallest = INFINITY;
    for (int t = 0; t < sheet.count; ++t) {
        density[t] = a->curvature * ax_falloff_share((ax_falloff)a->brush.falloff, distance[t], 1, 1);
        u[t] = log(sheet.scale[t]);
    }
    bool settled = ax_field_bend(sheet.linkage, sheet.spacing, density, u);
    for (int t = 0; t < sheet.count; ++t) {
        sheet.scale[t] = exp(u[t]);
        largest = fmax(largest, sheet.scale[t]);
        smallest = fmin(smallest, sheet.scale[t]);
    }
    ax_free(u);
    ax_free(distance);
    if (!context->live && (!settled || largest > 2 || smallest < 1)) {
        ax_sheet_free(&sheet);
        return ax_fail(
            error, AX_CANNOT_REALISE,
            "So much curvature asks for scale factors from %.3g to %.3g, and a sheet can have 1 to 2. Paint less "
            "curvature, a smaller radius, or fill the sheet with another scale factor first.",
            smallest, largest);
    }
    ax_sheet_give(context, &sheet);
    return AX_OK;
}

const ax_operator_type ax_operator_paint_curvature = {
    .name = "paint_curvature",
    .title = "Paint curvature",
    .doc = "Paints Gaussian curvature of the deployed surface: the scale factors that bend it so, with those at the "
           "rim kept, come from the solution of Liouville's equation on the lattice.",
    .group = "scale",
    .fields = fields,
    .field_count = AX_COUNT(fields),
    .size = sizeof(arguments),
    .defaults = defaults,
    .settles = true,
    .apply = apply,
};
