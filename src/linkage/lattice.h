// Laying the triangular lattice over a flat domain. The lattice is the base mesh: its triangles become the linkage's panels, its
// edges the hinges (at their midpoints), its vertices the holes, so the linkage is the medial graph of the lattice.
#pragma once

#include "ax/linkage.h"

typedef struct ax_lattice {
    ax_linkage linkage;
    double (*hinges)[2]; // midpoints of the lattice edges: the fully open, undeformed linkage, perhaps stretched; owned
    double spacing;      // distance of lattice points; panels here have edges of half of it
    double angle;        // radians, lattice rows against the x axis
    double offset[2];    // of lattice point (0, 0)
} ax_lattice;

void ax_lattice_free(ax_lattice* lattice);

// A closed outline in the plane, counter-clockwise.
typedef struct ax_outline {
    int count;
    const double (*points)[2];
} ax_outline;

// Keeps every lattice triangle whose centroid lies inside the outline or, with `inside`, whose panel lies inside; then removes
// ears (triangles hanging on one hinge), pinched vertices, and all but the largest part. AX_CANNOT_REALISE when fewer than
// 12 triangles remain.
ax_status ax_lattice_lay(const ax_outline* outline, double spacing, double angle, const double offset[2], bool inside,
                         ax_lattice* out, ax_error* error);

// Moves the origin to the lowest column and row in use, so that people count panels from there; the hinges stay. For new
// lattices only: panels are known by their numbers.
void ax_lattice_renumber(ax_lattice* lattice);

// Corners of the flat holes: triples (previous, hinge, next) of every hole and of the inner hinges of every opening. Counted in
// *count; owned by the caller.
int (*ax_linkage_mouths(const ax_linkage* linkage, int* count))[3];

// Signed angle of the hole at the middle point of a triple, counter-clockwise from next to previous, in (-pi/3, 5 pi/3]:
// negative where the two panels overlap.
double ax_mouth_angle(const double previous[2], const double hinge[2], const double next[2]);

// The flat state that expands by `scale` (per triangle, >= 1) to the undeformed lattice: every triangle turned about its centre by
// -+acos(1/scale), up and down triangles in opposite sense, and enlarged by scale; each hinge is the mean of its two corners. Of a
// stretched lattice, too: its up and down triangles are alike but for half a turn, so that lattice vectors 2 v become
// R(t) v + R(-t) v = 2 cos(t) v in whichever direction.
void ax_lattice_twist(const ax_lattice* lattice, const double* scale, double (*flat)[2]);

// Two triangles of each hinge, -1 where there is none on the rim. Owned by the caller, hinge_count pairs.
int (*ax_linkage_hinge_triangles(const ax_linkage* linkage))[2];
