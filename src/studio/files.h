// Files the studio may touch: within one folder, uploads, and files offered for download, each behind a token. Thread safe.
#pragma once

#include "ax/base.h"

#include <jansson.h>

enum { SECRET_LENGTH = 32, TOKEN_LENGTH = 20, UPLOAD_BYTES = 64 << 20, NAME_LENGTH = 128 };

// `length` letters and digits that cannot be guessed; text holds one more for the end.
ax_status secret_make(char* text, int length, ax_error* error);
// Takes as long for every text of one length.
bool secret_equal(const char* a, const char* b, size_t length);

typedef struct files files;

// `folder` as given; the private folder for uploads and downloads goes with the studio.
ax_status files_open(const char* folder, files** out, ax_error* error);
void files_close(files* f);
const char* files_folder(const files* f); // absolute, no links in it

// The absolute path of `name` within the folder, owned by the caller. AX_BAD_INPUT for what lies outside, also through links; the
// file itself need not exist, its folder must.
ax_status files_within(const files* f, const char* name, char** path, ax_error* error);
// `path` as seen from the folder, or NULL when it is outside; points into `path`.
const char* files_relative(const files* f, const char* path);
// What can be opened in a folder within, as the protocol's answer.
ax_status files_list(const files* f, const char* folder, json_t** list, ax_error* error);

// A plain file name for people: no slashes, no control characters, not hidden, at most NAME_LENGTH bytes.
bool files_name_is_plain(const char* name);

// Removes a private file, and with the last one the folder that an export made for it.
void files_remove(const files* f, const char* path);
// A private path for a file that is about to be written, which keeps the ending of `name`; owned by the caller.
char* files_new_path(files* f, const char* name);
// An upload that has arrived at a private path: the token by which commands call it.
ax_status files_uploaded(files* f, const char* path, const char* name, char token[TOKEN_LENGTH + 1], ax_error* error);
// Where an upload lies, and its name (NAME_LENGTH + 1 bytes). AX_BAD_INPUT for an unknown token.
ax_status files_upload(files* f, const char* token, char** path, char* name, ax_error* error);

// Offers a private file for one download; the file goes when it was fetched or after ten minutes.
ax_status files_offer(files* f, const char* path, const char* name, char token[TOKEN_LENGTH + 1], ax_error* error);
// Takes an offer: where it lies (owned by the caller, who removes the file) and its name. False if there is none (any more).
bool files_take(files* f, const char* token, char** path, char* name);
