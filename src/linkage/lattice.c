// The trihexagonal linkage as medial graph of a regular triangular lattice; selection of the lattice triangles inside an
// outline follows the centroid rule, which leaves rim hinges within 0.4 spacings of the outline.
#include "linkage/lattice.h"

#include "base/vec.h"

#include <assert.h>
#include <limits.h>
#include <stdlib.h>
#include <string.h>

// Window of the lattice: columns i0 .. i0 + width, rows j0 .. j0 + height; two triangles per cell.
typedef struct window {
    int i0, j0, width, height;
    unsigned char* keep; // [row][column][up, down]
} window;

static size_t cell(const window* w, int i, int j)
{
    return ((size_t)(j - w->j0) * (size_t)w->width + (size_t)(i - w->i0)) * 2;
}

static bool kept(const window* w, int i, int j, int down)
{
    return i >= w->i0 && j >= w->j0 && i < w->i0 + w->width && j < w->j0 + w->height && w->keep[cell(w, i, j) + down];
}

// The three neighbours of a triangle across its edges.
static void neighbours(int i, int j, int down, int out[3][3])
{
    const int up_to_down[3][2] = {{0, 0}, {-1, 0}, {0, -1}}, down_to_up[3][2] = {{0, 0}, {1, 0}, {0, 1}};
    for (int k = 0; k < 3; ++k) {
        out[k][0] = i + (down ? down_to_up[k][0] : up_to_down[k][0]);
        out[k][1] = j + (down ? down_to_up[k][1] : up_to_down[k][1]);
        out[k][2] = !down;
    }
}

// The six triangles around lattice point (i, j), counter-clockwise from the direction of increasing i.
static const int around[6][3] = {{0, 0, 0}, {-1, 0, 1}, {-1, 0, 0}, {-1, -1, 1}, {0, -1, 0}, {0, -1, 1}};

// Edges of the lattice: kind 0 from (i, j) to (i + 1, j), 1 to (i, j + 1), 2 from (i + 1, j) to (i, j + 1).
// The six edges that leave lattice point (i, j), counter-clockwise, each just before the triangle of the same index.
static const int spokes[6][3] = {{0, 0, 0}, {0, 0, 1}, {-1, 0, 2}, {-1, 0, 0}, {0, -1, 1}, {0, -1, 2}};

// Edges opposite the corners of the up and of the down triangle of a cell, counter-clockwise.
static const int sides[2][3][3] = {{{0, 0, 2}, {0, 0, 1}, {0, 0, 0}}, {{0, 1, 0}, {0, 0, 2}, {1, 0, 1}}};

static int ascending(const void* a, const void* b)
{
    double x = *(const double*)a, y = *(const double*)b;
    return (x > y) - (x < y);
}

// Marks which of the points (first + k, row y), k = 0 .. count - 1, lie inside the outline, for all rows y = y0 + r: even-odd rule
// along scan lines. The outline is in lattice units (x, y sheared to columns and rows).
typedef struct scan {
    int rows;
    int* start; // rows + 1
    double* crossing;
} scan;

static scan scan_outline(int count, const double (*points)[2], double y0, int rows)
{
    scan s = {.rows = rows, .start = AX_NEW0(int, rows + 1)};
    for (int pass = 0; pass < 2; ++pass) {
        int* fill = pass ? ax_copy(s.start, (size_t)rows + 1, sizeof *fill) : NULL;
        for (int k = 0; k < count; ++k) {
            const double *a = points[k], *b = points[(k + 1) % count];
            double lo = fmin(a[1], b[1]), hi = fmax(a[1], b[1]);
            // half-open in y, so that a vertex on a scan line counts once
            int first = (int)fmax(0, ceil(lo - y0)), last = (int)fmin(rows - 1, ceil(hi - y0) - 1);
            for (int r = first; r <= last; ++r)
                if (pass)
                    s.crossing[fill[r]++] = a[0] + (b[0] - a[0]) * ((y0 + r - a[1]) / (b[1] - a[1]));
                else
                    ++s.start[r + 1];
        }
        if (pass) {
            ax_free(fill);
            break;
        }
        for (int r = 0; r < rows; ++r)
            s.start[r + 1] += s.start[r];
        s.crossing = AX_NEW(double, s.start[rows]);
    }
    for (int r = 0; r < rows; ++r)
        qsort(s.crossing + s.start[r], (size_t)(s.start[r + 1] - s.start[r]), sizeof(double), ascending);
    return s;
}

