// DXF R12 of a cut plan.
#include "export/dxf.h"

static ax_status write_sheet(const ax_design* design, const ax_cut_plan* plan, int sheet, const char* path,
                             ax_error* error)
{
    (void)design;
    return ax_dxf_write(plan, sheet, AX_DXF_R12, path, error);
}

const ax_export_type ax_export_r12_dxf = {
    .ending = ".r12.dxf",
    .name = "DXF drawing, R12",
    .doc = "The flat panels at true size in mm, a layer for each operation, closed polylines; older machines read it.",
    .default_state = AX_STATE_FLAT,
    .states = {[AX_STATE_DEFAULT] = true, [AX_STATE_FLAT] = true},
    .write_sheet = write_sheet,
};
