#include "studio/files.h"

#include "base/clock.h"

#include <dirent.h>
#include <errno.h>
#include <limits.h>
#include <pthread.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/random.h>
#include <sys/stat.h>
#include <unistd.h>

enum { LIST_MOST = 1000, TICKETS_MOST = 256 };
static const double offer_seconds = 600;

typedef struct ticket {
    char token[TOKEN_LENGTH + 1];
    char name[NAME_LENGTH + 1];
    char* path;
    bool offer; // for download, once; else an upload
    double made;
} ticket;

struct files {
    char* folder;
    char* private;
    pthread_mutex_t lock;
    ticket tickets[TICKETS_MOST];
    int count;
    unsigned made; // private paths so far
};

ax_status secret_make(char* text, int length, ax_error* error)
{
    // 32 letters: five bits a byte, no bias; none that are mistaken for another
    static const char letters[] = "abcdefghijkmnpqrstuvwxyz23456789";
    unsigned char bytes[64];
    if (getrandom(bytes, (size_t)length, 0) != length)
        return ax_fail(error, AX_FAILED, "The system gives no random numbers: %s.", strerror(errno));
    for (int k = 0; k < length; ++k)
        text[k] = letters[bytes[k] & 31];
    text[length] = 0;
    return AX_OK;
}

bool secret_equal(const char* a, const char* b, size_t length)
{
    unsigned char differ = 0;
    for (size_t k = 0; k < length; ++k)
        differ |= (unsigned char)(a[k] ^ b[k]);
    return !differ;
}

static char* joined(const char* folder, const char* name)
{
    size_t size = strlen(folder) + strlen(name) + 2;
    char* path = ax_alloc(size, 1);
    snprintf(path, size, "%s/%s", folder, name);
    return path;
}

ax_status files_open(const char* folder, files** out, ax_error* error)
{
    char absolute[PATH_MAX];
    *out = NULL;
    if (!realpath(folder ? folder : ".", absolute))
        return ax_fail(error, AX_BAD_INPUT, "The folder %s cannot be used: %s.", folder ? folder : ".",
                       strerror(errno));
    const char* temporary = getenv("TMPDIR");
    char* private = joined(temporary ? temporary : "/tmp", "auxshell-XXXXXX");
    if (!mkdtemp(private)) {
        ax_status status =
            ax_fail(error, AX_FAILED, "No folder for temporary files could be made: %s: %s.", private, strerror(errno));
        ax_free(private);
        return status;
    }
    files* f = AX_NEW0(files, 1);
    f->private = private;
    f->folder = ax_copy(absolute, strlen(absolute) + 1, 1);
    pthread_mutex_init(&f->lock, NULL);
    *out = f;
    return AX_OK;
}

void files_remove(const files* f, const char* path)
{
    unlink(path);
    char* folder = ax_copy(path, strlen(path) + 1, 1);
    *strrchr(folder, '/') = 0;
    if (strcmp(folder, f->private) != 0)
        rmdir(folder); // stays while there is more in it
    ax_free(folder);
}

static void drop(files* f, int k)
{
    files_remove(f, f->tickets[k].path);
    ax_free(f->tickets[k].path);
    f->tickets[k] = f->tickets[--f->count];
}

void files_close(files* f)
{
    if (!f)
        return;
    while (f->count)
        drop(f, 0);
    rmdir(f->private);
    pthread_mutex_destroy(&f->lock);
    ax_free(f->private);
    ax_free(f->folder);
    ax_free(f);
}

const char* files_folder(const files* f)
{
    return f->folder;
}

const char* files_relative(const files* f, const char* path)
{
    size_t length = strcmp(f->folder, "/") == 0 ? 0 : strlen(f->folder);
    return strncmp(path, f->folder, length) == 0 && path[length] == '/' ? path + length + 1 : NULL;
}

ax_status files_within(const files* f, const char* name, char** path, ax_error* error)
{
    char absolute[PATH_MAX], folder[PATH_MAX];
    *path = NULL;
    if (!*name || *name == '/' || strlen(name) >= PATH_MAX / 2 || strlen(f->folder) >= PATH_MAX / 2 - 2)
        return ax_fail(error, AX_BAD_INPUT,
                       "\"%.200s\" is no path within the studio's folder: give one relative to it.", name);
    snprintf(folder, sizeof folder, "%s/%s", f->folder, name);
    char* last = strrchr(folder, '/');
    *last++ = 0;
    if (!files_name_is_plain(last))
        return ax_fail(error, AX_BAD_INPUT, "\"%.200s\" is no name of a file.", name);
    if (!realpath(folder, absolute))
        return ax_fail(error, AX_BAD_INPUT, "The folder of \"%.200s\" cannot be used: %s.", name, strerror(errno));
    if (strcmp(absolute, f->folder) != 0 && !files_relative(f, absolute))
        return ax_fail(error, AX_BAD_INPUT, "\"%.200s\" lies outside the folder that the studio was started in.", name);
    char* whole = joined(absolute, last);
    if (realpath(whole, absolute) && !files_relative(f, absolute)) { // a link that leads out
        ax_free(whole);
        return ax_fail(error, AX_BAD_INPUT,
                       "\"%.200s\" is a link that leads out of the folder that the studio was started in.", name);
    }
    *path = whole;
    return AX_OK;
}

