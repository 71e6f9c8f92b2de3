// Nearest points on curves.
// Ellipse: Eberly, Distance from a Point to an Ellipse, an Ellipsoid, or a Hyperellipsoid (2013), with Newton in place
// of bisection. Cubic pieces: Schneider, Solving the Nearest-Point-on-Curve Problem (Graphics Gems, 1990): (B(t) -
// x).B'(t) has degree five; in Bernstein form its sign changes bound its roots, so halving isolates every one of them.
// Sampling and descent miss the nearest one where the curve winds round x. Pieces are found through a tree of boxes
// over their order along the curve.
#include "constraint/place.h"

#include "ax/base.h"
#include "constraint/eigen3.h"

#include <assert.h>

enum { DEEPEST = 48, SPLINE_CUTS = 16, ELLIPSE_CUTS = 256 };

typedef enum curve_kind { LINE, ELLIPSE, POLYLINE, SPLINE } curve_kind;

typedef struct bezier {
    double b[4][3]; // Bezier points
} bezier;

typedef struct bounds {
    double lo[3], hi[3];
} bounds;

struct ax_curve {
    curve_kind kind;
    double point[3], u[3], v[3]; // line: origin, direction; ellipse: centre, unit semi-axes
    double a, b;                 // ellipse: their lengths
    bezier* pieces;
    bounds* boxes; // of a range of pieces, then of its first half, then of its second: 2 count - 1
    int count;
    bool closed;
    double* along; // length from the start to every cut; between them it is taken to be linear in t
    int cuts;      // equal ones in t over the whole curve; none on a line
};

static ax_curve* make(curve_kind kind)
{
    ax_curve* curve = AX_NEW0(ax_curve, 1);
    curve->kind = kind;
    return curve;
}

static void copy3(const double from[3], double to[3])
{
    to[0] = from[0], to[1] = from[1], to[2] = from[2];
}

static void measure_along(ax_curve* curve, int cuts)
{
    double end = ax_curve_extent(curve).to, last[3], next[3];
    curve->cuts = cuts;
    curve->along = AX_NEW0(double, cuts + 1);
    ax_curve_point(curve, 0, last);
    for (int k = 1; k <= cuts; ++k) {
        ax_curve_point(curve, end * k / cuts, next);
        curve->along[k] = curve->along[k - 1] + ax_distance3(last, next);
        copy3(next, last);
    }
}

// out = a + t (b - a)
static void between(const double a[3], const double b[3], double t, double out[3])
{
    for (int i = 0; i < 3; ++i)
        out[i] = (1 - t) * a[i] + t * b[i];
}

ax_curve* ax_curve_line(const double point[3], const double direction[3])
{
    ax_curve* curve = make(LINE);
    double length = ax_norm3(direction);
    copy3(point, curve->point);
    for (int i = 0; i < 3; ++i)
        curve->u[i] = length > 0 ? direction[i] / length : 0;
    return curve;
}

ax_curve* ax_curve_ellipse(const double centre[3], const double a[3], const double b[3])
{
    ax_curve* curve = make(ELLIPSE);
    double r[3];
    copy3(centre, curve->point);
    ax_frame(a, b, curve->u, curve->v, r);
    curve->a = r[0], curve->b = r[2];
    measure_along(curve, ELLIPSE_CUTS);
    return curve;
}

ax_curve* ax_curve_circle(const double centre[3], const double normal[3], double radius)
{
    double n[3], u[3], v[3], length = ax_norm3(normal);
    assert(radius >= 0);
    for (int i = 0; i < 3; ++i)
        n[i] = length > 0 ? normal[i] / length : i == 2;
    ax_perpendicular(n, u, v);
    ax_curve* curve = make(ELLIPSE);
    copy3(centre, curve->point), copy3(u, curve->u), copy3(v, curve->v);
    curve->a = curve->b = radius;
    measure_along(curve, ELLIPSE_CUTS);
    return curve;
}

static void make_boxes(ax_curve* curve, int first, int count, int node)
{
    bounds* box = &curve->boxes[node];
    for (int i = 0; i < 3; ++i) {
        box->lo[i] = INFINITY, box->hi[i] = -INFINITY;
        for (int k = 4 * first; k < 4 * (first + count); ++k) {
            double x = curve->pieces[k / 4].b[k % 4][i];
            box->lo[i] = fmin(box->lo[i], x), box->hi[i] = fmax(box->hi[i], x);
        }
    }
    if (count > 1) {
        int half = count / 2;
        make_boxes(curve, first, half, node + 1);
        make_boxes(curve, first + half, count - half, node + 2 * half);
    }
}

