// The joint solve without overlaps.
#pragma once

#include "joint/joint.h"

// ax_joint_solve; where panels then overlap flat by more than `depth`, names those pairs to the solver and solves again, a few times. The mouth bound keeps
// neighbours apart, but two rim panels can meet past the ends of an opening, where no mouth sees them. problem->apart is this
// function's; result->steps counts all steps.
ax_status ax_solve_apart(ax_joint_problem* problem, double depth, double (*flat)[2], double (*deployed)[3],
                         const ax_progress* progress, ax_joint_result* result, ax_error* error);
