// triangle_area: keeps the area of a triangle in a range. With w = exp(2 pi i / 3) every triangle is alpha w^k + beta
// w^-k in its own plane; its sum of squares is 3 (|alpha|^2 + |beta|^2) and its area 3 sqrt(3)/4 (|alpha|^2 -
// |beta|^2). So the nearest triangle of area A keeps the two phases, and the moduli (a, b) go to the nearest point of
// the hyperbola a^2 - b^2 = 4 A / (3 sqrt(3)): one equation in one unknown. (ShapeOp takes four Newton steps on
// singular values towards the same point.)
#include "constraint/triangle.h"

enum { LO, HI, AREA, LANES, STEPS = 60 };

static const ax_parameter parameters[] = {
    {.name = "lo",
     .unit = "1",
     .doc = "smallest area / rest area",
     .standard = 1,
     .least = 0,
     .most = 1,
     .offset = LO,
     .lanes = 1},
    {.name = "hi",
     .unit = "1",
     .doc = "largest area / rest area",
     .standard = 1,
     .least = 1,
     .most = 1e6,
     .offset = HI,
     .lanes = 1},
    {.name = "area",
     .unit = "area",
     .doc = "rest area",
     .standard = 1,
     .least = 0,
     .most = 1e24,
     .offset = AREA,
     .lanes = 1},
};

static void rest(ax_lane* restrict block, int points, const ax_lane3* restrict x)
{
    (void)points;
    for (int l = 0; l < AX_W; ++l) {
        double u[3], v[3], r[3];
        ax_triangle_frame(x, l, u, v, r);
        block[AREA][l] = 0.5 * r[0] * r[2];
    }
}

// Nearest point of a^2 - b^2 = k to (a, b), all lanes, a >= b >= 0. On the way from (a, b) to it one of the two grows:
// with that one called x, starting at p, and the other starting at q, perpendicularity gives other = x q / (2 x - p),
// and x^2 - other^2 = t has one root beyond p. Newton between bounds.
static void to_hyperbola(ax_lane a, ax_lane b, const ax_lane k)
{
    ax_lane p, q, t, lo, hi, x, open;
    for (int l = 0; l < AX_W; ++l) {
        int grow = k[l] > (a[l] - b[l]) * (a[l] + b[l]);
        p[l] = grow ? a[l] : b[l], q[l] = grow ? b[l] : a[l], t[l] = grow ? k[l] : -k[l];
        double least = t[l] + 0.25 * q[l] * q[l], most = t[l] + q[l] * q[l]; // the other one is between q / 2 and q
        least = sqrt(least > 0 ? least : 0), most = sqrt(most > 0 ? most : 0);
        // when b grows, a is at least sqrt(k): decisive for a triangle that is equilateral but for rounding
        double root = sqrt(k[l]), room = 2 * root - q[l], bound = p[l] * root / (room > 0 ? room : 1);
        bound = room > 0 ? bound : most, bound = t[l] > 0 ? most : bound, bound = bound < most ? bound : most;
        lo[l] = least > p[l] ? least : p[l], hi[l] = bound > lo[l] ? bound : lo[l];
        x[l] = hi[l], open[l] = 1;
    }
    double any = 1;
    for (int step = 0; step < STEPS && any > 0; ++step) {
        for (int l = 0; l < AX_W; ++l) {
            double d = 2 * x[l] - p[l], s = 1 / (d > 0 ? d : 1), other = q[l] * (d > 0 ? x[l] * s : 1);
            double f = x[l] * x[l] - other * other - t[l], slope = 2 * x[l] + 2 * other * (q[l] * s) * (p[l] * s);
            lo[l] = f < 0 ? x[l] : lo[l], hi[l] = f > 0 ? x[l] : hi[l];
            double next = x[l] - f / (slope > 0 ? slope : 1),
                   middle = lo[l] > 0 ? sqrt(lo[l]) * sqrt(hi[l]) : 0.5 * hi[l];
            next = next >= lo[l] ? next : middle, next = next <= hi[l] ? next : middle;
            next = open[l] > 0 ? next : x[l]; // a lane that has arrived stays, whatever the others need
            open[l] = fabs(next - x[l]) > 4e-16 * x[l] ? open[l] : 0;
            x[l] = next;
        }
        any = 0;
        for (int l = 0; l < AX_W; ++l)
            any += open[l];
    }
    for (int l = 0; l < AX_W; ++l) {
        double d = 2 * x[l] - p[l], other = q[l] * (d > 0 ? x[l] / d : 1);
        b[l] = t[l] > 0 ? other : x[l];
        a[l] = sqrt(k[l] + b[l] * b[l]);
    }
}

