// The ladder from flat to exact, rung by rung, in this order; docs/deployment.md tells what each is for.
//   at once      projective steps until the residuals are small, then Newton; where Newton fails, from a ten times smaller level
//   rough        where projective steps stand still far from there, Newton from where they stand, with more steps
//   inflated     gravity by load swap: the inflated state is near, and has all its edges in tension
//   smaller      projective steps go on to smaller levels still, where they had come near
//   in stages    the supports move from where they lie flat to their places by and by, the panels rigid at each stage
//   designed     Newton from the designed state, if the caller knows one
#include "deploy/deploy.h"

#include "base/vec.h"

#include <stdlib.h>
#include <string.h>

enum { PROJECTIVE_STEPS = 6000, OPENING_STEPS = 300, STAGE_STEPS = 400 };
enum { NEWTON_STEPS = 150, ROUGH_STEPS = 300, STAGE_NEWTON_STEPS = 100, DESIGNED_STEPS = 400 };
static const double noise = 0.01;
static const double most_tension = 1000; // over load x edge / rim, of a sheet that still has room to bulge
static const double congruent = 1e-6;    // edge error of a designed state that is one

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
static bool finish(ladder* l, int steps, const ax_progress* progress, bool* cancelled)
{
    ax_newton_result r = ax_newton_run(l->newton, l->x, l->force, AX_NEWTON_EXACT, steps, progress);
    l->result->newton_steps += r.steps;
    l->result->factorisations += r.factorisations;
    l->result->residuals = r.residuals;
    l->result->energy = r.energy;
    l->result->stable = r.stable;
    l->result->exact = r.exact && r.stable;
    *cancelled = r.cancelled;
    return l->result->exact;
}

static double force_over_tension(const ladder* l)
{
    double most = 0;
    for (int e = 0; e < l->model->edge_count; ++e)
        most = fmax(most, fabs(l->force[e]) / l->model->tension);
    return most;
}

static double edge_off(const ladder* l, int e)
{
    const int* end = l->model->edge[e];
    return fabs(ax_distance3(l->x[end[0]], l->x[end[1]]) / l->model->length[e] - 1);
}

