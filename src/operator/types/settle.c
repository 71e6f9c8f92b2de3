#include "operator/operator.h"

typedef struct arguments {
    int steps;
} arguments;

static const ax_field fields[] = {
    AX_STEPS(arguments),
};

static ax_status apply(const ax_operator_context* context, const void* given, ax_error* error)
{
    (void)context, (void)given, (void)error; // settling is what follows every operator of this kind
    return AX_OK;
}

const ax_operator_type ax_operator_settle = {
    .name = "settle",
    .title = "Settle",
    .doc = "Solves on, until the form is at rest or for so many iterations.",
    .group = "dynamics",
    .fields = fields,
    .field_count = AX_COUNT(fields),
    .size = sizeof(arguments),
    .settles = true,
    .apply = apply,
};
