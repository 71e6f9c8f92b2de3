// Design JSON, version 1: connectivity, all states, forces and the report. The arrays are written as they are passed through;
// only the report becomes a tree.
#include "ax/report.h"
#include "export/writing.h"

#include <jansson.h>
#include <math.h>

static void put_number(FILE* out, double value)
{
    if (isfinite(value))
        fprintf(out, "%.17g", value);
    else
        fputs("null", out);
}

static void put_numbers(FILE* out, const double* values, int count)
{
    for (int k = 0; k < count; ++k) {
        if (k)
            putc(',', out);
        put_number(out, values[k]);
    }
}

static void put_indices(FILE* out, const int* values, int count)
{
    for (int k = 0; k < count; ++k)
        fprintf(out, k ? ",%d" : "%d", values[k]);
}

// One row to a line: text tools and people find their way, and it costs a byte.
static void put_points(FILE* out, const double* values, int count, int width)
{
    if (!values) {
        fputs("null", out);
        return;
    }
    putc('[', out);
    for (int k = 0; k < count; ++k) {
        fputs(k ? ",\n[" : "\n[", out);
        put_numbers(out, values + (size_t)k * (size_t)width, width);
        putc(']', out);
    }
    fputs("\n]", out);
}

static void put_loops(FILE* out, int count, const int* start, const int* hinges)
{
    putc('[', out);
    for (int k = 0; k < count; ++k) {
        fputs(k ? ",\n[" : "\n[", out);
        put_indices(out, hinges + start[k], start[k + 1] - start[k]);
        putc(']', out);
    }
    fputs("\n]", out);
}

static void put_triangles(FILE* out, const ax_linkage* linkage)
{
    putc('[', out);
    for (int t = 0; t < linkage->triangle_count; ++t) {
        fputs(t ? ",\n[" : "\n[", out);
        put_indices(out, linkage->triangles[t], 3);
        putc(']', out);
    }
    fputs("\n]", out);
}

static void put_supports(FILE* out, const ax_design* design)
{
    const char* comma = "";
    putc('[', out);
    for (int h = 0; h < design->linkage.hinge_count; ++h)
        if (design->supports[h]) {
            fprintf(out, "%s%d", comma, h);
            comma = ",";
        }
    putc(']', out);
}

static void put_load(FILE* out, const ax_design* design)
{
    const ax_load* load = &design->load;
    if (load->kind == AX_LOAD_NONE) {
        fputs("null", out);
        return;
    }
    bool gravity = load->kind == AX_LOAD_GRAVITY;
    fprintf(out, "{\"kind\": \"%s\", \"direction\": ", ax_load_kind_name(load->kind));
    if (gravity) {
        putc('[', out);
        put_numbers(out, load->direction, 3);
        putc(']', out);
    } else
        fputs("null", out);
    fputs(", \"pressure\": ", out);
    put_number(out, gravity ? NAN : load->pressure);
    fputs(", \"density\": ", out);
    put_number(out, gravity ? load->density : NAN);
    fputs(",\n\"forces\": ", out);
    put_points(out, (const double*)design->forces, design->linkage.hinge_count, 3);
    putc('}', out);
}

static json_t* number(double value)
{
    return isfinite(value) ? json_real(value) : json_null();
}

static json_t* figure(const ax_figure* figure, const ax_report* report, int k)
{
    double value = ax_figure_value(figure, report, k);
    switch (figure->kind) {
    case AX_FIGURE_COUNT:
        return json_integer((json_int_t)value);
    case AX_FIGURE_FLAG:
        return json_boolean(value != 0);
    case AX_FIGURE_NUMBER:
        break;
    }
    return number(value);
}

