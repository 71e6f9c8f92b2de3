// What the readers of drawings draw with: lines, cubics, arcs and splines in the plane, flattened into curves of points.
#pragma once

#include "input/outline.h"

// After the first failure every call does nothing.
typedef struct ax_pen {
    const char* path; // for messages
    double tolerance; // of chords, > 0; INFINITY for a first look at the size
    double matrix[6]; // places x, y become m[0] x + m[2] y + m[4], m[1] x + m[3] y + m[5]
    int line;         // of the file; new curves take it, and messages name it
    char name[64];    // new curves take it
    ax_status status;
    ax_error* error;
    ax_outline outline;                              // the last curve is the one being drawn
    int curve_capacity, point_capacity, point_count; // of curves; of points in the last one; of all points
} ax_pen;

ax_pen ax_pen_make(const char* path, double tolerance, ax_error* error);
void ax_pen_free(ax_pen* pen);
void ax_pen_fail(ax_pen* pen, const char* format, ...) __attribute__((format(printf, 2, 3))); // "PATH, line N: ..."

void ax_pen_move(ax_pen* pen, double x, double y); // begins a curve; the other strokes go on from where it is
void ax_pen_line(ax_pen* pen, double x, double y);
void ax_pen_cubic(ax_pen* pen, const double a[2], const double b[2], const double end[2]);
// Along centre + u cos t + v sin t, t from `start` to start + sweep, which is at `end`.
void ax_pen_arc(ax_pen* pen, const double centre[2], const double u[2], const double v[2], double start, double sweep,
                const double end[2]);
// A whole ellipse, a closed curve of its own.
void ax_pen_ellipse(ax_pen* pen, const double centre[2], const double u[2], const double v[2]);
// A curve of its own: a rational B-spline of degree 1 to AX_PEN_DEGREE over count + degree + 1 knots that do not fall; weights > 0.
enum { AX_PEN_DEGREE = 15 };
void ax_pen_spline(ax_pen* pen, int degree, int count, const double (*points)[2], const double* weights,
                   const double* knots);
void ax_pen_close(ax_pen* pen);

// Box around all points; false if there are none.
bool ax_pen_bounds(const ax_pen* pen, double lo[2], double hi[2]);
// Joins curves whose ends touch and drops those without length. The outline is the caller's then.
ax_outline ax_pen_finish(ax_pen* pen);
