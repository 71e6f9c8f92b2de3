// Newton on  grad E + J' lambda = 0,  c = 0  by the condensed matrix K = H(lambda) - p V'' + delta I + mu J'J, one sparse Cholesky of
// 3 unknowns a hinge. K is positive definite exactly if the reduced Hessian plus delta is (for large mu), so the inertia test
// comes with the factorisation. Where it fails, a few hinges are pinned (deploy/pins.h); delta > 0 is for what is not told by a few.
//
// Globalisation: the full KKT step, then chord corrections back to the rigid manifold with the same factor, judged by an
// augmented Lagrangian with the new multipliers fixed; delta from the ratio of actual to predicted decrease; a hard cap on the
// edge error. A residual norm as merit stalls where the reduced Hessian is indefinite, and the multipliers must stay unknowns of
// their own: lambda + mu c at the end would spoil the forces by mu times the rounding of c.
#include "deploy/newton.h"

#include "deploy/pins.h"

#include <string.h>

static const double merit_penalty = 30, penalty_far = 1e4, penalty_near = 1e7, edge_cap = 0.1, edge_target = 0.3;
enum { UZAWA = 12, CHORDS = 4, TRIES = 3, REJECTIONS = 30, SHIFTS = 40 };
// Stiffness in tensions and reach in edges of pins, which go with shifts below `most_pinned`. A hinge that would go `astray` and is more
// than a `lone` part of the step is pinned too: there the matrix is all but singular.
static const double spring = 100, first_reach = 0.03, most_reach = 0.5, most_pinned = 0.1, astray = 0.5, lone = 0.02;

// What makes the matrix positive definite where pins do not.
typedef struct damping {
    double shift, last, least, neutral;
    int hold; // steps that it is kept
} damping;

struct ax_newton {
    const ax_deploy_model* model;
    ax_deploy_hessian hessian;
    ax_block_factor* factor;
    int factorisations;
    ax_deploy_frame *frame, *trial_frame;
    double (*y)[3], (*work)[3], (*gradient)[3]; // per hinge
    double (*d)[3], (*move)[3], (*right)[3];    // per free hinge
    double *c, *trial_c, *trial_force, *change, *jd;
    ax_pins pins;
    double (*pinned_d)[3], *pinned_change; // the step before pins move
    damping damping;
};

ax_newton* ax_newton_make(const ax_deploy_model* m, ax_pool* pool)
{
    ax_newton* s = AX_NEW0(ax_newton, 1);
    s->model = m;
    s->hessian = ax_deploy_hessian_make(m);
    double(*place)[3] = ax_calloc((size_t)m->unknowns, sizeof *place);
    for (int u = 0; u < m->unknowns; ++u)
        memcpy(place[u], m->rest[m->hinge[u]], sizeof *m->rest);
    s->factor = ax_block_factor_make(&s->hessian.blocks, (const double(*)[3])place, pool);
    ax_free(place);
    s->frame = AX_NEW0(ax_deploy_frame, m->slide_count);
    s->trial_frame = AX_NEW0(ax_deploy_frame, m->slide_count);
    s->y = ax_alloc((size_t)m->hinges, sizeof *s->y);
    s->work = ax_alloc((size_t)m->hinges, sizeof *s->work);
    s->gradient = ax_alloc((size_t)m->hinges, sizeof *s->gradient);
    s->d = ax_alloc((size_t)m->unknowns, sizeof *s->d);
    s->move = ax_alloc((size_t)m->unknowns, sizeof *s->move);
    s->right = ax_alloc((size_t)m->unknowns, sizeof *s->right);
    s->c = AX_NEW(double, m->edge_count);
    s->trial_c = AX_NEW(double, m->edge_count);
    s->trial_force = AX_NEW(double, m->edge_count);
    s->change = AX_NEW(double, m->edge_count);
    s->jd = AX_NEW(double, m->edge_count);
    s->pins = ax_pins_make(m->unknowns);
    s->pinned_d = ax_alloc((size_t)m->unknowns, sizeof *s->pinned_d);
    s->pinned_change = AX_NEW(double, m->edge_count);
    return s;
}

