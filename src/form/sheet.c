// Laying the sheet over an outline. The border follows it by whole panels; what that does to the sheet's size and proportions is mended
// here, since shapes tell by it: a rim holds a sheet that is 1 % longer than drawn in a bulge a tenth as high as it is long.
#include "form/state.h"

#include "base/vec.h"

#include <math.h>
#include <string.h>

static const double good_fit = 0.01, corner_weight = 0.12, count_weight = 0.2, search_range = 0.08;
enum { COUNT_ROUNDS = 6, SEARCH_STEPS = 40 };

// Area, and second moments of it about its middle over the square of the area: of what proportions it is, whatever its size.
typedef struct moments {
    double area, xx, xy, yy;
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
    return m;
}

static moments sheet_moments(const ax_lattice* lattice)
{
    const ax_linkage* linkage = &lattice->linkage;
    double cell =
        sqrt(3) / 4 * lattice->spacing * lattice->spacing; // what a panel takes up, with its share of the holes
    double first[2] = {0, 0}, xx = 0, xy = 0, yy = 0, t = linkage->triangle_count;
    for (int k = 0; k < linkage->triangle_count; ++k) {
        const int* h = linkage->triangles[k];
        double x[2];
        for (int c = 0; c < 2; ++c)
            x[c] = (lattice->hinges[h[0]][c] + lattice->hinges[h[1]][c] + lattice->hinges[h[2]][c]) / 3 -
                   lattice->offset[c];
        first[0] += x[0], first[1] += x[1];
        xx += x[0] * x[0], xy += x[0] * x[1], yy += x[1] * x[1];
    }
    double own = t * lattice->spacing * lattice->spacing / 24, area = t * cell, unit = cell / (area * area);
    return (moments){.area = area,
                     .xx = unit * (xx - first[0] * first[0] / t + own),
                     .xy = unit * (xy - first[0] * first[1] / t),
                     .yy = unit * (yy - first[1] * first[1] / t + own)};
}

// How much longer one way, and shorter across, a sheet is than its outline, once it has its area: half the relative change of its
// moments, as the norm of a matrix.
static double misfit(const ax_lattice* lattice, const moments* asked)
{
    moments m = sheet_moments(lattice);
    double det = asked->xx * asked->yy - asked->xy * asked->xy;
    double xx = (m.xx - asked->xx) / det, xy = (m.xy - asked->xy) / det, yy = (m.yy - asked->yy) / det;
    double a = asked->yy * xx - asked->xy * xy, b = asked->yy * xy - asked->xy * yy;
    double c = asked->xx * xy - asked->xy * xx, d = asked->xx * yy - asked->xy * xy;
    return 0.5 * sqrt(fmax(0, a * a + 2 * b * c + d * d));
}

// Where the outline turns by more than 30 degrees; counted in *count, owned by the caller.
static double (*list_corners(const ax_outline* outline, int* count))[2]
{
    double(*corners)[2] = ax_alloc((size_t)outline->count, sizeof *corners);
    *count = 0;
    for (int k = 0; k < outline->count; ++k) {
        const double *a = outline->points[(k + outline->count - 1) % outline->count], *b = outline->points[k],
                     *c = outline->points[(k + 1) % outline->count];
        double in[2] = {b[0] - a[0], b[1] - a[1]}, out[2] = {c[0] - b[0], c[1] - b[1]};
        if (fabs(atan2(ax_cross2(in, out), in[0] * out[0] + in[1] * out[1])) > AX_PI / 6)
            memcpy(corners[(*count)++], b, sizeof *corners);
    }
    return corners;
}

// What is asked of a sheet.
typedef struct fit {
    const ax_form_start* start;
    ax_outline outline;
    moments asked;
    int corner_count;
    double (*corners)[2];
} fit;

// Proportions first; then corners, which a last row of panels that is too short cuts off: sides of the rim are known by them; then the
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
    double share = lattice->linkage.triangle_count / (double)f->start->triangles;
    return misfit(lattice, &f->asked) + corner_weight * missed + count_weight * fabs(share - 1);
}

// Rows of panels are whole: 600 of them over 3 m by 1 m came out as 3.20 m by 0.94 m. Other numbers of panels near the one wanted have
// rows that end on the outline; the lattice stays where it is, for the sake of symmetry.
static void search_fit(const fit* f, ax_lattice* lattice)
{
    if (misfit(lattice, &f->asked) < good_fit)
        return;
    double best = badness(f, lattice), offset[2] = {lattice->offset[0], lattice->offset[1]};
    double spacing = sqrt(4 * f->asked.area / (sqrt(3) * f->start->triangles));
    for (int k = -SEARCH_STEPS; k <= SEARCH_STEPS; ++k) {
        ax_lattice other;
        ax_error ignored;
        double stretch = 1 + search_range * k / SEARCH_STEPS;
        if (ax_lattice_lay(&f->outline, spacing * stretch, f->start->angle, offset, false, &other, &ignored) != AX_OK)
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

// Whether the rim stands within the outline or without told a dome's rise at 600 panels from that at 2,500. The sheet as a whole is
// scaled to the area of its outline.
static void fit_area(ax_lattice* lattice, double area)
{
    double scale = sqrt(area / sheet_moments(lattice).area);
    for (int h = 0; h < lattice->linkage.hinge_count; ++h)
        for (int c = 0; c < 2; ++c)
            lattice->hinges[h][c] = lattice->offset[c] + scale * (lattice->hinges[h][c] - lattice->offset[c]);
    lattice->spacing *= scale;
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
    if (status == AX_OK && !(start->edge > 0) && !start->inside) {
        fit f = {.start = start, .outline = outline, .asked = outline_moments(&outline)};
        f.corners = list_corners(&outline, &f.corner_count);
        search_fit(&f, lattice);
        fit_area(lattice, f.asked.area);
        ax_free(f.corners);
    }
    ax_free(points);
    if (status == AX_OK)
        ax_lattice_renumber(lattice); // names of panels without minus signs
    return status;
}
