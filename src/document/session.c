#include "ax/session.h"

#include "base/file.h"
#include "document/design_rows.h"
#include "document/history.h"
#include "document/lock.h"
#include "document/opening.h"
#include "document/sql.h"
#include "input/bytes.h"

#include <libgen.h>
#include <limits.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>
#include <unistd.h>

enum { SEALED = 7 };            // tables
enum { most_file = 256 << 20 }; // bytes; larger ones are not kept
enum { stride = 10 };           // while steps are played, the form is kept after every tenth

struct ax_session {
    char *path, *folder, *read_only;
    ax_lock* lock;
    ax_database database;
    bool from_design;
    ax_recipe* recipe;
    int id_capacity;
    int64_t* ids; // of the steps: ids[k] is the k-th, counted from 1; ids[0] = 0, the beginning; -1: not stored yet
    ax_present present;
    ax_moment* moments;
    int moment_count;
    ax_kept_variant* kept; // variants, and what is told of them
    ax_variant* variants;
    int variant_count;
    ax_form* form;          // after step present.state
    ax_form* const* making; // that of the attempt that is being played
    void* bytes;            // the same, stored
    size_t size;
    ax_design design; // of step `designed`; -1: none is loaded
    int64_t designed;
    bool touched[SEALED]; // tables, by the transaction that is going on
};

static char* copy_text(const char* text)
{
    return text ? ax_copy(text, strlen(text) + 1, 1) : NULL;
}

static ax_status fail_reading(const ax_session* s, int result, ax_error* error)
{
    return result == SQLITE_CORRUPT ? ax_fail_damaged(s->path, "its history contradicts itself", error)
                                    : ax_fail_reading(s->path, s->database.view, result, error);
}

// ---- the recipe and its steps -----------------------------------------------------------------------------------------------

static void reserve_ids(ax_session* s, int steps)
{
    if (steps + 1 <= s->id_capacity)
        return;
    s->id_capacity = 2 * steps + 16;
    s->ids = ax_realloc(s->ids, (size_t)s->id_capacity, sizeof *s->ids);
    s->ids[0] = 0;
}

static void shorten(ax_session* s, int steps)
{
    while (ax_recipe_count(s->recipe) > steps)
        ax_recipe_remove(s->recipe, ax_recipe_count(s->recipe) - 1);
}

// Makes the recipe the steps up to `tip`; what it has in common with the one before stays.
static ax_status show_steps(ax_session* s, int64_t tip, int steps, ax_error* error)
{
    int64_t* ids = AX_NEW(int64_t, (size_t)steps + 1);
    sqlite3* db = s->database.view;
    int result = ax_history_path(db, tip, steps, ids), common = 0;
    if (result != SQLITE_OK) {
        ax_free(ids);
        return fail_reading(s, result, error);
    }
    reserve_ids(s, steps);
    while (common < steps && common < ax_recipe_count(s->recipe) && ids[common + 1] == s->ids[common + 1])
        ++common;
    shorten(s, common);
    ax_status status = AX_OK;
    for (int k = common; k < steps && status == AX_OK; ++k) {
        char* json;
        ax_error inner = {0};
        result = ax_history_operator(db, ids[k + 1], &json);
        if (result != SQLITE_OK)
            status = fail_reading(s, result, error);
        else if (ax_recipe_insert(s->recipe, k, json, &inner) != AX_OK)
            status = ax_fail(error, AX_BAD_INPUT, "%s cannot be read: its step %d is not known here. %s", s->path,
                             k + 1, inner.message);
        ax_free(json);
        s->ids[k + 1] = ids[k + 1];
    }
    ax_free(ids);
    return status;
}

// Looks up the steps from number `from` on (counted from 0) that are stored already, by an earlier moment.
static ax_status identify(ax_session* s, int from, ax_error* error)
{
    int count = ax_recipe_count(s->recipe), result = SQLITE_OK;
    reserve_ids(s, count);
    for (int k = from; k < count && result == SQLITE_OK; ++k)
        if (s->ids[k] < 0)
            s->ids[k + 1] = -1;
        else
            result = ax_history_find(s->database.view, s->ids[k], ax_recipe_operator(s->recipe, k), &s->ids[k + 1]);
    return result == SQLITE_OK ? AX_OK : fail_reading(s, result, error);
}

// ---- playing ----------------------------------------------------------------------------------------------------------------

