#include "ax/document.h"

#include "ax/report.h"
#include "base/file.h"
#include "document/load.h"
#include "document/rows.h"
#include "mesh/manifold.h"

#include <errno.h>
#include <limits.h>
#include <stdio.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

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

// Everything of one save that can fail in SQLite.
static int write_database(sqlite3* db, ax_design* design)
{
    char identify[64];
    snprintf(identify, sizeof identify, "PRAGMA application_id = %d", AX_DOCUMENT_ID);
    // the file is thrown away if anything fails, and made durable as a whole
    int result = sqlite3_exec(db, "PRAGMA journal_mode = OFF; PRAGMA synchronous = OFF", NULL, NULL, NULL);
    if (result == SQLITE_OK)
        result = sqlite3_exec(db, identify, NULL, NULL, NULL);
    if (result == SQLITE_OK)
        result = sqlite3_exec(db, "BEGIN", NULL, NULL, NULL);
    if (result == SQLITE_OK)
        result = ax_schema_upgrade(&ax_document_schema, db, 0, ax_document_schema.version);
    if (result != SQLITE_OK)
        return result;
    ax_rows rows = ax_rows_begin(db, false);
    describe(&rows, design);
    result = rows.result;
    ax_rows_end(&rows);
    if (result == SQLITE_OK)
        result = ax_schema_seal(db);
    return result == SQLITE_OK ? sqlite3_exec(db, "COMMIT", NULL, NULL, NULL) : result;
}

ax_status ax_document_save(const char* path, const ax_design* design, ax_error* error)
{
    ax_file file;
    ax_status status = ax_file_begin_path(&file, path, error);
    if (status != AX_OK)
        return status;
    sqlite3* db = NULL;
    ax_design seen = *design; // saving changes nothing; the description serves loading too
    int result = sqlite3_open_v2(file.path, &db, SQLITE_OPEN_READWRITE | SQLITE_OPEN_NOMUTEX, NULL);
    if (result == SQLITE_OK)
        result = write_database(db, &seen);
    char reason[256];
    snprintf(reason, sizeof reason, "%s", result == SQLITE_OK ? "" : sqlite3_errmsg(db));
    if (sqlite3_close(db) != SQLITE_OK && result == SQLITE_OK)
        result = SQLITE_ERROR;
    if (result == SQLITE_OK)
        return ax_file_commit(&file, error);
    status = ax_fail(error, AX_FAILED, "Cannot write %s: %s. Nothing was changed.", path, reason);
    ax_file_abandon(&file);
    return status;
}

static ax_status fail_damaged(const char* path, const char* what, ax_error* error)
{
    return ax_fail(error, AX_BAD_INPUT, "%s is damaged: %s. Use an earlier copy, or design it again.", path, what);
}

// SQLite's own troubles while reading: the file is damaged, or it cannot be read now.
static ax_status fail_reading(const char* path, sqlite3* db, int result, ax_error* error)
{
    switch (result & 0xff) {
    case SQLITE_NOTADB:
        return ax_fail(error, AX_BAD_INPUT,
                       "%s is not an Auxshell document. Give a file that the design command has written.", path);
    case SQLITE_BUSY:
    case SQLITE_LOCKED:
        return ax_fail(error, AX_FAILED, "%s is being changed by another program. Try again when it is done.", path);
    case SQLITE_NOMEM:
    case SQLITE_IOERR:
    case SQLITE_CANTOPEN:
    case SQLITE_READONLY:
        return ax_fail(error, AX_FAILED, "Cannot read %s: %s.", path, sqlite3_errmsg(db));
    default:
        return fail_damaged(path, sqlite3_errmsg(db), error);
    }
}

static ax_status check_file(const char* path, ax_error* error)
{
    struct stat info;
    if (stat(path, &info) != 0)
        return errno == ENOENT ? ax_fail(error, AX_BAD_INPUT, "There is no file %s.", path)
                               : ax_fail(error, AX_BAD_INPUT, "Cannot read %s: %s.", path, strerror(errno));
    if (S_ISDIR(info.st_mode))
        return ax_fail(error, AX_BAD_INPUT, "%s is a folder. Give the name of a document.", path);
    if (!S_ISREG(info.st_mode))
        return ax_fail(error, AX_BAD_INPUT, "%s is not a file.", path);
    if (access(path, R_OK) != 0)
        return ax_fail(error, AX_BAD_INPUT, "Cannot read %s: %s.", path, strerror(errno));
    return AX_OK;
}

static int read_pragma(sqlite3* db, const char* sql, int* value)
{
    sqlite3_stmt* statement = NULL;
    int result = sqlite3_prepare_v2(db, sql, -1, &statement, NULL);
    if (result == SQLITE_OK && (result = sqlite3_step(statement)) == SQLITE_ROW) {
        *value = sqlite3_column_int(statement, 0);
        result = SQLITE_OK;
    }
    sqlite3_finalize(statement);
    return result;
}

