// The loaded state brought to rest. Projective steps are near it after some fifty, and where a part of the sheet is slack they circle
// round it for ever. Newton on the same energy, that of the load and of fairness, with the panels rigid, takes a few steps.
#include "form/state.h"

#include "base/vec.h"
#include "deploy/newton.h"

#include <math.h>
#include <string.h>

// Residuals of states that lie within 0.001 of an edge of where they would come to rest; where a part is slack, 1e-4 left 0.06.
static const double enough = 1e-6;
// Small forms are worth a search, large ones a few steps.
enum { LEAST_STEPS = 8, MOST_STEPS = 25, PANELS_OF_MOST = 3000 };

static bool hold(ax_hold* holds, int h, ax_hold with)
{
    if (holds[h].kind != AX_HOLD_FREE)
        return false;
    holds[h] = with;
    return true;
}

// What holds each hinge under the load, and where. False if something does that Newton does not know, or planes alone, in which all
// may slide.
static bool list_supports(const ax_form* f, ax_hold* holds, double (*places)[3])
{
    bool known = true;
    for (int k = 0; k < f->rim_count; ++k) {
        const ax_rim_part* part = f->rim + k;
        known =
            known && (part->kind != AX_RIM_SLIDE || ax_form_shares(f)); // else it slides under the load, in its order
        for (int i = 0; i < part->count && part->kind != AX_RIM_FREE; ++i) {
            int h = part->hinges[i];
            known = hold(holds, h, (ax_hold){.kind = AX_HOLD_FIXED}) && known;
            memcpy(places[h], part->kind == AX_RIM_FIXED ? part->places[i] : f->deployed[h], sizeof *places);
        }
    }
    for (int k = 0; k < f->held_count; ++k) {
        const ax_form_constraint* c = f->held + k;
        for (int i = 0; i < c->count && c->support; ++i) {
            int h = c->hinges[i];
            if (c->kind == AX_HELD_FIXED) {
                known = hold(holds, h, (ax_hold){.kind = AX_HOLD_FIXED}) && known;
                memcpy(places[h], c->places[i], sizeof *places);
            } else if (c->kind == AX_HELD_CURVE)
                known = hold(holds, h, (ax_hold){.kind = AX_HOLD_ON_CURVE, .curve = f->held_holder[k].curve}) && known;
            else if (c->kind == AX_HELD_PLANE_GIVEN) {
                ax_hold plane = {.kind = AX_HOLD_IN_PLANE};
                double length = ax_norm3(c->direction);
                for (int d = 0; d < 3; ++d)
                    plane.normal[d] = c->direction[d] / length;
                known = hold(holds, h, plane) && known;
                memcpy(places[h], c->point, sizeof *places);
            } else
                known = false;
        }
    }
    // air is kept in by a membrane across what is open, whose apex is not the same in both
    bool inflated = f->dynamics.kind == AX_DYNAMICS_INFLATION, placed = false;
    for (int h = 0; h < f->lattice.linkage.hinge_count; ++h) {
        known = known && !(inflated && f->lattice.linkage.on_rim[h] && holds[h].kind == AX_HOLD_FREE);
        placed = placed || holds[h].kind == AX_HOLD_FIXED || holds[h].kind == AX_HOLD_ON_CURVE;
    }
    return known && placed;
}

static void unit_between(const double from[3], const double to[3], double d[3])
{
    ax_sub3(to, from, d);
    double length = ax_norm3(d);
    for (int c = 0; c < 3 && length > 0; ++c)
        d[c] /= length;
}

// Axial forces of the edges of a panel from its multipliers, which are forces on its corners.
static void edges_of_corners(const ax_form* f, int t, const double (*u)[3], double force[3])
{
    const int* h = f->lattice.linkage.triangles[t];
    memset(force, 0, 3 * sizeof *force);
    for (int k = 0; k < 3; ++k) {
        double next[3], previous[3];
        unit_between(f->simulated[h[k]], f->simulated[h[(k + 1) % 3]], next);
        unit_between(f->simulated[h[k]], f->simulated[h[(k + 2) % 3]], previous);
        double c = ax_dot3(next, previous), a = -ax_dot3(u[k], next), b = -ax_dot3(u[k], previous);
        double slim = fmax(1 - c * c, 1e-3); // a panel that lies on a line tells nothing
        force[(k + 2) % 3] += (a - c * b) / slim / 2;
        force[(k + 1) % 3] += (b - c * a) / slim / 2;
    }
}

