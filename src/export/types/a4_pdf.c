// PDF at true size on A4, to be printed on an office printer and glued: pages overlap, marks show where.
#include "export/page.h"

static ax_status write_sheet(const ax_design* design, const ax_cut_plan* plan, int sheet, const char* path,
                             ax_error* error)
{
    (void)design, (void)sheet;
    return ax_page_tiles(plan, (const double[]){210, 297}, false, path, error);
}

const ax_export_type ax_export_a4_pdf = {
    .ending = ".a4.pdf",
    .name = "PDF tiles",
    .doc = "The sheets at true size over pages of A4 that overlap, with marks for gluing.",
    .default_state = AX_STATE_FLAT,
    .states = {[AX_STATE_DEFAULT] = true, [AX_STATE_FLAT] = true},
    .write_sheet = write_sheet,
    .all_sheets = true,
};
