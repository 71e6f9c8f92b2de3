// auxshell gallery: makes every example again from its recipe and holds its figures against their bounds.
#include "bounds.h"
#include "gallery_page.h"
#include "options.h"
#include "output.h"
#include "progress.h"
#include "report.h"

#include "fabricate.h"

#include "ax/export.h"
#include "ax/picture.h"
#include "ax/session.h"

#include <dirent.h>
#include <limits.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>
#include <unistd.h>

static const char ending[] = ".json";

typedef struct arguments {
    word_list names;
    const char *from, *out, *page;
    bool quick;
} arguments;

static void defaults(void* given)
{
    ((arguments*)given)->from = ax_examples_folder();
}

static const command_option options[] = {
    {.name = "NAME...",
     .text = "examples to make",
     .kind = OPTION_WORDS,
     .operand = true,
     .fallback = "all of them",
     .offset = offsetof(arguments, names)},
    {.name = "-o",
     .value = "DIR",
     .text =
         "write a folder for each example: its recipe, document, design JSON, pictures and what it takes to make it",
     .kind = OPTION_TEXT,
     .offset = offsetof(arguments, out)},
    {.name = "--quick",
     .text = "only the examples that their bounds mark as quick",
     .kind = OPTION_FLAG,
     .offset = offsetof(arguments, quick)},
    {.name = "--page",
     .value = "FILE.md",
     .text = "write a page of all of them, with its pictures in the folder pictures/gallery beside it",
     .kind = OPTION_TEXT,
     .offset = offsetof(arguments, page)},
    {.name = "--from",
     .value = "DIR",
     .text = "where the recipes are, with their bounds in gallery/bounds.json",
     .kind = OPTION_TEXT,
     .fallback = "the examples of the project",
     .offset = offsetof(arguments, from)},
};

typedef struct gallery {
    const arguments* a;
    bounds bounds;
    char scratch[PATH_MAX]; // folder of the documents when none is asked for
    int made, broken;
    gallery_page* page;
} gallery;

static int is_recipe(const struct dirent* entry)
{
    size_t length = strlen(entry->d_name);
    return length >= sizeof ending && strcmp(entry->d_name + length - strlen(ending), ending) == 0;
}

static int by_name(const void* a, const void* b)
{
    return strcmp(*(char* const*)a, *(char* const*)b);
}

// Names of the recipes in the folder, sorted without their endings; `count` < 0 if it cannot be read. Freed by free_names.
static char** list_names(const char* folder, int* count)
{
    struct dirent** entries;
    *count = scandir(folder, &entries, is_recipe, NULL);
    char** names = AX_NEW0(char*, *count > 0 ? *count : 1);
    for (int k = 0; k < *count; ++k) {
        size_t length = strlen(entries[k]->d_name) - strlen(ending);
        names[k] = ax_calloc(length + 1, 1);
        memcpy(names[k], entries[k]->d_name, length);
        free(entries[k]);
    }
    if (*count >= 0)
        free(entries);
    if (*count > 1)
        qsort(names, (size_t)*count, sizeof *names, by_name);
    return names;
}

static void free_names(char** names, int count)
{
    for (int k = 0; k < count; ++k)
        ax_free(names[k]);
    ax_free(names);
}

static bool is_asked(const gallery* g, const char* name)
{
    if (g->a->quick && !json_is_true(json_object_get(bounds_of(&g->bounds, name), "quick")))
        return false;
    for (int k = 0; k < g->a->names.count; ++k)
        if (strcmp(g->a->names.words[k], name) == 0)
            return true;
    return g->a->names.count == 0;
}

static ax_status check_names(const arguments* a, int count, char** names, ax_error* error)
{
    for (int k = 0; k < a->names.count; ++k) {
        bool found = false;
        for (int i = 0; i < count && !found; ++i)
            found = strcmp(a->names.words[k], names[i]) == 0;
        const char* nearest = ax_nearest_word(a->names.words[k], count, (const char* const*)names);
        if (!found && nearest)
            return ax_fail(error, AX_USAGE, "There is no example \"%s\". Did you mean \"%s\"?", a->names.words[k],
                           nearest);
        if (!found)
            return ax_fail(error, AX_USAGE, "There is no example \"%s\" in %s.", a->names.words[k], a->from);
    }
    return AX_OK;
}

static double now(void)
{
    struct timespec t;
    clock_gettime(CLOCK_MONOTONIC, &t);
    return (double)t.tv_sec + 1e-9 * (double)t.tv_nsec;
}

