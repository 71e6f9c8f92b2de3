// min E(x) subject to |x_i - x_j| = l on every edge, split as d = z with z on the sphere of radius l (Overby et al. 2017, ADMM
// contains projective dynamics). The penalty is scaled by the load: rho = 10 edge forces per edge length, soft enough to open
// the sheet quickly. In absolute units it is the classic failure: at a hundred times that value the edges are right to 6e-8 and
// the forces stall at 5e-4 of the load. It is balanced as it goes (He, Yang and Wang 2000; Boyd et al. 2011, section 3.4.1):
// doubled where edges lag behind forces, halved where forces lag, at the cost of a rescaling and no factorisation. Held fixed it
// takes five times as many steps at 10,000 and 40,000 panels.
#include "deploy/admm.h"

#include "base/vec.h"
#include "linalg/order.h"
#include "linalg/panels.h"

#include <string.h>

static const double relaxation = 1.8, start_penalty = 10, most_penalty = 3000, imbalance = 2;
enum { CHECK = 20, BALANCE = 2 * CHECK, PATIENCE = 500 };
static const double standstill =
    0.02; // residuals above it that have not fallen by a tenth in PATIENCE steps will not fall

struct ax_admm {
    const ax_deploy_model* model;
    ax_pool* pool;
    double rho, turn; // the penalty, and the factor by which it is changed
    int way;          // of the last change, up 1, down -1
    double (*x)[3];
    double (*z)[3], (*u)[3];     // per edge: the rigid edge vector and its scaled multiplier
    double (*at)[3], (*pull)[3]; // per sliding hinge: its point on the curve or plane and its scaled multiplier
    ax_deploy_frame* frame;
    bool released;
    ax_vec4* right; // per free hinge, in elimination order
    double (*gradient)[3];
    double* force;
    int* row; // per free hinge: its place in elimination order
    ax_panels* factor;
    int iterations;
};

static void factorise(ax_admm* a, ax_entries* entries)
{
    const ax_deploy_model* m = a->model;
    ax_sparse laplacian = ax_entries_sparse(entries, m->unknowns);
    double(*place)[3] = ax_calloc((size_t)m->unknowns, sizeof *place);
    int* order = AX_NEW(int, m->unknowns);
    for (int u = 0; u < m->unknowns; ++u)
        memcpy(place[u], m->rest[m->hinge[u]], sizeof *m->rest);
    ax_order_by_place(&laplacian, (const double(*)[3])place, a->pool, order);
    a->factor = ax_panels_analyse(&laplacian, order);
    ax_panels_factor(a->factor, &laplacian, a->pool); // an edge Laplacian plus 1e-9 is positive definite
    a->right = ax_alloc_aligned(ax_panels_rows(a->factor), sizeof *a->right);
    a->row = AX_NEW(int, m->unknowns);
    for (int k = 0; k < m->unknowns; ++k)
        a->row[ax_panels_order(a->factor)[k]] = k;
    ax_sparse_free(&laplacian);
    ax_free(place);
    ax_free(order);
}

ax_admm* ax_admm_make(const ax_deploy_model* m, const double (*x)[3], ax_pool* pool)
{
    ax_admm* a = AX_NEW0(ax_admm, 1);
    *a = (ax_admm){.model = m, .pool = pool, .rho = start_penalty * m->tension, .turn = 2};
    a->x = ax_copy(x, (size_t)m->hinges, sizeof *a->x);
    a->z = ax_alloc((size_t)m->edge_count, sizeof *a->z);
    a->u = ax_calloc((size_t)m->edge_count, sizeof *a->u);
    a->gradient = ax_alloc((size_t)m->hinges, sizeof *a->gradient);
    a->force = AX_NEW0(double, m->edge_count);
    a->at = ax_alloc((size_t)m->slide_count, sizeof *a->at);
    a->pull = ax_calloc((size_t)m->slide_count, sizeof *a->pull);
    a->frame = AX_NEW(ax_deploy_frame, m->slide_count);
    ax_entries entries = {0};
    for (int u = 0; u < m->unknowns; ++u)
        ax_entries_add(&entries, u, u, 1e-9);
    for (int k = 0; k < m->slide_count; ++k) {
        ax_entries_add(&entries, m->unknown[m->slide[k]], m->unknown[m->slide[k]], 1);
        memcpy(a->at[k], x[m->slide[k]], sizeof *a->at);
    }
    for (int e = 0; e < m->edge_count; ++e) {
        int i = m->unknown[m->edge[e][0]], j = m->unknown[m->edge[e][1]];
        if (i >= 0)
            ax_entries_add(&entries, i, i, 1);
        if (j >= 0)
            ax_entries_add(&entries, j, j, 1);
        if (i >= 0 && j >= 0)
            ax_entries_add(&entries, i, j, -1);
        double d[3], length;
        ax_sub3(x[m->edge[e][0]], x[m->edge[e][1]], d);
        length = ax_norm3(d);
        for (int c = 0; c < 3; ++c) // coincident ends have no direction: +x is as good as any, and repeatable
            a->z[e][c] = length > 0 ? m->length[e] / length * d[c] : (c == 0 ? m->length[e] : 0);
    }
    factorise(a, &entries);
    return a;
}