// Distinct neighbours among the points, at least one.
static int distinct(const double (*points)[3], int count, bool closed, double (*out)[3])
{
    int n = 0;
    for (int k = 0; k < count; ++k)
        if (n == 0 || ax_distance3(points[k], out[n - 1]) > 0)
            copy3(points[k], out[n++]);
    while (closed && n > 1 && !(ax_distance3(out[n - 1], out[0]) > 0))
        --n;
    return n;
}

// Knots a square root of the distance apart: derivative at b, for points a, b, c, in units of the span from b to c (or
// a to b).
static void tangent(const double a[3], const double b[3], const double c[3], double span, double out[3])
{
    double s = sqrt(ax_distance3(a, b)), t = sqrt(ax_distance3(b, c));
    for (int i = 0; i < 3; ++i)
        out[i] = span * ((b[i] - a[i]) / s - (c[i] - a[i]) / (s + t) + (c[i] - b[i]) / t);
}

// A curve of pieces that are given, owned by it from now on.
static ax_curve* of_pieces(curve_kind kind, bezier* pieces, int count, bool closed)
{
    ax_curve* curve = make(kind);
    curve->pieces = pieces, curve->count = count, curve->closed = closed;
    curve->boxes = AX_NEW(bounds, 2 * count - 1);
    make_boxes(curve, 0, count, 0);
    measure_along(curve, count * (kind == POLYLINE ? 1 : SPLINE_CUTS));
    return curve;
}

static bezier straight(const double from[3], const double to[3])
{
    bezier piece;
    copy3(from, piece.b[0]), copy3(to, piece.b[3]);
    between(from, to, 1.0 / 3, piece.b[1]), between(from, to, 2.0 / 3, piece.b[2]);
    return piece;
}

static ax_curve* make_pieces(curve_kind kind, const double (*points)[3], int count, bool closed)
{
    assert(count >= 1);
    double(*p)[3] = ax_alloc((size_t)count, sizeof *p);
    int n = distinct(points, count, closed, p);
    closed = closed && n > 1;
    int pieces = n == 1 ? 1 : n - !closed;
    bezier* piece = AX_NEW(bezier, pieces);
    for (int k = 0; k < pieces; ++k) {
        const double *b = p[k], *c = p[(k + 1) % n];
        piece[k] = straight(b, c);
        double(*at)[3] = piece[k].b;
        if (kind == SPLINE && n > 2) {
            // an open end has no neighbour beyond: the chord itself would make a kink of the curvature, its mirror
            // image does not
            double before[3], after[3], m[3], span = sqrt(ax_distance3(b, c));
            for (int i = 0; i < 3; ++i) {
                before[i] = closed || k > 0 ? p[(k + n - 1) % n][i] : 2 * b[i] - c[i];
                after[i] = closed || k + 2 < n ? p[(k + 2) % n][i] : 2 * c[i] - b[i];
            }
            tangent(before, b, c, span, m);
            for (int i = 0; i < 3; ++i)
                at[1][i] = b[i] + m[i] / 3;
            tangent(b, c, after, span, m);
            for (int i = 0; i < 3; ++i)
                at[2][i] = c[i] - m[i] / 3;
        }
    }
    ax_free(p);
    return of_pieces(kind, piece, pieces, closed);
}

ax_curve* ax_curve_polyline(const double (*points)[3], int count, bool closed)
{
    return make_pieces(POLYLINE, points, count, closed);
}

ax_curve* ax_curve_spline(const double (*points)[3], int count, bool closed)
{
    return make_pieces(SPLINE, points, count, closed);
}

