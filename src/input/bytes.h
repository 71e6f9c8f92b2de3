// Whole files in memory, for readers that parse text.
#pragma once

#include "ax/base.h"

// Reads an ordinary file of 1 to `most` bytes; a zero byte follows the last. `bytes` is owned by the caller (ax_free), NULL on
// failure. AX_BAD_INPUT says what is wrong with the file, calling it `what` ("an outline").
ax_status ax_bytes_read(const char* path, const char* what, size_t most, char** bytes, size_t* size, ax_error* error);