void ax_newton_free(ax_newton* s)
{
    if (!s)
        return;
    void* blocks[] = {s->y,     s->work,  s->gradient,    s->d,           s->move,
                      s->right, s->c,     s->trial_c,     s->trial_force, s->change,
                      s->jd,    s->frame, s->trial_frame, s->pinned_d,    s->pinned_change};
    for (size_t k = 0; k < sizeof blocks / sizeof *blocks; ++k)
        ax_free(blocks[k]);
    ax_deploy_hessian_free(&s->hessian);
    ax_block_factor_free(s->factor);
    ax_pins_free(&s->pins);
    ax_free(s);
}

// J(x) d per edge, d over free hinges.
static void jacobian_times(const ax_deploy_model* m, const double (*x)[3], const double (*d)[3], double* out)
{
    for (int e = 0; e < m->edge_count; ++e) {
        int i = m->edge[e][0], j = m->edge[e][1], u = m->unknown[i], v = m->unknown[j];
        double sum = 0;
        for (int k = 0; k < 3; ++k)
            sum += (x[i][k] - x[j][k]) * ((u >= 0 ? d[u][k] : 0) - (v >= 0 ? d[v][k] : 0));
        out[e] = sum / m->length[e];
    }
}

// right (free hinges) = J(x)' force
static void transposed_times(ax_newton* s, const double (*x)[3], const double* force, double (*right)[3])
{
    const ax_deploy_model* m = s->model;
    memset(s->work, 0, (size_t)m->hinges * sizeof *s->work);
    ax_deploy_add_edge_forces(m, x, force, s->work);
    ax_deploy_allow(m, s->frame, s->work);
    for (int u = 0; u < m->unknowns; ++u)
        memcpy(right[u], s->work[m->hinge[u]], sizeof *right);
}

// Gradient of the Lagrangian over the unknown hinges in the directions that `frame`, made here, allows; returns the energy.
static double lagrangian_gradient(ax_newton* s, const double (*x)[3], const double* force, ax_deploy_frame* frame,
                                  double (*gradient)[3])
{
    const ax_deploy_model* m = s->model;
    double energy = ax_deploy_energy(m, x, s->work);
    ax_deploy_add_edge_forces(m, x, force, s->work);
    ax_deploy_frames(m, x, (const double(*)[3])s->work, frame);
    ax_deploy_allow(m, frame, s->work);
    for (int u = 0; u < m->unknowns; ++u)
        memcpy(gradient[u], s->work[m->hinge[u]], sizeof *gradient);
    return energy;
}

static double dot(int n, const double* a, const double* b)
{
    double sum = 0;
    for (int k = 0; k < n; ++k)
        sum += a[k] * b[k];
    return sum;
}

static bool factorise(ax_newton* s, const double (*x)[3], const double* force, double shift, double mu)
{
    ax_deploy_hessian_fill(&s->hessian, s->model, x, s->frame, force, shift, mu);
    ax_pins_hold(&s->pins, &s->hessian.blocks);
    ++s->factorisations;
    return ax_block_factor_run(s->factor, &s->hessian.blocks);
}

// Factorises a matrix that is positive definite: pins hinges where it is not, and where they are too many raises the shift, in large
// steps while its size is unknown.
static bool factorise_definite(ax_newton* s, const double (*x)[3], const double* force, double mu)
{
    damping* a = &s->damping;
    bool pinning = a->shift < most_pinned * s->model->tension;
    for (int tries = 0; tries < SHIFTS; ++tries) {
        if (factorise(s, x, force, fmax(a->shift, a->neutral), mu)) {
            a->last = a->shift > 0 ? a->shift : a->last;
            return true;
        }
        if (pinning && ax_pins_find(&s->pins, s->factor, s->move))
            continue;
        pinning = false;
        s->pins.count = 0;
        a->shift = a->shift > 0 ? (a->last > 0 ? 4 : 16) * a->shift : fmax(a->least, a->last / 2);
        a->hold = 2;
    }
    return false;
}

