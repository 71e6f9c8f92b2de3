// What undo and redo share.
#pragma once

#include "options.h"

#include "ax/session.h"

typedef struct walk_arguments {
    const char* document;
    int times;
} walk_arguments;

void walk_defaults(void* arguments);
#define WALK_OPTIONS(verb)                                                                                             \
    OPTION_DOCUMENT(walk_arguments),                                                                                   \
    {                                                                                                                  \
        .name = "--times", .value = "N", .text = "changes to " verb, .kind = OPTION_INTEGER, .lo = 1, .hi = 1000000,   \
        .offset = offsetof(walk_arguments, times)                                                                      \
    }

// Takes so many steps along the history (`step`: ax_session_undo or ax_session_redo), and prints where that led; `program` is who
// does it.
ax_status walk(const walk_arguments* a, const char* program,
               ax_status (*step)(ax_session* session, const ax_progress* progress, ax_error* error), ax_error* error);

// "3 of 5 steps are applied."
void walk_print_place(const ax_session* session);
