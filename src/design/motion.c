#include "design/motion.h"

#include "base/vec.h"
#include "solver/solver.h"

#include <string.h>

// Time steps from flat to rest, and iterations of each. A point of the sheet gathers the way to its place over some ten steps whatever
// the mesh: the load on it falls with the square root of the number of panels, its way over an edge grows with that. With these the
// last state is within 0.05 edges of the exact equilibrium, where that is the only one.
enum { STEPS = 48, INNER = 20 };
static const double arrival = 0.8;            // of the time, when supports are where they shall be
static const double strain = 0.1;             // by the load, of panels without multipliers, see ax_solver_load_ratio
static const double mass = 40, damping = 0.5; // of the whole; velocity kept a step

struct ax_design_motion {
    const ax_design* design;
    ax_solver* solver;
    int supports; // group
    int held_count, *held;
    double (*from)[3], (*to)[3]; // of the supports
    double at;
};

// x = centre + u p0 + v p1, by the polar factor of the 3 x 2 correlation.
void ax_design_lay_flat(const ax_design* d, const double (*open)[3], double (*out)[3])
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

// Panels, and under pressure holes and openings too, as loops.
static void add_load(ax_design_motion* m)
{
    const ax_design* d = m->design;
    const ax_linkage* l = &d->linkage;
    bool inflated = d->load.kind == AX_LOAD_INFLATION;
    int holes = inflated ? l->hole_count : 0, openings = inflated ? l->opening_count : 0, count = 0, loop = 0;
    int* start = AX_NEW0(int, l->triangle_count + holes + openings + 1);
    int* points = AX_NEW(int, 3 * l->triangle_count + l->hole_start[holes] + l->opening_start[openings]);
    for (int t = 0; t < l->triangle_count; ++t, start[++loop] = count)
        for (int k = 0; k < 3; ++k)
            points[count++] = l->triangles[t][k];
    for (int k = 0; k < holes; ++k, start[++loop] = count)
        for (int i = l->hole_start[k]; i < l->hole_start[k + 1]; ++i)
            points[count++] = l->hole_hinges[i];
    for (int k = 0; k < openings; ++k, start[++loop] = count)
        for (int i = l->opening_start[k]; i < l->opening_start[k + 1]; ++i)
            points[count++] = l->opening_hinges[i];
    const ax_load_type* type = ax_load_find(inflated ? "pressure" : "gravity");
    int load = ax_solver_add_load(m->solver, type, loop, start, points);
    for (int k = 0; k < type->parameter_count && !inflated; ++k)
        if (strcmp(type->parameters[k].name, "direction") == 0)
            for (int c = 0; c < 3; ++c)
                ax_solver_set_load_value(m->solver, load, type->parameters[k].offset + c, d->load.direction[c]);
    ax_free(start);
    ax_free(points);
}

ax_design_motion* ax_design_motion_make(const ax_design* d, const double (*flat)[3], ax_pool* pool)
{
    const ax_linkage* l = &d->linkage;
    ax_design_motion* m = AX_NEW0(ax_design_motion, 1);
    m->design = d;
    m->held = AX_NEW(int, l->hinge_count);
    for (int h = 0; h < l->hinge_count; ++h)
        if (d->supports[h])
            m->held[m->held_count++] = h;
    m->from = ax_alloc((size_t)m->held_count, sizeof *m->from);
    m->to = ax_alloc((size_t)m->held_count, sizeof *m->to);
    for (int k = 0; k < m->held_count; ++k) {
        memcpy(m->from[k], flat[m->held[k]], sizeof *m->from);
        memcpy(m->to[k], d->simulated[m->held[k]], sizeof *m->to);
    }
    m->solver = ax_solver_make(l->hinge_count, flat, pool);
    int panels = ax_solver_add(m->solver, ax_constraint_find("rigid_triangle"), 3, l->triangle_count,
                               (const int*)l->triangles, 1, NULL);
    m->supports = ax_solver_add(m->solver, ax_constraint_find("fixed"), 1, m->held_count, m->held, 1, NULL);
    add_load(m);
    ax_solver_scale_loads(m->solver, strain / ax_solver_load_ratio(m->solver, panels));
    ax_solver_set_dynamics(m->solver,
                           &(ax_dynamics){.mass = mass / l->triangle_count, .time_step = 1, .damping = damping});
    ax_solver_use_multipliers(m->solver, true);
    ax_solver_cap_multipliers(m->solver, 2 * d->report.edge_mean);
    return m;
}

void ax_design_motion_free(ax_design_motion* m)
{
    if (!m)
        return;
    ax_solver_free(m->solver);
    ax_free(m->held);
    ax_free(m->from);
    ax_free(m->to);
    ax_free(m);
}

bool ax_design_motion_to(ax_design_motion* m, double t, const ax_progress* progress, double (*places)[3])
{
    int steps = t > m->at ? (int)fmax(1, lround((t - m->at) * STEPS)) : 0;
    for (int i = 1; i <= steps; ++i) {
        double time = fmin(1, (m->at + (t - m->at) * i / steps) / arrival), share = time * time * (3 - 2 * time);
        if (!ax_progress_report(progress, "Simulating the way", (double)i / steps, NAN))
            return false;
        for (int k = 0; k < m->held_count; ++k)
            for (int c = 0; c < 3; ++c)
                ax_solver_set(m->solver, m->supports, k, c, m->from[k][c] + share * (m->to[k][c] - m->from[k][c]));
        ax_solver_step(m->solver, INNER);
    }
    m->at = t;
    ax_solver_get_places(m->solver, places);
    return true;
}
