// auxshell redo: go forward again in a document's history.
#include "walk.h"

static const command_option options[] = {WALK_OPTIONS("redo")};

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
    .defaults = walk_defaults,
    .run = run,
};
