// auxshell diff: what two documents do differently, and what comes of it.
#include "options.h"
#include "progress.h"
#include "report.h"

#include "ax/document.h"
#include "ax/form.h"
#include "ax/session.h"

#include <math.h>
#include <string.h>

typedef struct arguments {
    const char* documents[2];
} arguments;

static const command_option options[] = {
    {.name = "A.auxshell",
     .text = "a document",
     .kind = OPTION_TEXT,
     .operand = true,
     .required = true,
     .offset = offsetof(arguments, documents[0])},
    {.name = "B.auxshell",
     .text = "another, or an earlier copy of it",
     .kind = OPTION_TEXT,
     .operand = true,
     .required = true,
     .offset = offsetof(arguments, documents[1])},
};

// The steps that are applied.
typedef struct side {
    const ax_recipe* recipe;
    int count;
} side;

static bool same_step(const side* a, int i, const side* b, int j)
{
    return strcmp(ax_recipe_operator(a->recipe, i), ax_recipe_operator(b->recipe, j)) == 0;
}

static void print_step(char mark, const side* s, int k)
{
    char words[160];
    ax_recipe_words(s->recipe, k, words);
    printf("%c %3d  %s\n", mark, k + 1, words);
}

// Between what both begin and end with: a longest common subsequence, length[i][j] being that of the steps from i and j on. Beyond
// `most` entries all of it counts as different.
static void print_middle(const side* a, const side* b, int first, int end_a, int end_b)
{
    const size_t most = 25000000;
    size_t rows = (size_t)(end_a - first) + 1, columns = (size_t)(end_b - first) + 1;
    int* length = rows * columns <= most ? AX_NEW0(int, rows* columns) : NULL;
    for (size_t i = rows - 1; length && i-- > 0;)
        for (size_t j = columns - 1; j-- > 0;) {
            int down = length[(i + 1) * columns + j], right = length[i * columns + j + 1];
            length[i * columns + j] = same_step(a, first + (int)i, b, first + (int)j)
                                          ? length[(i + 1) * columns + j + 1] + 1
                                      : down > right ? down
                                                     : right;
        }
    int i = first, j = first;
    while (i < end_a || j < end_b) {
        size_t at = (size_t)(i - first) * columns + (size_t)(j - first);
        if (length && i < end_a && j < end_b && same_step(a, i, b, j)) {
            print_step(' ', a, i);
            ++i, ++j;
        } else if (i < end_a && (j == end_b || !length || length[at + columns] >= length[at + 1]))
            print_step('-', a, i++);
        else
            print_step('+', b, j++);
    }
    ax_free(length);
}

static void print_recipes(const side* a, const side* b)
{
    int first = 0, end_a = a->count, end_b = b->count;
    while (first < end_a && first < end_b && same_step(a, first, b, first))
        ++first;
    while (end_a > first && end_b > first && same_step(a, end_a - 1, b, end_b - 1))
        --end_a, --end_b;
    if (first == end_a && first == end_b) {
        printf("The recipes are the same: %d step%s.\n", first, first == 1 ? "" : "s");
        return;
    }
    printf("Recipe\n");
    if (first)
        printf("       %d step%s the same\n", first, first == 1 ? "" : "s");
    print_middle(a, b, first, end_a, end_b);
    if (end_a < a->count)
        printf("       %d step%s the same\n", a->count - end_a, a->count - end_a == 1 ? "" : "s");
}

static void print_figure(const ax_figure* figure, double x, double y)
{
    char words[2][32] = {"-", "-"}; // where there is no such state
    if (!isnan(x))
        snprintf(words[0], sizeof words[0], "%.6g", x);
    if (!isnan(y))
        snprintf(words[1], sizeof words[1], "%.6g", y);
    printf("  %-44s %14s %14s\n", figure->label, words[0], words[1]);
}