// A form kept after step `at`.
typedef struct kept {
    int at;
    bool stored; // already in the file
    void* bytes;
    size_t size;
} kept;

// What a step read from the file that it names.
typedef struct source {
    int at;
    char *name, *bytes;
    size_t size;
} source;

// A change that is being tried: nothing of the session but its recipe is touched before it is in the file.
typedef struct attempt {
    ax_form* form;
    int at;
    int kept_count, kept_capacity;
    kept* kept;
    int source_count;
    source* sources;
    ax_finished finished; // by the last step
} attempt;

static void keep(attempt* a, void* bytes, size_t size, bool stored)
{
    if (a->kept_count == a->kept_capacity) {
        a->kept_capacity = 2 * a->kept_capacity + 4;
        a->kept = ax_realloc(a->kept, (size_t)a->kept_capacity, sizeof *a->kept);
    }
    a->kept[a->kept_count++] = (kept){a->at, stored, bytes, size};
}

static bool is_kept(const attempt* a)
{
    return a->kept_count && a->kept[a->kept_count - 1].at == a->at;
}

static void keep_form(attempt* a)
{
    size_t size;
    if (a->form && !is_kept(a)) {
        void* bytes = ax_form_save(a->form, &size);
        keep(a, bytes, size, false);
    }
}

static void forget(attempt* a)
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
    *a = (attempt){0};
}

// The checkpoint after a step, if there is a sound one.
static bool fetch_checkpoint(ax_session* s, int64_t step, attempt* a)
{
    size_t size;
    sqlite3_stmt* row;
    const void* bytes = ax_history_checkpoint(s->database.view, step, &size, &row);
    if (bytes && ax_form_load(bytes, size, &a->form, NULL) == AX_OK)
        keep(a, ax_copy(bytes, size, 1), size, true);
    sqlite3_finalize(row);
    return a->form != NULL;
}

static ax_status fetch_beginning(ax_session* s, attempt* a, ax_error* error)
{
    ax_design design;
    ax_status status = ax_design_fetch(s->path, s->database.view, 0, &design, error);
    if (status == AX_OK)
        status = ax_form_from_design(&design, &a->form, error);
    ax_design_free(&design);
    return status;
}

// The state nearest before `until` from which to go on: the present form itself, a checkpoint, or the beginning.
static ax_status find_start(ax_session* s, int until, attempt* a, ax_error* error)
{
    for (a->at = until; a->at >= 0; --a->at) {
        int64_t id = s->ids[a->at];
        if (id == s->present.state && s->form) {
            a->form = s->form;
            s->form = NULL;
            return AX_OK;
        }
        if (id >= 0 && fetch_checkpoint(s, id, a))
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

// Applies step `at` (counted from 0) to a->form. Its file is read where it is, and otherwise as it was when it was read last.
static ax_status apply_step(ax_session* s, attempt* a, int at, const ax_progress* progress, ax_error* error)
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
        a->sources[a->source_count++] = (source){at + 1, name, bytes, size};
        name = NULL, bytes = NULL;
    }
    ax_free(name);
    ax_free(path);
    ax_free(bytes);
    ax_free(unpacked);
    return status;
}

