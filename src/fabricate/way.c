#include "fabricate/way.h"

#include "base/vec.h"
#include "design/motion.h"
#include "solver/solver.h"

#include <string.h>

// --- rigid panels near given middles

// A thousandth to ten times this finds the same ways within a tenth of an edge; here iterations are fewest. Acceleration takes fewer
// still, but more time.
static const double weight = 0.03;
static const double residual = 1e-5; // of edges: hinges are then off by a few ten thousandths of one at most
enum { ITERATIONS = 1000 };

struct ax_way {
    const ax_design* design;
    double (*flat)[3], (*open)[3]; // hinges, the flat ones moved to where they open
    double (*places)[3];           // of the state at hand
    double at;
    // makes panels rigid
    ax_solver* rigid;
    int middles;              // group
    double (*target)[3];      // of the panels' middles
    ax_design_motion* motion; // NULL: panels go straight
    double (*simulated)[3];   // by it
};

static void find_middles(const ax_linkage* linkage, const double (*places)[3], double (*middle)[3])
{
    for (int t = 0; t < linkage->triangle_count; ++t)
        for (int c = 0; c < 3; ++c)
            middle[t][c] = (places[linkage->triangles[t][0]][c] + places[linkage->triangles[t][1]][c] +
                            places[linkage->triangles[t][2]][c]) /
                           3;
}

static double edge_error(const ax_design* d, const double (*places)[3])
{
    double most = 0;
    for (int t = 0; t < d->linkage.triangle_count; ++t)
        for (int k = 0; k < 3; ++k) {
            int i = d->linkage.triangles[t][k], j = d->linkage.triangles[t][(k + 1) % 3];
            most = fmax(most, fabs(ax_distance3(places[i], places[j]) / ax_distance2(d->flat[i], d->flat[j]) - 1));
        }
    return most;
}

static void make_rigid(ax_way* w, ax_pool* pool)
{
    const ax_linkage* l = &w->design->linkage;
    w->rigid = ax_solver_make(l->hinge_count, (const double(*)[3])w->flat, pool);
    ax_solver_add(w->rigid, ax_constraint_find("rigid_triangle"), 3, l->triangle_count, (const int*)l->triangles, 1,
                  NULL);
    w->middles = ax_solver_add(w->rigid, ax_constraint_find("centroid"), 3, l->triangle_count, (const int*)l->triangles,
                               weight, NULL);
    ax_solver_set_soft(w->rigid, w->middles, true);
    ax_solver_use_multipliers(w->rigid, true);
}

// From `places` to rigid panels with their middles near the targets. False if cancelled.
static bool settle(ax_way* w, const ax_progress* progress)
{
    ax_settle how = AX_SETTLE_STANDARD;
    how.force = 1e-3, how.primal = residual, how.iterations = ITERATIONS;
    ax_solver_set_places(w->rigid, (const double(*)[3])w->places);
    ax_solver_set_all(w->rigid, w->middles, 0, 3, (const double*)w->target);
    ax_settled end = ax_solver_settle(w->rigid, &how, progress);
    ax_solver_get_places(w->rigid, w->places);
    return end.end != AX_SETTLE_CANCELLED;
}

// --- the way

ax_way* ax_way_make(const ax_design* design, ax_pool* pool)
{
    size_t panels = (size_t)design->linkage.triangle_count, hinges = (size_t)design->linkage.hinge_count;
    ax_way* w = AX_NEW0(ax_way, 1);
    w->design = design;
    w->flat = ax_alloc(hinges, sizeof *w->flat);
    w->open = ax_copy(design->simulated ? design->simulated : design->deployed, hinges, sizeof *w->open);
    w->target = ax_alloc(panels, sizeof *w->target);
    ax_design_lay_flat(design, (const double(*)[3])w->open, w->flat);
    w->places = ax_copy(w->flat, hinges, sizeof *w->places);
    make_rigid(w, pool);
    if (design->simulated) {
        w->motion = ax_design_motion_make(design, (const double(*)[3])w->flat, pool);
        w->simulated = ax_alloc(hinges, sizeof *w->simulated);
    }
    return w;
}

void ax_way_free(ax_way* w)
{
    if (!w)
        return;
    ax_solver_free(w->rigid);
    ax_design_motion_free(w->motion);
    ax_free(w->flat);
    ax_free(w->open);
    ax_free(w->places);
    ax_free(w->target);
    ax_free(w->simulated);
    ax_free(w);
}

// Middles on straight lines; the start moves every hinge as the panels that it joins do on average.
static void go_straight(ax_way* w, double t)
{
    const ax_linkage* l = &w->design->linkage;
    for (int h = 0; h < l->hinge_count; ++h)
        for (int c = 0; c < 3; ++c)
            w->places[h][c] += (t - w->at) * (w->open[h][c] - w->flat[h][c]);
    for (int k = 0; k < l->triangle_count; ++k)
        for (int c = 0; c < 3; ++c) {
            w->target[k][c] = 0;
            for (int i = 0; i < 3; ++i) {
                int h = l->triangles[k][i];
                w->target[k][c] += ((1 - t) * w->flat[h][c] + t * w->open[h][c]) / 3;
            }
        }
}

bool ax_way_at(ax_way* w, double t, const ax_progress* progress, ax_way_state* out)
{
    int hinges = w->design->linkage.hinge_count;
    *out = (ax_way_state){.places = (const double(*)[3])w->places};
    if (w->motion) {
        ax_progress_part slot;
        if (!ax_design_motion_to(w->motion, t, ax_progress_within(&slot, progress, 0, 0.7), w->simulated))
            return false;
        memcpy(w->places, w->simulated, (size_t)hinges * sizeof *w->places);
        find_middles(&w->design->linkage, (const double(*)[3])w->places, w->target);
        out->strain = edge_error(w->design, (const double(*)[3])w->places);
        ax_solver_reset_multipliers(w->rigid);
    } else
        go_straight(w, t);
    w->at = t;
    if (!settle(w, progress))
        return false;
    out->error = edge_error(w->design, (const double(*)[3])w->places);
    for (int h = 0; h < hinges && w->motion; ++h)
        out->moved = fmax(out->moved, ax_distance3(w->places[h], w->simulated[h]));
    return true;
}
