#include "fabricate/way.h"

#include "base/vec.h"
#include "solver/solver.h"

#include <string.h>

// A thousandth to ten times this finds the same ways within a tenth of an edge; here iterations are fewest.
static const double weight = 0.1;
static const double residual = 1e-5; // of edges: hinges are then off by a ten thousandth of one at most
enum { ITERATIONS = 1000, WINDOW = 5 };

struct ax_way {
    const ax_design* design;
    ax_solver* solver;
    int middles;                 // group
    double (*from)[3], (*to)[3]; // middles of the panels, flat (moved to where they deploy) and open
    double (*target)[3];
    double (*places)[3], (*move)[3]; // of hinges
    int* panels;                     // that hold each hinge
    double at;
};

// The motion of the plane into space that brings the flat state nearest to the open one: x = centre + u p0 + v p1 (the polar factor
// of the 3 x 2 correlation).
static void align(const ax_design* d, const double (*open)[3], double (*out)[3])
{
    int n = d->linkage.hinge_count;
    double flat[2] = {0}, centre[3] = {0}, m[2][3] = {{0}}, u[2][3];
    for (int h = 0; h < n; ++h)
        for (int c = 0; c < 3; ++c) {
            centre[c] += open[h][c] / n;
            if (c < 2)
                flat[c] += d->flat[h][c] / n;
        }
    for (int h = 0; h < n; ++h)
        for (int k = 0; k < 2; ++k)
            for (int c = 0; c < 3; ++c)
                m[k][c] += (d->flat[h][k] - flat[k]) * (open[h][c] - centre[c]);
    // (M'M)^(-1/2) of a 2 x 2 matrix: with root = sqrt(det), trace' = sqrt(trace + 2 root) its root is (M'M + root I) / trace'
    double a = ax_dot3(m[0], m[0]), b = ax_dot3(m[0], m[1]), c = ax_dot3(m[1], m[1]);
    double root = sqrt(fmax(0, a * c - b * b)), trace = sqrt(a + c + 2 * root);
    double p = (a + root) / trace, q = b / trace, r = (c + root) / trace, det = p * r - q * q;
    for (int k = 0; k < 3; ++k) {
        u[0][k] = (r * m[0][k] - q * m[1][k]) / det;
        u[1][k] = (p * m[1][k] - q * m[0][k]) / det;
    }
    for (int h = 0; h < n; ++h)
        for (int k = 0; k < 3; ++k)
            out[h][k] = centre[k] + (d->flat[h][0] - flat[0]) * u[0][k] + (d->flat[h][1] - flat[1]) * u[1][k];
}

static void find_middles(const ax_linkage* linkage, const double (*places)[3], double (*middle)[3])
{
    for (int t = 0; t < linkage->triangle_count; ++t)
        for (int c = 0; c < 3; ++c)
            middle[t][c] = (places[linkage->triangles[t][0]][c] + places[linkage->triangles[t][1]][c] +
                            places[linkage->triangles[t][2]][c]) /
                           3;
}

ax_way* ax_way_make(const ax_design* design, ax_pool* pool)
{
    const ax_linkage* l = &design->linkage;
    size_t panels = (size_t)l->triangle_count, hinges = (size_t)l->hinge_count;
    const double(*open)[3] = (const double(*)[3])(design->simulated ? design->simulated : design->deployed);
    ax_way* w = AX_NEW0(ax_way, 1);
    w->design = design;
    w->from = ax_alloc(panels, sizeof *w->from), w->to = ax_alloc(panels, sizeof *w->to);
    w->target = ax_alloc(panels, sizeof *w->target), w->move = ax_alloc(hinges, sizeof *w->move);
    w->places = ax_alloc(hinges, sizeof *w->places);
    w->panels = AX_NEW0(int, hinges);
    for (int t = 0; t < l->triangle_count; ++t)
        for (int k = 0; k < 3; ++k)
            ++w->panels[l->triangles[t][k]];
    align(design, open, w->places);
    find_middles(l, (const double(*)[3])w->places, w->from);
    find_middles(l, open, w->to);
    w->solver = ax_solver_make(l->hinge_count, (const double(*)[3])w->places, pool);
    ax_solver_add(w->solver, ax_constraint_find("rigid_triangle"), 3, l->triangle_count, (const int*)l->triangles, 1,
                  NULL);
    w->middles = ax_solver_add(w->solver, ax_constraint_find("centroid"), 3, l->triangle_count,
                               (const int*)l->triangles, weight, NULL);
    ax_solver_set_soft(w->solver, w->middles, true);
    ax_solver_use_multipliers(w->solver, true);
    ax_solver_accelerate(w->solver, WINDOW);
    return w;
}

void ax_way_free(ax_way* w)
{
    if (!w)
        return;
    ax_solver_free(w->solver);
    ax_free(w->from);
    ax_free(w->to);
    ax_free(w->target);
    ax_free(w->move);
    ax_free(w->places);
    ax_free(w->panels);
    ax_free(w);
}

static double edge_error(const ax_way* w)
{
    const ax_linkage* l = &w->design->linkage;
    double most = 0;
    for (int t = 0; t < l->triangle_count; ++t)
        for (int k = 0; k < 3; ++k) {
            int i = l->triangles[t][k], j = l->triangles[t][(k + 1) % 3];
            double rest = ax_distance2(w->design->flat[i], w->design->flat[j]);
            most = fmax(most, fabs(ax_distance3(w->places[i], w->places[j]) / rest - 1));
        }
    return most;
}

bool ax_way_at(ax_way* w, double t, const ax_progress* progress, double (*places)[3], double* error)
{
    const ax_linkage* l = &w->design->linkage;
    ax_settle settle = AX_SETTLE_STANDARD;
    settle.force = 1e-3, settle.primal = residual, settle.iterations = ITERATIONS;
    memset(w->move, 0, (size_t)l->hinge_count * sizeof *w->move);
    for (int k = 0; k < l->triangle_count; ++k)
        for (int c = 0; c < 3; ++c) {
            w->target[k][c] = (1 - t) * w->from[k][c] + t * w->to[k][c];
            for (int i = 0; i < 3; ++i)
                w->move[l->triangles[k][i]][c] += (t - w->at) * (w->to[k][c] - w->from[k][c]);
        }
    for (int h = 0; h < l->hinge_count; ++h)
        for (int c = 0; c < 3; ++c)
            w->places[h][c] += w->panels[h] ? w->move[h][c] / w->panels[h] : 0;
    w->at = t;
    ax_solver_set_places(w->solver, (const double(*)[3])w->places);
    ax_solver_set_all(w->solver, w->middles, 0, 3, (const double*)w->target);
    ax_settled end = ax_solver_settle(w->solver, &settle, progress);
    ax_solver_get_places(w->solver, w->places);
    memcpy(places, w->places, (size_t)l->hinge_count * sizeof *places);
    *error = edge_error(w);
    return end.end != AX_SETTLE_CANCELLED;
}
