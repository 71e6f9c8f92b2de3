// Opening the database of a document: whatever the file holds, it is a sound document of a version that is known, or refused.
#pragma once

#include "document/schema.h"

typedef struct ax_database {
    sqlite3* file;
    sqlite3* view; // what to read: `file`, or a copy of it in memory that was brought to the present version
    int version;   // of the file
    const ax_schema* schema;
} ax_database;

// A file that was left in the middle of a change is brought back to the state before it, if it can be written. AX_BAD_INPUT when it is
// missing, no document, damaged, or of a newer version; empty then.
ax_status ax_database_open(const ax_schema* schema, const char* path, ax_database* out, ax_error* error);
void ax_database_close(ax_database* database);

// A document of nothing yet at a file that is empty, and thrown away if anything fails: without journal, made durable as a whole by
// whoever asked for it. An SQLite result; *db is to be closed in any case.
int ax_database_make(const char* path, sqlite3** db);

ax_status ax_fail_damaged(const char* path, const char* what, ax_error* error);
// SQLite's own troubles while reading: the file is damaged, or it cannot be read now.
ax_status ax_fail_reading(const char* path, sqlite3* db, int result, ax_error* error);
