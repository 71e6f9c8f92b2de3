// Laying the sheet over an outline. The border follows it by whole panels; what that does to the sheet's size and proportions is mended
// here, since shapes tell by it: a rim holds a sheet that is 1 % longer than drawn in a bulge a tenth as high as it is long.
#include "form/state.h"

#include "base/vec.h"

#include <math.h>
#include <string.h>

static const double least_lean = 1e-9, most_lean = 0.02, good_lean = 0.007; // of panels from equilateral
static const double good_waves = 0.008;                                     // of the rim about its outline
static const double least_shift = 1e-9;                                     // in spacings
static const double excess_weight = 10, wave_weight = 3, corner_weight = 0.12, count_weight = 0.2, search_range = 0.08;
enum { COUNT_ROUNDS = 6, SEARCH_STEPS = 40, WAVES = 9 };

// Area, and second moments of it about its middle over the square of the area: of what proportions it is, whatever its size.
typedef struct moments {
    double area, middle[2], xx, xy, yy;
} moments;

static moments outline_moments(const ax_outline* outline)
{
    moments m = {0};
    const double* o = outline->points[0]; // outlines far from the origin lose no digits
    double first[2] = {0, 0};
    for (int k = 0; k < outline->count; ++k) { // triangles from that point to each side
        const double *p = outline->points[k], *q = outline->points[(k + 1) % outline->count];
        double a[2] = {p[0] - o[0], p[1] - o[1]}, b[2] = {q[0] - o[0], q[1] - o[1]}, cross = ax_cross2(a, b);
        m.area += cross / 2;
        for (int c = 0; c < 2; ++c)
            first[c] += cross * (a[c] + b[c]) / 6;
        m.xx += cross * (a[0] * a[0] + a[0] * b[0] + b[0] * b[0]) / 12;
        m.xy += cross * (2 * a[0] * a[1] + a[0] * b[1] + b[0] * a[1] + 2 * b[0] * b[1]) / 24;
        m.yy += cross * (a[1] * a[1] + a[1] * b[1] + b[1] * b[1]) / 12;
    }
    double square = m.area * m.area;
    m.xx = (m.xx - first[0] * first[0] / m.area) / square;
    m.xy = (m.xy - first[0] * first[1] / m.area) / square;
    m.yy = (m.yy - first[1] * first[1] / m.area) / square;
    for (int c = 0; c < 2; ++c)
        m.middle[c] = o[c] + first[c] / m.area;
    return m;
}

// Where the outline turns by more than 30 degrees; counted in *count, owned by the caller. Oblique: somewhere by no right angle.
static double (*list_corners(const ax_outline* outline, int* count, bool* oblique))[2]
{
    static const double right = 1e-3;
    double(*corners)[2] = ax_alloc((size_t)outline->count, sizeof *corners);
    *count = 0, *oblique = false;
    for (int k = 0; k < outline->count; ++k) {
        const double *a = outline->points[(k + outline->count - 1) % outline->count], *b = outline->points[k],
                     *c = outline->points[(k + 1) % outline->count];
        double in[2] = {b[0] - a[0], b[1] - a[1]}, out[2] = {c[0] - b[0], c[1] - b[1]};
        double turn = fabs(atan2(ax_cross2(in, out), in[0] * out[0] + in[1] * out[1]));
        if (turn > AX_PI / 6) {
            memcpy(corners[(*count)++], b, sizeof *corners);
            *oblique = *oblique || fabs(turn - AX_PI / 2) > right;
        }
    }
    return corners;
}

// What is asked of a sheet.
typedef struct fit {
    const ax_form_start* start;
    ax_outline outline;
    ax_polyline* border; // the same, to find places on
    moments asked;
    double middle[2]; // of its extents
    int corner_count;
    double (*corners)[2];
    bool oblique; // corners
} fit;

// Whether a corner's last cell is missing at a rim hinge: hanging on one hinge it was left out. `other` is where its middle would be.
static bool is_cut(const fit* f, const ax_lattice* lattice, const double other[2])
{
    static const double near_corner = 1.5; // spacings
    bool near = false, inside = false;
    for (int k = 0; k < f->corner_count && !near; ++k)
        near = ax_distance2(other, f->corners[k]) < near_corner * lattice->spacing;
    for (int k = 0; k < f->outline.count && near; ++k) { // even-odd rule
        const double *a = f->outline.points[k], *b = f->outline.points[(k + 1) % f->outline.count];
        if ((a[1] > other[1]) != (b[1] > other[1]) &&
            other[0] < a[0] + (b[0] - a[0]) * (other[1] - a[1]) / (b[1] - a[1]))
            inside = !inside;
    }
    return inside;
}

