// Form-finding while the hand moves: what a visual update takes, and what settling after a stroke takes and leaves.
//
//   bench_form [--json FILE] [TRIANGLES ...]        default 2000 10000
//
// An update is ten iterations of both states, the median of fifty after a stroke; settling is from that stroke, and what it leaves is the
// largest distance, in mean edges and of either state, from where the form is after it has been settled a hundred times more (2,000 panels). A sheet
// turns in a rim that is nearly round, by next to no force: how far it has turned is left out.
#include "ax/recipe.h"
#include "base/clock.h"
#include "base/vec.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { UPDATES = 50, ITERATIONS = 10, SETTLED = 100, PANELS_SETTLED = 2000, MOST_SIZES = 8 };

static const struct {
    const char *name, *rest, *stroke;
} cases[] = {
    {"dome on a circle, gravity",
     "{\"op\": \"paint\", \"points\": [[0, 0]], \"radius\": 0.95, \"value\": 1.6}, {\"op\": \"rim_circle\", "
     "\"radius\": 1.05}, "
     "{\"op\": \"gravity\"}",
     "{\"op\": \"paint\", \"points\": [[0.3, 0.2]], \"radius\": 0.3, \"value\": 1.7}"},
    {"two domes on an ellipse, inflation",
     "{\"op\": \"paint\", \"points\": [[-0.35, 0], [0.35, 0.1]], \"radius\": 0.6, \"value\": 1.7}, {\"op\": "
     "\"smooth\", \"amount\": 0.15}, "
     "{\"op\": \"rim_ellipse\", \"a\": [1.15, 0, 0], \"b\": [0, 1.05, 0]}, {\"op\": \"inflation\"}",
     "{\"op\": \"paint\", \"points\": [[-0.4, 0]], \"radius\": 0.3, \"value\": 1.5}"},
    {"constant curvature on a circle, inflation",
     "{\"op\": \"paint_curvature\", \"points\": [[0, 0]], \"radius\": 0.8, \"curvature\": 0.5}, {\"op\": "
     "\"rim_circle\", \"radius\": 1.3}, "
     "{\"op\": \"inflation\"}",
     "{\"op\": \"paint\", \"points\": [[0, 0.3]], \"radius\": 0.3, \"value\": 1.6}"},
};

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

// Largest distance of two states apart from a turn about the vertical through their middle.
static double apart(int n, const double (*a)[3], const double (*b)[3])
{
    double middle[2] = {0, 0}, along = 0, across = 0, most = 0;
    for (int h = 0; h < n; ++h)
        middle[0] += a[h][0] / n, middle[1] += a[h][1] / n;
    for (int h = 0; h < n; ++h) {
        double u[2] = {a[h][0] - middle[0], a[h][1] - middle[1]}, v[2] = {b[h][0] - middle[0], b[h][1] - middle[1]};
        along += u[0] * v[0] + u[1] * v[1], across += u[0] * v[1] - u[1] * v[0];
    }
    double cosine = along / hypot(along, across), sine = across / hypot(along, across);
    for (int h = 0; h < n; ++h) {
        double u[2] = {a[h][0] - middle[0], a[h][1] - middle[1]};
        const double turned[3] = {middle[0] + cosine * u[0] - sine * u[1], middle[1] + sine * u[0] + cosine * u[1],
                                  a[h][2]};
        most = fmax(most, ax_distance3(turned, b[h]));
    }
    return most;
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
    double most = fmax(apart(n, (const double(*)[3])deployed, view.deployed),
                       apart(n, (const double(*)[3])simulated, view.simulated));
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
    printf("%-44s panels  update ms  settled s  from rest, L\n", "");
    fprintf(file, "[");
    for (int s = 0; s < count; ++s)
        for (size_t c = 0; c < sizeof cases / sizeof *cases; ++c) {
            ax_form* form = begin(cases[c].rest, sizes[s]);
            stroke(&form, cases[c].stroke);
            double start = ax_seconds();
            ax_form_settle(form, 0, NULL, NULL);
            double settled = ax_seconds() - start, left = from_rest(form), update[UPDATES];
            ax_form_free(form);
            form = begin(cases[c].rest, sizes[s]);
            stroke(&form, cases[c].stroke);
            ax_form_iterate(form, ITERATIONS); // what a first one prepares
            for (int k = 0; k < UPDATES; ++k) {
                start = ax_seconds();
                ax_form_iterate(form, ITERATIONS);
                update[k] = ax_seconds() - start;
            }
            qsort(update, UPDATES, sizeof *update, ascending);
            int triangles = ax_form_look(form).linkage->triangle_count;
            ax_form_free(form);
            printf("%-44s %6d %10.2f %10.3f %13.3f\n", cases[c].name, triangles, 1e3 * update[UPDATES / 2], settled,
                   left);
            fflush(stdout);
            fprintf(file,
                    "%s\n  {\"case\": \"%s\", \"triangles\": %d, \"update_ms\": %.6g, \"settled_s\": %.6g, "
                    "\"from_rest_edges\": %.6g}",
                    separator, cases[c].name, triangles, 1e3 * update[UPDATES / 2], settled, left);
            separator = ",";
        }
    fprintf(file, "\n]\n");
    if (fclose(file)) {
        perror(json);
        return 1;
    }
    return 0;
}
