#include "solver/extrapolate.h"

#include "ax/base.h"

#include <assert.h>
#include <math.h>

// Coefficients beyond this tell of steps that do not differ but by noise.
static const double most_growth = 1000;

struct ax_extrapolation {
    size_t size;
    int most, kept;
    double *states[AX_MOST_STATES], *limit;
};

ax_extrapolation* ax_extrapolation_make(size_t size, int most)
{
    assert(most >= 3 && most <= AX_MOST_STATES);
    ax_extrapolation* e = AX_NEW0(ax_extrapolation, 1);
    e->size = size;
    e->most = most;
    for (int k = 0; k < most; ++k)
        e->states[k] = AX_NEW(double, size);
    e->limit = AX_NEW(double, size);
    return e;
}

void ax_extrapolation_free(ax_extrapolation* e)
{
    if (!e)
        return;
    for (int k = 0; k < e->most; ++k)
        ax_free(e->states[k]);
    ax_free(e->limit);
    ax_free(e);
}

double* ax_extrapolation_next(ax_extrapolation* e)
{
    if (e->kept == e->most)
        e->kept = 0;
    return e->states[e->kept++];
}

void ax_extrapolation_clear(ax_extrapolation* e)
{
    e->kept = 0;
}

const double* ax_extrapolation_last(const ax_extrapolation* e)
{
    assert(e->kept > 0);
    return e->states[e->kept - 1];
}

// Solves A c = 1 for a positive definite A of m rows, in place of `c`. False if it is not definite.
static bool solve_ones(double A[AX_MOST_STATES][AX_MOST_STATES], int m, double* c)
{
    for (int i = 0; i < m; ++i)
        c[i] = 1;
    for (int i = 0; i < m; ++i) {
        if (!(A[i][i] > 0))
            return false;
        for (int r = i + 1; r < m; ++r) {
            double q = A[r][i] / A[i][i];
            for (int k = i; k < m; ++k)
                A[r][k] -= q * A[i][k];
            c[r] -= q * c[i];
        }
    }
    for (int i = m - 1; i >= 0; --i) {
        for (int k = i + 1; k < m; ++k)
            c[i] -= A[i][k] * c[k];
        c[i] /= A[i][i];
    }
    return true;
}

const double* ax_extrapolation_limit(ax_extrapolation* e)
{
    if (e->kept < e->most)
        return NULL;
    int m = e->most - 1;
    double A[AX_MOST_STATES][AX_MOST_STATES] = {{0}}, c[AX_MOST_STATES], trace = 0, sum = 0, growth = 0;
    for (size_t q = 0; q < e->size; ++q) {
        double step[AX_MOST_STATES];
        for (int i = 0; i < m; ++i)
            step[i] = e->states[i + 1][q] - e->states[i][q];
        for (int i = 0; i < m; ++i)
            for (int k = 0; k <= i; ++k)
                A[i][k] += step[i] * step[k];
    }
    for (int i = 0; i < m; ++i) {
        for (int k = 0; k < i; ++k)
            A[k][i] = A[i][k];
        trace += A[i][i];
    }
    for (int i = 0; i < m; ++i)
        A[i][i] += 1e-10 * trace;
    if (!(trace > 0) || !solve_ones(A, m, c))
        return NULL;
    for (int i = 0; i < m; ++i)
        sum += c[i];
    for (int i = 0; i < m; ++i)
        growth += fabs(c[i] /= sum);
    if (!(growth < most_growth))
        return NULL;
    for (size_t q = 0; q < e->size; ++q) {
        double z = 0;
        for (int i = 0; i < m; ++i)
            z += c[i] * e->states[i + 1][q];
        e->limit[q] = z;
    }
    return e->limit;
}
