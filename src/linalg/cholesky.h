// Sparse Cholesky factorisation through CHOLMOD, as three separate steps: analyse once per pattern, factor once per set of
// values, solve as often as wanted. BLAS is held to one thread, so results do not depend on the number of cores.
#pragma once

#include "linalg/sparse.h"

typedef struct ax_cholesky ax_cholesky;

// Orders and analyses the pattern of `matrix` (values are not read), for columns or dense blocks, whichever is quicker for one
// factorisation and a few solves. Never fails on a sound pattern.
ax_cholesky* ax_cholesky_analyse(const ax_sparse* matrix);
// In an order of elimination that is given, rows in turn: finding one takes longer than the rest of an analysis.
ax_cholesky* ax_cholesky_analyse_ordered(const ax_sparse* matrix, const int* order);
// The order of elimination, n rows in turn; as long as the factor.
const int* ax_cholesky_order(const ax_cholesky* factor);
void ax_cholesky_free(ax_cholesky* factor);

// Numerical factorisation of a matrix with the analysed pattern. False if it is not positive definite.
bool ax_cholesky_factor(ax_cholesky* factor, const ax_sparse* matrix);

// x = A^-1 b for `columns` right-hand sides stored one after the other; x may be b.
void ax_cholesky_solve(ax_cholesky* factor, const double* b, double* x, int columns);

typedef struct ax_cholesky_counters {
    int analyses, factorisations, solves;
    double entries; // in the factor
} ax_cholesky_counters;
ax_cholesky_counters ax_cholesky_count(const ax_cholesky* factor);
