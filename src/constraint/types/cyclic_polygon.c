// cyclic_polygon: keeps a hole congruent to the polygon of given sides that is inscribed in a circle: the hole fully
// open. Where circle lets corners gather on it, this fixes their places too, and pulls the edges to their lengths.
//
// The template depends on the sides alone and is prepared; the fit is the polar factor of a 3 x 2 matrix, a QR
// factorisation and one rotation (no singular values).
#include "constraint/cyclic.h"
#include "constraint/eigen3.h"

enum { MOST = AX_CYCLIC_MOST, SIDES = 0, TEMPLATE = SIDES + MOST, LANES = TEMPLATE + 2 * MOST };

static const ax_parameter parameters[] = {
    {.name = "sides",
     .unit = "length",
     .doc = "side k from point k to the next one; as many count as there are points",
     .standard = 1,
     .least = 0,
     .most = 1e12,
     .offset = SIDES,
     .lanes = MOST},
};

static void rest(ax_lane* restrict block, int points, const ax_lane3* restrict x)
{
    for (int k = 0; k < points; ++k)
        for (int l = 0; l < AX_W; ++l) {
            int j = (k + 1) % points;
            double a[3] = {x[j][0][l] - x[k][0][l], x[j][1][l] - x[k][1][l], x[j][2][l] - x[k][2][l]};
            block[SIDES + k][l] = ax_norm3(a);
        }
}

static void prepare(ax_lane* restrict block, int points)
{
    for (int l = 0; l < AX_W; ++l) {
        double side[MOST] = {0}, corner[MOST][2] = {{0}};
        for (int k = 0; k < points; ++k)
            side[k] = block[SIDES + k][l];
        ax_cyclic_inscribe(points, side, corner);
        for (int k = 0; k < points; ++k)
            block[TEMPLATE + 2 * k][l] = corner[k][0], block[TEMPLATE + 2 * k + 1][l] = corner[k][1];
    }
}

static void project(const ax_lane* restrict block, const ax_place* place, int points, const ax_lane3* restrict y,
                    ax_lane3* restrict p)
{
    (void)place;
    ax_lane3 a = {0}, b = {0}; // columns of the correlation
    for (int k = 0; k < points; ++k)
        for (int i = 0; i < 3; ++i)
            for (int l = 0; l < AX_W; ++l) {
                a[i][l] += block[TEMPLATE + 2 * k][l] * y[k][i][l];
                b[i][l] += block[TEMPLATE + 2 * k + 1][l] * y[k][i][l];
            }
    for (int l = 0; l < AX_W; ++l) {
        double m[3] = {a[0][l], a[1][l], a[2][l]}, n[3] = {b[0][l], b[1][l], b[2][l]}, u[3], v[3], r[3];
        ax_frame(m, n, u, v, r);

        // the triangle r has determinant >= 0, so its polar factor is a rotation
        double c = r[0] + r[2], s = -r[1], length = sqrt(c * c + s * s), inverse = 1 / (length > 0 ? length : 1);
        c = length > 0 ? c * inverse : 1, s *= inverse;
        for (int i = 0; i < 3; ++i)
            a[i][l] = c * u[i] + s * v[i], b[i][l] = c * v[i] - s * u[i];
    }
    for (int k = 0; k < points; ++k)
        for (int i = 0; i < 3; ++i)
            for (int l = 0; l < AX_W; ++l)
                p[k][i][l] = block[TEMPLATE + 2 * k][l] * a[i][l] + block[TEMPLATE + 2 * k + 1][l] * b[i][l];
}

const ax_constraint_type ax_constraint_cyclic_polygon = {
    .name = "cyclic_polygon",
    .doc = "Keeps a hole congruent to the polygon of its sides that is inscribed in a circle.",
    .reference = "I. Niven 1981, Maxima and Minima Without Calculus; B. K. P. Horn 1987, Closed-form solution of "
                 "absolute orientation",
    .pattern = AX_ROWS_CENTRED,
    .least_points = 3,
    .most_points = MOST,
    .symmetry = AX_SYMMETRY_TRANSLATION | AX_SYMMETRY_ROTATION,
    .lanes = LANES,
    .parameters = parameters,
    .parameter_count = sizeof parameters / sizeof *parameters,
    .rest = rest,
    .prepare = prepare,
    .project = project,
};
