#include "input/table.h"
#include "operator/operator.h"

typedef struct arguments {
    const char *file, *hinges;
} arguments;

static void defaults(void* given)
{
    arguments* a = given;
    a->hinges = "all";
}

static const ax_field fields[] = {
    AX_TEXT(arguments, file, "File", .required = true,
            .doc = "CSV with a first line panel,lambda (panels by name) or x,y,lambda (samples on the sheet)."),
    AX_TEXT(arguments, hinges, "Region", .doc = "Selection it is confined to: panels all of whose hinges are chosen."),
};

static ax_status apply(const ax_operator_context* context, const void* given, ax_error* error)
{
    const arguments* a = given;
    ax_sheet sheet;
    ax_table table;
    ax_status status = ax_sheet_take(context, a->hinges, &sheet, error);
    if (status != AX_OK)
        return status;
    char* path = ax_operator_path(context, a->file);
    double* scale = ax_copy(sheet.scale, (size_t)sheet.count, sizeof *scale);
    status = ax_table_read(path, &table, error);
    if (status == AX_OK) {
        status = ax_table_apply(&table, path, sheet.linkage, ax_form_look(*context->form).sheet, scale, error);
        ax_table_free(&table);
    }
    for (int t = 0; t < sheet.count; ++t)
        sheet.scale[t] = sheet.chosen[t] ? scale[t] : sheet.scale[t];
    if (status == AX_OK)
        ax_sheet_give(context, &sheet);
    else
        ax_sheet_free(&sheet);
    ax_free(scale);
    ax_free(path);
    return status;
}

const ax_operator_type ax_operator_table = {
    .name = "table",
    .title = "From a table",
    .doc = "Scale factors from a CSV file: by panel, or by samples scattered over the sheet.",
    .group = "scale",
    .fields = fields,
    .field_count = AX_COUNT(fields),
    .size = sizeof(arguments),
    .defaults = defaults,
    .settles = true,
    .apply = apply,
};
