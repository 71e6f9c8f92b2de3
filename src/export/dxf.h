// DXF drawings of cut plans, in the two versions that machines read.
#pragma once

#include "ax/export.h"

typedef enum ax_dxf_version { AX_DXF_R12, AX_DXF_R2000 } ax_dxf_version;

// Writes one sheet (the overview if `sheet` is plan->sheet_count): millimetres, one layer per operation, closed outlines as one
// polyline with bulges, circles as circles.
ax_status ax_dxf_write(const ax_cut_plan* plan, int sheet, ax_dxf_version version, const char* path, ax_error* error);
