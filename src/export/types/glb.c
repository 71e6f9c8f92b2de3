// glTF 2.0, binary: what the web shows. The format wants metres and Y up, so lengths are converted and a node turns Z up to Y up;
// the node also carries the middle of the design, since single precision is too coarse for places far from the origin.
#include "base/vec.h"
#include "export/writing.h"
#include "picture/colour.h"

#include <jansson.h>
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

// glTF's vertex colours are linear, the colour map is sRGB (IEC 61966-2-1).
static uint16_t linear(double srgb)
{
    double light = srgb <= 0.04045 ? srgb / 12.92 : pow((srgb + 0.055) / 1.055, 2.4);
    return (uint16_t)lround(65535 * light);
}

static corner* make_corners(const ax_design* design, ax_state state, double centre[3], float bounds[2][3])
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
        bounds[0][c] = (float)((lo - centre[c]) * metre);
        bounds[1][c] = (float)((hi - centre[c]) * metre);
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

static json_t* numbers(const float* values)
{
    return json_pack("[f, f, f]", (double)values[0], (double)values[1], (double)values[2]);
}

static json_t* make_scene(ax_state state, int corners, const double centre[3], const float bounds[2][3])
{
    int bytes = corners * (int)sizeof(corner);
    char generator[40]; // the unit is always the metre, so the usual remark would mislead
    snprintf(generator, sizeof generator, "Auxshell %s", ax_version());
    json_t* accessors = json_pack(
        "[{s:i, s:i, s:i, s:i, s:s, s:o, s:o}, {s:i, s:i, s:i, s:i, s:s}, {s:i, s:i, s:i, s:i, s:s, s:b}]",
        "bufferView", 0, "byteOffset", (int)offsetof(corner, place), "componentType", FLOAT, "count", corners, "type",
        "VEC3", "min", numbers(bounds[0]), "max", numbers(bounds[1]), //
        "bufferView", 0, "byteOffset", (int)offsetof(corner, normal), "componentType", FLOAT, "count", corners, "type",
        "VEC3", //
        "bufferView", 0, "byteOffset", (int)offsetof(corner, colour), "componentType", UNSIGNED_SHORT, "count", corners,
        "type", "VEC4", "normalized", 1);
    json_t* material = json_pack("{s:b, s:{s:f, s:f}}", "doubleSided", 1, "pbrMetallicRoughness", "metallicFactor", 0.0,
                                 "roughnessFactor", 0.8);
    double half = sqrt(0.5);
    json_t* node = json_pack("{s:i, s:s, s:[f, f, f, f], s:[f, f, f]}", "mesh", 0, "name", ax_state_name(state),
                             "rotation", -half, 0.0, 0.0, half, "translation", centre[0], centre[2], -centre[1]);
    return json_pack("{s:{s:s, s:s}, s:i, s:[{s:[i]}], s:[o], s:[{s:[{s:{s:i, s:i, s:i}, s:i, s:i}]}], s:[o], s:o, "
                     "s:[{s:i, s:i, s:i, s:i}], s:[{s:i}]}",
                     "asset", "version", "2.0", "generator", generator,                                  //
                     "scene", 0, "scenes", "nodes", 0,                                                   //
                     "nodes", node,                                                                      //
                     "meshes", "primitives", "attributes", "POSITION", 0, "NORMAL", 1, "COLOR_0", 2,     //
                     "material", 0, "mode", TRIANGLES,                                                   //
                     "materials", material, "accessors", accessors,                                      //
                     "bufferViews", "buffer", 0, "byteLength", bytes, "byteStride", (int)sizeof(corner), //
                     "target", ARRAY_BUFFER,                                                             //
                     "buffers", "byteLength", bytes);
}

static void put_words(FILE* out, uint32_t a, uint32_t b)
{
    fwrite((uint32_t[]){a, b}, sizeof(uint32_t), 2, out);
}

static ax_status write_glb(const ax_design* design, ax_state state, const ax_export_options* options, const char* path,
                           ax_error* error)
{
    (void)options;
    int count = 3 * design->linkage.triangle_count;
    if (count > INT32_MAX / (int)sizeof(corner))
        return ax_fail(error, AX_FAILED, "%d triangles are more than a glTF file can hold. Use .ply instead.",
                       design->linkage.triangle_count);
    FILE* out = ax_export_open(path, error);
    if (!out)
        return AX_FAILED;
    double centre[3];
    float bounds[2][3];
    corner* corners = make_corners(design, state, centre, bounds);
    json_t* scene = make_scene(state, count, centre, (const float(*)[3])bounds);
    if (!scene) { // infinite in single precision
        ax_free(corners);
        fclose(out);
        return ax_fail(error, AX_FAILED, "The coordinates are too large for a glTF file. Use .ply instead.");
    }
    char* text = json_dumps(scene, JSON_COMPACT);
    json_decref(scene);

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

const ax_export_type ax_export_glb = {
    .ending = ".glb",
    .name = "glTF, binary",
    .doc = "Panels for viewers and the web, coloured by their scale factor, in metres with Y up as glTF wants.",
    .default_state = AX_STATE_DEPLOYED,
    .states = {true, true, true, true},
    .write = write_glb,
};
