#include "deploy/pins.h"

#include <string.h>

enum { ROUNDS = 100 };

ax_pins ax_pins_make(int unknowns)
{
    return (ax_pins){.unknowns = unknowns, .mode = ax_alloc(3 * AX_PINS * (size_t)unknowns, sizeof(double[3]))};
}

void ax_pins_free(ax_pins* p)
{
    ax_free(p->mode);
    *p = (ax_pins){0};
}

bool ax_pins_add(ax_pins* p, int hinge)
{
    for (int k = 0; k < p->count; ++k)
        if (p->hinge[k] == hinge)
            return false;
    if (p->count == AX_PINS)
        return false;
    p->hinge[p->count++] = hinge;
    return true;
}

bool ax_pins_find(ax_pins* p, ax_block_factor* factor, double (*scratch)[3])
{
    bool found = false;
    for (int k = 0; k < AX_PANELS_TREES; ++k)
        if (ax_block_factor_negative(factor, k, scratch[0])) {
            int most = 0;
            for (int u = 1; u < p->unknowns; ++u)
                if (ax_norm3(scratch[u]) > ax_norm3(scratch[most]))
                    most = u;
            found = ax_pins_add(p, most) || found;
        }
    return found;
}

void ax_pins_hold(const ax_pins* p, ax_blocks* matrix)
{
    const double w = p->spring, block[9] = {w, 0, 0, 0, w, 0, 0, 0, w};
    for (int k = 0; k < p->count; ++k)
        ax_blocks_add_diagonal(matrix, p->hinge[k], block);
}

static double dot(int n, const double (*a)[3], const double (*b)[3])
{
    double sum = 0;
    for (int u = 0; u < n; ++u)
        sum += ax_dot3(a[u], b[u]);
    return sum;
}

double ax_pins_held(const ax_pins* p, const double (*a)[3], const double (*b)[3])
{
    double sum = 0;
    for (int k = 0; k < p->count; ++k)
        sum += p->spring * ax_dot3(a[p->hinge[k]], b[p->hinge[k]]);
    return sum;
}

// Cholesky, in place.
static bool is_definite(int n, double (*a)[3 * AX_PINS])
{
    for (int k = 0; k < n; ++k)
        for (int l = 0; l <= k; ++l) {
            for (int i = 0; i < l; ++i)
                a[k][l] -= a[k][i] * a[l][i];
            if (l == k && !(a[k][k] > 0))
                return false;
            a[k][l] = l == k ? sqrt(a[k][k]) : a[k][l] / a[l][l];
        }
    return true;
}

// With springs D and shift s the matrix K + D + s meets mode k with a force D e_k, so K a = D e_k - D a - s a; it meets d with minus
// the gradient, so K d leaves - D d - s d of it.
void ax_pins_follow(ax_pins* p, ax_block_factor* factor, double shift, const double (*d)[3])
{
    int n = p->unknowns, count = 3 * p->count;
    double test[3 * AX_PINS][3 * AX_PINS];
    memset(p->mode, 0, (size_t)count * (size_t)n * sizeof *p->mode);
    for (int k = 0; k < count; ++k)
        p->mode[(size_t)k * (size_t)n + (size_t)p->hinge[k / 3]][k % 3] = p->spring;
    for (int k = 0; k < p->count; ++k) {
        double* three = p->mode[3 * (size_t)k * (size_t)n];
        ax_block_factor_solve(factor, three, three, 3);
    }
    for (int k = 0; k < count; ++k) {
        const double(*a)[3] = (const double(*)[3])(p->mode + (size_t)k * (size_t)n);
        p->slope[k] = -ax_pins_held(p, a, d) - shift * dot(n, a, d);
        for (int l = 0; l <= k; ++l) {
            const double(*b)[3] = (const double(*)[3])(p->mode + (size_t)l * (size_t)n);
            p->damped[k][l] = p->damped[l][k] = p->spring * a[p->hinge[l / 3]][l % 3] - ax_pins_held(p, a, b);
            p->curvature[k][l] = p->curvature[l][k] = test[k][l] = p->damped[k][l] - shift * dot(n, a, b);
        }
    }
    p->definite = is_definite(count, test);
}

double ax_pins_move(ax_pins* p, double reach, double (*move)[3])
{
    int n = p->unknowns, count = 3 * p->count;
    double gain = 0, *along = p->along;
    memset(along, 0, sizeof p->along);
    for (int round = 0; round < ROUNDS; ++round)
        for (int k = 0; k < count; ++k) {
            double slope = p->slope[k], own = p->damped[k][k];
            for (int l = 0; l < count; ++l)
                slope += l == k ? 0 : p->damped[k][l] * along[l];
            along[k] = own > 0 ? fmax(-reach, fmin(reach, -slope / own)) : slope > 0 ? -reach : reach;
        }
    memset(move, 0, (size_t)n * sizeof *move);
    for (int k = 0; k < count; ++k) {
        gain -= p->slope[k] * along[k];
        for (int l = 0; l < count; ++l)
            gain -= p->curvature[k][l] * along[k] * along[l] / 2;
        const double(*a)[3] = (const double(*)[3])(p->mode + (size_t)k * (size_t)n);
        for (int u = 0; u < n; ++u)
            for (int c = 0; c < 3; ++c)
                move[u][c] += along[k] * a[u][c];
    }
    return gain;
}

double ax_pins_longest(const ax_pins* p)
{
    double longest = 0;
    for (int k = 0; k < 3 * p->count; ++k)
        longest = fmax(longest, fabs(p->along[k]));
    return longest;
}
