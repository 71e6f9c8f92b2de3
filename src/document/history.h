// Steps, moments and checkpoints of a document as rows of its tables (see schema.c). All functions return SQLite results.
#pragma once

#include "ax/session.h"

#include <sqlite3.h>
#include <stdint.h>

// Where the document stands.
typedef struct ax_present {
    int now;            // moment
    int64_t tip, state; // steps
    int steps, at;
    char* failure; // why the step at `at` failed when it was played again; NULL: none did. Owned
} ax_present;

// SQLITE_CORRUPT when there is no such moment or its numbers cannot be.
int ax_history_moment(sqlite3* db, int number, ax_present* out);
// A place in the tree that has a name.
typedef struct ax_kept_variant {
    char *name, *figures;
    int64_t tip, state;
    int steps, at;
    double time;
} ax_kept_variant;

// The moment at which the session is, and the folder of its files, owned by the caller ("": that of the document).
int ax_history_present(sqlite3* db, ax_present* out, char** folder);
// All moments in order, owned by the caller with their words.
int ax_history_moments(sqlite3* db, ax_moment** moments, int* count);
void ax_history_moments_free(ax_moment* moments, int count);

// Fills ids[1 .. count] with the steps from the first to `tip`, ids[0] = 0. SQLITE_CORRUPT unless they are just so many.
int ax_history_path(sqlite3* db, int64_t tip, int count, int64_t* ids);
// The operator of a step, owned by the caller.
int ax_history_operator(sqlite3* db, int64_t step, char** json);
// The step with this operator after `parent`; -1 if there is none.
int ax_history_find(sqlite3* db, int64_t parent, const char* json, int64_t* step);

// The form that is kept after a step, borrowed until the statement *row is finalised, which the caller does. NULL if there is none or
// it is not what was written.
const void* ax_history_checkpoint(sqlite3* db, int64_t step, size_t* size, sqlite3_stmt** row);

// What the file that a step names held when it was read last; owned by the caller. *bytes NULL: nothing is kept.
int ax_history_file(sqlite3* db, int64_t step, char** bytes, size_t* size);

// All variants in the order in which they were kept, owned by the caller with their texts.
int ax_history_variants(sqlite3* db, ax_kept_variant** variants, int* count);
void ax_history_variants_free(ax_kept_variant* variants, int count);

// ---- within a transaction ---------------------------------------------------------------------------------------------------

int ax_history_add_step(sqlite3* db, int64_t parent, const char* json, int64_t* step);
// Makes `present` a moment and the present one, and drops those behind it with all that only they needed.
int ax_history_add_moment(sqlite3* db, const ax_present* present, const char* words, double time);
int ax_history_go(sqlite3* db, int moment);
// The place `present` under this name, instead of what had it.
int ax_history_keep_variant(sqlite3* db, const char* name, const ax_present* present, double time, const char* figures);
// With all that only it needed.
int ax_history_drop_variant(sqlite3* db, const char* name);
int ax_history_keep_file(sqlite3* db, int64_t step, const char* name, const char* bytes, size_t size);
int ax_history_keep(sqlite3* db, int64_t step, const void* form, size_t size);
// Keeps checkpoints and designs of the present, of variants, of the last moments and of every tenth one before, within bounds.
int ax_history_thin(sqlite3* db, int now);
