#include "studio/session.h"

#include <stdio.h>
#include <string.h>

enum { MOMENTS_MOST = 200 };

// The document at one moment of its history.
typedef struct moment {
    ax_recipe* recipe;
    int at;
    void* form; // as ax_form_save gives it
    size_t size;
    char words[160]; // what led here
    int failed;
    ax_error failure;
    ax_design* exact;
} moment;

struct session {
    char* folder;
    moment moments[MOMENTS_MOST];
    int count, now;
    ax_form* form;    // of moments[now]
    ax_form* playing; // while steps are played again
};

static void free_moment(moment* m)
{
    ax_recipe_free(m->recipe);
    ax_free(m->form);
    if (m->exact)
        ax_design_free(m->exact);
    ax_free(m->exact);
    *m = (moment){0};
}

static ax_recipe* copy_recipe(const ax_recipe* recipe)
{
    char* text = ax_recipe_text(recipe);
    ax_recipe* copy = NULL;
    ax_recipe_parse(text, &copy, NULL);
    ax_free(text);
    return copy;
}

// Makes `form` the state of a new moment: what could be done again is dropped. Takes over recipe, form and exact.
static void advance(session* s, ax_recipe* recipe, int at, ax_form* form, ax_design* exact, const char* words)
{
    while (s->count > s->now + 1)
        free_moment(&s->moments[--s->count]);
    if (s->count == MOMENTS_MOST) {
        free_moment(&s->moments[0]);
        memmove(s->moments, s->moments + 1, (MOMENTS_MOST - 1) * sizeof *s->moments);
        --s->count;
    }
    moment* m = &s->moments[s->count];
    *m = (moment){.recipe = recipe, .at = at, .failed = -1, .exact = exact};
    m->form = ax_form_save(form, &m->size);
    snprintf(m->words, sizeof m->words, "%s", words);
    s->now = s->count++;
    if (s->form != form) {
        ax_form_free(s->form);
        s->form = form;
    }
}

static const moment* now(const session* s)
{
    return &s->moments[s->now];
}

static ax_status restore(session* s, ax_error* error)
{
    ax_form_free(s->form);
    s->form = NULL;
    return ax_form_load(now(s)->form, now(s)->size, &s->form, error);
}

// Plays `until` steps of a recipe; takes the recipe over. Steps after one that fails stay ahead.
static ax_status play(session* s, ax_recipe* recipe, int until, const char* words, const ax_progress* progress,
                      ax_error* error)
{
    ax_error failure = {0};
    int done = 0;
    ax_status status = ax_recipe_play(recipe, until, s->folder, progress, NULL, NULL, &s->playing, &done, &failure);
    ax_form* form = s->playing;
    s->playing = NULL;
    if (!form || status == AX_CANCELLED) {
        ax_form_free(form);
        ax_recipe_free(recipe);
        if (error)
            *error = failure;
        return status;
    }
    advance(s, recipe, done, form, NULL, words);
    if (status != AX_OK) {
        s->moments[s->now].failed = done;
        s->moments[s->now].failure = failure;
    }
    return AX_OK;
}

ax_status session_open(const char* path, const char* recipe, const char* folder, const ax_progress* progress,
                       session** out, ax_error* error)
{
    session* s = AX_NEW0(session, 1);
    s->folder = ax_copy(folder, strlen(folder) + 1, 1);
    s->now = -1;
    ax_recipe* steps = NULL;
    const char* dot = path ? strrchr(path, '.') : NULL;
    ax_status status;
    if (recipe || (dot && strcmp(dot, ".json") == 0)) {
        status = recipe ? ax_recipe_parse(recipe, &steps, error) : ax_recipe_read(path, &steps, error);
        if (status == AX_OK)
            status = play(s, steps, -1, "New", progress, error);
    } else {
        ax_design design;
        ax_form* form = NULL;
        status = ax_document_load(path, &design, error);
        if (status == AX_OK) {
            status = ax_form_from_design(&design, &form, error);
            if (status == AX_OK)
                advance(s, ax_recipe_make(), 0, form, ax_copy(&design, 1, sizeof design), "Open");
            else
                ax_design_free(&design);
        }
    }
    if (status != AX_OK) {
        session_close(s);
        s = NULL;
    }
    *out = s;
    return status;
}

void session_close(session* s)
{
    if (!s)
        return;
    while (s->count)
        free_moment(&s->moments[--s->count]);
    ax_form_free(s->form);
    ax_free(s->folder);
    ax_free(s);
}

const ax_recipe* session_recipe(const session* s)
{
    return now(s)->recipe;
}

int session_at(const session* s)
{
    return now(s)->at;
}

