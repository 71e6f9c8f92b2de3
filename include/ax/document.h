// The document: a .auxshell file is an SQLite database holding one design. Saving is atomic: a crash at any moment leaves the
// previous or the new document.
#pragma once

#include "ax/design.h"

ax_status ax_document_save(const char* path, const ax_design* design, ax_error* error);
// AX_BAD_INPUT when the file is missing, no document, damaged, or written by a newer version (the message says which).
ax_status ax_document_load(const char* path, ax_design* design, ax_error* error);
