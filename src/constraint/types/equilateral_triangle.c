// equilateral_triangle: keeps a triangle similar to the equilateral one, its edge in a range. With w = exp(2 pi i / 3)
// every triangle of its own plane is alpha w^k + beta w^-k about its centre: the equilateral part and the rest,
// perpendicular to each other.
#include "constraint/triangle.h"

enum { LO, HI, LENGTH, LANES };

static const ax_parameter parameters[] = {
    {.name = "lo",
     .unit = "1",
     .doc = "shortest edge / length; 0: no bound",
     .standard = 0,
     .least = 0,
     .most = 1,
     .offset = LO,
     .lanes = 1},
    {.name = "hi",
     .unit = "1",
     .doc = "longest edge / length; 1e6 is as good as no bound",
     .standard = 1e6,
     .least = 1,
     .most = 1e6,
     .offset = HI,
     .lanes = 1},
    {.name = "length",
     .unit = "length",
     .doc = "edge to which the bounds refer",
     .standard = 1,
     .least = 0,
     .most = 1e12,
     .offset = LENGTH,
     .lanes = 1},
};

// The edge of the equilateral triangle with the same sum of squares.
static void rest(ax_lane* restrict block, int points, const ax_lane3* restrict x)
{
    (void)points;
    for (int l = 0; l < AX_W; ++l) {
        double sum = 0;
        for (int i = 0; i < 3; ++i) {
            double a = x[1][i][l] - x[0][i][l], b = x[2][i][l] - x[1][i][l], c = x[0][i][l] - x[2][i][l];
            sum += a * a + b * b + c * c;
        }
        block[LENGTH][l] = sqrt(sum / 3);
    }
}

static void project(const ax_lane* restrict block, const ax_place* place, int points, const ax_lane3* restrict y,
                    ax_lane3* restrict p)
{
    (void)place, (void)points;
    const double h = sqrt(0.75); // w = -1/2 + i h
    for (int l = 0; l < AX_W; ++l) {
        double u[3], v[3], r[3];
        ax_triangle_frame(y, l, u, v, r);
        double re = (-0.5 * (r[0] + r[1]) - h * r[2]) / 3, im = (h * (r[1] - r[0]) - 0.5 * r[2]) / 3; // alpha
        double radius = sqrt(re * re + im * im), unit = block[LENGTH][l] / (2 * h);
        double lo = block[LO][l] * unit, hi = block[HI][l] * unit;
        double want = radius < lo ? lo : (radius > hi ? hi : radius), s = want / (radius > 0 ? radius : 1);
        re = s * (radius > 0 ? re : 1), im *= s;
        double re1 = -0.5 * re - h * im, im1 = h * re - 0.5 * im; // alpha w
        for (int i = 0; i < 3; ++i) {
            double a = re * u[i] + im * v[i], b = re1 * u[i] + im1 * v[i];
            p[0][i][l] = a, p[1][i][l] = b, p[2][i][l] = -(a + b);
        }
    }
}

const ax_constraint_type ax_constraint_equilateral_triangle = {
    .name = "equilateral_triangle",
    .doc = "Keeps a triangle equilateral, its edge free or in a range around a length.",
    .reference = "Bouaziz et al. 2012, Shape-Up (similar to a regular polygon)",
    .pattern = AX_ROWS_CENTRED,
    .least_points = 3,
    .most_points = 3,
    .symmetry = AX_SYMMETRY_TRANSLATION | AX_SYMMETRY_ROTATION,
    .lanes = LANES,
    .parameters = parameters,
    .parameter_count = sizeof parameters / sizeof *parameters,
    .rest = rest,
    .project = project,
};
