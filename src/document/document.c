#include "ax/document.h"

#include "ax/session.h"
#include "document/design_rows.h"
#include "document/load.h"
#include "document/lock.h"
#include "document/opening.h"
#include "document/sql.h"

#include <math.h>
#include <stdio.h>
#include <sys/stat.h>

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
    ax_status status = ax_lock_new(path, "auxshell", &file, &lock, error);
    if (status != AX_OK)
        return status;
    sqlite3* db = NULL;
    int result = ax_database_make(file.path, &db);
    if (result == SQLITE_OK)
        result = write_database(db, design);
    char reason[256];
    snprintf(reason, sizeof reason, "%s", result == SQLITE_OK ? "" : sqlite3_errmsg(db));
    if (sqlite3_close(db) != SQLITE_OK && result == SQLITE_OK)
        result = SQLITE_ERROR;
    if (result != SQLITE_OK)
        status = ax_fail(error, AX_FAILED, "Cannot write %s: %s. Nothing was changed.", path, reason);
    status = ax_file_end(&file, status, error);
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

static ax_status load_unfinished(const char* path, ax_design* design, ax_error* error)
{
    ax_session* session;
    ax_status status = ax_session_open(path, false, NULL, NULL, &session, error);
    if (status != AX_OK)
        return status;
    ax_form* form = ax_session_form(session);
    if (form)
        ax_form_snapshot(form, false, design);
    else
        status = ax_fail(error, AX_BAD_INPUT, "%s is empty: no operator has started a design in it.", path);
    ax_session_close(session);
    return status;
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
    bool finished = result == SQLITE_OK && ax_design_stored(database.view, step);
    if (result != SQLITE_OK)
        status = ax_fail_reading(path, database.view, result, error);
    else if (finished)
        status = ax_design_fetch(path, database.view, step, design, error);
    ax_database_close(&database);
    return status == AX_OK && !finished ? load_unfinished(path, design, error) : status;
}

ax_status ax_document_load(const char* path, ax_design* design, ax_error* error)
{
    return ax_document_load_as(&ax_document_schema, path, design, error);
}

double ax_document_time(const char* path)
{
    ax_database database;
    struct stat file;
    int result = SQLITE_OK;
    if (stat(path, &file) != 0 || ax_database_open(&ax_document_schema, path, &database, NULL) != AX_OK)
        return NAN;
    double time = (double)file.st_mtime;
    sqlite3_stmt* row = ax_sql_ask(database.view, "SELECT time FROM moment JOIN session ON number = now", "");
    if (ax_sql_next(row, &result) && sqlite3_column_type(row, 0) != SQLITE_NULL)
        time = sqlite3_column_double(row, 0);
    sqlite3_finalize(row);
    ax_database_close(&database);
    return time;
}