bool files_name_is_plain(const char* name)
{
    size_t length = strlen(name);
    if (length == 0 || length > NAME_LENGTH || *name == '.')
        return false;
    for (const char* c = name; *c; ++c)
        if (*c == '/' || (unsigned char)*c < 32 || *c == 127)
            return false;
    return true;
}

static bool is_openable(const char* name)
{
    static const char* const endings[] = {".auxshell", ".json", ".obj", ".stl", ".ply",
                                          ".off",      ".svg",  ".dxf", ".csv", ".png"};
    const char* dot = strrchr(name, '.');
    for (size_t k = 0; dot && k < sizeof endings / sizeof *endings; ++k)
        if (strcasecmp(dot, endings[k]) == 0)
            return true;
    return false;
}

ax_status files_list(const files* f, const char* folder, json_t** list, ax_error* error)
{
    char* path = NULL;
    if (folder && *folder) {
        ax_status status = files_within(f, folder, &path, error);
        if (status != AX_OK)
            return status;
    }
    DIR* open = opendir(path ? path : f->folder);
    if (!open) {
        ax_free(path);
        return ax_fail(error, AX_BAD_INPUT, "The folder \"%.200s\" cannot be read: %s.", folder ? folder : "",
                       strerror(errno));
    }
    *list = json_array();
    for (struct dirent* entry; (entry = readdir(open)) && json_array_size(*list) < LIST_MOST;) {
        struct stat about;
        if (!files_name_is_plain(entry->d_name) || fstatat(dirfd(open), entry->d_name, &about, 0) != 0)
            continue;
        bool is_folder = S_ISDIR(about.st_mode);
        if (is_folder || (S_ISREG(about.st_mode) && is_openable(entry->d_name))) {
            json_t* row = json_pack("{s:s, s:I, s:I, s:b}", "name", entry->d_name, "bytes", (json_int_t)about.st_size,
                                    "time", (json_int_t)about.st_mtime, "folder", is_folder);
            if (row) // not for names that are no UTF-8
                json_array_append_new(*list, row);
        }
    }
    closedir(open);
    ax_free(path);
    return AX_OK;
}

char* files_new_path(files* f, const char* name)
{
    char file[32];
    const char* dot = strrchr(name, '.');
    pthread_mutex_lock(&f->lock);
    snprintf(file, sizeof file, "%u%.16s", f->made++, dot && !strchr(dot, '/') ? dot : "");
    pthread_mutex_unlock(&f->lock);
    return joined(f->private, file);
}

static ax_status add(files* f, const char* path, const char* name, bool offer, char token[TOKEN_LENGTH + 1],
                     ax_error* error)
{
    ax_status status = secret_make(token, TOKEN_LENGTH, error);
    if (status != AX_OK)
        return status;
    pthread_mutex_lock(&f->lock);
    double now = ax_seconds();
    for (int k = f->count; k-- > 0;)
        if (f->tickets[k].offer && now - f->tickets[k].made > offer_seconds)
            drop(f, k);
    if (f->count == TICKETS_MOST) { // the oldest goes
        int oldest = 0;
        for (int k = 1; k < f->count; ++k)
            if (f->tickets[k].made < f->tickets[oldest].made)
                oldest = k;
        drop(f, oldest);
    }
    ticket* t = &f->tickets[f->count++];
    *t = (ticket){.path = ax_copy(path, strlen(path) + 1, 1), .offer = offer, .made = now};
    snprintf(t->name, sizeof t->name, "%s", name);
    memcpy(t->token, token, TOKEN_LENGTH + 1);
    pthread_mutex_unlock(&f->lock);
    return AX_OK;
}

ax_status files_uploaded(files* f, const char* path, const char* name, char token[TOKEN_LENGTH + 1], ax_error* error)
{
    return add(f, path, name, false, token, error);
}

ax_status files_offer(files* f, const char* path, const char* name, char token[TOKEN_LENGTH + 1], ax_error* error)
{
    return add(f, path, name, true, token, error);
}

// The place of a ticket; the lock is held.
static int find(const files* f, const char* token, bool offer)
{
    for (int k = 0; strlen(token) == TOKEN_LENGTH && k < f->count; ++k)
        if (f->tickets[k].offer == offer && secret_equal(f->tickets[k].token, token, TOKEN_LENGTH))
            return k;
    return -1;
}

ax_status files_upload(files* f, const char* token, char** path, char* name, ax_error* error)
{
    pthread_mutex_lock(&f->lock);
    int k = find(f, token, false);
    if (k >= 0) {
        *path = ax_copy(f->tickets[k].path, strlen(f->tickets[k].path) + 1, 1);
        strcpy(name, f->tickets[k].name);
    }
    pthread_mutex_unlock(&f->lock);
    return k >= 0 ? AX_OK : ax_fail(error, AX_BAD_INPUT, "There is no such upload (any more): send the file again.");
}

bool files_take(files* f, const char* token, char** path, char* name)
{
    pthread_mutex_lock(&f->lock);
    int k = find(f, token, true);
    bool good = k >= 0 && ax_seconds() - f->tickets[k].made <= offer_seconds;
    if (good) {
        *path = f->tickets[k].path;
        strcpy(name, f->tickets[k].name);
        f->tickets[k] = f->tickets[--f->count];
    }
    pthread_mutex_unlock(&f->lock);
    return good;
}
