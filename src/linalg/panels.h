// A sparse Cholesky factor for many solves with three right-hand sides at once, on several threads.
//
// A solve reads every entry of the factor twice and does little else, so its time is the memory's: entries are stored exactly
// once without padding, indices once per dense block, and each entry serves x, y and z. The elimination tree is cut into
// independent subtrees that threads take, and a top. Sums across the cut are made in a fixed order: every number of threads
// gives the same bits.
#pragma once

#include "base/pool.h"
#include "linalg/sparse.h"

typedef double ax_vec4[4]; // x, y, z and one lane of padding

typedef struct ax_panels ax_panels;

// Analyses the pattern of a symmetric matrix (values are not read) that is to be eliminated in `order` (n entries), up to a
// postorder of the tree.
ax_panels* ax_panels_analyse(const ax_sparse* matrix, const int* order);
void ax_panels_free(ax_panels* panels);

// Factorises a matrix of that pattern. False if it is not positive definite: then panels must not be solved with. NULL pool:
// one thread.
bool ax_panels_factor(ax_panels* panels, const ax_sparse* matrix, ax_pool* pool);

// After a factorisation that has failed: x'Ax <= 0, in elimination order and in the first lane, that moves only what the part 0 ..
// AX_PANELS_TREES - 1 of the tree had eliminated when it came upon its first pivot that was not positive. False if it came upon none.
enum { AX_PANELS_TREES = 9 };
bool ax_panels_negative(const ax_panels* panels, int part, ax_vec4* x);

// order[k]: the unknown that is eliminated k-th. Solves work in this order, so that callers can keep their data in it.
const int* ax_panels_order(const ax_panels* panels);
double ax_panels_entries(const ax_panels* panels);
size_t ax_panels_bytes(const ax_panels* panels); // read by one solve, both passes

// x = A^-1 x in elimination order, 32-byte aligned. Behind its n rows x has room for what threads sum apart: ax_panels_rows in
// all. NULL pool: one thread.
void ax_panels_solve(const ax_panels* panels, ax_pool* pool, ax_vec4* x);
size_t ax_panels_rows(const ax_panels* panels);
