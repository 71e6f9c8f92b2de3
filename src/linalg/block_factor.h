// A sparse Cholesky factor of a matrix of blocks on nodes that have places, factorised by all cores: a front for every supernode,
// eliminated in nested dissection of the places. Analysed once, factorised once per set of values, the same bits on
// every number of threads.
#pragma once

#include "base/pool.h"
#include "linalg/sparse.h"

typedef struct ax_block_factor ax_block_factor;

// place: one per node, any unit; values are not read. `pool` is borrowed; NULL: one thread.
ax_block_factor* ax_block_factor_make(const ax_blocks* blocks, const double (*place)[3], ax_pool* pool);
void ax_block_factor_free(ax_block_factor* factor);
// False if the matrix is not positive definite: then there is nothing to solve with.
bool ax_block_factor_run(ax_block_factor* factor, const ax_blocks* blocks);
// x = A^-1 b, n x size numbers each; x may be b.
void ax_block_factor_solve(ax_block_factor* factor, const double* b, double* x);
