// Exported files, read back number by number by parsers written for the purpose.
#include "ax/export.h"

#include "ax/report.h"
#include "base/random.h"
#include "base/vec.h"
#include "export/writing.h"
#include "fabricate/stroke_font.h"
#include "picture/colour.h"
#include "support/sample.h"
#include "support/test.h"

#include <dirent.h>
#include <jansson.h>
#include <signal.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

static char folder[] = "/tmp/ax_export_XXXXXX";
static ax_design sample;

static int set_up(void** state)
{
    (void)state;
    sample = sample_design();
    return mkdtemp(folder) ? 0 : -1;
}

// Removes what is in the folder and returns how much it was.
static int clear_folder(void)
{
    int count = 0;
    DIR* entries = opendir(folder);
    for (struct dirent* entry; (entry = readdir(entries));) {
        char name[400];
        snprintf(name, sizeof name, "%s/%s", folder, entry->d_name);
        count += unlink(name) == 0;
    }
    closedir(entries);
    return count;
}

static int tear_down(void** state)
{
    (void)state;
    clear_folder();
    rmdir(folder);
    ax_design_free(&sample);
    return 0;
}

static const char* in_folder(const char* name)
{
    static char path[128];
    snprintf(path, sizeof path, "%s/%s", folder, name);
    return path;
}

// Contents of a file with a zero byte after the end; freed by the caller.
static char* read_bytes(const char* path, size_t* size)
{
    FILE* in = fopen(path, "rb");
    if (!in)
        fail_msg("%s is not there", path);
    fseek(in, 0, SEEK_END);
    *size = (size_t)ftell(in);
    rewind(in);
    char* bytes = calloc(*size + 1, 1);
    assert_int_equal(fread(bytes, 1, *size, in), *size);
    fclose(in);
    return bytes;
}

// Exports, reads, and leaves the folder as it was.
static char* export_design(const ax_design* design, const char* name, ax_state state, const char* title, size_t* size)
{
    ax_error error;
    const char* path = in_folder(name);
    if (ax_export(design, path, &(ax_export_options){.state = state, .title = title}, &error) != AX_OK)
        fail_msg("%s", error.message);
    char* bytes = read_bytes(path, size);
    assert_int_equal(clear_folder(), 1);
    return bytes;
}

static const ax_state states[] = {AX_STATE_FLAT, AX_STATE_DEPLOYED, AX_STATE_SIMULATED};

// Hinge `h` of a state, the flat one in z = 0.
static void place_of(const ax_design* design, ax_state state, int h, double out[3])
{
    const double(*places)[3] = (const double(*)[3])(state == AX_STATE_SIMULATED ? design->simulated : design->deployed);
    for (int c = 0; c < 3; ++c)
        out[c] = state != AX_STATE_FLAT ? places[h][c] : c < 2 ? design->flat[h][c] : 0;
}

static void normal_of(const ax_design* design, ax_state state, int t, double out[3])
{
    double p[3][3], a[3], b[3];
    for (int k = 0; k < 3; ++k)
        place_of(design, state, design->linkage.triangles[t][k], p[k]);
    ax_sub3(p[1], p[0], a);
    ax_sub3(p[2], p[0], b);
    ax_cross(a, b, out);
    double length = ax_norm3(out);
    for (int c = 0; c < 3; ++c)
        out[c] /= length;
}

// --- the list of exporters

static void exporters_are_listed_by_ending_and_complete(void** state)
{
    (void)state;
    int count;
    const ax_export_type* const* types = ax_export_types(&count);
    assert_in_range(count, 6, 100);
    for (int k = 0; k < count; ++k) {
        assert_int_equal(types[k]->ending[0], '.');
        assert_true(k == 0 || strcmp(types[k - 1]->ending, types[k]->ending) < 0);
        assert_true(strlen(types[k]->name) > 2);
        assert_int_equal(types[k]->doc[strlen(types[k]->doc) - 1], '.');
        assert_true(types[k]->states[AX_STATE_DEFAULT]);
        assert_true(types[k]->default_state != AX_STATE_DEFAULT && types[k]->states[types[k]->default_state]);
        assert_true(!types[k]->write != !types[k]->write_sheet);
    }
}

static void every_exporter_repeats_its_bytes_and_leaves_one_file(void** state)
{
    (void)state;
    int count;
    const ax_export_type* const* types = ax_export_types(&count);
    for (int k = 0; k < count; ++k) {
        char name[32];
        snprintf(name, sizeof name, "dome%s", types[k]->ending);
        size_t n, m;
        char *a = export_design(&sample, name, AX_STATE_DEFAULT, "dome", &n),
             *b = export_design(&sample, name, types[k]->default_state, "dome", &m);
        assert_int_equal(n, m);
        assert_memory_equal(a, b, n);
        free(a);
        free(b);
    }
}

static void every_exporter_notices_a_full_disk_and_leaves_nothing(void** state)
{
    (void)state;
    int count;
    const ax_export_type* const* types = ax_export_types(&count);
    for (int k = 0; k < count; ++k) {
        fflush(NULL);
        pid_t child = fork();
        if (child == 0) {
            char name[32];
            snprintf(name, sizeof name, "dome%s", types[k]->ending);
            const char* path = in_folder(name);
            signal(SIGXFSZ, SIG_IGN);
            setrlimit(RLIMIT_FSIZE, &(struct rlimit){1000, 1000});
            ax_error error = {0};
            ax_status status = ax_export(&sample, path, NULL, &error);
            bool named = strstr(error.message, path) && !strstr(error.message, ".part");
            _exit(status == AX_FAILED && named ? 0 : 1);
        }
        int ended;
        waitpid(child, &ended, 0);
        if (ended != 0)
            fail_msg("%s does not notice a full disk", types[k]->ending);
        assert_int_equal(clear_folder(), 0);
    }
}

static void a_folder_that_is_not_there_is_named(void** state)
{
    (void)state;
    ax_error error;
    assert_int_equal(ax_export(&sample, "/nowhere/dome.obj", NULL, &error), AX_FAILED);
    assert_non_null(strstr(error.message, "/nowhere/dome.obj"));
}

static void endings_choose_the_format_whatever_their_case(void** state)
{
    (void)state;
    size_t n, m;
    char *a = export_design(&sample, "a.stl", AX_STATE_FLAT, NULL, &n),
         *b = export_design(&sample, "b.d.STL", AX_STATE_FLAT, NULL, &m);
    assert_int_equal(n, m);
    assert_memory_equal(a, b, n);
    free(a);
    free(b);
}

