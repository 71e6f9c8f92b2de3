// glTF in which panels can be told apart: what modelling programs open.
#include "export/glb.h"

static ax_status write_glb(const ax_design* design, ax_state state, const ax_export_options* options, const char* path,
                           ax_error* error)
{
    (void)options;
    return ax_glb_write(design, state, true, path, error);
}

const ax_export_type ax_export_glb = {
    .ending = ".glb",
    .name = "glTF, binary",
    .doc = "Panels by name in rows, coloured by their scale factor, in metres with Y up as glTF wants.",
    .default_state = AX_STATE_DEPLOYED,
    .states = {true, true, true, true},
    .write = write_glb,
};
