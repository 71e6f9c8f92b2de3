#include "document/schema.h"

#include "document/sql.h"

#include <stdint.h>
#include <stdio.h>
#include <string.h>

static const char* const steps[] = {
    // Single values, and arrays as blobs of little-endian elements: type f64, i32 or u8, `count` rows of `width` elements.
    "CREATE TABLE property(name TEXT PRIMARY KEY NOT NULL, value);"
    "CREATE TABLE array(name TEXT PRIMARY KEY NOT NULL, type TEXT NOT NULL, width INTEGER NOT NULL,"
    " count INTEGER NOT NULL, data BLOB NOT NULL);"
    "CREATE TABLE seal(digest INTEGER NOT NULL);",
    // History. Steps are a tree: each is an operator (JSON text) after its parent, 0 being the beginning, so that what several
    // moments have in common is there once. A moment has all steps up to `tip`, which are `steps`, and the state after step `state`,
    // which is number `at` of them. Designs belong to the step that finished them, checkpoints (forms) to the one they follow.
    // What was there becomes the beginning of a history.
    "ALTER TABLE property RENAME TO old_property;"
    "ALTER TABLE array RENAME TO old_array;"
    "CREATE TABLE property(design INTEGER NOT NULL, name TEXT NOT NULL, value, PRIMARY KEY(design, name));"
    "CREATE TABLE array(design INTEGER NOT NULL, name TEXT NOT NULL, type TEXT NOT NULL, width INTEGER NOT NULL,"
    " count INTEGER NOT NULL, data BLOB NOT NULL, PRIMARY KEY(design, name));"
    "INSERT INTO property SELECT 0, name, value FROM old_property;"
    "INSERT INTO array SELECT 0, name, type, width, count, data FROM old_array;"
    "DROP TABLE old_property;"
    "DROP TABLE old_array;"
    "CREATE TABLE step(id INTEGER PRIMARY KEY, parent INTEGER NOT NULL, operator TEXT NOT NULL);"
    "CREATE INDEX step_after ON step(parent);"
    "CREATE TABLE moment(number INTEGER PRIMARY KEY, tip INTEGER NOT NULL, state INTEGER NOT NULL, steps INTEGER NOT "
    "NULL,"
    " at INTEGER NOT NULL, words TEXT NOT NULL, time REAL, failure TEXT);"
    "CREATE TABLE session(now INTEGER NOT NULL, folder TEXT NOT NULL);"
    "CREATE TABLE checkpoint(step INTEGER PRIMARY KEY, form BLOB NOT NULL, digest INTEGER NOT NULL);"
    "INSERT INTO moment VALUES(0, 0, 0, 0, 0, 'Start', NULL, NULL);"
    "INSERT INTO session VALUES(0, '');"
    "DROP TABLE seal;"
    "CREATE TABLE seal(name TEXT PRIMARY KEY NOT NULL, digest INTEGER NOT NULL);",
    // What the files that steps name held when they were read, so that a document is whole wherever it goes.
    "CREATE TABLE file(step INTEGER PRIMARY KEY, name TEXT NOT NULL, data BLOB NOT NULL);",
    // Places in the tree of steps that have a name, as a moment has a number, with their figures as text.
    ("CREATE TABLE variant(name TEXT PRIMARY KEY NOT NULL, tip INTEGER NOT NULL, state INTEGER NOT NULL, steps INTEGER"
     " NOT NULL, at INTEGER NOT NULL, time REAL NOT NULL, figures TEXT NOT NULL);"),
    // How a simulated state was reached: until then always from flat, mostly at once.
    ("INSERT INTO property SELECT design, 'report.from_flat', value FROM property WHERE name = 'report.simulated';"
     "INSERT INTO property SELECT design, 'report.rim_stages', value FROM property WHERE name = 'report.simulated';"
     "INSERT INTO property SELECT design, 'report.inflated_first', 0 FROM property WHERE name = 'report.simulated';"),
};

const ax_schema ax_document_schema = {.version = sizeof steps / sizeof *steps, .steps = steps};

int ax_schema_upgrade(const ax_schema* schema, sqlite3* db, int from, int to)
{
    int result = sqlite3_exec(db, "SAVEPOINT upgrade", NULL, NULL, NULL);
    for (int k = from; k < to && result == SQLITE_OK; ++k)
        result = sqlite3_exec(db, schema->steps[k], NULL, NULL, NULL);
    char version[64];
    snprintf(version, sizeof version, "PRAGMA user_version = %d", to);
    if (result == SQLITE_OK)
        result = sqlite3_exec(db, version, NULL, NULL, NULL);
    return result == SQLITE_OK ? sqlite3_exec(db, "RELEASE upgrade", NULL, NULL, NULL) : result;
}

static const char list_tables[] = "SELECT type, name, tbl_name, sql FROM sqlite_schema"
                                  " WHERE name NOT LIKE 'sqlite_%' ORDER BY name";

static bool same_text(sqlite3_stmt* a, sqlite3_stmt* b, int column)
{
    const unsigned char *x = sqlite3_column_text(a, column), *y = sqlite3_column_text(b, column);
    return x && y && strcmp((const char*)x, (const char*)y) == 0;
}

