#include "document/history.h"

#include "document/design_rows.h"
#include "document/schema.h"
#include "document/sql.h"

#include <limits.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

// Forms of 2,500 triangles have 2 MB. Those of the last moments may fill more, since undo should not compute.
enum { most_checkpoints = 64, most_designs = 4, last_moments = 20, stride = 10 };
static const int64_t most_bytes = (int64_t)256 << 20, most_old_bytes = (int64_t)64 << 20;

static char* column_text(sqlite3_stmt* row, int column)
{
    return ax_copy_text((const char*)sqlite3_column_text(row, column));
}

static bool column_whole(sqlite3_stmt* row, int column, int* value)
{
    sqlite3_int64 stored = sqlite3_column_int64(row, column);
    *value = (int)stored;
    return sqlite3_column_type(row, column) == SQLITE_INTEGER && stored >= 0 && stored < INT_MAX;
}

int ax_history_moment(sqlite3* db, int number, ax_present* out)
{
    *out = (ax_present){.now = number};
    int result = SQLITE_OK;
    sqlite3_stmt* row =
        ax_sql_ask(db, "SELECT tip, state, steps, at, failure FROM moment WHERE number = ?1", "i", (int64_t)number);
    bool found = ax_sql_next(row, &result);
    if (found) {
        out->tip = sqlite3_column_int64(row, 0);
        out->state = sqlite3_column_int64(row, 1);
        found = column_whole(row, 2, &out->steps) && column_whole(row, 3, &out->at) && out->at <= out->steps;
        out->failure = column_text(row, 4);
    }
    sqlite3_finalize(row);
    return result == SQLITE_OK && !found ? SQLITE_CORRUPT : result;
}

int ax_history_present(sqlite3* db, ax_present* out, char** folder)
{
    *out = (ax_present){0};
    *folder = NULL;
    int result = SQLITE_OK, now = 0;
    sqlite3_stmt* row = ax_sql_ask(db, "SELECT now, folder FROM session", "");
    if (ax_sql_next(row, &result) && column_whole(row, 0, &now))
        *folder = column_text(row, 1);
    sqlite3_finalize(row);
    if (result == SQLITE_OK)
        result = *folder ? ax_history_moment(db, now, out) : SQLITE_CORRUPT;
    return result;
}

int ax_history_moments(sqlite3* db, ax_moment** moments, int* count)
{
    *moments = NULL;
    *count = 0;
    int result = SQLITE_OK, capacity = 0, number;
    sqlite3_stmt* rows = ax_sql_ask(db, "SELECT number, steps, at, words, time FROM moment ORDER BY number", "");
    while (ax_sql_next(rows, &result)) {
        if (*count == capacity) {
            capacity = 2 * capacity + 16;
            *moments = ax_realloc(*moments, (size_t)capacity, sizeof **moments);
        }
        ax_moment m = {.time = NAN};
        bool sound = column_whole(rows, 0, &number) && number == *count && column_whole(rows, 1, &m.steps) &&
                     column_whole(rows, 2, &m.at);
        if (sqlite3_column_type(rows, 4) != SQLITE_NULL)
            m.time = sqlite3_column_double(rows, 4);
        m.words = column_text(rows, 3);
        if (!sound || !m.words) {
            ax_free((char*)m.words);
            result = SQLITE_CORRUPT;
            break;
        }
        (*moments)[(*count)++] = m;
    }
    sqlite3_finalize(rows);
    return result;
}

void ax_history_moments_free(ax_moment* moments, int count)
{
    for (int k = 0; k < count; ++k)
        ax_free((char*)moments[k].words);
    ax_free(moments);
}

