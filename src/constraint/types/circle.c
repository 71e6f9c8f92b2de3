// circle: keeps points on one circle: a hole of the linkage that is fully open (of all polygons with given sides the
// one inscribed in a circle has the largest area). The published projection of ShapeOp: best plane, algebraic circle
// fit in it (Kasa 1976), then radially; the mean of the result, which no equation sees, is taken out. It is not the
// nearest circle: that minimises distances, this one squares of powers. The two differ by the second order of the
// distance.
#include "constraint/eigen3.h"

// Least 4 det / trace^2 of the points' 2 x 2 matrix at which a circle is fitted; below, points are nearly on a line and
// go to the plane only. ShapeOp's bound is det > 1e-5 in absolute units; this is the same for a regular hexagon with
// edges of length 1.
static const double ROUND = 4e-5 / 36;

static void project(const ax_lane* restrict block, const ax_place* place, int points, const ax_lane3* restrict y,
                    ax_lane3* restrict p)
{
    (void)block, (void)place;
    ax_lane3 axis[3];
    ax_lane uu = {0}, uv = {0}, vv = {0}, cu = {0}, cv = {0}, mean[2] = {0}, radius, curved;
    ax_principal_axes(points, y, axis);

    // coordinates in the plane, kept in p, and moments
    for (int k = 0; k < points; ++k)
        for (int l = 0; l < AX_W; ++l) {
            double a = y[k][0][l], b = y[k][1][l], c = y[k][2][l];
            double u = axis[0][0][l] * a + axis[0][1][l] * b + axis[0][2][l] * c;
            double v = axis[1][0][l] * a + axis[1][1][l] * b + axis[1][2][l] * c, square = u * u + v * v;
            p[k][0][l] = u, p[k][1][l] = v;
            uu[l] += u * u, uv[l] += u * v, vv[l] += v * v, cu[l] += u * square, cv[l] += v * square;
        }

    // centre and radius
    for (int l = 0; l < AX_W; ++l) {
        double trace = uu[l] + vv[l], s = trace > 0 ? 1 / trace : 0, a = uu[l] * s, b = uv[l] * s, d = vv[l] * s;
        double e = 0.5 * cu[l] * s, f = 0.5 * cv[l] * s, det = a * d - b * b;
        double inverse = det > 0 ? 1 / det : 0, g = inverse * (d * e - b * f), h = inverse * (a * f - b * e);
        cu[l] = g, cv[l] = h;
        radius[l] = sqrt(g * g + h * h + trace / points);
        curved[l] = 4 * det > ROUND ? 1.0 : 0.0;
    }
    for (int k = 0; k < points; ++k)
        for (int l = 0; l < AX_W; ++l) {
            double a = p[k][0][l], b = p[k][1][l], u = a - cu[l], v = b - cv[l], d = sqrt(u * u + v * v);
            double s = radius[l] / (d > 0 ? d : 1);
            u = s * (d > 0 ? u : 1), v *= s; // the centre itself has no direction
            u = curved[l] > 0 ? u : a, v = curved[l] > 0 ? v : b;
            p[k][0][l] = u, p[k][1][l] = v;
            mean[0][l] += u, mean[1][l] += v;
        }
    double inverse = 1.0 / points;
    for (int k = 0; k < points; ++k)
        for (int l = 0; l < AX_W; ++l) {
            double u = p[k][0][l] - inverse * mean[0][l], v = p[k][1][l] - inverse * mean[1][l];
            p[k][0][l] = u * axis[0][0][l] + v * axis[1][0][l];
            p[k][1][l] = u * axis[0][1][l] + v * axis[1][1][l];
            p[k][2][l] = u * axis[0][2][l] + v * axis[1][2][l];
        }
}

const ax_constraint_type ax_constraint_circle = {
    .name = "circle",
    .doc = "Keeps points on a common circle (algebraic fit in the best plane, then radially).",
    .reference = "Deuss et al. 2015, ShapeOp; I. Kasa 1976, A circle fitting procedure and its error analysis",
    .pattern = AX_ROWS_CENTRED,
    .least_points = 3,
    .most_points = AX_MOST_POINTS,
    .symmetry = AX_SYMMETRY_TRANSLATION | AX_SYMMETRY_ROTATION | AX_SYMMETRY_SCALE,
    .approximate = true,
    .project = project,
};
