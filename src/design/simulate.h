// Simulation with supports that slide, for designs whose rims or arches do.
#pragma once

#include "ax/design.h"
#include "deploy/deploy.h"

// As ax_design_simulate, but every hinge is held as `holds` says (hinge_count): fixed at its deployed place, on a curve where it
// starts at the deployed place, or in the plane through that. Sets design->supports, and design->slides when it succeeds. A rim
// that gathers on one side of its curve is refused with AX_CANNOT_REALISE.
ax_status ax_design_simulate_held(ax_design* design, const ax_load* load, const ax_hold* holds,
                                  const ax_progress* progress, ax_error* error);
