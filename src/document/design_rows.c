#include "document/design_rows.h"

#include "ax/report.h"
#include "document/opening.h"
#include "document/rows.h"
#include "document/sql.h"
#include "mesh/manifold.h"

#include <limits.h>
#include <stdio.h>
#include <string.h>

// Loops of hinges in CSR form.
static void describe_loops(ax_rows* rows, const char* start_name, const char* hinges_name, int count, int** start,
                           int** hinges)
{
    *start = ax_rows_array(rows, start_name, AX_I32, 1, count + 1, false, *start);
    if (!ax_rows_sound(rows))
        return;
    bool rising = (*start)[0] == 0;
    for (int k = 0; k < count; ++k)
        rising = rising && (*start)[k] <= (*start)[k + 1];
    if (rising)
        *hinges = ax_rows_array(rows, hinges_name, AX_I32, 1, (*start)[count], false, *hinges);
    else
        ax_rows_damaged(rows, start_name);
}

static void describe_linkage(ax_rows* rows, ax_linkage* linkage)
{
    // 12 bytes a triangle: no blob of SQLite's holds more
    ax_rows_whole(rows, "triangle_count", &linkage->triangle_count, 1, 100000000);
    ax_rows_whole(rows, "hinge_count", &linkage->hinge_count, 1, 3 * 100000000);
    ax_rows_whole(rows, "hole_count", &linkage->hole_count, 0, 100000000);
    ax_rows_whole(rows, "opening_count", &linkage->opening_count, 0, 100000000);
    int triangles = linkage->triangle_count, hinges = linkage->hinge_count;
    linkage->triangles = ax_rows_array(rows, "triangles", AX_I32, 3, triangles, false, linkage->triangles);
    linkage->panels = ax_rows_array(rows, "panels", AX_I32, 3, triangles, false, linkage->panels);
    describe_loops(rows, "hole_start", "hole_hinges", linkage->hole_count, &linkage->hole_start, &linkage->hole_hinges);
    describe_loops(rows, "opening_start", "opening_hinges", linkage->opening_count, &linkage->opening_start,
                   &linkage->opening_hinges);
    linkage->on_rim = ax_rows_array(rows, "on_rim", AX_U8, 1, hinges, false, linkage->on_rim);
}

static void describe_load(ax_rows* rows, ax_load* load)
{
    char text[16];
    if (ax_rows_word(rows, "load", ax_load_kind_name(load->kind), text) && !ax_load_kind_parse(text, &load->kind))
        ax_rows_damaged(rows, "load");
    ax_rows_real(rows, "load_direction_x", &load->direction[0]);
    ax_rows_real(rows, "load_direction_y", &load->direction[1]);
    ax_rows_real(rows, "load_direction_z", &load->direction[2]);
    ax_rows_real(rows, "load_pressure", &load->pressure);
    ax_rows_real(rows, "load_density", &load->density);
}

static void describe_origin(ax_rows* rows, ax_design* design)
{
    ax_mesh* target = &design->target;
    ax_rows_whole(rows, "target_vertex_count", &target->vertex_count, 0, 100000000);
    ax_rows_whole(rows, "target_face_count", &target->face_count, 0, 100000000);
    target->positions =
        ax_rows_array(rows, "target_positions", AX_F64, 3, target->vertex_count, true, target->positions);
    target->faces = ax_rows_array(rows, "target_faces", AX_I32, 3, target->face_count, true, target->faces);

    ax_mesh_repairs* r = &design->repairs;
    ax_rows_whole(rows, "repaired_welded_vertices", &r->welded_vertices, 0, INT_MAX);
    ax_rows_whole(rows, "repaired_degenerate_faces", &r->degenerate_faces, 0, INT_MAX);
    ax_rows_whole(rows, "repaired_duplicate_faces", &r->duplicate_faces, 0, INT_MAX);
    ax_rows_whole(rows, "repaired_unused_vertices", &r->unused_vertices, 0, INT_MAX);
    ax_rows_whole(rows, "repaired_flipped_faces", &r->flipped_faces, 0, INT_MAX);
    ax_rows_flag(rows, "repaired_turned_outward", &r->turned_outward);

    ax_projection* p = &design->projection;
    ax_rows_flag(rows, "projected", &design->projected);
    ax_rows_real(rows, "projection_moved_area_share", &p->moved_area_share);
    ax_rows_real(rows, "projection_largest_move", &p->largest_move);
    ax_rows_real(rows, "projection_curvature_min", &p->curvature_min);
    ax_rows_real(rows, "projection_nonpositive_share", &p->nonpositive_share);
    ax_rows_whole(rows, "projection_steps", &p->steps, 0, INT_MAX);
}

// Every figure is a property of its own, so that SQL can ask for it: report.edge_mean, report.flat_bounds.1
static void describe_report(ax_rows* rows, ax_report* report)
{
    int count;
    const ax_figure* figures = ax_report_figures(&count);
    for (int f = 0; f < count; ++f)
        for (int k = 0; k < figures[f].count; ++k) {
            char name[96];
            if (figures[f].count > 1)
                snprintf(name, sizeof name, "report.%s.%d", figures[f].key, k);
            else
                snprintf(name, sizeof name, "report.%s", figures[f].key);
            double value = ax_figure_value(&figures[f], report, k);
            int whole = figures[f].kind == AX_FIGURE_NUMBER ? 0 : (int)value;
            if (figures[f].kind == AX_FIGURE_NUMBER)
                ax_rows_real(rows, name, &value);
            else
                ax_rows_whole(rows, name, &whole, INT_MIN, INT_MAX);
            if (rows->loading && ax_rows_sound(rows))
                ax_figure_set(&figures[f], report, k, figures[f].kind == AX_FIGURE_NUMBER ? value : whole);
        }
}

