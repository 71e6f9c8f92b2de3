// The document behind a desk: its recipe, where in it the design stands, undo and redo, and the settled form. Used by one thread.
#pragma once

#include "ax/document.h"
#include "ax/recipe.h"

typedef struct session session;

// A document at `path`, which is made if it is not there; with `recipe` (JSON text, NULL: none) as its steps. `folder`: where steps
// find files.
ax_status session_open(const char* path, const char* recipe, const char* folder, const ax_progress* progress,
                       session** out, ax_error* error);
void session_close(session* s);

const ax_recipe* session_recipe(const session* s);
int session_at(const session* s);
// The form after step at - 1, settled; while steps are played, the one that is being made. Borrowed until the next change.
ax_form* session_form(const session* s);
// The exact design, if the present state is exact; borrowed.
const ax_design* session_exact(const session* s);
const char* session_undo_words(const session* s); // NULL: nothing to undo
const char* session_redo_words(const session* s);
// The step that failed when steps were played, -1 if none did; and why.
int session_failed(const session* s, const ax_error** error);

// Every change is one undo step. On failure the document is as it was, but for steps played again: see session_failed.
ax_status session_apply(session* s, const char* step, const ax_progress* progress, ax_error* error);
ax_status session_edit(session* s, int k, const char* step, const ax_progress* progress,
                       ax_error* error); // NULL: removes
ax_status session_go(session* s, int at, const ax_progress* progress, ax_error* error);
ax_status session_undo(session* s, const ax_progress* progress, ax_error* error);
ax_status session_redo(session* s, const ax_progress* progress, ax_error* error);
ax_status session_finish(session* s, const ax_progress* progress, ax_finish* finish, ax_error* error);
ax_status session_replace(session* s, const char* recipe, const ax_progress* progress, ax_error* error); // all steps
