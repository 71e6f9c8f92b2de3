// Corners and sides of a sheet: those of the outline that it was laid over, whatever the lattice makes of them; else those of its rim.
#include "operator/selection.h"

#include "base/vec.h"

#include <math.h>
#include <string.h>

static const double sharp_turn = 25 * AX_PI / 180; // of a corner, at least; a dodecagon's are 30 degrees
static const double round_turn = 60 * AX_PI / 180; // at a point of a rounded one, at most
static const double round_radius = 0.3; // of a rounded one, at most, over that of a disk as large as the sheet
static const double same = 1e-9;        // radii between points that are one given twice
static const double straight = 0.05;    // by how much of its length a side between rounded corners may bulge

// The outline, counter-clockwise, and by which angle it turns at each of its points.
typedef struct path {
    int count;
    double (*at)[2], *turn, radius; // of a disk as large
} path;

static path measure_outline(const ax_form_view* view)
{
    int n = view->outline_count;
    path p = {0, ax_alloc((size_t)n, sizeof *p.at), AX_NEW(double, n), 0};
    double area = 0;
    for (int k = 0; k < n; ++k)
        area += 0.5 * ax_cross2(view->outline[k], view->outline[(k + 1) % n]);
    p.radius = sqrt(fabs(area) / AX_PI);
    for (int k = 0; k < n; ++k) {
        const double *at = view->outline[area > 0 ? k : n - 1 - k],
                     *next = view->outline[area > 0 ? (k + 1) % n : (2 * n - 2 - k) % n];
        if (ax_distance2(at, next) > same * p.radius)
            memcpy(p.at[p.count++], at, sizeof *p.at);
    }
    n = p.count;
    for (int k = 0; k < n; ++k) {
        const double *a = p.at[(k + n - 1) % n], *b = p.at[k], *c = p.at[(k + 1) % n];
        double in[2] = {b[0] - a[0], b[1] - a[1]}, out[2] = {c[0] - b[0], c[1] - b[1]};
        p.turn[k] = atan2(ax_cross2(in, out), in[0] * out[0] + in[1] * out[1]);
    }
    return p;
}

// Where the outline turns: at a point, or round several.
typedef struct bend {
    int from, to; // cyclic, both included
    double turn, at[2];
} bend;

// Whether a point and the next belong to one rounded corner.
static bool is_round(const path* p, int k)
{
    int next = (k + 1) % p->count;
    double a = p->turn[k], b = p->turn[next], sum = fabs(a) + fabs(b);
    return a * b > 0 && fmax(fabs(a), fabs(b)) < round_turn &&
           ax_distance2(p->at[k], p->at[next]) < round_radius * p->radius * sum / 2;
}

static bend make_bend(const path* p, int from)
{
    bend b = {.from = from, .to = from, .turn = p->turn[from]};
    double length = 0;
    for (int next; is_round(p, b.to) && (next = (b.to + 1) % p->count) != from; b.to = next) {
        length += ax_distance2(p->at[b.to], p->at[next]);
        b.turn += p->turn[next];
    }
    memcpy(b.at, p->at[from], sizeof b.at);
    double left = length / 2;
    for (int k = from; k != b.to && left > 0; k = (k + 1) % p->count) {
        const double *x = p->at[k], *y = p->at[(k + 1) % p->count];
        double step = ax_distance2(x, y), part = left < step ? left / step : 1;
        for (int c = 0; c < 2; ++c)
            b.at[c] = x[c] + part * (y[c] - x[c]);
        left -= step;
    }
    return b;
}

// Whether the outline from one bend to the next is nearly straight.
static bool is_straight(const path* p, const bend* a, const bend* b)
{
    const double *from = p->at[a->to], *to = p->at[b->from];
    double most = 0;
    for (int k = a->to; k != b->from; k = (k + 1) % p->count)
        most = fmax(most, ax_segment_distance2(p->at[k], from, to));
    return most < straight * ax_distance2(from, to);
}

