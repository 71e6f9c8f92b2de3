// One program edits a document at a time. The lock is a file beside it, .NAME.lock, which the kernel lets go when the program ends,
// however it ends; a lock on the document itself would be lost with the first descriptor of it that is closed, and would not outlive
// its replacement by a new file.
#pragma once

#include "ax/base.h"
#include "base/file.h"

typedef struct ax_lock ax_lock;

// `program`: what others are told, NULL: "another program". AX_FAILED when another one has the lock (the message says which), or
// when there can be none because the folder cannot be written.
ax_status ax_lock_take(const char* path, const char* program, ax_lock** out, ax_error* error);
// Begins a new document (ax_file_begin_path) that is locked meanwhile: both or neither.
ax_status ax_lock_new(const char* path, const char* program, ax_file* file, ax_lock** out, ax_error* error);
void ax_lock_release(ax_lock* lock); // NULL allowed