// Reaches the state after `until` steps of the recipe, or as far as they go.
static ax_status play(ax_session* s, int until, const ax_progress* progress, attempt* a, ax_error* error)
{
    *a = (attempt){0};
    ax_status status = find_start(s, until, a, error);
    int first = a->at;
    s->making = &a->form;
    while (a->at < until && status == AX_OK) {
        ax_progress_part slot;
        double lo = (double)(a->at - first) / (until - first), hi = (double)(a->at + 1 - first) / (until - first);
        ax_design_free(&a->finished.design);
        a->finished = (ax_finished){0};
        status = apply_step(s, a, a->at, ax_progress_within(&slot, progress, lo, hi), error);
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

// ---- writing ----------------------------------------------------------------------------------------------------------------

static ax_status check_writable(const ax_session* s, ax_error* error)
{
    return s->read_only ? ax_fail(error, AX_FAILED, "%s", s->read_only) : AX_OK;
}

static double now(void)
{
    struct timespec time;
    clock_gettime(CLOCK_REALTIME, &time);
    return (double)time.tv_sec + 1e-9 * (double)time.tv_nsec;
}

// Tables that are sealed again after they were touched. Checkpoints are not sealed; see schema.h.
static const char* const sealed[SEALED] = {"step", "moment", "session", "property", "array", "file", "variant"};

static void on_touch(void* context, int operation, const char* database, const char* table, sqlite3_int64 row)
{
    (void)operation, (void)database, (void)row;
    ax_session* s = context;
    for (int k = 0; k < SEALED; ++k)
        s->touched[k] |= strcmp(table, sealed[k]) == 0;
}

static int begin(ax_session* s)
{
    ax_database* d = &s->database;
    memset(s->touched, 0, sizeof s->touched);
    sqlite3_update_hook(d->file, on_touch, s);
    int result = sqlite3_exec(d->file, "BEGIN IMMEDIATE", NULL, NULL, NULL);
    if (result == SQLITE_OK && d->view != d->file) {
        result = ax_schema_upgrade(d->schema, d->file, d->version, d->schema->version);
        if (result == SQLITE_OK)
            result = ax_schema_seal(d->file);
    }
    return result;
}

// Ends the transaction: all of it is in the file, or nothing.
static ax_status end(ax_session* s, int result, ax_error* error)
{
    ax_database* d = &s->database;
    if (result == SQLITE_OK)
        result = sqlite3_exec(d->file, "COMMIT", NULL, NULL, NULL);
    if (result == SQLITE_OK) {
        if (d->view != d->file)
            sqlite3_close(d->view);
        d->view = d->file;
        d->version = d->schema->version;
        return AX_OK;
    }
    char reason[256];
    snprintf(reason, sizeof reason, "%s", sqlite3_errmsg(d->file));
    sqlite3_exec(d->file, "ROLLBACK", NULL, NULL, NULL);
    return ax_fail(error, AX_FAILED, "%s could not be saved: %s. Nothing was changed.", s->path, reason);
}

static int seal(ax_session* s)
{
    int result = SQLITE_OK;
    for (int k = 0; k < SEALED && result == SQLITE_OK; ++k)
        if (s->touched[k])
            result = ax_schema_seal_table(s->database.file, sealed[k]);
    return result;
}

static int write_steps(ax_session* s)
{
    int result = SQLITE_OK;
    for (int k = 0; k < ax_recipe_count(s->recipe) && result == SQLITE_OK; ++k)
        if (s->ids[k + 1] < 0)
            result = ax_history_add_step(s->database.file, s->ids[k], ax_recipe_operator(s->recipe, k), &s->ids[k + 1]);
    return result;
}

static int write_states(ax_session* s, const attempt* a)
{
    sqlite3* db = s->database.file;
    int result = SQLITE_OK;
    for (int k = 0; k < a->kept_count && result == SQLITE_OK; ++k)
        if (!a->kept[k].stored)
            result = ax_history_keep(db, s->ids[a->kept[k].at], a->kept[k].bytes, a->kept[k].size);
    for (int k = 0; k < a->source_count && result == SQLITE_OK; ++k) {
        const source* f = &a->sources[k];
        result = ax_history_keep_file(db, s->ids[f->at], f->name, f->bytes, f->size);
    }
    if (result == SQLITE_OK && a->finished.made)
        result = ax_design_store(db, s->ids[a->at], &a->finished.design);
    return result;
}

static void adopt(ax_session* s, attempt* a, const ax_present* present)
{
    ax_form_free(s->form);
    s->form = a->form;
    a->form = NULL;
    if (is_kept(a)) {
        kept* last = &a->kept[a->kept_count - 1];
        ax_free(s->bytes);
        s->bytes = last->bytes, s->size = last->size;
        last->bytes = NULL;
    }
    if (!s->form) { // an empty document
        ax_free(s->bytes);
        s->bytes = NULL, s->size = 0;
    }
    char* failure = copy_text(present->failure); // it may be the present one's
    ax_free(s->present.failure);
    s->present = *present;
    s->present.failure = failure;
}

static ax_status read_moments(ax_session* s, ax_error* error)
{
    ax_history_moments_free(s->moments, s->moment_count);
    int result = ax_history_moments(s->database.view, &s->moments, &s->moment_count);
    return result == SQLITE_OK ? AX_OK : fail_reading(s, result, error);
}

static void forget_variants(ax_session* s)
{
    ax_history_variants_free(s->kept, s->variant_count);
    ax_free(s->variants);
    s->kept = NULL, s->variants = NULL, s->variant_count = 0;
}

static void find_present_variant(ax_session* s)
{
    for (int k = 0; k < s->variant_count; ++k)
        s->variants[k].present = s->kept[k].tip == s->present.tip && s->kept[k].at == s->present.at;
}

static ax_status read_variants(ax_session* s, ax_error* error)
{
    forget_variants(s);
    int result = ax_history_variants(s->database.view, &s->kept, &s->variant_count);
    if (result != SQLITE_OK) {
        forget_variants(s);
        return fail_reading(s, result, error);
    }
    s->variants = AX_NEW(ax_variant, (size_t)s->variant_count);
    for (int k = 0; k < s->variant_count; ++k) {
        const ax_kept_variant* v = &s->kept[k];
        s->variants[k] =
            (ax_variant){.name = v->name, .figures = v->figures, .time = v->time, .steps = v->steps, .at = v->at};
    }
    find_present_variant(s);
    return AX_OK;
}

// Writes what was tried as moment `number`, a new one if it has words, and makes it the present one.
static ax_status commit(ax_session* s, attempt* a, int number, const char* words, const char* failure, ax_error* error)
{
    sqlite3* db = s->database.file;
    int count = ax_recipe_count(s->recipe), result = begin(s);
    if (result == SQLITE_OK)
        result = write_steps(s);
    ax_present present = {.now = number, .steps = count, .at = a->at, .failure = (char*)failure};
    present.tip = s->ids[count], present.state = s->ids[a->at];
    if (result == SQLITE_OK)
        result = words ? ax_history_add_moment(db, &present, words, now()) : ax_history_go(db, number);
    if (result == SQLITE_OK)
        result = write_states(s, a);
    if (result == SQLITE_OK)
        result = ax_history_thin(db, number);
    if (result == SQLITE_OK)
        result = seal(s);
    ax_status status = end(s, result, error);
    if (status == AX_OK) {
        adopt(s, a, &present);
        find_present_variant(s);
        status = read_moments(s, error);
    }
    return status;
}

// Back to the present state after something failed.
static void revert(ax_session* s, attempt* a)
{
    if (a)
        forget(a);
    if (!s->form && s->bytes)
        ax_form_load(s->bytes, s->size, &s->form, NULL); // it was saved from a form, so it loads
    show_steps(s, s->present.tip, s->present.steps, NULL);
}

// ---- opening and closing ----------------------------------------------------------------------------------------------------

static char* folder_of(const char* path)
{
    char* copy = copy_text(path);
    char* folder = copy_text(dirname(copy));
    ax_free(copy);
    return folder;
}

static ax_session* make(const char* path)
{
    ax_session* s = AX_NEW0(ax_session, 1);
    s->path = copy_text(path);
    s->designed = -1;
    reserve_ids(s, 0);
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
    forget_variants(s);
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
        return fail_reading(s, result, error);
    }
    s->folder = *folder ? copy_text(folder) : folder_of(s->path);
    ax_free(folder);
    s->from_design = ax_design_stored(s->database.view, 0);
    s->recipe = s->from_design ? ax_recipe_make_based() : ax_recipe_make();
    ax_status status = read_moments(s, error);
    if (status == AX_OK)
        status = read_variants(s, error);
    if (status == AX_OK)
        status = show_steps(s, s->present.tip, s->present.steps, error);
    if (status == AX_OK && s->ids[s->present.at] != s->present.state)
        status = fail_reading(s, SQLITE_CORRUPT, error);
    if (status != AX_OK)
        return status;
    attempt a;
    ax_error inner = {0};
    status = play(s, s->present.at, progress, &a, &inner);
    if (status != AX_OK && (status == AX_CANCELLED || !a.form)) {
        forget(&a);
        return ax_fail(error, status, "%s", inner.message);
    }
    bool computed = a.kept_count && !a.kept[a.kept_count - 1].stored;
    // What was lost is put back, so that it need not be computed the next time; but opening a document that is only begun, or of an
    // older version, does not change it.
    bool current = s->database.view == s->database.file && s->present.at > 0;
    if (status == AX_OK && computed && current && !s->read_only)
        commit(s, &a, s->present.now, NULL, s->present.failure, NULL);
    if (!s->form) {
        ax_present present = s->present;
        present.at = a.at, present.state = s->ids[a.at];
        present.failure = status == AX_OK ? s->present.failure : inner.message;
        present.failure = copy_text(present.failure);
        adopt(s, &a, &present);
        ax_free(present.failure);
    }
    forget(&a);
    return AX_OK;
}

// Opens for the one who has the lock, or without one for reading.
static ax_status open_locked(const char* path, ax_lock* lock, const char* read_only, const ax_progress* progress,
                             ax_session** out, ax_error* error)
{
    ax_session* s = make(path);
    s->lock = lock;
    s->read_only = copy_text(read_only);
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
    return open_locked(path, lock, lock ? NULL : refused.message, progress, out, error);
}

// ---- creating ---------------------------------------------------------------------------------------------------------------

static ax_status apply(ax_session* s, const char* json, int number, const ax_progress* progress, ax_finish* figures,
                       ax_error* error);

// All steps at once, of which one fails and those before it are the state.
static ax_status keep_failing(ax_session* s, const ax_recipe* recipe, int until, const char* failure, ax_error* error)
{
    ax_status status = AX_OK;
    int first = ax_recipe_count(s->recipe);
    for (int k = first; k < until && status == AX_OK; ++k)
        status = ax_recipe_insert(s->recipe, k, ax_recipe_operator(recipe, k), error);
    if (status == AX_OK)
        status = identify(s, first, error);
    attempt a;
    if (status == AX_OK)
        status = play(s, s->present.at, NULL, &a, error);
    if (status == AX_OK) {
        char words[160];
        ax_recipe_words(s->recipe, s->present.at, words);
        status = commit(s, &a, s->present.now + 1, words, failure, error);
        forget(&a);
    }
    return status;
}

static ax_status play_start(ax_session* s, const ax_session_start* start, const ax_progress* progress, ax_error* error)
{
    int count = start->recipe ? ax_recipe_count(start->recipe) : 0;
    int until = start->until >= 0 && start->until < count ? start->until : count;
    ax_status status = AX_OK;
    if (until == 0) {
        attempt empty = {0};
        return commit(s, &empty, 0, "New", NULL, error);
    }
    for (int k = 0; k < until && status == AX_OK; ++k) {
        ax_progress_part slot;
        ax_error inner = {0};
        status = apply(s, ax_recipe_operator(start->recipe, k), k, // the first step is where the history begins
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
    char* beside = folder_of(document);
    char *asked = folder ? realpath(folder, NULL) : NULL, *real = realpath(beside, NULL);
    bool same = !folder || (asked && real && strcmp(asked, real) == 0);
    char* result = same ? copy_text("") : copy_text(asked ? asked : folder);
    free(asked);
    free(real);
    ax_free(beside);
    return result;
}

// Makes the database of a new document beside its place, lets `fill` do its work on it, and puts it there.
static ax_status create(const char* path, const char* program, const char* folder,
                        ax_status (*fill)(ax_session* s, const void* context, const ax_progress* progress,
                                          ax_error* error),
                        const void* context, const ax_progress* progress, ax_session** out, ax_error* error)
{
    *out = NULL;
    ax_file file;
    ax_lock* lock = NULL;
    ax_status status = ax_file_begin_path(&file, path, error);
    if (status != AX_OK)
        return status;
    status = ax_lock_take(path, program, &lock, error);
    if (status != AX_OK) {
        ax_file_abandon(&file);
        return status;
    }
    ax_session* s = make(path);
    char* stored = absolute_folder(folder, path);
    s->folder = *stored ? copy_text(stored) : folder_of(path);
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
    if (status == AX_OK)
        status = fill(s, context, progress, error);
    ax_session_close(s);
    ax_free(stored);
    if (status == AX_OK)
        status = ax_file_commit(&file, error);
    else
        ax_file_abandon(&file);
    if (status == AX_OK)
        return open_locked(path, lock, NULL, progress, out, error);
    ax_lock_release(lock);
    return status;
}

static ax_status fill_from_recipe(ax_session* s, const void* context, const ax_progress* progress, ax_error* error)
{
    const ax_session_start* start = context;
    if (start->session)
        *start->session = s;
    ax_status status = play_start(s, start, progress, error);
    if (start->session)
        *start->session = NULL;
    return status;
}

ax_status ax_session_create(const char* path, const ax_session_start* start, const ax_progress* progress,
                            ax_session** out, ax_error* error)
{
    return create(path, start->program, start->folder, fill_from_recipe, start, progress, out, error);
}

static ax_status fill_from_design(ax_session* s, const void* context, const ax_progress* progress, ax_error* error)
{
    (void)progress;
    sqlite3* db = s->database.file;
    ax_present beginning = {0};
    int result = begin(s);
    if (result == SQLITE_OK)
        result = ax_design_store(db, 0, context);
    if (result == SQLITE_OK)
        result = ax_history_add_moment(db, &beginning, "Design", now());
    if (result == SQLITE_OK)
        result = seal(s);
    return end(s, result, error);
}

ax_status ax_session_create_from_design(const char* path, const ax_design* design, const char* program,
                                        ax_session** out, ax_error* error)
{
    return create(path, program, NULL, fill_from_design, design, NULL, out, error);
}

// ---- looking ----------------------------------------------------------------------------------------------------------------

const char* ax_session_path(const ax_session* s)
{
    return s->path;
}

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
    attempt before;
    int last = s->present.at - 1;
    ax_status status = play(s, last, progress, &before, error);
    if (status == AX_OK)
        status = apply_step(s, &before, last, progress, error);
    if (status == AX_OK && before.finished.made)
        take_design(s, &before.finished.design);
    revert(s, &before);
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

// ---- changing ---------------------------------------------------------------------------------------------------------------

// Applies an operator after the present step, as moment `number`.
static ax_status apply(ax_session* s, const char* json, int number, const ax_progress* progress, ax_finish* figures,
                       ax_error* error)
{
    int at = s->present.at;
    attempt a = {0};
    shorten(s, at);
    ax_status status = ax_recipe_insert(s->recipe, at, json, error);
    if (status == AX_OK)
        status = identify(s, at, error);
    if (status == AX_OK)
        status = play(s, at + 1, progress, &a, error);
    if (figures)
        *figures = a.finished.figures;
    if (status == AX_OK) {
        char words[160];
        ax_recipe_words(s->recipe, at, words);
        status = commit(s, &a, number, words, NULL, error);
    }
    if (status == AX_OK)
        forget(&a);
    else
        revert(s, &a);
    return status;
}

ax_status ax_session_apply(ax_session* s, const char* json, const ax_progress* progress, ax_error* error)
{
    ax_status status = check_writable(s, error);
    return status == AX_OK ? apply(s, json, s->present.now + 1, progress, NULL, error) : status;
}

ax_status ax_session_finish(ax_session* s, const ax_progress* progress, ax_finish* figures, ax_error* error)
{
    ax_status status = check_writable(s, error);
    return status == AX_OK ? apply(s, "{\"op\": \"finish\"}", s->present.now + 1, progress, figures, error) : status;
}

// Plays the recipe as it was edited from step `from` on. Only there may it not fail.
static ax_status play_edited(ax_session* s, int from, int until, const char* words, const ax_progress* progress,
                             ax_error* error)
{
    attempt a = {0};
    ax_error failure = {0};
    ax_status status = identify(s, from, &failure);
    if (status == AX_OK)
        status = play(s, until, progress, &a, &failure);
    bool later = status != AX_OK && status != AX_CANCELLED && a.form && a.at > from;
    if (status == AX_OK || later)
        status = commit(s, &a, s->present.now + 1, words, later ? failure.message : NULL, &failure);
    if (status == AX_OK)
        forget(&a);
    else {
        revert(s, &a);
        if (error)
            *error = failure;
    }
    return status;
}

ax_status ax_session_edit(ax_session* s, int k, const char* json, const ax_progress* progress, ax_error* error)
{
    int count = ax_recipe_count(s->recipe),
        at = s->present.failure ? count : s->present.at; // an edit may mend what failed
    ax_status status = check_writable(s, error);
    if (status != AX_OK)
        return status;
    if (k < 0 || k >= count)
        return ax_fail(error, AX_USAGE, "There is no step %d: the recipe has %d.", k + 1, count);
    if (!json && k == 0 && !s->from_design)
        return ax_fail(error, AX_USAGE, "The first step starts the design: put another in its place instead.");
    char step[160], words[192];
    ax_recipe_words(s->recipe, k, step);
    if (json)
        status = ax_recipe_replace(s->recipe, k, json, error);
    else
        ax_recipe_remove(s->recipe, k);
    if (status != AX_OK)
        return status;
    if (json)
        ax_recipe_words(s->recipe, k, step);
    snprintf(words, sizeof words, "%s %s", json ? "Edit" : "Remove", step);
    return play_edited(s, k, !json && at > k ? at - 1 : at, words, progress, error);
}

ax_status ax_session_replace(ax_session* s, const ax_recipe* recipe, const ax_progress* progress, ax_error* error)
{
    int count = ax_recipe_count(recipe), common = 0;
    ax_status status = check_writable(s, error);
    if (status != AX_OK)
        return status;
    while (common < count && common < ax_recipe_count(s->recipe) &&
           strcmp(ax_recipe_operator(recipe, common), ax_recipe_operator(s->recipe, common)) == 0)
        ++common;
    shorten(s, common);
    for (int k = common; k < count && status == AX_OK; ++k)
        status = ax_recipe_insert(s->recipe, k, ax_recipe_operator(recipe, k), error);
    if (status != AX_OK) {
        revert(s, NULL);
        return status;
    }
    return play_edited(s, common, count, "Take another recipe", progress, error);
}

ax_status ax_session_go(ax_session* s, int at, const ax_progress* progress, ax_error* error)
{
    int count = ax_recipe_count(s->recipe), first = s->from_design ? 0 : 1;
    ax_status status = check_writable(s, error);
    if (status != AX_OK)
        return status;
    if (at < first || at > count)
        return ax_fail(error, AX_USAGE, "There is no state after %d steps: the recipe has %d.", at, count);
    attempt a;
    status = play(s, at, progress, &a, error);
    if (status == AX_OK) {
        char words[64];
        snprintf(words, sizeof words, "Go to step %d", at);
        status = commit(s, &a, s->present.now + 1, words, NULL, error);
    }
    if (status == AX_OK)
        forget(&a);
    else
        revert(s, &a);
    return status;
}

// Goes to a place of the tree, as moment `target->now`: a new one if there are words for it.
static ax_status visit(ax_session* s, const ax_present* target, const char* words, const ax_progress* progress,
                       ax_error* error)
{
    attempt a = {0};
    ax_status status = show_steps(s, target->tip, target->steps, error);
    if (status == AX_OK)
        status = play(s, target->at, progress, &a, error);
    if (status == AX_OK)
        status = commit(s, &a, target->now, words, target->failure, error);
    if (status == AX_OK)
        forget(&a);
    else
        revert(s, &a);
    return status;
}

ax_status ax_session_jump(ax_session* s, int moment, const ax_progress* progress, ax_error* error)
{
    ax_status status = check_writable(s, error);
    if (status != AX_OK)
        return status;
    if (moment < 0 || moment >= s->moment_count)
        return ax_fail(error, AX_USAGE, "There is no moment %d: the history has 0 to %d.", moment, s->moment_count - 1);
    ax_present target;
    int result = ax_history_moment(s->database.view, moment, &target);
    status = result == SQLITE_OK ? visit(s, &target, NULL, progress, error) : fail_reading(s, result, error);
    ax_free(target.failure);
    return status;
}

ax_status ax_session_undo(ax_session* s, const ax_progress* progress, ax_error* error)
{
    if (s->present.now == 0)
        return ax_fail(error, AX_USAGE, "There is nothing to undo.");
    return ax_session_jump(s, s->present.now - 1, progress, error);
}

ax_status ax_session_redo(ax_session* s, const ax_progress* progress, ax_error* error)
{
    if (s->present.now + 1 == s->moment_count)
        return ax_fail(error, AX_USAGE, "There is nothing to redo.");
    return ax_session_jump(s, s->present.now + 1, progress, error);
}

// ---- variants ---------------------------------------------------------------------------------------------------------------

int ax_session_variants(const ax_session* s, const ax_variant** variants)
{
    *variants = s->variants;
    return s->variant_count;
}

static ax_status find_variant(const ax_session* s, const char* name, const ax_kept_variant** found, ax_error* error)
{
    for (int k = 0; k < s->variant_count; ++k)
        if (strcmp(s->kept[k].name, name) == 0) {
            *found = &s->kept[k];
            return AX_OK;
        }
    return ax_fail(error, AX_BAD_INPUT, "There is no variant \"%.*s\".", AX_VARIANT_NAME, name);
}

ax_status ax_session_keep_variant(ax_session* s, const char* name, const char* figures, ax_error* error)
{
    const ax_kept_variant* old;
    ax_status status = check_writable(s, error);
    if (status != AX_OK)
        return status;
    if (!s->form)
        return ax_fail(error, AX_USAGE, "%s is empty: there is nothing to keep.", s->path);
    if (!*name || strlen(name) > AX_VARIANT_NAME)
        return ax_fail(error, AX_USAGE, "The name of a variant has 1 to %d bytes.", AX_VARIANT_NAME);
    if (s->variant_count >= AX_VARIANTS_MOST && find_variant(s, name, &old, NULL) != AX_OK)
        return ax_fail(error, AX_USAGE, "A document has at most %d variants. Remove one first.", AX_VARIANTS_MOST);
    int result = begin(s);
    if (result == SQLITE_OK)
        result = ax_history_keep_variant(s->database.file, name, &s->present, now(), figures);
    if (result == SQLITE_OK)
        result = seal(s);
    status = end(s, result, error);
    return status == AX_OK ? read_variants(s, error) : status;
}

ax_status ax_session_drop_variant(ax_session* s, const char* name, ax_error* error)
{
    const ax_kept_variant* v;
    ax_status status = check_writable(s, error);
    if (status == AX_OK)
        status = find_variant(s, name, &v, error);
    if (status != AX_OK)
        return status;
    int result = begin(s);
    if (result == SQLITE_OK)
        result = ax_history_drop_variant(s->database.file, name);
    if (result == SQLITE_OK)
        result = seal(s);
    status = end(s, result, error);
    return status == AX_OK ? read_variants(s, error) : status;
}

ax_status ax_session_take_variant(ax_session* s, const char* name, const ax_progress* progress, ax_error* error)
{
    const ax_kept_variant* v = NULL;
    ax_status status = check_writable(s, error);
    if (status == AX_OK)
        status = find_variant(s, name, &v, error);
    if (status != AX_OK)
        return status;
    const ax_present target = {
        .now = s->present.now + 1, .tip = v->tip, .state = v->state, .steps = v->steps, .at = v->at};
    char words[AX_VARIANT_NAME + 32];
    snprintf(words, sizeof words, "Take variant %s", name);
    return visit(s, &target, words, progress, error);
}

ax_status ax_session_variant_form(ax_session* s, const char* name, const ax_progress* progress, ax_form** form,
                                  ax_error* error)
{
    const ax_kept_variant* v = NULL;
    *form = NULL;
    ax_status status = find_variant(s, name, &v, error);
    if (status != AX_OK)
        return status;
    attempt a = {0};
    if (!fetch_checkpoint(s, v->state, &a)) {
        status = show_steps(s, v->tip, v->steps, error);
        if (status == AX_OK)
            status = play(s, v->at, progress, &a, error);
    }
    if (status == AX_OK) {
        *form = a.form;
        a.form = NULL;
    }
    revert(s, &a);
    return status;
}

// -----------------------------------------------------------------------------------------------------------------------------

ax_status ax_session_put_design(ax_session* s, const ax_design* design, ax_error* error)
{
    const ax_design* old;
    ax_status status = check_writable(s, error);
    if (status == AX_OK)
        status = ax_session_design(s, NULL, &old, error);
    if (status != AX_OK)
        return status;
    if (!old)
        return ax_fail(error, AX_USAGE, "%s has no finished design at this point of its history. Finish it first.",
                       s->path);
    int result = begin(s);
    if (result == SQLITE_OK)
        result = ax_design_store(s->database.file, s->present.state, design);
    if (result == SQLITE_OK)
        result = seal(s);
    status = end(s, result, error);
    if (status == AX_OK) {
        ax_design_free(&s->design);
        s->designed = -1;
    }
    return status;
}

ax_status ax_session_copy(ax_session* s, const char* path, ax_error* error)
{
    ax_file file;
    ax_lock* lock = NULL;
    ax_status status = ax_file_begin_path(&file, path, error);
    if (status != AX_OK)
        return status;
    status = ax_lock_take(path, NULL, &lock, error);
    if (status != AX_OK) {
        ax_file_abandon(&file);
        return status;
    }
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
    if (status == AX_OK)
        status = ax_file_commit(&file, error);
    else
        ax_file_abandon(&file);
    ax_lock_release(lock);
    return status;
}
