#include "base/file.h"

#include <errno.h>
#include <fcntl.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

ax_status ax_file_begin_path(ax_file* file, const char* destination, ax_error* error)
{
    *file = (ax_file){0};
    struct stat info;
    if (stat(destination, &info) == 0 && S_ISDIR(info.st_mode))
        return ax_fail(error, AX_FAILED, "%s is a folder. Give the name of a file to write.", destination);
    size_t length = strlen(destination);
    file->destination = ax_copy(destination, length + 1, 1);
    file->path = ax_alloc(length + 16, 1);
    snprintf(file->path, length + 16, "%s.part-XXXXXX", destination);
    int descriptor = mkstemp(file->path);
    if (descriptor < 0) {
        int reason = errno;
        ax_status status = ax_fail(error, AX_FAILED, "Cannot write %s: %s.", destination, strerror(reason));
        ax_free(file->path);
        ax_free(file->destination);
        *file = (ax_file){0};
        return status;
    }
    mode_t mask = umask(0); // mkstemp makes private files; a result has the usual permissions
    umask(mask);
    fchmod(descriptor, 0666 & ~mask);
    close(descriptor);
    return AX_OK;
}

ax_status ax_file_begin(ax_file* file, const char* destination, ax_error* error)
{
    ax_status status = ax_file_begin_path(file, destination, error);
    if (status != AX_OK)
        return status;
    file->stream = fopen(file->path, "wb");
    if (!file->stream) {
        status = ax_fail(error, AX_FAILED, "Cannot write %s: %s.", destination, strerror(errno));
        ax_file_abandon(file);
    }
    return status;
}

static void release(ax_file* file)
{
    ax_free(file->path);
    ax_free(file->destination);
    *file = (ax_file){0};
}

static bool flush_to_disk(ax_file* file)
{
    if (file->stream) {
        bool sound = !ferror(file->stream) && fflush(file->stream) == 0 && fsync(fileno(file->stream)) == 0;
        int reason = errno;
        sound = fclose(file->stream) == 0 && sound;
        errno = reason ? reason : errno;
        file->stream = NULL;
        return sound;
    }
    int descriptor = open(file->path, O_RDWR);
    bool sound = descriptor >= 0 && fsync(descriptor) == 0;
    if (descriptor >= 0)
        close(descriptor);
    return sound;
}

ax_status ax_file_commit(ax_file* file, ax_error* error)
{
    errno = 0;
    if (flush_to_disk(file) && rename(file->path, file->destination) == 0) {
        release(file);
        return AX_OK;
    }
    ax_status status = ax_fail(error, AX_FAILED, "Cannot write %s: %s. Nothing was changed.", file->destination,
                               errno ? strerror(errno) : "the disk did not take it; it may be full");
    ax_file_abandon(file);
    return status;
}

void ax_file_abandon(ax_file* file)
{
    if (file->stream)
        fclose(file->stream);
    if (file->path)
        unlink(file->path);
    release(file);
}

ax_status ax_file_end(ax_file* file, ax_status status, ax_error* error)
{
    if (status == AX_OK)
        return ax_file_commit(file, error);
    ax_file_abandon(file);
    return status;
}