// The arc that rounds the corner b between a and c as two cubic pieces; false where there is nothing to round. `room`: along each side.
static bool round_corner(const double a[3], const double b[3], const double c[3], double radius, double room,
                         bezier arc[2])
{
    double u[3], v[3], middle[3], reach = 0;
    ax_sub3(a, b, u), ax_sub3(c, b, v);
    double lu = ax_norm3(u), lv = ax_norm3(v), cosine = -ax_dot3(u, v) / (lu * lv); // of the turn
    if (!(cosine < 1 - 1e-12) || cosine < -1 + 1e-12)
        return false;
    double turn = acos(cosine), half = 0.5 * turn, cut = fmin(radius * tan(half), room);
    radius = cut / tan(half);
    for (int i = 0; i < 3; ++i) {
        u[i] = cut * u[i] / lu, v[i] = cut * v[i] / lv;
        middle[i] = u[i] + v[i];
    }
    reach = ax_norm3(middle); // from the corner, the arc's middle lies radius / cos(half) - radius along
    double handle = 4.0 / 3 * tan(turn / 8) * radius, along[3], length;
    ax_sub3(v, u, along);
    length = ax_norm3(along);
    for (int i = 0; i < 3; ++i) {
        double top = b[i] + middle[i] / reach * (radius / cos(half) - radius), slope = handle * along[i] / length;
        arc[0].b[0][i] = b[i] + u[i];
        arc[0].b[1][i] = b[i] + u[i] * (1 - handle / cut);
        arc[0].b[2][i] = top - slope;
        arc[0].b[3][i] = arc[1].b[0][i] = top;
        arc[1].b[1][i] = top + slope;
        arc[1].b[2][i] = b[i] + v[i] * (1 - handle / cut);
        arc[1].b[3][i] = b[i] + v[i];
    }
    return true;
}

ax_curve* ax_curve_rounded(const double (*points)[3], int count, bool closed, double radius)
{
    double(*p)[3] = ax_alloc((size_t)count, sizeof *p);
    int n = distinct(points, count, closed, p), pieces = 0;
    if (!(radius > 0) || n < 3) {
        ax_free(p);
        return ax_curve_polyline(points, count, closed);
    }
    bezier *piece = AX_NEW(bezier, 3 * n), arc[2];
    double at[3], first[3];
    copy3(p[0], at);
    for (int k = closed ? 0 : 1; k < n - !closed; ++k) { // the side up to each corner, and its arc
        const double *a = p[(k + n - 1) % n], *b = p[k], *c = p[(k + 1) % n];
        double before = ax_distance3(a, b), after = ax_distance3(b, c), *end = p[k];
        bool round = round_corner(a, b, c, radius, 0.5 * fmin(before, after), arc);
        double* start = round ? arc[0].b[0] : end;
        if (closed && k == 0)
            copy3(start, first); // its side comes last
        else if (ax_distance3(at, start) > 1e-9 * before)
            piece[pieces++] = straight(at, start);
        copy3(round ? arc[1].b[3] : end, at);
        for (int i = 0; round && i < 2; ++i)
            piece[pieces++] = arc[i];
    }
    double* last = closed ? first : p[n - 1];
    if (ax_distance3(at, last) > 1e-9 * ax_distance3(p[n - 1], p[closed ? 0 : n - 2]))
        piece[pieces++] = straight(at, last);
    ax_free(p);
    return of_pieces(SPLINE, piece, pieces, closed);
}

void ax_curve_free(ax_curve* curve)
{
    if (curve) {
        ax_free(curve->pieces);
        ax_free(curve->boxes);
        ax_free(curve->along);
        ax_free(curve);
    }
}

// Nearest point of the ellipse (x/a)^2 + (y/b)^2 = 1, a >= b > 0, to x, y >= 0.
static void ellipse_nearest(double a, double b, double x, double y, double* u, double* v)
{
    // the nearest point is (x r / (s + r - 1), y / s) with r = (a / b)^2 and s > 0 the root of
    // G(s) = (n / (s + r - 1))^2 + (z / s)^2 - 1, convex and falling
    double r = (a / b) * (a / b), more = (a / b - 1) * (a / b + 1), n = r * x / a, z = y / b;
    if (y > 0) {
        // each term alone is at most 1: a start on the left of the root, from where Newton never passes it
        double s = fmax(z, n - more);
        for (int step = 0; step < 200; ++step) {
            double p = n / (s + more), q = z / s, g = p * p + q * q - 1;
            double next = s + 0.5 * g / (p * p / (s + more) + q * q / s);
            if (!(next > s))
                break;
            s = next;
        }
        *u = x * r / (s + more), *v = y / s;
    } else if (a * x < (a - b) * (a + b)) { // between the centres of curvature of the long axis: off the axis
        double c = a * x / ((a - b) * (a + b));
        *u = a * c, *v = b * sqrt((1 - c) * (1 + c));
    } else {
        *u = a, *v = 0;
    }
}

