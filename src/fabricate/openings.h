// One-piece sheets: the openings between panels, cut so that a ligament is left at each hinge.
//
// Two openings meet at a hinge P, with angles that sum to 240 degrees between equilateral panels. In the smaller one, the mouth, the
// cut ends at T, half a ligament from P: the corner is rounded by the arc through T that touches both edges. In the larger one,
// the material bulges by the disc of one ligament's radius about T, so that nowhere less than a ligament is left between the
// two cuts, and P is its middle. With the beam's width, edges and arcs move into the opening; a mouth too narrow for the beam is
// cut by a single line along its middle.
#pragma once

#include "fabricate/work.h"

// One corner of an opening, which lies to the left of its edges.
typedef struct ax_opening_corner {
    double enter[2], leave[2]; // on the edges before and after
    double centre[2], sweep;   // of the arc between them; sweep 0: a plain corner
    double tip[2];             // the arc's middle: the point of the opening nearest to the hinge
    double line_end[2];        // with `line`: a single cut goes on from the corner to here
    bool line;
} ax_opening_corner;

// The corner at `at` between `before` and `after`; grow: half the kerf.
ax_opening_corner ax_opening_corner_make(const double before[2], const double at[2], const double after[2],
                                         double ligament, double grow);

// A panel of a one-piece sheet, to the middles of its ligaments, as a path. Corners whose hinge leads to no other panel of the same
// piece are plain.
void ax_openings_put_panel(ax_work* w, int triangle);

// AX_CANNOT_REALISE when openings cannot take their ligaments: names a panel.
ax_status ax_openings_check(const ax_work* w, ax_error* error);

// Cuts all openings of the pieces as SLIT and their rims as CUT, each where its panels are placed.
void ax_openings_draw(ax_work* w, int sheet);