// All of a design, for saving and for loading.
static void describe(ax_rows* rows, ax_design* design)
{
    char text[16];
    if (ax_rows_word(rows, "unit", ax_unit_name(design->unit), text) && !ax_unit_parse(text, &design->unit))
        ax_rows_damaged(rows, "unit");
    if (ax_rows_word(rows, "border", ax_border_name(design->border), text) && !ax_border_parse(text, &design->border))
        ax_rows_damaged(rows, "border");
    ax_rows_real(rows, "scale_ratio", &design->scale_ratio);
    ax_rows_real(rows, "mouth_min", &design->mouth_min);
    describe_linkage(rows, &design->linkage);
    int triangles = design->linkage.triangle_count, hinges = design->linkage.hinge_count;
    design->flat = ax_rows_array(rows, "flat", AX_F64, 2, hinges, false, design->flat);
    design->deployed = ax_rows_array(rows, "deployed", AX_F64, 3, hinges, false, design->deployed);
    design->simulated = ax_rows_array(rows, "simulated", AX_F64, 3, hinges, true, design->simulated);
    design->scale = ax_rows_array(rows, "scale", AX_F64, 1, triangles, false, design->scale);
    design->supports = ax_rows_array(rows, "supports", AX_U8, 1, hinges, false, design->supports);
    describe_load(rows, &design->load);
    design->forces = ax_rows_array(rows, "forces", AX_F64, 3, hinges, true, design->forces);
    design->edge_forces = ax_rows_array(rows, "edge_forces", AX_F64, 3, triangles, true, design->edge_forces);
    describe_origin(rows, design);
    describe_report(rows, &design->report);
}

// What the arrays say to each other. The seal keeps accidents out; this keeps out what a foreign program has sealed.
static ax_status check_design(const ax_design* design, ax_error* error)
{
    const ax_linkage* linkage = &design->linkage;
    const ax_report* r = &design->report;
    int hinges = linkage->hinge_count, triangles = linkage->triangle_count, face;
    for (int h = 0; h < hinges; ++h)
        if (linkage->on_rim[h] > 1 || design->supports[h] > 1)
            return ax_fail(error, AX_BAD_INPUT, "The marks of hinge %d are neither 0 nor 1.", h);
    if (!design->simulated != !design->forces || !design->simulated != !design->edge_forces)
        return ax_fail(error, AX_BAD_INPUT, "The simulated state lacks its forces, or the forces their state.");
    const ax_mesh* target = &design->target;
    if ((target->vertex_count && !target->positions) || (target->face_count && !target->faces))
        return ax_fail(error, AX_BAD_INPUT, "The target surface is not there.");
    if (target->face_count && !ax_mesh_is_manifold(target, &face))
        return ax_fail(error, AX_BAD_INPUT, "Face %d of the target surface is wrong.", face);
    if (r->mouth_min_hinge < -1 || r->mouth_min_hinge >= hinges || r->simulated_max_hinge < -1 ||
        r->simulated_max_hinge >= hinges || r->overlap_first[0] < -1 || r->overlap_first[0] >= triangles ||
        r->overlap_first[1] < -1 || r->overlap_first[1] >= triangles)
        return ax_fail(error, AX_BAD_INPUT, "The report names hinges or triangles that do not exist.");
    return ax_linkage_check(linkage, error);
}

int ax_design_remove(sqlite3* db, sqlite3_int64 number)
{
    int result = ax_sql_run(db, "DELETE FROM property WHERE design = ?1", "i", (int64_t)number);
    return result == SQLITE_OK ? ax_sql_run(db, "DELETE FROM array WHERE design = ?1", "i", (int64_t)number) : result;
}

int ax_design_store(sqlite3* db, sqlite3_int64 number, const ax_design* design)
{
    int result = ax_design_remove(db, number);
    if (result != SQLITE_OK)
        return result;
    ax_design seen = *design; // storing changes nothing; the description serves loading too
    ax_rows rows = ax_rows_begin(db, number, false);
    describe(&rows, &seen);
    result = rows.result;
    ax_rows_end(&rows);
    return result;
}

bool ax_design_stored(sqlite3* db, sqlite3_int64 number)
{
    int result = SQLITE_OK;
    sqlite3_stmt* row = ax_sql_ask(db, "SELECT 1 FROM property WHERE design = ?1 LIMIT 1", "i", (int64_t)number);
    bool stored = ax_sql_next(row, &result);
    sqlite3_finalize(row);
    return stored;
}

ax_status ax_design_fetch(const char* path, sqlite3* db, sqlite3_int64 number, ax_design* design, ax_error* error)
{
    *design = (ax_design){0};
    ax_rows rows = ax_rows_begin(db, number, true);
    describe(&rows, design);
    ax_status status = AX_OK;
    char what[600];
    if (rows.damaged[0]) {
        snprintf(what, sizeof what, "it lacks a sound value for \"%s\"", rows.damaged);
        status = ax_fail_damaged(path, what, error);
    } else if (rows.result != SQLITE_OK)
        status = ax_fail_reading(path, db, rows.result, error);
    ax_rows_end(&rows);
    ax_error inner;
    if (status == AX_OK && check_design(design, &inner) != AX_OK) {
        inner.message[strlen(inner.message) - 1] = '\0'; // it becomes a part of a sentence
        snprintf(what, sizeof what, "%.500s", inner.message);
        status = ax_fail_damaged(path, what, error);
    }
    if (status != AX_OK)
        ax_design_free(design);
    return status;
}
