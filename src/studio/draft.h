// Documents that have no name yet: kept in the user's state folder ($XDG_STATE_HOME/auxshell, else ~/.local/state/auxshell), so that
// a crash or a closed window loses nothing.
#pragma once

#include "ax/base.h"

#include <jansson.h>

enum { DRAFT_ID = 24, DRAFT_TITLE = 128 };

// A name that no draft has: "draft-7f3kq2ma".
ax_status draft_new_id(char id[DRAFT_ID], ax_error* error);
bool draft_exists(const char* id);
// Where a draft lies, owned by the caller; its folder is made. AX_FAILED when that cannot be.
ax_status draft_path(const char* id, char** path, ax_error* error);
// The folder in which a draft's own files lie, owned by the caller; it is made.
ax_status draft_folder(const char* id, char** path, ax_error* error);
// What people know it by, in a file of its own beside it; longer titles are cut. "Unsaved design" if it was not set.
void draft_set_title(const char* id, const char* title);
void draft_title(const char* id, char title[DRAFT_TITLE]);
// Removes a draft with its files; or the document alone, and the folder if it is empty.
void draft_remove(const char* id);
void draft_forget(const char* id);
// Drafts on disk, newest first: {name, title, time}.
json_t* draft_list(void);