static void project(const ax_lane* restrict block, const ax_place* place, int points, const ax_lane3* restrict y,
                    ax_lane3* restrict p)
{
    (void)place, (void)points;
    const double h = sqrt(0.75); // w = -1/2 + i h
    ax_lane3 u, v;
    ax_lane alpha[2], beta[2], a, b, k, inverse_a, inverse_b, outside;
    for (int l = 0; l < AX_W; ++l) {
        double e[3], f[3], r[3];
        ax_triangle_frame(y, l, e, f, r);
        double even = -0.5 * (r[0] + r[1]), odd = h * (r[1] - r[0]);
        double x = (even - h * r[2]) / 3, z = (odd - 0.5 * r[2]) / 3, c = (even + h * r[2]) / 3,
               d = (-odd - 0.5 * r[2]) / 3;
        a[l] = sqrt(x * x + z * z), b[l] = sqrt(c * c + d * d);
        inverse_a[l] = 1 / (a[l] > 0 ? a[l] : 1), inverse_b[l] = 1 / (b[l] > 0 ? b[l] : 1);
        alpha[0][l] = a[l] > 0 ? x : 1, alpha[1][l] = z, beta[0][l] = b[l] > 0 ? c : 1, beta[1][l] = d;
        double area = 0.5 * r[0] * r[2], lo = block[LO][l] * block[AREA][l], hi = block[HI][l] * block[AREA][l];
        double want = area < lo ? lo : (area > hi ? hi : area);
        k[l] = want / (1.5 * h), outside[l] = fabs(want - area) > 0 ? 1.0 : 0.0;
        for (int i = 0; i < 3; ++i)
            u[i][l] = e[i], v[i][l] = f[i];
    }
    to_hyperbola(a, b, k);
    for (int l = 0; l < AX_W; ++l) {
        double s = a[l] * inverse_a[l], t = b[l] * inverse_b[l];
        double x = s * alpha[0][l], z = s * alpha[1][l], c = t * beta[0][l], d = t * beta[1][l];
        double re0 = x + c, im0 = z + d, re1 = -0.5 * re0 + h * (d - z), im1 = -0.5 * im0 + h * (x - c);
        for (int i = 0; i < 3; ++i) {
            double p0 = re0 * u[i][l] + im0 * v[i][l], p1 = re1 * u[i][l] + im1 * v[i][l], out = outside[l];
            p[0][i][l] = out > 0 ? p0 : y[0][i][l];
            p[1][i][l] = out > 0 ? p1 : y[1][i][l];
            p[2][i][l] = out > 0 ? -(p0 + p1) : y[2][i][l];
        }
    }
}

const ax_constraint_type ax_constraint_triangle_area = {
    .name = "triangle_area",
    .doc = "Keeps the area of a triangle in a range around its rest area.",
    .reference = "Bouaziz et al. 2014, Projective Dynamics (area), solved to the nearest point",
    .pattern = AX_ROWS_CENTRED,
    .least_points = 3,
    .most_points = 3,
    .symmetry = AX_SYMMETRY_TRANSLATION | AX_SYMMETRY_ROTATION,
    .lanes = LANES,
    .parameters = parameters,
    .parameter_count = sizeof parameters / sizeof *parameters,
    .rest = rest,
    .project = project,
};
