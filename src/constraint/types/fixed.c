// fixed: holds a point at a target exactly. The point leaves the unknowns, so it costs nothing and has no weight; moving the target
// changes no matrix.
#include "constraint/target.h"

const ax_constraint_type ax_constraint_fixed = {
    .name = "fixed",
    .doc = "Holds a point at a target exactly.",
    .reference = "Bathe 1996, Finite Element Procedures (imposed displacements)",
    .pattern = AX_ROWS_POINTS,
    .least_points = 1,
    .most_points = 1,
    .eliminated = true,
    .lanes = TARGET_LANES,
    .parameters = ax_target_parameters,
    .parameter_count = sizeof ax_target_parameters / sizeof *ax_target_parameters,
    .rest = ax_target_rest,
    .project = ax_target_project,
};