int ax_history_path(sqlite3* db, int64_t tip, int count, int64_t* ids)
{
    int result = SQLITE_OK;
    sqlite3_stmt* row = ax_sql_ask(db, "SELECT parent FROM step WHERE id = ?1", "");
    if (!row)
        return sqlite3_errcode(db);
    int64_t id = tip;
    for (int k = count; k > 0 && result == SQLITE_OK; --k) {
        ids[k] = id;
        sqlite3_bind_int64(row, 1, id);
        if (id > 0 && ax_sql_next(row, &result))
            id = sqlite3_column_int64(row, 0);
        else if (result == SQLITE_OK)
            result = SQLITE_CORRUPT;
        sqlite3_reset(row);
    }
    ids[0] = 0;
    sqlite3_finalize(row);
    return result == SQLITE_OK && id != 0 ? SQLITE_CORRUPT : result;
}

int ax_history_operator(sqlite3* db, int64_t step, char** json)
{
    int result = SQLITE_OK;
    sqlite3_stmt* row = ax_sql_ask(db, "SELECT operator FROM step WHERE id = ?1", "i", step);
    *json = ax_sql_next(row, &result) ? column_text(row, 0) : NULL;
    sqlite3_finalize(row);
    return result == SQLITE_OK && !*json ? SQLITE_CORRUPT : result;
}

int ax_history_find(sqlite3* db, int64_t parent, const char* json, int64_t* step)
{
    int result = SQLITE_OK;
    sqlite3_stmt* row = ax_sql_ask(db, "SELECT id FROM step WHERE parent = ?1 AND operator = ?2", "it", parent, json);
    *step = ax_sql_next(row, &result) ? sqlite3_column_int64(row, 0) : -1;
    sqlite3_finalize(row);
    return result;
}

// Of the step too: a form under another's number would be a sound one all the same.
static int64_t digest_checkpoint(int64_t step, const void* form, size_t size)
{
    return (int64_t)ax_schema_digest(ax_schema_digest(0, &step, sizeof step), form, size);
}

const void* ax_history_checkpoint(sqlite3* db, int64_t step, size_t* size, sqlite3_stmt** row)
{
    int result = SQLITE_OK;
    *row = ax_sql_ask(db, "SELECT form, digest FROM checkpoint WHERE step = ?1", "i", step);
    if (!ax_sql_next(*row, &result))
        return NULL;
    const void* form = sqlite3_column_blob(*row, 0);
    *size = (size_t)sqlite3_column_bytes(*row, 0);
    return form && digest_checkpoint(step, form, *size) == sqlite3_column_int64(*row, 1) ? form : NULL;
}

int ax_history_keep(sqlite3* db, int64_t step, const void* form, size_t size)
{
    return ax_sql_run(db, "INSERT OR REPLACE INTO checkpoint VALUES(?1, ?2, ?3)", "ibi", step, form, size,
                      digest_checkpoint(step, form, size));
}

int ax_history_add_step(sqlite3* db, int64_t parent, const char* json, int64_t* step)
{
    int result = ax_sql_run(db, "INSERT INTO step(parent, operator) VALUES(?1, ?2)", "it", parent, json);
    *step = sqlite3_last_insert_rowid(db);
    return result;
}

int ax_history_file(sqlite3* db, int64_t step, char** bytes, size_t* size)
{
    int result = SQLITE_OK;
    sqlite3_stmt* row = ax_sql_ask(db, "SELECT data FROM file WHERE step = ?1", "i", step);
    *bytes = NULL, *size = 0;
    if (ax_sql_next(row, &result)) {
        const void* data = sqlite3_column_blob(row, 0); // before its length, as SQLite asks
        *size = (size_t)sqlite3_column_bytes(row, 0);
        *bytes = data ? ax_copy(data, *size, 1) : NULL;
    }
    sqlite3_finalize(row);
    return result;
}

// Nothing is written if it is there already, so that playing a step again costs no writing.
int ax_history_keep_file(sqlite3* db, int64_t step, const char* name, const char* bytes, size_t size)
{
    return ax_sql_run(db,
                      "INSERT INTO file VALUES(?1, ?2, ?3) ON CONFLICT(step) DO UPDATE SET data = ?3 WHERE data <> ?3",
                      "itb", step, name, bytes, size);
}

