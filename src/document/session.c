// Opening documents, closing them, and looking at them.
#include "document/session.h"

#include "document/design_rows.h"

#include <libgen.h>
#include <string.h>
#include <unistd.h>

char* ax_folder_of(const char* path)
{
    char* copy = ax_copy_text(path);
    char* folder = ax_copy_text(dirname(copy));
    ax_free(copy);
    return folder;
}

ax_session* ax_session_make(const char* path)
{
    ax_session* s = AX_NEW0(ax_session, 1);
    s->path = ax_copy_text(path);
    s->designed = -1;
    ax_steps_reserve(s, 0);
    return s;
}

void ax_session_close(ax_session* s)
{
    if (!s)
        return;
    ax_form_free(s->form);
    ax_free(s->bytes);
    if (s->designed >= 0)
        ax_design_free(&s->design);
    ax_history_moments_free(s->moments, s->moment_count);
    ax_saving_forget_variants(s);
    ax_recipe_free(s->recipe);
    ax_free(s->ids);
    ax_free(s->present.failure);
    ax_database_close(&s->database);
    ax_lock_release(s->lock);
    ax_free(s->path);
    ax_free(s->folder);
    ax_free(s->read_only);
    ax_free(s);
}

// Reads where the document stands, and its form. A present form that is lost is computed again.
static ax_status read_present(ax_session* s, const ax_progress* progress, ax_error* error)
{
    char* folder;
    int result = ax_history_present(s->database.view, &s->present, &folder);
    if (result != SQLITE_OK) {
        ax_free(folder);
        return ax_session_fail_reading(s, result, error);
    }
    s->folder = *folder ? ax_copy_text(folder) : ax_folder_of(s->path);
    ax_free(folder);
    s->from_design = ax_design_stored(s->database.view, 0);
    s->recipe = s->from_design ? ax_recipe_make_based() : ax_recipe_make();
    ax_status status = ax_saving_read_moments(s, error);
    if (status == AX_OK)
        status = ax_saving_read_variants(s, error);
    if (status == AX_OK)
        status = ax_steps_show(s, s->present.tip, s->present.steps, error);
    if (status == AX_OK && s->ids[s->present.at] != s->present.state)
        status = ax_session_fail_reading(s, SQLITE_CORRUPT, error);
    if (status != AX_OK)
        return status;
    ax_attempt a;
    ax_error inner = {0};
    status = ax_attempt_play(s, s->present.at, progress, &a, &inner);
    if (status != AX_OK && (status == AX_CANCELLED || !a.form)) {
        ax_attempt_forget(&a);
        return ax_fail(error, status, "%s", inner.message);
    }
    bool computed = a.kept_count && !a.kept[a.kept_count - 1].stored;
    // What was lost is put back, so that it need not be computed the next time; but opening a document that is only begun, or of an
    // older version, does not change it.
    bool current = s->database.view == s->database.file && s->present.at > 0;
    if (status == AX_OK && computed && current && !s->read_only)
        ax_saving_commit(s, &a, s->present.now, NULL, s->present.failure, NULL);
    if (!s->form) {
        ax_present present = s->present;
        present.at = a.at, present.state = s->ids[a.at];
        present.failure = status == AX_OK ? s->present.failure : inner.message;
        present.failure = ax_copy_text(present.failure);
        ax_saving_adopt(s, &a, &present);
        ax_free(present.failure);
    }
    ax_attempt_forget(&a);
    return AX_OK;
}

ax_status ax_session_open_locked(const char* path, ax_lock* lock, const char* read_only, const ax_progress* progress,
                                 ax_session** out, ax_error* error)
{
    ax_session* s = ax_session_make(path);
    s->lock = lock;
    s->read_only = ax_copy_text(read_only);
    ax_status status = ax_database_open(&ax_document_schema, path, &s->database, error);
    if (status == AX_OK && !read_only)
        sqlite3_exec(s->database.file, "PRAGMA journal_mode = DELETE; PRAGMA synchronous = EXTRA", NULL, NULL, NULL);
    if (status == AX_OK)
        status = read_present(s, progress, error);
    if (status != AX_OK) {
        ax_session_close(s);
        s = NULL;
    }
    *out = s;
    return status;
}

