#include "document/schema.h"

#include <stdint.h>
#include <stdio.h>
#include <string.h>

static const char* const steps[] = {
    // Single values, and arrays as blobs of little-endian elements: type f64, i32 or u8, `count` rows of `width` elements.
    "CREATE TABLE property(name TEXT PRIMARY KEY NOT NULL, value);"
    "CREATE TABLE array(name TEXT PRIMARY KEY NOT NULL, type TEXT NOT NULL, width INTEGER NOT NULL,"
    " count INTEGER NOT NULL, data BLOB NOT NULL);"
    "CREATE TABLE seal(digest INTEGER NOT NULL);",
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
static uint64_t mix(uint64_t state, const void* data, size_t bytes)
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
        state = mix(state, &type, sizeof type);
        if (type == SQLITE_INTEGER) {
            sqlite3_int64 value = sqlite3_column_int64(row, c);
            state = mix(state, &value, sizeof value);
        } else if (type == SQLITE_FLOAT) {
            double value = sqlite3_column_double(row, c);
            state = mix(state, &value, sizeof value);
        } else if (type != SQLITE_NULL) {
            const void* value = sqlite3_column_blob(row, c); // before its length, as SQLite asks
            state = mix(state, value, (size_t)sqlite3_column_bytes(row, c));
        }
    }
    return state;
}

// Sum over the rows of all tables but the seal's own, so that the order in which SQLite finds them does not matter.
static int digest_all(sqlite3* db, uint64_t* digest)
{
    sqlite3_stmt* tables = NULL;
    *digest = 0;
    int result = sqlite3_prepare_v2(db,
                                    "SELECT name FROM sqlite_schema WHERE type = 'table' AND name <> 'seal'"
                                    " AND name NOT LIKE 'sqlite_%'",
                                    -1, &tables, NULL);
    while (result == SQLITE_OK && (result = sqlite3_step(tables)) == SQLITE_ROW) {
        const char* name = (const char*)sqlite3_column_text(tables, 0);
        uint64_t seed = mix(0, name, strlen(name));
        char* sql = sqlite3_mprintf("SELECT * FROM \"%w\"", name);
        sqlite3_stmt* rows = NULL;
        result = sql ? sqlite3_prepare_v2(db, sql, -1, &rows, NULL) : SQLITE_NOMEM;
        while (result == SQLITE_OK && (result = sqlite3_step(rows)) == SQLITE_ROW) {
            *digest += mix_row(seed, rows);
            result = SQLITE_OK;
        }
        result = result == SQLITE_DONE ? SQLITE_OK : result;
        sqlite3_finalize(rows);
        sqlite3_free(sql);
    }
    sqlite3_finalize(tables);
    return result == SQLITE_DONE ? SQLITE_OK : result;
}

int ax_schema_seal(sqlite3* db)
{
    uint64_t digest;
    int result = digest_all(db, &digest);
    char* sql = sqlite3_mprintf("DELETE FROM seal; INSERT INTO seal VALUES(%lld)", (sqlite3_int64)digest);
    if (result == SQLITE_OK)
        result = sql ? sqlite3_exec(db, sql, NULL, NULL, NULL) : SQLITE_NOMEM;
    sqlite3_free(sql);
    return result;
}

int ax_schema_check_seal(sqlite3* db, bool* sound)
{
    uint64_t digest;
    sqlite3_stmt* seal = NULL;
    int result = digest_all(db, &digest);
    if (result == SQLITE_OK)
        result = sqlite3_prepare_v2(db, "SELECT digest FROM seal", -1, &seal, NULL);
    if (result == SQLITE_OK)
        result = sqlite3_step(seal);
    *sound = result == SQLITE_ROW && sqlite3_column_int64(seal, 0) == (sqlite3_int64)digest;
    sqlite3_finalize(seal);
    return result == SQLITE_ROW || result == SQLITE_DONE ? SQLITE_OK : result;
}
