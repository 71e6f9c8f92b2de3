// One-piece sheets: the openings between panels, cut so that a ligament is left at each hinge.
//
// Two openings meet at a hinge P. In the smaller one, the mouth, the cut ends at T, half a ligament from P: the corner is rounded by
// the arc through T that touches both edges. In the larger one, the material bulges by an arc about the same centre, a ligament
// farther out, so that nowhere less than a ligament is left between the two cuts, and P is its middle. With the beam's width,
// edges and arcs move into the opening; a mouth too narrow for the beam is cut by a single line along its middle.
#pragma once

#include "fabricate/work.h"

// One corner of an opening, which lies to the left of its edges.
typedef struct ax_opening_corner {
    double enter[2], leave[2]; // on the edges before and after
    double tip[2];             // of the arc between them: the point of the opening nearest to the hinge
    double centre[2];          // of the arc
    double sweep[2];           // from enter to tip, and on to leave; 0: a plain corner
    bool line;
    double line_end[2]; // with `line`: a single cut goes on from the corner to here
} ax_opening_corner;

// A panel of a one-piece sheet, to the middles of its ligaments, as a path. Corners whose hinge leads to no other panel of the same
// piece are plain.
void ax_openings_put_panel(ax_work* w, int triangle);

// AX_CANNOT_REALISE when openings cannot take their ligaments: names a panel.
ax_status ax_openings_check(const ax_work* w, ax_error* error);

// Cuts all openings of the pieces as SLIT and their rims as CUT, each where its panels are placed.
void ax_openings_draw(ax_work* w, int sheet);
