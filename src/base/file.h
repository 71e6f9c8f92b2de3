// Writing files so that no reader ever sees half of one.
#pragma once

#include "ax/base.h"

#include <stdio.h>

// A file being written beside its final place. Begin, write to `stream` (or to `path` by other means, closing stream first), then
// commit (flushes, checks every write, renames) or abandon (removes). Both release everything.
typedef struct ax_file {
    FILE* stream; // NULL when opened with ax_file_begin_path
    char* path;   // the temporary file
    char* destination;
} ax_file;

ax_status ax_file_begin(ax_file* file, const char* destination, ax_error* error);
// The same without a stream, for libraries that open the path themselves.
ax_status ax_file_begin_path(ax_file* file, const char* destination, ax_error* error);
ax_status ax_file_commit(ax_file* file, ax_error* error);
void ax_file_abandon(ax_file* file);
// Commits if what was to be written has come so far, else abandons. Returns `status`, or what the commit says.
ax_status ax_file_end(ax_file* file, ax_status status, ax_error* error);
