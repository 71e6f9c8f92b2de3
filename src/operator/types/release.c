#include "operator/operator.h"

typedef struct arguments {
    const char* name;
} arguments;

static const ax_field fields[] = {
    AX_TEXT(arguments, name, "Name", .required = true, .doc = "Name of the constraint."),
};

static ax_status apply(const ax_operator_context* context, const void* given, ax_error* error)
{
    const arguments* a = given;
    if (ax_form_drop_constraint(*context->form, a->name))
        return AX_OK;
    return ax_fail(error, AX_BAD_INPUT, "There is no constraint \"%.60s\".", a->name);
}

const ax_operator_type ax_operator_release = {
    .name = "release",
    .title = "Release",
    .doc = "Drops a constraint.",
    .group = "constraint",
    .fields = fields,
    .field_count = AX_COUNT(fields),
    .size = sizeof(arguments),
    .settles = true,
    .apply = apply,
};
