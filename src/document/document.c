#include "ax/document.h"

#include "base/file.h"
#include "document/design_rows.h"
#include "document/load.h"
#include "document/lock.h"
#include "document/opening.h"
#include "document/sql.h"

#include <stdio.h>

// Everything of one save that can fail in SQLite.
static int write_database(sqlite3* db, const ax_design* design)
{
    int result = sqlite3_exec(db, "BEGIN", NULL, NULL, NULL);
    if (result == SQLITE_OK)
        result = ax_design_store(db, 0, design);
    if (result == SQLITE_OK)
        result = ax_schema_seal(db);
    return result == SQLITE_OK ? sqlite3_exec(db, "COMMIT", NULL, NULL, NULL) : result;
}

ax_status ax_document_save(const char* path, const ax_design* design, ax_error* error)
{
    ax_file file;
    ax_lock* lock = NULL;
    ax_status status = ax_file_begin_path(&file, path, error);
    if (status != AX_OK)
        return status;
    status = ax_lock_take(path, "auxshell", &lock, error);
    if (status != AX_OK) {
        ax_file_abandon(&file);
        return status;
    }
    sqlite3* db = NULL;
    int result = ax_database_make(file.path, &db);
    if (result == SQLITE_OK)
        result = write_database(db, design);
    char reason[256];
    snprintf(reason, sizeof reason, "%s", result == SQLITE_OK ? "" : sqlite3_errmsg(db));
    if (sqlite3_close(db) != SQLITE_OK && result == SQLITE_OK)
        result = SQLITE_ERROR;
    if (result == SQLITE_OK)
        status = ax_file_commit(&file, error);
    else {
        status = ax_fail(error, AX_FAILED, "Cannot write %s: %s. Nothing was changed.", path, reason);
        ax_file_abandon(&file);
    }
    ax_lock_release(lock);
    return status;
}

// The step after which the present state comes.
static int present_step(sqlite3* db, sqlite3_int64* step)
{
    int result = SQLITE_OK;
    sqlite3_stmt* row = ax_sql_ask(db, "SELECT state FROM moment JOIN session ON number = now", "");
    *step = ax_sql_next(row, &result) ? sqlite3_column_int64(row, 0) : -1;
    sqlite3_finalize(row);
    return result;
}

ax_status ax_document_load_as(const ax_schema* schema, const char* path, ax_design* design, ax_error* error)
{
    *design = (ax_design){0};
    ax_database database;
    ax_status status = ax_database_open(schema, path, &database, error);
    if (status != AX_OK)
        return status;
    sqlite3_int64 step;
    int result = present_step(database.view, &step);
    if (result != SQLITE_OK)
        status = ax_fail_reading(path, database.view, result, error);
    else if (step != 0 && !ax_design_stored(database.view, step))
        status = ax_fail(error, AX_BAD_INPUT,
                         "%s has no finished design at this point of its history. Finish it first: auxshell finish %s.",
                         path, path);
    else
        status = ax_design_fetch(path, database.view, step, design, error);
    ax_database_close(&database);
    return status;
}

ax_status ax_document_load(const char* path, ax_design* design, ax_error* error)
{
    return ax_document_load_as(&ax_document_schema, path, design, error);
}
