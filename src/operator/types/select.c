#include "operator/selection.h"

typedef struct arguments {
    const char *name, *hinges;
} arguments;

static const ax_field fields[] = {
    AX_TEXT(arguments, name, "Name", .required = true, .doc = "Name of the selection; one of this name is replaced."),
    AX_TEXT(arguments, hinges, "Hinges", .required = true,
            .doc = "Selection in words, such as rim:0..90, rim:near(1,0) or line(3,40)."),
};

static const char* check(const void* given, int* field)
{
    const arguments* a = given;
    *field = 0;
    return ax_is_name(a->name) ? NULL : ax_no_name;
}

static ax_status apply(const ax_operator_context* context, const void* given, ax_error* error)
{
    const arguments* a = given;
    int *hinges, count;
    ax_status status = ax_operator_hinges(context, a->hinges, 1, &hinges, &count, error);
    if (status == AX_OK)
        ax_form_name_selection(*context->form, a->name, count, hinges);
    ax_free(hinges);
    return status;
}

const ax_operator_type ax_operator_select = {
    .name = "select",
    .title = "Select",
    .doc = "Gives a selection of hinges a name, by which later operators call it: #name.",
    .group = "selection",
    .fields = fields,
    .field_count = AX_COUNT(fields),
    .size = sizeof(arguments),
    .check = check,
    .apply = apply,
};
