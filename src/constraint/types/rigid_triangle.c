// rigid_triangle: keeps a triangle congruent to a template, a panel of the linkage; with lo < hi similar to it, its
// size in a range. Shared corners carry no orientation in space: a panel can be turned over. In the plane use
// flat_triangle.
#include "constraint/triangle.h"

static void project(const ax_lane* restrict block, const ax_place* place, int points, const ax_lane3* restrict y,
                    ax_lane3* restrict p)
{
    (void)place, (void)points;
    for (int l = 0; l < AX_W; ++l) {
        double u[3], v[3], r[3], z[2];
        ax_triangle_frame(y, l, u, v, r);
        ax_triangle_fit(block, l, (double[2]){r[0], 0}, r + 1, z);
        double a = block[AX_TRIANGLE_W1][l], b = block[AX_TRIANGLE_W1 + 1][l];
        double c = block[AX_TRIANGLE_W2][l], d = block[AX_TRIANGLE_W2 + 1][l];
        double x1 = a * z[0] - b * z[1], y1 = a * z[1] + b * z[0], x2 = c * z[0] - d * z[1], y2 = c * z[1] + d * z[0];
        for (int i = 0; i < 3; ++i) {
            double q = x1 * u[i] + y1 * v[i], s = x2 * u[i] + y2 * v[i];
            p[0][i][l] = -(q + s), p[1][i][l] = q, p[2][i][l] = s;
        }
    }
}

const ax_constraint_type ax_constraint_rigid_triangle = {
    .name = "rigid_triangle",
    .doc = "Keeps a triangle congruent to its template, or similar to it with its size in a range.",
    .reference = "Bouaziz et al. 2012, Shape-Up (rigid, similar); B. K. P. Horn 1987, Closed-form solution of absolute "
                 "orientation",
    .pattern = AX_ROWS_CENTRED,
    .least_points = 3,
    .most_points = 3,
    .symmetry = AX_SYMMETRY_TRANSLATION | AX_SYMMETRY_ROTATION,
    .lanes = AX_TRIANGLE_LANES,
    .parameters = ax_triangle_parameters,
    .parameter_count = AX_TRIANGLE_PARAMETERS,
    .rest = ax_triangle_rest,
    .prepare = ax_triangle_prepare,
    .project = project,
};
