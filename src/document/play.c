// Playing the recipe: a change is tried on forms of its own before anything of the session is touched.
#include "document/session.h"

#include "document/design_rows.h"
#include "input/bytes.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

enum { most_file = 256 << 20 }; // bytes; larger ones are not kept
enum { stride = 10 };           // while steps are played, the form is kept after every tenth

static void keep(ax_attempt* a, void* bytes, size_t size, bool stored)
{
    if (a->kept_count == a->kept_capacity) {
        a->kept_capacity = 2 * a->kept_capacity + 4;
        a->kept = ax_realloc(a->kept, (size_t)a->kept_capacity, sizeof *a->kept);
    }
    a->kept[a->kept_count++] = (ax_kept_form){a->at, stored, bytes, size};
}

bool ax_attempt_is_kept(const ax_attempt* a)
{
    return a->kept_count && a->kept[a->kept_count - 1].at == a->at;
}

static void keep_form(ax_attempt* a)
{
    size_t size;
    if (a->form && !ax_attempt_is_kept(a)) {
        void* bytes = ax_form_save(a->form, &size);
        keep(a, bytes, size, false);
    }
}

void ax_attempt_forget(ax_attempt* a)
{
    ax_form_free(a->form);
    for (int k = 0; k < a->kept_count; ++k)
        ax_free(a->kept[k].bytes);
    ax_free(a->kept);
    for (int k = 0; k < a->source_count; ++k) {
        ax_free(a->sources[k].name);
        ax_free(a->sources[k].bytes);
    }
    ax_free(a->sources);
    ax_design_free(&a->finished.design);
    *a = (ax_attempt){0};
}

bool ax_attempt_fetch(ax_session* s, int64_t step, ax_attempt* a)
{
    size_t size;
    sqlite3_stmt* row;
    const void* bytes = ax_history_checkpoint(s->database.view, step, &size, &row);
    if (bytes && ax_form_load(bytes, size, &a->form, NULL) == AX_OK)
        keep(a, ax_copy(bytes, size, 1), size, true);
    sqlite3_finalize(row);
    return a->form != NULL;
}

static ax_status fetch_beginning(ax_session* s, ax_attempt* a, ax_error* error)
{
    ax_design design;
    ax_status status = ax_design_fetch(s->path, s->database.view, 0, &design, error);
    if (status == AX_OK)
        status = ax_form_from_design(&design, &a->form, error);
    ax_design_free(&design);
    return status;
}

// The state nearest before `until` from which to go on: the present form itself, a checkpoint, or the beginning.
static ax_status find_start(ax_session* s, int until, ax_attempt* a, ax_error* error)
{
    for (a->at = until; a->at >= 0; --a->at) {
        int64_t id = s->ids[a->at];
        if (id == s->present.state && s->form) {
            a->form = s->form;
            s->form = NULL;
            return AX_OK;
        }
        if (id >= 0 && ax_attempt_fetch(s, id, a))
            return AX_OK;
    }
    a->at = 0;
    return s->from_design ? fetch_beginning(s, a, error) : AX_OK;
}

// A stored file as one on the disk, for readers that open files: a name of its own with the same ending. Owned by the caller, who removes
// it; NULL if it cannot be written.
static char* unpack(const char* name, const char* bytes, size_t size)
{
    const char *folder = getenv("TMPDIR"), *ending = strrchr(name, '.');
    if (!ending || strchr(ending, '/'))
        ending = "";
    size_t room = strlen(folder ? folder : "/tmp") + strlen(ending) + 32;
    char* path = AX_NEW(char, room);
    snprintf(path, room, "%s/auxshell-XXXXXX%s", folder ? folder : "/tmp", ending);
    int out = mkstemps(path, (int)strlen(ending));
    FILE* stream = out >= 0 ? fdopen(out, "wb") : NULL;
    bool written = stream && fwrite(bytes, 1, size, stream) == size;
    written = (!stream || fclose(stream) == 0) && written;
    if (written)
        return path;
    if (out >= 0)
        unlink(path);
    ax_free(path);
    return NULL;
}

ax_status ax_attempt_step(ax_session* s, ax_attempt* a, int at, const ax_progress* progress, ax_error* error)
{
    char *name = ax_recipe_file(s->recipe, at), *path = NULL, *bytes = NULL, *unpacked = NULL;
    size_t size = 0;
    if (name) {
        size_t room = strlen(s->folder) + strlen(name) + 2;
        path = AX_NEW(char, room);
        snprintf(path, room, "%s%s%s", *name == '/' ? "" : s->folder, *name == '/' ? "" : "/", name);
        if (ax_bytes_read(path, "a file", most_file, &bytes, &size, NULL) != AX_OK && access(path, F_OK) != 0 &&
            s->ids[at + 1] >= 0 && ax_history_file(s->database.view, s->ids[at + 1], &bytes, &size) == SQLITE_OK &&
            bytes)
            unpacked = unpack(name, bytes, size);
    }
    ax_status status =
        ax_recipe_apply_finished(s->recipe, at, s->folder, unpacked, progress, &a->form, &a->finished, error);
    if (unpacked)
        unlink(unpacked);
    if (status == AX_OK && bytes) {
        a->sources = ax_realloc(a->sources, (size_t)a->source_count + 1, sizeof *a->sources);
        a->sources[a->source_count++] = (ax_kept_source){at + 1, name, bytes, size};
        name = NULL, bytes = NULL;
    }
    ax_free(name);
    ax_free(path);
    ax_free(bytes);
    ax_free(unpacked);
    return status;
}

ax_status ax_attempt_play(ax_session* s, int until, const ax_progress* progress, ax_attempt* a, ax_error* error)
{
    *a = (ax_attempt){0};
    ax_status status = find_start(s, until, a, error);
    int first = a->at;
    s->making = &a->form;
    while (a->at < until && status == AX_OK) {
        ax_progress_part slot;
        double lo = (double)(a->at - first) / (until - first), hi = (double)(a->at + 1 - first) / (until - first);
        ax_design_free(&a->finished.design);
        a->finished = (ax_finished){0};
        status = ax_attempt_step(s, a, a->at, ax_progress_within(&slot, progress, lo, hi), error);
        if (status != AX_OK)
            break;
        ++a->at;
        if (a->at % stride == 0)
            keep_form(a);
    }
    s->making = NULL;
    keep_form(a);
    return status;
}
