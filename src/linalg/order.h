// Elimination order by nested dissection of node coordinates (George 1973): for meshes whose nodes have places, as good as a
// graph partitioner and many times faster.
#pragma once

#include "base/pool.h"
#include "linalg/sparse.h"

// Fills order[k] = node eliminated k-th. `matrix` gives the pattern over n nodes, `place` their coordinates (any that keep
// neighbours near: a flat or a lattice state). NULL pool: one thread, the same order.
void ax_order_by_place(const ax_sparse* matrix, const double (*place)[3], ax_pool* pool, int* order);
