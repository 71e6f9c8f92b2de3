// The sign of mean curvature over a surface, judged by shares of area.
#pragma once

#include "ax/mesh.h"

typedef struct ax_curvature_screen {
    double area;
    double* mean;                 // H per vertex, area-weighted average over the one-ring
    double* vertex_area;          // per vertex
    double min, q01, median, q95; // of H, by area
    double nonpositive_share;     // share of area with H <= 0
    double worst_place[3];        // centroid of the largest part with H <= 0, or of the smallest H
    bool positive;                // H > 0 but for what noise explains
    double asked;                 // of q95, for the next:
    bool dome_like;               // curved enough somewhere that projection would keep part of the surface
} ax_curvature_screen;

ax_curvature_screen ax_curvature_measure(const ax_mesh* mesh);
void ax_curvature_free(ax_curvature_screen* screen);
