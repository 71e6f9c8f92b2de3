// Changes to a document: each is tried, and then it is a moment of the history.
#include "document/session.h"

#include <stdio.h>
#include <string.h>

ax_status ax_change_apply(ax_session* s, const char* json, int number, const ax_progress* progress, ax_finish* figures,
                          ax_error* error)
{
    int at = s->present.at;
    ax_attempt a = {0};
    ax_steps_shorten(s, at);
    ax_status status = ax_recipe_insert(s->recipe, at, json, error);
    if (status == AX_OK)
        status = ax_steps_identify(s, at, error);
    if (status == AX_OK)
        status = ax_attempt_play(s, at + 1, progress, &a, error);
    if (figures)
        *figures = a.finished.figures;
    if (status == AX_OK) {
        char words[160];
        ax_recipe_words(s->recipe, at, words);
        status = ax_saving_commit(s, &a, number, words, NULL, error);
    }
    return ax_saving_conclude(s, &a, status);
}

ax_status ax_session_apply(ax_session* s, const char* json, const ax_progress* progress, ax_error* error)
{
    ax_status status = ax_saving_check(s, error);
    return status == AX_OK ? ax_change_apply(s, json, s->present.now + 1, progress, NULL, error) : status;
}

ax_status ax_session_finish(ax_session* s, const ax_progress* progress, ax_finish* figures, ax_error* error)
{
    ax_status status = ax_saving_check(s, error);
    return status == AX_OK ? ax_change_apply(s, "{\"op\": \"finish\"}", s->present.now + 1, progress, figures, error)
                           : status;
}

// Plays the recipe as it was edited from step `from` on. Only there may it not fail.
static ax_status play_edited(ax_session* s, int from, int until, const char* words, const ax_progress* progress,
                             ax_error* error)
{
    ax_attempt a = {0};
    ax_error failure = {0};
    ax_status status = ax_steps_identify(s, from, &failure);
    if (status == AX_OK)
        status = ax_attempt_play(s, until, progress, &a, &failure);
    bool later = status != AX_OK && status != AX_CANCELLED && a.form && a.at > from;
    if (status == AX_OK || later)
        status = ax_saving_commit(s, &a, s->present.now + 1, words, later ? failure.message : NULL, &failure);
    if (status != AX_OK && error)
        *error = failure;
    return ax_saving_conclude(s, &a, status);
}

ax_status ax_session_edit(ax_session* s, int k, const char* json, const ax_progress* progress, ax_error* error)
{
    int count = ax_recipe_count(s->recipe),
        at = s->present.failure ? count : s->present.at; // an edit may mend what failed
    ax_status status = ax_saving_check(s, error);
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
    ax_status status = ax_saving_check(s, error);
    if (status != AX_OK)
        return status;
    while (common < count && common < ax_recipe_count(s->recipe) &&
           strcmp(ax_recipe_operator(recipe, common), ax_recipe_operator(s->recipe, common)) == 0)
        ++common;
    ax_steps_shorten(s, common);
    for (int k = common; k < count && status == AX_OK; ++k)
        status = ax_recipe_insert(s->recipe, k, ax_recipe_operator(recipe, k), error);
    if (status != AX_OK) {
        ax_saving_revert(s, NULL);
        return status;
    }
    return play_edited(s, common, count, "Take another recipe", progress, error);
}

ax_status ax_session_go(ax_session* s, int at, const ax_progress* progress, ax_error* error)
{
    int count = ax_recipe_count(s->recipe), first = s->from_design ? 0 : 1;
    ax_status status = ax_saving_check(s, error);
    if (status != AX_OK)
        return status;
    if (at < first || at > count)
        return ax_fail(error, AX_USAGE, "There is no state after %d steps: the recipe has %d.", at, count);
    ax_attempt a;
    status = ax_attempt_play(s, at, progress, &a, error);
    if (status == AX_OK) {
        char words[64];
        snprintf(words, sizeof words, "Go to step %d", at);
        status = ax_saving_commit(s, &a, s->present.now + 1, words, NULL, error);
    }
    return ax_saving_conclude(s, &a, status);
}

ax_status ax_change_visit(ax_session* s, const ax_present* target, const char* words, const ax_progress* progress,
                          ax_error* error)
{
    ax_attempt a = {0};
    ax_status status = ax_steps_show(s, target->tip, target->steps, error);
    if (status == AX_OK)
        status = ax_attempt_play(s, target->at, progress, &a, error);
    if (status == AX_OK)
        status = ax_saving_commit(s, &a, target->now, words, target->failure, error);
    return ax_saving_conclude(s, &a, status);
}

ax_status ax_session_jump(ax_session* s, int moment, const ax_progress* progress, ax_error* error)
{
    ax_status status = ax_saving_check(s, error);
    if (status != AX_OK)
        return status;
    if (moment < 0 || moment >= s->moment_count)
        return ax_fail(error, AX_USAGE, "There is no moment %d: the history has 0 to %d.", moment, s->moment_count - 1);
    ax_present target;
    int result = ax_history_moment(s->database.view, moment, &target);
    status = result == SQLITE_OK ? ax_change_visit(s, &target, NULL, progress, error)
                                 : ax_session_fail_reading(s, result, error);
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
