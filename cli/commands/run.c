// auxshell run: plays a recipe.
#include "options.h"
#include "output.h"
#include "progress.h"
#include "report.h"

#include "ax/session.h"

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
    OPTION_OUT(arguments),
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

static void print_state(ax_form* form)
{
    ax_form_report r;
    ax_form_measure(form, &r);
    const char* unit = ax_unit_name(ax_form_look(form).unit);
    printf(
        "\n%s after %d iterations. Mean edge %.4g %s, scale factors within the sheet %.3f to %.3f, smallest mouth %.1f "
        "degrees.\n",
        !r.settled ? "Not settled"
        : r.exact  ? "Exact"
                   : "Settled",
        r.iterations, r.edge, unit, r.realised_min, r.realised_max, r.mouth_min * 57.29577951308232);
    form_print(&r, ax_form_look(form).unit, stdout);
    if (ax_form_get_dynamics(form)->kind == AX_DYNAMICS_NONE)
        printf("\nOnly the flat state is solved yet: expand, gravity or inflation opens the sheet.\n");
    ax_form_report_free(&r);
}

// How the design was opened, if the recipe finished one.
static ax_status print_opening(ax_session* session, ax_error* error)
{
    const ax_design* design;
    ax_status status = ax_session_design(session, progress_reporter(), &design, error);
    progress_end();
    if (status == AX_OK && design && design->simulated)
        printf("\nSimulated %.4f L rms from the design, %s.\n", design->report.simulated_rms_over_L,
               ax_report_opening(&design->report));
    if (status == AX_OK && design)
        report_print_failing(design, stdout);
    return status;
}

static void print_step(void* context, int k, const char* words)
{
    (void)context;
    progress_end();
    printf("%3d  %s\n", k + 1, words);
    fflush(stdout);
}

static int steps_asked(const arguments* a, const ax_recipe* recipe)
{
    int count = ax_recipe_count(recipe);
    return a->until >= 0 && a->until < count ? a->until : count;
}

static ax_status create(const arguments* a, const ax_recipe* recipe, ax_session** session, ax_error* error)
{
    char folder[PATH_MAX];
    const char* slash = strrchr(a->recipe, '/');
    if (strlen(a->recipe) >= sizeof folder)
        return ax_fail(error, AX_USAGE, "The name of the recipe is longer than the system allows.");
    snprintf(folder, sizeof folder, "%.*s", slash ? (int)(slash - a->recipe) + 1 : 1, slash ? a->recipe : ".");
    const ax_session_start start = {.recipe = recipe,
                                    .until = a->until,
                                    .folder = folder,
                                    .program = "auxshell run",
                                    .played = print_step,
                                    .keep = AX_KEEP_BEFORE_UNREALISABLE};
    return ax_session_create(a->out, &start, progress_reporter(), session, error);
}

// How many operators are as they were when they were played last.
static int unchanged(const ax_recipe* recipe, const ax_session* session)
{
    const ax_recipe* old = ax_session_recipe(session);
    int k = 0;
    while (k < ax_recipe_count(recipe) && k < ax_session_at(session) &&
           strcmp(ax_recipe_operator(recipe, k), ax_recipe_operator(old, k)) == 0)
        ++k;
    return k;
}

// The document goes on from what the recipes have in common, as one change that can be undone.
static ax_status replace(const arguments* a, ax_recipe* recipe, ax_session* session, ax_error* error)
{
    for (int k = ax_recipe_count(recipe); k > steps_asked(a, recipe); --k)
        ax_recipe_remove(recipe, k - 1);
    int first = unchanged(recipe, session);
    ax_status status = ax_session_replace(session, recipe, progress_reporter(), error);
    progress_end();
    for (int k = first; k < ax_session_at(session) && status == AX_OK; ++k) {
        char words[160];
        ax_recipe_words(recipe, k, words);
        print_step(NULL, k, words);
    }
    return status;
}

// Plays into the session, which is made if there is none yet.
static ax_status play(const arguments* a, ax_session** session, ax_error* error)
{
    ax_recipe* recipe;
    ax_status status = ax_recipe_read(a->recipe, &recipe, error);
    if (status != AX_OK)
        return status;
    if (steps_asked(a, recipe) == 0)
        status = ax_fail(error, AX_BAD_INPUT, "%s has no operators: begin with one that starts a design.", a->recipe);
    else
        status = *session ? replace(a, recipe, *session, error) : create(a, recipe, session, error);
    progress_end();
    ax_recipe_free(recipe);
    if (status != AX_OK)
        return status;
    print_state(ax_session_form(*session));
    status = print_opening(*session, error);
    if (status != AX_OK)
        return status;
    printf("\nWrote %s: %d triangles.\n", a->out, ax_form_look(ax_session_form(*session)).linkage->triangle_count);
    const char* why;
    if (ax_session_failed(*session, &why) < 0)
        return AX_OK;
    fflush(stdout);
    return ax_fail(error, AX_CANNOT_REALISE, "%s The document holds what came before.", why);
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

static ax_status watch(const arguments* a, ax_session** session)
{
    struct stat known = {0};
    while (wait_for_change(a->recipe, &known)) {
        ax_error error;
        if (play(a, session, &error) != AX_OK && !progress_cancelled())
            fprintf(stderr, "auxshell run: %s\n", error.message);
        if (!progress_cancelled())
            printf("\nWatching %s.\n", a->recipe);
        fflush(stdout);
    }
    return AX_OK; // an interrupt is how watching ends
}

static ax_status run(const void* given, ax_error* error)
{
    const arguments* a = given;
    ax_session* session = NULL;
    ax_status status = output_check(a->out, ".auxshell", error);
    if (status == AX_OK)
        status = a->watch ? watch(a, &session) : play(a, &session, error);
    ax_session_close(session);
    return status;
}

const command command_run = {
    .name = "run",
    .summary = "play a recipe: form-finding from scratch or from a surface",
    .text =
        "Plays the operators of a recipe one after the other, prints what came of it, and writes the document. If an "
        "operator asks for what cannot exist, the document holds what came before it. \"auxshell operators\" lists the "
        "operators; docs/recipes.md explains the format. Files that a recipe names are looked for in its folder.",
    .options = options,
    .option_count = sizeof options / sizeof *options,
    .size = sizeof(arguments),
    .defaults = defaults,
    .run = run,
};
