// Triangles in their own plane, as complex numbers: corners x0, x1, x2 with the plane's first axis along x1 - x0 and
// its second on the side of x2, so that every triangle of space is counter-clockwise there. What is nearest to a
// triangle among placements of another is nearest in that plane (the polar factor of the 3 x 2 correlation lies in it),
// and there a fit is one multiplication.
#pragma once

#include "constraint/eigen3.h"

// Lanes of the types that fit a template, a triangle with corners w0, w1, w2, mean 0, side w1 - w0 real.
enum {
    AX_TRIANGLE_LO,
    AX_TRIANGLE_HI,
    AX_TRIANGLE_LENGTHS,
    AX_TRIANGLE_W1 = AX_TRIANGLE_LENGTHS + 3, // prepared: real and imaginary part, w0 = -(w1 + w2)
    AX_TRIANGLE_W2 = AX_TRIANGLE_W1 + 2,
    AX_TRIANGLE_INVERSE = AX_TRIANGLE_W2 + 2, // 1 / (|w0|^2 + |w1|^2 + |w2|^2)
    AX_TRIANGLE_LANES,
    AX_TRIANGLE_PARAMETERS = 3,
};
extern const ax_parameter ax_triangle_parameters[AX_TRIANGLE_PARAMETERS];
void ax_triangle_rest(ax_lane* restrict block, int points, const ax_lane3* restrict x);
void ax_triangle_prepare(ax_lane* restrict block, int points);

// Frame u, v of the triangle in lane l; its sides x1 - x0 and x2 - x0 are r[0] and r[1] + i r[2], r[0], r[2] >= 0.
AX_INLINE void ax_triangle_frame(const ax_lane3* x, int l, double u[3], double v[3], double r[3])
{
    double a[3], b[3];
    for (int i = 0; i < 3; ++i)
        a[i] = x[1][i][l] - x[0][i][l], b[i] = x[2][i][l] - x[0][i][l];
    ax_frame(a, b, u, v, r);
}

// z with |z| in [lo, hi] that brings w z nearest to a triangle with the complex sides a = x1 - x0 and b = x2 - x0.
AX_INLINE void ax_triangle_fit(const ax_lane* block, int l, const double a[2], const double b[2], double z[2])
{
    double p = block[AX_TRIANGLE_W1][l], q = block[AX_TRIANGLE_W1 + 1][l];
    double r = block[AX_TRIANGLE_W2][l], t = block[AX_TRIANGLE_W2 + 1][l], inverse = block[AX_TRIANGLE_INVERSE][l];
    double x = inverse * (p * a[0] + q * a[1] + r * b[0] + t * b[1]);
    double y = inverse * (p * a[1] - q * a[0] + r * b[1] - t * b[0]);
    double size = sqrt(x * x + y * y), lo = block[AX_TRIANGLE_LO][l], hi = block[AX_TRIANGLE_HI][l];
    double want = size < lo ? lo : (size > hi ? hi : size), s = want / (size > 0 ? size : 1);
    z[0] = s * (size > 0 ? x : 1);
    z[1] = s * y;
}