ax_status ax_session_open(const char* path, bool edit, const char* program, const ax_progress* progress,
                          ax_session** out, ax_error* error)
{
    ax_lock* lock = NULL;
    ax_error refused = {.message = "The document was opened for reading only."};
    if (edit && ax_lock_take(path, program, &lock, &refused) == AX_OK && access(path, W_OK) != 0 &&
        access(path, F_OK) == 0) {
        ax_fail(&refused, AX_FAILED, "%s may not be changed: you have no right to write it.", path);
        ax_lock_release(lock);
        lock = NULL;
    }
    return ax_session_open_locked(path, lock, lock ? NULL : refused.message, progress, out, error);
}

// ---- looking ----------------------------------------------------------------------------------------------------------------

const char* ax_session_read_only(const ax_session* s)
{
    return s->read_only;
}

const ax_recipe* ax_session_recipe(const ax_session* s)
{
    return s->recipe;
}

int ax_session_at(const ax_session* s)
{
    return s->present.at;
}

bool ax_session_from_design(const ax_session* s)
{
    return s->from_design;
}

ax_form* ax_session_form(const ax_session* s)
{
    return s->form;
}

ax_form* ax_session_making(const ax_session* s)
{
    return s->making ? *s->making : NULL;
}

int ax_session_failed(const ax_session* s, const char** why)
{
    if (why)
        *why = s->present.failure;
    return s->present.failure ? s->present.at : -1;
}

int ax_session_history(const ax_session* s, const ax_moment** moments, int* present)
{
    if (moments)
        *moments = s->moments;
    if (present)
        *present = s->present.now;
    return s->moment_count;
}

static void take_design(ax_session* s, ax_design* design)
{
    if (s->designed >= 0)
        ax_design_free(&s->design);
    s->design = *design;
    s->designed = s->present.state;
    *design = (ax_design){0};
}

// A finished design that was dropped to keep the document small: its step is played once more.
static ax_status finish_again(ax_session* s, const ax_progress* progress, ax_error* error)
{
    ax_attempt before;
    int last = s->present.at - 1;
    ax_status status = ax_attempt_play(s, last, progress, &before, error);
    if (status == AX_OK)
        status = ax_attempt_step(s, &before, last, progress, error);
    if (status == AX_OK && before.finished.made)
        take_design(s, &before.finished.design);
    ax_saving_revert(s, &before);
    return status;
}

ax_status ax_session_design(ax_session* s, const ax_progress* progress, const ax_design** design, ax_error* error)
{
    *design = NULL;
    int at = s->present.at;
    ax_status status = AX_OK;
    if (s->designed != s->present.state || s->designed < 0) {
        ax_design stored;
        if (ax_design_stored(s->database.view, s->present.state)) {
            status = ax_design_fetch(s->path, s->database.view, s->present.state, &stored, error);
            if (status == AX_OK)
                take_design(s, &stored);
        } else if (at > 0 && strcmp(ax_recipe_type(s->recipe, at - 1)->group, "finish") == 0)
            status = finish_again(s, progress, error);
    }
    if (status == AX_OK && s->designed == s->present.state)
        *design = &s->design;
    return status;
}

ax_status ax_session_put_design(ax_session* s, const ax_design* design, ax_error* error)
{
    const ax_design* old;
    ax_status status = ax_saving_check(s, error);
    if (status == AX_OK)
        status = ax_session_design(s, NULL, &old, error);
    if (status != AX_OK)
        return status;
    if (!old)
        return ax_fail(error, AX_USAGE, "%s has no finished design at this point of its history. Finish it first.",
                       s->path);
    int result = ax_saving_begin(s);
    if (result == SQLITE_OK)
        result = ax_design_store(s->database.file, s->present.state, design);
    status = ax_saving_end(s, result, error);
    if (status == AX_OK) {
        ax_design_free(&s->design);
        s->designed = -1;
    }
    return status;
}
