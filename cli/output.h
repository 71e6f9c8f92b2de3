// Checks and helpers shared by subcommands that write files.
#pragma once

#include "ax/base.h"

// AX_USAGE unless `path` can be written: its folder exists and takes files, it is no folder itself, and it ends in `ending`
// (NULL: any). Called before long work starts, so that its result is not lost in the end.
ax_status output_check(const char* path, const char* ending, ax_error* error);
// The same for a folder that is made if only its last part is missing.
ax_status output_check_folder(const char* path, ax_error* error);
ax_status output_make_folder(const char* path, ax_error* error);
// "folder/name" in `path`; AX_USAGE if it does not fit.
ax_status output_join(const char* folder, const char* name, char* path, size_t size, ax_error* error);
