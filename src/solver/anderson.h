// Anderson acceleration of a fixed-point iteration v <- G(v): the next point is the affine combination of the last images G whose
// residuals F = G - v combine to the least. Anderson 1965 (type II of Fang and Saad 2009); for local/global solvers Peng et al.
// 2018, for ADMM Zhang et al. 2019 and Ouyang et al. 2020.
//
// The state lives with the caller, in a few arrays. One iteration: jump, then G in place, then either take or revert. The same
// bits for every number of threads; nothing is allocated but by start, if the state has grown.
#pragma once

#include "base/pool.h"

#include <stdbool.h>
#include <stddef.h>

enum { AX_ANDERSON_MOST = 8 };
typedef struct ax_anderson ax_anderson;

typedef struct ax_anderson_part {
    double* values;
    size_t count;
} ax_anderson_part;

// `window`: how many past steps are combined, 1 .. AX_ANDERSON_MOST.
ax_anderson* ax_anderson_make(int window);
void ax_anderson_free(ax_anderson* anderson);
size_t ax_anderson_bytes(const ax_anderson* anderson);

// Forgets the past; the state is `count` arrays, whose places are kept.
void ax_anderson_start(ax_anderson* anderson, int count, const ax_anderson_part* parts, ax_pool* pool);
// The state, an image G, becomes the combination. False if there is nothing to combine and it stays.
bool ax_anderson_jump(ax_anderson* anderson, ax_pool* pool);
// After G: |F|^2 of this iteration.
double ax_anderson_residual(ax_anderson* anderson, ax_pool* pool);
// After G: the pair of v and G joins the past.
void ax_anderson_take(ax_anderson* anderson, ax_pool* pool);
// The state becomes again what it was before the last jump, as if there had been none.
void ax_anderson_revert(ax_anderson* anderson, ax_pool* pool);
// Nothing of the past but the last image is combined again.
void ax_anderson_forget(ax_anderson* anderson);
