// Files that a fuzzer changes: read once, written again with each input. What must hold for the fuzzer itself to work aborts.
#pragma once

#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>

static inline void promise(bool kept)
{
    if (!kept)
        abort();
}

// All bytes of a file, for the life of the process.
static inline unsigned char* read_file(const char* path, size_t* size)
{
    FILE* in = fopen(path, "rb");
    promise(in && fseek(in, 0, SEEK_END) == 0);
    *size = (size_t)ftell(in);
    rewind(in);
    unsigned char* bytes = malloc(*size);
    promise(bytes && fread(bytes, 1, *size, in) == *size);
    fclose(in);
    return bytes;
}

static inline void write_file(const char* path, const unsigned char* bytes, size_t size)
{
    FILE* out = fopen(path, "wb");
    promise(out && fwrite(bytes, 1, size, out) == size && fclose(out) == 0);
}
