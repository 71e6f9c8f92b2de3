// Curves as places for on_geometry: rims slide on them. Each finds its nearest point of all, not a local one, and gives
// it a parameter, so that hinges on a curve have an order. A mesh becomes a place by ax_closest_place.
#pragma once

#include "constraint/constraint_type.h"

// A curve in space. Parameter t: signed length from `point` on a line; fraction of a turn in [0, 1) on a circle and an
// ellipse; index of the control point plus the fraction of the way to the next one on polylines and splines (coincident
// neighbours count once). Immutable, so shared by threads.
typedef struct ax_curve ax_curve;

// Unbounded line through `point`; a direction without length makes it that point.
ax_curve* ax_curve_line(const double point[3], const double direction[3]);

// Circle about the axis `normal` (none: +z).
ax_curve* ax_curve_circle(const double centre[3], const double normal[3], double radius);

// Ellipse centre + cos a + sin b with the semi-axes a and b as vectors, t = 0 at a; b's part along a is dropped. Either
// may be zero.
ax_curve* ax_curve_ellipse(const double centre[3], const double a[3], const double b[3]);

// Straight pieces between `count` >= 1 points, back to the first if `closed`.
ax_curve* ax_curve_polyline(const double (*points)[3], int count, bool closed);

// Centripetal Catmull-Rom spline through `count` >= 1 points: tangent continuous, no cusp or loop between two points
// (Yuksel, Schaefer and Keyser 2011, Parameterization and Applications of Catmull-Rom Curves); moving a point changes
// four pieces.
ax_curve* ax_curve_spline(const double (*points)[3], int count, bool closed);

// Straight pieces between the points, corners rounded by arcs of `radius`, or of as much as half the shorter side has room for: tangent
// continuous. An arc is two cubic pieces, within a hundred-thousandth of its radius up to a right angle. 0: a polyline.
ax_curve* ax_curve_rounded(const double (*points)[3], int count, bool closed, double radius);

void ax_curve_free(ax_curve* curve);

// Nearest point to x; returns its parameter. Of equally near points always the same one. O(log n) pieces for x near the
// curve.
double ax_curve_nearest(const ax_curve* curve, const double x[3], double out[3]);

// The point at t; beyond its ends an open curve stays there, a closed one goes round.
void ax_curve_point(const ax_curve* curve, double t, double out[3]);

// First and second derivative of the point by t; on a polyline the second vanishes, and at a corner both are those of the
// piece that begins there. Zero where a curve is a single point.
void ax_curve_derivatives(const ax_curve* curve, double t, double first[3], double second[3]);

typedef struct ax_curve_range {
    double from, to; // of t; infinite on a line
    bool closed;     // `to` is `from` again
    bool smooth;     // without corners between its ends
} ax_curve_range;
ax_curve_range ax_curve_extent(const ax_curve* curve);
// At t it ends, or turns a corner: a point held there has no direction in which it may move.
bool ax_curve_stops(const ax_curve* curve, double t);

// Length along the curve from its start to t, within t's range, and the t at a length: inverse to one another, monotone, and exact on
// lines, circles and polylines; elsewhere measured along chords, within a thousandth. Closed curves go round.
double ax_curve_length(const ax_curve* curve, double t);
double ax_curve_at_length(const ax_curve* curve, double length);

// The curve as a place, borrowed. Its parameter is the length along it, so that gaps between points mean the same everywhere.
ax_place ax_curve_place(const ax_curve* curve);
