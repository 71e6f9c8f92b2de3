// PDF at true size, one page a sheet, the overview first.
#include "export/page.h"

static ax_status write_sheet(const ax_design* design, const ax_cut_plan* plan, int sheet, const char* path,
                             ax_error* error)
{
    (void)design, (void)sheet;
    return ax_page_sheets(plan, path, error);
}

const ax_export_type ax_export_pdf = {
    .ending = ".pdf",
    .name = "PDF drawing",
    .doc = "The sheets at true size, one to a page of at most 5080 mm.",
    .default_state = AX_STATE_FLAT,
    .states = {[AX_STATE_DEFAULT] = true, [AX_STATE_FLAT] = true},
    .write_sheet = write_sheet,
    .all_sheets = true,
};
