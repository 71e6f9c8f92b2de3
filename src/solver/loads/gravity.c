// gravity: the weight of panels, an equal share at each corner, which for a triangle is exact. The area is that of the loop when the
// load was added or measured, so that the load has a potential.
#include "constraint/eigen3.h"
#include "solver/load.h"

enum { DENSITY, ACCELERATION, DIRECTION, VALUES = DIRECTION + 3 };

static const ax_parameter parameters[] = {
    {.name = "density",
     .unit = "density",
     .doc = "mass of a unit of panel area",
     .standard = 1,
     .least = 0,
     .most = 1e12,
     .offset = DENSITY,
     .lanes = 1},
    {.name = "acceleration",
     .unit = "acceleration",
     .doc = "of free fall",
     .standard = 9.80665,
     .least = 0,
     .most = 1e12,
     .offset = ACCELERATION,
     .lanes = 1},
    {.name = "direction",
     .unit = "direction",
     .doc = "towards which things fall",
     .standard = 0,
     .least = -1e12,
     .most = 1e12,
     .offset = DIRECTION,
     .lanes = 3},
};

static void act(const double* value, const ax_lane area, int points, const ax_lane3* restrict x,
                ax_lane3* restrict force, ax_lane potential)
{
    (void)x, (void)potential;
    double down[3], size = ax_norm3(value + DIRECTION);
    for (int i = 0; i < 3; ++i)
        down[i] = size > 0 ? value[DIRECTION + i] / size : i == 2;
    for (int k = 0; k < points; ++k)
        for (int i = 0; i < 3; ++i)
            for (int l = 0; l < AX_W; ++l)
                force[k][i][l] = value[DENSITY] * value[ACCELERATION] * area[l] / points * down[i];
}

const ax_load_type ax_load_gravity = {
    .name = "gravity",
    .doc = "The weight of the panels: area times density times acceleration, shared by their corners.",
    .reference = "Bathe 1996, Finite Element Procedures (lumped body forces)",
    .parameters = parameters,
    .parameter_count = sizeof parameters / sizeof *parameters,
    .values = VALUES,
    .act = act,
};
