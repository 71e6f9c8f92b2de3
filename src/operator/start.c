#include "operator/start.h"

const char* const ax_unit_words[3] = {[AX_MILLIMETRE] = "mm", [AX_CENTIMETRE] = "cm", [AX_METRE] = "m"};

ax_start ax_start_default(void)
{
    return (ax_start){.triangles = 600, .scale = 1.3, .unit = AX_METRE};
}

ax_status ax_start_form(const ax_operator_context* context, const ax_start* start, int count,
                        const double (*outline)[2], ax_error* error)
{
    const ax_form_start wanted = {.outline_count = count,
                                  .outline = outline,
                                  .triangles = start->triangles,
                                  .edge = start->edge,
                                  .scale = start->scale,
                                  .angle = start->angle * AX_PI / 180,
                                  .inside = start->inside,
                                  .unit = (ax_unit)start->unit};
    ax_form* form;
    ax_status status = ax_form_make(&wanted, &form, error);
    if (status == AX_OK) {
        ax_form_free(*context->form);
        *context->form = form;
    }
    return status;
}
