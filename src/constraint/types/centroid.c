// centroid: pulls the mean of points to a target, and leaves the points free about it: a panel that turns on its place.
#include "constraint/constraint_type.h"

enum { TARGET, LANES = TARGET + 3 };

static const ax_parameter parameters[] = {
    {.name = "target",
     .unit = "point",
     .doc = "where the mean shall be",
     .standard = 0,
     .least = -1e12,
     .most = 1e12,
     .offset = TARGET,
     .lanes = 3},
};

static double coefficient(int points, int point)
{
    (void)point;
    return 1.0 / points;
}

static void rest(ax_lane* restrict block, int points, const ax_lane3* restrict x)
{
    for (int i = 0; i < 3; ++i)
        for (int l = 0; l < AX_W; ++l) {
            double sum = 0;
            for (int k = 0; k < points; ++k)
                sum += x[k][i][l];
            block[TARGET + i][l] = sum / points;
        }
}

static void project(const ax_lane* restrict block, const ax_place* place, int points, const ax_lane3* restrict y,
                    ax_lane3* restrict p)
{
    (void)place, (void)points, (void)y;
    for (int i = 0; i < 3; ++i)
        for (int l = 0; l < AX_W; ++l)
            p[0][i][l] = block[TARGET + i][l];
}

const ax_constraint_type ax_constraint_centroid = {
    .name = "centroid",
    .doc = "Pulls the mean of points to a target.",
    .reference = "Bouaziz et al. 2012, Shape-Up (closeness, of a mean)",
    .pattern = AX_ROWS_SUM,
    .least_points = 1,
    .most_points = AX_MOST_POINTS,
    .lanes = LANES,
    .parameters = parameters,
    .parameter_count = sizeof parameters / sizeof *parameters,
    .coefficient = coefficient,
    .rest = rest,
    .project = project,
};
