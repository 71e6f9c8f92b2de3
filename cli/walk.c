#include "walk.h"

#include "progress.h"

#include <stdio.h>

void walk_print_place(const ax_session* session)
{
    const char* why;
    int steps = ax_recipe_count(ax_session_recipe(session)), at = ax_session_at(session);
    printf("%d of %d steps %s applied.\n", at, steps, at == 1 ? "is" : "are");
    int failed = ax_session_failed(session, &why);
    if (failed >= 0)
        printf("Step %d failed when it was played again: %s\n", failed + 1, why);
}

void walk_defaults(void* given)
{
    ((walk_arguments*)given)->times = 1;
}

ax_status walk(const walk_arguments* a, const char* program,
               ax_status (*step)(ax_session* session, const ax_progress* progress, ax_error* error), ax_error* error)
{
    ax_session* session;
    ax_status status = ax_session_open(a->document, true, program, progress_reporter(), &session, error);
    if (status != AX_OK)
        return status;
    for (int k = 0; k < a->times && status == AX_OK; ++k) {
        const ax_moment* moments;
        int before, after, count = ax_session_history(session, NULL, &before);
        if (k > 0 && (before == 0 || before + 1 == count)) // an end that was reached is no error
            break;
        status = step(session, progress_reporter(), error);
        progress_end();
        ax_session_history(session, &moments, &after);
        if (status == AX_OK)
            printf("%s: %s\n", after < before ? "Undone" : "Done again",
                   moments[after < before ? before : after].words);
    }
    if (status == AX_OK)
        walk_print_place(session);
    ax_session_close(session);
    return status;
}