static void unknown_endings_are_answered_with_the_known_ones(void** state)
{
    (void)state;
    static const char* const names[] = {"dome.xyz", "dome", "obj", "dome.obj~", ""};
    for (size_t k = 0; k < sizeof names / sizeof *names; ++k) {
        ax_error error = {0};
        assert_int_equal(ax_export(&sample, names[k], NULL, &error), AX_USAGE);
        int count;
        const ax_export_type* const* types = ax_export_types(&count);
        for (int t = 0; t < count; ++t)
            assert_non_null(strstr(error.message, types[t]->ending));
    }
}

static void states_that_cannot_be_written_are_refused(void** state)
{
    (void)state;
    ax_error error;
    ax_export_options options = {.state = AX_STATE_DEPLOYED};
    assert_int_equal(ax_export(&sample, in_folder("a.svg"), &options, &error), AX_USAGE);
    assert_non_null(strstr(error.message, "deployed"));
    ax_design bare = sample;
    bare.simulated = NULL, bare.forces = NULL, bare.edge_forces = NULL;
    options.state = AX_STATE_SIMULATED;
    assert_int_equal(ax_export(&bare, in_folder("a.obj"), &options, &error), AX_BAD_INPUT);
    assert_non_null(strstr(error.message, "simulated"));
    assert_int_equal(clear_folder(), 0);
}

// --- design JSON

static void assert_rows(const json_t* array, const double* values, int count, int width)
{
    assert_int_equal(json_array_size(array), count);
    for (int k = 0; k < count; ++k) {
        const json_t* row = width > 1 ? json_array_get(array, (size_t)k) : array;
        assert_true(width == 1 || json_array_size(row) == (size_t)width);
        for (int c = 0; c < width; ++c)
            assert_near(json_number_value(json_array_get(row, (size_t)(width > 1 ? c : k))), values[k * width + c], 0);
    }
}

static void assert_loops(const json_t* array, int count, const int* start, const int* hinges)
{
    assert_int_equal(json_array_size(array), count);
    for (int k = 0; k < count; ++k) {
        const json_t* loop = json_array_get(array, (size_t)k);
        assert_int_equal(json_array_size(loop), start[k + 1] - start[k]);
        for (int i = start[k]; i < start[k + 1]; ++i)
            assert_int_equal(json_integer_value(json_array_get(loop, (size_t)(i - start[k]))), hinges[i]);
    }
}

static json_t* export_json(const ax_design* design)
{
    size_t size;
    char* text = export_design(design, "dome.json", AX_STATE_DEFAULT, NULL, &size);
    json_error_t error;
    json_t* root = json_loadb(text, size, JSON_REJECT_DUPLICATES, &error);
    if (!root)
        fail_msg("line %d: %s", error.line, error.text);
    free(text);
    return root;
}

static void design_json_holds_the_design_to_the_last_bit(void** state)
{
    (void)state;
    json_t* root = export_json(&sample);
    static const char* const keys[] = {"format",   "version",  "units",       "triangles", "holes",
                                       "openings", "supports", "flat",        "deployed",  "simulated",
                                       "scale",    "load",     "edge_forces", "report"};
    size_t found = 0;
    for (void* at = json_object_iter(root); at; at = json_object_iter_next(root, at), ++found)
        assert_string_equal(json_object_iter_key(at), keys[found]);
    assert_int_equal(found, sizeof keys / sizeof *keys);
    assert_string_equal(json_string_value(json_object_get(root, "format")), "auxshell-design");
    assert_int_equal(json_integer_value(json_object_get(root, "version")), 1);
    assert_string_equal(json_string_value(json_object_get(root, "units")), "m");

    const ax_linkage* l = &sample.linkage;
    const json_t* triangles = json_object_get(root, "triangles");
    assert_int_equal(json_array_size(triangles), l->triangle_count);
    for (int t = 0; t < l->triangle_count; ++t)
        for (int k = 0; k < 3; ++k)
            assert_int_equal(json_integer_value(json_array_get(json_array_get(triangles, (size_t)t), (size_t)k)),
                             l->triangles[t][k]);
    assert_loops(json_object_get(root, "holes"), l->hole_count, l->hole_start, l->hole_hinges);
    assert_loops(json_object_get(root, "openings"), l->opening_count, l->opening_start, l->opening_hinges);
    const json_t* supports = json_object_get(root, "supports");
    size_t held = 0;
    for (int h = 0; h < l->hinge_count; ++h)
        if (sample.supports[h])
            assert_int_equal(json_integer_value(json_array_get(supports, held++)), h);
    assert_int_equal(json_array_size(supports), held);
    assert_rows(json_object_get(root, "flat"), sample.flat[0], l->hinge_count, 2);
    assert_rows(json_object_get(root, "deployed"), sample.deployed[0], l->hinge_count, 3);
    assert_rows(json_object_get(root, "simulated"), sample.simulated[0], l->hinge_count, 3);
    assert_rows(json_object_get(root, "scale"), sample.scale, l->triangle_count, 1);
    assert_rows(json_object_get(root, "edge_forces"), sample.edge_forces[0], l->triangle_count, 3);
    const json_t* load = json_object_get(root, "load");
    assert_string_equal(json_string_value(json_object_get(load, "kind")), "inflation");
    assert_true(json_is_null(json_object_get(load, "direction")));
    assert_near(json_number_value(json_object_get(load, "pressure")), sample.load.pressure, 0);
    assert_true(json_is_null(json_object_get(load, "density")));
    assert_rows(json_object_get(load, "forces"), sample.forces[0], l->hinge_count, 3);
    json_decref(root);
}

static void design_json_reports_every_figure_and_names_every_panel(void** state)
{
    (void)state;
    ax_design design = sample;
    design.report.cover_p99_over_L = NAN; // JSON has no NaN
    json_t* root = export_json(&design);
    const json_t* report = json_object_get(root, "report");
    int count;
    const ax_figure* figures = ax_report_figures(&count);
    for (int f = 0; f < count; ++f)
        for (int k = 0; k < figures[f].count; ++k) {
            const json_t* value = json_object_get(report, figures[f].key);
            value = figures[f].count > 1 ? json_array_get(value, (size_t)k) : value;
            double expected = ax_figure_value(&figures[f], &design.report, k);
            assert_non_null(value);
            if (figures[f].kind == AX_FIGURE_FLAG)
                assert_true(json_is_boolean(value) && json_is_true(value) == (expected != 0));
            else if (isnan(expected))
                assert_true(json_is_null(value));
            else
                assert_near(json_number_value(value), expected, 0);
        }
    assert_true(json_is_null(json_object_get(report, "cover_p99_over_L")));
    const json_t* panels = json_object_get(report, "panels");
    assert_int_equal(json_array_size(panels), sample.linkage.triangle_count);
    for (int t = 0; t < sample.linkage.triangle_count; ++t) {
        char name[16];
        ax_panel_name(&sample.linkage, t, name);
        assert_string_equal(json_string_value(json_array_get(panels, (size_t)t)), name);
    }
    assert_true(json_is_null(json_object_get(report, "projection")));
    assert_int_equal(json_integer_value(json_object_get(json_object_get(report, "repairs"), "flipped_faces")),
                     sample.repairs.flipped_faces);
    assert_near(json_number_value(json_object_get(report, "scale_ratio")), sample.scale_ratio, 0);
    assert_near(json_number_value(json_object_get(report, "mouth_min")), sample.mouth_min, 0);
    assert_string_equal(json_string_value(json_object_get(report, "border")), "equilateral");
    json_decref(root);
}

