#include "operator/operator.h"

typedef struct arguments {
    double value;
    const char* hinges;
} arguments;

static void defaults(void* given)
{
    arguments* a = given;
    a->hinges = "all";
}

static const ax_field fields[] = {
    AX_NUMBER(arguments, value, "Value", "", 1, 2, .required = true, .doc = "Scale factor to set."),
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
        if (sheet.chosen[t])
            sheet.scale[t] = a->value;
    ax_sheet_give(context, &sheet);
    return AX_OK;
}

const ax_operator_type ax_operator_fill = {
    .name = "fill",
    .title = "Fill",
    .doc = "Sets the scale factor of all panels or of a region.",
    .group = "scale",
    .fields = fields,
    .field_count = AX_COUNT(fields),
    .size = sizeof(arguments),
    .defaults = defaults,
    .settles = true,
    .apply = apply,
};
