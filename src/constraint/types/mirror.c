// mirror: keeps two points mirror images of each other in a given plane: both go to the mean of the first and the image
// of the second.
#include "constraint/given_plane.h"

static void project(const ax_lane* restrict block, const ax_place* place, int points, const ax_lane3* restrict y,
                    ax_lane3* restrict p)
{
    (void)place, (void)points;
    for (int l = 0; l < AX_W; ++l) {
        double height[2], mean[3];
        for (int k = 0; k < 2; ++k) {
            height[k] = 0;
            for (int i = 0; i < 3; ++i)
                height[k] += block[PLANE_UNIT + i][l] * (y[k][i][l] - block[PLANE_POINT + i][l]);
        }
        // along the plane both get the mean, across it plus and minus half the difference of their heights
        double across = 0.5 * (height[0] - height[1]);
        for (int i = 0; i < 3; ++i) {
            double n = block[PLANE_UNIT + i][l];
            mean[i] = 0.5 * ((y[0][i][l] - height[0] * n) + (y[1][i][l] - height[1] * n));
            p[0][i][l] = mean[i] + across * n, p[1][i][l] = mean[i] - across * n;
        }
    }
}

const ax_constraint_type ax_constraint_mirror = {
    .name = "mirror",
    .doc = "Keeps two points mirror images of each other in a given plane.",
    .reference = "Bouaziz et al. 2012, Shape-Up (symmetry)",
    .pattern = AX_ROWS_POINTS,
    .least_points = 2,
    .most_points = 2,
    .lanes = PLANE_LANES,
    .parameters = ax_given_plane_parameters,
    .parameter_count = sizeof ax_given_plane_parameters / sizeof *ax_given_plane_parameters,
    .prepare = ax_given_plane_prepare,
    .project = project,
};
