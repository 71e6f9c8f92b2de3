#include "output.h"

#include <errno.h>
#include <limits.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

ax_status output_join(const char* folder, const char* name, char* path, size_t size, ax_error* error)
{
    size_t length = strlen(folder);
    const char* slash = length && folder[length - 1] == '/' ? "" : "/";
    if ((size_t)snprintf(path, size, "%s%s%s", folder, slash, name) >= size)
        return ax_fail(error, AX_USAGE, "The name of the folder %s is too long.", folder);
    return AX_OK;
}

// Tries it: permission bits alone do not tell (root, read-only mounts, folders of the kernel).
static ax_status check_takes_files(const char* folder, ax_error* error)
{
    struct stat info;
    if (stat(folder, &info) != 0)
        return ax_fail(error, AX_USAGE, "The folder %s cannot be used: %s. Make it first.", folder, strerror(errno));
    if (!S_ISDIR(info.st_mode))
        return ax_fail(error, AX_USAGE, "%s is no folder.", folder);
    char probe[PATH_MAX];
    ax_status status = output_join(folder, ".auxshell-XXXXXX", probe, sizeof probe, error);
    if (status != AX_OK)
        return status;
    int descriptor = mkstemp(probe);
    if (descriptor < 0)
        return ax_fail(error, AX_USAGE, "No file can be written in the folder %s: %s. Choose another.", folder,
                       strerror(errno));
    close(descriptor);
    unlink(probe);
    return AX_OK;
}

// The folder of a path without trailing slashes: "." for a bare name.
static void folder_of(const char* path, char* folder, size_t size)
{
    const char* slash = strrchr(path, '/');
    if (!slash)
        snprintf(folder, size, ".");
    else
        snprintf(folder, size, "%.*s", slash == path ? 1 : (int)(slash - path), path);
}

ax_status output_check(const char* path, const char* ending, ax_error* error)
{
    if (strlen(path) >= PATH_MAX)
        return ax_fail(error, AX_USAGE, "The name of the file to write is longer than the system allows.");
    const char *slash = strrchr(path, '/'), *name = slash ? slash + 1 : path;
    size_t length = strlen(name), ending_length = ending ? strlen(ending) : 0;
    if (ending && (length <= ending_length || strcmp(name + length - ending_length, ending) != 0))
        return ax_fail(error, AX_USAGE, "The file to write must end in %s: %s%s.", ending, path, ending);
    struct stat info;
    if (stat(path, &info) == 0 && S_ISDIR(info.st_mode))
        return ax_fail(error, AX_USAGE, "%s is a folder. Give the name of a file to write.", path);
    char folder[PATH_MAX];
    folder_of(path, folder, sizeof folder);
    return check_takes_files(folder, error);
}

ax_status output_check_folder(const char* path, ax_error* error)
{
    struct stat info;
    if (stat(path, &info) == 0)
        return check_takes_files(path, error);
    char name[PATH_MAX], folder[PATH_MAX];
    size_t length = strlen(path);
    if (length >= sizeof name)
        return ax_fail(error, AX_USAGE, "The name of the folder to write is longer than the system allows.");
    memcpy(name, path, length + 1);
    while (length > 1 && name[length - 1] == '/')
        name[--length] = 0;
    folder_of(name, folder, sizeof folder);
    return check_takes_files(folder, error);
}

ax_status output_make_folder(const char* path, ax_error* error)
{
    if (mkdir(path, 0777) != 0 && errno != EEXIST)
        return ax_fail(error, AX_FAILED, "The folder %s cannot be made: %s.", path, strerror(errno));
    return AX_OK;
}
