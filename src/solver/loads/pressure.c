// pressure: a follower load on a surface of loops, each closed by a fan of triangles about the mean of its corners. Its potential is
// -p V, V the volume between the loops and `origin`; the force on a corner is p dV/dx. Given panels, holes and openings counter-
// clockwise seen from outside, inner points feel the true pressure of the triangulated surface whatever the origin is, and an
// unsupported rim that of the membrane that closes it to the origin.
#include "constraint/eigen3.h"
#include "solver/load.h"

enum { PRESSURE, ORIGIN, VALUES = ORIGIN + 3 };

static const ax_parameter parameters[] = {
    {.name = "pressure",
     .unit = "pressure",
     .doc = "on the side from which corners turn clockwise; negative is suction",
     .standard = 1,
     .least = -1e12,
     .most = 1e12,
     .offset = PRESSURE,
     .lanes = 1},
    {.name = "origin",
     .unit = "point",
     .doc = "to which an unsupported rim is closed; learned as the centre of the points, for the sake of rounding",
     .standard = 0,
     .least = -1e12,
     .most = 1e12,
     .offset = ORIGIN,
     .lanes = 3},
};

static void rest(double* value, const double centre[3])
{
    for (int i = 0; i < 3; ++i)
        value[ORIGIN + i] = centre[i];
}

// Between a loop and the origin V = c . S / 6, c the mean of the corners, S = sum x_k x x_{k+1}. Hence
// dV/dx_k = (S / n + (x_{k+1} - x_{k-1}) x c) / 6.
static void act(const double* value, const ax_lane area, int points, const ax_lane3* restrict x,
                ax_lane3* restrict force, ax_lane potential)
{
    (void)area;
    double p = value[PRESSURE] / 6, share = 1.0 / points;
    ax_lane3 c = {{0}}, s = {{0}};
    for (int k = 0; k < points; ++k) {
        const ax_lane* a = x[k];
        const ax_lane* b = x[k + 1 < points ? k + 1 : 0];
        for (int l = 0; l < AX_W; ++l) {
            double ax = a[0][l] - value[ORIGIN], ay = a[1][l] - value[ORIGIN + 1], az = a[2][l] - value[ORIGIN + 2];
            double bx = b[0][l] - value[ORIGIN], by = b[1][l] - value[ORIGIN + 1], bz = b[2][l] - value[ORIGIN + 2];
            c[0][l] += share * ax, c[1][l] += share * ay, c[2][l] += share * az;
            s[0][l] += ay * bz - az * by, s[1][l] += az * bx - ax * bz, s[2][l] += ax * by - ay * bx;
        }
    }
    for (int k = 0; k < points; ++k) {
        const ax_lane* a = x[k > 0 ? k - 1 : points - 1];
        const ax_lane* b = x[k + 1 < points ? k + 1 : 0];
        for (int l = 0; l < AX_W; ++l) {
            double dx = b[0][l] - a[0][l], dy = b[1][l] - a[1][l], dz = b[2][l] - a[2][l];
            force[k][0][l] = p * (share * s[0][l] + dy * c[2][l] - dz * c[1][l]);
            force[k][1][l] = p * (share * s[1][l] + dz * c[0][l] - dx * c[2][l]);
            force[k][2][l] = p * (share * s[2][l] + dx * c[1][l] - dy * c[0][l]);
        }
    }
    for (int l = 0; l < AX_W; ++l)
        potential[l] = -p * (c[0][l] * s[0][l] + c[1][l] * s[1][l] + c[2][l] * s[2][l]);
}

const ax_load_type ax_load_pressure = {
    .name = "pressure",
    .doc = "Pressure on panels, holes and openings, always across the surface where it is now.",
    .reference = "Hibbitt 1979, Some follower forces and load stiffness, IJNME 14",
    .parameters = parameters,
    .parameter_count = sizeof parameters / sizeof *parameters,
    .values = VALUES,
    .follows = true,
    .rest = rest,
    .act = act,
};
