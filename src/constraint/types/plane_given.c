// plane_given: keeps a point on a plane that is given, a wall or a floor; the hinges that lie on a mirror.
#include "constraint/given_plane.h"

static void project(const ax_lane* restrict block, const ax_place* place, int points, const ax_lane3* restrict y,
                    ax_lane3* restrict p)
{
    (void)place, (void)points;
    for (int l = 0; l < AX_W; ++l) {
        double a = block[PLANE_UNIT][l], b = block[PLANE_UNIT + 1][l], c = block[PLANE_UNIT + 2][l];
        double d = a * (y[0][0][l] - block[PLANE_POINT][l]) + b * (y[0][1][l] - block[PLANE_POINT + 1][l]) +
                   c * (y[0][2][l] - block[PLANE_POINT + 2][l]);
        p[0][0][l] = y[0][0][l] - d * a, p[0][1][l] = y[0][1][l] - d * b, p[0][2][l] = y[0][2][l] - d * c;
    }
}

const ax_constraint_type ax_constraint_plane_given = {
    .name = "plane_given",
    .doc = "Keeps a point on a given plane.",
    .reference = "Bouaziz et al. 2012, Shape-Up (closest point on a reference)",
    .pattern = AX_ROWS_POINTS,
    .least_points = 1,
    .most_points = 1,
    .lanes = PLANE_LANES,
    .parameters = ax_given_plane_parameters,
    .parameter_count = sizeof ax_given_plane_parameters / sizeof *ax_given_plane_parameters,
    .prepare = ax_given_plane_prepare,
    .project = project,
};