// Calls the points x = x0 + k inside: sets inside[k * stride] |= bit.
static void fill_row(const scan* s, int row, double x0, int count, unsigned char* inside, int stride, int bit)
{
    for (int k = s->start[row]; k + 1 < s->start[row + 1]; k += 2) {
        int first = (int)fmax(0, ceil(s->crossing[k] - x0));
        int last = (int)fmin(count - 1, floor(s->crossing[k + 1] - x0));
        for (int i = first; i <= last; ++i)
            inside[(size_t)i * (size_t)stride] |= (unsigned char)bit;
    }
}

static void scan_free(scan* s)
{
    ax_free(s->start);
    ax_free(s->crossing);
}

// Bit set for every cell (i, j) of the window whose point (i + dx, j + dy) lies inside.
static void mark(const window* w, int count, const double (*points)[2], double dx, double dy, unsigned char* bits,
                 int stride, int bit)
{
    scan s = scan_outline(count, points, w->j0 + dy, w->height);
    for (int r = 0; r < w->height; ++r)
        fill_row(&s, r, w->i0 + dx, w->width, bits + (size_t)r * (size_t)w->width * (size_t)stride, stride, bit);
    scan_free(&s);
}

static void select_triangles(window* w, int count, const double (*points)[2], bool inside)
{
    if (!inside) { // centroids, in sheared lattice coordinates
        mark(w, count, points, 1.0 / 3, 1.0 / 3, w->keep, 2, 1);
        mark(w, count, points, 2.0 / 3, 2.0 / 3, w->keep + 1, 2, 1);
        return;
    }
    unsigned char* edges = AX_NEW0(unsigned char, (size_t)w->width*(size_t)w->height);
    mark(w, count, points, 0.5, 0, edges, 1, 1);
    mark(w, count, points, 0, 0.5, edges, 1, 2);
    mark(w, count, points, 0.5, 0.5, edges, 1, 4);
    for (int j = w->j0; j < w->j0 + w->height - 1; ++j)
        for (int i = w->i0; i < w->i0 + w->width - 1; ++i)
            for (int down = 0; down < 2; ++down) {
                bool all = true;
                for (int k = 0; k < 3; ++k) {
                    const int* e = sides[down][k];
                    all = all && edges[cell(w, i + e[0], j + e[1]) / 2] >> e[2] & 1;
                }
                w->keep[cell(w, i, j) + (size_t)down] = all;
            }
    ax_free(edges);
}

// Removes triangles with fewer than two neighbours, and those around pinched lattice points. True if any was removed.
static bool prune(window* w)
{
    bool changed = false;
    for (int j = w->j0; j < w->j0 + w->height; ++j)
        for (int i = w->i0; i < w->i0 + w->width; ++i) {
            for (int down = 0; down < 2; ++down)
                if (kept(w, i, j, down)) {
                    int near[3][3], held = 0;
                    neighbours(i, j, down, near);
                    for (int k = 0; k < 3; ++k)
                        held += kept(w, near[k][0], near[k][1], near[k][2]);
                    if (held < 2)
                        w->keep[cell(w, i, j) + (size_t)down] = 0, changed = true;
                }
            int fans = 0;
            for (int k = 0; k < 6; ++k)
                fans += kept(w, i + around[k][0], j + around[k][1], around[k][2]) &&
                        !kept(w, i + around[(k + 5) % 6][0], j + around[(k + 5) % 6][1], around[(k + 5) % 6][2]);
            if (fans > 1) {
                changed = true;
                for (int k = 0; k < 6; ++k)
                    if (kept(w, i + around[k][0], j + around[k][1], around[k][2]))
                        w->keep[cell(w, i + around[k][0], j + around[k][1]) + (size_t)around[k][2]] = 0;
            }
        }
    return changed;
}

