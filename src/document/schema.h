// The tables of a document and how they grow from version to version.
#pragma once

#include "ax/base.h"

#include <sqlite3.h>
#include <stdint.h>

enum { AX_DOCUMENT_ID = 0x41585348 }; // "AXSH", the application id in the header of the file

typedef struct ax_schema {
    int version;              // of the tables that this program reads and writes
    const char* const* steps; // steps[k] is the SQL that leads from version k to k + 1; version 0 is an empty database
} ax_schema;

extern const ax_schema ax_document_schema;

// Takes the steps from version `from` to version `to`, as one transaction. Returns an SQLite result.
int ax_schema_upgrade(const ax_schema* schema, sqlite3* db, int from, int to);

// True if the tables are exactly those of `version`, so that no view, trigger or virtual table of a foreign hand is ever read.
bool ax_schema_matches(const ax_schema* schema, sqlite3* db, int version);

// Goes on from the digest `state` of what came before (0: nothing).
uint64_t ax_schema_digest(uint64_t state, const void* data, size_t bytes);

// A document is sealed: a digest of everything in each of its tables is kept in one of them, so that damage below SQLite's notice (a
// flipped bit in a coordinate) is found on opening. Checkpoints are not: each has a digest of its own, with its step, and can be computed
// again, and there are too many to read them all on opening. SQLite results; `sound` tells whether the seals fit.
int ax_schema_seal(sqlite3* db);                          // all tables
int ax_schema_seal_table(sqlite3* db, const char* table); // one that was changed
int ax_schema_check_seal(sqlite3* db, int version, bool* sound);
