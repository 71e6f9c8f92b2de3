// Real outlines of panels: lines and arcs, constructed from the triangle and the joint's rule, so that offsetting by the kerf is
// exact. Growing an outline moves its edges outward and widens its discs about the same centres.
#pragma once

#include "fabricate/joint_work.h"
#include "fabricate/plan.h"

typedef struct ax_panel_corner {
    double disc[2];            // centre
    double enter[2], leave[2]; // where the outline comes to the disc and leaves it
    double sweep;              // of the arc between
    double hole[2];            // centre
} ax_panel_corner;

typedef struct ax_panel_outline {
    double radius, hole_radius; // grown
    ax_panel_corner corner[3];
    double slack[3]; // length of the straight edge from corner k to k + 1; negative: the panel is too small
    int tight;       // the edge with the least of it
} ax_panel_outline;

// `corner`: the triangle, counter-clockwise.
ax_panel_outline ax_panel_make(const ax_panel_rule* rule, const double* const corner[3], double grow);
// How far outlines reach beyond the hinges, mm.
double ax_panel_reach(const ax_panel_rule* rule, double grow);

// Appends the outline (counter-clockwise) as a path, and the holes (clockwise) as one each, moved.
void ax_panel_put_outline(ax_plan_builder* b, const ax_panel_outline* outline, const ax_motion* motion);
void ax_panel_put_hole(ax_plan_builder* b, const ax_panel_outline* outline, int corner, const ax_motion* motion);