static void design_json_says_null_for_what_is_not_there(void** state)
{
    (void)state;
    ax_design design = sample;
    design.simulated = NULL, design.forces = NULL, design.edge_forces = NULL;
    design.load = (ax_load){.kind = AX_LOAD_GRAVITY, .direction = {0, 0, -1}, .pressure = 100, .density = 4};
    design.projected = true;
    design.projection.steps = 3;
    json_t* root = export_json(&design);
    assert_true(json_is_null(json_object_get(root, "simulated")));
    assert_true(json_is_null(json_object_get(root, "edge_forces")));
    const json_t* load = json_object_get(root, "load");
    assert_true(json_is_null(json_object_get(load, "forces")));
    assert_true(json_is_null(json_object_get(load, "pressure")));
    assert_near(json_number_value(json_object_get(load, "density")), 4, 0);
    assert_rows(json_object_get(load, "direction"), design.load.direction, 3, 1);
    const json_t* projection = json_object_get(json_object_get(root, "report"), "projection");
    assert_int_equal(json_integer_value(json_object_get(projection, "steps")), 3);
    json_decref(root);
    design.load = (ax_load){.kind = AX_LOAD_NONE};
    root = export_json(&design);
    assert_true(json_is_null(json_object_get(root, "load")));
    json_decref(root);
}

// --- meshes

static void obj_holds_hinges_and_named_panels(void** state)
{
    (void)state;
    const ax_linkage* l = &sample.linkage;
    for (int s = 0; s < 3; ++s) {
        size_t size;
        char* text = export_design(&sample, "dome.obj", states[s], "a dome", &size);
        assert_non_null(strstr(text, "lengths in m\n"));
        assert_non_null(strstr(text, "\no a_dome\n"));
        int h = 0, t = 0, i, j, k;
        char group[32] = "", name[16];
        for (char* line = strtok(text, "\n"); line; line = strtok(NULL, "\n")) {
            double p[3], want[3];
            if (sscanf(line, "v %lf %lf %lf", &p[0], &p[1], &p[2]) == 3) {
                place_of(&sample, states[s], h++, want);
                assert_memory_equal(p, want, sizeof p);
            } else if (sscanf(line, "f %d %d %d", &i, &j, &k) == 3) {
                const int* corner = l->triangles[t];
                assert_true(i == corner[0] + 1 && j == corner[1] + 1 && k == corner[2] + 1);
                ax_panel_name(l, t++, name);
                assert_string_equal(group, name);
            } else
                sscanf(line, "g %31s", group);
        }
        assert_int_equal(h, l->hinge_count);
        assert_int_equal(t, l->triangle_count);
        free(text);
    }
}

static void stl_holds_panels_with_their_normals(void** state)
{
    (void)state;
    const ax_linkage* l = &sample.linkage;
    for (int s = 0; s < 3; ++s) {
        size_t size;
        char* bytes = export_design(&sample, "dome.stl", states[s], "solid", &size);
        uint32_t count;
        memcpy(&count, bytes + 80, 4);
        assert_int_equal(count, l->triangle_count);
        assert_int_equal(size, 84 + 50 * (size_t)count);
        assert_int_not_equal(memcmp(bytes, "solid", 5), 0); // would announce text
        assert_non_null(strstr(bytes, "lengths in m"));
        for (int t = 0; t < l->triangle_count; ++t) {
            float row[12];
            double normal[3], place[3];
            memcpy(row, bytes + 84 + 50 * t, sizeof row);
            normal_of(&sample, states[s], t, normal);
            for (int c = 0; c < 3; ++c)
                assert_near(row[c], normal[c], 1e-6);
            for (int k = 0; k < 3; ++k) {
                place_of(&sample, states[s], l->triangles[t][k], place);
                for (int c = 0; c < 3; ++c)
                    assert_true(row[3 + 3 * k + c] == (float)place[c]);
            }
        }
        free(bytes);
    }
}

static void ply_holds_panels_with_scale_and_colour(void** state)
{
    (void)state;
    const ax_linkage* l = &sample.linkage;
    size_t size;
    char* bytes = export_design(&sample, "dome.ply", AX_STATE_SIMULATED, NULL, &size);
    char expected[400];
    snprintf(expected, sizeof expected,
             "ply\nformat binary_little_endian 1.0\ncomment Auxshell %s, simulated state, lengths in m\n"
             "element vertex %d\nproperty double x\nproperty double y\nproperty double z\n"
             "element face %d\nproperty list uchar int vertex_indices\nproperty double lambda\n"
             "property uchar red\nproperty uchar green\nproperty uchar blue\nend_header\n",
             ax_version(), l->hinge_count, l->triangle_count);
    size_t header = strlen(expected);
    assert_memory_equal(bytes, expected, header);
    const char* body = bytes + header;
    assert_int_equal(size, header + 24 * (size_t)l->hinge_count + 24 * (size_t)l->triangle_count);
    assert_memory_equal(body, sample.simulated, 24 * (size_t)l->hinge_count);
    body += 24 * l->hinge_count;
    for (int t = 0; t < l->triangle_count; ++t, body += 24) {
        double rgb[3];
        assert_int_equal(body[0], 3);
        assert_memory_equal(body + 1, l->triangles[t], 12);
        assert_memory_equal(body + 13, &sample.scale[t], 8);
        ax_colour_scale(sample.scale[t], rgb);
        for (int c = 0; c < 3; ++c)
            assert_near((unsigned char)body[21 + c], 255 * rgb[c], 0.5);
    }
    free(bytes);
}

typedef struct glb {
    char* bytes;
    json_t* scene;
    const char* data;
} glb;

static glb export_glb(const ax_design* design, const char* name, ax_state state)
{
    glb g;
    size_t size;
    g.bytes = export_design(design, name, state, NULL, &size);
    uint32_t head[5], data_head[2];
    memcpy(head, g.bytes, sizeof head);
    assert_memory_equal(g.bytes, "glTF", 4);
    assert_int_equal(head[1], 2);
    assert_int_equal(head[2], size);
    assert_int_equal(head[3] % 4, 0);
    assert_memory_equal(g.bytes + 16, "JSON", 4);
    json_error_t error;
    g.scene = json_loadb(g.bytes + 20, head[3], 0, &error);
    assert_non_null(g.scene);
    memcpy(data_head, g.bytes + 20 + head[3], sizeof data_head);
    assert_memory_equal(g.bytes + 24 + head[3], "BIN\0", 4);
    assert_int_equal(28 + head[3] + data_head[0], size);
    g.data = g.bytes + 28 + head[3];
    json_int_t length;
    assert_int_equal(json_unpack(g.scene, "{s:[{s:I}]}", "buffers", "byteLength", &length), 0);
    assert_int_equal(length, data_head[0]);
    return g;
}