// y = x + t d on the unknown hinges, back on their curves and planes.
static void displace(const ax_deploy_model* m, const double (*x)[3], const double (*d)[3], double t, double (*y)[3])
{
    if (y != x)
        memcpy(y, x, (size_t)m->hinges * sizeof *y);
    for (int u = 0; u < m->unknowns; ++u)
        for (int c = 0; c < 3; ++c)
            y[m->hinge[u]][c] += t * d[u][c];
    for (int k = 0; k < m->slide_count; ++k) {
        int h = m->slide[k], u = m->unknown[h];
        double from[3];
        for (int c = 0; c < 3; ++c)
            from[c] = y[h][c] - t * d[u][c];
        ax_deploy_return(m, h, from, y[h]);
    }
}

// The KKT step d and the change of the multipliers, by Uzawa refinement on the factor of K.
static void kkt_step(ax_newton* s, const double (*x)[3], const double (*gradient)[3], double mu)
{
    const ax_deploy_model* m = s->model;
    int n = m->unknowns, edges = m->edge_count;
    double size = sqrt(dot(edges, s->c, s->c));
    memset(s->change, 0, (size_t)edges * sizeof *s->change);
    for (int round = 0; round < UZAWA; ++round) {
        for (int e = 0; e < edges; ++e)
            s->jd[e] = s->change[e] + mu * s->c[e];
        transposed_times(s, x, s->jd, s->right);
        for (int u = 0; u < n; ++u)
            for (int c = 0; c < 3; ++c)
                s->right[u][c] = -(s->right[u][c] + gradient[u][c]);
        ax_block_factor_solve(s->factor, s->right[0], s->d[0], 1);
        jacobian_times(m, x, (const double(*)[3])s->d, s->jd);
        double left = 0;
        for (int e = 0; e < edges; ++e) {
            double r = s->c[e] + s->jd[e];
            s->change[e] += mu * r;
            left += r * r;
        }
        left = sqrt(left);
        if (left < 0.1 * size * fmax(1e-3, fmin(1, 10 * size)) || left < 1e-13)
            break;
    }
}

// The KKT step with pins held back; returns by how much it lowers the Lagrangian.
static double pinned_step(ax_newton* s, const double (*x)[3], const double (*gradient)[3], double mu)
{
    const ax_deploy_model* m = s->model;
    const double(*d)[3] = (const double(*)[3])s->d;
    int n = 3 * m->unknowns;
    double shift = fmax(s->damping.shift, s->damping.neutral);
    kkt_step(s, x, gradient, mu);
    jacobian_times(m, x, d, s->jd);
    double held = shift * dot(n, d[0], d[0]) + ax_pins_held(&s->pins, d, d);
    double curvature = -dot(n, d[0], gradient[0]) - dot(m->edge_count, s->jd, s->change) - held;
    ax_pins_follow(&s->pins, s->factor, shift, d);
    memcpy(s->pinned_d, d, (size_t)m->unknowns * sizeof *d);
    memcpy(s->pinned_change, s->change, (size_t)m->edge_count * sizeof *s->change);
    return curvature / 2 + held;
}

// The whole step: pins go within `reach` and all else follows; returns by how much more that lowers the Lagrangian.
static double move_pins(ax_newton* s, const double (*x)[3], double mu, double reach)
{
    double gain = ax_pins_move(&s->pins, reach, s->move);
    jacobian_times(s->model, x, (const double(*)[3])s->move, s->jd);
    for (int u = 0; u < s->model->unknowns; ++u)
        for (int c = 0; c < 3; ++c)
            s->d[u][c] = s->pinned_d[u][c] + s->move[u][c];
    for (int e = 0; e < s->model->edge_count; ++e)
        s->change[e] = s->pinned_change[e] + mu * s->jd[e];
    return gain;
}

// One chord correction of y towards the rigid manifold with the present factor; adds to `force` what it takes.
static void chord(ax_newton* s, const double (*x)[3], double mu, double* force)
{
    const ax_deploy_model* m = s->model;
    for (int e = 0; e < m->edge_count; ++e)
        s->jd[e] = mu * s->trial_c[e];
    transposed_times(s, x, s->jd, s->right);
    ax_block_factor_solve(s->factor, s->right[0], s->move[0], 1);
    for (int u = 0; u < m->unknowns; ++u)
        for (int c = 0; c < 3; ++c)
            s->move[u][c] = -s->move[u][c];
    jacobian_times(m, x, (const double(*)[3])s->move, s->jd);
    for (int e = 0; e < m->edge_count; ++e)
        force[e] += mu * (s->trial_c[e] + s->jd[e]);
    displace(m, (const double(*)[3])s->y, (const double(*)[3])s->move, 1, s->y);
    ax_deploy_constraints(m, (const double(*)[3])s->y, s->trial_c);
}

