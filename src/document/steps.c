// The recipe and where its steps are stored.
#include "document/session.h"

ax_status ax_session_fail_reading(const ax_session* s, int result, ax_error* error)
{
    return result == SQLITE_CORRUPT ? ax_fail_damaged(s->path, "its history contradicts itself", error)
                                    : ax_fail_reading(s->path, s->database.view, result, error);
}

void ax_steps_reserve(ax_session* s, int steps)
{
    if (steps + 1 <= s->id_capacity)
        return;
    s->id_capacity = 2 * steps + 16;
    s->ids = ax_realloc(s->ids, (size_t)s->id_capacity, sizeof *s->ids);
    s->ids[0] = 0;
}

void ax_steps_shorten(ax_session* s, int steps)
{
    while (ax_recipe_count(s->recipe) > steps)
        ax_recipe_remove(s->recipe, ax_recipe_count(s->recipe) - 1);
}

ax_status ax_steps_show(ax_session* s, int64_t tip, int steps, ax_error* error)
{
    int64_t* ids = AX_NEW(int64_t, (size_t)steps + 1);
    sqlite3* db = s->database.view;
    int result = ax_history_path(db, tip, steps, ids), common = 0;
    if (result != SQLITE_OK) {
        ax_free(ids);
        return ax_session_fail_reading(s, result, error);
    }
    ax_steps_reserve(s, steps);
    while (common < steps && common < ax_recipe_count(s->recipe) && ids[common + 1] == s->ids[common + 1])
        ++common;
    ax_steps_shorten(s, common);
    ax_status status = AX_OK;
    for (int k = common; k < steps && status == AX_OK; ++k) {
        char* json;
        ax_error inner = {0};
        result = ax_history_operator(db, ids[k + 1], &json);
        if (result != SQLITE_OK)
            status = ax_session_fail_reading(s, result, error);
        else if (ax_recipe_insert(s->recipe, k, json, &inner) != AX_OK)
            status = ax_fail(error, AX_BAD_INPUT, "%s cannot be read: its step %d is not known here. %s", s->path,
                             k + 1, inner.message);
        ax_free(json);
        s->ids[k + 1] = ids[k + 1];
    }
    ax_free(ids);
    return status;
}

ax_status ax_steps_identify(ax_session* s, int from, ax_error* error)
{
    int count = ax_recipe_count(s->recipe), result = SQLITE_OK;
    ax_steps_reserve(s, count);
    for (int k = from; k < count && result == SQLITE_OK; ++k)
        if (s->ids[k] < 0)
            s->ids[k + 1] = -1;
        else
            result = ax_history_find(s->database.view, s->ids[k], ax_recipe_operator(s->recipe, k), &s->ids[k + 1]);
    return result == SQLITE_OK ? AX_OK : ax_session_fail_reading(s, result, error);
}
