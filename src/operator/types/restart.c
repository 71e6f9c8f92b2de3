#include "operator/operator.h"

typedef struct arguments {
    double height;
    int steps;
} arguments;

static void defaults(void* given)
{
    arguments* a = given;
    a->height = 0.05;
}

static const ax_field fields[] = {
    AX_NUMBER(arguments, height, "Height", "", -2, 2,
              .doc = "Of the dome, over the radius of the sheet; negative: a bowl."),
    AX_STEPS(arguments),
};

static ax_status apply(const ax_operator_context* context, const void* given, ax_error* error)
{
    (void)error;
    const arguments* a = given;
    ax_form_restart(*context->form, a->height);
    return AX_OK;
}

const ax_operator_type ax_operator_restart = {
    .name = "restart",
    .title = "Start again",
    .doc =
        "Puts the deployed state back to a shallow bowl or dome over the sheet and forgets what was learnt on the way.",
    .group = "dynamics",
    .fields = fields,
    .field_count = AX_COUNT(fields),
    .size = sizeof(arguments),
    .defaults = defaults,
    .settles = true,
    .apply = apply,
};
