// sphere: keeps points on one sphere: algebraic fit of the centre (Kasa 1976 in three dimensions), then radially; the
// mean of the result, which no equation sees, is taken out. Coplanar points get the sphere about the centre of their circle.
#include "constraint/eigen3.h"

// Share of the squares below which points have no extent along an axis. The centre could then lie anywhere on it; it
// stays in the plane of the points, so that they stay there too.
static const double FLAT = 1e-10;

static void project(const ax_lane* restrict block, const ax_place* place, int points, const ax_lane3* restrict y,
                    ax_lane3* restrict p)
{
    (void)block, (void)place;
    ax_lane3 axis[3], c = {{0}};
    ax_lane mean[3] = {0}, trace = {0}, radius;
    ax_principal_axes(points, y, axis);
    for (int k = 0; k < points; ++k)
        for (int l = 0; l < AX_W; ++l)
            trace[l] += y[k][0][l] * y[k][0][l] + y[k][1][l] * y[k][1][l] + y[k][2][l] * y[k][2][l];
    for (int a = 0; a < 3; ++a) { // the normal equations are diagonal along the axes
        ax_lane moment = {0}, side = {0};
        for (int k = 0; k < points; ++k)
            for (int l = 0; l < AX_W; ++l) {
                double square = y[k][0][l] * y[k][0][l] + y[k][1][l] * y[k][1][l] + y[k][2][l] * y[k][2][l];
                double along = axis[a][0][l] * y[k][0][l] + axis[a][1][l] * y[k][1][l] + axis[a][2][l] * y[k][2][l];
                moment[l] += along * along, side[l] += along * (square / (trace[l] > 0 ? trace[l] : 1));
            }
        for (int l = 0; l < AX_W; ++l) {
            double share = moment[l] / (trace[l] > 0 ? trace[l] : 1), at = share > FLAT ? 0.5 * side[l] / share : 0;
            for (int i = 0; i < 3; ++i)
                c[i][l] += at * axis[a][i][l];
        }
    }
    for (int l = 0; l < AX_W; ++l)
        radius[l] = sqrt(c[0][l] * c[0][l] + c[1][l] * c[1][l] + c[2][l] * c[2][l] + trace[l] / points);
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
