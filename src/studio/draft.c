#include "studio/draft.h"

#include "base/file.h"
#include "studio/files.h"

#include <dirent.h>
#include <errno.h>
#include <limits.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

enum { NAME_LETTERS = 8, LIST_MOST = 32 };
static const char prefix[] = "draft-";
static const char ending[] = ".auxshell", title_ending[] = ".title";

ax_status draft_new_id(char id[DRAFT_ID], ax_error* error)
{
    strcpy(id, prefix);
    return secret_make(id + strlen(prefix), NAME_LETTERS, error);
}

static bool is_id(const char* id)
{
    return strncmp(id, prefix, strlen(prefix)) == 0 && strlen(id) == strlen(prefix) + NAME_LETTERS &&
           strspn(id + strlen(prefix), "abcdefghijklmnopqrstuvwxyz0123456789") == NAME_LETTERS;
}

static void folder(char path[PATH_MAX])
{
    const char *state = getenv("XDG_STATE_HOME"), *home = getenv("HOME");
    if (state && *state == '/')
        snprintf(path, PATH_MAX, "%s/auxshell", state);
    else
        snprintf(path, PATH_MAX, "%s/.local/state/auxshell", home && *home ? home : "/tmp");
}

static void file_of(const char* id, const char* ends, char path[PATH_MAX + 64])
{
    char in[PATH_MAX];
    folder(in);
    snprintf(path, PATH_MAX + 64, "%s/%s%s", in, id, ends);
}

static void file(const char* id, char path[PATH_MAX + 64])
{
    file_of(id, ending, path);
}

void draft_set_title(const char* id, const char* title)
{
    char path[PATH_MAX + 64];
    ax_file out;
    file_of(id, title_ending, path);
    if (ax_file_begin(&out, path, NULL) != AX_OK)
        return; // a title is not worth a failure
    fputs(title, out.stream);
    ax_file_commit(&out, NULL);
}

void draft_title(const char* id, char title[DRAFT_TITLE])
{
    char path[PATH_MAX + 64];
    file_of(id, title_ending, path);
    FILE* in = is_id(id) ? fopen(path, "r") : NULL;
    if (!in || !fgets(title, DRAFT_TITLE, in))
        strcpy(title, "Unsaved design");
    title[strcspn(title, "\n")] = 0;
    if (in)
        fclose(in);
}

bool draft_exists(const char* id)
{
    char path[PATH_MAX + 64];
    struct stat about;
    if (!is_id(id))
        return false;
    file(id, path);
    return stat(path, &about) == 0 && S_ISREG(about.st_mode);
}

ax_status draft_path(const char* id, char** path, ax_error* error)
{
    char in[PATH_MAX], whole[PATH_MAX + 64];
    folder(in);
    for (char* slash = in + 1; (slash = strchr(slash, '/'));
         *slash++ = '/') { // private from the first part that is missing
        *slash = 0;
        mkdir(in, 0700);
    }
    struct stat about;
    if (mkdir(in, 0700) != 0 && (stat(in, &about) != 0 || !S_ISDIR(about.st_mode)))
        return ax_fail(error, AX_FAILED, "The folder %s for unsaved documents cannot be made: %s.", in,
                       strerror(errno));
    file(id, whole);
    *path = ax_copy(whole, strlen(whole) + 1, 1);
    return AX_OK;
}

ax_status draft_folder(const char* id, char** path, ax_error* error)
{
    ax_status status = draft_path(id, path, error);
    if (status != AX_OK)
        return status;
    (*path)[strlen(*path) - strlen(ending)] = 0;
    struct stat about;
    if (mkdir(*path, 0700) != 0 && (stat(*path, &about) != 0 || !S_ISDIR(about.st_mode))) {
        status =
            ax_fail(error, AX_FAILED, "The folder %s for uploaded files cannot be made: %s.", *path, strerror(errno));
        ax_free(*path);
        *path = NULL;
    }
    return status;
}

static void remove_draft(const char* id, bool with_files)
{
    char path[PATH_MAX + 64];
    file_of(id, title_ending, path);
    unlink(path);
    file(id, path);
    unlink(path);
    path[strlen(path) - strlen(ending)] = 0;
    DIR* open = with_files ? opendir(path) : NULL;
    for (struct dirent* entry; open && (entry = readdir(open));)
        unlinkat(dirfd(open), entry->d_name, 0); // plain files only: nothing else is put there
    if (open)
        closedir(open);
    rmdir(path);
}

void draft_remove(const char* id)
{
    remove_draft(id, true);
}

void draft_forget(const char* id)
{
    remove_draft(id, false);
}

static int newest_first(const void* a, const void* b)
{
    json_int_t x = json_integer_value(json_object_get(*(json_t* const*)a, "time"));
    json_int_t y = json_integer_value(json_object_get(*(json_t* const*)b, "time"));
    return (x < y) - (x > y);
}

json_t* draft_list(void)
{
    char in[PATH_MAX];
    json_t* rows[256];
    size_t count = 0;
    folder(in);
    DIR* open = opendir(in);
    for (struct dirent* entry; open && count < sizeof rows / sizeof *rows && (entry = readdir(open));) {
        char id[DRAFT_ID];
        struct stat about;
        size_t length = strlen(entry->d_name);
        if (length <= strlen(ending) || strcmp(entry->d_name + length - strlen(ending), ending) != 0)
            continue;
        snprintf(id, sizeof id, "%.*s", (int)(length - strlen(ending)), entry->d_name);
        if (!is_id(id) || fstatat(dirfd(open), entry->d_name, &about, 0) != 0)
            continue;
        char title[DRAFT_TITLE];
        draft_title(id, title);
        json_t* words = json_string(title); // NULL where a damaged file is no text
        rows[count++] = json_pack("{s:s, s:o, s:I}", "name", id, "title", words ? words : json_string("Unsaved design"),
                                  "time", (json_int_t)about.st_mtime);
    }
    if (open)
        closedir(open);
    qsort(rows, count, sizeof *rows, newest_first);
    json_t* list = json_array();
    for (size_t k = 0; k < count; ++k)
        if (k < LIST_MOST)
            json_array_append_new(list, rows[k]);
        else
            json_decref(rows[k]);
    return list;
}
