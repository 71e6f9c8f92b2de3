#include "input/pen.h"

#include "base/vec.h"

#include <assert.h>
#include <math.h>
#include <stdarg.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { most_points = 1000000 };

ax_pen ax_pen_make(const char* path, double tolerance, ax_error* error)
{
    assert(tolerance > 0);
    return (ax_pen){.path = path, .tolerance = tolerance, .matrix = {1, 0, 0, 1, 0, 0}, .line = 1, .error = error};
}

void ax_outline_free(ax_outline* outline)
{
    for (int c = 0; c < outline->count; ++c)
        ax_free(outline->curves[c].points);
    ax_free(outline->curves);
    *outline = (ax_outline){0};
}

void ax_pen_free(ax_pen* pen)
{
    ax_outline_free(&pen->outline);
}

void ax_pen_fail(ax_pen* pen, const char* format, ...)
{
    if (pen->status != AX_OK)
        return;
    char what[512];
    va_list arguments;
    va_start(arguments, format);
    vsnprintf(what, sizeof what, format, arguments);
    va_end(arguments);
    pen->status = ax_fail(pen->error, AX_BAD_INPUT, "%s, line %d: %s", pen->path, pen->line, what);
}

static ax_outline_curve* last_curve(const ax_pen* pen)
{
    return pen->outline.curves + pen->outline.count - 1;
}

// Adds a point that is already where it belongs.
static void add(ax_pen* pen, double x, double y)
{
    if (pen->status != AX_OK)
        return;
    if (!(fabs(x) < 1e100 && fabs(y) < 1e100)) { // squares must not overflow
        ax_pen_fail(pen, "a coordinate here is no number that a drawing can have. Mend or remove this curve.");
        return;
    }
    if (pen->point_count == most_points) {
        ax_pen_fail(
            pen,
            "the drawing has more than a million points. Leave out what is not needed, or allow a larger tolerance.");
        return;
    }
    ax_outline_curve* curve = last_curve(pen);
    if (curve->count == pen->point_capacity) {
        pen->point_capacity = pen->point_capacity ? 2 * pen->point_capacity : 8;
        curve->points = ax_realloc(curve->points, (size_t)pen->point_capacity, sizeof *curve->points);
    }
    curve->points[curve->count][0] = x;
    curve->points[curve->count++][1] = y;
    ++pen->point_count;
}

static void place(const ax_pen* pen, const double x[2], double out[2])
{
    const double* m = pen->matrix;
    out[0] = m[0] * x[0] + m[2] * x[1] + m[4];
    out[1] = m[1] * x[0] + m[3] * x[1] + m[5];
}

static void place_vector(const ax_pen* pen, const double v[2], double out[2])
{
    const double* m = pen->matrix;
    out[0] = m[0] * v[0] + m[2] * v[1];
    out[1] = m[1] * v[0] + m[3] * v[1];
}

static void begin_curve(ax_pen* pen)
{
    if (pen->status != AX_OK)
        return;
    if (pen->outline.count == pen->curve_capacity) {
        pen->curve_capacity = pen->curve_capacity ? 2 * pen->curve_capacity : 16;
        pen->outline.curves = ax_realloc(pen->outline.curves, (size_t)pen->curve_capacity, sizeof *pen->outline.curves);
    }
    ax_outline_curve* curve = pen->outline.curves + pen->outline.count++;
    *curve = (ax_outline_curve){.line = pen->line};
    memcpy(curve->name, pen->name, sizeof curve->name);
    pen->point_capacity = 0;
}

void ax_pen_move(ax_pen* pen, double x, double y)
{
    begin_curve(pen);
    ax_pen_line(pen, x, y);
}

void ax_pen_line(ax_pen* pen, double x, double y)
{
    double at[2];
    place(pen, (double[]){x, y}, at);
    add(pen, at[0], at[1]);
}

// How many equal parts keep chords within the tolerance of a curve whose second derivative is at most `second`: a chord over a
// parameter step s is off by at most s^2 second / 8.
static int part_count(const ax_pen* pen, double second, int fewest)
{
    double parts = ceil(sqrt(second / (8 * pen->tolerance)));
    if (!(parts <= most_points))
        return most_points + 1; // refused while they are added
    return parts > fewest ? (int)parts : fewest;
}

void ax_pen_cubic(ax_pen* pen, const double a[2], const double b[2], const double end[2])
{
    if (pen->status != AX_OK)
        return;
    const ax_outline_curve* curve = last_curve(pen);
    double p[4][2], second = 0;
    memcpy(p[0], curve->points[curve->count - 1], sizeof p[0]);
    place(pen, a, p[1]);
    place(pen, b, p[2]);
    place(pen, end, p[3]);
    for (int k = 0; k < 2; ++k)
        second =
            fmax(second, 6 * hypot(p[k][0] - 2 * p[k + 1][0] + p[k + 2][0], p[k][1] - 2 * p[k + 1][1] + p[k + 2][1]));
    int parts = part_count(pen, second, 4);
    for (int k = 1; k < parts && pen->status == AX_OK; ++k) {
        double t = (double)k / parts, s = 1 - t;
        double w[4] = {s * s * s, 3 * s * s * t, 3 * s * t * t, t * t * t};
        add(pen, w[0] * p[0][0] + w[1] * p[1][0] + w[2] * p[2][0] + w[3] * p[3][0],
            w[0] * p[0][1] + w[1] * p[1][1] + w[2] * p[2][1] + w[3] * p[3][1]);
    }
    add(pen, p[3][0], p[3][1]);
}

