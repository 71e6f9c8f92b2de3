// Wavefront OBJ: vertex k + 1 is hinge k, one face per panel in a group of the panel's name.
#include "export/writing.h"

#include <ctype.h>

// OBJ separates by white space and ends names at line ends.
static void put_name(FILE* out, const char* name)
{
    for (; *name; ++name)
        putc(isspace((unsigned char)*name) || iscntrl((unsigned char)*name) ? '_' : *name, out);
}

static ax_status write_obj(const ax_design* design, ax_state state, const ax_export_options* options, const char* path,
                           ax_error* error)
{
    FILE* out = ax_export_open(path, error);
    if (!out)
        return AX_FAILED;
    const ax_linkage* linkage = &design->linkage;
    double(*places)[3] = ax_state_places(design, state);
    char text[80];
    ax_export_remark(design, state, text);
    fprintf(out, "# %s\no ", text);
    put_name(out, options->title && *options->title ? options->title : "auxshell");
    putc('\n', out);
    for (int h = 0; h < linkage->hinge_count; ++h)
        fprintf(out, "v %.17g %.17g %.17g\n", places[h][0], places[h][1], places[h][2]);
    for (int t = 0; t < linkage->triangle_count; ++t) {
        const int* corner = linkage->triangles[t];
        ax_panel_name(linkage, t, text);
        fprintf(out, "g %s\nf %d %d %d\n", text, corner[0] + 1, corner[1] + 1, corner[2] + 1);
    }
    ax_free(places);
    return ax_export_close(out, path, error);
}

const ax_export_type ax_export_obj = {
    .ending = ".obj",
    .name = "Wavefront OBJ",
    .doc = "Panels as faces that share their hinges as vertices, one group per panel, in the design's unit.",
    .default_state = AX_STATE_DEPLOYED,
    .states = {true, true, true, true},
    .write = write_obj,
};
