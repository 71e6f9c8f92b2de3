// The frame's template as DXF R2000.
#include "ax/assembly.h"
#include "export/dxf.h"

static ax_status write_frame(const ax_design* design, ax_state state, const ax_export_options* options,
                             const char* path, ax_error* error)
{
    (void)state;
    ax_support_frame frame = ax_frame_of(design);
    ax_cut_plan plan;
    ax_status status = ax_frame_plan(design, &frame, options->title, &plan, error);
    if (status == AX_OK)
        status = ax_dxf_write(&plan, 0, AX_DXF_R2000, path, error);
    ax_cut_plan_free(&plan);
    ax_frame_free(&frame);
    return status;
}

const ax_export_type ax_export_frame_dxf = {
    .ending = ".frame.dxf",
    .name = "Frame template, DXF",
    .doc = "The curves of the supports, rim and arches, at true size in mm, each in its plane; else from above with "
           "heights, and unrolled.",
    .default_state = AX_STATE_DEPLOYED,
    .states = {[AX_STATE_DEFAULT] = true, [AX_STATE_DEPLOYED] = true},
    .write = write_frame,
};
