// auxshell run: plays a recipe.
#include "options.h"
#include "output.h"
#include "progress.h"
#include "report.h"

#include "ax/document.h"
#include "ax/recipe.h"

#include <limits.h>
#include <string.h>
#include <sys/stat.h>
#include <time.h>

typedef struct arguments {
    const char *recipe, *out;
    int until;
    bool watch;
} arguments;

static void defaults(void* given)
{
    arguments* a = given;
    a->until = -1;
}

static const command_option options[] = {
    {.name = "RECIPE.json",
     .text = "the recipe to play",
     .kind = OPTION_TEXT,
     .operand = true,
     .required = true,
     .offset = offsetof(arguments, recipe)},
    {.name = "-o",
     .value = "P.auxshell",
     .text = "the document to write",
     .kind = OPTION_TEXT,
     .required = true,
     .offset = offsetof(arguments, out)},
    {.name = "--until",
     .value = "N",
     .text = "play the first N operators only",
     .kind = OPTION_INTEGER,
     .lo = 1,
     .hi = 1000000,
     .fallback = "all",
     .offset = offsetof(arguments, until)},
    {.name = "--watch",
     .text = "play it again whenever the file changes, from the first operator that did, until interrupted",
     .kind = OPTION_FLAG,
     .offset = offsetof(arguments, watch)},
};

// The form as it was after each operator, so that a changed recipe is played from the first change on.
typedef struct mark {
    char* json;
    void* bytes;
    size_t size;
} mark;

typedef struct session {
    const arguments* given;
    char folder[PATH_MAX];
    mark* marks;
    int mark_count;
} session;

static void forget_marks(session* s, int from)
{
    for (int k = from; k < s->mark_count; ++k) {
        ax_free(s->marks[k].json);
        ax_free(s->marks[k].bytes);
    }
    s->mark_count = from < s->mark_count ? from : s->mark_count;
}

static void put_mark(session* s, const char* json, const ax_form* form)
{
    s->marks = ax_realloc(s->marks, (size_t)s->mark_count + 1, sizeof *s->marks);
    mark* m = &s->marks[s->mark_count++];
    m->json = ax_copy(json, strlen(json) + 1, 1);
    m->bytes = ax_form_save(form, &m->size);
}

// How many operators are as they were when they were played last.
static int unchanged(const session* s, const ax_recipe* recipe, int count)
{
    int k = 0;
    while (k < count && k < s->mark_count && strcmp(s->marks[k].json, ax_recipe_operator(recipe, k)) == 0)
        ++k;
    return k;
}

static bool print_state(ax_form* form)
{
    ax_form_report r;
    ax_form_measure(form, &r);
    const char* unit = ax_unit_name(ax_form_look(form).unit);
    printf("\n%s after %d iterations. Mean edge %.4g %s, scale factors %.3f to %.3f, smallest mouth %.1f degrees.\n",
           r.exact     ? "Exact"
           : r.settled ? "Settled"
                       : "Not settled",
           r.iterations, r.edge, unit, r.realised_min, r.realised_max, r.mouth_min * 57.29577951308232);
    if (r.held_count)
        printf("\n  %-24s%-14s%8s  %12s\n", "held", "by", "hinges", "off by");
    for (int k = 0; k < r.held_count; ++k)
        printf("  %-24s%-14s%8d  %12.3g %s\n", r.held[k].name, r.held[k].kind, r.held[k].count, r.held[k].residual,
               unit);
    for (int k = 0; k < r.finding_count; ++k)
        printf("%s%s\n", k ? "" : "\n", r.findings[k].text);
    bool exact = r.exact;
    ax_form_report_free(&r);
    return exact;
}

static ax_status save(const session* s, ax_form* form, bool exact, ax_error* error)
{
    ax_design design = {0};
    ax_finish finish;
    ax_status status = AX_OK;
    if (exact)
        status = ax_form_finish(form, progress_reporter(), &design, &finish, error);
    else
        ax_form_snapshot(form, false, &design);
    progress_end();
    if (status == AX_OK)
        status = ax_document_save(s->given->out, &design, error);
    if (status == AX_OK)
        printf("\nWrote %s: %d triangles.\n", s->given->out, design.linkage.triangle_count);
    ax_design_free(&design);
    return status;
}

