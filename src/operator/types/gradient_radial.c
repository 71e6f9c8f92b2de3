#include "operator/brush.h"

typedef struct arguments {
    double centre[2], radius, inner, outer;
    int falloff;
    const char* hinges;
} arguments;

static void defaults(void* given)
{
    arguments* a = given;
    *a = (arguments){.centre = {NAN, NAN}, .hinges = "all"};
}

static const ax_field fields[] = {
    AX_NUMBER(arguments, radius, "Radius", "length", 0, 1e9, .open = true, .required = true,
              .doc = "Distance on the sheet at which the outer value is reached."),
    AX_NUMBER(arguments, inner, "Inner value", "", 1, 2, .required = true, .doc = "Scale factor at the centre."),
    AX_NUMBER(arguments, outer, "Outer value", "", 1, 2, .required = true,
              .doc = "Scale factor at the radius and beyond."),
    AX_VECTOR(arguments, centre, "Centre", "length", 2, .fallback = "the middle of the sheet",
              .doc = "Point of the sheet it goes out from."),
    AX_CHOICE(arguments, falloff, "Falloff", ax_falloff_names,
              .doc = "How it changes in between: sphere gives constant curvature, flat is a disc with a sharp edge."),
    AX_TEXT(arguments, hinges, "Region", .doc = "Selection it is confined to: panels all of whose hinges are chosen."),
};

static ax_status apply(const ax_operator_context* context, const void* given, ax_error* error)
{
    const arguments* a = given;
    ax_sheet sheet;
    ax_status status = ax_sheet_take(context, a->hinges, &sheet, error);
    if (status != AX_OK)
        return status;
    const double* centre = isnan(a->centre[0]) ? sheet.middle : a->centre;
    for (int t = 0; t < sheet.count; ++t) {
        double x = ax_distance2(sheet.centre[t], centre) / a->radius;
        double share = ax_falloff_share((ax_falloff)a->falloff, x, a->outer, a->inner);
        if (sheet.chosen[t])
            sheet.scale[t] = a->outer * exp(share * log(a->inner / a->outer));
    }
    ax_sheet_give(context, &sheet);
    return AX_OK;
}

const ax_operator_type ax_operator_gradient_radial = {
    .name = "gradient_radial",
    .title = "Radial gradient",
    .doc = "Scale factors by the distance from a point: one value at the point, another from the radius on.",
    .group = "scale",
    .fields = fields,
    .field_count = AX_COUNT(fields),
    .size = sizeof(arguments),
    .defaults = defaults,
    .settles = true,
    .apply = apply,
};
