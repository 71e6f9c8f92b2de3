#include "operator/scale_field.h"

typedef struct arguments {
    double amount;
    const char* hinges;
} arguments;

static void defaults(void* given)
{
    arguments* a = given;
    a->hinges = "all";
}

static const ax_field fields[] = {
    AX_NUMBER(arguments, amount, "Amount", "length", 0, 1e9, .open = true, .required = true,
              .doc = "How far it reaches on the sheet: the standard deviation of the blur."),
    AX_TEXT(arguments, hinges, "Region", .doc = "Selection it is confined to: panels all of whose hinges are chosen."),
};

static ax_status apply(const ax_operator_context* context, const void* given, ax_error* error)
{
    const arguments* a = given;
    ax_sheet sheet;
    ax_status status = ax_sheet_take(context, a->hinges, &sheet, error);
    if (status != AX_OK)
        return status;
    for (int t = 0; t < sheet.count; ++t)
        sheet.scale[t] = log(sheet.scale[t]);
    ax_field_smooth(sheet.linkage, sheet.spacing, sheet.chosen, a->amount, sheet.scale);
    for (int t = 0; t < sheet.count; ++t)
        sheet.scale[t] = exp(sheet.scale[t]);
    ax_sheet_give(context, &sheet);
    return AX_OK;
}

const ax_operator_type ax_operator_smooth = {
    .name = "smooth",
    .title = "Smooth",
    .doc = "Evens scale factors out by a flow of heat on ln lambda, like a blur; the result does not depend on the "
           "number of panels.",
    .group = "scale",
    .fields = fields,
    .field_count = AX_COUNT(fields),
    .size = sizeof(arguments),
    .defaults = defaults,
    .settles = true,
    .apply = apply,
};
