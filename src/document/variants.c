// Variants: places of the history that have a name.
#include "document/session.h"

#include <stdio.h>
#include <string.h>

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
    ax_status status = ax_saving_check(s, error);
    if (status != AX_OK)
        return status;
    if (!s->form)
        return ax_fail(error, AX_USAGE, "%s is empty: there is nothing to keep.", s->path);
    if (!*name || strlen(name) > AX_VARIANT_NAME)
        return ax_fail(error, AX_USAGE, "The name of a variant has 1 to %d bytes.", AX_VARIANT_NAME);
    if (s->variant_count >= AX_VARIANTS_MOST && find_variant(s, name, &old, NULL) != AX_OK)
        return ax_fail(error, AX_USAGE, "A document has at most %d variants. Remove one first.", AX_VARIANTS_MOST);
    int result = ax_saving_begin(s);
    if (result == SQLITE_OK)
        result = ax_history_keep_variant(s->database.file, name, &s->present, ax_saving_now(), figures);
    status = ax_saving_end(s, result, error);
    return status == AX_OK ? ax_saving_read_variants(s, error) : status;
}

ax_status ax_session_drop_variant(ax_session* s, const char* name, ax_error* error)
{
    const ax_kept_variant* v;
    ax_status status = ax_saving_check(s, error);
    if (status == AX_OK)
        status = find_variant(s, name, &v, error);
    if (status != AX_OK)
        return status;
    int result = ax_saving_begin(s);
    if (result == SQLITE_OK)
        result = ax_history_drop_variant(s->database.file, name);
    status = ax_saving_end(s, result, error);
    return status == AX_OK ? ax_saving_read_variants(s, error) : status;
}

ax_status ax_session_take_variant(ax_session* s, const char* name, const ax_progress* progress, ax_error* error)
{
    const ax_kept_variant* v = NULL;
    ax_status status = ax_saving_check(s, error);
    if (status == AX_OK)
        status = find_variant(s, name, &v, error);
    if (status != AX_OK)
        return status;
    const ax_present target = {
        .now = s->present.now + 1, .tip = v->tip, .state = v->state, .steps = v->steps, .at = v->at};
    char words[AX_VARIANT_NAME + 32];
    snprintf(words, sizeof words, "Take variant %s", name);
    return ax_change_visit(s, &target, words, progress, error);
}

ax_status ax_session_variant_form(ax_session* s, const char* name, const ax_progress* progress, ax_form** form,
                                  ax_error* error)
{
    const ax_kept_variant* v = NULL;
    *form = NULL;
    ax_status status = find_variant(s, name, &v, error);
    if (status != AX_OK)
        return status;
    ax_attempt a = {0};
    if (!ax_attempt_fetch(s, v->state, &a)) {
        status = ax_steps_show(s, v->tip, v->steps, error);
        if (status == AX_OK)
            status = ax_attempt_play(s, v->at, progress, &a, error);
    }
    if (status == AX_OK) {
        *form = a.form;
        a.form = NULL;
    }
    ax_saving_revert(s, &a);
    return status;
}