static void free_glb(glb* g)
{
    json_decref(g->scene);
    free(g->bytes);
}

// Corner `i` as the accessor for `attribute` finds it; returns the address of its first component.
static const char* glb_corner(const glb* g, const char* attribute, int i, int type, const char* shape)
{
    int accessor, view, offset, component, count, start, length, stride;
    const char* found;
    assert_int_equal(
        json_unpack(g->scene, "{s:[{s:[{s:{s:i}}]}]}", "meshes", "primitives", "attributes", attribute, &accessor), 0);
    json_t* a = json_array_get(json_object_get(g->scene, "accessors"), (size_t)accessor);
    assert_int_equal(json_unpack(a, "{s:i, s:i, s:i, s:i, s:s}", "bufferView", &view, "byteOffset", &offset,
                                 "componentType", &component, "count", &count, "type", &found),
                     0);
    assert_int_equal(component, type);
    assert_string_equal(found, shape);
    json_t* v = json_array_get(json_object_get(g->scene, "bufferViews"), (size_t)view);
    assert_int_equal(
        json_unpack(v, "{s?i, s:i, s:i}", "byteOffset", &start, "byteLength", &length, "byteStride", &stride), 0);
    assert_in_range(i, 0, count - 1);
    assert_int_equal(length, count * stride);
    return g->data + offset + i * stride;
}

// The node's transformation, as glTF defines it: turn by the quaternion, then move.
static void glb_transform(const glb* g, const float local[3], double out[3])
{
    double q[4], move[3];
    assert_int_equal(json_unpack(g->scene, "{s:[{s:[F,F,F,F], s:[F,F,F]}]}", "nodes", "rotation", &q[0], &q[1], &q[2],
                                 &q[3], "translation", &move[0], &move[1], &move[2]),
                     0);
    double v[3] = {local[0], local[1], local[2]}, u[3], w[3];
    ax_cross(q, v, u);
    for (int c = 0; c < 3; ++c)
        u[c] += q[3] * v[c];
    ax_cross(q, u, w);
    for (int c = 0; c < 3; ++c)
        out[c] = v[c] + 2 * w[c] + move[c];
}

static double linear_light(double srgb)
{
    return srgb <= 0.04045 ? srgb / 12.92 : pow((srgb + 0.055) / 1.055, 2.4);
}

static void glb_holds_panels_in_metres_with_y_up(void** state)
{
    (void)state;
    static const ax_unit units[] = {AX_METRE, AX_CENTIMETRE, AX_MILLIMETRE};
    static const double metres[] = {1, 0.01, 0.001};
    const ax_linkage* l = &sample.linkage;
    for (int s = 0; s < 3; ++s) {
        ax_design design = sample;
        design.unit = units[s];
        glb g = export_glb(&design, "dome.mesh.glb", states[s]);
        float lo[3] = {INFINITY, INFINITY, INFINITY}, hi[3] = {-INFINITY, -INFINITY, -INFINITY};
        for (int i = 0; i < 3 * l->triangle_count; ++i) {
            float local[3], normal[3];
            uint16_t colour[4];
            double place[3], world[3], up[3], rgb[3];
            memcpy(local, glb_corner(&g, "POSITION", i, 5126, "VEC3"), sizeof local);
            memcpy(normal, glb_corner(&g, "NORMAL", i, 5126, "VEC3"), sizeof normal);
            memcpy(colour, glb_corner(&g, "COLOR_0", i, 5123, "VEC4"), sizeof colour);
            glb_transform(&g, local, world);
            place_of(&design, states[s], l->triangles[i / 3][i % 3], place);
            // Z up becomes Y up: x stays right, the old y points away from the viewer
            assert_near(world[0], metres[s] * place[0], 1e-7 * metres[s]);
            assert_near(world[1], metres[s] * place[2], 1e-7 * metres[s]);
            assert_near(world[2], -metres[s] * place[1], 1e-7 * metres[s]);
            normal_of(&design, states[s], i / 3, up);
            ax_colour_scale(design.scale[i / 3], rgb);
            for (int c = 0; c < 3; ++c) {
                assert_near(normal[c], up[c], 1e-6);
                assert_near(colour[c] / 65535.0, linear_light(rgb[c]), 1e-5);
                lo[c] = fminf(lo[c], local[c]);
                hi[c] = fmaxf(hi[c], local[c]);
            }
            assert_int_equal(colour[3], 65535);
        }
        json_t* accessor = json_array_get(json_object_get(g.scene, "accessors"), 0);
        for (size_t c = 0; c < 3; ++c) {
            assert_true((float)json_number_value(json_array_get(json_object_get(accessor, "min"), c)) == lo[c]);
            assert_true((float)json_number_value(json_array_get(json_object_get(accessor, "max"), c)) == hi[c]);
        }
        free_glb(&g);
    }
}