// What no moment and no variant leads to any more.
static int drop_unreachable(sqlite3* db)
{
    static const char* const statements[] = {
        ("DELETE FROM step WHERE id NOT IN (WITH RECURSIVE live(id) AS (SELECT tip FROM moment UNION SELECT tip FROM"
         " variant UNION SELECT parent FROM step JOIN live USING(id)) SELECT id FROM live)"),
        "DELETE FROM checkpoint WHERE step <> 0 AND step NOT IN (SELECT id FROM step)",
        "DELETE FROM file WHERE step NOT IN (SELECT id FROM step)",
        "DELETE FROM property WHERE design <> 0 AND design NOT IN (SELECT id FROM step)",
        "DELETE FROM array WHERE design <> 0 AND design NOT IN (SELECT id FROM step)",
    };
    int result = SQLITE_OK;
    for (size_t k = 0; k < sizeof statements / sizeof *statements && result == SQLITE_OK; ++k)
        result = ax_sql_run(db, statements[k], "");
    return result;
}

int ax_history_variants(sqlite3* db, ax_kept_variant** variants, int* count)
{
    *variants = NULL;
    *count = 0;
    int result = SQLITE_OK, capacity = 0;
    sqlite3_stmt* rows =
        ax_sql_ask(db, "SELECT name, tip, state, steps, at, time, figures FROM variant ORDER BY rowid", "");
    while (ax_sql_next(rows, &result)) {
        if (*count == capacity) {
            capacity = 2 * capacity + 8;
            *variants = ax_realloc(*variants, (size_t)capacity, sizeof **variants);
        }
        ax_kept_variant* v = &(*variants)[(*count)++];
        *v = (ax_kept_variant){.name = column_text(rows, 0),
                               .tip = sqlite3_column_int64(rows, 1),
                               .state = sqlite3_column_int64(rows, 2),
                               .time = sqlite3_column_double(rows, 5),
                               .figures = column_text(rows, 6)};
        if (!v->name || !v->figures || !column_whole(rows, 3, &v->steps) || !column_whole(rows, 4, &v->at) ||
            v->at > v->steps) {
            result = SQLITE_CORRUPT;
            break;
        }
    }
    sqlite3_finalize(rows);
    return result;
}

void ax_history_variants_free(ax_kept_variant* variants, int count)
{
    for (int k = 0; k < count; ++k) {
        ax_free(variants[k].name);
        ax_free(variants[k].figures);
    }
    ax_free(variants);
}

int ax_history_keep_variant(sqlite3* db, const char* name, const ax_present* p, double time, const char* figures)
{
    // it keeps its place in the list, and what it was is gone
    int result = ax_sql_run(db,
                            "INSERT INTO variant VALUES(?1, ?2, ?3, ?4, ?5, ?6, ?7) ON CONFLICT(name) DO UPDATE SET"
                            " tip = ?2, state = ?3, steps = ?4, at = ?5, time = ?6, figures = ?7",
                            "tiiiidt", name, p->tip, p->state, (int64_t)p->steps, (int64_t)p->at, time, figures);
    return result == SQLITE_OK ? drop_unreachable(db) : result;
}

int ax_history_drop_variant(sqlite3* db, const char* name)
{
    int result = ax_sql_run(db, "DELETE FROM variant WHERE name = ?1", "t", name);
    return result == SQLITE_OK ? drop_unreachable(db) : result;
}

int ax_history_go(sqlite3* db, int moment)
{
    return ax_sql_run(db, "UPDATE session SET now = ?1", "i", (int64_t)moment);
}

