// A sparse Cholesky factor of a matrix of blocks on nodes that have places, factorised by all cores: a front for every supernode,
// eliminated in nested dissection of the places. Analysed once, factorised once per set of values, the same bits on
// every number of threads.
#pragma once

#include "base/pool.h"
#include "linalg/panels.h"
#include "linalg/sparse.h"

typedef struct ax_block_factor ax_block_factor;

// place: one per node, any unit; values are not read. `pool` is borrowed; NULL: one thread.
ax_block_factor* ax_block_factor_make(const ax_blocks* blocks, const double (*place)[3], ax_pool* pool);
void ax_block_factor_free(ax_block_factor* factor);
// False if the matrix is not positive definite: then there is nothing to solve with.
bool ax_block_factor_run(ax_block_factor* factor, const ax_blocks* blocks);
// After that: a move x, n x size numbers, of what one of AX_PANELS_TREES parts of the matrix had eliminated when it came upon a pivot that
// was not positive: x'Ax <= 0. False if that part came upon none.
bool ax_block_factor_negative(ax_block_factor* factor, int part, double* x);
// x = A^-1 b for 1 to 4 right-hand sides of n x size numbers, one after the other; x may be b.
void ax_block_factor_solve(ax_block_factor* factor, const double* b, double* x, int columns);
