// What an open document holds, for the files that work on it: steps.c, the recipe; play.c, trying a change; saving.c, putting it into
// the file; change.c, the changes there are; variants.c; create.c, new documents; and session.c, which opens them and looks at them.
#pragma once

#include "ax/session.h"
#include "document/history.h"
#include "document/lock.h"
#include "document/opening.h"

enum { AX_SEALED = 7 }; // tables

struct ax_session {
    char *path, *folder, *read_only;
    ax_lock* lock;
    ax_database database;
    bool from_design;
    ax_recipe* recipe;
    int id_capacity;
    int64_t* ids; // of the steps: ids[k] is the k-th, counted from 1; ids[0] = 0, the beginning; -1: not stored yet
    ax_present present;
    ax_moment* moments;
    int moment_count;
    ax_kept_variant* kept; // variants, and what is told of them
    ax_variant* variants;
    int variant_count;
    ax_form* form;          // after step present.state
    ax_form* const* making; // that of the attempt that is being played
    void* bytes;            // the same, stored
    size_t size;
    ax_design design; // of step `designed`; -1: none is loaded
    int64_t designed;
    bool touched[AX_SEALED]; // tables, by the transaction that is going on
};

char* ax_folder_of(const char* path); // owned by the caller
// One that holds nothing yet.
ax_session* ax_session_make(const char* path);
// Opens for the one who has the lock, which the session takes over, or without one for reading: `read_only` says why.
ax_status ax_session_open_locked(const char* path, ax_lock* lock, const char* read_only, const ax_progress* progress,
                                 ax_session** out, ax_error* error);
// SQLite's own troubles while reading the document.
ax_status ax_session_fail_reading(const ax_session* s, int result, ax_error* error);

// ---- the recipe and its steps -----------------------------------------------------------------------------------------------

void ax_steps_reserve(ax_session* s, int steps);
void ax_steps_shorten(ax_session* s, int steps);
// Makes the recipe the steps up to `tip`; what it has in common with the one before stays.
ax_status ax_steps_show(ax_session* s, int64_t tip, int steps, ax_error* error);
// Looks up the steps from number `from` on (counted from 0) that are stored already, by an earlier moment.
ax_status ax_steps_identify(ax_session* s, int from, ax_error* error);

// ---- trying a change --------------------------------------------------------------------------------------------------------

// A form kept after step `at`.
typedef struct ax_kept_form {
    int at;
    bool stored; // already in the file
    void* bytes;
    size_t size;
} ax_kept_form;

// What a step read from the file that it names.
typedef struct ax_kept_source {
    int at;
    char *name, *bytes;
    size_t size;
} ax_kept_source;

// A change that is being tried: nothing of the session but its recipe is touched before it is in the file.
typedef struct ax_attempt {
    ax_form* form;
    int at;
    int kept_count, kept_capacity;
    ax_kept_form* kept;
    int source_count;
    ax_kept_source* sources;
    ax_finished finished; // by the last step
} ax_attempt;

// Reaches the state after `until` steps of the recipe, or as far as they go.
ax_status ax_attempt_play(ax_session* s, int until, const ax_progress* progress, ax_attempt* a, ax_error* error);
// Applies step `at` (counted from 0) to a->form. Its file is read where it is, and otherwise as it was when it was read last.
ax_status ax_attempt_step(ax_session* s, ax_attempt* a, int at, const ax_progress* progress, ax_error* error);
// The checkpoint after a step, if there is a sound one.
bool ax_attempt_fetch(ax_session* s, int64_t step, ax_attempt* a);
bool ax_attempt_is_kept(const ax_attempt* a); // the form after its last step
void ax_attempt_forget(ax_attempt* a);        // also resets to an empty one

// ---- putting it into the file -----------------------------------------------------------------------------------------------

ax_status ax_saving_check(const ax_session* s, ax_error* error); // that the document may be changed
double ax_saving_now(void);                                      // seconds since 1970
// A transaction: what is written between the two, an SQLite result, is in the file as a whole, or nothing of it.
int ax_saving_begin(ax_session* s);
ax_status ax_saving_end(ax_session* s, int result, ax_error* error);
// Writes what was tried as moment `number`, a new one if it has words, and makes it the present one.
ax_status ax_saving_commit(ax_session* s, ax_attempt* a, int number, const char* words, const char* failure,
                           ax_error* error);
// Back to the present state after something failed, or was tried only; `a` is forgotten, NULL: there is none.
void ax_saving_revert(ax_session* s, ax_attempt* a);
// What a change ends with: the attempt is forgotten, and unless it is in the file, all is as it was. Returns `status`.
ax_status ax_saving_conclude(ax_session* s, ax_attempt* a, ax_status status);
// Takes the form that was tried, without writing it.
void ax_saving_adopt(ax_session* s, ax_attempt* a, const ax_present* present);
ax_status ax_saving_read_moments(ax_session* s, ax_error* error);
ax_status ax_saving_read_variants(ax_session* s, ax_error* error);
void ax_saving_forget_variants(ax_session* s);

// ---- changing ---------------------------------------------------------------------------------------------------------------

// Applies an operator after the present step, as moment `number`.
ax_status ax_change_apply(ax_session* s, const char* json, int number, const ax_progress* progress, ax_finish* figures,
                          ax_error* error);
// Goes to a place of the tree, as moment `target->now`: a new one if there are words for it.
ax_status ax_change_visit(ax_session* s, const ax_present* target, const char* words, const ax_progress* progress,
                          ax_error* error);