// The longer semi-axis of the ellipse with conjugate radii u and v.
static double longest_radius(const double u[2], const double v[2])
{
    double uu = u[0] * u[0] + u[1] * u[1], vv = v[0] * v[0] + v[1] * v[1], uv = u[0] * v[0] + u[1] * v[1];
    return sqrt((uu + vv) / 2 + hypot((uu - vv) / 2, uv));
}

void ax_pen_arc(ax_pen* pen, const double centre[2], const double u[2], const double v[2], double start, double sweep,
                const double end[2])
{
    double c[2], a[2], b[2];
    place(pen, centre, c);
    place_vector(pen, u, a);
    place_vector(pen, v, b);
    int parts = part_count(pen, sweep * sweep * longest_radius(a, b), (int)ceil(fabs(sweep) / 0.8) + 1);
    for (int k = 1; k < parts && pen->status == AX_OK; ++k) {
        double t = start + sweep * k / parts;
        add(pen, c[0] + a[0] * cos(t) + b[0] * sin(t), c[1] + a[1] * cos(t) + b[1] * sin(t));
    }
    ax_pen_line(pen, end[0], end[1]);
}

void ax_pen_ellipse(ax_pen* pen, const double centre[2], const double u[2], const double v[2])
{
    double start[2] = {centre[0] + u[0], centre[1] + u[1]};
    ax_pen_move(pen, start[0], start[1]);
    ax_pen_arc(pen, centre, u, v, 0, 2 * M_PI, start);
    ax_pen_close(pen);
}

typedef struct spline {
    int degree;
    const double (*points)[2]; // placed
    const double *weights, *knots;
} spline;

// de Boor's algorithm in homogeneous coordinates, t within the span from knots[span] to knots[span + 1].
static void spline_at(const spline* s, int span, double t, double out[2])
{
    double d[AX_PEN_DEGREE + 1][3];
    for (int k = 0; k <= s->degree; ++k) {
        int i = span - s->degree + k;
        d[k][0] = s->weights[i] * s->points[i][0];
        d[k][1] = s->weights[i] * s->points[i][1];
        d[k][2] = s->weights[i];
    }
    for (int r = 1; r <= s->degree; ++r)
        for (int k = s->degree; k >= r; --k) {
            double lo = s->knots[span - s->degree + k], hi = s->knots[span + 1 + k - r];
            double w = (t - lo) / (hi - lo); // the span lies within lo to hi, so it is not empty
            for (int e = 0; e < 3; ++e)
                d[k][e] = (1 - w) * d[k - 1][e] + w * d[k][e];
        }
    out[0] = d[s->degree][0] / d[s->degree][2];
    out[1] = d[s->degree][1] / d[s->degree][2];
}

// Halves the part until the curve at three places within lies near the chord: a rational curve's derivatives have no simple bound.
static void add_spline_part(ax_pen* pen, const spline* s, int span, double from, const double a[2], double to,
                            const double b[2], int depth)
{
    if (pen->status != AX_OK)
        return;
    double middle[2] = {a[0], a[1]}, off = 0, dx = b[0] - a[0], dy = b[1] - a[1], length = hypot(dx, dy);
    for (int k = 1; k <= 3; ++k) {
        double x[2];
        spline_at(s, span, from + (to - from) * k / 4, x);
        double side = length > 0 ? fabs(dx * (x[1] - a[1]) - dy * (x[0] - a[0])) / length : ax_distance2(x, a);
        off = fmax(off, side);
        if (k == 2)
            memcpy(middle, x, sizeof middle);
    }
    if (depth < 2 || (depth < 18 && off > 0.8 * pen->tolerance)) {
        double half = (from + to) / 2;
        add_spline_part(pen, s, span, from, a, half, middle, depth + 1);
        add_spline_part(pen, s, span, half, middle, to, b, depth + 1);
    } else
        add(pen, b[0], b[1]);
}

void ax_pen_spline(ax_pen* pen, int degree, int count, const double (*points)[2], const double* weights,
                   const double* knots)
{
    assert(degree >= 1 && degree <= AX_PEN_DEGREE && count > degree);
    double(*placed)[2] = ax_alloc((size_t)count, sizeof *placed);
    for (int k = 0; k < count; ++k)
        place(pen, points[k], placed[k]);
    spline s = {degree, (const double(*)[2])placed, weights, knots};
    begin_curve(pen);
    bool begun = false;
    double a[2], b[2];
    for (int span = degree; span < count && pen->status == AX_OK; ++span) {
        if (!(knots[span] < knots[span + 1]))
            continue;
        spline_at(&s, span, knots[span], a);
        spline_at(&s, span, knots[span + 1], b);
        if (!begun)
            add(pen, a[0], a[1]);
        begun = true;
        add_spline_part(pen, &s, span, knots[span], a, knots[span + 1], b, 0);
    }
    ax_free(placed);
}

void ax_pen_close(ax_pen* pen)
{
    if (pen->status == AX_OK)
        last_curve(pen)->closed = true;
}

bool ax_pen_bounds(const ax_pen* pen, double lo[2], double hi[2])
{
    lo[0] = lo[1] = INFINITY, hi[0] = hi[1] = -INFINITY;
    for (int c = 0; c < pen->outline.count; ++c)
        for (int k = 0; k < pen->outline.curves[c].count; ++k)
            for (int d = 0; d < 2; ++d) {
                lo[d] = fmin(lo[d], pen->outline.curves[c].points[k][d]);
                hi[d] = fmax(hi[d], pen->outline.curves[c].points[k][d]);
            }
    return lo[0] <= hi[0];
}
