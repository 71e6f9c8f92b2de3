// States between flat and deployed. The panels' middles go straight from where they lie to where they end, which is how a uniform
// linkage opens; of the rigid linkages with middles near there the projective solver finds the nearest. A linkage has more
// freedoms than one, so this is a way that it can take, and the one along which it is drawn apart evenly.
#pragma once

#include "ax/design.h"
#include "base/pool.h"

typedef struct ax_way ax_way;

// Ends at the simulated state, if there is one, else at the deployed one. `pool` is borrowed.
ax_way* ax_way_make(const ax_design* design, ax_pool* pool);
void ax_way_free(ax_way* way);

// Hinge places (document units) at `t`, 0 flat, 1 open, beginning with the state asked before. `error` receives the largest relative
// error of an edge. False if cancelled.
bool ax_way_at(ax_way* way, double t, const ax_progress* progress, double (*places)[3], double* error);
