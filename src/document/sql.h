// SQL statements in one line each.
#pragma once

#include <sqlite3.h>
#include <stdint.h>

// What is bound to ?1, ?2 ... is told by `types`: i int64_t, d double (NaN becomes NULL), t text that may be NULL, b a blob as pointer and
// size_t. Texts and blobs must live until the statement is finalised.

// Runs a statement that returns no rows. SQLITE_OK, or what went wrong.
int ax_sql_run(sqlite3* db, const char* sql, const char* types, ...);

// Prepares and binds; the caller steps and finalises. NULL on failure, for which step and finalise are harmless.
sqlite3_stmt* ax_sql_ask(sqlite3* db, const char* sql, const char* types, ...);

// Goes to the next row; false at the end and on failure, which goes to *result unless that holds one already.
int ax_sql_next(sqlite3_stmt* rows, int* result);
