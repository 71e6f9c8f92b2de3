// The assembly plan as a PDF of A3 pages.
#include "ax/export.h"

#include "export/booklet.h"

static ax_status write_sheet(const ax_design* design, const ax_cut_plan* plan, int sheet, const char* path,
                             ax_error* error)
{
    (void)sheet;
    if (!design)
        return ax_fail(error, AX_USAGE, "A coupon has no assembly plan; write it as .svg, .dxf or .pdf.");
    ax_booklet b;
    ax_booklet_open(&b, design, plan, path);
    ax_booklet_title(&b);
    ax_booklet_layout(&b);
    ax_booklet_order(&b);
    ax_booklet_frame(&b);
    ax_booklet_views(&b);
    ax_booklet_collisions(&b);
    return ax_booklet_close(&b, path, error);
}

const ax_export_type ax_export_plan_pdf = {
    .ending = ".plan.pdf",
    .name = "Assembly plan",
    .doc = "Pages of A3: the flat layout with names, the order of joining, the frame with its dimensions, four views.",
    .default_state = AX_STATE_FLAT,
    .states = {[AX_STATE_DEFAULT] = true, [AX_STATE_FLAT] = true},
    .write_sheet = write_sheet,
    .all_sheets = true,
};
