#include "operator/rim.h"

typedef struct arguments {
    const char* hinges;
} arguments;

static void defaults(void* given)
{
    arguments* a = given;
    a->hinges = "rim";
}

static const ax_field fields[] = {
    AX_RIM_HINGES(arguments),
};

static ax_status apply(const ax_operator_context* context, const void* given, ax_error* error)
{
    const arguments* a = given;
    int *hinges, count;
    ax_status status = ax_rim_hinges(context, a->hinges, &hinges, &count, error);
    if (status != AX_OK)
        return status;
    ax_rim rim = ax_rim_copy(*context->form);
    ax_rim_take_out(&rim, count, hinges);
    status = ax_form_set_rim(*context->form, rim.count, rim.parts, error);
    ax_rim_free(&rim);
    ax_free(hinges);
    return status;
}

const ax_operator_type ax_operator_rim_free = {
    .name = "rim_free",
    .title = "Free rim",
    .doc = "Lets hinges of the rim go wherever the design takes them.",
    .group = "boundary",
    .fields = fields,
    .field_count = AX_COUNT(fields),
    .size = sizeof(arguments),
    .defaults = defaults,
    .settles = true,
    .apply = apply,
};
