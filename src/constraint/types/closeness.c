// closeness: pulls a point to a target. A support that does not move is the same thing with a large weight.
#include "constraint/constraint_type.h"

enum { TARGET, LANES = TARGET + 3 };

static const ax_parameter parameters[] = {
    {.name = "target",
     .unit = "point",
     .doc = "where the point shall be",
     .standard = 0,
     .least = -1e12,
     .most = 1e12,
     .offset = TARGET,
     .lanes = 3},
};

static void rest(ax_lane* restrict block, int points, const ax_lane3* restrict x)
{
    (void)points;
    for (int i = 0; i < 3; ++i)
        for (int l = 0; l < AX_W; ++l)
            block[TARGET + i][l] = x[0][i][l];
}

static void project(const ax_lane* restrict block, const ax_place* place, int points, const ax_lane3* restrict y,
                    ax_lane3* restrict p)
{
    (void)place, (void)points, (void)y;
    for (int i = 0; i < 3; ++i)
        for (int l = 0; l < AX_W; ++l)
            p[0][i][l] = block[TARGET + i][l];
}

const ax_constraint_type ax_constraint_closeness = {
    .name = "closeness",
    .doc = "Pulls a point to a target; with a large weight a fixed support.",
    .reference = "Bouaziz et al. 2012, Shape-Up (closeness)",
    .pattern = AX_ROWS_POINTS,
    .least_points = 1,
    .most_points = 1,
    .lanes = LANES,
    .parameters = parameters,
    .parameter_count = sizeof parameters / sizeof *parameters,
    .rest = rest,
    .project = project,
};
