// Parameters of the types that know a plane in advance: a point of it, its normal, and the unit normal derived from that.
#pragma once

#include "constraint/eigen3.h"

enum { PLANE_POINT, PLANE_NORMAL = PLANE_POINT + 3, PLANE_UNIT = PLANE_NORMAL + 3, PLANE_LANES = PLANE_UNIT + 3 };

static const ax_parameter ax_given_plane_parameters[] = {
    {.name = "point",
     .unit = "point",
     .doc = "any point of the plane",
     .standard = 0,
     .least = -1e12,
     .most = 1e12,
     .offset = PLANE_POINT,
     .lanes = 3},
    {.name = "normal",
     .unit = "direction",
     .doc = "normal of the plane",
     .standard = 0,
     .least = -1e12,
     .most = 1e12,
     .offset = PLANE_NORMAL,
     .lanes = 3},
};

static inline void ax_given_plane_prepare(ax_lane* restrict block, int points)
{
    (void)points;
    for (int l = 0; l < AX_W; ++l) {
        double n[3];
        ax_unit_direction(block + PLANE_NORMAL, l, n);
        for (int c = 0; c < 3; ++c)
            block[PLANE_UNIT + c][l] = n[c];
    }
}