// Keeps the largest part that is connected through hinges; the first of equal ones.
static void keep_largest(window* w)
{
    size_t total = (size_t)w->width * (size_t)w->height * 2;
    int *part = AX_NEW0(int, total), *stack = AX_NEW(int, total), parts = 0, best = 0, best_size = 0;
    for (size_t s = 0; s < total; ++s) {
        if (!w->keep[s] || part[s])
            continue;
        int size = 0, top = 0;
        stack[top++] = (int)s, part[s] = ++parts;
        while (top) {
            int t = stack[--top], near[3][3];
            ++size;
            neighbours(w->i0 + t / 2 % w->width, w->j0 + t / 2 / w->width, t & 1, near);
            for (int k = 0; k < 3; ++k)
                if (kept(w, near[k][0], near[k][1], near[k][2])) {
                    size_t next = cell(w, near[k][0], near[k][1]) + (size_t)near[k][2];
                    if (!part[next])
                        part[next] = parts, stack[top++] = (int)next;
                }
        }
        if (size > best_size)
            best_size = size, best = parts;
    }
    for (size_t s = 0; s < total; ++s)
        w->keep[s] = w->keep[s] && part[s] == best;
    ax_free(part);
    ax_free(stack);
}

// Numbers hinges in the order of their cells and fills the linkage; `point` maps lattice coordinates to the plane.
static void connect(const window* w, ax_lattice* lattice)
{
    size_t cells = (size_t)w->width * (size_t)w->height;
    ax_linkage* linkage = &lattice->linkage;
    int *id = AX_NEW(int, 3 * cells), *uses = AX_NEW0(int, 3 * cells), triangles = 0;
    for (int j = w->j0; j < w->j0 + w->height; ++j)
        for (int i = w->i0; i < w->i0 + w->width; ++i)
            for (int down = 0; down < 2; ++down)
                if (kept(w, i, j, down)) {
                    ++triangles;
                    for (int k = 0; k < 3; ++k) {
                        const int* e = sides[down][k];
                        ++uses[cell(w, i + e[0], j + e[1]) / 2 * 3 + (size_t)e[2]];
                    }
                }
    int hinges = 0;
    for (size_t e = 0; e < 3 * cells; ++e)
        id[e] = uses[e] ? hinges++ : -1;

    linkage->triangle_count = triangles, linkage->hinge_count = hinges;
    linkage->triangles = ax_alloc((size_t)triangles, sizeof *linkage->triangles);
    linkage->panels = ax_alloc((size_t)triangles, sizeof *linkage->panels);
    linkage->on_rim = AX_NEW0(unsigned char, hinges);
    lattice->hinges = ax_alloc((size_t)hinges, sizeof *lattice->hinges);
    double c = cos(lattice->angle) * lattice->spacing, s = sin(lattice->angle) * lattice->spacing;
    const double middle[3][2] = {{0.5, 0}, {0, 0.5}, {0.5, 0.5}};
    for (size_t e = 0; e < 3 * cells; ++e)
        if (id[e] >= 0) {
            int i = w->i0 + (int)(e / 3 % (size_t)w->width), j = w->j0 + (int)(e / 3 / (size_t)w->width);
            double x = i + middle[e % 3][0], y = j + middle[e % 3][1], u = x + 0.5 * y, v = 0.5 * sqrt(3) * y;
            lattice->hinges[id[e]][0] = lattice->offset[0] + c * u - s * v;
            lattice->hinges[id[e]][1] = lattice->offset[1] + s * u + c * v;
            linkage->on_rim[id[e]] = uses[e] == 1;
        }

    int t = 0, holes = 0, openings = 0, hole_hinges = 0, opening_hinges = 0;
    for (int j = w->j0; j < w->j0 + w->height; ++j)
        for (int i = w->i0; i < w->i0 + w->width; ++i) {
            for (int down = 0; down < 2; ++down)
                if (kept(w, i, j, down)) {
                    for (int k = 0; k < 3; ++k) {
                        const int* e = sides[down][k];
                        linkage->triangles[t][k] = id[cell(w, i + e[0], j + e[1]) / 2 * 3 + (size_t)e[2]];
                    }
                    linkage->panels[t][0] = i, linkage->panels[t][1] = j, linkage->panels[t][2] = down, ++t;
                }
        }
    // holes and openings around lattice points; a first pass counts
    for (int pass = 0; pass < 2; ++pass) {
        if (pass) {
            linkage->hole_start = AX_NEW0(int, holes + 1);
            linkage->hole_hinges = AX_NEW(int, hole_hinges);
            linkage->opening_start = AX_NEW0(int, openings + 1);
            linkage->opening_hinges = AX_NEW(int, opening_hinges);
        }
        holes = openings = hole_hinges = opening_hinges = 0;
        for (int j = w->j0; j <= w->j0 + w->height; ++j)
            for (int i = w->i0; i <= w->i0 + w->width; ++i) {
                int count = 0, first = -1;
                for (int k = 0; k < 6; ++k) {
                    bool here = kept(w, i + around[k][0], j + around[k][1], around[k][2]);
                    bool before =
                        kept(w, i + around[(k + 5) % 6][0], j + around[(k + 5) % 6][1], around[(k + 5) % 6][2]);
                    count += here;
                    if (here && !before)
                        first = k;
                }
                if (count < 2)
                    continue; // a single panel bounds no opening
                int loop[7], length = count == 6 ? 6 : count + 1;
                for (int k = 0; k < length; ++k) {
                    const int* e = spokes[((count == 6 ? 0 : first) + k) % 6];
                    loop[k] = id[cell(w, i + e[0], j + e[1]) / 2 * 3 + (size_t)e[2]];
                }
                int* list = count == 6 ? linkage->hole_hinges : linkage->opening_hinges;
                int* used = count == 6 ? &hole_hinges : &opening_hinges;
                if (pass)
                    memcpy(list + *used, loop, (size_t)length * sizeof *loop);
                *used += length;
                if (count == 6) {
                    ++holes;
                    if (pass)
                        linkage->hole_start[holes] = hole_hinges;
                } else {
                    ++openings;
                    if (pass)
                        linkage->opening_start[openings] = opening_hinges;
                }
            }
    }
    linkage->hole_count = holes, linkage->opening_count = openings;
    ax_free(id);
    ax_free(uses);
}

