#include "document/opening.h"

#include <errno.h>
#include <stdio.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

ax_status ax_fail_damaged(const char* path, const char* what, ax_error* error)
{
    return ax_fail(error, AX_BAD_INPUT, "%s is damaged: %s. Use an earlier copy, or design it again.", path, what);
}

ax_status ax_fail_reading(const char* path, sqlite3* db, int result, ax_error* error)
{
    switch (result & 0xff) {
    case SQLITE_NOTADB:
        return ax_fail(error, AX_BAD_INPUT,
                       "%s is not an Auxshell document. Give a file that the design command has written.", path);
    case SQLITE_BUSY:
    case SQLITE_LOCKED:
        return ax_fail(error, AX_FAILED, "%s is being changed by another program. Try again when it is done.", path);
    case SQLITE_READONLY: // only when a journal waits
        return ax_fail(
            error, AX_FAILED,
            "%s was left in the middle of a change and cannot be mended where it may not be written. Copy it, "
            "with the file %s-journal beside it, to where you may.",
            path, path);
    case SQLITE_NOMEM:
    case SQLITE_IOERR:
    case SQLITE_CANTOPEN:
        return ax_fail(error, AX_FAILED, "Cannot read %s: %s.", path, sqlite3_errmsg(db));
    default:
        return ax_fail_damaged(path, sqlite3_errmsg(db), error);
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

// An upgraded copy in memory: looking at a document never changes its file.
static int upgrade_in_memory(const ax_schema* schema, sqlite3* db, int version, sqlite3** copy)
{
    int result = sqlite3_open_v2(":memory:", copy, SQLITE_OPEN_READWRITE | SQLITE_OPEN_NOMUTEX, NULL);
    sqlite3_backup* backup = result == SQLITE_OK ? sqlite3_backup_init(*copy, "main", db, "main") : NULL;
    if (backup) {
        sqlite3_backup_step(backup, -1);
        result = sqlite3_backup_finish(backup);
    }
    return result == SQLITE_OK ? ax_schema_upgrade(schema, *copy, version, schema->version) : result;
}

// Checks that an open database is a sound document, and gives it a view of the schema's version.
static ax_status accept(const char* path, ax_database* d, ax_error* error)
{
    int id = 0;
    bool sound = false;
    int result = read_pragma(d->file, "PRAGMA application_id", &id);
    if (result == SQLITE_OK)
        result = read_pragma(d->file, "PRAGMA user_version", &d->version);
    if (result != SQLITE_OK)
        return ax_fail_reading(path, d->file, result, error);
    if (id != AX_DOCUMENT_ID)
        return ax_fail(error, AX_BAD_INPUT,
                       "%s is not an Auxshell document%s. Give a file that the design command has written.", path,
                       id || d->version ? " but a database of another program" : "");
    if (d->version > d->schema->version)
        return ax_fail(error, AX_BAD_INPUT,
                       "%s is a document of version %d, written by a newer Auxshell; version %s reads up to %d. Use "
                       "the newer one.",
                       path, d->version, ax_version(), d->schema->version);
    if (d->version < 1 || !ax_schema_matches(d->schema, d->file, d->version))
        return ax_fail_damaged(path, "its tables are not those of a document", error);
    result = ax_schema_check_seal(d->file, d->version, &sound);
    if (result != SQLITE_OK)
        return ax_fail_reading(path, d->file, result, error);
    if (!sound)
        return ax_fail_damaged(path, "its contents are not what was saved", error);
    if (d->version == d->schema->version) {
        d->view = d->file;
        return AX_OK;
    }
    result = upgrade_in_memory(d->schema, d->file, d->version, &d->view);
    return result == SQLITE_OK ? AX_OK : ax_fail_reading(path, d->view, result, error);
}

// Also for reading the file is opened for writing where it may be: only so can a change that was cut short be taken back.
static int open_file(const char* path, sqlite3** db)
{
    int how = access(path, W_OK) == 0 ? SQLITE_OPEN_READWRITE : SQLITE_OPEN_READONLY;
    int result = sqlite3_open_v2(path, db, how | SQLITE_OPEN_NOMUTEX, NULL);
    if (result != SQLITE_OK)
        return result;
    sqlite3_busy_timeout(*db, 5000);
    // see "Defense Against Dark Arts" in SQLite's documentation
    return sqlite3_exec(*db, "PRAGMA trusted_schema = OFF; PRAGMA cell_size_check = ON; PRAGMA mmap_size = 0", NULL,
                        NULL, NULL);
}

ax_status ax_database_open(const ax_schema* schema, const char* path, ax_database* out, ax_error* error)
{
    *out = (ax_database){.schema = schema};
    ax_status status = check_file(path, error);
    if (status != AX_OK)
        return status;
    int result = open_file(path, &out->file);
    if (result == SQLITE_OK)
        result = sqlite3_exec(out->file, "BEGIN", NULL, NULL, NULL); // one look, while others may write
    status = result == SQLITE_OK ? accept(path, out, error) : ax_fail_reading(path, out->file, result, error);
    if (out->file)
        sqlite3_exec(out->file, "END", NULL, NULL, NULL);
    if (status != AX_OK)
        ax_database_close(out);
    return status;
}

void ax_database_close(ax_database* database)
{
    if (database->view != database->file)
        sqlite3_close(database->view);
    sqlite3_close(database->file);
    *database = (ax_database){0};
}

int ax_database_make(const char* path, sqlite3** db)
{
    char identify[64];
    snprintf(identify, sizeof identify, "PRAGMA application_id = %d", AX_DOCUMENT_ID);
    int result = sqlite3_open_v2(path, db, SQLITE_OPEN_READWRITE | SQLITE_OPEN_NOMUTEX, NULL);
    if (result == SQLITE_OK)
        result = sqlite3_exec(*db, "PRAGMA journal_mode = OFF; PRAGMA synchronous = OFF", NULL, NULL, NULL);
    if (result == SQLITE_OK)
        result = sqlite3_exec(*db, identify, NULL, NULL, NULL);
    return result == SQLITE_OK ? ax_schema_upgrade(&ax_document_schema, *db, 0, ax_document_schema.version) : result;
}