static ax_status path_of(const char* folder, const char* name, const char* ends, char path[PATH_MAX], ax_error* error)
{
    char file[NAME_MAX + 1];
    if ((size_t)snprintf(file, sizeof file, "%s%s", name, ends) >= sizeof file)
        return ax_fail(error, AX_USAGE, "The name %s is too long.", name);
    return output_join(folder, file, path, PATH_MAX, error);
}

// What an example takes to make, at the sizes and with the joint that its bounds name.
static ax_status write_files(const char* folder, const char* name, const json_t* example, const ax_recipe* recipe,
                             const ax_design* design, ax_error* error)
{
    static const char* const whole[] = {".json", ".glb", ".svg", ".dxf", ".csv", ".plan.pdf", ".frame.pdf"};
    char path[PATH_MAX];
    fabricate_choice chosen;
    fabricate_arguments how;
    const json_t* make = json_object_get(example, "make");
    fabricate_defaults(&how);
    how.joint = json_string_value(json_object_get(make, "joint"));
    how.material = json_string_value(json_object_get(make, "material"));
    how.sheet = json_string_value(json_object_get(make, "sheet"));
    ax_status status = fabricate_choose(&how, NULL, &chosen, error);
    if (status == AX_OK)
        status = path_of(folder, name, ".recipe.json", path, error);
    if (status == AX_OK)
        status = ax_recipe_write(recipe, path, error);
    int count = (int)(sizeof whole / sizeof *whole) - (design->simulated ? 0 : 1); // without supports no frame
    for (int k = 0; k < count && status == AX_OK; ++k) {
        const ax_export_options o = {.title = name, .fabricate = &chosen.options, .progress = progress_reporter()};
        status = path_of(folder, name, whole[k], path, error);
        if (status == AX_OK)
            status = ax_export(design, path, &o, error);
    }
    for (ax_state s = AX_STATE_FLAT; s <= (design->simulated ? AX_STATE_SIMULATED : AX_STATE_DEPLOYED); ++s) {
        char picture[32];
        snprintf(picture, sizeof picture, "%s.png", ax_state_name(s));
        if (status == AX_OK)
            status = output_join(folder, picture, path, sizeof path, error);
        if (status == AX_OK)
            status = ax_picture_design(design, s, 1600, 1200, path, error);
    }
    return status;
}

static void print_head(void)
{
    printf("%-15s %6s  %-9s  %-13s %6s %8s  %-15s %9s %10s %6s\n", "example", "panels", "load", "scale factors",
           "mouth", "overlaps", "rms, max / L", "residual", "congruence", "time");
}

static void print_row(const char* name, const ax_design* d, double seconds, const json_t* broken)
{
    const ax_report* r = &d->report;
    char distance[32] = "-", residual[16] = "-";
    if (d->simulated) {
        snprintf(distance, sizeof distance, "%.4f, %.4f", r->simulated_rms_over_L, r->simulated_max_over_L);
        snprintf(residual, sizeof residual, "%.1e", r->force_residual);
    }
    printf("%-15s %6d  %-9s  %.3f - %.3f %6.1f %8d  %-15s %9s %10.1e %4.1f s\n", name, d->linkage.triangle_count,
           ax_load_kind_name(d->load.kind), r->scale_min, r->scale_max, r->mouth_min_deg, r->overlap_pairs, distance,
           residual, r->congruence_max, seconds);
    for (size_t k = 0; k < json_array_size(broken); ++k)
        printf("    OUT OF BOUNDS: %s\n", json_string_value(json_array_get(broken, k)));
    fflush(stdout);
}

static ax_status judge(gallery* g, const char* name, const char* folder, const ax_recipe* recipe, ax_session* session,
                       double seconds, ax_error* error)
{
    const json_t* example = bounds_of(&g->bounds, name);
    const ax_design* design;
    ax_status status = ax_session_design(session, progress_reporter(), &design, error);
    progress_end();
    if (status != AX_OK)
        return status;
    if (!design)
        return ax_fail(error, AX_CANNOT_REALISE, "%s does not end finished, so there is nothing exact to judge.", name);
    ax_form_report form;
    ax_form_measure(ax_session_form(session), &form);
    json_t* broken = bounds_check(&g->bounds, example, design, &form);
    print_row(name, design, seconds, broken);
    g->broken += json_array_size(broken) > 0;
    ++g->made;
    if (g->a->out)
        status = write_files(folder, name, example, recipe, design, error);
    if (status == AX_OK && g->page)
        status = gallery_page_add(g->page, name, recipe, example, design, &form, seconds, error);
    progress_end();
    json_decref(broken);
    ax_form_report_free(&form);
    return status;
}

