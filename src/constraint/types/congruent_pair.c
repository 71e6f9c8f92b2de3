// congruent_pair: keeps two edges of equal length, the flat and the deployed copy of one edge of a panel: both go to
// their mean.
#include "constraint/constraint_type.h"

static void project(const ax_lane* restrict block, const ax_place* place, int points, const ax_lane3* restrict y,
                    ax_lane3* restrict p)
{
    (void)block, (void)place, (void)points;
    for (int l = 0; l < AX_W; ++l) {
        double a = sqrt(y[0][0][l] * y[0][0][l] + y[0][1][l] * y[0][1][l] + y[0][2][l] * y[0][2][l]);
        double b = sqrt(y[1][0][l] * y[1][0][l] + y[1][1][l] * y[1][1][l] + y[1][2][l] * y[1][2][l]);
        double mean = 0.5 * (a + b), s = mean / (a > 0 ? a : 1), t = mean / (b > 0 ? b : 1);

        // an edge of no length has no direction: +x
        p[0][0][l] = s * (a > 0 ? y[0][0][l] : 1), p[0][1][l] = s * y[0][1][l], p[0][2][l] = s * y[0][2][l];
        p[1][0][l] = t * (b > 0 ? y[1][0][l] : 1), p[1][1][l] = t * y[1][1][l], p[1][2][l] = t * y[1][2][l];
    }
}

const ax_constraint_type ax_constraint_congruent_pair = {
    .name = "congruent_pair",
    .doc = "Keeps two edges of equal length: an edge of the flat state and the same edge of the deployed one.",
    .reference = "Bouaziz et al. 2012, Shape-Up (projection onto a common length)",
    .pattern = AX_ROWS_EDGES,
    .least_points = 4,
    .most_points = 4,
    .symmetry = AX_SYMMETRY_TRANSLATION | AX_SYMMETRY_ROTATION | AX_SYMMETRY_SCALE,
    .project = project,
};
