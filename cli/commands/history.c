// auxshell history: the changes that led to a document, those that were undone, and its variants.
#include "options.h"
#include "progress.h"
#include "report.h"
#include "walk.h"

#include <math.h>
#include <time.h>

typedef struct arguments {
    const char* document;
    bool json;
} arguments;

static const command_option options[] = {
    OPTION_DOCUMENT(arguments),
    {.name = "--json", .text = "print it as JSON", .kind = OPTION_FLAG, .offset = offsetof(arguments, json)},
};

static void time_words(double seconds, char words[32])
{
    time_t whole = (time_t)seconds;
    struct tm parts;
    bool known = isfinite(seconds) && fabs(seconds) < 1e11 && localtime_r(&whole, &parts);
    if (!known || strftime(words, 32, "%Y-%m-%d %H:%M:%S", &parts) == 0)
        snprintf(words, 32, "%-19s", "");
}

static void print_table(const ax_session* session)
{
    const ax_moment* moments;
    int now, count = ax_session_history(session, &moments, &now);
    for (int k = 0; k < count; ++k) {
        char time[32];
        time_words(moments[k].time, time);
        printf("%c %4d  %s  %s%s\n", k == now ? '>' : ' ', k, time, k > now ? "(undone) " : "", moments[k].words);
    }
    walk_print_place(session);
    const ax_variant* variants;
    count = ax_session_variants(session, &variants);
    for (int k = 0; k < count; ++k) {
        char time[32];
        time_words(variants[k].time, time);
        printf("%sVariant %s%s: %d steps, kept %s\n", k ? "" : "\n", variants[k].name,
               variants[k].present ? " (this)" : "", variants[k].at, time);
    }
}

static void print_json(const ax_session* session)
{
    const ax_moment* moments;
    int now, count = ax_session_history(session, &moments, &now);
    json_t *list = json_array(), *steps = json_array(), *kept = json_array();
    const ax_variant* variants;
    int variant_count = ax_session_variants(session, &variants);
    for (int k = 0; k < variant_count; ++k) {
        json_t* figures = json_loads(variants[k].figures, 0, NULL);
        json_array_append_new(kept, json_pack("{s:s, s:o, s:i, s:b, s:o}", "name", variants[k].name, "time",
                                              json_number(variants[k].time), "steps", variants[k].at, "present",
                                              variants[k].present, "figures", figures ? figures : json_null()));
    }
    for (int k = 0; k < count; ++k)
        json_array_append_new(list,
                              json_pack("{s:s, s:o, s:i, s:i}", "words", moments[k].words, "time",
                                        json_number(moments[k].time), "steps", moments[k].steps, "at", moments[k].at));
    for (int k = 0; k < ax_recipe_count(ax_session_recipe(session)); ++k)
        json_array_append_new(steps, json_loads(ax_recipe_operator(ax_session_recipe(session), k), 0, NULL));
    const char* why;
    int failed = ax_session_failed(session, &why);
    json_print(json_pack("{s:i, s:o, s:i, s:o, s:o, s:s?, s:o}", "now", now, "moments", list, "at",
                         ax_session_at(session), "steps", steps, "failed",
                         failed < 0 ? json_null() : json_integer(failed), "failure", why, "variants", kept),
               stdout);
}

static ax_status run(const void* given, ax_error* error)
{
    const arguments* a = given;
    ax_session* session;
    ax_status status = ax_session_open(a->document, false, NULL, progress_reporter(), &session, error);
    progress_end();
    if (status != AX_OK)
        return status;
    if (a->json)
        print_json(session);
    else
        print_table(session);
    ax_session_close(session);
    return AX_OK;
}

const command command_history = {
    .name = "history",
    .summary = "list the changes that led to a document",
    .text = "Lists every change of a document with its time, and marks the one at which it stands: those after it were "
            "undone and can be redone. Its variants follow, as they were kept in the studio.",
    .options = options,
    .option_count = sizeof options / sizeof *options,
    .size = sizeof(arguments),
    .run = run,
};
