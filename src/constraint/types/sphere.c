// sphere: keeps points on one sphere: algebraic fit of the centre (Kasa 1976 in three dimensions), then radially; the
// mean of the result, which no equation sees, is taken out. Coplanar points get the sphere through their circle.
#include "constraint/eigen3.h"

// Added to the normal matrix in units of its trace: centres across the plane of coplanar points stay finite.
static const double RIDGE = 1e-15;

static void project(const ax_lane* restrict block, const ax_place* place, int points, const ax_lane3* restrict y,
                    ax_lane3* restrict p)
{
    (void)block, (void)place;
    ax_lane sum[6] = {0}, c[3] = {0}, mean[3] = {0}, radius;
    for (int k = 0; k < points; ++k)
        for (int l = 0; l < AX_W; ++l) {
            double a = y[k][0][l], b = y[k][1][l], d = y[k][2][l], square = a * a + b * b + d * d;
            sum[0][l] += a * a, sum[1][l] += a * b, sum[2][l] += a * d;
            sum[3][l] += b * b, sum[4][l] += b * d, sum[5][l] += d * d;
            c[0][l] += a * square, c[1][l] += b * square, c[2][l] += d * square;
        }
    for (int l = 0; l < AX_W; ++l) {
        // 3 x 3 Cholesky (LDL') of the moments in units of their trace
        double trace = sum[0][l] + sum[3][l] + sum[5][l], s = trace > 0 ? 1 / trace : 0, h = 0.5 * s;
        double d0 = sum[0][l] * s + RIDGE, a = sum[1][l] * s / d0, b = sum[2][l] * s / d0;
        double d1 = sum[3][l] * s - a * a * d0, e = sum[4][l] * s - a * b * d0;
        d1 = (d1 > 0 ? d1 : 0) + RIDGE, e /= d1;
        double d2 = sum[5][l] * s - b * b * d0 - e * e * d1;
        d2 = (d2 > 0 ? d2 : 0) + RIDGE;
        double x = h * c[0][l], y1 = h * c[1][l] - a * x, z = (h * c[2][l] - b * x - e * y1) / d2;
        y1 = y1 / d1 - e * z, x = x / d0 - a * y1 - b * z;
        c[0][l] = x, c[1][l] = y1, c[2][l] = z;
        radius[l] = sqrt(x * x + y1 * y1 + z * z + trace / points);
    }
    for (int k = 0; k < points; ++k)
        for (int l = 0; l < AX_W; ++l) {
            double u = y[k][0][l] - c[0][l], v = y[k][1][l] - c[1][l], w = y[k][2][l] - c[2][l];
            double d = sqrt(u * u + v * v + w * w), s = radius[l] / (d > 0 ? d : 1);
            u = s * (d > 0 ? u : 1), v *= s, w *= s; // the centre itself has no direction
            p[k][0][l] = u, p[k][1][l] = v, p[k][2][l] = w;
            mean[0][l] += u, mean[1][l] += v, mean[2][l] += w;
        }
    double inverse = 1.0 / points;
    for (int k = 0; k < points; ++k)
        for (int i = 0; i < 3; ++i)
            for (int l = 0; l < AX_W; ++l)
                p[k][i][l] -= inverse * mean[i][l];
}

const ax_constraint_type ax_constraint_sphere = {
    .name = "sphere",
    .doc = "Keeps points on a common sphere (algebraic fit, then radially).",
    .reference = "Deuss et al. 2015, ShapeOp; I. Kasa 1976, A circle fitting procedure and its error analysis",
    .pattern = AX_ROWS_CENTRED,
    .least_points = 4,
    .most_points = AX_MOST_POINTS,
    .symmetry = AX_SYMMETRY_TRANSLATION | AX_SYMMETRY_ROTATION | AX_SYMMETRY_SCALE,
    .approximate = true,
    .project = project,
};
