// Newton on  grad E + J' lambda = 0,  c = 0  by the condensed matrix K = H(lambda) - p V'' + delta I + mu J'J, one sparse Cholesky of
// 3 unknowns a hinge. K is positive definite exactly if the reduced Hessian plus delta is (for large mu), so the inertia test
// comes with the factorisation.
//
// Globalisation: the full KKT step, then chord corrections back to the rigid manifold with the same factor, judged by an
// augmented Lagrangian with the new multipliers fixed; delta from the ratio of actual to predicted decrease; a hard cap on the
// edge error. A residual norm as merit stalls where the reduced Hessian is indefinite, and the multipliers must stay unknowns of
// their own: lambda + mu c at the end would spoil the forces by mu times the rounding of c.
#include "deploy/newton.h"

#include "base/vec.h"
#include "linalg/block_factor.h"

#include <string.h>

static const double merit_penalty = 30, penalty_far = 1e4, penalty_near = 1e7, edge_cap = 0.1, edge_target = 0.3;
enum { UZAWA = 12, CHORDS = 4, TRIES = 3, REJECTIONS = 30 };

struct ax_newton {
    const ax_deploy_model* model;
    ax_deploy_hessian hessian;
    ax_block_factor* factor;
    int factorisations;
    ax_deploy_frame *frame, *trial_frame;
    double (*y)[3], (*work)[3], (*gradient)[3]; // per hinge
    double (*d)[3], (*move)[3], (*right)[3];    // per free hinge
    double *c, *trial_c, *trial_force, *change, *jd;
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
    return s;
}