// Panel t is a node of its name in a node of its row; its mesh has the corners of the one mesh of .mesh.glb.
static void glb_tells_panels_apart(void** state)
{
    (void)state;
    const ax_linkage* l = &sample.linkage;
    glb g = export_glb(&sample, "dome.glb", AX_STATE_DEPLOYED),
        one = export_glb(&sample, "dome.mesh.glb", AX_STATE_DEPLOYED);
    json_t *nodes = json_object_get(g.scene, "nodes"), *meshes = json_object_get(g.scene, "meshes");
    json_t *accessors = json_object_get(g.scene, "accessors"), *row, *panel;
    assert_int_equal(json_array_size(meshes), l->triangle_count);
    unsigned char* met = AX_NEW0(unsigned char, l->triangle_count);
    size_t i, k, met_nodes = 1;
    assert_true(json_equal(json_object_get(json_array_get(nodes, 0), "rotation"),
                           json_object_get(json_array_get(json_object_get(one.scene, "nodes"), 0), "rotation")));
    assert_true(json_equal(json_object_get(json_array_get(nodes, 0), "translation"),
                           json_object_get(json_array_get(json_object_get(one.scene, "nodes"), 0), "translation")));
    json_array_foreach(json_object_get(json_array_get(nodes, 0), "children"), i, row)
    {
        json_t* row_node = json_array_get(nodes, (size_t)json_integer_value(row));
        const char* row_name = json_string_value(json_object_get(row_node, "name"));
        ++met_nodes;
        json_array_foreach(json_object_get(row_node, "children"), k, panel)
        {
            const char* name;
            int mesh, a[3];
            char expected[16], start[24];
            assert_int_equal(json_unpack(json_array_get(nodes, (size_t)json_integer_value(panel)), "{s:s, s:i}", "name",
                                         &name, "mesh", &mesh),
                             0);
            ax_panel_name(l, mesh, expected);
            assert_string_equal(name, expected);
            snprintf(start, sizeof start, "row %.*s", (int)strcspn(name, "0123456789"),
                     name); // names of this design have no minus
            assert_string_equal(row_name, start);
            assert_false(met[mesh]++);
            ++met_nodes;
            assert_int_equal(json_unpack(json_array_get(meshes, (size_t)mesh), "{s:[{s:{s:i, s:i, s:i}}]}",
                                         "primitives", "attributes", "POSITION", &a[0], "NORMAL", &a[1], "COLOR_0",
                                         &a[2]),
                             0);
            static const char* const attributes[] = {"POSITION", "NORMAL", "COLOR_0"};
            for (int c = 0; c < 3; ++c) {
                int offset, count, type;
                const char* shape;
                assert_int_equal(json_unpack(json_array_get(accessors, (size_t)a[c]), "{s:i, s:i, s:i, s:s}",
                                             "byteOffset", &offset, "count", &count, "componentType", &type, "type",
                                             &shape),
                                 0);
                assert_int_equal(count, 3);
                for (int corner = 0; corner < 3; ++corner)
                    assert_memory_equal(g.data + offset + 32 * corner,
                                        glb_corner(&one, attributes[c], 3 * mesh + corner, type, shape),
                                        c == 2 ? 8 : 12);
                for (size_t d = 0; c == 0 && d < 3; ++d) {
                    json_t* place = json_array_get(accessors, (size_t)a[0]);
                    float lo = INFINITY, hi = -INFINITY, x[3];
                    for (int corner = 0; corner < 3; ++corner) {
                        memcpy(x, g.data + offset + 32 * corner, sizeof x);
                        lo = fminf(lo, x[d]), hi = fmaxf(hi, x[d]);
                    }
                    assert_true((float)json_number_value(json_array_get(json_object_get(place, "min"), d)) == lo);
                    assert_true((float)json_number_value(json_array_get(json_object_get(place, "max"), d)) == hi);
                }
            }
        }
    }
    assert_int_equal(met_nodes, json_array_size(nodes));
    for (int t = 0; t < l->triangle_count; ++t)
        assert_true(met[t]);
    ax_free(met);
    free_glb(&g);
    free_glb(&one);
}

static void glb_keeps_its_precision_far_from_the_origin(void** state)
{
    (void)state;
    ax_design design = sample;
    size_t n = (size_t)sample.linkage.hinge_count;
    design.deployed = ax_copy(sample.deployed, n, sizeof *sample.deployed);
    for (size_t h = 0; h < n; ++h)
        design.deployed[h][0] += 4e5, design.deployed[h][1] += 5e6; // a place on a national grid
    glb g = export_glb(&design, "dome.mesh.glb", AX_STATE_DEPLOYED);
    for (int i = 0; i < 3 * sample.linkage.triangle_count; i += 3) {
        float a[3], b[3];
        memcpy(a, glb_corner(&g, "POSITION", i, 5126, "VEC3"), sizeof a);
        memcpy(b, glb_corner(&g, "POSITION", i + 1, 5126, "VEC3"), sizeof b);
        double p[3] = {a[0], a[1], a[2]}, q[3] = {b[0], b[1], b[2]}, world[3];
        const int* corner = sample.linkage.triangles[i / 3];
        assert_near(ax_distance3(p, q), ax_distance3(sample.deployed[corner[0]], sample.deployed[corner[1]]), 1e-6);
        glb_transform(&g, a, world);
        assert_near(world[2], -design.deployed[corner[0]][1], 1e-6);
    }
    free_glb(&g);
    ax_free(design.deployed);
}

static void png_is_a_picture_of_the_state(void** state)
{
    (void)state;
    static const unsigned char head[24] = {0x89, 'P', 'N',        'G',        '\r', '\n', 0x1a,       '\n',
                                           0,    0,   0,          13,         'I',  'H',  'D',        'R',
                                           0,    0,   1600 / 256, 1600 % 256, 0,    0,    1200 / 256, 1200 % 256};
    size_t size[3];
    char* bytes[3];
    for (int s = 0; s < 3; ++s) {
        bytes[s] = export_design(&sample, "dome.png", states[s], NULL, &size[s]);
        assert_memory_equal(bytes[s], head, sizeof head);
    }
    assert_true(size[0] != size[1] || memcmp(bytes[0], bytes[1], size[0]) != 0);
    for (int s = 0; s < 3; ++s)
        free(bytes[s]);
}

// --- the cut file

typedef struct stroke {
    double (*points)[2];
    int count;
    bool* begins; // a pen-up move leads here
    bool closed;
} stroke;

// Next path of the text from *at on, before `end`; its id and its attributes up to "/>" are copied.
static bool next_path(const char** at, const char* end, char id[40], char style[200], stroke* out)
{
    const char* path = strstr(*at, "<path ");
    if (!path || path > end)
        return false;
    id[0] = '\0';
    sscanf(path, "<path id=\"%39[^\"]\"", id);
    const char *d = strstr(path, " d=\"") + 4, *stop = strchr(d, '"'), *close = strstr(stop, "/>");
    snprintf(style, 200, "%.*s", (int)(close - stop - 2), stop + 2);
    *out = (stroke){.points = malloc((size_t)(stop - d + 1) * sizeof(double[2])),
                    .begins = calloc((size_t)(stop - d + 1), sizeof(bool))};
    while (d < stop) {
        char command = *d++;
        if (command == 'Z') {
            out->closed = true;
            continue;
        }
        assert_true(command == 'M' || command == 'L');
        char* after;
        out->begins[out->count] = command == 'M';
        out->points[out->count][0] = strtod(d, &after);
        out->points[out->count][1] = strtod(after, &after);
        ++out->count;
        d = after;
    }
    *at = close;
    return true;
}

static void free_stroke(stroke* s)
{
    free(s->points);
    free(s->begins);
}

static const char* layer(const char* text, const char* name, const char** end)
{
    char opening[120];
    snprintf(opening, sizeof opening, "<g inkscape:groupmode=\"layer\" inkscape:label=\"%s\" id=\"%s\">", name, name);
    const char* found = strstr(text, opening);
    assert_non_null(found);
    *end = strstr(found, "</g>");
    return found;
}