static void find_worst_edges(ladder* l)
{
    int tightest = 0, furthest = 0;
    for (int e = 1; e < l->model->edge_count; ++e) {
        tightest = fabs(l->force[e]) > fabs(l->force[tightest]) ? e : tightest;
        furthest = edge_off(l, e) > edge_off(l, furthest) ? e : furthest;
    }
    l->result->tightest = tightest, l->result->furthest = furthest;
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

static void take(ladder* l, const ax_admm* admm)
{
    const ax_deploy_model* m = l->model;
    memcpy(l->x, ax_admm_places(admm), (size_t)m->hinges * sizeof *l->x);
    for (int k = 0; k < m->slide_count; ++k)
        ax_deploy_return(m, m->slide[k], l->x[m->slide[k]], l->x[m->slide[k]]);
    ax_admm_forces(admm, l->force);
}

// `near` tells whether the projective steps came to the first level at all.
static bool climb(ladder* l, double first_level, double last_level, bool* near, const ax_progress* progress,
                  bool* cancelled)
{
    const ax_deploy_model* m = l->model;
    ax_deploy_start(m, noise, l->x);
    ax_admm* admm = ax_admm_make(m, (const double(*)[3])l->x, l->pool);
    bool done = false;
    double lo = 0;
    *near = false;
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
        take(l, admm);
        l->result->residuals = residuals;
        l->result->force_over_tension = fmax(l->result->force_over_tension, force_over_tension(l));
        measure_spread(l);
        if (l->result->gathered)
            break;
        bool rough = fmax(residuals.edge, residuals.force) > 10 * level;
        *near = *near || !rough;
        done = finish(l, rough ? ROUGH_STEPS : NEWTON_STEPS, ax_progress_within(&slot, progress, (lo + hi) / 2, hi),
                      cancelled);
        if (rough) {
            if (!done)
                l->result->residuals = residuals;
            break; // no level below will be reached either
        }
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
    bool near, open = climb(&other, 1e-3, 1e-5, &near, ax_progress_within(&slot, progress, 0, 0.5), cancelled);
    ax_newton_free(other.newton);
    l->result->projective_steps += aside.projective_steps;
    l->result->newton_steps += aside.newton_steps;
    l->result->factorisations += aside.factorisations;
    if (!open)
        return false;
    ax_newton_fit_forces(l->newton, (const double(*)[3])l->x, l->force);
    return finish(l, NEWTON_STEPS, ax_progress_within(&slot, progress, 0.5, 1), cancelled);
}

// The panels stay rigid while their supports move: each stage is brought near an equilibrium of its own and starts the next. Between stages
// forces are carried over, and what is free follows by the next projective steps.
static bool move_supports(ladder* l, const ax_progress* progress, bool* cancelled)
{
    const ax_deploy_model* m = l->model;
    ax_deploy_model staged = *m;
    double(*flat)[3] = ax_alloc((size_t)m->hinges, sizeof *flat);
    ax_deploy_lay(m, flat);
    staged.support = ax_copy(m->support, (size_t)m->hinges, sizeof *m->support);
    bool done = false;
    for (int stage = 1; stage <= AX_OPENING_STAGES && !*cancelled; ++stage) {
        double share = (double)stage / AX_OPENING_STAGES, lo = share - 1.0 / AX_OPENING_STAGES;
        bool last = stage == AX_OPENING_STAGES;
        for (int h = 0; h < m->hinges; ++h)
            for (int c = 0; c < 3 && m->hold[h].kind == AX_HOLD_FIXED; ++c) {
                staged.support[h][c] = last ? m->support[h][c] : flat[h][c] + share * (m->support[h][c] - flat[h][c]);
                l->x[h][c] = staged.support[h][c];
            }
        if (stage == 1)
            ax_deploy_start(&staged, noise, l->x);
        ax_admm* admm = ax_admm_make(&staged, (const double(*)[3])l->x, l->pool);
        if (stage > 1)
            ax_admm_set_forces(admm, l->force);
        ax_progress_part slot;
        ax_residuals residuals;
        *cancelled = !ax_admm_run(admm, 1e-2, last ? 2 * STAGE_STEPS : STAGE_STEPS,
                                  ax_progress_within(&slot, progress, lo, (lo + share) / 2), &residuals);
        take(l, admm);
        l->result->projective_steps += ax_admm_iterations(admm);
        ax_admm_free(admm);
        if (!*cancelled) // Newton reads the places of what is fixed from x: it serves every stage
            done = finish(l, last ? ROUGH_STEPS : STAGE_NEWTON_STEPS,
                          ax_progress_within(&slot, progress, (lo + share) / 2, share), cancelled) &&
                   last;
    }
    ax_free(flat);
    ax_free(staged.support);
    return done;
}

static bool from_design(ladder* l, const double (*designed)[3], const ax_progress* progress, bool* cancelled)
{
    if (!designed || !(ax_deploy_edge_error(l->model, designed) < congruent))
        return false;
    memcpy(l->x, designed, (size_t)l->model->hinges * sizeof *l->x);
    ax_newton_fit_forces(l->newton, designed, l->force);
    return finish(l, DESIGNED_STEPS, progress, cancelled);
}

bool ax_deploy(const ax_deploy_model* model, const double (*designed)[3], double (*x)[3], double* force,
               const ax_progress* progress, ax_deployment* result)
{
    *result = (ax_deployment){.opening = AX_OPENED_AT_ONCE};
    ladder l = {.model = model, .x = x, .force = force, .pool = ax_pool_make(0), .result = result};
    l.newton = ax_newton_make(model, l.pool);
    double closest, first = model->hinges > 8000 ? 1e-4 : 1e-3;
    measure_gaps(model, (const double(*)[3])model->support, &closest, &l.widest);
    bool cancelled = false, near, slides = false;
    for (int k = 0; k < model->slide_count; ++k)
        slides = slides || model->hold[model->slide[k]].kind == AX_HOLD_ON_CURVE;
    ax_progress_part slot;
    bool done = climb(&l, first, 1e-4, &near, ax_progress_within(&slot, progress, 0, 0.3), &cancelled);
    result->taut = !done && result->residuals.edge < 1e-5 && force_over_tension(&l) > most_tension;
    if (result->taut)
        result->force_over_tension = force_over_tension(&l);
    find_worst_edges(&l);
    ax_deployment at_once = *result; // it says most about what is wrong with a sheet that nothing opens
    bool hopeless = result->gathered || result->taut; // from flat, whatever the way
    if (!done && !cancelled && !hopeless && !model->inflated) {
        result->opening = AX_OPENED_INFLATED;
        done = swap_load(&l, ax_progress_within(&slot, progress, 0.3, 0.5), &cancelled);
    }
    if (!done && !cancelled && !hopeless && near) {
        result->opening = AX_OPENED_AT_ONCE;
        done = climb(&l, 1e-5, 1e-6, &near, ax_progress_within(&slot, progress, 0.5, 0.65), &cancelled);
    }
    if (!done && !cancelled && !hopeless && !slides) { // those on curves have places there only
        result->opening = AX_OPENED_IN_STAGES;
        done = move_supports(&l, ax_progress_within(&slot, progress, 0.65, 0.85), &cancelled);
    }
    if (!done && !cancelled && !result->gathered) {
        result->opening = AX_OPENED_DESIGNED;
        done = from_design(&l, designed, ax_progress_within(&slot, progress, 0.85, 1), &cancelled);
    }
    if (done) {
        result->taut = false;
        result->force_over_tension = force_over_tension(&l);
    } else {
        int projective = result->projective_steps, newton = result->newton_steps;
        *result = at_once;
        result->opening = AX_NOT_OPENED;
        result->exact = result->stable = false;
        result->projective_steps = projective, result->newton_steps = newton;
    }
    measure_spread(&l);
    result->exact = result->exact && !result->gathered && result->gap_least > -1e-9;
    ax_newton_free(l.newton);
    ax_pool_free(l.pool);
    return !cancelled;
}
