#include "operator/operator.h"

typedef struct arguments {
    bool released;
} arguments;

static const ax_field fields[] = {
    AX_FLAG(arguments, released, "Released", .required = true,
            .doc = "true: they may follow the rim's curve; false: every panel stays equilateral."),
};

static ax_status apply(const ax_operator_context* context, const void* given, ax_error* error)
{
    (void)error;
    const arguments* a = given;
    ax_form_release_border(*context->form, a->released);
    return AX_OK;
}

const ax_operator_type ax_operator_border = {
    .name = "border",
    .title = "Border panels",
    .doc = "Lets panels at the rim deviate from being equilateral, within bounds, or forbids it.",
    .group = "boundary",
    .fields = fields,
    .field_count = AX_COUNT(fields),
    .size = sizeof(arguments),
    .settles = true,
    .apply = apply,
};
