// Reading what a page sends: one command, as a JSON object.
#pragma once

#include "ax/base.h"

#include <jansson.h>

enum { MESSAGE_BYTES = 1 << 20, MESSAGE_DEPTH = 32 };

typedef struct message {
    json_t* parameters; // the whole object without "do" and "id", owned
    char action[24];    // "do"
    int id;             // 0: no answer wanted
} message;

// AX_USAGE for what is no command; `out->id` then tells whom to answer, if that much could be read. `out` is then to be freed too.
ax_status message_read(const char* bytes, size_t size, message* out, ax_error* error);
void message_free(message* m);

// Takes parameters out of an object into variables, as json_unpack does with its format; a parameter that is not named in the
// format, missing, or of another kind is AX_USAGE, with the command's name in front.
ax_status message_unpack(const message* m, ax_error* error, const char* format, ...);
