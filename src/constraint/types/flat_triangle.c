// flat_triangle: a rigid_triangle in the plane z = 0 that keeps its corners counter-clockwise. A triangle that an edit
// has turned inside out is turned back; fitted in space it would stay turned over for ever.
#include "constraint/triangle.h"

static void project(const ax_lane* restrict block, const ax_place* place, int points, const ax_lane3* restrict y,
                    ax_lane3* restrict p)
{
    (void)place, (void)points;
    for (int l = 0; l < AX_W; ++l) {
        double e[2] = {y[1][0][l] - y[0][0][l], y[1][1][l] - y[0][1][l]};
        double f[2] = {y[2][0][l] - y[0][0][l], y[2][1][l] - y[0][1][l]}, z[2];
        ax_triangle_fit(block, l, e, f, z);
        double a = block[AX_TRIANGLE_W1][l], b = block[AX_TRIANGLE_W1 + 1][l];
        double c = block[AX_TRIANGLE_W2][l], d = block[AX_TRIANGLE_W2 + 1][l];
        double x1 = a * z[0] - b * z[1], y1 = a * z[1] + b * z[0], x2 = c * z[0] - d * z[1], y2 = c * z[1] + d * z[0];
        p[0][0][l] = -(x1 + x2), p[1][0][l] = x1, p[2][0][l] = x2;
        p[0][1][l] = -(y1 + y2), p[1][1][l] = y1, p[2][1][l] = y2;
        p[0][2][l] = p[1][2][l] = p[2][2][l] = 0;
    }
}

const ax_constraint_type ax_constraint_flat_triangle = {
    .name = "flat_triangle",
    .doc = "Keeps a triangle of the flat state congruent to its template (or similar, in a range of sizes), "
           "counter-clockwise.",
    .reference = "Bouaziz et al. 2012, Shape-Up (rigid, similar), in complex numbers",
    .pattern = AX_ROWS_CENTRED,
    .least_points = 3,
    .most_points = 3,
    .symmetry = AX_SYMMETRY_TRANSLATION | AX_SYMMETRY_ROTATION,
    .flat = true,
    .lanes = AX_TRIANGLE_LANES,
    .parameters = ax_triangle_parameters,
    .parameter_count = AX_TRIANGLE_PARAMETERS,
    .rest = ax_triangle_rest,
    .prepare = ax_triangle_prepare,
    .project = project,
};