// Cells that a corner lacks are counted: where the sides are is told by the others.
static moments sheet_moments(const fit* f, const ax_lattice* lattice)
{
    const ax_linkage* linkage = &lattice->linkage;
    double cell =
        sqrt(3) / 4 * lattice->spacing * lattice->spacing; // what a panel takes up, with its share of the holes
    double first[2] = {0, 0}, xx = 0, xy = 0, yy = 0, t = 0;
    for (int k = 0; k < linkage->triangle_count; ++k) {
        const int* h = linkage->triangles[k];
        double middle[2];
        for (int c = 0; c < 2; ++c)
            middle[c] = (lattice->hinges[h[0]][c] + lattice->hinges[h[1]][c] + lattice->hinges[h[2]][c]) / 3;
        for (int i = -1; i < 3; ++i) { // the panel, and what might be beyond its rim hinges
            double x[2] = {middle[0], middle[1]};
            if (i >= 0) {
                for (int c = 0; c < 2; ++c)
                    x[c] = 2 * lattice->hinges[h[i]][c] - middle[c];
                if (!linkage->on_rim[h[i]] || !is_cut(f, lattice, x))
                    continue;
            }
            x[0] -= lattice->offset[0], x[1] -= lattice->offset[1];
            first[0] += x[0], first[1] += x[1];
            xx += x[0] * x[0], xy += x[0] * x[1], yy += x[1] * x[1];
            ++t;
        }
    }
    double own = t * lattice->spacing * lattice->spacing / 24, area = t * cell, unit = cell / (area * area);
    return (moments){.area = area,
                     .middle = {lattice->offset[0] + first[0] / t, lattice->offset[1] + first[1] / t},
                     .xx = unit * (xx - first[0] * first[0] / t + own),
                     .xy = unit * (xy - first[0] * first[1] / t),
                     .yy = unit * (yy - first[1] * first[1] / t + own)};
}

// A symmetric matrix of determinant 1: half (1 + lean) along one direction, half (1 - lean) across.
typedef struct stretching {
    double xx, xy, yy, half, lean;
} stretching;

// That which brings the sheet to the proportions of its outline, whatever its size: S A S = B is solved by the geometric mean of the
// inverse of A and B, and of two such matrices this is their sum over the root of its determinant.
static stretching match(const moments* sheet, const moments* asked)
{
    double a = 1 / sqrt(sheet->xx * sheet->yy - sheet->xy * sheet->xy);
    double b = 1 / sqrt(asked->xx * asked->yy - asked->xy * asked->xy);
    stretching s = {
        .xx = a * sheet->yy + b * asked->xx, .xy = b * asked->xy - a * sheet->xy, .yy = a * sheet->xx + b * asked->yy};
    double root = sqrt(s.xx * s.yy - s.xy * s.xy);
    s.xx /= root, s.xy /= root, s.yy /= root;
    s.half = 0.5 * (s.xx + s.yy);
    s.lean = hypot(0.5 * (s.xx - s.yy), s.xy) / s.half;
    return s;
}

// The affine map of the sheet to its outline.
typedef struct affine {
    double from[2], to[2], xx, xy, yy, lean;
} affine;

static affine map_to_outline(const fit* f, const ax_lattice* lattice, double* scale)
{
    const moments m = sheet_moments(f, lattice), *asked = &f->asked;
    stretching s = match(&m, asked);
    affine a = {.lean = s.lean};
    memcpy(a.from, m.middle, sizeof a.from);
    memcpy(a.to, asked->middle, sizeof a.to);
    if (s.lean < least_lean) // as symmetric as its outline
        s.xx = s.yy = 1, s.xy = 0;
    if (ax_distance2(a.from, a.to) < least_shift * lattice->spacing) {
        memcpy(a.from, f->middle, sizeof a.from);
        memcpy(a.to, f->middle, sizeof a.to);
    }
    if (s.lean > most_lean) {
        double half = 1 / sqrt(1 - most_lean * most_lean), share = most_lean * half / (s.lean * s.half);
        s.xx = half + share * (s.xx - s.half), s.xy *= share, s.yy = half + share * (s.yy - s.half);
    }
    *scale = sqrt(asked->area / m.area);
    a.xx = *scale * s.xx, a.xy = *scale * s.xy, a.yy = *scale * s.yy;
    return a;
}

static void map_point(const affine* a, double x[2])
{
    double d[2] = {x[0] - a->from[0], x[1] - a->from[1]};
    x[0] = a->to[0] + a->xx * d[0] + a->xy * d[1];
    x[1] = a->to[1] + a->xy * d[0] + a->yy * d[1];
}

// How far a point is within the outline; negative: without.
static double depth_within(const ax_polyline* border, const double x[2])
{
    ax_polyline_point on = ax_polyline_find(border, (const double[3]){x[0], x[1], 0});
    double to[2] = {x[0] - on.point[0], x[1] - on.point[1]};
    return ax_cross2(on.tangent, to) < 0 ? -on.distance : on.distance;
}

