// glTF 2.0, binary. The format wants metres and Y up, so lengths are converted and a node turns Z up to Y up; the node also carries
// the middle of the design, since single precision is too coarse for places far from the origin.
#include "export/glb.h"

#include "base/vec.h"
#include "export/writing.h"
#include "picture/colour.h"

#include <stdint.h>
#include <stdlib.h>
#include <string.h>

_Static_assert(__BYTE_ORDER__ == __ORDER_LITTLE_ENDIAN__, "glTF is little endian, and so is what is written here");

// One corner of a panel. Panels are flat and have one colour each, so corners are not shared.
typedef struct corner {
    float place[3], normal[3];
    uint16_t colour[4];
} corner;
_Static_assert(sizeof(corner) == 32, "corners are packed");

enum { FLOAT = 5126, UNSIGNED_SHORT = 5123, ARRAY_BUFFER = 34962, TRIANGLES = 4 };
enum { POSITION, NORMAL, COLOUR, ATTRIBUTES }; // accessors of a mesh, in this order

// glTF's vertex colours are linear, the colour map is sRGB (IEC 61966-2-1).
static uint16_t linear(double srgb)
{
    double light = srgb <= 0.04045 ? srgb / 12.92 : pow((srgb + 0.055) / 1.055, 2.4);
    return (uint16_t)lround(65535 * light);
}

static corner* make_corners(const ax_design* design, ax_state state, double centre[3])
{
    const ax_linkage* linkage = &design->linkage;
    double(*places)[3] = ax_state_places(design, state);
    double metre = ax_unit_in_metres(design->unit);
    for (int c = 0; c < 3; ++c) {
        double lo = INFINITY, hi = -INFINITY;
        for (int h = 0; h < linkage->hinge_count; ++h) {
            lo = fmin(lo, places[h][c]);
            hi = fmax(hi, places[h][c]);
        }
        centre[c] = lo / 2 + hi / 2;
    }
    corner* corners = AX_NEW0(corner, 3 * (size_t)linkage->triangle_count);
    for (int t = 0; t < linkage->triangle_count; ++t) {
        double normal[3], rgb[3];
        ax_panel_normal((const double(*)[3])places, linkage->triangles[t], normal);
        ax_colour_scale(design->scale[t], rgb);
        for (int k = 0; k < 3; ++k) {
            corner* at = &corners[3 * (size_t)t + (size_t)k];
            for (int c = 0; c < 3; ++c) {
                at->place[c] = (float)((places[linkage->triangles[t][k]][c] - centre[c]) * metre);
                at->normal[c] = (float)normal[c];
                at->colour[c] = linear(rgb[c]);
            }
            at->colour[3] = 65535;
        }
    }
    for (int c = 0; c < 3; ++c)
        centre[c] *= metre;
    ax_free(places);
    return corners;
}

static void put_numbers(FILE* out, const char* key, const float values[3])
{
    fprintf(out, ",\"%s\":[%.9g,%.9g,%.9g]", key, (double)values[0], (double)values[1], (double)values[2]);
}

// The attributes of corners first .. first + count, false if a bound is not finite.
static bool put_accessors(FILE* out, const corner* corners, int first, int count)
{
    static const size_t offsets[] = {offsetof(corner, place), offsetof(corner, normal), offsetof(corner, colour)};
    float lo[3] = {INFINITY, INFINITY, INFINITY}, hi[3] = {-INFINITY, -INFINITY, -INFINITY};
    for (int i = first; i < first + count; ++i)
        for (int c = 0; c < 3; ++c) {
            lo[c] = fminf(lo[c], corners[i].place[c]);
            hi[c] = fmaxf(hi[c], corners[i].place[c]);
        }
    for (int a = 0; a < ATTRIBUTES; ++a) {
        fprintf(out, "%s{\"bufferView\":0,\"byteOffset\":%zu,\"componentType\":%d,\"count\":%d,\"type\":\"%s\"",
                first || a ? "," : "", (size_t)first * sizeof(corner) + offsets[a],
                a == COLOUR ? UNSIGNED_SHORT : FLOAT, count, a == COLOUR ? "VEC4" : "VEC3");
        if (a == POSITION) {
            put_numbers(out, "min", lo);
            put_numbers(out, "max", hi);
        }
        fputs(a == COLOUR ? ",\"normalized\":true}" : "}", out);
    }
    return isfinite(lo[0] + lo[1] + lo[2]) && isfinite(hi[0] + hi[1] + hi[2]);
}

static void put_mesh(FILE* out, int index)
{
    int a = ATTRIBUTES * index;
    fprintf(out,
            "%s{\"primitives\":[{\"attributes\":{\"POSITION\":%d,\"NORMAL\":%d,\"COLOR_0\":%d},\"material\":0,\"mode\":"
            "%d}]}",
            index ? "," : "", a + POSITION, a + NORMAL, a + COLOUR, TRIANGLES);
}

typedef struct placed {
    int row, panel;
} placed;

static int by_row(const void* a, const void* b)
{
    const placed *x = a, *y = b;
    return x->row != y->row ? (x->row > y->row) - (x->row < y->row) : x->panel - y->panel;
}

