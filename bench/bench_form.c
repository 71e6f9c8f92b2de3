// Form-finding while the hand moves: what a visual update takes, and what settling after a stroke takes and leaves.
//
//   bench_form [--json FILE] [TRIANGLES ...]        default 2000 10000
//
// An update is ten iterations of both states, the median of fifty after a stroke; settling is from such strokes, the median of five and the
// worst, and what it leaves is the largest distance, in mean edges and of either state, from where the form is after it has been
// settled forty times more (2,000 panels). A sheet turns in a rim that is nearly round, by next to no force: how far is left out.
#include "analysis/measure.h"
#include "ax/recipe.h"
#include "base/clock.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { UPDATES = 50, ITERATIONS = 10, SETTLED = 40, PANELS_SETTLED = 2000, MOST_SIZES = 8 };

static const struct {
    const char *name, *rest;
} cases[] = {
    {"dome on a circle, gravity",
     "{\"op\": \"paint\", \"points\": [[0, 0]], \"radius\": 0.95, \"value\": 1.6}, {\"op\": \"rim_circle\", "
     "\"radius\": 1.05}, "
     "{\"op\": \"gravity\"}"},
    {"two domes on an ellipse, inflation",
     "{\"op\": \"paint\", \"points\": [[-0.35, 0], [0.35, 0.1]], \"radius\": 0.6, \"value\": 1.7}, {\"op\": "
     "\"smooth\", \"amount\": 0.15}, "
     "{\"op\": \"rim_ellipse\", \"a\": [1.15, 0, 0], \"b\": [0, 1.05, 0]}, {\"op\": \"inflation\"}"},
    {"constant curvature on a circle, inflation",
     "{\"op\": \"paint_curvature\", \"points\": [[0, 0]], \"radius\": 0.8, \"curvature\": 0.5}, {\"op\": "
     "\"rim_circle\", \"radius\": 1.3}, "
     "{\"op\": \"inflation\"}"},
};

static const char* const strokes[] = {
    "{\"op\": \"paint\", \"points\": [[0.3, 0.2]], \"radius\": 0.3, \"value\": 1.7}",
    "{\"op\": \"paint\", \"points\": [[-0.3, 0.1]], \"radius\": 0.3, \"value\": 1.7}",
    "{\"op\": \"paint\", \"points\": [[0.1, -0.4]], \"radius\": 0.25, \"value\": 1.4}",
    "{\"op\": \"paint\", \"points\": [[0.4, 0.4]], \"radius\": 0.35, \"value\": 1.5}",
    "{\"op\": \"paint\", \"points\": [[0, 0]], \"radius\": 0.2, \"value\": 1.8}",
};
enum { STROKES = sizeof strokes / sizeof *strokes };

static ax_form* begin(const char* rest, int triangles)
{
    char text[1600];
    ax_recipe* recipe;
    ax_form* form = NULL;
    ax_error error = {0};
    int done;
    snprintf(
        text, sizeof text,
        "{\"format\": \"auxshell-recipe\", \"version\": 1, \"operators\": [{\"op\": \"start_circle\", \"radius\": 1, "
        "\"triangles\": %d, \"scale\": 1.25}, %s]}",
        triangles, rest);
    ax_status status = ax_recipe_parse(text, &recipe, &error);
    if (status == AX_OK) {
        status = ax_recipe_play(recipe, -1, ".", NULL, NULL, NULL, &form, &done, &error);
        ax_recipe_free(recipe);
    }
    if (status != AX_OK) {
        fprintf(stderr, "%s\n", error.message);
        exit((int)status);
    }
    return form;
}

static void stroke(ax_form** form, const char* operator)
{
    ax_error error = {0};
    ax_status status = ax_operator_preview(operator, ".", form, &error);
    if (status != AX_OK) {
        fprintf(stderr, "%s\n", error.message);
        exit((int)status);
    }
}

static int ascending(const void* a, const void* b)
{
    double x = *(const double*)a, y = *(const double*)b;
    return (x > y) - (x < y);
}

// In mean edges.
static double from_rest(ax_form* form)
{
    ax_form_view view = ax_form_look(form);
    int n = view.linkage->hinge_count;
    double(*deployed)[3] = ax_copy(view.deployed, (size_t)n, sizeof *deployed),
    (*simulated)[3] = ax_copy(view.simulated, (size_t)n, sizeof *simulated), edge = 0;
    for (int t = 0; t < view.linkage->triangle_count; ++t)
        edge += view.prescribed[t] * view.spacing / 2 / view.linkage->triangle_count;
    for (long k = 0; k * view.linkage->triangle_count < (long)SETTLED * PANELS_SETTLED; ++k)
        ax_form_settle(form, 0, NULL, NULL);
    view = ax_form_look(form);
    double most = fmax(ax_measure_move(n, (const double(*)[3])deployed, view.deployed),
                       ax_measure_move(n, (const double(*)[3])simulated, view.simulated));
    ax_free(deployed);
    ax_free(simulated);
    return most / edge;
}

int main(int argc, char** argv)
{
    const char *json = "/dev/null", *separator = "";
    if (argc > 2 && strcmp(argv[1], "--json") == 0)
        json = argv[2], argc -= 2, argv += 2;
    FILE* file = fopen(json, "w");
    if (!file) {
        perror(json);
        return 1;
    }
    int sizes[MOST_SIZES] = {2000, 10000}, count = 2;
    for (int k = 1; k < argc && k <= MOST_SIZES; ++k)
        sizes[k - 1] = atoi(argv[k]), count = k;
    printf("%-44s panels  update ms  settled, s      worst  from rest, L\n", "");
    fprintf(file, "[");
    for (int s = 0; s < count; ++s)
        for (size_t c = 0; c < sizeof cases / sizeof *cases; ++c) {
            double settled[STROKES], left = 0, update[UPDATES], start;
            ax_form* form;
            for (int k = 0; k < STROKES; ++k) {
                form = begin(cases[c].rest, sizes[s]);
                stroke(&form, strokes[k]);
                start = ax_seconds();
                ax_form_settle(form, 0, NULL, NULL);
                settled[k] = ax_seconds() - start;
                left = fmax(left, from_rest(form));
                ax_form_free(form);
            }
            qsort(settled, STROKES, sizeof *settled, ascending);
            form = begin(cases[c].rest, sizes[s]);
            stroke(&form, strokes[0]);
            ax_form_iterate(form, ITERATIONS); // what a first one prepares
            for (int k = 0; k < UPDATES; ++k) {
                start = ax_seconds();
                ax_form_iterate(form, ITERATIONS);
                update[k] = ax_seconds() - start;
            }
            qsort(update, UPDATES, sizeof *update, ascending);
            int triangles = ax_form_look(form).linkage->triangle_count;
            ax_form_free(form);
            printf("%-44s %6d %10.2f %11.3f %10.3f %13.3f\n", cases[c].name, triangles, 1e3 * update[UPDATES / 2],
                   settled[STROKES / 2], settled[STROKES - 1], left);
            fflush(stdout);
            fprintf(file,
                    "%s\n  {\"case\": \"%s\", \"triangles\": %d, \"update_ms\": %.6g, \"settled_s\": %.6g, "
                    "\"settled_worst_s\": %.6g, \"from_rest_edges\": %.6g}",
                    separator, cases[c].name, triangles, 1e3 * update[UPDATES / 2], settled[STROKES / 2],
                    settled[STROKES - 1], left);
            separator = ",";
        }
    fprintf(file, "\n]\n");
    if (fclose(file)) {
        perror(json);
        return 1;
    }
    return 0;
}
