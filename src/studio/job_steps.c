// Commands that edit the recipe, or ask about it.
#include "studio/describe.h"
#include "studio/job.h"

#include <string.h>

static json_t* at_result(const desk* d)
{
    return json_pack("{s:i}", "at", ax_session_at(d->session));
}

static ax_status step_text(const job* j, json_t* step, char** text, ax_error* error)
{
    *text = json_is_object(step) ? json_dumps(step, JSON_COMPACT) : NULL;
    return *text
               ? AX_OK
               : ax_fail(error, AX_USAGE, "%s: \"operator\" is an object: {\"op\": \"fill\", ...}.", j->message.action);
}

static ax_status apply(desk* d, const job* j, json_t** result, ax_error* error)
{
    json_t* step;
    char* text;
    ax_status status = message_unpack(&j->message, error, "{s:o}", "operator", &step);
    if (status == AX_OK)
        status = step_text(j, step, &text, error);
    if (status != AX_OK)
        return status;
    desk_begin_edit(d);
    const ax_progress progress = desk_progress(d);
    status = ax_session_apply(d->session, text, &progress, error);
    free(text);
    *result = at_result(d);
    return status;
}

static ax_status edit(desk* d, const job* j, json_t** result, ax_error* error)
{
    json_t* step = NULL;
    char* text = NULL;
    int k;
    bool removes = strcmp(j->message.action, "remove") == 0;
    ax_status status = removes ? message_unpack(&j->message, error, "{s:i}", "step", &k)
                               : message_unpack(&j->message, error, "{s:i, s:o}", "step", &k, "operator", &step);
    if (status == AX_OK && !removes)
        status = step_text(j, step, &text, error);
    if (status != AX_OK)
        return status;
    desk_begin_edit(d);
    const ax_progress progress = desk_progress(d);
    status = ax_session_edit(d->session, k, text, &progress, error);
    free(text);
    *result = at_result(d);
    return status;
}

static ax_status go(desk* d, const job* j, json_t** result, ax_error* error)
{
    int at;
    ax_status status = message_unpack(&j->message, error, "{s:i}", "at", &at);
    if (status != AX_OK)
        return status;
    desk_begin_edit(d);
    const ax_progress progress = desk_progress(d);
    status = ax_session_go(d->session, at, &progress, error);
    *result = at_result(d);
    return status;
}

static ax_status undo(desk* d, const job* j, json_t** result, ax_error* error)
{
    desk_begin_edit(d);
    const ax_progress progress = desk_progress(d);
    ax_status status = strcmp(j->message.action, "undo") == 0 ? ax_session_undo(d->session, &progress, error)
                                                              : ax_session_redo(d->session, &progress, error);
    *result = at_result(d);
    return status;
}

static ax_status finish(desk* d, const job* j, json_t** result, ax_error* error)
{
    (void)j;
    desk_begin_edit(d);
    ax_finish made = {0};
    const ax_progress progress = desk_progress(d);
    ax_status status = ax_session_finish(d->session, &progress, &made, error);
    if (status == AX_OK)
        *result =
            json_pack("{s:b, s:s, s:o, s:o, s:o, s:o}", "exact", made.exact, "reason", made.reason, "flat_moved_rms",
                      describe_number(made.flat_moved_rms), "flat_moved_max", describe_number(made.flat_moved_max),
                      "deployed_moved_rms", describe_number(made.deployed_moved_rms), "deployed_moved_max",
                      describe_number(made.deployed_moved_max));
    return status;
}

static ax_status recipe(desk* d, const job* j, json_t** result, ax_error* error)
{
    (void)j, (void)error;
    char* text = ax_recipe_text(ax_session_recipe(d->session));
    *result = json_pack("{s:s}", "text", text);
    ax_free(text);
    return AX_OK;
}

static ax_status select_hinges(desk* d, const job* j, json_t** result, ax_error* error)
{
    const char* words;
    int *hinges, count;
    ax_status status = message_unpack(&j->message, error, "{s:s}", "hinges", &words);
    if (status == AX_OK)
        status = ax_select(ax_session_form(d->session), words, &hinges, &count, error);
    if (status != AX_OK)
        return status;
    json_t* list = json_array();
    for (int k = 0; k < count; ++k)
        json_array_append_new(list, json_integer(hinges[k]));
    ax_free(hinges);
    *result = json_pack("{s:o}", "hinges", list);
    return AX_OK;
}

const job_type job_types_steps[] = {
    {"apply", true, apply, false},
    {"edit", true, edit, false},
    {"remove", true, edit, false},
    {"goto", true, go, false},
    {"undo", true, undo, true},
    {"redo", true, undo, true},
    {"finish", true, finish, true},
    {"recipe", false, recipe, true},
    {"select", false, select_hinges, false},
    {0},
};
