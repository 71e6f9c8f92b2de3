#include "operator/operator.h"

typedef struct arguments {
    double lo, hi;
    const char* hinges;
} arguments;

static void defaults(void* given)
{
    arguments* a = given;
    *a = (arguments){.lo = 1, .hi = 1.9, .hinges = "all"};
}

static const ax_field fields[] = {
    AX_NUMBER(arguments, lo, "Lower end", "", 1, 2, .doc = "Smaller scale factors become this."),
    AX_NUMBER(arguments, hi, "Upper end", "", 1, 2,
              .doc = "Larger ones become this; at 1.9 mouths are open by 3.5 degrees, room for joints and the saw."),
    AX_TEXT(arguments, hinges, "Region", .doc = "Selection it is confined to: panels all of whose hinges are chosen."),
};

static const char* check(const void* given, int* field)
{
    const arguments* a = given;
    *field = 1;
    return a->lo <= a->hi ? NULL : "\"hi\" must not be less than \"lo\".";
}

static ax_status apply(const ax_operator_context* context, const void* given, ax_error* error)
{
    const arguments* a = given;
    ax_sheet sheet;
    ax_status status = ax_sheet_take(context, a->hinges, &sheet, error);
    if (status != AX_OK)
        return status;
    for (int t = 0; t < sheet.count; ++t)
        if (sheet.chosen[t])
            sheet.scale[t] = ax_clamp(sheet.scale[t], a->lo, a->hi);
    ax_sheet_give(context, &sheet);
    return AX_OK;
}

const ax_operator_type ax_operator_clamp = {
    .name = "clamp",
    .title = "Clamp",
    .doc = "Brings scale factors into a band.",
    .group = "scale",
    .fields = fields,
    .field_count = AX_COUNT(fields),
    .size = sizeof(arguments),
    .defaults = defaults,
    .check = check,
    .settles = true,
    .apply = apply,
};
