// Principal axes of points, after Eberly, A Robust Eigensolver for 3 x 3 Symmetric Matrices (2014): of the three
// eigenvalues one end is always well separated from the other two. Its vector comes from cofactors; the other two from
// the 2 x 2 problem in the plane across, which has no bad case at all. The usual cofactors for each of the three fail
// where two eigenvalues meet: every regular hexagon.
//
// When the separated axis is the long one the 2 x 2 matrix is summed from the points again, not from the 3 x 3 matrix:
// of points along a line within 1e-8 the products have lost the plane, the coordinates across have not.
#include "constraint/eigen3.h"

// cos(acos(r) / 3) for r in [0, 1], the largest root of 4 c^3 - 3 c = r: a cubic (4e-5), then Newton to rounding.
AX_INLINE double third_of_angle(double r)
{
    double c = 0.86606633 + r * (0.16533035 + r * (-0.0406912 + r * 0.00931968));
    c -= (4 * c * c * c - 3 * c - r) / (12 * c * c - 3);
    c -= (4 * c * c * c - 3 * c - r) / (12 * c * c - 3);
    return c;
}

// Unit eigenvector of the separated end of the symmetric matrix xx, xy, xz, yy, yz, zz; returns 1 if that is the
// largest, -1 if the smallest.
AX_INLINE double separated_axis(double xx, double xy, double xz, double yy, double yz, double zz, double e[3])
{
    // deviator in units of its own size: eigenvalues 2 cos(angle / 3 + 0, 120, 240 degrees), determinant 2 cos(angle)
    double trace = xx + yy + zz, s = trace > 0 ? 1 / trace : 0;
    xx = xx * s - 1.0 / 3, yy = yy * s - 1.0 / 3, zz = zz * s - 1.0 / 3;
    xy *= s, xz *= s, yz *= s;
    double size = sqrt((xx * xx + yy * yy + zz * zz + 2 * (xy * xy + xz * xz + yz * yz)) / 6);
    s = size > 0 ? 1 / size : 0;
    xx *= s, xy *= s, xz *= s, yy *= s, yz *= s, zz *= s;
    double r = 0.5 * (xx * (yy * zz - yz * yz) - xy * (xy * zz - yz * xz) + xz * (xy * yz - yy * xz));
    double bounded = fabs(r) < 1 ? fabs(r) : 1;
    double value = copysign(2 * third_of_angle(bounded), r);

    // every column of the cofactors of (matrix - value) is along the axis: the longest has lost least
    xx -= value, yy -= value, zz -= value;
    double a[3] = {yy * zz - yz * yz, yz * xz - xy * zz, xy * yz - yy * xz};
    double b[3] = {a[1], xx * zz - xz * xz, xy * xz - xx * yz}, c[3] = {a[2], b[2], xx * yy - xy * xy};
    double aa = ax_dot3(a, a), bb = ax_dot3(b, b), cc = ax_dot3(c, c);
    double x = aa > bb ? a[0] : b[0], y = aa > bb ? a[1] : b[1], z = aa > bb ? a[2] : b[2], most = aa > bb ? aa : bb;
    x = cc > most ? c[0] : x, y = cc > most ? c[1] : y, z = cc > most ? c[2] : z, most = cc > most ? cc : most;
    s = 1 / sqrt(most); // at least 1: the gap to both other values is at least sqrt(3)
    e[0] = x * s, e[1] = y * s, e[2] = z * s;
    return copysign(1, r);
}

void ax_principal_axes(int points, const ax_lane3* restrict y, ax_lane3 axis[restrict 3])
{
    ax_lane sum[6] = {0}, across[3] = {0}, largest;
    ax_lane3 e, u, v;
    for (int k = 0; k < points; ++k)
        for (int l = 0; l < AX_W; ++l) {
            double p = y[k][0][l], q = y[k][1][l], r = y[k][2][l];
            sum[0][l] += p * p, sum[1][l] += p * q, sum[2][l] += p * r;
            sum[3][l] += q * q, sum[4][l] += q * r, sum[5][l] += r * r;
        }
    for (int l = 0; l < AX_W; ++l) {
        double d[3], f[3], g[3];
        largest[l] = separated_axis(sum[0][l], sum[1][l], sum[2][l], sum[3][l], sum[4][l], sum[5][l], d);
        ax_perpendicular(d, f, g);
        double trace = sum[0][l] + sum[3][l] + sum[5][l],
               s = trace > 0 ? 1 / sqrt(trace) : 0; // squares of squares overflow
        for (int i = 0; i < 3; ++i)
            e[i][l] = d[i], u[i][l] = f[i], v[i][l] = g[i];
        sum[0][l] = s;
    }
    for (int k = 0; k < points; ++k)
        for (int l = 0; l < AX_W; ++l) {
            double s = sum[0][l], p = s * y[k][0][l], q = s * y[k][1][l], r = s * y[k][2][l];
            double a = u[0][l] * p + u[1][l] * q + u[2][l] * r, b = v[0][l] * p + v[1][l] * q + v[2][l] * r;
            across[0][l] += a * a, across[1][l] += a * b, across[2][l] += b * b;
        }
    for (int l = 0; l < AX_W; ++l) {
        // long axis of the 2 x 2 matrix, by the half-angle form that does not cancel
        double d = 0.5 * (across[0][l] - across[2][l]), g = across[1][l], r = sqrt(d * d + g * g);
        double t = fabs(d) + r, n = sqrt(t * t + g * g), s = n > 0 ? 1 / n : 0;
        double near = n > 0 ? t * s : 1, far = g * s, a = d >= 0 ? near : far, b = d >= 0 ? far : near;
        int first = largest[l] > 0;
        for (int i = 0; i < 3; ++i) {
            double p = a * u[i][l] + b * v[i][l], q = a * v[i][l] - b * u[i][l], c = e[i][l];
            axis[0][i][l] = first ? c : p;
            axis[1][i][l] = first ? p : q;
            axis[2][i][l] = first ? q : c;
        }
    }
}