ax_form* session_form(const session* s)
{
    return s->playing ? s->playing : s->form;
}

const ax_design* session_exact(const session* s)
{
    return now(s)->exact;
}

const char* session_undo_words(const session* s)
{
    return s->now > 0 ? now(s)->words : NULL;
}

const char* session_redo_words(const session* s)
{
    return s->now + 1 < s->count ? s->moments[s->now + 1].words : NULL;
}

int session_failed(const session* s, const ax_error** error)
{
    *error = &now(s)->failure;
    return now(s)->failed;
}

ax_status session_apply(session* s, const char* step, const ax_progress* progress, ax_error* error)
{
    ax_recipe* recipe = copy_recipe(now(s)->recipe);
    int at = now(s)->at;
    while (ax_recipe_count(recipe) > at)
        ax_recipe_remove(recipe, ax_recipe_count(recipe) - 1);
    ax_status status = ax_recipe_insert(recipe, at, step, error);
    if (status == AX_OK)
        status = ax_recipe_apply(recipe, at, s->folder, progress, &s->form, error);
    if (status != AX_OK) {
        ax_recipe_free(recipe);
        return status;
    }
    char words[160];
    ax_recipe_words(recipe, at, words);
    advance(s, recipe, at + 1, s->form, NULL, words);
    return AX_OK;
}

ax_status session_edit(session* s, int k, const char* step, const ax_progress* progress, ax_error* error)
{
    int count = ax_recipe_count(now(s)->recipe);
    if (k < 0 || k >= count)
        return ax_fail(error, AX_USAGE, "There are %d steps.", count);
    ax_recipe* recipe = copy_recipe(now(s)->recipe);
    char words[160];
    ax_recipe_words(recipe, k, words);
    ax_status status = AX_OK;
    if (step)
        status = ax_recipe_replace(recipe, k, step, error);
    else if (k == 0)
        status = ax_fail(error, AX_USAGE, "The first step makes the sheet: edit it, or start a new design.");
    else
        ax_recipe_remove(recipe, k);
    if (status != AX_OK) {
        ax_recipe_free(recipe);
        return status;
    }
    if (step)
        ax_recipe_words(recipe, k, words);
    char what[192];
    snprintf(what, sizeof what, "%s %s", step ? "Edit" : "Remove", words);
    int until = now(s)->at > k && !step ? now(s)->at - 1 : now(s)->at;
    return play(s, recipe, until, what, progress, error);
}

ax_status session_go(session* s, int at, const ax_progress* progress, ax_error* error)
{
    int count = ax_recipe_count(now(s)->recipe);
    if (at < 1 || at > count)
        return ax_fail(error, AX_USAGE, "There are %d steps.", count);
    char words[64];
    snprintf(words, sizeof words, "Go to step %d", at);
    return play(s, copy_recipe(now(s)->recipe), at, words, progress, error);
}

ax_status session_undo(session* s, const ax_progress* progress, ax_error* error)
{
    (void)progress;
    if (s->now == 0)
        return ax_fail(error, AX_USAGE, "There is nothing to undo.");
    --s->now;
    return restore(s, error);
}

ax_status session_redo(session* s, const ax_progress* progress, ax_error* error)
{
    (void)progress;
    if (s->now + 1 == s->count)
        return ax_fail(error, AX_USAGE, "There is nothing to do again.");
    ++s->now;
    return restore(s, error);
}

// A step of the recipe too, so that playing it again ends exact. A form that is exact already only gives its design again.
ax_status session_finish(session* s, const ax_progress* progress, ax_finish* finish, ax_error* error)
{
    ax_design design;
    ax_status status = ax_form_finish(s->form, progress, &design, finish, error);
    if (status != AX_OK) {
        restore(s, NULL);
        return status;
    }
    ax_recipe* recipe = copy_recipe(now(s)->recipe);
    int at = now(s)->at;
    if (strcmp(ax_recipe_type(recipe, at - 1)->name, "finish") != 0) {
        while (ax_recipe_count(recipe) > at)
            ax_recipe_remove(recipe, ax_recipe_count(recipe) - 1);
        ax_recipe_insert(recipe, at++,
                         finish->exact ? "{\"op\": \"finish\"}" : "{\"op\": \"finish\", \"allow_inexact\": true}",
                         NULL);
    }
    advance(s, recipe, at, s->form, ax_copy(&design, 1, sizeof design), "Finish");
    return AX_OK;
}

ax_status session_replace(session* s, const char* recipe, const ax_progress* progress, ax_error* error)
{
    ax_recipe* steps;
    ax_status status = ax_recipe_parse(recipe, &steps, error);
    return status == AX_OK ? play(s, steps, -1, "Take a variant", progress, error) : status;
}
