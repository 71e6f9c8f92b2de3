// The ladder from flat to exact: projective steps until the residuals are small, then Newton; where Newton fails, projective
// steps go on from where they stood to a ten times smaller level and Newton tries again. Gravity that resists is reached
// through inflation: the inflated state is near, and has all its edges in tension.
#include "deploy/deploy.h"

#include "base/vec.h"

#include <stdlib.h>
#include <string.h>

enum { PROJECTIVE_STEPS = 6000, OPENING_STEPS = 300, NEWTON_STEPS = 150 };

// The widest gap on a curve, over the widest at the start, from which the rim is taken to have gathered elsewhere.
static const double most_widening = 4;

typedef struct ladder {
    const ax_deploy_model* model;
    double (*x)[3];
    double* force;
    ax_pool* pool;
    ax_newton* newton;
    ax_deployment* result;
    double widest; // gap on a curve at the start
} ladder;

// One Newton run from the present places and forces; true when the end is exact and stable. `cancelled` is set on request.
static bool finish(ladder* l, const ax_progress* progress, bool* cancelled)
{
    ax_newton_result r = ax_newton_run(l->newton, l->x, l->force, NEWTON_STEPS, progress);
    l->result->newton_steps += r.steps;
    l->result->factorisations += r.factorisations;
    l->result->residuals = r.residuals;
    l->result->energy = r.energy;
    l->result->stable = r.stable;
    l->result->exact = r.exact && r.stable;
    *cancelled = r.cancelled;
    return l->result->exact;
}

typedef struct bead {
    int curve;         // the first sliding hinge on the same one
    double start, end; // along it
} bead;

static int along_curves(const void* a, const void* b)
{
    const bead *p = a, *q = b;
    if (p->curve != q->curve)
        return p->curve - q->curve;
    return (p->start > q->start) - (p->start < q->start);
}

// Smallest and largest gap between neighbours on their curve at x, along it and over the mean gap; 1 where nothing slides on
// curves. Neighbours are those at the start; hinges that have passed each other have a gap below 0.
static void measure_gaps(const ax_deploy_model* m, const double (*x)[3], double* least, double* most)
{
    bead* beads = AX_NEW(bead, m->slide_count);
    int count = 0;
    for (int k = 0; k < m->slide_count; ++k) {
        const ax_hold* hold = &m->hold[m->slide[k]];
        if (hold->kind != AX_HOLD_ON_CURVE)
            continue;
        bead* b = &beads[count++];
        for (b->curve = 0; m->hold[m->slide[b->curve]].curve != hold->curve; ++b->curve)
            continue;
        b->start = ax_deploy_along(m, m->slide[k], m->support[m->slide[k]]);
        b->end = ax_deploy_along(m, m->slide[k], x[m->slide[k]]);
    }
    qsort(beads, (size_t)count, sizeof *beads, along_curves);
    *least = count ? INFINITY : 1, *most = count ? -INFINITY : 1;
    double* gap = AX_NEW(double, count);
    for (int first = 0, last; first < count; first = last) {
        for (last = first; last < count && beads[last].curve == beads[first].curve; ++last)
            continue;
        const ax_curve* curve = m->hold[m->slide[beads[first].curve]].curve;
        ax_curve_range range = ax_curve_extent(curve);
        double span = range.closed ? ax_curve_length(curve, range.to) : 0, round_trip = 0;
        int n = last - first, gaps = n - !range.closed, lowest = 0;
        for (int k = 0; k < gaps; ++k) {
            const bead *from = &beads[first + k], *to = &beads[first + (k + 1) % n];
            gap[k] = to->end - from->end;
            if (range.closed) {
                double before = to->start - from->start + (k == n - 1 ? span : 0);
                gap[k] -= span * round((gap[k] - before) / span);
            }
            round_trip += gap[k];
            lowest = gap[k] < gap[lowest] ? k : lowest;
        }
        if (range.closed && round_trip < span / 2) // the widest gap, of more than half the curve, was taken backwards
            gap[lowest] += span;
        double whole = range.closed ? span : beads[last - 1].start - beads[first].start;
        for (int k = 0; k < gaps; ++k) {
            *least = fmin(*least, gap[k] * gaps / whole);
            *most = fmax(*most, gap[k] * gaps / whole);
        }
    }
    ax_free(gap);
    ax_free(beads);
}

static void measure_spread(ladder* l)
{
    ax_deployment* r = l->result;
    measure_gaps(l->model, (const double(*)[3])l->x, &r->gap_least, &r->gap_most);
    r->gathered = r->gap_most > most_widening * l->widest;
}

