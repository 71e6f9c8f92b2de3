// auxshell redo: go forward again in a document's history.
#include "options.h"
#include "walk.h"

static void defaults(void* given)
{
    ((walk_arguments*)given)->times = 1;
}

static const command_option options[] = {
    OPTION_DOCUMENT(walk_arguments),
    {.name = "--times",
     .value = "N",
     .text = "changes to redo",
     .kind = OPTION_INTEGER,
     .lo = 1,
     .hi = 1000000,
     .offset = offsetof(walk_arguments, times)},
};

static ax_status run(const void* given, ax_error* error)
{
    return walk(given, "auxshell redo", ax_session_redo, error);
}

const command command_redo = {
    .name = "redo",
    .summary = "go forward again in a document's history",
    .text = "Goes forward in a document's history by one change that was undone, or by several.",
    .options = options,
    .option_count = sizeof options / sizeof *options,
    .size = sizeof(walk_arguments),
    .defaults = defaults,
    .run = run,
};
