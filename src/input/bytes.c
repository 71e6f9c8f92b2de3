#include "input/bytes.h"

#include <errno.h>
#include <stdio.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

// Opening would hang on a pipe, so the kind comes first.
static ax_status check(const char* path, const char* what, size_t most, size_t* size, ax_error* error)
{
    struct stat info;
    if (stat(path, &info) != 0)
        return ax_fail(error, AX_BAD_INPUT, "%s cannot be read: %s. Check the name and the folder.", path,
                       strerror(errno));
    if (S_ISDIR(info.st_mode))
        return ax_fail(error, AX_BAD_INPUT, "%s is a folder. Name %s, for example one inside it.", path, what);
    if (!S_ISREG(info.st_mode))
        return ax_fail(error, AX_BAD_INPUT, "%s is no ordinary file. Save %s to a file and name that.", path, what);
    if (info.st_size == 0)
        return ax_fail(error, AX_BAD_INPUT, "%s is empty (0 bytes). Export it again.", path);
    if ((size_t)info.st_size > most)
        return ax_fail(error, AX_BAD_INPUT, "%s has %.0f MB; %s may have %zu. Leave out what is not needed.", path,
                       (double)info.st_size / 1e6, what, most / 1000000);
    *size = (size_t)info.st_size;
    return AX_OK;
}

ax_status ax_bytes_read(const char* path, const char* what, size_t most, char** bytes, size_t* size, ax_error* error)
{
    *bytes = NULL;
    ax_status status = check(path, what, most, size, error);
    if (status != AX_OK)
        return status;
    FILE* in = fopen(path, "rb");
    if (!in)
        return ax_fail(error, AX_BAD_INPUT, "%s cannot be read: %s. Give yourself the right to read it.", path,
                       strerror(errno));
    char* block = AX_NEW(char, *size + 1);
    errno = 0;
    bool whole = fread(block, 1, *size, in) == *size;
    int reason = errno;
    fclose(in);
    if (!whole) {
        ax_free(block);
        return ax_fail(error, AX_BAD_INPUT, "%s cannot be read: %s. Try again when nothing else writes to it.", path,
                       reason ? strerror(reason) : "it became shorter");
    }
    block[*size] = '\0';
    *bytes = block;
    return AX_OK;
}
