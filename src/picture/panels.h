// The panels of a linkage as solids: prisms with bevelled edges and clipped corners, joined by discs at their hinges.
#pragma once

#include "ax/linkage.h"
#include "picture/scene.h"

typedef struct ax_panels_look {
    double edge_pixels; // size of a panel in the picture: it decides how much of a panel is made
    int front;          // 1: the side from which corners run counter-clockwise faces the eye, -1: the other
    ax_palette palette;
    const double* scale;            // per triangle, for AX_PALETTE_SCALE
    const double (*edge_forces)[3]; // per triangle, for AX_PALETTE_FORCE
} ax_panels_look;

// places: of the hinges, in the scene's frame; `edge`: the mean triangle edge, likewise.
void ax_panels_add(ax_scene* scene, const ax_linkage* linkage, const double (*places)[3], double edge,
                   const ax_panels_look* look);
