// Measures of a linkage's states, from positions alone: nothing here knows how a state was made, so every figure of the report
// checks the solvers.
#pragma once

#include "ax/design.h"
#include "mesh/closest.h"

// The turn about the vertical through the middle of the first state of `count` hinges that brings it nearest to the second, and a state
// turned so. `to` may be `from`.
double ax_measure_turn(int count, const double (*from)[3], const double (*to)[3]);
void ax_measure_turned(int count, const double (*from)[3], double angle, double (*to)[3]);

// Largest distance between two states of `count` hinges but for a turn about the vertical through the middle of the first: a sheet turns in
// a rim that is nearly round by next to no force.
double ax_measure_move(int count, const double (*from)[3], const double (*to)[3]);

// Largest |flat edge / other edge - 1| over all edges; `other` in space.
double ax_measure_congruence(const ax_linkage* linkage, const double (*flat)[2], const double (*other)[3]);

typedef struct ax_edge_measure {
    double mean, min, max;                        // of flat edges
    double equilateral_inner, equilateral_border; // largest |edge / mean of its triangle - 1|
} ax_edge_measure;
ax_edge_measure ax_measure_edges(const ax_linkage* linkage, const double (*flat)[2]);

typedef struct ax_mouth_measure {
    double min_deg, median_deg; // over hinges of two triangles: the smaller of the two signed gaps
    int min_hinge;
} ax_mouth_measure;
ax_mouth_measure ax_measure_mouths(const ax_linkage* linkage, const double (*flat)[2]);

// The smaller of the two signed gaps at each hinge, radians; infinite where there is none. Owned by the caller.
double* ax_measure_mouth_angles(const ax_linkage* linkage, const double (*flat)[2]);

// Number of pairs of flat triangles whose interiors overlap by more than `depth` (separating axes over a grid); the first `most` of
// them go to `pairs`.
int ax_measure_overlaps(const ax_linkage* linkage, const double (*flat)[2], double depth, int most, int (*pairs)[2]);
// Number of flat triangles that are turned over; the first of them, if there are any, goes to *first (NULL: not wanted).
int ax_measure_flipped(const ax_linkage* linkage, const double (*flat)[2], int* first);

// Realised scale factor per triangle: twice its mean edge over the lattice spacing that its neighbours' centres show in the
// flat state; for border triangles, which lack a neighbour, the one that their mouths show.
void ax_measure_scale(const ax_linkage* linkage, const double (*flat)[2], double* scale);

// Mean curvature per panel of a state in space, 1/length, positive to the side to which it bulges as a whole: a quadric fitted to the hinges
// of the panels within two steps (21; at the rim, on one side only, fewer). NaN where fewer than 12 are there or they lie on a conic.
void ax_measure_mean_curvature(const ax_linkage* linkage, const double (*places)[3], double* out);

// 5 %, 50 % and 95 % quantiles of the interior angles of six-hinged holes in space, degrees.
void ax_measure_hole_angles(const ax_linkage* linkage, const double (*places)[3], double quantile[3]);

// Load plus the pull of all edges at each hinge, N: nothing at a free hinge in equilibrium, at a support what it must bear. Owned by
// the caller.
double (*ax_measure_unbalanced(const ax_linkage* linkage, const double (*places)[3], const double (*edge_forces)[3],
                               const double (*loads)[3]))[3];

// |force| over the free hinges, and in the free directions of those that slide (`slides` NULL: none does) / total load, from
// places, edge forces (N, per triangle and edge) and hinge loads (N).
double ax_measure_force_residual(const ax_linkage* linkage, const double (*places)[3], const double (*edge_forces)[3],
                                 const double (*loads)[3], const unsigned char* supports, const ax_slide* slides);

// Force on the hinge at corner k of triangle t by the triangle's two edges there, N.
void ax_measure_corner_force(const ax_linkage* linkage, const double (*places)[3], const double (*edge_forces)[3],
                             int t, int k, double out[3]);

// Largest force that a panel passes on at one hinge, and the sum of the reactions' magnitudes, N.
void ax_measure_hinge_forces(const ax_linkage* linkage, const double (*places)[3], const double (*edge_forces)[3],
                             const double (*loads)[3], const unsigned char* supports, double* hinge_max,
                             double* reactions);

// Distance within which `share` (0..1) of the target's vertices lie from the linkage's panels.
double ax_measure_cover(const ax_mesh* target, const ax_linkage* linkage, const double (*places)[3], double share);
