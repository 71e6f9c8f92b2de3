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
    ax_finished made = {0};
    ax_status status = ax_form_finish(*context->form, context->progress, &made.design, &made.figures, error);
    made.made = status == AX_OK && made.figures.exact;
    if (status == AX_OK && !made.figures.exact)
        status = ax_fail(error, AX_CANNOT_REALISE, "%s", made.figures.reason);
    if (!made.made || !context->finished)
        ax_design_free(&made.design);
    if (context->finished)
        *context->finished = made;
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