// From where `form` stands, after `done` operators.
static ax_status play_on(session* s, const ax_recipe* recipe, int done, int count, ax_form** form, ax_error* error)
{
    for (int k = done; k < count; ++k) {
        ax_progress_part part;
        const ax_progress* within =
            ax_progress_within(&part, progress_reporter(), (double)k / count, (k + 1.0) / count);
        ax_status status = ax_recipe_apply(recipe, k, s->folder, within, form, error);
        if (status != AX_OK)
            return status;
        char words[160];
        ax_recipe_words(recipe, k, words);
        progress_end();
        printf("%3d  %s\n", k + 1, words);
        fflush(stdout);
        if (s->given->watch)
            put_mark(s, ax_recipe_operator(recipe, k), *form);
    }
    return AX_OK;
}

static ax_status play(session* s, ax_error* error)
{
    ax_recipe* recipe;
    ax_status status = ax_recipe_read(s->given->recipe, &recipe, error);
    if (status != AX_OK)
        return status;
    int count = ax_recipe_count(recipe);
    if (s->given->until >= 0 && s->given->until < count)
        count = s->given->until;
    int done = unchanged(s, recipe, count);
    ax_form* form = NULL;
    forget_marks(s, done);
    if (count == 0)
        status =
            ax_fail(error, AX_BAD_INPUT, "%s has no operators: begin with one that starts a design.", s->given->recipe);
    if (status == AX_OK && done)
        status = ax_form_load(s->marks[done - 1].bytes, s->marks[done - 1].size, &form, error);
    if (status == AX_OK)
        status = play_on(s, recipe, done, count, &form, error);
    progress_end();
    if (status == AX_OK) {
        bool exact = print_state(form);
        status = save(s, form, exact, error);
    }
    ax_form_free(form);
    ax_recipe_free(recipe);
    return status;
}

// Waits until the file has other times or another size; false after an interrupt. Editors that write beside and rename leave
// a moment without the file.
static bool wait_for_change(const char* path, struct stat* known)
{
    for (;;) {
        struct stat now;
        if (progress_cancelled())
            return false;
        nanosleep(&(struct timespec){.tv_nsec = 100000000}, NULL);
        if (stat(path, &now) == 0 &&
            (now.st_mtim.tv_sec != known->st_mtim.tv_sec || now.st_mtim.tv_nsec != known->st_mtim.tv_nsec ||
             now.st_size != known->st_size || now.st_ino != known->st_ino)) {
            *known = now;
            return true;
        }
    }
}

static ax_status watch(session* s)
{
    struct stat known = {0};
    while (wait_for_change(s->given->recipe, &known)) {
        ax_error error;
        if (play(s, &error) != AX_OK && !progress_cancelled())
            fprintf(stderr, "auxshell run: %s\n", error.message);
        if (!progress_cancelled())
            printf("\nWatching %s.\n", s->given->recipe);
        fflush(stdout);
    }
    return AX_OK; // an interrupt is how watching ends
}

static ax_status run(const void* given, ax_error* error)
{
    session s = {.given = given};
    const char* slash = strrchr(s.given->recipe, '/');
    if (strlen(s.given->recipe) >= sizeof s.folder)
        return ax_fail(error, AX_USAGE, "The name of the recipe is longer than the system allows.");
    snprintf(s.folder, sizeof s.folder, "%.*s", slash ? (int)(slash - s.given->recipe) + 1 : 1,
             slash ? s.given->recipe : ".");
    ax_status status = output_check(s.given->out, ".auxshell", error);
    if (status == AX_OK)
        status = s.given->watch ? watch(&s) : play(&s, error);
    forget_marks(&s, 0);
    ax_free(s.marks);
    return status;
}

const command command_run = {
    .name = "run",
    .summary = "play a recipe: form-finding from scratch or from a surface",
    .text = "Plays the operators of a recipe one after the other, prints what came of it, and writes the document. "
            "\"auxshell "
            "operators\" lists the operators; docs/recipes.md explains the format. Files that a recipe names are "
            "looked for "
            "in its folder.",
    .options = options,
    .option_count = sizeof options / sizeof *options,
    .size = sizeof(arguments),
    .defaults = defaults,
    .run = run,
};
