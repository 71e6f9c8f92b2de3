// mouth_angle: keeps the angle from the first arm of a hinge to its second, counter-clockwise in the flat state,
// between two bounds: the mouth of a slit. The angle is signed: panels that have passed through each other are pushed
// apart again, which an unsigned angle (ShapeOp's) cannot see.
//
// Outside the bounds both arms turn to the nearer one with their lengths kept, the nearest way to do so: with arms a, b
// as complex numbers and the bound's angle t the new first arm points along |a| a + |b| b exp(-it); arms of equal
// length turn by half the violation each. Arms may also shrink to come nearer still (the nearest rows of all do, by the
// cosine of their turn), but a mouth that is far out would then shrink them to nothing, and the lengths belong to the
// panels.
#include "constraint/constraint_type.h"

enum { LO, HI, AT_LO, AT_HI = AT_LO + 2, MIDDLE = AT_HI + 2, WIDE = MIDDLE + 2, LANES };

static const ax_parameter parameters[] = {
    {.name = "lo",
     .unit = "rad",
     .doc = "smallest angle; 0: arms on each other, negative: overlap",
     .standard = 0,
     .least = -AX_PI,
     .most = AX_PI,
     .offset = LO,
     .lanes = 1},
    {.name = "hi",
     .unit = "rad",
     .doc = "largest angle; a third of a full turn: fully open",
     .standard = 2 * AX_PI / 3,
     .least = -AX_PI,
     .most = 2 * AX_PI,
     .offset = HI,
     .lanes = 1},
};

// Bounds that cross meet in their middle; bounds a full turn apart bound nothing.
static void prepare(ax_lane* restrict block, int points)
{
    (void)points;
    for (int l = 0; l < AX_W; ++l) {
        double middle = 0.5 * (block[LO][l] + block[HI][l]), half = ax_clamp(block[HI][l] - middle, 0, AX_PI);
        double angle[3] = {middle - half, middle + half, middle};
        for (int k = 0; k < 3; ++k)
            block[AT_LO + 2 * k][l] = cos(angle[k]), block[AT_LO + 2 * k + 1][l] = sin(angle[k]);
        block[WIDE][l] = half > AX_PI / 2;
        // sin(-pi) and sin(pi) differ in sign
        block[AT_LO + 1][l] = half < AX_PI ? block[AT_LO + 1][l] : block[AT_HI + 1][l];
    }
}

static void project(const ax_lane* restrict block, const ax_place* place, int points, const ax_lane3* restrict y,
                    ax_lane3* restrict p)
{
    (void)place, (void)points;
    for (int l = 0; l < AX_W; ++l) {
        double ax = y[0][0][l], ay = y[0][1][l], bx = y[1][0][l], by = y[1][1][l];
        double re = ax * bx + ay * by, im = ax * by - ay * bx; // b / a but for its length

        // which side of each bound and of the middle b is on, seen from a
        double lo = im * block[AT_LO][l] - re * block[AT_LO + 1][l];
        double hi = im * block[AT_HI][l] - re * block[AT_HI + 1][l];
        double side = im * block[MIDDLE][l] - re * block[MIDDLE + 1][l];
        double front = re * block[MIDDLE][l] + im * block[MIDDLE + 1][l];
        double above = lo >= 0 ? 1.0 : 0.0, below = hi <= 0 ? 1.0 : 0.0, ahead = front >= 0 ? 1.0 : 0.0;
        double inside = block[WIDE][l] > 0 ? above + below : above * below * ahead;

        // first arm along |a| a + |b| b exp(-it), scaled: products of four coordinates overflow
        double c = side > 0 ? block[AT_HI][l] : block[AT_LO][l],
               s = side > 0 ? block[AT_HI + 1][l] : block[AT_LO + 1][l];
        double a = sqrt(ax * ax + ay * ay), b = sqrt(bx * bx + by * by), sum = a + b;
        double unit = sum > 0 ? 1 / sum : 0, f = a * unit, g = b * unit;
        double x = f * (unit * ax) + g * (unit * (c * bx + s * by)),
               z = f * (unit * ay) + g * (unit * (c * by - s * bx));
        double n = sqrt(x * x + z * z), inverse = n > 0 ? 1 / n : 0;
        x = n > 0 ? x * inverse : 1, z *= inverse; // opposite to the bound: any direction
        p[0][0][l] = inside > 0 ? ax : a * x, p[0][1][l] = inside > 0 ? ay : a * z, p[0][2][l] = 0;
        double u = b * (c * x - s * z), v = b * (c * z + s * x);
        p[1][0][l] = inside > 0 ? bx : u, p[1][1][l] = inside > 0 ? by : v, p[1][2][l] = 0;
    }
}

const ax_constraint_type ax_constraint_mouth_angle = {
    .name = "mouth_angle",
    .doc = "Keeps the signed angle between two arms of a flat hinge in a range (nearest with the lengths of the arms "
           "kept).",
    .reference = "Deuss et al. 2015, ShapeOp (angle), made signed",
    .pattern = AX_ROWS_ARMS,
    .least_points = 3,
    .most_points = 3,
    .symmetry = AX_SYMMETRY_TRANSLATION | AX_SYMMETRY_ROTATION | AX_SYMMETRY_SCALE,
    .flat = true,
    .approximate = true,
    .lanes = LANES,
    .parameters = parameters,
    .parameter_count = sizeof parameters / sizeof *parameters,
    .prepare = prepare,
    .project = project,
};
