// A Cholesky factor repacked for many solves with three right-hand sides at once, on several threads.
//
// A solve reads every entry of the factor twice and does little else, so its time is the memory's: entries are stored exactly
// once without padding, indices once per dense block, and each entry serves x, y and z. The elimination tree is cut into
// independent subtrees that threads take, and a top that one thread does; sums across the cut are made in a fixed order.
#pragma once

#include "base/pool.h"
#include "linalg/cholesky.h"

typedef double ax_vec4[4]; // x, y, z and one lane of padding

typedef struct ax_panels ax_panels;

// From a numerical factor of kind AX_FACTOR_PANELS, which may be freed afterwards.
ax_panels* ax_panels_make(const ax_cholesky* factor);
void ax_panels_free(ax_panels* panels);

// order[k]: the unknown that is eliminated k-th. Solves work in this order, so that callers can keep their data in it.
const int* ax_panels_order(const ax_panels* panels);
double ax_panels_entries(const ax_panels* panels);
size_t ax_panels_bytes(const ax_panels* panels); // read by one solve, both passes

// x = A^-1 x in elimination order; n rows, 32-byte aligned. NULL pool: one thread, the same bits.
void ax_panels_solve(ax_panels* panels, ax_pool* pool, ax_vec4* x);
