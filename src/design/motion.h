// A deployment as time goes by, for looking at it and for what happens on the way: supports go from where they lie in the flat sheet to their
// places while the load opens the holes, by implicit time steps of the projective solver. Panels are not quite rigid on the way, and where
// several supports hold a stiff patch they strain it; there is no contact.
#pragma once

#include "ax/design.h"
#include "base/pool.h"

typedef struct ax_design_motion ax_design_motion;

// The flat hinges in space, moved rigidly to where they are nearest to those of an open state.
void ax_design_lay_flat(const ax_design* design, const double (*open)[3], double (*out)[3]);

// Of a design with a simulated state, under its load and with its supports. `flat`: where its hinges lie at the beginning. `design` and
// `pool` are borrowed.
ax_design_motion* ax_design_motion_make(const ax_design* design, const double (*flat)[3], ax_pool* pool);
void ax_design_motion_free(ax_design_motion* motion);

// Goes on to time `t`, 0 flat, 1 at rest, and gives the hinges' places. False if cancelled.
bool ax_design_motion_to(ax_design_motion* motion, double t, const ax_progress* progress, double (*places)[3]);
