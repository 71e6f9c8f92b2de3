#include "operator/scale_field.h"

#include "linalg/cholesky.h"
#include "linkage/lattice.h"

#include <assert.h>

// `weight` times L plus the identity times `mass`, over the panels with index[t] >= 0. Neighbours outside these count as held, and
// with `rim_held` so does the rim: its hinge lies half as far as a neighbour, which doubles the weight.
static ax_sparse assemble(const ax_linkage* linkage, const int (*pairs)[2], double mass, double weight,
                          const int* index, int n, bool rim_held)
{
    ax_entries entries = {0};
    for (int t = 0; t < linkage->triangle_count; ++t)
        if (index[t] >= 0)
            ax_entries_add(&entries, index[t], index[t], mass);
    for (int h = 0; h < linkage->hinge_count; ++h) {
        int a = pairs[h][0], b = pairs[h][1], i = index[a], j = b >= 0 ? index[b] : -1;
        if (i >= 0 && (b >= 0 || rim_held))
            ax_entries_add(&entries, i, i, b >= 0 ? weight : 2 * weight);
        if (j >= 0)
            ax_entries_add(&entries, j, j, weight);
        if (i >= 0 && j >= 0)
            ax_entries_add(&entries, i, j, -weight);
    }
    return ax_entries_sparse(&entries, n);
}

static ax_cholesky* factor(ax_sparse* matrix)
{
    ax_cholesky* made = ax_cholesky_analyse(matrix);
    bool definite = ax_cholesky_factor(made, matrix);
    assert(definite); // diagonally dominant
    (void)definite;
    ax_sparse_free(matrix);
    return made;
}

enum { HEAT_STEPS = 4 }; // of implicit Euler: a fair Gaussian, and never a new extremum

void ax_field_smooth(const ax_linkage* linkage, double spacing, const unsigned char* chosen, double length, double* u)
{
    int *index = AX_NEW(int, linkage->triangle_count), n = 0;
    for (int t = 0; t < linkage->triangle_count; ++t)
        index[t] = chosen[t] ? n++ : -1;
    if (n && length > 0) {
        int(*pairs)[2] = ax_linkage_hinge_triangles(linkage);
        double weight = length * length / (2 * HEAT_STEPS) * 4 / (spacing * spacing);
        ax_sparse matrix = assemble(linkage, (const int(*)[2])pairs, 1, weight, index, n, false);
        ax_cholesky* solver = factor(&matrix);
        double *held = AX_NEW0(double, n), *x = AX_NEW(double, n);
        for (int h = 0; h < linkage->hinge_count; ++h) {
            int a = pairs[h][0], b = pairs[h][1];
            if (b >= 0 && index[a] >= 0 && index[b] < 0)
                held[index[a]] += weight * u[b];
            if (b >= 0 && index[b] >= 0 && index[a] < 0)
                held[index[b]] += weight * u[a];
        }
        for (int step = 0; step < HEAT_STEPS; ++step) {
            for (int t = 0; t < linkage->triangle_count; ++t)
                if (index[t] >= 0)
                    x[index[t]] = u[t] + held[index[t]];
            ax_cholesky_solve(solver, x, x, 1);
            for (int t = 0; t < linkage->triangle_count; ++t)
                if (index[t] >= 0)
                    u[t] = x[index[t]];
        }
        ax_cholesky_free(solver);
        ax_free(held);
        ax_free(x);
        ax_free(pairs);
    }
    ax_free(index);
}

enum { BEND_STEPS = 200 };

bool ax_field_bend(const ax_linkage* linkage, double spacing, const double* density, double* u)
{
    int n = linkage->triangle_count;
    int *index = AX_NEW(int, n), (*pairs)[2] = ax_linkage_hinge_triangles(linkage);
    for (int t = 0; t < n; ++t)
        index[t] = t;
    ax_sparse matrix = assemble(linkage, (const int(*)[2])pairs, 0, 4 / (spacing * spacing), index, n, true);
    ax_cholesky* solver = factor(&matrix);
    double *v = AX_NEW0(double, n), *next = AX_NEW(double, n), change = INFINITY;
    for (int step = 0; step < BEND_STEPS && change > 1e-12; ++step) { // monotone where the curvature has one sign
        for (int t = 0; t < n; ++t)
            next[t] = density[t] * exp(2 * fmin(u[t] + v[t], log(2)));
        ax_cholesky_solve(solver, next, next, 1);
        change = 0;
        for (int t = 0; t < n; ++t) {
            change = fmax(change, fabs(next[t] - v[t]));
            v[t] = next[t];
        }
    }
    bool settled = change <= 1e-9;
    for (int t = 0; t < n && settled; ++t)
        u[t] += v[t];
    ax_cholesky_free(solver);
    ax_free(v);
    ax_free(next);
    ax_free(pairs);
    ax_free(index);
    return settled;
}