// Replaces `db` by an upgraded copy in memory: looking at a document never changes its file.
static int upgrade_in_memory(const ax_schema* schema, sqlite3** db, int version)
{
    sqlite3* copy = NULL;
    int result = sqlite3_open_v2(":memory:", &copy, SQLITE_OPEN_READWRITE | SQLITE_OPEN_NOMUTEX, NULL);
    sqlite3_backup* backup = result == SQLITE_OK ? sqlite3_backup_init(copy, "main", *db, "main") : NULL;
    if (backup) {
        sqlite3_backup_step(backup, -1);
        result = sqlite3_backup_finish(backup);
    }
    if (result == SQLITE_OK)
        result = ax_schema_upgrade(schema, copy, version, schema->version);
    sqlite3_close(*db);
    *db = copy;
    return result;
}

// Checks that an open database is a sound document and brings it to the schema's version.
static ax_status accept_database(const ax_schema* schema, const char* path, sqlite3** db, ax_error* error)
{
    int id = 0, version = 0;
    bool sound = false;
    int result = read_pragma(*db, "PRAGMA application_id", &id);
    if (result == SQLITE_OK)
        result = read_pragma(*db, "PRAGMA user_version", &version);
    if (result != SQLITE_OK)
        return fail_reading(path, *db, result, error);
    if (id != AX_DOCUMENT_ID)
        return ax_fail(error, AX_BAD_INPUT,
                       "%s is not an Auxshell document%s. Give a file that the design command has written.", path,
                       id || version ? " but a database of another program" : "");
    if (version > schema->version)
        return ax_fail(error, AX_BAD_INPUT,
                       "%s is a document of version %d, written by a newer Auxshell; version %s reads up to %d. Use "
                       "the newer one.",
                       path, version, ax_version(), schema->version);
    if (version < 1 || !ax_schema_matches(schema, *db, version))
        return fail_damaged(path, "its tables are not those of a document", error);
    result = ax_schema_check_seal(*db, &sound);
    if (result != SQLITE_OK)
        return fail_reading(path, *db, result, error);
    if (!sound)
        return fail_damaged(path, "its contents are not what was saved", error);
    if (version < schema->version)
        result = upgrade_in_memory(schema, db, version);
    return result == SQLITE_OK ? AX_OK : fail_reading(path, *db, result, error);
}

static ax_status read_design(const char* path, sqlite3* db, ax_design* design, ax_error* error)
{
    ax_rows rows = ax_rows_begin(db, true);
    describe(&rows, design);
    ax_status status = AX_OK;
    char what[600];
    if (rows.damaged[0]) {
        snprintf(what, sizeof what, "it lacks a sound value for \"%s\"", rows.damaged);
        status = fail_damaged(path, what, error);
    } else if (rows.result != SQLITE_OK)
        status = fail_reading(path, db, rows.result, error);
    ax_rows_end(&rows);
    ax_error inner;
    if (status == AX_OK && check_design(design, &inner) != AX_OK) {
        inner.message[strlen(inner.message) - 1] = '\0'; // it becomes a part of a sentence
        snprintf(what, sizeof what, "%.500s", inner.message);
        status = fail_damaged(path, what, error);
    }
    return status;
}

ax_status ax_document_load_as(const ax_schema* schema, const char* path, ax_design* design, ax_error* error)
{
    *design = (ax_design){0};
    ax_status status = check_file(path, error);
    if (status != AX_OK)
        return status;
    sqlite3* db = NULL;
    int result = sqlite3_open_v2(path, &db, SQLITE_OPEN_READONLY | SQLITE_OPEN_NOMUTEX, NULL);
    if (result == SQLITE_OK) {
        sqlite3_busy_timeout(db, 2000);
        // see "Defense Against Dark Arts" in SQLite's documentation
        result = sqlite3_exec(db, "PRAGMA trusted_schema = OFF; PRAGMA cell_size_check = ON; PRAGMA mmap_size = 0",
                              NULL, NULL, NULL);
    }
    ax_design loaded = {0};
    status = result == SQLITE_OK ? accept_database(schema, path, &db, error) : fail_reading(path, db, result, error);
    if (status == AX_OK)
        status = read_design(path, db, &loaded, error);
    sqlite3_close(db);
    if (status == AX_OK)
        *design = loaded;
    else
        ax_design_free(&loaded);
    return status;
}

ax_status ax_document_load(const char* path, ax_design* design, ax_error* error)
{
    return ax_document_load_as(&ax_document_schema, path, design, error);
}
