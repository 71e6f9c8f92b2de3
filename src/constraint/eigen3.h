// Principal axes of point sets and orthonormal frames in closed form, for AX_W sets side by side. Straight-line code
// with selects for the rare cases, so that the loops over lanes vectorise; no iteration count depends on the data, no
// libm but sqrt.
#pragma once

#include "constraint/constraint_type.h"

#define AX_INLINE static inline __attribute__((always_inline))

// u, v so that u, v, e is a right-handed orthonormal frame; e a unit vector (a zero vector gives u = +x). Duff et al.
// 2017, Building an Orthonormal Basis, Revisited.
AX_INLINE void ax_perpendicular(const double e[3], double u[3], double v[3])
{
    double sign = copysign(1, e[2]), a = -1 / (sign + e[2]), b = e[0] * e[1] * a;
    u[0] = 1 + sign * e[0] * e[0] * a, u[1] = sign * b, u[2] = -sign * e[0];
    v[0] = b, v[1] = sign + e[1] * e[1] * a, v[2] = -e[1];
}

// Unit vector of a "direction" parameter in lane l; +z if it has no length.
AX_INLINE void ax_unit_direction(const ax_lane* direction, int l, double out[3])
{
    double d[3] = {direction[0][l], direction[1][l], direction[2][l]}, length = ax_norm3(d);
    for (int i = 0; i < 3; ++i)
        out[i] = length > 0 ? d[i] / length : i == 2;
}

// QR factors of the 3 x 2 matrix [a b]: a = r[0] u, b = r[1] u + r[2] v with u, v orthonormal to rounding whatever a
// and b are and r[0], r[2] >= 0. Without a direction of their own u and v are some perpendicular ones.
AX_INLINE void ax_frame(const double a[3], const double b[3], double u[3], double v[3], double r[3])
{
    double length = sqrt(ax_dot3(a, a)), s = length > 0 ? 1 / length : 0;
    u[0] = length > 0 ? a[0] * s : 1, u[1] = a[1] * s, u[2] = a[2] * s;
    r[0] = length, r[1] = ax_dot3(u, b);

    // Gram-Schmidt twice: once leaves v far from perpendicular when a and b are nearly parallel
    double w[3] = {b[0] - r[1] * u[0], b[1] - r[1] * u[1], b[2] - r[1] * u[2]}, again = ax_dot3(u, w);
    w[0] -= again * u[0], w[1] -= again * u[1], w[2] -= again * u[2];
    double rest = ax_dot3(w, w), p[3], q[3];
    ax_perpendicular(u, p, q);
    int parallel = rest <= 1e-30 * ax_dot3(b, b); // what is left is rounding
    r[2] = parallel ? 0 : sqrt(rest);
    s = parallel ? 1 : 1 / r[2];
    v[0] = s * (parallel ? p[0] : w[0]), v[1] = s * (parallel ? p[1] : w[1]), v[2] = s * (parallel ? p[2] : w[2]);
}

// Principal axes of centred points: unit axis[0] with the largest, axis[2] with the smallest sum of (axis . y)^2,
// mutually perpendicular. axis[2] is the normal of the plane, axis[0] the direction of the line that fits best. Where
// sums are equal the axes are some pair of their plane, or some triple.
void ax_principal_axes(int points, const ax_lane3* restrict y, ax_lane3 axis[restrict 3]);