// Corners of the outline. A rounded one counts beside a side that is straight: the ends of an ellipse are none.
static int find_in_outline(const ax_form_view* view, double (*at)[2])
{
    path p = measure_outline(view);
    bend* bends = AX_NEW(bend, p.count);
    int n = 0, found = 0, start = 0;
    while (start < p.count && is_round(&p, (start + p.count - 1) % p.count))
        ++start;
    for (int gone = 0; gone < p.count && start < p.count;) {
        bend b = make_bend(&p, (start + gone) % p.count);
        gone += (b.to - b.from + p.count) % p.count + 1;
        if (fabs(b.turn) > sharp_turn)
            bends[n++] = b;
    }
    for (int k = 0; k < n; ++k) {
        const bend *b = &bends[k], *before = &bends[(k + n - 1) % n], *after = &bends[(k + 1) % n];
        bool is_corner = b->from == b->to || (n > 1 && (is_straight(&p, before, b) || is_straight(&p, b, after)));
        if (is_corner && found++ < AX_CORNERS_MOST)
            memcpy(at[found - 1], b->at, sizeof *at);
    }
    ax_free(bends);
    ax_free(p.at);
    ax_free(p.turn);
    return found > AX_CORNERS_MOST ? 0 : found;
}

enum { SHORTEST_SIDE = 6 }; // hinges, on average

// Douglas and Peucker (1973) between places i and j of the cyclic order.
static void split(const ax_form_view* view, int count, const int* rim, int i, int j, double tolerance,
                  unsigned char* corner)
{
    int farthest = -1;
    double most = tolerance;
    for (int k = i + 1; k < j; ++k) {
        double d =
            ax_segment_distance2(view->sheet[rim[k % count]], view->sheet[rim[i % count]], view->sheet[rim[j % count]]);
        if (d > most)
            most = d, farthest = k;
    }
    if (farthest < 0)
        return;
    corner[farthest % count] = 1;
    split(view, count, rim, i, farthest, tolerance, corner);
    split(view, count, rim, farthest, j, tolerance, corner);
}

// How far the middle of a side lies outside its outer parts. Its ends do not count: there the lattice may be cut.
static double bulge(const ax_form_view* view, int count, const int* rim, int i, int j)
{
    const double *a = view->sheet[rim[i % count]], *b = view->sheet[rim[j % count]];
    double length = ax_distance2(a, b), sum[2] = {0, 0};
    int n[2] = {0, 0};
    for (int k = i + 1; k < j; ++k) {
        bool middle = 3 * (k - i) >= j - i && 3 * (k - i) <= 2 * (j - i);
        sum[middle] -= ax_orient2(a, b, view->sheet[rim[k % count]]) / length;
        ++n[middle];
    }
    return n[0] && n[1] ? sum[1] / n[1] - sum[0] / n[0] : 0;
}

// A corner that lacks its last panels turns at both ends of its cut, two hinges apart: it is where its middle one is.
static void join_cut(int count, unsigned char* corner)
{
    for (int k = 0; k < count; ++k)
        if (corner[k] && corner[(k + 2) % count]) {
            corner[k] = corner[(k + 2) % count] = 0;
            corner[(k + 1) % count] = 1;
        }
}

// Corners of a rim of which no outline is known, told from its hinges. Their number, at most that of the hinges.
static int find_in_rim(const ax_form_view* view, int count, const int* rim, int* found)
{
    double middle[2], most = -1, tolerance = view->spacing;
    int first = 0, second = 0, n = 0;
    ax_sheet_middle(view, middle);
    for (int k = 0; k < count; ++k) {
        double d = ax_distance2(view->sheet[rim[k]], middle);
        if (d > most)
            most = d, first = k;
    }
    most = -1;
    for (int k = 0; k < count; ++k) {
        double d = ax_distance2(view->sheet[rim[k]], view->sheet[rim[first]]);
        if (d > most)
            most = d, second = k;
    }
    unsigned char* corner = AX_NEW0(unsigned char, count);
    corner[first] = corner[second] = 1;
    split(view, count, rim, first, second > first ? second : second + count, tolerance, corner);
    split(view, count, rim, second, first > second ? first : first + count, tolerance, corner);
    join_cut(count, corner);
    for (int k = 0; k < count; ++k)
        if (corner[k])
            found[n++] = k;
    ax_free(corner);
    double bulges = 0; // a round rim is a polygon within the tolerance, too, but all its sides bulge
    for (int k = 0; k < n; ++k)
        bulges += bulge(view, count, rim, found[k], k + 1 < n ? found[k + 1] : found[0] + count);
    return n < 3 || n > AX_CORNERS_MOST || count < SHORTEST_SIDE * n || bulges > 0.12 * n * tolerance ? 0 : n;
}

