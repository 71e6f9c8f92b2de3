// line: keeps points on one straight line, whichever fits best.
#include "constraint/eigen3.h"

static void project(const ax_lane* restrict block, const ax_place* place, int points, const ax_lane3* restrict y,
                    ax_lane3* restrict p)
{
    (void)block, (void)place;
    ax_lane3 axis[3];
    ax_principal_axes(points, y, axis);
    for (int k = 0; k < points; ++k)
        for (int l = 0; l < AX_W; ++l) {
            double a = axis[0][0][l], b = axis[0][1][l], c = axis[0][2][l];
            double d = a * y[k][0][l] + b * y[k][1][l] + c * y[k][2][l];
            p[k][0][l] = d * a, p[k][1][l] = d * b, p[k][2][l] = d * c;
        }
}

const ax_constraint_type ax_constraint_line = {
    .name = "line",
    .doc = "Keeps points on a common straight line.",
    .reference =
        "Bouaziz et al. 2012, Shape-Up (line); D. Eberly 2014, A Robust Eigensolver for 3 x 3 Symmetric Matrices",
    .pattern = AX_ROWS_CENTRED,
    .least_points = 2,
    .most_points = AX_MOST_POINTS,
    .symmetry = AX_SYMMETRY_TRANSLATION | AX_SYMMETRY_ROTATION | AX_SYMMETRY_SCALE,
    .project = project,
};
