// plane_given: keeps a point on a plane that is given, a wall or a floor; the hinges that lie on a mirror.
#include "constraint/eigen3.h"

enum { POINT, NORMAL = POINT + 3, UNIT = NORMAL + 3, LANES = UNIT + 3 };

static const ax_parameter parameters[] = {
    {.name = "point",
     .unit = "point",
     .doc = "any point of the plane",
     .standard = 0,
     .least = -1e12,
     .most = 1e12,
     .offset = POINT,
     .lanes = 3},
    {.name = "normal",
     .unit = "direction",
     .doc = "normal of the plane",
     .standard = 0,
     .least = -1e12,
     .most = 1e12,
     .offset = NORMAL,
     .lanes = 3},
};

static void prepare(ax_lane* restrict block, int points)
{
    (void)points;
    for (int l = 0; l < AX_W; ++l) {
        double n[3];
        ax_unit_direction(block + NORMAL, l, n);
        block[UNIT][l] = n[0], block[UNIT + 1][l] = n[1], block[UNIT + 2][l] = n[2];
    }
}

static void project(const ax_lane* restrict block, const ax_place* place, int points, const ax_lane3* restrict y,
                    ax_lane3* restrict p)
{
    (void)place, (void)points;
    for (int l = 0; l < AX_W; ++l) {
        double a = block[UNIT][l], b = block[UNIT + 1][l], c = block[UNIT + 2][l];
        double d = a * (y[0][0][l] - block[POINT][l]) + b * (y[0][1][l] - block[POINT + 1][l]) +
                   c * (y[0][2][l] - block[POINT + 2][l]);
        p[0][0][l] = y[0][0][l] - d * a, p[0][1][l] = y[0][1][l] - d * b, p[0][2][l] = y[0][2][l] - d * c;
    }
}

const ax_constraint_type ax_constraint_plane_given = {
    .name = "plane_given",
    .doc = "Keeps a point on a given plane.",
    .reference = "Bouaziz et al. 2012, Shape-Up (closest point on a reference)",
    .pattern = AX_ROWS_POINTS,
    .least_points = 1,
    .most_points = 1,
    .lanes = LANES,
    .parameters = parameters,
    .parameter_count = sizeof parameters / sizeof *parameters,
    .prepare = prepare,
    .project = project,
};
