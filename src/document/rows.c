#include "document/rows.h"

#include <limits.h>
#include <math.h>
#include <stdio.h>
#include <string.h>

_Static_assert(__BYTE_ORDER__ == __ORDER_LITTLE_ENDIAN__, "arrays are stored as they lie in memory: little endian");
_Static_assert(sizeof(int) == 4 && sizeof(double) == 8, "i32 and f64");

static const struct {
    const char* name;
    size_t size;
} elements[] = {[AX_F64] = {"f64", 8}, [AX_I32] = {"i32", 4}, [AX_U8] = {"u8", 1}};

ax_rows ax_rows_begin(sqlite3* db, sqlite3_int64 design, bool loading)
{
    ax_rows rows = {.db = db, .design = design, .loading = loading};
    rows.result = sqlite3_prepare_v2(db,
                                     loading ? "SELECT value FROM property WHERE design = ?1 AND name = ?2"
                                             : "INSERT INTO property VALUES(?1, ?2, ?3)",
                                     -1, &rows.property, NULL);
    if (rows.result == SQLITE_OK)
        rows.result =
            sqlite3_prepare_v2(db,
                               loading ? "SELECT type, width, count, data FROM array WHERE design = ?1 AND name = ?2"
                                       : "INSERT INTO array VALUES(?1, ?2, ?3, ?4, ?5, ?6)",
                               -1, &rows.array, NULL);
    return rows;
}

void ax_rows_end(ax_rows* rows)
{
    sqlite3_finalize(rows->property);
    sqlite3_finalize(rows->array);
    rows->property = rows->array = NULL;
}

bool ax_rows_sound(const ax_rows* rows)
{
    return rows->result == SQLITE_OK && !rows->damaged[0];
}

void ax_rows_damaged(ax_rows* rows, const char* name)
{
    if (ax_rows_sound(rows))
        snprintf(rows->damaged, sizeof rows->damaged, "%s", name);
}

static void start(const ax_rows* rows, sqlite3_stmt* row, const char* name)
{
    sqlite3_reset(row);
    sqlite3_clear_bindings(row);
    sqlite3_bind_int64(row, 1, rows->design);
    sqlite3_bind_text(row, 2, name, -1, SQLITE_STATIC);
}

static void insert(ax_rows* rows, sqlite3_stmt* row)
{
    int result = sqlite3_step(row);
    if (result != SQLITE_DONE)
        rows->result = result;
}

// True if there is a row of that name; its absence is damage unless it is optional.
static bool find(ax_rows* rows, sqlite3_stmt* row, const char* name, bool optional)
{
    start(rows, row, name);
    int result = sqlite3_step(row);
    if (result == SQLITE_DONE && !optional)
        ax_rows_damaged(rows, name);
    else if (result != SQLITE_ROW && result != SQLITE_DONE)
        rows->result = result;
    return result == SQLITE_ROW;
}

void ax_rows_real(ax_rows* rows, const char* name, double* value)
{
    if (!ax_rows_sound(rows))
        return;
    if (!rows->loading) {
        start(rows, rows->property, name);
        sqlite3_bind_double(rows->property, 3, *value); // SQLite makes NaN NULL
        insert(rows, rows->property);
    } else if (find(rows, rows->property, name, false)) {
        int type = sqlite3_column_type(rows->property, 0);
        if (type == SQLITE_FLOAT)
            *value = sqlite3_column_double(rows->property, 0);
        else if (type == SQLITE_NULL)
            *value = NAN;
        else
            ax_rows_damaged(rows, name);
    }
}

void ax_rows_whole(ax_rows* rows, const char* name, int* value, int lo, int hi)
{
    if (!ax_rows_sound(rows))
        return;
    if (!rows->loading) {
        start(rows, rows->property, name);
        sqlite3_bind_int(rows->property, 3, *value);
        insert(rows, rows->property);
    } else if (find(rows, rows->property, name, false)) {
        sqlite3_int64 stored = sqlite3_column_int64(rows->property, 0);
        if (sqlite3_column_type(rows->property, 0) != SQLITE_INTEGER || stored < lo || stored > hi)
            ax_rows_damaged(rows, name);
        else
            *value = (int)stored;
    }
}

void ax_rows_flag(ax_rows* rows, const char* name, bool* value)
{
    int whole = *value;
    ax_rows_whole(rows, name, &whole, 0, 1);
    *value = whole;
}

bool ax_rows_word(ax_rows* rows, const char* name, const char* now, char text[16])
{
    if (!ax_rows_sound(rows))
        return false;
    if (!rows->loading) {
        start(rows, rows->property, name);
        sqlite3_bind_text(rows->property, 3, now, -1, SQLITE_STATIC);
        insert(rows, rows->property);
        return false;
    }
    if (!find(rows, rows->property, name, false))
        return false;
    bool is_text = sqlite3_column_type(rows->property, 0) == SQLITE_TEXT;
    const char* stored = is_text ? (const char*)sqlite3_column_text(rows->property, 0) : NULL;
    if (!stored || strlen(stored) > 15) {
        ax_rows_damaged(rows, name);
        return false;
    }
    strcpy(text, stored);
    return true;
}

static bool all_finite(const double* values, size_t count)
{
    for (size_t k = 0; k < count; ++k)
        if (!isfinite(values[k]))
            return false;
    return true;
}

static void* load_array(ax_rows* rows, const char* name, ax_element type, int width, int count)
{
    const char* stored_type = (const char*)sqlite3_column_text(rows->array, 0);
    size_t values = (size_t)width * (size_t)count, bytes = values * elements[type].size;
    const void* data = sqlite3_column_blob(rows->array, 3);
    void* block = NULL;
    bool fits = stored_type && strcmp(stored_type, elements[type].name) == 0 &&
                sqlite3_column_int64(rows->array, 1) == width && sqlite3_column_int64(rows->array, 2) == count &&
                sqlite3_column_type(rows->array, 3) == SQLITE_BLOB &&
                (size_t)sqlite3_column_bytes(rows->array, 3) == bytes && (data || bytes == 0);
    if (fits) {
        block = ax_alloc(values, elements[type].size);
        if (bytes)
            memcpy(block, data, bytes);
        fits = type != AX_F64 || all_finite(block, values);
    }
    if (!fits) {
        ax_rows_damaged(rows, name);
        ax_free(block);
        block = NULL;
    }
    sqlite3_reset(rows->array); // lets go of SQLite's copy
    return block;
}

void* ax_rows_array(ax_rows* rows, const char* name, ax_element type, int width, int count, bool optional, void* now)
{
    if (!ax_rows_sound(rows))
        return rows->loading ? NULL : now;
    if (rows->loading)
        return find(rows, rows->array, name, optional) ? load_array(rows, name, type, width, count) : NULL;
    if (!now)
        return NULL;
    start(rows, rows->array, name);
    sqlite3_bind_text(rows->array, 3, elements[type].name, -1, SQLITE_STATIC);
    sqlite3_bind_int(rows->array, 4, width);
    sqlite3_bind_int(rows->array, 5, count);
    size_t bytes = (size_t)width * (size_t)count * elements[type].size;
    int result = sqlite3_bind_blob64(rows->array, 6, now, bytes, SQLITE_STATIC);
    if (result == SQLITE_OK)
        insert(rows, rows->array);
    else
        rows->result = result; // more than a database can hold
    return now;
}
