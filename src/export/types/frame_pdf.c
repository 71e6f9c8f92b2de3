// The frame's template at true size on A3, to be printed and glued.
#include "ax/assembly.h"
#include "export/page.h"

#include <math.h>

static const double page_size[2] = {420, 297};
enum { MOST_PAGES = 1000 };

// What passes over `length` mm of curve, and its drawings, cannot touch fewer pages than this.
static ax_status check_length(const ax_support_frame* frame, ax_error* error)
{
    double length = 0;
    for (int k = 0; k < frame->curve_count; ++k)
        length += frame->curves[k].length;
    double pages = length / hypot(page_size[0], page_size[1]);
    return pages <= MOST_PAGES ? AX_OK
                               : ax_fail(error, AX_CANNOT_REALISE,
                                         "A frame %.0f m long would take more than %d pages at true size. Use "
                                         ".frame.dxf, and plot or cut it.",
                                         length / 1000, MOST_PAGES);
}

static ax_status write_frame(const ax_design* design, ax_state state, const ax_export_options* options,
                             const char* path, ax_error* error)
{
    (void)state;
    ax_support_frame frame = ax_frame_of(design);
    ax_cut_plan plan = {0};
    ax_status status = check_length(&frame, error);
    if (status == AX_OK)
        status = ax_frame_plan(design, &frame, options->title, &plan, error);
    if (status == AX_OK)
        status = ax_page_tiles(&plan, page_size, true, path, error);
    ax_cut_plan_free(&plan);
    ax_frame_free(&frame);
    return status;
}

const ax_export_type ax_export_frame_pdf = {
    .ending = ".frame.pdf",
    .name = "Frame template, PDF",
    .doc = "The same over pages of A3 that overlap, with marks for gluing.",
    .default_state = AX_STATE_DEPLOYED,
    .states = {[AX_STATE_DEFAULT] = true, [AX_STATE_DEPLOYED] = true},
    .write = write_frame,
};
