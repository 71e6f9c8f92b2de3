// What undo and redo share.
#pragma once

#include "ax/session.h"

typedef struct walk_arguments {
    const char* document;
    int times;
} walk_arguments;

// Takes so many steps along the history (`step`: ax_session_undo or ax_session_redo), and prints where that led; `program` is who
// does it.
ax_status walk(const walk_arguments* a, const char* program,
               ax_status (*step)(ax_session* session, const ax_progress* progress, ax_error* error), ax_error* error);

// "3 of 5 steps are applied."
void walk_print_place(const ax_session* session);