static int panel_named(const ax_linkage* l, const char* wanted)
{
    for (int t = 0; t < l->triangle_count; ++t) {
        char name[16];
        ax_panel_name(l, t, name);
        if (strcmp(name, wanted) == 0)
            return t;
    }
    fail_msg("there is no panel %s", wanted);
    return -1;
}

// All that must hold of a cut file, whatever the unit: `mm` per document unit. Returns the number of labelled panels.
static int check_cut_file(const ax_design* design, double mm, const char* text)
{
    const ax_linkage* l = &design->linkage;
    double width, height, box[2];
    const char* size = strstr(text, "width=");
    assert_int_equal(
        sscanf(size, "width=\"%lfmm\" height=\"%lfmm\" viewBox=\"0 0 %lf %lf\"", &width, &height, &box[0], &box[1]), 4);
    assert_near(width, box[0], 0);
    assert_near(height, box[1], 0);
    const char *label_end = text, *cut_end, *note_end, *labels = text; // no layer of labels if there are none
    if (strstr(text, "id=\"LABEL\""))
        labels = layer(text, "LABEL", &label_end);
    const char *cuts = layer(text, "CUT", &cut_end), *notes = layer(text, "NOTE", &note_end);
    assert_true(labels < cuts && cuts < notes); // in the order of work

    double lo[2] = {INFINITY, INFINITY}, hi[2] = {-INFINITY, -INFINITY}, shift[2] = {0, 0};
    char id[40], style[200];
    bool met[1000] = {false};
    stroke s;
    int t = 0;
    for (; next_path(&cuts, cut_end, id, style, &s); ++t) {
        assert_in_range(t, 0, l->triangle_count - 1);
        assert_string_equal(style, "fill=\"none\" stroke=\"#ff0000\" stroke-width=\"0.1\"");
        int panel = panel_named(l, id + strlen("cut-"));
        assert_false(met[panel]);
        met[panel] = true;
        assert_true(s.closed && s.count == 3);
        for (int k = 0; k < 3; ++k)
            for (int d = 0; d < 2; ++d) {
                // true size, y turned over: one shift fits all corners
                double place = (d ? -1 : 1) * mm * design->flat[l->triangles[panel][k]][d];
                if (t == 0 && k == 0)
                    shift[d] = s.points[k][d] - place;
                assert_near(s.points[k][d], place + shift[d], 1.0001e-4);
                lo[d] = fmin(lo[d], s.points[k][d]);
                hi[d] = fmax(hi[d], s.points[k][d]);
            }
        free_stroke(&s);
    }
    assert_int_equal(t, l->triangle_count);
    assert_true(lo[0] > 5 && lo[1] > 5 && hi[0] < width - 5 && hi[1] < height - 5);

    int labelled = 0;
    for (; next_path(&labels, label_end, id, style, &s); ++labelled) {
        assert_string_equal(style, "fill=\"none\" stroke=\"#000000\" stroke-width=\"0.1\"");
        int panel = panel_named(l, id + strlen("label-"));
        double top = INFINITY, bottom = -INFINITY;
        for (int i = 0; i < s.count; ++i) {
            double p[3][2];
            for (int k = 0; k < 3; ++k) {
                p[k][0] = mm * design->flat[l->triangles[panel][k]][0] + shift[0];
                p[k][1] = -mm * design->flat[l->triangles[panel][k]][1] + shift[1];
            }
            for (int k = 0; k < 3; ++k) // y points down, so the corners run clockwise
                assert_true(ax_orient2(p[k], p[(k + 1) % 3], s.points[i]) < 0);
            top = fmin(top, s.points[i][1]);
            bottom = fmax(bottom, s.points[i][1]);
        }
        assert_true(bottom - top > 2 - 1e-3 && bottom - top < 10 + 1e-3);
        free_stroke(&s);
    }
    int bars = 0, strokes = 0;
    while (next_path(&notes, note_end, id, style, &s)) {
        for (int i = 0; i < s.count; ++i, ++strokes) {
            assert_true(s.points[i][0] > 0 && s.points[i][0] < width);
            assert_true(s.points[i][1] > hi[1] && s.points[i][1] < height);
        }
        if (strcmp(id, "check-bar") == 0) {
            double left = INFINITY, right = -INFINITY;
            for (int i = 0; i < s.count; ++i)
                left = fmin(left, s.points[i][0]), right = fmax(right, s.points[i][0]);
            assert_near(right - left, 100, 0);
            ++bars;
        }
        free_stroke(&s);
    }
    assert_int_equal(bars, 1);
    assert_true(strokes > 100);
    return labelled;
}

static void svg_has_true_size_for_every_unit(void** state)
{
    (void)state;
    static const ax_unit units[] = {AX_METRE, AX_CENTIMETRE, AX_MILLIMETRE};
    static const double mm[] = {1000, 10, 1};
    for (int k = 0; k < 3; ++k) {
        ax_design design = sample;
        design.unit = units[k];
        size_t size;
        char* text = export_design(&design, "dome.svg", AX_STATE_DEFAULT, "dome 3 (test)", &size);
        assert_int_equal(check_cut_file(&design, mm[k], text), k == 0 ? sample.linkage.triangle_count : 0);
        free(text);
    }
}

static void svg_labels_only_panels_that_can_hold_two_millimetres(void** state)
{
    (void)state;
    ax_design design = sample;
    size_t n = (size_t)sample.linkage.hinge_count, size;
    design.unit = AX_MILLIMETRE;
    design.flat = ax_copy(sample.flat, n, sizeof *sample.flat);
    for (size_t h = 0; h < n; ++h)
        design.flat[h][0] *= 95, design.flat[h][1] *= 95; // edges of 8 to 14 mm
    char* text = export_design(&design, "dome.svg", AX_STATE_DEFAULT, NULL, &size);
    assert_in_range(check_cut_file(&design, 1, text), 10, sample.linkage.triangle_count - 10);
    free(text);
    ax_free(design.flat);
}

static void svg_is_the_same_wherever_the_design_lies(void** state)
{
    (void)state;
    ax_design design = sample;
    size_t n = (size_t)sample.linkage.hinge_count, size;
    design.flat = ax_copy(sample.flat, n, sizeof *sample.flat);
    for (size_t h = 0; h < n; ++h)
        design.flat[h][0] += 4e5, design.flat[h][1] -= 5e6;
    char* text = export_design(&design, "dome.svg", AX_STATE_DEFAULT, NULL, &size);
    assert_int_equal(check_cut_file(&design, 1000, text), sample.linkage.triangle_count);
    free(text);
    ax_free(design.flat);
}