void ax_admm_free(ax_admm* a)
{
    if (!a)
        return;
    void* blocks[] = {a->x, a->z, a->u, a->at, a->pull, a->frame, a->right, a->gradient, a->force, a->row};
    for (size_t k = 0; k < sizeof blocks / sizeof *blocks; ++k)
        ax_free(blocks[k]);
    ax_panels_free(a->factor);
    ax_free(a);
}

void ax_admm_set_forces(ax_admm* a, const double* force)
{
    for (int e = 0; e < a->model->edge_count; ++e)
        for (int c = 0; c < 3; ++c)
            a->u[e][c] = force[e] / a->rho * a->z[e][c] / a->model->length[e];
}

void ax_admm_forces(const ax_admm* a, double* force)
{
    const ax_deploy_model* m = a->model;
    for (int e = 0; e < m->edge_count; ++e) {
        double d[3];
        ax_sub3(a->x[m->edge[e][0]], a->x[m->edge[e][1]], d);
        force[e] = a->rho * ax_dot3(a->u[e], d) / fmax(ax_norm3(d), 1e-300);
    }
}

// Hinges on curves, until they are released.
static bool stays(const ax_admm* a, int h)
{
    return !a->released && a->model->hold[h].kind == AX_HOLD_ON_CURVE;
}

void ax_admm_release(ax_admm* a)
{
    a->released = true;
}

static ax_residuals measure(ax_admm* a)
{
    const ax_deploy_model* m = a->model;
    const double(*x)[3] = (const double(*)[3])a->x;
    ax_admm_forces(a, a->force);
    ax_deploy_energy(m, x, a->gradient);
    ax_deploy_add_edge_forces(m, x, a->force, a->gradient);
    ax_residuals residuals = {.edge = ax_deploy_edge_error(m, x)};
    ax_deploy_frames(m, x, (const double(*)[3])a->gradient, a->frame);
    for (int k = 0; k < m->slide_count; ++k) {
        residuals.edge = fmax(residuals.edge, ax_distance3(x[m->slide[k]], a->at[k]));
        if (stays(a, m->slide[k]))
            a->frame[k] = (ax_deploy_frame){0};
    }
    ax_deploy_allow(m, a->frame, a->gradient);
    double sum = 0;
    for (int u = 0; u < m->unknowns; ++u)
        sum += ax_dot3(a->gradient[m->hinge[u]], a->gradient[m->hinge[u]]);
    residuals.force = sqrt(sum);
    return residuals;
}

