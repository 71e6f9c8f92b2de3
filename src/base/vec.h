// Small vectors in double precision, inlined.
#pragma once

#include <math.h>

#define AX_PI 3.14159265358979323846

static inline double ax_dot3(const double a[3], const double b[3])
{
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

static inline void ax_cross(const double a[3], const double b[3], double out[3])
{
    double x = a[1] * b[2] - a[2] * b[1], y = a[2] * b[0] - a[0] * b[2], z = a[0] * b[1] - a[1] * b[0];
    out[0] = x, out[1] = y, out[2] = z;
}

static inline void ax_sub3(const double a[3], const double b[3], double out[3])
{
    out[0] = a[0] - b[0], out[1] = a[1] - b[1], out[2] = a[2] - b[2];
}

static inline double ax_norm3(const double a[3])
{
    return sqrt(ax_dot3(a, a));
}

static inline double ax_distance3(const double a[3], const double b[3])
{
    double d[3];
    ax_sub3(a, b, d);
    return ax_norm3(d);
}

static inline double ax_distance2(const double a[2], const double b[2])
{
    double x = a[0] - b[0], y = a[1] - b[1];
    return sqrt(x * x + y * y);
}

static inline double ax_cross2(const double a[2], const double b[2])
{
    return a[0] * b[1] - a[1] * b[0];
}

// Twice the signed area of the triangle a, b, c: positive counter-clockwise.
static inline double ax_orient2(const double a[2], const double b[2], const double c[2])
{
    return (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0]);
}

static inline double ax_clamp(double x, double lo, double hi)
{
    return x < lo ? lo : (x > hi ? hi : x);
}

// Distance of x from the segment a b in the plane.
static inline double ax_segment_distance2(const double x[2], const double a[2], const double b[2])
{
    double d[2] = {b[0] - a[0], b[1] - a[1]}, length2 = d[0] * d[0] + d[1] * d[1];
    double s = length2 > 0 ? ax_clamp(((x[0] - a[0]) * d[0] + (x[1] - a[1]) * d[1]) / length2, 0, 1) : 0;
    double near[2] = {a[0] + s * d[0], a[1] + s * d[1]};
    return ax_distance2(x, near);
}
