#include "input/formula.h"
#include "operator/operator.h"

typedef struct arguments {
    const char *formula, *hinges;
} arguments;

static void defaults(void* given)
{
    arguments* a = given;
    a->hinges = "all";
}

static const ax_field fields[] = {
    AX_TEXT(
        arguments, formula, "Formula", .required = true,
        .doc =
            "Of x and y on the sheet, r and theta (radians) about its middle, and s, the scale factor so far. Values "
            "below 1 and above 2 are cut off; a formula that gives nothing else is refused."),
    AX_TEXT(arguments, hinges, "Region", .doc = "Selection it is confined to: panels all of whose hinges are chosen."),
};

static const char* const variables[] = {"x", "y", "r", "theta", "s"};

static ax_status evaluate(const ax_formula* formula, ax_sheet* sheet, ax_error* error)
{
    double least = INFINITY, most = -INFINITY;
    for (int t = 0; t < sheet->count; ++t) {
        const double* c = sheet->centre[t];
        double x = c[0] - sheet->middle[0], y = c[1] - sheet->middle[1];
        double value =
            ax_formula_value(formula, (double[]){c[0], c[1], sqrt(x * x + y * y), atan2(y, x), sheet->scale[t]});
        if (!sheet->chosen[t])
            continue;
        if (!isfinite(value))
            return ax_fail(error, AX_BAD_INPUT, "The formula gives no number at x = %.4g, y = %.4g.", c[0], c[1]);
        least = fmin(least, value), most = fmax(most, value);
        sheet->scale[t] = ax_clamp(value, 1, 2);
    }
    if (most < 1 || least > 2)
        return ax_fail(error, AX_BAD_INPUT,
                       "The formula gives values from %.4g to %.4g here, and scale factors are 1 to 2.", least, most);
    return AX_OK;
}

static ax_status apply(const ax_operator_context* context, const void* given, ax_error* error)
{
    const arguments* a = given;
    ax_formula* formula;
    ax_sheet sheet;
    ax_status status = ax_formula_parse(a->formula, AX_COUNT(variables), variables, &formula, error);
    if (status != AX_OK)
        return status;
    status = ax_sheet_take(context, a->hinges, &sheet, error);
    if (status == AX_OK) {
        status = evaluate(formula, &sheet, error);
        if (status == AX_OK)
            ax_sheet_give(context, &sheet);
        else
            ax_sheet_free(&sheet);
    }
    ax_formula_free(formula);
    return status;
}

const ax_operator_type ax_operator_formula = {
    .name = "formula",
    .title = "Formula",
    .doc = "Scale factors by a formula of position, for example 1.3 + 0.4*exp(-(x^2+y^2)/0.5).",
    .group = "scale",
    .fields = fields,
    .field_count = AX_COUNT(fields),
    .size = sizeof(arguments),
    .defaults = defaults,
    .settles = true,
    .apply = apply,
};
