// on_geometry: keeps a point on a curve or a surface, whatever the group's place is: a rim hinge that slides on a
// spline, a hinge on the designed surface.
#include "constraint/constraint_type.h"

static void project(const ax_lane* restrict block, const ax_place* place, int points, const ax_lane3* restrict y,
                    ax_lane3* restrict p)
{
    (void)block, (void)points;
    for (int l = 0; l < AX_W; ++l) {
        double x[3] = {y[0][0][l], y[0][1][l], y[0][2][l]}, out[3];
        place->nearest(place->geometry, x, out);
        p[0][0][l] = out[0], p[0][1][l] = out[1], p[0][2][l] = out[2];
    }
}

const ax_constraint_type ax_constraint_on_geometry = {
    .name = "on_geometry",
    .doc = "Keeps a point on a curve (line, circle, ellipse, polyline, spline) or on a surface.",
    .reference = "Bouaziz et al. 2012, Shape-Up (closest point on a reference)",
    .pattern = AX_ROWS_POINTS,
    .least_points = 1,
    .most_points = 1,
    .needs_place = true,
    .project = project,
};
