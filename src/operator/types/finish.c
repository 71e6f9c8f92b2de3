#include "operator/operator.h"

typedef struct arguments {
    bool allow_inexact;
} arguments;

static const ax_field fields[] = {
    AX_FLAG(arguments, allow_inexact, "Keep going",
            .doc = "Whether a design that has no exact state goes on as it is, instead of ending the recipe."),
};

static ax_status apply(const ax_operator_context* context, const void* given, ax_error* error)
{
    const arguments* a = given;
    if (context->live)
        return AX_OK;
    ax_design design = {0};
    ax_finish finish = {0};
    ax_status status = ax_form_finish(*context->form, context->progress, &design, &finish, error);
    ax_design_free(&design);
    if (status == AX_OK && !finish.exact)
        status = ax_fail(error, AX_CANNOT_REALISE, "%s", finish.reason);
    return status == AX_CANNOT_REALISE && a->allow_inexact ? AX_OK : status;
}

const ax_operator_type ax_operator_finish = {
    .name = "finish",
    .title = "Finish",
    .doc = "Takes the design to the exact joint solve and, under a load, to exact deployment.",
    .group = "finish",
    .fields = fields,
    .field_count = AX_COUNT(fields),
    .size = sizeof(arguments),
    .apply = apply,
};