ax_newton_result ax_newton_run(ax_newton* s, double (*x)[3], double* force, double enough, int most_steps,
                               const ax_progress* progress)
{
    const ax_deploy_model* m = s->model;
    const double(*at)[3] = (const double(*)[3])x, (*d)[3] = (const double(*)[3])s->d;
    int n = m->unknowns, edges = m->edge_count, rejected = 0;
    double stiffness = m->tension; // force per length: the unit of every stiffness below
    double kappa = penalty_far, penalty = merit_penalty * stiffness, reach = first_reach, pinned_gain = 0;
    bool shorter = false; // the step is taken again, within less reach
    double(*gradient)[3] = ax_alloc((size_t)n, sizeof *gradient);
    ax_newton_result result = {0};
    // a rim on a circle turns freely: motions without stiffness are held a little, and count as stable
    s->damping = (damping){.least = 1e-5 * stiffness, .neutral = m->slide_count ? 1e-6 * stiffness : 0};
    s->pins.count = 0;
    s->pins.spring = spring * stiffness;
    s->factorisations = 0;

    double energy = lagrangian_gradient(s, at, force, s->frame, gradient);
    ax_deploy_constraints(m, at, s->c);
    while (true) {
        double edge = ax_deploy_edge_error(m, at);
        double residual = sqrt(dot(3 * n, gradient[0], gradient[0]));
        result.residuals = (ax_residuals){edge, residual};
        result.reached = edge <= enough && residual <= enough;
        result.exact = edge <= AX_NEWTON_EXACT && residual <= AX_NEWTON_EXACT;
        if (result.reached || result.steps == most_steps)
            break;
        if (!ax_progress_report(progress, "Balancing forces", (double)result.steps / most_steps,
                                fmax(edge, residual))) {
            result.cancelled = true;
            break;
        }
        if (edge < 1e-4 && residual < 1e-4)
            kappa = penalty_near;
        double mu = kappa * stiffness, c2 = dot(edges, s->c, s->c), *shift = &s->damping.shift;
        if (!shorter) {
            if (!factorise_definite(s, at, force, mu))
                break;
            pinned_gain = pinned_step(s, at, (const double(*)[3])gradient, mu) + penalty * c2 / 2;
        }
        double predicted = pinned_gain + move_pins(s, at, mu, reach);
        int farthest = 0;
        for (int u = 1; u < n; ++u)
            if (ax_norm3(d[u]) > ax_norm3(d[farthest]))
                farthest = u;
        double longest = ax_norm3(d[farthest]), pinned = ax_pins_longest(&s->pins);
        bool alone = longest * longest > lone * dot(3 * n, d[0], d[0]) && *shift < most_pinned * stiffness;
        if (longest > astray && alone && ax_pins_add(&s->pins, farthest)) {
            shorter = false;
            continue;
        }
        double lagrangian = energy + dot(edges, force, s->c) + dot(edges, s->change, s->c);
        double before = lagrangian + penalty * c2 / 2, floor = 1e-13 * (fabs(energy) + 1);
        double residual_merit = residual * residual + 100 * stiffness * stiffness * c2, there = 0.1 * enough;
        double full = fmin(1, 2 / longest), t = full, ratio = 0, trial_energy = 0;
        bool accepted = false, fast = false, local = pinned > 0.3 * longest; // what pins do decides

        for (int tries = 0; tries < (local ? 1 : TRIES) && !accepted; ++tries, t *= accepted ? 1 : 0.4) {
            displace(m, at, d, t, s->y);
            ax_deploy_constraints(m, (const double(*)[3])s->y, s->trial_c);
            for (int e = 0; e < edges; ++e)
                s->trial_force[e] = force[e] + t * s->change[e];
            if (t == 1) { // where Newton contracts at once, nothing else is needed
                trial_energy =
                    lagrangian_gradient(s, (const double(*)[3])s->y, s->trial_force, s->trial_frame, s->move);
                double now = dot(3 * n, s->move[0], s->move[0]) +
                             100 * stiffness * stiffness * dot(edges, s->trial_c, s->trial_c);
                if ((now < 0.1 * residual_merit && *shift < 1e-2 * stiffness && s->pins.definite) ||
                    now < there * there) {
                    fast = accepted = true;
                    break;
                }
            }
            double error = ax_deploy_edge_error(m, (const double(*)[3])s->y);
            double target = fmax(1e-9, fmin(edge_cap * edge_target, 0.1 * edge));
            for (int k = 0; k < CHORDS && error > target; ++k) {
                chord(s, at, mu, s->trial_force);
                double next = ax_deploy_edge_error(m, (const double(*)[3])s->y);
                bool diverging = next > 0.8 * error;
                error = next;
                if (diverging)
                    break;
            }
            trial_energy = ax_deploy_energy(m, (const double(*)[3])s->y, NULL);
            double after = trial_energy + dot(edges, force, s->trial_c) + dot(edges, s->change, s->trial_c) +
                           penalty * dot(edges, s->trial_c, s->trial_c) / 2;
            double expected = predicted * (t == 1 ? 1 : t * (2 - t));
            ratio = (before - after + floor) / (fabs(expected) + floor);
            accepted = error <= fmax(edge_cap, 0.9 * edge) && ratio > 1e-3;
        }
        shorter = !accepted && local;
        if (!accepted) {
            if (++rejected > REJECTIONS)
                break;
            if (local)
                reach = 0.3 * pinned;
            else if (alone && ax_pins_add(&s->pins, farthest))
                reach = 0.3 * longest;
            else {
                *shift = fmax(8 * *shift, 1e-3 * stiffness);
                s->damping.hold = 1;
            }
            continue;
        }
        if (local && ratio > 0.6 && !fast)
            reach = fmax(reach, fmin(most_reach, 2.5 * pinned));
        if (fast || (ratio > 0.6 && t == full)) {
            if (s->damping.hold > 0 && !fast)
                --s->damping.hold;
            else {
                *shift *= fast ? 0.1 : fabs(ratio - 1) < 0.1 ? 1.0 / 16 : 0.25;
                if (*shift < 0.05 * s->damping.least)
                    *shift = 0;
            }
        } else if (local && ratio < 0.2)
            reach = 0.3 * pinned;
        else if ((ratio < 0.2 || t < full / 2) && !(alone && ax_pins_add(&s->pins, farthest)))
            *shift = fmax(4 * *shift, s->damping.least);
        if (fast) // then the matrix is positive definite without them
            s->pins.count = 0;
        memcpy(x, s->y, (size_t)m->hinges * sizeof *x);
        memcpy(force, s->trial_force, (size_t)edges * sizeof *force);
        energy = lagrangian_gradient(s, at, force, s->frame, gradient);
        ax_deploy_constraints(m, at, s->c);
        ++result.steps;
    }
    result.energy = energy;
    s->pins.count = 0;
    result.stable = result.exact && factorise(s, at, force, s->damping.neutral, penalty_near * stiffness);
    result.factorisations = s->factorisations;
    ax_free(gradient);
    return result;
}

void ax_newton_fit_forces(ax_newton* s, const double (*x)[3], double* force)
{
    const ax_deploy_model* m = s->model;
    memset(force, 0, (size_t)m->edge_count * sizeof *force);
    lagrangian_gradient(s, x, force, s->frame, s->right); // tells which way hinges can slide
    s->pins.count = 0;
    if (!factorise(s, x, force, 1e-7, 1)) // J'J + 1e-7 I
        return;
    for (int round = 0; round < 3; ++round) {
        lagrangian_gradient(s, x, force, s->frame, s->right);
        ax_block_factor_solve(s->factor, s->right[0], s->d[0], 1);
        jacobian_times(m, x, (const double(*)[3])s->d, s->jd);
        for (int e = 0; e < m->edge_count; ++e)
            force[e] -= s->jd[e];
    }
}
