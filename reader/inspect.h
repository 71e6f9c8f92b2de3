// Looks through an OBJ, STL, PLY or OFF file for what importers pass over in silence or report without a place: a file
// that breaks off, corners that do not exist, numbers that are none.
#pragma once

#include <stdbool.h>
#include <stddef.h>

typedef struct inspection {
    char message[512]; // what, where and how to mend it; empty if nothing was found
} inspection;

// The format is told by the ending of `name`; other files pass. `data` need not be terminated.
bool inspect(const char* name, const char* data, size_t size, inspection* found);