static double nearest_on_ellipse(const ax_curve* curve, const double x[3], double out[3])
{
    double d[3], a = curve->a, b = curve->b, longer = fmax(a, b), shorter = fmin(a, b), c,
                 s; // cosine and sine of the angle
    ax_sub3(x, curve->point, d);
    double p = ax_dot3(d, curve->u), q = ax_dot3(d, curve->v);
    if (a == b) {
        double length = sqrt(p * p + q * q);
        c = length > 0 ? p / length : 1, s = length > 0 ? q / length : 0;
    } else {
        double e = fabs(a > b ? p : q), f = fabs(a > b ? q : p), u, v;
        if (shorter > 1e-12 * longer) {
            ellipse_nearest(longer, shorter, e, f, &u, &v);
            u /= longer, v /= shorter;
        } else { // as good as a segment
            u = fmin(e / longer, 1), v = sqrt((1 - u) * (1 + u));
        }
        c = copysign(a > b ? u : v, p), s = copysign(a > b ? v : u, q);
    }
    for (int i = 0; i < 3; ++i)
        out[i] = curve->point[i] + a * c * curve->u[i] + b * s * curve->v[i];
    double turn = atan2(s, c) / (2 * AX_PI);
    return turn < 0 ? turn + 1 : turn;
}

typedef struct query {
    const ax_curve* curve;
    const double* x;
    double square, t; // the best so far: squared distance, parameter
    double out[3];
} query;

static void piece_point(const bezier* piece, double t, double out[3])
{
    double c[4][3];
    for (int k = 0; k < 3; ++k)
        between(piece->b[k], piece->b[k + 1], t, c[k]);
    for (int n = 2; n > 0; --n)
        for (int k = 0; k < n; ++k)
            between(c[k], c[k + 1], t, c[k]);
    copy3(c[0], out);
}

// p, at t of piece `index`, is the nearest if it is nearer than what was.
static void offer_point(query* best, int index, double t, const double p[3])
{
    double d[3];
    ax_sub3(p, best->x, d);
    double square = ax_dot3(d, d);
    if (square < best->square) {
        best->square = square, best->t = index + t;
        copy3(p, best->out);
    }
}

static void offer(query* best, int index, double t)
{
    double p[3];
    piece_point(&best->curve->pieces[index], t, p);
    offer_point(best, index, t, p);
}

// Bernstein coefficients of the two halves of a quintic (de Casteljau).
static void halve(const double w[6], double left[6], double right[6])
{
    double c[6];
    for (int k = 0; k < 6; ++k)
        c[k] = w[k];
    for (int n = 5; n >= 0; --n) {
        left[5 - n] = c[0], right[n] = c[n];
        for (int k = 0; k < n; ++k)
            c[k] = 0.5 * (c[k] + c[k + 1]);
    }
}

// The one root of a quintic in (0, 1) that rises from negative to positive there: Newton between bounds.
static double quintic_root(const double w[6])
{
    // powers of t by differences of the coefficients
    static const double binomial[6] = {1, 5, 10, 10, 5, 1};
    double c[6], lo = 0, hi = 1, t = w[0] / (w[0] - w[5]);
    for (int k = 0; k < 6; ++k)
        c[k] = w[k];
    for (int n = 1; n < 6; ++n)
        for (int k = 5; k >= n; --k)
            c[k] -= c[k - 1];
    for (int k = 0; k < 6; ++k)
        c[k] *= binomial[k];
    for (int step = 0; step < 64; ++step) {
        double value = c[5], slope = 0;
        for (int k = 4; k >= 0; --k)
            slope = slope * t + value, value = value * t + c[k];
        if (value < 0)
            lo = t;
        else
            hi = t;
        double next = t - value / slope;
        if (!(next > lo && next < hi))
            next = 0.5 * (lo + hi);
        if (fabs(next - t) <= 1e-16)
            break;
        t = next;
    }
    return t;
}

