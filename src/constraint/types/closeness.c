// closeness: pulls a point to a target.
#include "constraint/target.h"

const ax_constraint_type ax_constraint_closeness = {
    .name = "closeness",
    .doc = "Pulls a point to a target.",
    .reference = "Bouaziz et al. 2012, Shape-Up (closeness)",
    .pattern = AX_ROWS_POINTS,
    .least_points = 1,
    .most_points = 1,
    .lanes = TARGET_LANES,
    .parameters = ax_target_parameters,
    .parameter_count = sizeof ax_target_parameters / sizeof *ax_target_parameters,
    .rest = ax_target_rest,
    .project = ax_target_project,
};