// The line that fits the inner parts of a side best, as a point and a direction; at its ends the lattice may be cut.
static void fit_side(const ax_form_view* view, int count, const int* rim, int i, int j, double point[2],
                     double along[2])
{
    double xx = 0, xy = 0, yy = 0;
    int n = 0;
    point[0] = point[1] = 0;
    for (int pass = 0; pass < 2; ++pass)
        for (int k = i + (j - i) / 6 + 1; k < j - (j - i) / 6; ++k) {
            const double* x = view->sheet[rim[k % count]];
            if (!pass) {
                ++n;
                for (int c = 0; c < 2; ++c)
                    point[c] += (x[c] - point[c]) / n;
            } else {
                double u = x[0] - point[0], v = x[1] - point[1];
                xx += u * u, xy += u * v, yy += v * v;
            }
        }
    double turn = 0.5 * atan2(2 * xy, xx - yy);
    along[0] = cos(turn), along[1] = sin(turn);
}

// Where the sides that meet at corner k would meet as straight lines; the hinge there if they are not.
static void meet_sides(const ax_form_view* view, int count, const int* rim, int n, const int* corners, int k,
                       double place[2])
{
    double a[2], b[2], u[2], v[2];
    int before = corners[(k + n - 1) % n], at = corners[k], after = corners[(k + 1) % n];
    fit_side(view, count, rim, before, at > before ? at : at + count, a, u);
    fit_side(view, count, rim, at, after > at ? after : after + count, b, v);
    double turn = ax_cross2(u, v), between[2] = {b[0] - a[0], b[1] - a[1]}, t = ax_cross2(between, v) / turn;
    for (int c = 0; c < 2; ++c)
        place[c] = a[c] + t * u[c];
    if (!(ax_distance2(place, view->sheet[rim[at]]) < view->spacing))
        memcpy(place, view->sheet[rim[at]], 2 * sizeof *place);
}

// Of the outline's extents, or of the sheet's.
static void find_middle(const ax_form_view* view, double middle[2])
{
    ax_sheet_middle(view, middle);
    for (int c = 0; c < 2 && view->outline_count > 0; ++c) {
        double lo = INFINITY, hi = -INFINITY;
        for (int k = 0; k < view->outline_count; ++k)
            lo = fmin(lo, view->outline[k][c]), hi = fmax(hi, view->outline[k][c]);
        middle[c] = (lo + hi) / 2;
    }
}

// The hinge of the rim that is nearest to a place.
static int nearest_of(const ax_form_view* view, int count, const int* rim, const double at[2])
{
    int nearest = 0;
    for (int k = 1; k < count; ++k)
        if (ax_distance2(view->sheet[rim[k]], at) < ax_distance2(view->sheet[rim[nearest]], at))
            nearest = k;
    return nearest;
}

int ax_select_corners(const ax_form_view* view, int count, const int* rim, ax_corner corners[AX_CORNERS_MOST])
{
    double at[AX_CORNERS_MOST][2], middle[2];
    int n;
    if (view->outline_count > 0) {
        n = find_in_outline(view, at);
    } else {
        int* found = AX_NEW(int, count);
        n = find_in_rim(view, count, rim, found);
        for (int k = 0; k < n; ++k)
            meet_sides(view, count, rim, n, found, k, at[k]);
        ax_free(found);
    }
    int first = 0;
    double smallest = INFINITY;
    find_middle(view, middle);
    for (int k = 0; k < n; ++k) {
        // straight to the right is first, whatever rounding makes of it
        double angle = fmod(ax_angle_about(middle, at[k]) + 1, 360);
        if (angle < smallest)
            smallest = angle, first = k;
    }
    for (int k = 0; k < n; ++k) {
        ax_corner* corner = &corners[k];
        memcpy(corner->at, at[(first + k) % n], sizeof corner->at);
        corner->place = nearest_of(view, count, rim, corner->at);
    }
    for (int k = 0; k + 1 < n; ++k) // sides without a hinge of their own are none
        if ((corners[k + 1].place - corners[0].place + count) % count <=
            (corners[k].place - corners[0].place + count) % count)
            return 0;
    return n < 2 ? 0 : n;
}