// All of the report but the panels' names, of which there may be a million.
static json_t* report_tree(const ax_design* design)
{
    json_t* tree = json_object();
    int count;
    const ax_figure* figures = ax_report_figures(&count);
    for (int k = 0; k < count; ++k) {
        json_t* value = figures[k].count > 1 ? json_array() : figure(&figures[k], &design->report, 0);
        for (int i = 0; i < figures[k].count && figures[k].count > 1; ++i)
            json_array_append_new(value, figure(&figures[k], &design->report, i));
        json_object_set_new(tree, figures[k].key, value);
    }
    const ax_mesh_repairs* r = &design->repairs;
    json_object_set_new(tree, "repairs",
                        json_pack("{s:i, s:i, s:i, s:i, s:i, s:b}", "welded_vertices", r->welded_vertices,
                                  "degenerate_faces", r->degenerate_faces, "duplicate_faces", r->duplicate_faces,
                                  "unused_vertices", r->unused_vertices, "flipped_faces", r->flipped_faces,
                                  "turned_outward", r->turned_outward));
    const ax_projection* p = &design->projection;
    json_object_set_new(tree, "projection",
                        design->projected
                            ? json_pack("{s:o, s:o, s:o, s:o, s:i}", "moved_area_share", number(p->moved_area_share),
                                        "largest_move", number(p->largest_move), "curvature_min",
                                        number(p->curvature_min), "nonpositive_share", number(p->nonpositive_share),
                                        "steps", p->steps)
                            : json_null());
    json_object_set_new(tree, "scale_ratio", number(design->scale_ratio));
    json_object_set_new(tree, "mouth_min", number(design->mouth_min));
    json_object_set_new(tree, "border", json_string(ax_border_name(design->border)));
    return tree;
}

static void put_report(FILE* out, const ax_design* design)
{
    json_t* tree = report_tree(design);
    putc('{', out);
    json_dumpf(tree, out, JSON_EMBED | JSON_REAL_PRECISION(17));
    json_decref(tree);
    fputs(", \"panels\": [", out);
    for (int t = 0; t < design->linkage.triangle_count; ++t) {
        char name[16];
        ax_panel_name(&design->linkage, t, name);
        fprintf(out, t ? ",\n\"%s\"" : "\n\"%s\"", name);
    }
    fputs("\n]}", out);
}

static ax_status write_json(const ax_design* design, ax_state state, const ax_export_options* options, const char* path,
                            ax_error* error)
{
    (void)state; // it holds them all
    (void)options;
    FILE* out = ax_export_open(path, error);
    if (!out)
        return AX_FAILED;
    const ax_linkage* linkage = &design->linkage;
    int hinges = linkage->hinge_count, triangles = linkage->triangle_count;
    fprintf(out, "{\"format\": \"auxshell-design\", \"version\": 1, \"units\": \"%s\",\n\"triangles\": ",
            ax_unit_name(design->unit));
    put_triangles(out, linkage);
    fputs(",\n\"holes\": ", out);
    put_loops(out, linkage->hole_count, linkage->hole_start, linkage->hole_hinges);
    fputs(",\n\"openings\": ", out);
    put_loops(out, linkage->opening_count, linkage->opening_start, linkage->opening_hinges);
    fputs(",\n\"supports\": ", out);
    put_supports(out, design);
    fputs(",\n\"flat\": ", out);
    put_points(out, (const double*)design->flat, hinges, 2);
    fputs(",\n\"deployed\": ", out);
    put_points(out, (const double*)design->deployed, hinges, 3);
    fputs(",\n\"simulated\": ", out);
    put_points(out, (const double*)design->simulated, hinges, 3);
    fputs(",\n\"scale\": [", out);
    put_numbers(out, design->scale, triangles);
    fputs("],\n\"load\": ", out);
    put_load(out, design);
    fputs(",\n\"edge_forces\": ", out);
    put_points(out, (const double*)design->edge_forces, triangles, 3);
    fputs(",\n\"report\": ", out);
    put_report(out, design);
    fputs("}\n", out);
    return ax_export_close(out, path, error);
}

const ax_export_type ax_export_json = {
    .ending = ".json",
    .name = "design JSON",
    .doc = "Everything of the design: connectivity, all states, forces, scale factors and the report.",
    .default_state = AX_STATE_DEPLOYED,
    .states = {true, true, true, true},
    .write = write_json,
};