// Offers every root of the quintic, which stands for [lo, lo + size] of a piece.
static void offer_roots(query* best, int index, const double w[6], double lo, double size, int depth)
{
    int changes = 0;
    double last = 0;
    for (int k = 0; k < 6; ++k)
        if (w[k] != 0) {
            changes += last * w[k] < 0;
            last = w[k] < 0 ? -1 : 1;
        }
    if (changes == 0) {
        return; // a root at an end is offered as the end or by the other half
    } else if (changes == 1 && w[0] != 0 && w[5] != 0) {
        if (w[0] < 0) // the other way the distance has a maximum
            offer(best, index, lo + size * quintic_root(w));
    } else if (depth == DEEPEST) {
        offer(best, index, lo + 0.5 * size);
    } else {
        double left[6], right[6];
        halve(w, left, right);
        offer_roots(best, index, left, lo, 0.5 * size, depth + 1);
        if (right[0] == 0)
            offer(best, index, lo + 0.5 * size);
        offer_roots(best, index, right, lo + 0.5 * size, 0.5 * size, depth + 1);
    }
}

static void search_piece(query* best, int index)
{
    const bezier* piece = &best->curve->pieces[index];
    offer_point(best, index, 0, piece->b[0]);
    offer_point(best, index, 1, piece->b[3]);
    double d[4][3], e[3][3];
    for (int k = 0; k < 4; ++k)
        ax_sub3(piece->b[k], best->x, d[k]);
    for (int k = 0; k < 3; ++k)
        ax_sub3(piece->b[k + 1], piece->b[k], e[k]);
    if (best->curve->kind == POLYLINE) {
        double chord[3];
        ax_sub3(piece->b[3], piece->b[0], chord);
        double square = ax_dot3(chord, chord), t = -ax_dot3(d[0], chord) / square;
        if (t > 0 && t < 1) // not so for a point, without a length
            offer(best, index, t);
    } else {
        // product of the Bernstein forms of B - x and B' / 3
        static const double cubic[4] = {1, 3, 3, 1}, square[3] = {1, 2, 1}, quintic[6] = {1, 5, 10, 10, 5, 1};
        double w[6] = {0};
        for (int i = 0; i < 4; ++i)
            for (int j = 0; j < 3; ++j)
                w[i + j] += cubic[i] * square[j] / quintic[i + j] * ax_dot3(d[i], e[j]);
        offer_roots(best, index, w, 0, 1, 0);
    }
}

static double box_square(const bounds* box, const double x[3])
{
    double sum = 0;
    for (int i = 0; i < 3; ++i) {
        double d = fmax(0, fmax(box->lo[i] - x[i], x[i] - box->hi[i]));
        sum += d * d;
    }
    return sum;
}

static void search_range(query* best, int first, int count, int node)
{
    if (count == 1) {
        search_piece(best, first);
        return;
    }
    int half = count / 2, left = node + 1, right = node + 2 * half;
    double a = box_square(&best->curve->boxes[left], best->x), b = box_square(&best->curve->boxes[right], best->x);
    for (int side = 0; side < 2; ++side) { // the nearer half first
        bool second = (b < a) != side;
        if ((second ? b : a) < best->square)
            search_range(best, second ? first + half : first, second ? count - half : half, second ? right : left);
    }
}

double ax_curve_nearest(const ax_curve* curve, const double x[3], double out[3])
{
    if (curve->kind == LINE) {
        double d[3];
        ax_sub3(x, curve->point, d);
        double t = ax_dot3(d, curve->u);
        for (int i = 0; i < 3; ++i)
            out[i] = curve->point[i] + t * curve->u[i];
        return t;
    }
    if (curve->kind == ELLIPSE)
        return nearest_on_ellipse(curve, x, out);
    query best = {.curve = curve, .x = x, .square = INFINITY};
    search_range(&best, 0, curve->count, 0);
    copy3(best.out, out);
    return curve->closed && best.t >= curve->count ? 0 : best.t;
}

// The piece that t lies on; t becomes the fraction of the way along it.
static int piece_at(const ax_curve* curve, double* t)
{
    double n = curve->count;
    *t = curve->closed ? *t - n * floor(*t / n) : ax_clamp(*t, 0, n);
    int index = *t < n ? (int)*t : curve->count - 1;
    *t -= index;
    return index;
}

