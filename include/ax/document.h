// The document: a .auxshell file is an SQLite database holding a design and the history that led to it (ax/session.h). Saving is
// atomic: a crash at any moment leaves the previous or the new document.
#pragma once

#include "ax/design.h"

// A document that holds a design and nothing before it. AX_FAILED when it cannot be written, or another program edits the one there.
ax_status ax_document_save(const char* path, const ax_design* design, ax_error* error);
// The design at the present moment of the document's history: the finished one, or else what the states are as they stand
// (ax_form_snapshot). AX_BAD_INPUT when the file is missing, no document, damaged, empty, or written by a newer version (the message
// says which).
ax_status ax_document_load(const char* path, ax_design* design, ax_error* error);
// When the present moment of the document's history was made, or if that is not known, when the file was written: seconds since 1970.
// NaN if the file cannot be read.
double ax_document_time(const char* path);
