#include "operator/operator.h"

typedef struct arguments {
    double depth;
} arguments;

static const ax_field fields[] = {
    AX_NUMBER(
        arguments, depth, "Depth", "length", -1e9, 1e9, .required = true,
        .doc = "Of the lowest point below a film without weight on the same rim; negative: above it, for inflation."),
};

static const char* check(const void* given, int* field)
{
    const arguments* a = given;
    *field = 0;
    return a->depth == 0 ? "a level film hangs from no finite force; give a depth below or, negative, above the rim."
                         : NULL;
}

static ax_status apply(const ax_operator_context* context, const void* given, ax_error* error)
{
    const arguments* a = given;
    size_t size;
    void* before = ax_form_save(*context->form, &size);
    ax_status status = ax_form_drape(*context->form, a->depth, context->progress, error);
    if (status != AX_OK) {
        ax_form_free(*context->form);
        *context->form = NULL;
        ax_form_load(before, size, context->form, NULL);
    }
    ax_free(before);
    return status;
}

const ax_operator_type ax_operator_drape = {
    .name = "drape",
    .title = "Drape",
    .doc = "Paints scale factors with which the sheet hangs from its rim like a film: every hole open and every panel "
           "pulled, between lobes and round re-entrant corners too. A start for painting within a given rim.",
    .reference = "Schek 1974, The force density method",
    .group = "scale",
    .fields = fields,
    .field_count = AX_COUNT(fields),
    .size = sizeof(arguments),
    .check = check,
    .settles = true,
    .apply = apply,
};