void ax_curve_point(const ax_curve* curve, double t, double out[3])
{
    if (curve->kind == LINE || curve->kind == ELLIPSE) {
        double x = t, y = 0;
        if (curve->kind == ELLIPSE)
            x = curve->a * cos(2 * AX_PI * t), y = curve->b * sin(2 * AX_PI * t);
        for (int i = 0; i < 3; ++i)
            out[i] = curve->point[i] + x * curve->u[i] + y * curve->v[i];
        return;
    }
    int index = piece_at(curve, &t);
    piece_point(&curve->pieces[index], t, out);
}

void ax_curve_derivatives(const ax_curve* curve, double t, double first[3], double second[3])
{
    if (curve->kind == LINE) {
        copy3(curve->u, first);
        second[0] = second[1] = second[2] = 0;
        return;
    }
    if (curve->kind == ELLIPSE) {
        double turn = 2 * AX_PI, x = curve->a * cos(turn * t), y = curve->b * sin(turn * t);
        double dx = -curve->a * sin(turn * t), dy = curve->b * cos(turn * t);
        for (int i = 0; i < 3; ++i) {
            first[i] = turn * (dx * curve->u[i] + dy * curve->v[i]);
            second[i] = -turn * turn * (x * curve->u[i] + y * curve->v[i]);
        }
        return;
    }
    const double(*b)[3] = (const double(*)[3])curve->pieces[piece_at(curve, &t)].b;
    double s = 1 - t;
    for (int i = 0; i < 3; ++i) {
        double d[3] = {b[1][i] - b[0][i], b[2][i] - b[1][i], b[3][i] - b[2][i]};
        first[i] = 3 * (s * s * d[0] + 2 * s * t * d[1] + t * t * d[2]);
        second[i] = curve->kind == POLYLINE ? 0 : 6 * (s * (d[1] - d[0]) + t * (d[2] - d[1]));
    }
}

ax_curve_range ax_curve_extent(const ax_curve* curve)
{
    if (curve->kind == LINE)
        return (ax_curve_range){-INFINITY, INFINITY, false, true};
    if (curve->kind == ELLIPSE)
        return (ax_curve_range){0, 1, true, true};
    bool straight = curve->kind == POLYLINE || (curve->closed && curve->count == 2); // there and back
    return (ax_curve_range){0, curve->count, curve->closed, !straight || curve->count == 1};
}

bool ax_curve_stops(const ax_curve* curve, double t)
{
    ax_curve_range range = ax_curve_extent(curve);
    return (!range.closed && (t <= range.from || t >= range.to)) || (!range.smooth && fabs(t - round(t)) < 1e-9);
}

double ax_curve_length(const ax_curve* curve, double t)
{
    if (curve->kind == LINE)
        return t;
    double at = t * curve->cuts / ax_curve_extent(curve).to;
    int cut = (int)ax_clamp(floor(at), 0, curve->cuts - 1);
    return curve->along[cut] + (at - cut) * (curve->along[cut + 1] - curve->along[cut]);
}

double ax_curve_at_length(const ax_curve* curve, double length)
{
    if (curve->kind == LINE)
        return length;
    ax_curve_range range = ax_curve_extent(curve);
    double whole = curve->along[curve->cuts];
    if (range.closed && whole > 0)
        length -= whole * floor(length / whole);
    int lo = 0, hi = curve->cuts; // the cut whose stretch holds it
    while (hi - lo > 1) {
        int middle = (lo + hi) / 2;
        *(curve->along[middle] <= length ? &lo : &hi) = middle;
    }
    double stretch = curve->along[hi] - curve->along[lo];
    double at = lo + (stretch > 0 ? ax_clamp((length - curve->along[lo]) / stretch, 0, 1) : 0);
    return at * range.to / curve->cuts;
}

static void place_nearest(const void* geometry, const double x[3], double out[3])
{
    ax_curve_nearest(geometry, x, out);
}

static double place_parameter(const void* geometry, const double x[3], double out[3])
{
    return ax_curve_length(geometry, ax_curve_nearest(geometry, x, out));
}

static void place_point(const void* geometry, double length, double out[3])
{
    ax_curve_point(geometry, ax_curve_at_length(geometry, length), out);
}

ax_place ax_curve_place(const ax_curve* curve)
{
    double period = ax_curve_extent(curve).closed ? curve->along[curve->cuts] : 0;
    return (ax_place){place_nearest, curve, place_parameter, place_point, period};
}