bool ax_schema_matches(const ax_schema* schema, sqlite3* db, int version)
{
    sqlite3* model = NULL;
    sqlite3_stmt *have = NULL, *want = NULL;
    bool same = sqlite3_open(":memory:", &model) == SQLITE_OK &&
                ax_schema_upgrade(schema, model, 0, version) == SQLITE_OK &&
                sqlite3_prepare_v2(model, list_tables, -1, &want, NULL) == SQLITE_OK &&
                sqlite3_prepare_v2(db, list_tables, -1, &have, NULL) == SQLITE_OK;
    for (int a = SQLITE_ROW, b; same && a == SQLITE_ROW;) {
        a = sqlite3_step(want), b = sqlite3_step(have);
        same = a == b && (a == SQLITE_ROW || a == SQLITE_DONE);
        for (int c = 0; c < 4 && same && a == SQLITE_ROW; ++c)
            same = same_text(want, have, c);
    }
    sqlite3_finalize(have);
    sqlite3_finalize(want);
    sqlite3_close(model);
    return same;
}

// Eight bytes at a time; multiply and shift as in splitmix64, which is enough against accidents. It is no signature.
uint64_t ax_schema_digest(uint64_t state, const void* data, size_t bytes)
{
    const char* at = data;
    state += bytes;
    for (; bytes > 0; at += 8) {
        uint64_t word = 0;
        size_t part = bytes < 8 ? bytes : 8;
        memcpy(&word, at, part);
        bytes -= part;
        state = (state ^ word) * 0xbf58476d1ce4e5b9u;
        state ^= state >> 31;
    }
    return state;
}

static uint64_t mix_row(uint64_t state, sqlite3_stmt* row)
{
    for (int c = 0; c < sqlite3_column_count(row); ++c) {
        int type = sqlite3_column_type(row, c);
        state = ax_schema_digest(state, &type, sizeof type);
        if (type == SQLITE_INTEGER) {
            sqlite3_int64 value = sqlite3_column_int64(row, c);
            state = ax_schema_digest(state, &value, sizeof value);
        } else if (type == SQLITE_FLOAT) {
            double value = sqlite3_column_double(row, c);
            state = ax_schema_digest(state, &value, sizeof value);
        } else if (type != SQLITE_NULL) {
            const void* value = sqlite3_column_blob(row, c); // before its length, as SQLite asks
            state = ax_schema_digest(state, value, (size_t)sqlite3_column_bytes(row, c));
        }
    }
    return state;
}

// Sum over the rows, so that the order in which SQLite finds them does not matter.
static int digest_table(sqlite3* db, const char* name, uint64_t* digest)
{
    uint64_t seed = ax_schema_digest(0, name, strlen(name));
    *digest = 0;
    char* sql = sqlite3_mprintf("SELECT * FROM \"%w\"", name);
    int result = SQLITE_OK;
    sqlite3_stmt* rows = ax_sql_ask(db, sql, "");
    if (!rows)
        result = sqlite3_errcode(db);
    while (rows && ax_sql_next(rows, &result))
        *digest += mix_row(seed, rows);
    sqlite3_finalize(rows);
    sqlite3_free(sql);
    return result;
}

static const char sealed_tables[] = "SELECT name FROM sqlite_schema WHERE type = 'table' AND name <> 'seal'"
                                    " AND name <> 'checkpoint' AND name NOT LIKE 'sqlite_%'";

int ax_schema_seal_table(sqlite3* db, const char* table)
{
    uint64_t digest;
    int result = digest_table(db, table, &digest);
    return result == SQLITE_OK
               ? ax_sql_run(db, "INSERT OR REPLACE INTO seal VALUES(?1, ?2)", "ti", table, (int64_t)digest)
               : result;
}

int ax_schema_seal(sqlite3* db)
{
    int result = ax_sql_run(db, "DELETE FROM seal", "");
    sqlite3_stmt* tables = ax_sql_ask(db, sealed_tables, "");
    while (result == SQLITE_OK && ax_sql_next(tables, &result))
        result = ax_schema_seal_table(db, (const char*)sqlite3_column_text(tables, 0));
    sqlite3_finalize(tables);
    return result;
}

// Version 1 had one digest, the sum of those of the tables.
static int check_single_seal(sqlite3* db, uint64_t sum, bool* sound)
{
    int result = SQLITE_OK;
    sqlite3_stmt* seal = ax_sql_ask(db, "SELECT digest FROM seal", "");
    *sound = ax_sql_next(seal, &result) && sqlite3_column_int64(seal, 0) == (sqlite3_int64)sum;
    sqlite3_finalize(seal);
    return result;
}

int ax_schema_check_seal(sqlite3* db, int version, bool* sound)
{
    int result = SQLITE_OK;
    uint64_t sum = 0;
    *sound = true;
    sqlite3_stmt* tables = ax_sql_ask(db, sealed_tables, "");
    while (result == SQLITE_OK && ax_sql_next(tables, &result)) {
        const char* name = (const char*)sqlite3_column_text(tables, 0);
        uint64_t digest;
        result = digest_table(db, name, &digest);
        sum += digest;
        if (result != SQLITE_OK || version == 1)
            continue;
        sqlite3_stmt* seal = ax_sql_ask(db, "SELECT digest FROM seal WHERE name = ?1", "t", name);
        *sound = ax_sql_next(seal, &result) && sqlite3_column_int64(seal, 0) == (sqlite3_int64)digest && *sound;
        sqlite3_finalize(seal);
    }
    sqlite3_finalize(tables);
    return result == SQLITE_OK && version == 1 ? check_single_seal(db, sum, sound) : result;
}