static void print_figures(const ax_design* a, const ax_design* b)
{
    int count, different = 0;
    const ax_figure* figures = ax_report_figures(&count);
    for (int f = 0; f < count; ++f)
        for (int k = 0; k < figures[f].count && figures[f].group != AX_GROUP_EFFORT; ++k) {
            double x = ax_figure_value(&figures[f], &a->report, k), y = ax_figure_value(&figures[f], &b->report, k);
            if (x == y || (isnan(x) && isnan(y)))
                continue;
            if (!different++)
                printf("Figures\n");
            print_figure(&figures[f], x, y);
        }
    if (!different)
        printf("All figures are the same.\n");
}

// How far apart the shapes are, which may have other panels.
static void print_shapes(ax_form* a, ax_form* b)
{
    static const char* const states[] = {"deployed", "under load"};
    ax_form_view views[2] = {ax_form_look(a), ax_form_look(b)};
    bool same = true;
    if (views[0].unit != views[1].unit) {
        printf("Shapes are not compared: lengths are in %s here and in %s there.\n", ax_unit_name(views[0].unit),
               ax_unit_name(views[1].unit));
        return;
    }
    for (int loaded = 0; loaded < 2; ++loaded) {
        if (loaded && !(views[0].simulated && views[1].simulated))
            continue;
        ax_form_apart apart;
        ax_form_measure_apart(a, b, loaded, AX_FORM_APART_MARGIN, &apart);
        if (apart.surfaces_max == 0 && !(apart.points_max > 0))
            continue;
        if (same)
            printf("Shapes, %% of their size of %.4g %s, off the rim\n", apart.size, ax_unit_name(views[0].unit));
        same = false;
        printf("  %-11s surfaces are %.2f apart at most, %.2f rms", states[loaded], 100 * apart.surfaces_max,
               100 * apart.surfaces_rms);
        if (apart.hinge >= 0)
            printf("; points of the sheet %.2f, %.2f rms", 100 * apart.points_max, 100 * apart.points_rms);
        printf("\n");
    }
    if (same)
        printf("The shapes are the same.\n");
}

static ax_status compare(const arguments* a, ax_session* const sessions[2], ax_error* error)
{
    side sides[2];
    ax_design designs[2] = {0};
    ax_status status = AX_OK;
    for (int k = 0; k < 2; ++k)
        sides[k] = (side){ax_session_recipe(sessions[k]), ax_session_at(sessions[k])};
    for (int k = 0; k < 2 && status == AX_OK; ++k)
        status = ax_document_load(a->documents[k], &designs[k], error);
    if (status == AX_OK) {
        print_recipes(&sides[0], &sides[1]);
        if (designs[0].linkage.triangle_count != designs[1].linkage.triangle_count)
            printf("%d triangles, %d triangles\n", designs[0].linkage.triangle_count,
                   designs[1].linkage.triangle_count);
        print_figures(&designs[0], &designs[1]);
        print_shapes(ax_session_form(sessions[0]), ax_session_form(sessions[1]));
    }
    for (int k = 0; k < 2; ++k)
        ax_design_free(&designs[k]);
    return status;
}

static ax_status run(const void* given, ax_error* error)
{
    const arguments* a = given;
    ax_session* sessions[2] = {0};
    ax_status status = AX_OK;
    for (int k = 0; k < 2 && status == AX_OK; ++k)
        status = ax_session_open(a->documents[k], false, NULL, progress_reporter(), &sessions[k], error);
    progress_end();
    if (status == AX_OK)
        status = compare(a, sessions, error);
    for (int k = 0; k < 2; ++k)
        ax_session_close(sessions[k]);
    return status;
}

const command command_diff = {
    .name = "diff",
    .summary = "compare the recipes, figures and shapes of two documents",
    .text =
        "Lists the steps that only the first document has (-) and those that only the second one has (+), then every "
        "figure in which they differ, and how far apart the shapes are, which may have other panels: from either "
        "surface to the other, and for the same points of the sheet where both have one outline. Only steps that are "
        "applied count.",
    .options = options,
    .option_count = sizeof options / sizeof *options,
    .size = sizeof(arguments),
    .run = run,
};
