// laplacian: pulls the first point to the mean of the others.
#include "constraint/constraint_type.h"

static double coefficient(int points, int point)
{
    return point == 0 ? 1 : -1.0 / (points - 1);
}

static void project(const ax_lane* restrict block, const ax_place* place, int points, const ax_lane3* restrict y,
                    ax_lane3* restrict p)
{
    (void)block, (void)place, (void)points, (void)y;
    for (int i = 0; i < 3; ++i)
        for (int l = 0; l < AX_W; ++l)
            p[0][i][l] = 0;
}

const ax_constraint_type ax_constraint_laplacian = {
    .name = "laplacian",
    .doc = "Pulls the first point to the mean of the others.",
    .reference = "Bouaziz et al. 2012, Shape-Up (Laplacian fairness)",
    .pattern = AX_ROWS_SUM,
    .least_points = 2,
    .most_points = AX_MOST_POINTS,
    .symmetry = AX_SYMMETRY_TRANSLATION | AX_SYMMETRY_ROTATION | AX_SYMMETRY_SCALE,
    .coefficient = coefficient,
    .project = project,
};
