#include "operator/operator.h"

typedef struct arguments {
    double from[2], to[2], from_value, to_value;
    const char* hinges;
} arguments;

static void defaults(void* given)
{
    arguments* a = given;
    a->hinges = "all";
}

static const ax_field fields[] = {
    AX_VECTOR(arguments, from, "From", "length", 2, .required = true, .doc = "Point of the sheet where it begins."),
    AX_VECTOR(arguments, to, "To", "length", 2, .required = true, .doc = "Point of the sheet where it ends."),
    AX_NUMBER(arguments, from_value, "Value at its begin", "", 1, 2, .required = true,
              .doc = "Scale factor up to the first point."),
    AX_NUMBER(arguments, to_value, "Value at its end", "", 1, 2, .required = true,
              .doc = "Scale factor from the second point on."),
    AX_TEXT(arguments, hinges, "Region", .doc = "Selection it is confined to: panels all of whose hinges are chosen."),
};

static const char* check(const void* given, int* field)
{
    const arguments* a = given;
    *field = 1;
    return ax_distance2(a->from, a->to) > 0 ? NULL : "\"from\" and \"to\" must be two different points.";
}

static ax_status apply(const ax_operator_context* context, const void* given, ax_error* error)
{
    const arguments* a = given;
    ax_sheet sheet;
    ax_status status = ax_sheet_take(context, a->hinges, &sheet, error);
    if (status != AX_OK)
        return status;
    double d[2] = {a->to[0] - a->from[0], a->to[1] - a->from[1]}, length2 = d[0] * d[0] + d[1] * d[1];
    for (int t = 0; t < sheet.count; ++t) {
        const double* x = sheet.centre[t];
        double s = ax_clamp(((x[0] - a->from[0]) * d[0] + (x[1] - a->from[1]) * d[1]) / length2, 0, 1);
        if (sheet.chosen[t])
            sheet.scale[t] = a->from_value * exp(s * log(a->to_value / a->from_value));
    }
    ax_sheet_give(context, &sheet);
    return AX_OK;
}

const ax_operator_type ax_operator_gradient_linear = {
    .name = "gradient_linear",
    .title = "Linear gradient",
    .doc = "Scale factors between two points: beyond each they are constant, between them ln lambda changes evenly, so "
           "that all curvature lies at the two ends.",
    .group = "scale",
    .fields = fields,
    .field_count = AX_COUNT(fields),
    .size = sizeof(arguments),
    .defaults = defaults,
    .check = check,
    .settles = true,
    .apply = apply,
};
