// rotation_symmetry: keeps n points the images of one under the turns by 2 pi / n about an axis, in that order. Turned
// back to the first they have a mean; its images are the nearest symmetric points.
#include "constraint/eigen3.h"

enum { POINT, AXIS = POINT + 3, FRAME = AXIS + 3, COS = FRAME + 9, SIN, LANES };

static const ax_parameter parameters[] = {
    {.name = "point",
     .unit = "point",
     .doc = "any point of the axis",
     .standard = 0,
     .least = -1e12,
     .most = 1e12,
     .offset = POINT,
     .lanes = 3},
    {.name = "axis",
     .unit = "direction",
     .doc = "direction of the axis; seen against it the points follow each other counter-clockwise",
     .standard = 0,
     .least = -1e12,
     .most = 1e12,
     .offset = AXIS,
     .lanes = 3},
};

static void prepare(ax_lane* restrict block, int points)
{
    double c = cos(2 * AX_PI / points), s = sin(2 * AX_PI / points);
    for (int l = 0; l < AX_W; ++l) {
        double u[3], v[3], w[3];
        ax_unit_direction(block + AXIS, l, w);
        ax_perpendicular(w, u, v);
        for (int i = 0; i < 3; ++i)
            block[FRAME + i][l] = u[i], block[FRAME + 3 + i][l] = v[i], block[FRAME + 6 + i][l] = w[i];
        block[COS][l] = c, block[SIN][l] = s;
    }
}

static void project(const ax_lane* restrict block, const ax_place* place, int points, const ax_lane3* restrict y,
                    ax_lane3* restrict p)
{
    (void)place;
    const ax_lane *u = block + FRAME, *v = u + 3, *w = v + 3;
    double inverse = 1.0 / points;
    ax_lane turn[2], mean[3] = {0};
    for (int l = 0; l < AX_W; ++l)
        turn[0][l] = 1, turn[1][l] = 0;
    for (int k = 0; k < points; ++k)
        for (int l = 0; l < AX_W; ++l) {
            double a = y[k][0][l] - block[POINT][l], b = y[k][1][l] - block[POINT + 1][l];
            double c = y[k][2][l] - block[POINT + 2][l], re = turn[0][l], im = turn[1][l];
            double x = u[0][l] * a + u[1][l] * b + u[2][l] * c, z = v[0][l] * a + v[1][l] * b + v[2][l] * c;
            mean[0][l] += inverse * (re * x + im * z), mean[1][l] += inverse * (re * z - im * x);
            mean[2][l] += inverse * (w[0][l] * a + w[1][l] * b + w[2][l] * c);
            turn[0][l] = re * block[COS][l] - im * block[SIN][l], turn[1][l] = re * block[SIN][l] + im * block[COS][l];
        }
    for (int k = 0; k < points; ++k)
        for (int l = 0; l < AX_W; ++l) {
            double x = mean[0][l], z = mean[1][l], h = mean[2][l];
            p[k][0][l] = block[POINT][l] + x * u[0][l] + z * v[0][l] + h * w[0][l];
            p[k][1][l] = block[POINT + 1][l] + x * u[1][l] + z * v[1][l] + h * w[1][l];
            p[k][2][l] = block[POINT + 2][l] + x * u[2][l] + z * v[2][l] + h * w[2][l];
            mean[0][l] = x * block[COS][l] - z * block[SIN][l], mean[1][l] = x * block[SIN][l] + z * block[COS][l];
        }
}

const ax_constraint_type ax_constraint_rotation_symmetry = {
    .name = "rotation_symmetry",
    .doc = "Keeps n points the images of one under turns by a full turn / n about a given axis.",
    .reference = "Bouaziz et al. 2012, Shape-Up (symmetry)",
    .pattern = AX_ROWS_POINTS,
    .least_points = 2,
    .most_points = AX_MOST_POINTS,
    .lanes = LANES,
    .parameters = parameters,
    .parameter_count = sizeof parameters / sizeof *parameters,
    .prepare = prepare,
    .project = project,
};