static void iterate(ax_admm* a)
{
    const ax_deploy_model* m = a->model;
    // the follower load is lagged by up to three iterations: it changes slowly and costs as much as the rest
    if (a->iterations == 0 || (m->inflated && a->iterations % 3 == 0))
        ax_deploy_energy(m, (const double(*)[3])a->x, a->gradient);
    for (int u = 0; u < m->unknowns; ++u)
        for (int c = 0; c < 3; ++c)
            a->right[a->row[u]][c] = -a->gradient[m->hinge[u]][c] / a->rho;
    for (int e = 0; e < m->edge_count; ++e) {
        int h[2] = {m->edge[e][0], m->edge[e][1]}, i = m->unknown[h[0]], j = m->unknown[h[1]];
        for (int c = 0; c < 3; ++c) {
            double y = a->z[e][c] - a->u[e][c];
            if (i >= 0)
                a->right[a->row[i]][c] += y + (j < 0 ? a->x[h[1]][c] : 0);
            if (j >= 0)
                a->right[a->row[j]][c] -= y - (i < 0 ? a->x[h[0]][c] : 0);
        }
    }
    for (int k = 0; k < m->slide_count; ++k)
        for (int c = 0; c < 3; ++c)
            a->right[a->row[m->unknown[m->slide[k]]]][c] += a->at[k][c] - a->pull[k][c];
    ax_panels_solve(a->factor, a->pool, a->right);
    for (int u = 0; u < m->unknowns; ++u)
        memcpy(a->x[m->hinge[u]], a->right[a->row[u]], sizeof *a->x);
    for (int e = 0; e < m->edge_count; ++e) {
        const double *p = a->x[m->edge[e][0]], *q = a->x[m->edge[e][1]];
        double y[3];
        for (int c = 0; c < 3; ++c)
            y[c] = relaxation * (p[c] - q[c]) + (1 - relaxation) * a->z[e][c] + a->u[e][c];
        double norm = sqrt(y[0] * y[0] + y[1] * y[1] + y[2] * y[2]), s = m->length[e] / (norm > 0 ? norm : 1);
        for (int c = 0; c < 3; ++c) {
            a->z[e][c] = s * y[c];
            a->u[e][c] = y[c] - a->z[e][c];
        }
    }
    for (int k = 0; k < m->slide_count; ++k) {
        int h = m->slide[k];
        double y[3], at[3];
        for (int c = 0; c < 3; ++c)
            at[c] = y[c] = relaxation * a->x[h][c] + (1 - relaxation) * a->at[k][c] + a->pull[k][c];
        if (stays(a, h))
            memcpy(at, a->at[k], sizeof at);
        else
            ax_deploy_return(m, h, a->at[k], at);
        ax_sub3(y, at, a->pull[k]);
        memcpy(a->at[k], at, sizeof at);
    }
    ++a->iterations;
}

// Moves the penalty towards where edges and forces converge alike, by less each time it turns back, so that what is left is a
// plain convergent iteration and not a swing from one side to the other.
static void balance(ax_admm* a, ax_residuals residuals)
{
    const ax_deploy_model* m = a->model;
    int way = (residuals.edge > imbalance * residuals.force) - (residuals.force > imbalance * residuals.edge);
    if (way == 0)
        return;
    if (way == -a->way)
        a->turn = sqrt(a->turn);
    a->way = way;
    double wanted = way > 0 ? a->rho * a->turn : a->rho / a->turn;
    double rho = ax_clamp(wanted, start_penalty * m->tension, most_penalty * m->tension), scale = a->rho / rho;
    for (int e = 0; e < m->edge_count; ++e)
        for (int c = 0; c < 3; ++c)
            a->u[e][c] *= scale;
    for (int k = 0; k < m->slide_count; ++k)
        for (int c = 0; c < 3; ++c)
            a->pull[k][c] *= scale;
    a->rho = rho;
}

bool ax_admm_run(ax_admm* a, double level, int iterations, const ax_progress* progress, ax_residuals* residuals)
{
    *residuals = measure(a);
    double least = INFINITY, before = INFINITY;
    if (!a->model->inflated)
        ax_deploy_energy(a->model, (const double(*)[3])a->x, a->gradient);
    for (int k = 1; k <= iterations; ++k) {
        iterate(a);
        if (k % CHECK && k < iterations)
            continue;
        *residuals = measure(a);
        ax_deploy_energy(a->model, (const double(*)[3])a->x, a->gradient);
        double worst = fmax(residuals->edge, residuals->force);
        if (!ax_progress_report(progress, "Opening the linkage", (double)k / iterations, worst))
            return false;
        if (worst <= level)
            break;
        least = fmin(least, worst);
        if (k % PATIENCE == 0) {
            if (least > standstill && least > 0.9 * before)
                break;
            before = fmin(before, least);
        }
        if (k % BALANCE == 0)
            balance(a, *residuals);
    }
    return true;
}

const double (*ax_admm_places(const ax_admm* a))[3]
{
    return (const double(*)[3])a->x;
}

int ax_admm_iterations(const ax_admm* a)
{
    return a->iterations;
}