static void svg_is_well_formed_whatever_the_title(void** state)
{
    (void)state;
    static const char* const titles[] = {
        NULL, "", "<dome> & \"co\"", "Kuppel \xc3\xa4\xe2\x82\xac", "broken \xff\xc3", "line\nbreak\x01"};
    for (size_t k = 0; k < sizeof titles / sizeof *titles; ++k) {
        ax_error error;
        const char* path = in_folder("dome.svg");
        if (ax_export(&sample, path, &(ax_export_options){.title = titles[k]}, &error) != AX_OK)
            fail_msg("%s", error.message);
        char command[300];
        snprintf(command, sizeof command,
                 "/usr/bin/python3 -c 'import sys, xml.dom.minidom; xml.dom.minidom.parse(sys.argv[1])' %s", path);
        if (system(command) != 0)
            fail_msg("a title of bytes like \"%s\" breaks the file", titles[k]);
        assert_int_equal(clear_folder(), 1);
    }
    size_t size;
    char* text = export_design(&sample, "dome.svg", AX_STATE_FLAT, "<dome> & co", &size);
    assert_non_null(strstr(text, "<title>&lt;dome&gt; &amp; co</title>"));
    free(text);
}

// A name of 80 letters of two bytes each, of which the last that fits whole is kept; and bytes that are no letters.
static void titles_are_whole_characters(void** state)
{
    (void)state;
    char name[161] = "x", kept[128] = "x";
    for (int k = 0; k < 79; ++k)
        memcpy(name + 1 + 2 * k, "\xc3\xa4", 3);
    for (int k = 0; k < 63; ++k)
        memcpy(kept + 1 + 2 * k, "\xc3\xa4", 3);
    const char* const titles[][2] = {{name, kept},
                                     {name + 1, NULL},
                                     {"broken \xff\xc3", "broken ??"},
                                     {"\xf0\x9f\x8f\x95 dome", "\xf0\x9f\x8f\x95 dome"}};
    ax_fabricate_options fabricate = ax_fabricate_options_default();
    fabricate.frames = 0;
    for (size_t k = 0; k < sizeof titles / sizeof *titles; ++k) {
        ax_cut_plan plan;
        ax_error error;
        const ax_export_options options = {.title = titles[k][0], .fabricate = &fabricate, .plan = &plan};
        const char* const paths[] = {in_folder("dome.plan.pdf")};
        if (ax_export_files(&sample, 1, paths, &options, &error) != AX_OK)
            fail_msg("%s", error.message);
        assert_string_equal(plan.title, titles[k][1] ? titles[k][1] : kept + 1);
        ax_cut_plan_free(&plan);
        assert_int_equal(clear_folder(), 1);
    }
}

static void sheets_are_files_beside_an_overview(void** state)
{
    (void)state;
    ax_fabricate_options fabricate = ax_fabricate_options_default();
    ax_error error;
    ax_cut_plan plan;
    assert_int_equal(ax_fabricate_set_joint(&fabricate, "ring", &error), AX_OK);
    assert_int_equal(ax_fabricate_set_material(&fabricate, "plywood-3", &error), AX_OK);
    fabricate.sheet[0] = 900, fabricate.sheet[1] = 600;
    const ax_export_options options = {.title = "dome", .fabricate = &fabricate, .plan = &plan};
    if (ax_export(&sample, in_folder("dome.svg"), &options, &error) != AX_OK)
        fail_msg("%s", error.message);
    assert_in_range(plan.sheet_count, 2, 20);
    int cuts = 0, holes = 0;
    for (int s = 0; s <= plan.sheet_count; ++s) {
        char name[40];
        snprintf(name, sizeof name, s ? "dome-%d.svg" : "dome.svg", s);
        size_t size;
        char* text = read_bytes(in_folder(name), &size);
        const char* cut = strstr(text, "id=\"CUT\"");
        assert_int_equal(cut != NULL, s > 0); // nothing of the overview is to be cut
        assert_int_equal(strstr(text, "width=\"900mm\" height=\"600mm\" viewBox=\"0 0 900 600\"") != NULL, s > 0);
        for (const char* at = text; (at = strstr(at, "<path id=\"cut-")); ++at)
            ++cuts;
        for (const char* at = text; (at = strstr(at, "<path id=\"hole-")); ++at)
            ++holes;
        free(text);
    }
    assert_int_equal(cuts, sample.linkage.triangle_count);
    assert_int_equal(holes, 3 * sample.linkage.triangle_count);
    assert_int_equal(clear_folder(), plan.sheet_count + 1);
    ax_cut_plan_free(&plan);
}

// Every format that the states allow, at once, and each by itself: the same bytes.
static void files_written_side_by_side_are_those_written_alone(void** state)
{
    (void)state;
    static const char* const names[] = {"d.svg", "d.dxf", "d.r12.dxf", "d.pdf",  "d.a4.pdf", "d.plan.pdf",
                                        "d.csv", "d.3mf", "d.obj",     "d.json", "d.glb",    "d.png"};
    enum { COUNT = sizeof names / sizeof *names };
    ax_fabricate_options fabricate = ax_fabricate_options_default();
    ax_error error;
    assert_int_equal(ax_fabricate_set_joint(&fabricate, "ring", &error), AX_OK);
    assert_int_equal(ax_fabricate_set_material(&fabricate, "plywood-3", &error), AX_OK);
    fabricate.sheet[0] = 900, fabricate.sheet[1] = 600, fabricate.frames = 0;
    ax_cut_plan plan;
    const ax_export_options options = {.title = "dome", .fabricate = &fabricate, .plan = &plan};
    char* paths[COUNT];
    for (int k = 0; k < COUNT; ++k)
        paths[k] = strdup(in_folder(names[k]));
    if (ax_export_files(&sample, COUNT, (const char* const*)paths, &options, &error) != AX_OK)
        fail_msg("%s", error.message);
    char* together[COUNT];
    size_t size[COUNT], alone;
    for (int k = 0; k < COUNT; ++k)
        together[k] = read_bytes(paths[k], &size[k]);
    assert_int_equal(clear_folder(), COUNT + 3 * plan.sheet_count);
    ax_cut_plan_free(&plan);
    for (int k = 0; k < COUNT; ++k) {
        assert_int_equal(
            ax_export(&sample, paths[k], &(ax_export_options){.title = "dome", .fabricate = &fabricate}, &error),
            AX_OK);
        char* bytes = read_bytes(paths[k], &alone);
        assert_int_equal(alone, size[k]);
        assert_memory_equal(bytes, together[k], alone);
        free(bytes);
        free(together[k]);
    }
    clear_folder();
    // one that cannot be written, and none is
    const char* const mixed[] = {paths[0], paths[1], "/nowhere/d.obj"};
    assert_int_equal(ax_export_files(&sample, 3, mixed, &options, &error), AX_FAILED);
    assert_non_null(strstr(error.message, "/nowhere/d.obj"));
    assert_int_equal(plan.sheet_count, 0);
    assert_int_equal(clear_folder(), 0);
    for (int k = 0; k < COUNT; ++k)
        free(paths[k]);
}