void ax_newton_free(ax_newton* s)
{
    if (!s)
        return;
    void* blocks[] = {s->y,       s->work,        s->gradient, s->d,  s->move,  s->right,      s->c,
                      s->trial_c, s->trial_force, s->change,   s->jd, s->frame, s->trial_frame};
    for (size_t k = 0; k < sizeof blocks / sizeof *blocks; ++k)
        ax_free(blocks[k]);
    ax_deploy_hessian_free(&s->hessian);
    ax_block_factor_free(s->factor);
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
    ++s->factorisations;
    return ax_block_factor_run(s->factor, &s->hessian.blocks);
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
        ax_block_factor_solve(s->factor, s->right[0], s->d[0]);
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

// One chord correction of y towards the rigid manifold with the present factor; adds to `force` what it takes.
static void chord(ax_newton* s, const double (*x)[3], double mu, double* force)
{
    const ax_deploy_model* m = s->model;
    for (int e = 0; e < m->edge_count; ++e)
        s->jd[e] = mu * s->trial_c[e];
    transposed_times(s, x, s->jd, s->right);
    ax_block_factor_solve(s->factor, s->right[0], s->move[0]);
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
    const double(*at)[3] = (const double(*)[3])x;
    int n = m->unknowns, edges = m->edge_count, hold = 0, rejected = 0;
    double stiffness = m->tension; // force per length: the unit of every stiffness below
    // a rim on a circle turns freely: motions without stiffness are held a little, and count as stable
    double neutral = m->slide_count ? 1e-6 * stiffness : 0;
    double kappa = penalty_far, shift = 0, last_shift = 0, least = 1e-5 * stiffness,
           penalty = merit_penalty * stiffness;
    double(*gradient)[3] = ax_alloc((size_t)n, sizeof *gradient);
    ax_newton_result result = {0};
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
        double mu = kappa * stiffness;

        // inertia correction: raise the shift until the factorisation succeeds, in large steps while its size is unknown
        bool definite = false;
        for (int tries = 0; tries < 40 && !(definite = factorise(s, at, force, fmax(shift, neutral), mu)); ++tries) {
            shift = shift > 0 ? (last_shift > 0 ? 4 : 16) * shift : fmax(least, last_shift / 2);
            hold = 2;
        }
        if (!definite)
            break;
        if (shift > 0)
            last_shift = shift;
        double damping = fmax(shift, neutral);
        kkt_step(s, at, (const double(*)[3])gradient, mu);

        jacobian_times(m, at, (const double(*)[3])s->d, s->jd);
        double d2 = dot(3 * n, s->d[0], s->d[0]), c2 = dot(edges, s->c, s->c);
        double curvature = -dot(3 * n, s->d[0], gradient[0]) - dot(edges, s->jd, s->change) - damping * d2;
        double predicted = curvature / 2 + damping * d2 + penalty * c2 / 2;
        double lagrangian = energy + dot(edges, force, s->c) + dot(edges, s->change, s->c);
        double before = lagrangian + penalty * c2 / 2, floor = 1e-13 * (fabs(energy) + 1);
        double residual_merit = residual * residual + 100 * stiffness * stiffness * c2, longest = 0;
        for (int u = 0; u < n; ++u)
            longest = fmax(longest, ax_norm3(s->d[u]));
        double full = fmin(1, 2 / longest), t = full, ratio = 0, trial_energy = 0;
        bool accepted = false, fast = false;

        for (int tries = 0; tries < TRIES && !accepted; ++tries, t *= accepted ? 1 : 0.4) {
            displace(m, at, (const double(*)[3])s->d, t, s->y);
            ax_deploy_constraints(m, (const double(*)[3])s->y, s->trial_c);
            for (int e = 0; e < edges; ++e)
                s->trial_force[e] = force[e] + t * s->change[e];
            if (t == 1) { // where Newton contracts at once, nothing else is needed
                trial_energy =
                    lagrangian_gradient(s, (const double(*)[3])s->y, s->trial_force, s->trial_frame, s->move);
                double now = dot(3 * n, s->move[0], s->move[0]) +
                             100 * stiffness * stiffness * dot(edges, s->trial_c, s->trial_c);
                if ((now < 0.1 * residual_merit && shift < 1e-2 * stiffness) || now < 1e-24) {
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
        if (!accepted) {
            if (++rejected > REJECTIONS)
                break;
            shift = fmax(8 * shift, 1e-3 * stiffness);
            hold = 1;
            continue;
        }
        if (fast || (ratio > 0.6 && t == full)) {
            if (hold > 0 && !fast)
                --hold;
            else {
                shift *= fast ? 0.1 : fabs(ratio - 1) < 0.1 ? 1.0 / 16 : 0.25;
                if (shift < 0.05 * least)
                    shift = 0;
            }
        } else if (ratio < 0.2 || t < full / 2)
            shift = fmax(4 * shift, least);
        memcpy(x, s->y, (size_t)m->hinges * sizeof *x);
        memcpy(force, s->trial_force, (size_t)edges * sizeof *force);
        energy = lagrangian_gradient(s, at, force, s->frame, gradient);
        ax_deploy_constraints(m, at, s->c);
        ++result.steps;
    }
    result.energy = energy;
    result.stable = result.exact && factorise(s, at, force, neutral, penalty_near * stiffness);
    result.factorisations = s->factorisations;
    ax_free(gradient);
    return result;
}

void ax_newton_fit_forces(ax_newton* s, const double (*x)[3], double* force)
{
    const ax_deploy_model* m = s->model;
    memset(force, 0, (size_t)m->edge_count * sizeof *force);
    lagrangian_gradient(s, x, force, s->frame, s->right); // tells which way hinges can slide
    if (!factorise(s, x, force, 1e-7, 1))                 // J'J + 1e-7 I
        return;
    for (int round = 0; round < 3; ++round) {
        lagrangian_gradient(s, x, force, s->frame, s->right);
        ax_block_factor_solve(s->factor, s->right[0], s->d[0]);
        jacobian_times(m, x, (const double(*)[3])s->d, s->jd);
        for (int e = 0; e < m->edge_count; ++e)
            force[e] -= s->jd[e];
    }
}
