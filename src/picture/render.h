// A scene in its light, from a view, as pixels.
#pragma once

#include "picture/light.h"

#include <stdint.h>

typedef struct ax_render_setup {
    double pixel;     // width of a thin line, in pixels: 1 on a usual screen, more in large pictures
    double outlines;  // strength of the panels' outlines, 0 to 1
    double shadow;    // darkness of the ground's shadow, 0 to 1
    double grid;      // distance of the ground's grid lines, 0: none
    double grid_fade; // distance from the origin at which the grid has faded out
} ax_render_setup;

// Writes width x height pixels 0xRRGGBB, rows `stride` pixels apart.
void ax_render(const ax_scene* scene, const ax_view* view, const ax_light* light, const ax_render_setup* setup,
               int width, int height, uint32_t* pixels, int stride);
