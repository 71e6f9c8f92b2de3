// Finished designs in a document, each under a number of its own.
#pragma once

#include "ax/design.h"

#include <sqlite3.h>

// Puts a design there, in the place of the one that was. An SQLite result; the caller seals "property" and "array".
int ax_design_store(sqlite3* db, sqlite3_int64 number, const ax_design* design);
int ax_design_remove(sqlite3* db, sqlite3_int64 number);
bool ax_design_stored(sqlite3* db, sqlite3_int64 number);

// AX_BAD_INPUT when what is stored is no sound design; `path` is for messages. `design` is empty on failure.
ax_status ax_design_fetch(const char* path, sqlite3* db, sqlite3_int64 number, ax_design* design, ax_error* error);