static bool climb(ladder* l, double first_level, double last_level, const ax_progress* progress, bool* cancelled)
{
    const ax_deploy_model* m = l->model;
    size_t bytes = (size_t)m->hinges * sizeof *l->x;
    ax_deploy_start(m, 0.01, l->x);
    ax_admm* admm = ax_admm_make(m, (const double(*)[3])l->x, l->pool);
    bool done = false;
    double lo = 0;
    if (m->slide_count) { // opened where they start, hinges keep their order and their spread along a curve
        ax_residuals ignored;
        *cancelled = !ax_admm_run(admm, 1e-2, OPENING_STEPS, progress, &ignored);
        ax_admm_release(admm);
    }
    for (double level = first_level; level > last_level / 2 && !done && !*cancelled; level /= 10) {
        ax_progress_part slot;
        ax_residuals residuals;
        double hi = lo + (1 - lo) / 2;
        *cancelled = !ax_admm_run(admm, level, PROJECTIVE_STEPS, ax_progress_within(&slot, progress, lo, (lo + hi) / 2),
                                  &residuals);
        if (*cancelled)
            break;
        memcpy(l->x, ax_admm_places(admm), bytes);
        for (int k = 0; k < m->slide_count; ++k)
            ax_deploy_return(m, m->slide[k], l->x[m->slide[k]], l->x[m->slide[k]]);
        ax_admm_forces(admm, l->force);
        l->result->residuals = residuals;
        measure_spread(l);
        if (l->result->gathered)
            break;
        if (fmax(residuals.edge, residuals.force) > 0.1)
            break; // nowhere near: no level below will be reached either
        done = finish(l, ax_progress_within(&slot, progress, (lo + hi) / 2, hi), cancelled);
        lo = hi;
    }
    l->result->projective_steps += ax_admm_iterations(admm);
    ax_admm_free(admm);
    return done;
}

// Gravity by load swap: the same linkage inflated, then Newton under its own weight from there.
static bool swap_load(ladder* l, const ax_progress* progress, bool* cancelled)
{
    ax_deploy_model inflated = *l->model;
    double area = 0;
    for (int p = 0; p < inflated.polygon_count; ++p) {
        const int* loop = inflated.polygon + inflated.polygon_start[p];
        if (inflated.polygon_start[p + 1] - inflated.polygon_start[p] != 3)
            break; // panels come first
        const double *a = inflated.rest[loop[0]], *b = inflated.rest[loop[1]], *c = inflated.rest[loop[2]];
        area += fabs(ax_orient2(a, b, c)) / 2;
    }
    inflated.inflated = true;
    inflated.pressure = 1 / (4 * area);

    ladder other = *l;
    ax_deployment aside = {0};
    other.model = &inflated;
    other.newton = ax_newton_make(&inflated, l->pool);
    other.result = &aside;
    ax_progress_part slot;
    bool open = climb(&other, 1e-3, 1e-5, ax_progress_within(&slot, progress, 0, 0.5), cancelled);
    ax_newton_free(other.newton);
    l->result->projective_steps += aside.projective_steps;
    l->result->newton_steps += aside.newton_steps;
    l->result->factorisations += aside.factorisations;
    if (!open)
        return false;
    ax_newton_fit_forces(l->newton, (const double(*)[3])l->x, l->force);
    return finish(l, ax_progress_within(&slot, progress, 0.5, 1), cancelled);
}

bool ax_deploy(const ax_deploy_model* model, double (*x)[3], double* force, const ax_progress* progress,
               ax_deployment* result)
{
    *result = (ax_deployment){0};
    ladder l = {.model = model, .x = x, .force = force, .pool = ax_pool_make(0), .result = result};
    l.newton = ax_newton_make(model, l.pool);
    double closest;
    measure_gaps(model, (const double(*)[3])model->support, &closest, &l.widest);
    bool cancelled = false;
    double first = model->hinges > 8000 ? 1e-4 : 1e-3;
    ax_progress_part slot;
    bool done = climb(&l, first, 1e-4, ax_progress_within(&slot, progress, 0, 0.4), &cancelled);
    if (!done && !cancelled && !result->gathered && !model->inflated)
        done = swap_load(&l, ax_progress_within(&slot, progress, 0.4, 0.7), &cancelled);
    if (!done && !cancelled && !result->gathered)
        done = climb(&l, 1e-5, 1e-6, ax_progress_within(&slot, progress, 0.7, 1), &cancelled);
    for (int e = 0; e < model->edge_count; ++e)
        result->force_over_tension = fmax(result->force_over_tension, fabs(force[e]) / model->tension);
    measure_spread(&l);
    result->exact = result->exact && !result->gathered && result->gap_least > -1e-9;
    ax_newton_free(l.newton);
    ax_pool_free(l.pool);
    return !cancelled;
}