// Border panels even out steps from one to the next; what they cannot is where the rim as a whole runs within its outline here and without
// there: the long waves of its distance, over the root of the area.
static double waves_of(const fit* f, const ax_lattice* lattice, const affine* map)
{
    const ax_linkage* linkage = &lattice->linkage;
    int *rim = AX_NEW(int, linkage->hinge_count), count = ax_linkage_rim(linkage, rim);
    double(*x)[2] = ax_alloc((size_t)count, sizeof *x), length = 0, s = 0, wave[WAVES][2] = {{0}}, sum = 0;
    for (int k = 0; k < count; ++k) {
        memcpy(x[k], lattice->hinges[rim[k]], sizeof *x);
        map_point(map, x[k]);
    }
    for (int k = 0; k < count; ++k)
        length += ax_distance2(x[k], x[(k + 1) % count]);
    for (int k = 0; k < count; ++k) {
        double before = ax_distance2(x[k], x[(k + count - 1) % count]), after = ax_distance2(x[k], x[(k + 1) % count]);
        double share = (before + after) / 2 / length * depth_within(f->border, x[k]);
        for (int w = 0; w < WAVES; ++w) {
            wave[w][0] += share * cos(2 * AX_PI * w * s / length);
            wave[w][1] += share * sin(2 * AX_PI * w * s / length);
        }
        s += after;
    }
    for (int w = 0; w < WAVES; ++w)
        sum += (w ? 4 : 1) * (wave[w][0] * wave[w][0] + wave[w][1] * wave[w][1]);
    ax_free(x);
    ax_free(rim);
    return sqrt(sum / f->asked.area);
}

// Proportions first, and that the rim keeps to its outline; then corners, which a last row of panels that is too short cuts off: sides of the rim are known by them; then the
// number of panels.
static double badness(const fit* f, const ax_lattice* lattice)
{
    double missed = 0; // the corner furthest from the rim, in spacings
    for (int k = 0; k < f->corner_count; ++k) {
        double nearest = INFINITY;
        for (int h = 0; h < lattice->linkage.hinge_count; ++h)
            if (lattice->linkage.on_rim[h])
                nearest = fmin(nearest, ax_distance2(lattice->hinges[h], f->corners[k]));
        missed = fmax(missed, nearest / lattice->spacing);
    }
    double share = lattice->linkage.triangle_count / (double)f->start->triangles, scale;
    affine map = map_to_outline(f, lattice, &scale);
    return map.lean + excess_weight * fmax(0, map.lean - most_lean) + wave_weight * waves_of(f, lattice, &map) +
           corner_weight * missed + count_weight * fabs(share - 1);
}

// Rows of panels are whole: 600 of them over 3 m by 1 m came out as 3.20 m by 0.94 m. Other numbers of panels near the one wanted have
// rows that end on the outline, or nearly so; the lattice stays where it is, for the sake of symmetry.
static void search_fit(const fit* f, ax_lattice* lattice)
{
    double scale;
    affine map = map_to_outline(f, lattice, &scale);
    if (map.lean < good_lean && waves_of(f, lattice, &map) < good_waves)
        return;
    double best = badness(f, lattice), spacing = sqrt(4 * f->asked.area / (sqrt(3) * f->start->triangles));
    for (int k = -SEARCH_STEPS; k <= SEARCH_STEPS; ++k) {
        ax_lattice other;
        ax_error ignored;
        double tried = spacing * (1 + search_range * k / SEARCH_STEPS);
        if (ax_lattice_lay(&f->outline, tried, f->start->angle, f->middle, false, &other, &ignored) != AX_OK)
            continue;
        double score = badness(f, &other);
        if (score < best) {
            best = score;
            ax_lattice_free(lattice);
            *lattice = other;
        } else
            ax_lattice_free(&other);
    }
}

// Whether the rim stands within the outline or without told a dome's rise at 600 panels from that at 2,500, and rows that miss a rectangle's
// side by 1 % are felt as much. The sheet as a whole is stretched to area and second moments of its outline: panels stay alike, and
// turn as equilateral ones do.
static void fit_outline(const fit* f, ax_lattice* lattice)
{
    double scale;
    affine map = map_to_outline(f, lattice, &scale);
    map_point(&map, lattice->offset);
    for (int h = 0; h < lattice->linkage.hinge_count; ++h)
        map_point(&map, lattice->hinges[h]);
    lattice->spacing *= scale;
    if (f->oblique) // else rows or their ends follow all sides, and panels of round sheets stay alike
        ax_form_fit_border(lattice, &f->outline, f->border, f->middle);
}

