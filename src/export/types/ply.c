// Binary PLY: hinges in double precision, panels with their scale factor and its colour.
#include "export/writing.h"
#include "picture/colour.h"

#include <math.h>
#include <stdint.h>
#include <string.h>

_Static_assert(__BYTE_ORDER__ == __ORDER_LITTLE_ENDIAN__, "the header below says little endian");

static ax_status write_ply(const ax_design* design, ax_state state, const ax_export_options* options, const char* path,
                           ax_error* error)
{
    (void)options;
    FILE* out = ax_export_open(path, error);
    if (!out)
        return AX_FAILED;
    const ax_linkage* linkage = &design->linkage;
    double(*places)[3] = ax_state_places(design, state);
    char remark[80];
    ax_export_remark(design, state, remark);
    fprintf(out,
            "ply\nformat binary_little_endian 1.0\ncomment %s\n"
            "element vertex %d\nproperty double x\nproperty double y\nproperty double z\n"
            "element face %d\nproperty list uchar int vertex_indices\nproperty double lambda\n"
            "property uchar red\nproperty uchar green\nproperty uchar blue\nend_header\n",
            remark, linkage->hinge_count, linkage->triangle_count);
    fwrite(places, sizeof *places, (size_t)linkage->hinge_count, out);
    for (int t = 0; t < linkage->triangle_count; ++t) {
        unsigned char row[1 + 3 * sizeof(int32_t) + sizeof(double) + 3] = {3};
        double rgb[3];
        ax_colour_scale(design->scale[t], rgb);
        memcpy(row + 1, linkage->triangles[t], 3 * sizeof(int32_t));
        memcpy(row + 13, &design->scale[t], sizeof(double));
        for (int c = 0; c < 3; ++c)
            row[21 + c] = (unsigned char)lround(255 * rgb[c]);
        fwrite(row, 1, sizeof row, out);
    }
    ax_free(places);
    return ax_export_close(out, path, error);
}

const ax_export_type ax_export_ply = {
    .ending = ".ply",
    .name = "PLY, binary",
    .doc = "Panels with scale factor and colour, sharing their hinges in double precision, in the design's unit.",
    .default_state = AX_STATE_DEPLOYED,
    .states = {true, true, true, true},
    .write = write_ply,
};