static ax_status make(gallery* g, const char* name, ax_error* error)
{
    char path[PATH_MAX], folder[PATH_MAX], document[PATH_MAX];
    if (!bounds_of(&g->bounds, name))
        return ax_fail(error, AX_BAD_INPUT, "%s/gallery/bounds.json says nothing of %s. Add what its figures keep.",
                       g->a->from, name);
    ax_recipe* recipe = NULL;
    ax_session* session = NULL;
    snprintf(folder, sizeof folder, "%s", g->scratch);
    ax_status status = path_of(g->a->from, name, ending, path, error);
    if (status == AX_OK && g->a->out) {
        status = output_join(g->a->out, name, folder, sizeof folder, error);
        if (status == AX_OK)
            status = output_make_folder(folder, error);
    }
    if (status == AX_OK)
        status = path_of(folder, name, ".auxshell", document, error);
    if (status == AX_OK)
        status = ax_recipe_read(path, &recipe, error);
    double start = now();
    if (status == AX_OK) {
        const ax_session_start how = {
            .recipe = recipe, .until = -1, .folder = g->a->from, .program = "auxshell gallery"};
        status = ax_session_create(document, &how, progress_reporter(), &session, error);
        progress_end();
    }
    if (status == AX_OK)
        status = judge(g, name, folder, recipe, session, now() - start, error);
    ax_session_close(session);
    ax_recipe_free(recipe);
    if (!g->a->out)
        unlink(document);
    return status;
}

static ax_status make_all(gallery* g, int count, char** names, ax_error* error)
{
    ax_status status = AX_OK;
    print_head();
    for (int k = 0; k < count && status == AX_OK; ++k) {
        if (!is_asked(g, names[k]))
            continue;
        ax_error why = {0};
        ax_status one = make(g, names[k], &why);
        if (one ==
            AX_CANNOT_REALISE) { // an example that cannot be made is out of bounds; the others are shown all the same
            printf("%-15s OUT OF BOUNDS: %s\n", names[k], why.message);
            ++g->broken, ++g->made;
        } else if (one != AX_OK)
            status = ax_fail(error, one, "%s: %s", names[k], why.message);
    }
    return status;
}

static ax_status run(const void* given, ax_error* error)
{
    const arguments* a = given;
    gallery g = {.a = a, .scratch = "/tmp/auxshell-gallery-XXXXXX"};
    char path[PATH_MAX];
    int count;
    char** names = list_names(a->from, &count);
    ax_status status = count < 0 ? ax_fail(error, AX_BAD_INPUT, "The folder %s cannot be read.", a->from)
                                 : check_names(a, count, names, error);
    if (status == AX_OK)
        status = output_join(a->from, "gallery/bounds.json", path, sizeof path, error);
    if (status == AX_OK)
        status = bounds_read(path, &g.bounds, error);
    if (status == AX_OK && a->out)
        status = output_make_folder(a->out, error);
    if (status == AX_OK && a->page)
        status = gallery_page_open(a->page, &g.page, error);
    if (status == AX_OK && !mkdtemp(g.scratch))
        status = ax_fail(error, AX_FAILED, "No temporary folder could be made in /tmp.");
    if (status == AX_OK) {
        status = make_all(&g, count, names, error);
        rmdir(g.scratch);
    }
    if (status == AX_OK && g.page && g.broken == 0)
        status = gallery_page_write(g.page, error);
    if (status == AX_OK && g.broken)
        status = ax_fail(error, AX_FAILED, "%d of %d examples left their bounds.", g.broken, g.made);
    else if (status == AX_OK)
        printf("%d examples keep their bounds.\n", g.made);
    gallery_page_close(g.page);
    bounds_free(&g.bounds);
    free_names(names, count);
    return status;
}

const command command_gallery = {
    .name = "gallery",
    .summary = "make every example again and check its figures",
    .text =
        "Makes the examples again, each from its recipe, prints their figures, and fails if one of them leaves the "
        "bounds that are kept beside the recipes in gallery/bounds.json. Distances are those of the simulated state "
        "from the designed one, over the mean edge L; a load that is adopted makes what it finds the design, so that "
        "both are one.",
    .options = options,
    .option_count = sizeof options / sizeof *options,
    .size = sizeof(arguments),
    .defaults = defaults,
    .run = run,
};