// Below the root, node 0: a node for each row of the lattice, and in it one for each panel, named. Children of a node that is yet to come
// are known by the numbers they will have: row nodes 1 .. rows, then the panels in order of rows.
static void put_panel_nodes(FILE* out, const ax_linkage* linkage)
{
    int n = linkage->triangle_count, rows = 0;
    placed* order = AX_NEW(placed, n);
    for (int t = 0; t < n; ++t)
        order[t] = (placed){linkage->panels[t][1], t};
    qsort(order, (size_t)n, sizeof *order, by_row);
    for (int i = 0; i < n; ++i)
        rows += i == 0 || order[i].row != order[i - 1].row;
    fputs(",\"children\":[", out);
    for (int r = 0; r < rows; ++r)
        fprintf(out, "%s%d", r ? "," : "", 1 + r);
    fputs("]}", out);
    char name[16];
    for (int i = 0; i < n;) {
        int first = i;
        ax_panel_name(linkage, order[i].panel, name);
        size_t letters = strcspn(name + (name[0] == '-'), "-0123456789") + (name[0] == '-');
        fprintf(out, ",{\"name\":\"row %.*s\",\"children\":[", (int)letters, name);
        for (; i < n && order[i].row == order[first].row; ++i)
            fprintf(out, "%s%d", i > first ? "," : "", 1 + rows + i);
        fputs("]}", out);
    }
    for (int i = 0; i < n; ++i) {
        ax_panel_name(linkage, order[i].panel, name);
        fprintf(out, ",{\"name\":\"%s\",\"mesh\":%d}", name, order[i].panel);
    }
    ax_free(order);
}

// The scene as JSON, malloced; NULL if places are infinite in single precision.
static char* make_scene(const ax_linkage* linkage, ax_state state, const corner* corners, const double centre[3],
                        bool by_panels)
{
    char* text = NULL;
    size_t size;
    FILE* out = open_memstream(&text, &size);
    int count = 3 * linkage->triangle_count, meshes = by_panels ? linkage->triangle_count : 1;
    double half = sqrt(0.5);
    bool finite = true;
    // the unit is always the metre, so the usual remark would mislead
    fprintf(out,
            "{\"asset\":{\"version\":\"2.0\",\"generator\":\"Auxshell %s\"},\"scene\":0,\"scenes\":[{\"nodes\":[0]}],",
            ax_version());
    fprintf(out, "\"nodes\":[{\"name\":\"%s\",\"rotation\":[%.17g,0,0,%.17g],\"translation\":[%.17g,%.17g,%.17g]",
            ax_state_name(state), -half, half, centre[0], centre[2], -centre[1]);
    if (by_panels)
        put_panel_nodes(out, linkage);
    else
        fputs(",\"mesh\":0}", out);
    fputs("],\"meshes\":[", out);
    for (int m = 0; m < meshes; ++m)
        put_mesh(out, m);
    fputs("],\"materials\":[{\"doubleSided\":true,\"pbrMetallicRoughness\":{\"metallicFactor\":0,\"roughnessFactor\":0."
          "8}}],"
          "\"accessors\":[",
          out);
    for (int m = 0; m < meshes; ++m)
        finite &= put_accessors(out, corners, m * (count / meshes), count / meshes);
    fprintf(out,
            "],\"bufferViews\":[{\"buffer\":0,\"byteLength\":%zu,\"byteStride\":%zu,\"target\":%d}],\"buffers\":[{"
            "\"byteLength\":%zu}]}",
            (size_t)count * sizeof *corners, sizeof *corners, ARRAY_BUFFER, (size_t)count * sizeof *corners);
    fclose(out);
    if (!finite) {
        free(text);
        return NULL;
    }
    return text;
}

static void put_words(FILE* out, uint32_t a, uint32_t b)
{
    fwrite((uint32_t[]){a, b}, sizeof(uint32_t), 2, out);
}

ax_status ax_glb_write(const ax_design* design, ax_state state, bool by_panels, const char* path, ax_error* error)
{
    int count = 3 * design->linkage.triangle_count, most = INT32_MAX / (by_panels ? 800 : 3 * (int)sizeof(corner));
    if (design->linkage.triangle_count > most)
        return ax_fail(error, AX_FAILED, "%d triangles are more than a glTF file can hold. Use .ply instead.",
                       design->linkage.triangle_count);
    double centre[3];
    corner* corners = make_corners(design, state, centre);
    char* text = make_scene(&design->linkage, state, corners, centre, by_panels);
    FILE* out = text ? ax_export_open(path, error) : NULL;
    if (!out) {
        bool infinite = !text;
        free(text);
        ax_free(corners);
        return infinite ? ax_fail(error, AX_FAILED, "The coordinates are too large for a glTF file. Use .ply instead.")
                        : AX_FAILED;
    }
    // header, then chunks of multiples of four bytes, the text filled up with blanks
    uint32_t text_bytes = (uint32_t)strlen(text), filled = (text_bytes + 3) / 4 * 4;
    uint32_t data_bytes = (uint32_t)count * (uint32_t)sizeof(corner);
    fwrite("glTF", 1, 4, out);
    put_words(out, 2, 12 + 8 + filled + 8 + data_bytes);
    put_words(out, filled, 0x4e4f534a); // "JSON"
    fprintf(out, "%-*s", (int)filled, text);
    put_words(out, data_bytes, 0x004e4942); // "BIN"
    fwrite(corners, sizeof *corners, (size_t)count, out);
    free(text);
    ax_free(corners);
    return ax_export_close(out, path, error);
}
