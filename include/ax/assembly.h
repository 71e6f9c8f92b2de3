// How people put a cut design together: the order of joining, and the frame on which its supports stand. Lengths are millimetres at
// true size, whatever the document's unit.
#pragma once

#include "ax/fabricate.h"

// --- order of joining

// Panels order[first .. first + count) of the assembly. Loose panels are joined row by row of the lattice: a step is what hangs
// together of a row, and every panel but the very first is joined to one before it. Of pieces that were cut whole, a step is a piece.
typedef struct ax_assembly_step {
    int first, count;
    int row;           // of the lattice; of a piece: its lowest
    int piece;         // -1 unless the step is a piece
    bool from_right;   // which end of the row begins, with the rows running from left to right
    int hinges_within; // joined among the step's own panels
    int hinges_before; // joined to panels of earlier steps
} ax_assembly_step;

typedef struct ax_assembly {
    int panel_count, step_count;
    int* order;   // panels as they are joined
    int* step_of; // per panel
    ax_assembly_step* steps;
    bool by_pieces;
    // Unit, in the flat state: the direction in which rows run, places counting up; rows then count to its left.
    double along[2];
} ax_assembly;

void ax_assembly_free(ax_assembly* assembly); // also resets to an empty assembly; NULL allowed

// Orders the panels of a plan that was made of this design. It begins with the longer of the first and last row. n log n, or
// quadratic in the number of steps.
ax_assembly ax_assembly_make(const ax_design* design, const ax_cut_plan* plan);

// --- the frame

typedef struct ax_frame_point {
    int hinge, panel; // the support, and a panel that it holds
    double place[3];  // deployed
    double chord;     // to the next of its curve; NaN at the end of an open one
    double along;     // sum of chords up to here
    double plan;      // length of the smooth curve, seen from above, up to here
    double radius;    // of the circle through this point and its neighbours; NaN at ends, infinite where straight
    bool slides;
} ax_frame_point;

// Supports points[first .. first + count) that follow each other round the rim, or over the shell as an arch; single ones are curves
// of one point. Where the rim goes on unsupported for more than three times the usual distance, a curve ends. An arch is what panels join one
// after the other, going on straight, with the supports of the rim where it ends.
typedef struct ax_frame_curve {
    int first, count;
    bool closed, arch;
    double length, plan; // of its chords; of the smooth curve, seen from above
    bool planar;         // within AX_FRAME_TOLERANCE, as `circle` is
    // Largest distances from the plane and from the circle that fit best; NaN: too few points.
    double off_plane, off_circle;
    // Of the plane: axes[2] its normal, not downwards; axes[0] near the document's x, or level if the plane stands.
    double origin[3], axes[3][3];
    bool circle; // planar and of four or more points
    double centre[3], radius;
} ax_frame_curve;

#define AX_FRAME_TOLERANCE 0.5 // mm, or 1e-4 of the curve's length where that is more

typedef struct ax_support_frame {
    int point_count, curve_count;
    int support_count; // points where curves meet stand in each of them
    ax_frame_point* points;
    ax_frame_curve* curves;
} ax_support_frame;

void ax_frame_free(ax_support_frame* frame); // also resets to an empty frame; NULL allowed

// The supports in their deployed places, in order round the rim; then the arches. Empty without supports.
ax_support_frame ax_frame_of(const ax_design* design);

// The place at `t` in [0, 1] of the way from point k of a curve to the next: smooth through all points, but for corners of more
// than 30 degrees, whose sides start straight.
void ax_frame_at(const ax_support_frame* frame, const ax_frame_curve* curve, int k, double t, double place[3]);

// A plan of one sheet at true size: planar curves in their plane; others as seen from above, with heights, and unrolled (along:
// length seen from above, up: height). CUT: the curve, SCORE: chords and crosses at the supports, LABEL: their numbers. Without a
// curve of two supports: AX_BAD_INPUT.
ax_status ax_frame_plan(const ax_design* design, const ax_support_frame* frame, const char* title, ax_cut_plan* plan,
                        ax_error* error);
