// glTF that draws in one go: what the web shows.
#include "export/glb.h"

static ax_status write_glb(const ax_design* design, ax_state state, const ax_export_options* options, const char* path,
                           ax_error* error)
{
    (void)options;
    return ax_glb_write(design, state, false, path, error);
}

const ax_export_type ax_export_mesh_glb = {
    .ending = ".mesh.glb",
    .name = "glTF, one mesh",
    .doc = "The same as one mesh: small and quick, for viewers and the web.",
    .default_state = AX_STATE_DEPLOYED,
    .states = {true, true, true, true},
    .write = write_glb,
};
