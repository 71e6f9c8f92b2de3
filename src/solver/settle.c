// What the state is worth: energy, residuals, forces left, and iterating until they say that it is done or will not be.
#include "solver/internal.h"

#include <assert.h>
#include <string.h>

static tally group_tally(const ax_solver* s, const group* g)
{
    return g->type->eliminated ? (tally){0} : ax_sum_tallies(s, g->e.first_task, task_count(&g->e));
}

static double mean_of(const group* g, double square)
{
    return sqrt(square / ((double)g->e.count * g->rows));
}

// A system that cannot be factorised has no incidence, hence nothing to measure.
static bool measure(ax_solver* s)
{
    if (!ax_solver_prepare(s))
        return false;
    ax_measure(s);
    return true;
}

double ax_solver_energy(ax_solver* s)
{
    if (!measure(s))
        return NAN;
    return ax_sum_tallies(s, 0, s->point_tallies + point_task_count(s)).energy;
}

double ax_solver_residual(ax_solver* s, int k)
{
    return ax_solver_report(s, k).residual;
}

ax_group_report ax_solver_report(ax_solver* s, int k)
{
    const group* g = s->groups + k;
    if (!measure(s))
        return (ax_group_report){.residual = NAN, .residual_most = NAN, .multiplier = NAN, .multiplier_most = NAN};
    tally t = group_tally(s, g);
    return (ax_group_report){.residual = mean_of(g, t.primal_square),
                             .residual_most = sqrt(t.primal_most),
                             .multiplier = mean_of(g, t.dual_square),
                             .multiplier_most = sqrt(t.dual_most),
                             .capped = t.capped};
}

void ax_solver_get_forces(ax_solver* s, double (*force)[3])
{
    bool sound = measure(s);
    for (int v = 0; v < s->n; ++v)
        for (int c = 0; c < 3; ++c)
            force[v][c] = sound ? s->kept[s->position[v]][c] : NAN;
}

// Centre of the points and their root mean square distance from it.
static double spread(const ax_solver* s)
{
    double centre[3] = {0}, sum = 0;
    for (int v = 0; v < s->n; ++v)
        for (int c = 0; c < 3; ++c)
            centre[c] += s->x[v][c] / s->n;
    for (int v = 0; v < s->n; ++v) {
        double d = ax_distance3(s->x[v], centre);
        sum += d * d;
    }
    return sqrt(sum / s->n);
}

double ax_solver_load_ratio(ax_solver* s, int k)
{
    double factor = s->load_factor;
    s->load_factor = 1;
    bool sound = measure(s);
    s->load_factor = factor;
    if (!sound)
        return NAN;
    double sum = 0;
    for (int v = 0; v < s->n; ++v) {
        double f[3];
        for (int c = 0; c < 3; ++c)
            f[c] = s->dead ? s->dead[v][c] : 0;
        for (int i = s->incident_start[v]; i < s->incident_start[v + 1]; ++i) {
            int row = s->incident[i] >> 1;
            for (int c = 0; c < 3 && row >= s->first_load_row; ++c)
                f[c] += s->row[row][c];
        }
        sum += ax_norm3(f);
    }
    double radius = sqrt(2) * spread(s); // a disk of radius R has a spread of R / sqrt 2
    return sum / (AX_PI * radius * s->groups[k].weight);
}

static double typical_length(const ax_solver* s)
{
    double sum = 0;
    int count = 0;
    for (int k = 0; k < s->group_count; ++k) {
        const group* g = s->groups + k;
        ax_row_pattern pattern = g->type->pattern;
        if (pattern != AX_ROWS_EDGES && pattern != AX_ROWS_ARMS && pattern != AX_ROWS_CENTRED)
            continue;
        for (int c = 0; c < g->e.count; ++c) {
            const int *first = g->e.index + place_of(&g->e, g->e.slot[c], 0), *second = first + AX_W;
            double d = ax_distance3(s->x[*first], s->x[*second]);
            sum += d * d, ++count;
        }
    }
    double length = count ? sqrt(sum / count) : spread(s);
    return length > 0 ? length : 1;
}

// Fills the residuals of the present places.
static void judge(ax_solver* s, ax_settled* r)
{
    ax_measure(s);
    tally points = ax_sum_tallies(s, s->point_tallies, point_task_count(s));
    double scale = 0;
    for (int v = 0; points.load_square == 0 && v < s->n; ++v)
        if (!s->held[s->position[v]])
            scale += s->stiffness[v] * s->stiffness[v] * r->length * r->length;
    scale = points.load_square == 0 ? scale : points.load_square;
    r->force = scale == 0 ? 0 : sqrt(points.residual_square / scale); // places that are not finite make it so too
    r->primal = r->multiplier_most = 0;
    r->capped = 0;
    r->worst_group = -1;
    double worst = -1;
    for (int k = 0; k < s->group_count; ++k) {
        const group* g = s->groups + k;
        if (g->type->eliminated)
            continue;
        tally t = group_tally(s, g);
        double residual = mean_of(g, t.primal_square) / r->length;
        if (!(residual <= worst))
            worst = residual, r->worst_group = k;
        if (!is_hard(s, g))
            continue;
        r->primal = fmax(r->primal, residual);
        r->multiplier_most = fmax(r->multiplier_most, sqrt(t.dual_most) / r->length);
        r->capped += t.capped;
    }
}

ax_settled ax_solver_settle(ax_solver* s, const ax_settle* settle, const ax_progress* progress)
{
    assert(!s->dynamic && settle->force > 0 && settle->primal > 0 && settle->check > 0);
    ax_settled r = {.end = AX_SETTLE_UNBOUND, .worst_group = -1};
    if (!ax_solver_prepare(s))
        return r;
    ax_pin(s);
    r.length = settle->length > 0 ? settle->length : typical_length(s);
    double least = INFINITY, mark = INFINITY;
    int marked = 0;
    for (;;) {
        judge(s, &r);
        double worst = fmax(r.force / settle->force, r.primal / settle->primal);
        if (!isfinite(r.force) || worst > 1e3 * least) {
            r.end = AX_SETTLE_DIVERGED;
            return r;
        }
        if (worst <= 1) {
            r.end = AX_SETTLE_DONE;
            return r;
        }
        least = fmin(least, worst);
        if (worst <= mark / 2)
            mark = worst, marked = r.iterations;
        if (r.iterations - marked >= settle->patience) {
            r.end = AX_SETTLE_STAGNATED;
            return r;
        }
        if (r.iterations >= settle->iterations) {
            r.end = AX_SETTLE_LIMIT;
            return r;
        }
        if (!ax_progress_report(progress, "Settling", (double)r.iterations / settle->iterations, worst)) {
            r.end = AX_SETTLE_CANCELLED;
            return r;
        }
        int left = settle->iterations - r.iterations, count = left < settle->check ? left : settle->check;
        ax_solver_iterate(s, count);
        r.iterations += count;
    }
}