ax_status ax_lattice_lay(const ax_outline* outline, double spacing, double angle, const double offset[2], bool inside,
                         ax_lattice* out, ax_error* error)
{
    assert(outline->count >= 3 && spacing > 0);
    *out = (ax_lattice){.spacing = spacing, .angle = angle, .offset = {offset[0], offset[1]}};

    // the outline in lattice coordinates: columns and rows
    double(*points)[2] = ax_alloc((size_t)outline->count, sizeof *points);
    double lo[2] = {INFINITY, INFINITY}, hi[2] = {-INFINITY, -INFINITY}, c = cos(angle), s = sin(angle);
    for (int k = 0; k < outline->count; ++k) {
        double x = outline->points[k][0] - offset[0], y = outline->points[k][1] - offset[1];
        double v = (c * y - s * x) / spacing / (0.5 * sqrt(3)), u = (c * x + s * y) / spacing - 0.5 * v;
        points[k][0] = u, points[k][1] = v;
        for (int d = 0; d < 2; ++d)
            lo[d] = fmin(lo[d], points[k][d]), hi[d] = fmax(hi[d], points[k][d]);
    }
    window w = {.i0 = (int)floor(lo[0]) - 2, .j0 = (int)floor(lo[1]) - 2};
    w.width = (int)ceil(hi[0]) + 3 - w.i0, w.height = (int)ceil(hi[1]) + 3 - w.j0;
    w.keep = AX_NEW0(unsigned char, (size_t)w.width*(size_t)w.height * 2);

    select_triangles(&w, outline->count, (const double(*)[2])points, inside);
    do
        keep_largest(&w);
    while (prune(&w));
    connect(&w, out);
    ax_free(points);
    ax_free(w.keep);
    int count = out->linkage.triangle_count;
    if (count < 12) {
        ax_lattice_free(out);
        return ax_fail(error, AX_CANNOT_REALISE,
                       "Only %d triangles fit into the outline at a lattice spacing of %g. Ask for more triangles or a "
                       "shorter edge.",
                       count, spacing);
    }
    return AX_OK;
}

void ax_lattice_free(ax_lattice* lattice)
{
    ax_linkage_free(&lattice->linkage);
    ax_free(lattice->hinges);
    *lattice = (ax_lattice){0};
}