int ax_history_add_moment(sqlite3* db, const ax_present* p, const char* words, double time)
{
    int result = ax_sql_run(db, "DELETE FROM moment WHERE number >= ?1", "i", (int64_t)p->now);
    bool dropped = sqlite3_changes(db) > 0;
    if (result == SQLITE_OK)
        result =
            ax_sql_run(db, "INSERT INTO moment VALUES(?1, ?2, ?3, ?4, ?5, ?6, ?7, ?8)", "iiiiitdt", (int64_t)p->now,
                       p->tip, p->state, (int64_t)p->steps, (int64_t)p->at, words, time, p->failure);
    if (result == SQLITE_OK)
        result = ax_history_go(db, p->now);
    return result == SQLITE_OK && dropped ? drop_unreachable(db) : result;
}

// A stored state, and how much it would be missed: the present one most (0), then those of variants and of moments near to it, then
// every tenth.
// States between, which no moment has, come last among those that are kept.
typedef struct stored {
    int64_t step, bytes;
    int rank, distance;
} stored;

static int compare_stored(const void* a, const void* b)
{
    const stored *x = a, *y = b;
    if (x->rank != y->rank)
        return x->rank - y->rank;
    if (x->distance != y->distance)
        return x->distance - y->distance;
    return (x->step > y->step) - (x->step < y->step);
}

static stored rank(sqlite3_stmt* row)
{
    stored s = {sqlite3_column_int64(row, 0), sqlite3_column_int64(row, 1), .rank = 2, .distance = INT_MAX};
    if (sqlite3_column_type(row, 2) != SQLITE_NULL) {
        s.distance = sqlite3_column_int(row, 2);
        s.rank = s.distance == 0                            ? 0
                 : s.distance <= last_moments               ? 1
                 : sqlite3_column_int(row, 3) % stride == 0 ? 2
                                                            : 3;
    }
    if (sqlite3_column_int(row, 4) && s.rank > 0)
        s.rank = 1, s.distance = 0;
    return s;
}

// `list`: step, bytes, distance of the nearest moment from the present one, its number, and whether it is that of a variant.
static int thin(sqlite3* db, const char* list, int now, int most, int (*drop)(sqlite3* db, sqlite3_int64 step))
{
    int result = SQLITE_OK, count = 0, capacity = 0;
    stored* all = NULL;
    sqlite3_stmt* rows = ax_sql_ask(db, list, "i", (int64_t)now);
    while (ax_sql_next(rows, &result)) {
        if (count == capacity) {
            capacity = 2 * capacity + 64;
            all = ax_realloc(all, (size_t)capacity, sizeof *all);
        }
        all[count++] = rank(rows);
    }
    sqlite3_finalize(rows);
    if (count)
        qsort(all, (size_t)count, sizeof *all, compare_stored);
    int64_t bytes = 0;
    for (int k = 0; k < count && result == SQLITE_OK; ++k) {
        bytes += all[k].bytes;
        if (all[k].rank == 3 ||
            (all[k].rank > 0 && (k >= most || bytes > (all[k].rank == 1 ? most_bytes : most_old_bytes))))
            result = drop(db, all[k].step);
    }
    ax_free(all);
    return result;
}

static int drop_checkpoint(sqlite3* db, sqlite3_int64 step)
{
    return ax_sql_run(db, "DELETE FROM checkpoint WHERE step = ?1", "i", (int64_t)step);
}

int ax_history_thin(sqlite3* db, int now)
{
    int result = thin(db,
                      "SELECT step, length(form), min(abs(number - ?1)), number, step IN (SELECT state FROM variant)"
                      " FROM checkpoint LEFT JOIN moment ON state = step GROUP BY step",
                      now, most_checkpoints, drop_checkpoint);
    // the design with which a document began cannot be computed again
    return result == SQLITE_OK ? thin(db,
                                      "SELECT design, 0, min(abs(number - ?1)), number, design IN (SELECT state FROM"
                                      " variant) FROM (SELECT DISTINCT design FROM property WHERE design <> 0)"
                                      " LEFT JOIN moment ON state = design GROUP BY design",
                                      now, most_designs, ax_design_remove)
                               : result;
}
