#include "operator/operator.h"

typedef struct arguments {
    double angle;
} arguments;

static const ax_field fields[] = {
    AX_NUMBER(arguments, angle, "Angle", "deg", 0, 59, .required = true,
              .doc = "Smallest mouth angle of the flat state; a new design has 2."),
};

static ax_status apply(const ax_operator_context* context, const void* given, ax_error* error)
{
    (void)error;
    const arguments* a = given;
    ax_form_set_mouth_min(*context->form, a->angle * AX_PI / 180);
    return AX_OK;
}

const ax_operator_type ax_operator_mouth = {
    .name = "mouth",
    .title = "Mouth angle",
    .doc = "Sets how far the mouths of the flat holes must stay open: room for joints and the saw.",
    .group = "dynamics",
    .fields = fields,
    .field_count = AX_COUNT(fields),
    .size = sizeof(arguments),
    .settles = true,
    .apply = apply,
};
