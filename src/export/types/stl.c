// Binary STL: panels as separate triangles in single precision, which is all that the format has.
#include "base/vec.h"
#include "export/writing.h"

#include <stdint.h>
#include <string.h>

_Static_assert(__BYTE_ORDER__ == __ORDER_LITTLE_ENDIAN__, "STL is little endian, and so is what is written here");

static ax_status write_stl(const ax_design* design, ax_state state, const ax_export_options* options, const char* path,
                           ax_error* error)
{
    (void)options;
    FILE* out = ax_export_open(path, error);
    if (!out)
        return AX_FAILED;
    const ax_linkage* linkage = &design->linkage;
    double(*places)[3] = ax_state_places(design, state);
    char header[80] = {0}; // must not begin with "solid", which announces text
    ax_export_remark(design, state, header);
    fwrite(header, 1, sizeof header, out);
    uint32_t count = (uint32_t)linkage->triangle_count;
    fwrite(&count, sizeof count, 1, out);
    for (int t = 0; t < linkage->triangle_count; ++t) {
        const int* corner = linkage->triangles[t];
        double normal[3];
        ax_panel_normal((const double(*)[3])places, corner, normal);
        float row[12];
        for (int c = 0; c < 3; ++c) {
            row[c] = (float)normal[c];
            for (int k = 0; k < 3; ++k)
                row[3 + 3 * k + c] = (float)places[corner[k]][c];
        }
        char facet[50] = {0}; // the last two bytes have no agreed meaning
        memcpy(facet, row, sizeof row);
        fwrite(facet, 1, sizeof facet, out);
    }
    ax_free(places);
    return ax_export_close(out, path, error);
}

const ax_export_type ax_export_stl = {
    .ending = ".stl",
    .name = "STL, binary",
    .doc = "Panels as separate triangles in single precision, in the design's unit, which the format cannot name.",
    .default_state = AX_STATE_DEPLOYED,
    .states = {true, true, true, true},
    .write = write_stl,
};