void ax_lattice_renumber(ax_lattice* lattice)
{
    ax_linkage* linkage = &lattice->linkage;
    int lowest[2] = {INT_MAX, INT_MAX};
    for (int t = 0; t < linkage->triangle_count; ++t)
        for (int d = 0; d < 2; ++d)
            if (linkage->panels[t][d] < lowest[d])
                lowest[d] = linkage->panels[t][d];
    for (int t = 0; t < linkage->triangle_count; ++t)
        for (int d = 0; d < 2; ++d)
            linkage->panels[t][d] -= lowest[d];
    for (int d = 0; d < 2; ++d) { // columns run along the rows, rows at 60 degrees to them
        double direction = lattice->angle + d * AX_PI / 3;
        lattice->offset[0] += lattice->spacing * lowest[d] * cos(direction);
        lattice->offset[1] += lattice->spacing * lowest[d] * sin(direction);
    }
}

int (*ax_linkage_mouths(const ax_linkage* linkage, int* count))[3]
{
    int most = linkage->hole_start[linkage->hole_count] + linkage->opening_start[linkage->opening_count], used = 0;
    int(*mouths)[3] = ax_alloc((size_t)most, sizeof *mouths);
    for (int h = 0; h < linkage->hole_count; ++h) {
        const int* loop = linkage->hole_hinges + linkage->hole_start[h];
        int n = linkage->hole_start[h + 1] - linkage->hole_start[h];
        for (int k = 0; k < n; ++k, ++used)
            mouths[used][0] = loop[(k + n - 1) % n], mouths[used][1] = loop[k], mouths[used][2] = loop[(k + 1) % n];
    }
    for (int h = 0; h < linkage->opening_count; ++h) {
        const int* fan = linkage->opening_hinges + linkage->opening_start[h];
        int n = linkage->opening_start[h + 1] - linkage->opening_start[h];
        for (int k = 1; k + 1 < n; ++k, ++used)
            mouths[used][0] = fan[k - 1], mouths[used][1] = fan[k], mouths[used][2] = fan[k + 1];
    }
    *count = used;
    return mouths;
}

double ax_mouth_angle(const double previous[2], const double hinge[2], const double next[2])
{
    double a[2] = {previous[0] - hinge[0], previous[1] - hinge[1]}, b[2] = {next[0] - hinge[0], next[1] - hinge[1]};
    double angle = atan2(ax_cross2(b, a), a[0] * b[0] + a[1] * b[1]);
    return angle < -AX_PI / 3 ? angle + 2 * AX_PI : angle;
}

int (*ax_linkage_hinge_triangles(const ax_linkage* linkage))[2]
{
    int(*owners)[2] = ax_alloc((size_t)linkage->hinge_count, sizeof *owners);
    memset(owners, -1, (size_t)linkage->hinge_count * sizeof *owners);
    for (int t = 0; t < linkage->triangle_count; ++t)
        for (int k = 0; k < 3; ++k) {
            int* owner = owners[linkage->triangles[t][k]];
            owner[owner[0] >= 0] = t;
        }
    return owners;
}

void ax_lattice_twist(const ax_lattice* lattice, const double* scale, double (*flat)[2])
{
    const ax_linkage* linkage = &lattice->linkage;
    memset(flat, 0, (size_t)linkage->hinge_count * sizeof *flat);
    for (int t = 0; t < linkage->triangle_count; ++t) {
        const int* corner = linkage->triangles[t];
        double centre[2] = {0, 0};
        for (int k = 0; k < 3; ++k)
            for (int d = 0; d < 2; ++d)
                centre[d] += lattice->hinges[corner[k]][d] / 3;
        // scale (cos, sin) of the turn: the cosine is 1 / scale
        double c = 1, s = sqrt(fmax(0, scale[t] * scale[t] - 1)) * (linkage->panels[t][2] ? -1 : 1);
        for (int k = 0; k < 3; ++k) {
            const double* m = lattice->hinges[corner[k]];
            double x = m[0] - centre[0], y = m[1] - centre[1], share = linkage->on_rim[corner[k]] ? 1 : 0.5;
            flat[corner[k]][0] += share * (centre[0] + c * x - s * y);
            flat[corner[k]][1] += share * (centre[1] + s * x + c * y);
        }
    }
}