// The first side of a closed outline that runs across another one, -1 if none does; ends that touch are no crossing.
static int find_crossing(int n, const double (*x)[2])
{
    for (int i = 0; i < n; ++i) {
        const double *a = x[i], *b = x[(i + 1) % n];
        double lo = fmin(a[0], b[0]), hi = fmax(a[0], b[0]);
        for (int j = i + 2; j < n; ++j) {
            const double *c = x[j], *d = x[(j + 1) % n];
            if (fmin(c[0], d[0]) > hi || fmax(c[0], d[0]) < lo)
                continue;
            if (ax_orient2(a, b, c) * ax_orient2(a, b, d) < 0 && ax_orient2(c, d, a) * ax_orient2(c, d, b) < 0)
                return i;
        }
    }
    return -1;
}

ax_polyline* ax_form_outline_line(int count, const double (*points)[2])
{
    double(*lifted)[3] = ax_calloc((size_t)count, sizeof *lifted);
    for (int k = 0; k < count; ++k)
        memcpy(lifted[k], points[k], sizeof *points);
    ax_polyline* line = ax_polyline_make(count, (const double(*)[3])lifted);
    ax_free(lifted);
    return line;
}

ax_status ax_form_lay(const ax_form_start* start, ax_lattice* lattice, ax_error* error)
{
    *lattice = (ax_lattice){0};
    int n = start->outline_count;
    if (n < 3)
        return ax_fail(error, AX_USAGE, "An outline needs at least 3 points, %d are given.", n);
    double lo[2] = {INFINITY, INFINITY}, hi[2] = {-INFINITY, -INFINITY}, area = 0;
    for (int k = 0; k < n; ++k) {
        for (int c = 0; c < 2; ++c) {
            if (!isfinite(start->outline[k][c]))
                return ax_fail(error, AX_USAGE, "Point %d of the outline is no number.", k);
            lo[c] = fmin(lo[c], start->outline[k][c]), hi[c] = fmax(hi[c], start->outline[k][c]);
        }
        area += 0.5 * ax_cross2(start->outline[k], start->outline[(k + 1) % n]);
    }
    if (!(fabs(area) > 1e-12 * (hi[0] - lo[0]) * (hi[1] - lo[1])))
        return ax_fail(error, AX_USAGE, "The outline encloses no area.");
    int crossing = find_crossing(n, start->outline);
    if (crossing >= 0)
        return ax_fail(
            error, AX_USAGE,
            "The outline crosses itself after its point %d, at (%.4g, %.4g). Give the corners in their order "
            "round the sheet.",
            crossing, start->outline[crossing][0], start->outline[crossing][1]);
    if (!(start->scale >= 1 && start->scale <= 2))
        return ax_fail(error, AX_USAGE, "The scale factor %g is outside 1 to 2.", start->scale);
    double spacing = start->edge > 0 ? 2 * start->edge : sqrt(4 * fabs(area) / (sqrt(3) * fmax(start->triangles, 1)));
    double expected = 4 * fabs(area) / (sqrt(3) * spacing * spacing);
    if (!(expected >= 0.5 * AX_FORM_LEAST && expected <= AX_FORM_MOST))
        return ax_fail(error, AX_USAGE, "This outline would hold about %.0f triangles; %d to %d can be handled.",
                       expected, AX_FORM_LEAST, AX_FORM_MOST);

    // counter-clockwise; a lattice point in the middle, so that symmetric outlines get symmetric linkages
    double(*points)[2] = ax_alloc((size_t)n, sizeof *points);
    for (int k = 0; k < n; ++k)
        memcpy(points[k], start->outline[area > 0 ? k : n - 1 - k], sizeof *points);
    double middle[2] = {0.5 * (lo[0] + hi[0]), 0.5 * (lo[1] + hi[1])};
    ax_outline outline = {n, (const double(*)[2])points};
    ax_status status = AX_OK;
    for (int round = 0;; ++round) {
        status = ax_lattice_lay(&outline, spacing, start->angle, middle, start->inside, lattice, error);
        double share = status == AX_OK ? lattice->linkage.triangle_count / fmax(start->triangles, 1) : 1;
        if (status != AX_OK || start->edge > 0 || round == COUNT_ROUNDS || fabs(share - 1) < 0.02)
            break;
        ax_lattice_free(lattice);
        spacing *= sqrt(share);
    }
    if (status == AX_OK) {
        bool fits = !(start->edge > 0) && !start->inside;
        fit f = {
            .start = start, .outline = outline, .asked = outline_moments(&outline), .middle = {middle[0], middle[1]}};
        f.corners = list_corners(&outline, &f.corner_count, &f.oblique);
        f.border = ax_form_outline_line(n, (const double(*)[2])points);
        if (fits)
            search_fit(&f, lattice);
        ax_lattice_renumber(lattice); // names of panels without minus signs
        if (fits)
            fit_outline(&f, lattice);
        ax_polyline_free(f.border);
        ax_free(f.corners);
    }
    ax_free(points);
    return status;
}