static void corners_of_edges(const ax_form* f, int t, const double force[3], double (*u)[3])
{
    const int* h = f->lattice.linkage.triangles[t];
    for (int k = 0; k < 3; ++k) {
        double next[3], previous[3];
        unit_between(f->simulated[h[k]], f->simulated[h[(k + 1) % 3]], next);
        unit_between(f->simulated[h[k]], f->simulated[h[(k + 2) % 3]], previous);
        for (int c = 0; c < 3; ++c)
            u[k][c] = -(force[(k + 2) % 3] * next[c] + force[(k + 1) % 3] * previous[c]);
    }
}

bool ax_form_balance(ax_form* f, double load, const ax_progress* progress, bool* balanced)
{
    const ax_linkage* linkage = &f->lattice.linkage;
    int n = linkage->hinge_count;
    bool gravity = f->dynamics.kind == AX_DYNAMICS_GRAVITY;
    ax_hold* holds = AX_NEW0(ax_hold, n);
    double(*places)[3] = ax_copy(f->simulated, (size_t)n, sizeof *places);
    *balanced = false;
    if (!list_supports(f, holds, places)) {
        ax_free(places);
        ax_free(holds);
        return true;
    }
    double whole;
    ax_deploy_model m = ax_deploy_model_make(linkage, (const double(*)[2])f->flat, (const double(*)[3])places, holds,
                                             gravity ? f->dynamics.load.direction : NULL, &whole);
    whole *= gravity ? 4 * load : load; // panels carry four times their area
    for (int e = 0; e < m.edge_count; ++e)
        m.length[e] = f->side[m.edge_source[e] / 3][m.edge_source[e] % 3] / m.unit;
    ax_form_keep_fair(f, &m, 1 / whole);

    double(*x)[3] = ax_alloc((size_t)n, sizeof *x), *force = AX_NEW0(double, m.edge_count);
    for (int h = 0; h < n; ++h)
        for (int c = 0; c < 3; ++c)
            x[h][c] = ((holds[h].kind == AX_HOLD_FIXED ? places : f->simulated)[h][c] - m.centre[c]) / m.unit;
    for (int k = 0; k < m.slide_count; ++k)
        ax_deploy_return(&m, m.slide[k], x[m.slide[k]], x[m.slide[k]]);
    size_t count = ax_solver_multiplier_count(f->hang);
    double *multipliers = AX_NEW(double, count), (*panel)[3][3] = (double(*)[3][3])multipliers;
    double(*edges)[3] = ax_alloc((size_t)linkage->triangle_count, sizeof *edges);
    ax_solver_get_multipliers(f->hang, multipliers);
    for (int t = 0; t < linkage->triangle_count; ++t)
        edges_of_corners(f, t, (const double(*)[3])panel[t], edges[t]);
    for (int e = 0; e < m.edge_count; ++e)
        force[e] = edges[m.edge_source[e] / 3][m.edge_source[e] % 3] / whole;

    ax_newton* newton = ax_newton_make(&m, f->pool);
    int steps = (int)((long)MOST_STEPS * PANELS_OF_MOST / linkage->triangle_count);
    steps = steps < LEAST_STEPS ? LEAST_STEPS : steps > MOST_STEPS ? MOST_STEPS : steps;
    ax_newton_result result = ax_newton_run(newton, x, force, enough, steps, progress);
    ax_newton_free(newton);
    *balanced = result.reached;
    if (result.reached) {
        for (int h = 0; h < n; ++h)
            for (int c = 0; c < 3; ++c)
                f->simulated[h][c] = x[h][c] * m.unit + m.centre[c];
        for (int e = 0; e < m.edge_count; ++e)
            edges[m.edge_source[e] / 3][m.edge_source[e] % 3] = force[e] * whole;
        for (int t = 0; t < linkage->triangle_count; ++t)
            corners_of_edges(f, t, edges[t], panel[t]);
        ax_solver_set_multipliers(f->hang, multipliers);
        if (!ax_form_shares(f))
            memcpy(f->deployed, f->simulated, (size_t)n * sizeof *f->deployed);
    }
    ax_free(edges);
    ax_free(multipliers);
    ax_free(force);
    ax_free(x);
    ax_deploy_model_free(&m);
    ax_free(places);
    ax_free(holds);
    return !result.cancelled;
}
