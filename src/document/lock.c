#include "document/lock.h"

#include <errno.h>
#include <fcntl.h>
#include <libgen.h>
#include <limits.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

struct ax_lock {
    int descriptor;
    char path[PATH_MAX];
};

// The same for every name of the document.
static bool lock_path(const char* document, char out[PATH_MAX])
{
    char real[PATH_MAX], folder[PATH_MAX], name[PATH_MAX];
    if (!realpath(document, real)) { // not there yet
        char copy[PATH_MAX], resolved[PATH_MAX];
        if (snprintf(copy, sizeof copy, "%s", document) >= PATH_MAX || !realpath(dirname(copy), resolved))
            return false;
        snprintf(copy, sizeof copy, "%s", document);
        if (snprintf(real, sizeof real, "%s/%s", resolved, basename(copy)) >= PATH_MAX)
            return false;
    }
    strcpy(folder, real);
    strcpy(name, real);
    return snprintf(out, PATH_MAX, "%s/.%s.lock", dirname(folder), basename(name)) < PATH_MAX;
}

// Whoever lets go removes the file, so the one that was locked may no longer be the one that is there.
static bool still_there(int descriptor, const char* path)
{
    struct stat a, b;
    return fstat(descriptor, &a) == 0 && stat(path, &b) == 0 && a.st_dev == b.st_dev && a.st_ino == b.st_ino;
}

// Who holds the lock, in the words it has left.
static void read_words(int descriptor, char words[256])
{
    ssize_t length = pread(descriptor, words, 255, 0);
    words[length > 0 ? length : 0] = '\0';
    words[strcspn(words, "\n")] = '\0';
    if (!*words)
        strcpy(words, "another program");
}

static void write_words(int descriptor, const char* program)
{
    char words[256], host[64] = "";
    gethostname(host, sizeof host - 1);
    int length = snprintf(words, sizeof words, "%.100s (process %ld on %s)\n", program ? program : "another program",
                          (long)getpid(), host);
    // for people only: a full disk does not matter
    if (ftruncate(descriptor, 0) == 0 && pwrite(descriptor, words, (size_t)length, 0) != length)
        errno = 0;
}

ax_status ax_lock_take(const char* path, const char* program, ax_lock** out, ax_error* error)
{
    *out = NULL;
    ax_lock* lock = AX_NEW0(ax_lock, 1);
    if (!lock_path(path, lock->path)) {
        ax_free(lock);
        return ax_fail(error, AX_FAILED, "Cannot write %s: its folder is not there, or its name is too long.", path);
    }
    for (;;) {
        lock->descriptor = open(lock->path, O_RDWR | O_CREAT | O_CLOEXEC, 0666);
        if (lock->descriptor < 0) {
            int reason = errno;
            ax_free(lock);
            return ax_fail(error, AX_FAILED, "Cannot write %s: %s.", path, strerror(reason));
        }
        if (flock(lock->descriptor, LOCK_EX | LOCK_NB) != 0) {
            char words[256];
            read_words(lock->descriptor, words);
            close(lock->descriptor);
            ax_free(lock);
            return ax_fail(error, AX_FAILED, "%s is open in %s. Close it there to change it here.", path, words);
        }
        if (still_there(lock->descriptor, lock->path))
            break;
        close(lock->descriptor);
    }
    write_words(lock->descriptor, program);
    *out = lock;
    return AX_OK;
}

ax_status ax_lock_new(const char* path, const char* program, ax_file* file, ax_lock** out, ax_error* error)
{
    ax_status status = ax_file_begin_path(file, path, error);
    if (status != AX_OK)
        return status;
    status = ax_lock_take(path, program, out, error);
    if (status != AX_OK)
        ax_file_abandon(file);
    return status;
}

void ax_lock_release(ax_lock* lock)
{
    if (!lock)
        return;
    unlink(lock->path);
    close(lock->descriptor);
    ax_free(lock);
}
