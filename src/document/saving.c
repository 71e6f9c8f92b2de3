// A change goes into the file, whole or not at all, and the session follows it.
#include "document/session.h"

#include "document/design_rows.h"

#include <stdio.h>
#include <string.h>
#include <time.h>

ax_status ax_saving_check(const ax_session* s, ax_error* error)
{
    return s->read_only ? ax_fail(error, AX_FAILED, "%s", s->read_only) : AX_OK;
}

double ax_saving_now(void)
{
    struct timespec time;
    clock_gettime(CLOCK_REALTIME, &time);
    return (double)time.tv_sec + 1e-9 * (double)time.tv_nsec;
}

// Tables that are sealed again after they were touched. Checkpoints are not sealed; see schema.h.
static const char* const sealed[AX_SEALED] = {"step", "moment", "session", "property", "array", "file", "variant"};

static void on_touch(void* context, int operation, const char* database, const char* table, sqlite3_int64 row)
{
    (void)operation, (void)database, (void)row;
    ax_session* s = context;
    for (int k = 0; k < AX_SEALED; ++k)
        s->touched[k] |= strcmp(table, sealed[k]) == 0;
}

int ax_saving_begin(ax_session* s)
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

static int seal(ax_session* s)
{
    int result = SQLITE_OK;
    for (int k = 0; k < AX_SEALED && result == SQLITE_OK; ++k)
        if (s->touched[k])
            result = ax_schema_seal_table(s->database.file, sealed[k]);
    return result;
}

ax_status ax_saving_end(ax_session* s, int result, ax_error* error)
{
    ax_database* d = &s->database;
    if (result == SQLITE_OK)
        result = seal(s);
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

static int write_steps(ax_session* s)
{
    int result = SQLITE_OK;
    for (int k = 0; k < ax_recipe_count(s->recipe) && result == SQLITE_OK; ++k)
        if (s->ids[k + 1] < 0)
            result = ax_history_add_step(s->database.file, s->ids[k], ax_recipe_operator(s->recipe, k), &s->ids[k + 1]);
    return result;
}

static int write_states(ax_session* s, const ax_attempt* a)
{
    sqlite3* db = s->database.file;
    int result = SQLITE_OK;
    for (int k = 0; k < a->kept_count && result == SQLITE_OK; ++k)
        if (!a->kept[k].stored)
            result = ax_history_keep(db, s->ids[a->kept[k].at], a->kept[k].bytes, a->kept[k].size);
    for (int k = 0; k < a->source_count && result == SQLITE_OK; ++k) {
        const ax_kept_source* f = &a->sources[k];
        result = ax_history_keep_file(db, s->ids[f->at], f->name, f->bytes, f->size);
    }
    if (result == SQLITE_OK && a->finished.made)
        result = ax_design_store(db, s->ids[a->at], &a->finished.design);
    return result;
}

void ax_saving_adopt(ax_session* s, ax_attempt* a, const ax_present* present)
{
    ax_form_free(s->form);
    s->form = a->form;
    a->form = NULL;
    if (ax_attempt_is_kept(a)) {
        ax_kept_form* last = &a->kept[a->kept_count - 1];
        ax_free(s->bytes);
        s->bytes = last->bytes, s->size = last->size;
        last->bytes = NULL;
    }
    if (!s->form) { // an empty document
        ax_free(s->bytes);
        s->bytes = NULL, s->size = 0;
    }
    char* failure = ax_copy_text(present->failure); // it may be the present one's
    ax_free(s->present.failure);
    s->present = *present;
    s->present.failure = failure;
}

ax_status ax_saving_read_moments(ax_session* s, ax_error* error)
{
    ax_history_moments_free(s->moments, s->moment_count);
    int result = ax_history_moments(s->database.view, &s->moments, &s->moment_count);
    return result == SQLITE_OK ? AX_OK : ax_session_fail_reading(s, result, error);
}

void ax_saving_forget_variants(ax_session* s)
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

ax_status ax_saving_read_variants(ax_session* s, ax_error* error)
{
    ax_saving_forget_variants(s);
    int result = ax_history_variants(s->database.view, &s->kept, &s->variant_count);
    if (result != SQLITE_OK) {
        ax_saving_forget_variants(s);
        return ax_session_fail_reading(s, result, error);
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

ax_status ax_saving_commit(ax_session* s, ax_attempt* a, int number, const char* words, const char* failure,
                           ax_error* error)
{
    sqlite3* db = s->database.file;
    int count = ax_recipe_count(s->recipe), result = ax_saving_begin(s);
    if (result == SQLITE_OK)
        result = write_steps(s);
    ax_present present = {.now = number, .steps = count, .at = a->at, .failure = (char*)failure};
    present.tip = s->ids[count], present.state = s->ids[a->at];
    if (result == SQLITE_OK)
        result = words ? ax_history_add_moment(db, &present, words, ax_saving_now()) : ax_history_go(db, number);
    if (result == SQLITE_OK)
        result = write_states(s, a);
    if (result == SQLITE_OK)
        result = ax_history_thin(db, number);
    ax_status status = ax_saving_end(s, result, error);
    if (status == AX_OK) {
        ax_saving_adopt(s, a, &present);
        find_present_variant(s);
        status = ax_saving_read_moments(s, error);
    }
    return status;
}

void ax_saving_revert(ax_session* s, ax_attempt* a)
{
    if (a)
        ax_attempt_forget(a);
    if (!s->form && s->bytes)
        ax_form_load(s->bytes, s->size, &s->form, NULL); // it was saved from a form, so it loads
    ax_steps_show(s, s->present.tip, s->present.steps, NULL);
}

ax_status ax_saving_conclude(ax_session* s, ax_attempt* a, ax_status status)
{
    if (status == AX_OK)
        ax_attempt_forget(a);
    else
        ax_saving_revert(s, a);
    return status;
}
