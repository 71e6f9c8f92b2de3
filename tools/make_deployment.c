// Deploys a design as time goes by and draws it: its supports move from the flat sheet to where the frame has them, while the pressure
// or the weight opens the holes. usage: make_deployment RECIPE FOLDER FRAMES WIDTH HEIGHT
#include "ax/picture.h"
#include "ax/session.h"

#include "base/vec.h"
#include "solver/solver.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

enum { STEPS = 6, INNER = 12, REST = 8 }; // time steps a frame, iterations a step, frames at the end for coming to rest

static void require(ax_status status, const ax_error* error)
{
    if (status == AX_OK)
        return;
    fprintf(stderr, "make_deployment: %s\n", error->message);
    exit(1);
}

static ax_solver* make_solver(const ax_design* d, int* supports, int** held, int* held_count)
{
    const ax_linkage* l = &d->linkage;
    int n = l->hinge_count, panels = l->triangle_count, loops = panels + l->hole_count + l->opening_count;
    double(*flat)[3] = ax_calloc((size_t)n, sizeof *flat);
    *held = AX_NEW(int, n);
    *held_count = 0;
    for (int h = 0; h < n; ++h) {
        memcpy(flat[h], d->flat[h], sizeof d->flat[h]);
        if (d->supports[h] && l->on_rim[h])
            (*held)[(*held_count)++] = h;
    }
    ax_solver* s = ax_solver_make(n, (const double(*)[3])flat, NULL);
    int group = ax_solver_add(s, ax_constraint_find("rigid_triangle"), 3, panels, *l->triangles, 1, NULL);
    *supports = ax_solver_add(s, ax_constraint_find("fixed"), 1, *held_count, *held, 1, NULL);
    // panels, holes and openings as loops
    int *start = AX_NEW0(int, loops + 1),
        *points = AX_NEW(int, 3 * panels + l->hole_start[l->hole_count] + l->opening_start[l->opening_count]);
    int count = 0, loop = 0;
    for (int t = 0; t < panels; ++t, start[++loop] = count)
        for (int k = 0; k < 3; ++k)
            points[count++] = l->triangles[t][k];
    for (int k = 0; k < l->hole_count; ++k, start[++loop] = count)
        for (int i = l->hole_start[k]; i < l->hole_start[k + 1]; ++i)
            points[count++] = l->hole_hinges[i];
    for (int k = 0; k < l->opening_count; ++k, start[++loop] = count)
        for (int i = l->opening_start[k]; i < l->opening_start[k + 1]; ++i)
            points[count++] = l->opening_hinges[i];
    ax_solver_add_load(s, ax_load_find("pressure"), loops, start, points);
    ax_solver_scale_loads(s, 0.02 / ax_solver_load_ratio(s, group));
    ax_solver_set_dynamics(s, &(ax_dynamics){.mass = 0.015, .time_step = 1, .damping = 0.8});
    ax_solver_use_multipliers(s, true); // panels keep their size
    ax_free(start);
    ax_free(points);
    ax_free(flat);
    return s;
}

int main(int argc, char** argv)
{
    if (argc != 6) {
        fprintf(stderr, "usage: make_deployment RECIPE FOLDER FRAMES WIDTH HEIGHT\n");
        return 2;
    }
    char document[4096], pattern[4096];
    ax_error error;
    ax_recipe* recipe;
    ax_session* session;
    const ax_design* d;
    snprintf(document, sizeof document, "%s/deployment.auxshell", argv[2]);
    snprintf(pattern, sizeof pattern, "%s/%%03d.png", argv[2]);
    require(ax_recipe_read(argv[1], &recipe, &error), &error);
    const ax_session_start start = {.recipe = recipe, .until = -1};
    require(ax_session_create(document, &start, NULL, &session, &error), &error);
    require(ax_session_design(session, NULL, &d, &error), &error);

    int supports, *held, held_count, n = d->linkage.hinge_count, frames = atoi(argv[3]);
    ax_solver* s = make_solver(d, &supports, &held, &held_count);
    double(**shown)[3] = ax_calloc((size_t)frames, sizeof *shown);
    for (int f = 0; f < frames; ++f) {
        shown[f] = ax_calloc((size_t)n, sizeof **shown);
        ax_solver_get_places(s, shown[f]);
        for (int step = 0; step < STEPS && f < frames - 1; ++step) {
            double t = fmin(1, (f + (step + 1.0) / STEPS) / (frames - 1 - REST)), share = t * t * (3 - 2 * t);
            for (int k = 0; k < held_count; ++k)
                for (int i = 0; i < 3; ++i) {
                    double from = i < 2 ? d->flat[held[k]][i] : 0;
                    ax_solver_set(s, supports, k, i, from + share * (d->simulated[held[k]][i] - from));
                }
            ax_solver_step(s, INNER);
        }
    }
    double far = 0;
    for (int h = 0; h < n; ++h)
        far = fmax(far, ax_distance3(shown[frames - 1][h], d->simulated[h]) / d->report.edge_mean);
    printf("The last frame is %.2f L from the simulated state at most.\n", far);
    require(ax_picture_motion(d, frames, shown, atoi(argv[4]), atoi(argv[5]), pattern, &error), &error);
    for (int f = 0; f < frames; ++f)
        ax_free(shown[f]);
    ax_free(shown);
    ax_free(held);
    ax_solver_free(s);
    ax_session_close(session);
    ax_recipe_free(recipe);
    unlink(document);
    return 0;
}
