// plane: keeps points in one plane, whichever fits best: the hinges of a planar arch.
#include "constraint/eigen3.h"

static void project(const ax_lane* restrict block, const ax_place* place, int points, const ax_lane3* restrict y,
                    ax_lane3* restrict p)
{
    (void)block, (void)place;
    ax_lane3 axis[3];
    ax_principal_axes(points, y, axis);
    for (int k = 0; k < points; ++k)
        for (int l = 0; l < AX_W; ++l) {
            double a = axis[2][0][l], b = axis[2][1][l], c = axis[2][2][l];
            double d = a * y[k][0][l] + b * y[k][1][l] + c * y[k][2][l];
            p[k][0][l] = y[k][0][l] - d * a, p[k][1][l] = y[k][1][l] - d * b, p[k][2][l] = y[k][2][l] - d * c;
        }
}

const ax_constraint_type ax_constraint_plane = {
    .name = "plane",
    .doc = "Keeps points in a common plane.",
    .reference =
        "Bouaziz et al. 2012, Shape-Up (plane); D. Eberly 2014, A Robust Eigensolver for 3 x 3 Symmetric Matrices",
    .pattern = AX_ROWS_CENTRED,
    .least_points = 3,
    .most_points = AX_MOST_POINTS,
    .symmetry = AX_SYMMETRY_TRANSLATION | AX_SYMMETRY_ROTATION | AX_SYMMETRY_SCALE,
    .project = project,
};
