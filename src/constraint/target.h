// What the types that know a point in advance share: the target, learned from the place at rest, is the nearest row.
#pragma once

#include "constraint/constraint_type.h"

enum { TARGET_LANES = 3 };

static const ax_parameter ax_target_parameters[] = {
    {.name = "target",
     .unit = "point",
     .doc = "where the point shall be",
     .standard = 0,
     .least = -1e12,
     .most = 1e12,
     .offset = 0,
     .lanes = TARGET_LANES},
};

static inline void ax_target_rest(ax_lane* restrict block, int points, const ax_lane3* restrict x)
{
    (void)points;
    for (int i = 0; i < 3; ++i)
        for (int l = 0; l < AX_W; ++l)
            block[i][l] = x[0][i][l];
}

static inline void ax_target_project(const ax_lane* restrict block, const ax_place* place, int points,
                                     const ax_lane3* restrict y, ax_lane3* restrict p)
{
    (void)place, (void)points, (void)y;
    for (int i = 0; i < 3; ++i)
        for (int l = 0; l < AX_W; ++l)
            p[0][i][l] = block[i][l];
}
