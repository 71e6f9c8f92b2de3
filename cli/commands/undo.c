// auxshell undo: go back in a document's history.
#include "walk.h"

static const command_option options[] = {WALK_OPTIONS("undo")};

static ax_status run(const void* given, ax_error* error)
{
    return walk(given, "auxshell undo", ax_session_undo, error);
}

const command command_undo = {
    .name = "undo",
    .summary = "go back in a document's history",
    .text = "Goes back in a document's history by one change, or by several. What was undone can be redone, also after "
            "the document was closed, until something else is changed.",
    .options = options,
    .option_count = sizeof options / sizeof *options,
    .size = sizeof(walk_arguments),
    .defaults = walk_defaults,
    .run = run,
};
