// edge_length: keeps the length of an edge between `lo` and `hi` times its rest length. lo = hi = 1 is an inextensible
// linkage edge; lo < 1 lets it buckle.
#include "constraint/constraint_type.h"

enum { LO, HI, LENGTH, LANES };

static const ax_parameter parameters[] = {
    {.name = "lo",
     .unit = "1",
     .doc = "shortest length / rest length",
     .standard = 1,
     .least = 0,
     .most = 1,
     .offset = LO,
     .lanes = 1},
    {.name = "hi",
     .unit = "1",
     .doc = "longest length / rest length",
     .standard = 1,
     .least = 1,
     .most = 10,
     .offset = HI,
     .lanes = 1},
    {.name = "length",
     .unit = "length",
     .doc = "rest length",
     .standard = 1,
     .least = 0,
     .most = 1e12,
     .offset = LENGTH,
     .lanes = 1},
};

static void rest(ax_lane* restrict block, int points, const ax_lane3* restrict x)
{
    (void)points;
    for (int l = 0; l < AX_W; ++l) {
        double dx = x[1][0][l] - x[0][0][l], dy = x[1][1][l] - x[0][1][l], dz = x[1][2][l] - x[0][2][l];
        block[LENGTH][l] = sqrt(dx * dx + dy * dy + dz * dz);
    }
}

static void project(const ax_lane* restrict block, const ax_place* place, int points, const ax_lane3* restrict y,
                    ax_lane3* restrict p)
{
    (void)place, (void)points;
    for (int l = 0; l < AX_W; ++l) {
        double x = y[0][0][l], yy = y[0][1][l], z = y[0][2][l];
        double length = sqrt(x * x + yy * yy + z * z);
        double lo = block[LO][l] * block[LENGTH][l], hi = block[HI][l] * block[LENGTH][l];
        double want = length < lo ? lo : (length > hi ? hi : length);

        // coincident points have no direction: +x, so that the result is finite and repeatable
        double s = want / (length > 0 ? length : 1);
        p[0][0][l] = s * (length > 0 ? x : 1);
        p[0][1][l] = s * yy;
        p[0][2][l] = s * z;
    }
}

const ax_constraint_type ax_constraint_edge_length = {
    .name = "edge_length",
    .doc = "Keeps the length of an edge inside a range around its rest length.",
    .reference = "Bouaziz et al. 2014, Projective Dynamics (strain limiting, one dimension)",
    .pattern = AX_ROWS_EDGES,
    .least_points = 2,
    .most_points = 2,
    .symmetry = AX_SYMMETRY_TRANSLATION | AX_SYMMETRY_ROTATION,
    .lanes = LANES,
    .parameters = parameters,
    .parameter_count = sizeof parameters / sizeof *parameters,
    .rest = rest,
    .project = project,
};
