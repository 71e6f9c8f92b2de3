// An open document: its recipe, its history with undo and redo, and the form at present. Every change is in the file before the
// call that makes it returns, so that neither a crash nor a power cut loses what was acknowledged.
//
// The recipe is a list of steps, operators in order, of which the first `at` are applied. The history is a list of moments, one
// for each change: undo and redo walk along it, and a new change drops the moments ahead. Forms are kept for the last moments
// and every tenth of the older ones; others are computed again from the nearest one before, with the same bits.
//
// One program edits a document at a time; to others it is read-only. A session is used by one thread at a time.
#pragma once

#include "ax/recipe.h"

typedef struct ax_session ax_session;

// A new document at `path`, which is written as a whole once its steps have been played: a file there before stays until then, and
// is replaced. Steps 0 .. until - 1 of `recipe` (NULL: none; until < 0: all) are applied, each of them a moment of the history.
typedef enum ax_keep {
    AX_KEEP_NOTHING,
    AX_KEEP_BEFORE_UNREALISABLE, // when a later step asks for what cannot exist: AX_CANNOT_REALISE
    AX_KEEP_BEFORE_ANY,          // whatever goes wrong in a later step
} ax_keep;
typedef struct ax_session_start {
    const ax_recipe* recipe; // copied
    int until;
    const char* folder;  // relative names of files in steps are within it; NULL: the folder of the document
    const char* program; // who edits, for others that open the document: "auxshell studio"; NULL: "another program"
    void (*played)(void* context, int k, const char* words); // called after step k was applied; NULL: not
    void* context;
    // Set while steps are played, for their progress: ax_session_making shows how far it is. NULL: not.
    ax_session** session;
    ax_keep keep; // when to succeed with the steps before one that fails (see ax_session_failed)
} ax_session_start;
ax_status ax_session_create(const char* path, const ax_session_start* start, const ax_progress* progress,
                            ax_session** out, ax_error* error);

// Opens a document. With `edit`, it is locked for other programs until it is closed; where that cannot be (another program edits
// it, the file or its folder cannot be written), it is opened read-only all the same, and ax_session_read_only says why.
// A document made by ax_document_save goes on from its design. AX_BAD_INPUT as ax_document_load. Progress matters only where the present form has to be computed again.
ax_status ax_session_open(const char* path, bool edit, const char* program, const ax_progress* progress,
                          ax_session** out, ax_error* error);
void ax_session_close(ax_session* session); // NULL allowed

// Why it cannot be changed, a sentence: "roof.auxshell is open in auxshell studio (process 1234) ...". NULL: it can.
const char* ax_session_read_only(const ax_session* session);

// What follows is borrowed, valid until the next change.
const ax_recipe* ax_session_recipe(const ax_session* session); // all steps, also those ahead of `at`
int ax_session_at(const ax_session* session);
// True if the document began with a finished design and not with a step that starts one: its recipe is not all of it.
bool ax_session_from_design(const ax_session* session);
// The form after step at - 1, settled; NULL if the document is empty. Not to be changed: previews work on a copy (ax_form_save).
ax_form* ax_session_form(const ax_session* session);
// From the progress of a call that plays steps: the form as far as it is made; NULL in between and otherwise. For showing only.
ax_form* ax_session_making(const ax_session* session);
// Number of the step that failed when steps were played again, and why; -1 if none did.
int ax_session_failed(const ax_session* session, const char** why);
// The finished design, if the present state is that of one; *design is NULL if it is not. It may have to be computed again.
ax_status ax_session_design(ax_session* session, const ax_progress* progress, const ax_design** design,
                            ax_error* error);

typedef struct ax_moment {
    const char* words; // "Paint: 1.6 within 0.3 m"
    double time;       // seconds since 1970; NaN if it is not known
    int steps, at;     // of the recipe then
} ax_moment;
// The history, and which of its moments is the present one.
int ax_session_history(const ax_session* session, const ax_moment** moments, int* now);

// Changes, each of them one moment. On failure, and when cancelled, the document is as it was: AX_FAILED also when it cannot be saved
// (disk full) or is read-only. Errors of operators as ax_recipe_apply.
//
// Applies an operator (JSON text) after step at - 1; steps ahead are dropped.
ax_status ax_session_apply(ax_session* session, const char* json, const ax_progress* progress, ax_error* error);
// Puts another operator in the place of step k, or removes it (json NULL), and plays the steps from there on. If a later step fails
// then, that is no failure of the edit: the state is the last good one, and ax_session_failed tells.
ax_status ax_session_edit(ax_session* session, int k, const char* json, const ax_progress* progress, ax_error* error);
// Goes to the state after `at` steps; the others stay ahead.
ax_status ax_session_go(ax_session* session, int at, const ax_progress* progress, ax_error* error);
// Puts another recipe in the place of all steps; what both begin with is not computed again. Failing steps as with ax_session_edit.
ax_status ax_session_replace(ax_session* session, const ax_recipe* recipe, const ax_progress* progress,
                             ax_error* error);
// Applies the operator `finish`: the exact joint solve and exact deployment. `figures` (NULL: not wanted) says what moved.
ax_status ax_session_finish(ax_session* session, const ax_progress* progress, ax_finish* figures, ax_error* error);

// Walk along the history; AX_USAGE when there is nothing that way.
ax_status ax_session_undo(ax_session* session, const ax_progress* progress, ax_error* error);
ax_status ax_session_redo(ax_session* session, const ax_progress* progress, ax_error* error);
ax_status ax_session_jump(ax_session* session, int moment, const ax_progress* progress, ax_error* error);

// Variants: places of the document that have a name, to be compared; they stay where they are while the history goes on, and are no part
// of it: neither keeping nor dropping one is a moment.
enum { AX_VARIANTS_MOST = 24, AX_VARIANT_NAME = 80 }; // bytes of a name
typedef struct ax_variant {
    const char* name;
    const char* figures; // what its keeper said about it
    double time;         // seconds since 1970
    int steps, at;       // of its recipe
    bool present;        // the document stands there
} ax_variant;
// Those of the document in the order in which they were kept, borrowed until the next change.
int ax_session_variants(const ax_session* session, const ax_variant** variants);
// Keeps all steps and the state after step at - 1 under this name, instead of what had it. AX_USAGE when the name is empty or too long, or
// there are too many.
ax_status ax_session_keep_variant(ax_session* session, const char* name, const char* figures, ax_error* error);
// Makes a variant's steps and its state those of the document: one moment. AX_BAD_INPUT: there is none of this name; so below.
ax_status ax_session_take_variant(ax_session* session, const char* name, const ax_progress* progress, ax_error* error);
ax_status ax_session_drop_variant(ax_session* session, const char* name, ax_error* error);
// The form of a variant, owned by the caller. It may have to be computed again.
ax_status ax_session_variant_form(ax_session* session, const char* name, const ax_progress* progress, ax_form** form,
                                  ax_error* error);

// Replaces the finished design of the present state by the same one simulated anew (ax_design_simulate). Copies it; no moment.
ax_status ax_session_put_design(ax_session* session, const ax_design* design, ax_error* error);

// Writes the document, with its history, to another file. The session goes on in its own.
ax_status ax_session_copy(ax_session* session, const char* path, ax_error* error);
