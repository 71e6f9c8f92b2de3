// A picture of one state.
#include "ax/picture.h"

static ax_status write_png(const ax_design* design, ax_state state, const ax_export_options* options, const char* path,
                           ax_error* error)
{
    (void)options;
    return ax_picture_design(design, state, 1600, 1200, path, error);
}

const ax_export_type ax_export_png = {
    .ending = ".png",
    .name = "PNG picture",
    .doc = "A picture, 1600 x 1200 pixels, panels coloured by their scale factor.",
    .default_state = AX_STATE_DEPLOYED,
    .states = {true, true, true, true},
    .write = write_png,
};
