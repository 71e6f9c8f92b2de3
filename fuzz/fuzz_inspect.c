// Text and bytes in the four formats that are looked through before the importer sees them.
#include "inspect.h"

#include <stdint.h>
#include <stdlib.h>
#include <string.h>

int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size);

// The first byte chooses the format.
int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size)
{
    static const char* const names[] = {"a.obj", "a.stl", "a.ply", "a.off"};
    static const char* const starts[] = {"", "solid x\n", "ply\nformat ", "OFF\n"};
    if (size < 1)
        return 0;
    size_t format = data[0] % 4, start = data[0] & 4 ? strlen(starts[format]) : 0;
    size_t length = start + size - 1;
    char* copy = malloc(length ? length : 1); // exactly as long as the input, so that the sanitizer sees the end
    memcpy(copy, starts[format], start);
    memcpy(copy + start, data + 1, size - 1);
    inspection found;
    bool sound = inspect(names[format], copy, length, &found);
    if (sound != !found.message[0] || (!sound && found.message[strlen(found.message) - 1] != '.'))
        abort();
    free(copy);
    return 0;
}
