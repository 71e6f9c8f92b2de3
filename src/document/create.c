// New documents: from steps, and copies.
#include "document/session.h"

#include "document/sql.h"

#include <stdlib.h>
#include <string.h>

// All steps at once, of which one fails and those before it are the state.
static ax_status keep_failing(ax_session* s, const ax_recipe* recipe, int until, const char* failure, ax_error* error)
{
    ax_status status = AX_OK;
    int first = ax_recipe_count(s->recipe);
    for (int k = first; k < until && status == AX_OK; ++k)
        status = ax_recipe_insert(s->recipe, k, ax_recipe_operator(recipe, k), error);
    if (status == AX_OK)
        status = ax_steps_identify(s, first, error);
    ax_attempt a = {0};
    if (status == AX_OK)
        status = ax_attempt_play(s, s->present.at, NULL, &a, error);
    if (status == AX_OK) {
        char words[160];
        ax_recipe_words(s->recipe, s->present.at, words);
        status = ax_saving_commit(s, &a, s->present.now + 1, words, failure, error);
    }
    return ax_saving_conclude(s, &a, status);
}

static ax_status play_start(ax_session* s, const ax_session_start* start, const ax_progress* progress, ax_error* error)
{
    int count = start->recipe ? ax_recipe_count(start->recipe) : 0;
    int until = start->until >= 0 && start->until < count ? start->until : count;
    ax_status status = AX_OK;
    if (until == 0) {
        ax_attempt empty = {0};
        return ax_saving_commit(s, &empty, 0, "New", NULL, error);
    }
    for (int k = 0; k < until && status == AX_OK; ++k) {
        ax_progress_part slot;
        ax_error inner = {0};
        status = ax_change_apply(
            s, ax_recipe_operator(start->recipe, k), k, // the first step is where the history begins
            ax_progress_within(&slot, progress, (double)k / until, (double)(k + 1) / until), NULL, &inner);
        bool enough = start->keep == AX_KEEP_BEFORE_ANY
                          ? status != AX_OK && status != AX_CANCELLED
                          : start->keep == AX_KEEP_BEFORE_UNREALISABLE && status == AX_CANNOT_REALISE;
        if (enough && k > 0)
            return keep_failing(s, start->recipe, until, inner.message, error);
        if (status != AX_OK && error)
            *error = inner;
        if (status == AX_OK && start->played)
            start->played(start->context, k, s->moments[k].words);
    }
    return status;
}

// A relative folder would mean another one tomorrow.
static char* absolute_folder(const char* folder, const char* document)
{
    char* beside = ax_folder_of(document);
    char *asked = folder ? realpath(folder, NULL) : NULL, *real = realpath(beside, NULL);
    bool same = !folder || (asked && real && strcmp(asked, real) == 0);
    char* result = same ? ax_copy_text("") : ax_copy_text(asked ? asked : folder);
    free(asked);
    free(real);
    ax_free(beside);
    return result;
}

// Makes the database of a new document beside its place, plays the steps into it, and puts it there.
ax_status ax_session_create(const char* path, const ax_session_start* start, const ax_progress* progress,
                            ax_session** out, ax_error* error)
{
    *out = NULL;
    ax_file file;
    ax_lock* lock = NULL;
    ax_status status = ax_lock_new(path, start->program, &file, &lock, error);
    if (status != AX_OK)
        return status;
    ax_session* s = ax_session_make(path);
    char* stored = absolute_folder(start->folder, path);
    s->folder = *stored ? ax_copy_text(stored) : ax_folder_of(path);
    s->recipe = ax_recipe_make();
    s->database.schema = &ax_document_schema;
    s->database.version = ax_document_schema.version;
    int result = ax_database_make(file.path, &s->database.file);
    s->database.view = s->database.file;
    if (result == SQLITE_OK)
        result = ax_sql_run(s->database.file, "UPDATE session SET folder = ?1", "t", stored);
    if (result == SQLITE_OK)
        result = ax_schema_seal(s->database.file);
    if (result != SQLITE_OK)
        status = ax_fail(error, AX_FAILED, "Cannot write %s: %s. Nothing was changed.", path,
                         sqlite3_errmsg(s->database.file));
    if (start->session)
        *start->session = s;
    if (status == AX_OK)
        status = play_start(s, start, progress, error);
    if (start->session)
        *start->session = NULL;
    ax_session_close(s);
    ax_free(stored);
    status = ax_file_end(&file, status, error);
    if (status == AX_OK)
        return ax_session_open_locked(path, lock, NULL, progress, out, error);
    ax_lock_release(lock);
    return status;
}

ax_status ax_session_copy(ax_session* s, const char* path, ax_error* error)
{
    ax_file file;
    ax_lock* lock = NULL;
    ax_status status = ax_lock_new(path, NULL, &file, &lock, error);
    if (status != AX_OK)
        return status;
    sqlite3* copy = NULL;
    char* folder = absolute_folder(s->folder, path); // where its files still are
    int result = ax_sql_run(s->database.view, "VACUUM INTO ?1", "t", file.path);
    const char* reason = sqlite3_errmsg(s->database.view);
    if (result == SQLITE_OK) {
        result = sqlite3_open_v2(file.path, &copy, SQLITE_OPEN_READWRITE | SQLITE_OPEN_NOMUTEX, NULL);
        if (result == SQLITE_OK)
            result = ax_sql_run(copy, "UPDATE session SET folder = ?1", "t", folder);
        if (result == SQLITE_OK)
            result = ax_schema_seal_table(copy, "session");
        reason = sqlite3_errmsg(copy);
    }
    if (result != SQLITE_OK)
        status = ax_fail(error, AX_FAILED, "Cannot write %s: %s. Nothing was changed.", path, reason);
    sqlite3_close(copy);
    ax_free(folder);
    status = ax_file_end(&file, status, error);
    ax_lock_release(lock);
    return status;
}
