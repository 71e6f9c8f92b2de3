#include "operator/operator.h"

typedef struct arguments {
    int steps;
} arguments;

static const ax_field fields[] = {
    AX_STEPS(arguments),
};

static ax_status apply(const ax_operator_context* context, const void* given, ax_error* error)
{
    (void)error;
    const arguments* a = given;
    ax_form_dynamics dynamics = *ax_form_get_dynamics(*context->form);
    (void)a;
    dynamics.kind = AX_DYNAMICS_NONE;
    dynamics.load = (ax_load){.kind = AX_LOAD_NONE};
    ax_form_set_dynamics(*context->form, &dynamics);
    return AX_OK;
}

const ax_operator_type ax_operator_rest = {
    .name = "rest",
    .title = "Rest",
    .doc = "Ends dynamics: only the flat state is solved, the deployed one keeps its place.",
    .group = "dynamics",
    .fields = fields,
    .field_count = AX_COUNT(fields),
    .size = sizeof(arguments),
    .settles = true,
    .apply = apply,
};
