// The assembly plan as a PDF of A3 pages.
#include "export/booklet.h"
#include "export/page.h"

static ax_status write_sheet(const ax_design* design, const ax_cut_plan* plan, int sheet, const char* path,
                             ax_error* error)
{
    (void)sheet;
    if (!design)
        return ax_fail(error, AX_USAGE, "A coupon has no assembly plan; write it as .svg, .dxf or .pdf.");
    ax_booklet b = {.design = design, .plan = plan, .mm = 1000 * ax_unit_in_metres(design->unit)};
    b.surface = ax_page_open(plan, path, AX_BOOKLET_WIDTH, AX_BOOKLET_HEIGHT);
    b.cairo = cairo_create(b.surface);
    b.assembly = ax_assembly_make(design, plan);
    b.frame = ax_frame_of(design);
    cairo_select_font_face(b.cairo, "Inter", CAIRO_FONT_SLANT_NORMAL, CAIRO_FONT_WEIGHT_NORMAL);
    ax_booklet_title(&b);
    ax_booklet_layout(&b);
    ax_booklet_order(&b);
    ax_booklet_frame(&b);
    ax_booklet_views(&b);
    ax_assembly_free(&b.assembly);
    ax_frame_free(&b.frame);
    cairo_destroy(b.cairo);
    return ax_page_close(b.surface, path, error);
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