static void coupons_go_to_cut_files_only(void** state)
{
    (void)state;
    ax_cut_plan plan;
    ax_error error;
    assert_int_equal(ax_fabricate_coupon(AX_COUPON_KERF, NULL, &plan, &error), AX_OK);
    assert_int_equal(ax_export_plan(&plan, in_folder("kerf.svg"), &error), AX_OK);
    assert_int_equal(ax_export_plan(&plan, in_folder("kerf.obj"), &error), AX_USAGE);
    assert_int_equal(clear_folder(), 1);
    ax_cut_plan_free(&plan);
}

// --- the stroke font

typedef struct drawing {
    char text[4096];
    double left, right, low, high;
} drawing;

static void record(void* context, bool down, double x, double y)
{
    drawing* d = context;
    size_t used = strlen(d->text);
    snprintf(d->text + used, sizeof d->text - used, "%c%g,%g", down ? 'L' : 'M', x, y);
    d->left = fmin(d->left, x), d->right = fmax(d->right, x);
    d->low = fmin(d->low, y), d->high = fmax(d->high, y);
}

static drawing draw(const char* text)
{
    drawing d = {.left = INFINITY, .right = -INFINITY, .low = INFINITY, .high = -INFINITY};
    ax_stroke_text(text, record, &d);
    return d;
}

static void letters_differ_and_keep_to_their_cells(void** state)
{
    (void)state;
    static const char letters[] = "ABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789-+=.,:;/()'_%";
    drawing seen[sizeof letters];
    for (size_t k = 0; letters[k]; ++k) {
        char text[] = {letters[k], '\0'};
        seen[k] = draw(text);
        assert_int_equal(seen[k].text[0], 'M');
        assert_true(seen[k].left >= 0 && seen[k].right <= ax_stroke_width(text));
        assert_true(seen[k].low >= 0 && seen[k].high <= 1);
        for (size_t i = 0; i < k; ++i)
            assert_string_not_equal(seen[i].text, seen[k].text);
        if (letters[k] >= '0' && letters[k] <= 'Z' && letters[k] != ':' && letters[k] != ';' && letters[k] != '=')
            assert_true(seen[k].low == 0 && seen[k].high == 1);
    }
}

static void text_is_set_letter_by_letter(void** state)
{
    (void)state;
    assert_near(ax_stroke_width(""), 0, 0);
    assert_near(ax_stroke_width("C14"), 16.0 / 6, 1e-15);
    assert_near(draw("HHH").right, ax_stroke_width("HHH"), 1e-15);
    assert_string_equal(draw("c14").text, draw("C14").text);
    assert_near(ax_stroke_width("\xc3\xa4"), ax_stroke_width("A"), 0); // one character, two bytes
    assert_string_equal(draw("\xc3\xa4").text, draw("\xe2\x82\xac").text);
    assert_string_equal(draw("  ").text, "");
}

// Millions of numbers are set without printf, and must be read as the same.
static void numbers_are_set_as_printf_sets_them(void** state)
{
    (void)state;
    ax_random random = {20260531};
    print_message("seed %llu\n", (unsigned long long)random.state);
    static const double special[] = {0, -0.0, 1e-7, -1e-7, 0.5, -0.05, 9.99999995, 12345678, -999999.9999996};
    for (int k = 0; k < 20000; ++k) {
        double value = k < 9 ? special[k] : ax_random_uniform(&random, -1, 1) * pow(10, k % 7);
        int decimals = k % 9 % (12 - k % 7); // no more digits than a double holds for sure
        char expected[40];
        ax_writer w = {0};
        ax_put_fixed(&w, value, decimals);
        ax_put_words(&w, " ");
        ax_put_mm(&w, value);
        ax_put_words(&w, " ");
        ax_put_whole(&w, -k);
        ax_put_format(&w, "%c", 0);
        char *end, *mm, *whole;
        assert_near(strtod(w.at, &end), value, 0.5000001 * pow(10, -decimals));
        snprintf(expected, sizeof expected, "%.*f", decimals, value);
        const char* plain = expected + (*expected == '-' && strtod(expected, NULL) == 0); // no "-0"
        assert_int_equal(end - w.at, strlen(plain));
        if (k >= 9) // ties aside, which no random number is
            assert_memory_equal(w.at, plain, strlen(plain));
        mm = end + 1;
        assert_near(strtod(mm, &end), value, 0.5000001e-4);
        assert_true(!memchr(mm, '.', (size_t)(end - mm)) || (end[-1] != '0' && end[-1] != '.'));
        assert_int_equal(strtol(end + 1, &whole, 10), -k);
        assert_int_equal(*whole, 0);
        ax_writer_free(&w);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(exporters_are_listed_by_ending_and_complete),
        cmocka_unit_test(every_exporter_repeats_its_bytes_and_leaves_one_file),
        cmocka_unit_test(every_exporter_notices_a_full_disk_and_leaves_nothing),
        cmocka_unit_test(a_folder_that_is_not_there_is_named),
        cmocka_unit_test(endings_choose_the_format_whatever_their_case),
        cmocka_unit_test(unknown_endings_are_answered_with_the_known_ones),
        cmocka_unit_test(states_that_cannot_be_written_are_refused),
        cmocka_unit_test(design_json_holds_the_design_to_the_last_bit),
        cmocka_unit_test(design_json_reports_every_figure_and_names_every_panel),
        cmocka_unit_test(design_json_says_null_for_what_is_not_there),
        cmocka_unit_test(obj_holds_hinges_and_named_panels),
        cmocka_unit_test(stl_holds_panels_with_their_normals),
        cmocka_unit_test(ply_holds_panels_with_scale_and_colour),
        cmocka_unit_test(glb_holds_panels_in_metres_with_y_up),
        cmocka_unit_test(glb_tells_panels_apart),
        cmocka_unit_test(glb_keeps_its_precision_far_from_the_origin),
        cmocka_unit_test(png_is_a_picture_of_the_state),
        cmocka_unit_test(svg_has_true_size_for_every_unit),
        cmocka_unit_test(svg_labels_only_panels_that_can_hold_two_millimetres),
        cmocka_unit_test(svg_is_the_same_wherever_the_design_lies),
        cmocka_unit_test(svg_is_well_formed_whatever_the_title),
        cmocka_unit_test(titles_are_whole_characters),
        cmocka_unit_test(sheets_are_files_beside_an_overview),
        cmocka_unit_test(files_written_side_by_side_are_those_written_alone),
        cmocka_unit_test(coupons_go_to_cut_files_only),
        cmocka_unit_test(numbers_are_set_as_printf_sets_them),
        cmocka_unit_test(letters_differ_and_keep_to_their_cells),
        cmocka_unit_test(text_is_set_letter_by_letter),
    };
    return cmocka_run_group_tests(tests, set_up, tear_down);
}
