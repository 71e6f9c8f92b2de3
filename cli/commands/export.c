// auxshell export: writes a document's states to files of other programs.
#include "fabricate.h"
#include "output.h"
#include "progress.h"
#include "report.h"

#include "ax/document.h"
#include "ax/export.h"
#include "ax/session.h"

#include <string.h>

typedef struct arguments {
    const char* document;
    word_list out;
    ax_state state;
    fabricate_arguments fabricate;
    int clusters;
} arguments;

static void defaults(void* given)
{
    fabricate_defaults(&((arguments*)given)->fabricate);
}

static const char* const states[] = {"flat", "deployed", "simulated"};

static const command_option options[] = {
    OPTION_DOCUMENT(arguments),
    {.name = "-o",
     .value = "FILE",
     .text = "a file to write; its ending chooses the format. Given several times, all files are written at once, of "
             "one plan",
     .kind = OPTION_WORDS,
     .required = true,
     .offset = offsetof(arguments, out)},
    {.name = "--state",
     .text = "which state to write",
     .kind = OPTION_CHOICE,
     .choices = states,
     .choice_count = 3,
     .first = AX_STATE_FLAT,
     .fallback = "flat for cut files, deployed otherwise",
     .offset = offsetof(arguments, state)},
    FABRICATE_OPTIONS(arguments, fabricate),
    {.name = "--clusters",
     .value = "K",
     .text = "how many sizes of panel the schedule (.csv) proposes, with the error they would cause",
     .kind = OPTION_INTEGER,
     .lo = 1,
     .hi = 2e6,
     .fallback = "as many as keep every edge within 0.1 mm",
     .offset = offsetof(arguments, clusters)},
};

// The file's name without folder and ending.
static void title_of(const char* path, char* title, size_t size)
{
    const char* slash = strrchr(path, '/');
    snprintf(title, size, "%s", slash ? slash + 1 : path);
    char* dot = strrchr(title, '.');
    if (dot && dot != title)
        *dot = 0;
}

static bool ends_in(const char* text, const char* ending)
{
    size_t length = strlen(text), part = strlen(ending);
    return length > part && strcmp(text + length - part, ending) == 0;
}

static ax_status write_applied(const ax_session* session, const char* path, ax_error* error)
{
    char* text = ax_recipe_text(ax_session_recipe(session));
    ax_recipe* recipe;
    ax_status status = ax_recipe_parse(text, &recipe, error);
    ax_free(text);
    if (status != AX_OK)
        return status;
    for (int k = ax_recipe_count(recipe); k > ax_session_at(session); --k)
        ax_recipe_remove(recipe, k - 1);
    status = ax_recipe_write(recipe, path, error);
    ax_recipe_free(recipe);
    return status;
}

// The steps that are applied, as a recipe that `run` plays.
static ax_status export_recipe(const arguments* a, const char* path, ax_error* error)
{
    ax_session* session;
    ax_status status = ax_session_open(a->document, false, NULL, progress_reporter(), &session, error);
    progress_end();
    if (status != AX_OK)
        return status;
    if (ax_session_from_design(session))
        status =
            ax_fail(error, AX_BAD_INPUT,
                    "%s began as a finished design, so it has no recipe of its own. Export the design itself: .json.",
                    a->document);
    else
        status = write_applied(session, path, error);
    ax_session_close(session);
    if (status == AX_OK)
        printf("Wrote %s\n", path);
    return status;
}

// Whoever cuts must not take the overview for a sheet.
static void print_written(const char* path, const ax_cut_plan* plan)
{
    char* first = ax_export_sheet_path(path, plan, 0);
    char* last = first ? ax_export_sheet_path(path, plan, plan->sheet_count - 1) : NULL;
    if (first)
        printf("Wrote %s to %s, and %s, an overview that is not to be cut\n", first, last, path);
    else
        printf("Wrote %s\n", path);
    ax_free(first);
    ax_free(last);
}

static ax_status export_design(const arguments* a, int count, const char* const* paths, ax_error* error)
{
    ax_design design = {0};
    ax_cut_plan plan = {0};
    fabricate_choice chosen;
    ax_status status = fabricate_choose(&a->fabricate, a->document, &chosen, error);
    chosen.options.sizes = a->clusters;
    if (status == AX_OK)
        status = ax_document_load(a->document, &design, error);
    if (status == AX_OK) {
        char title[256];
        title_of(a->document, title, sizeof title);
        const ax_export_options how = {.state = a->state,
                                       .title = title,
                                       .fabricate = &chosen.options,
                                       .progress = progress_reporter(),
                                       .plan = &plan};
        status = ax_export_files(&design, count, paths, &how, error);
        progress_end();
    }
    for (int k = 0; k < count && status == AX_OK; ++k)
        print_written(paths[k], &plan);
    if (status == AX_OK && plan.sheet_count)
        fabricate_print(&plan, stdout);
    if (status == AX_OK && report_print_failing(&design, stdout) && !design.simulated)
        printf("Not proven to deploy: \"auxshell finish %s\" makes it exact before it is cut.\n", a->document);
    ax_cut_plan_free(&plan);
    ax_design_free(&design);
    return status;
}

static ax_status run(const void* given, ax_error* error)
{
    const arguments* a = given;
    const char *recipe = NULL, *paths[sizeof a->out.words / sizeof *a->out.words];
    int count = 0;
    ax_status status = AX_OK;
    for (int k = 0; k < a->out.count && status == AX_OK; ++k) {
        const char* path = a->out.words[k];
        status = output_check(path, NULL, error);
        if (!ends_in(path, ".recipe.json"))
            paths[count++] = path;
        else if (!recipe)
            recipe = path;
        else
            status = ax_fail(error, AX_USAGE, "%s and %s would be the same recipe. Name one.", recipe, path);
    }
    if (status == AX_OK && count)
        status = export_design(a, count, paths, error);
    if (status == AX_OK && recipe)
        status = export_recipe(a, recipe, error);
    return status;
}

static void list_formats(list_row row, FILE* out)
{
    int count;
    const ax_export_type* const* types = ax_export_types(&count);
    for (int k = 0; k < count; ++k) {
        char words[512];
        snprintf(words, sizeof words, "%s: %s", types[k]->name, types[k]->doc);
        row(types[k]->ending, words, out);
    }
}

const command command_export = {
    .name = "export",
    .summary = "write a state to a cut file, a 3D model, a picture or JSON",
    .text =
        "Writes a state of a document to a file, in the format that the file's ending names. Coordinates are those of "
        "the target, in the document's unit; cut files are drawn at true size in millimetres. What fits one sheet gets "
        "the name given; several sheets become NAME-1, NAME-2 and so on beside an overview of that name. "
        "NAME.recipe.json is the recipe: the steps that are applied, to be played by run.",
    .options = options,
    .option_count = sizeof options / sizeof *options,
    .size = sizeof(arguments),
    .defaults = defaults,
    .run = run,
    .list_title = "Formats",
    .list = list_formats,
};
