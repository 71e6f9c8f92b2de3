// Fewer sizes of panel: narrowest intervals of the mean edge, or by distance where panels are not equilateral; and the misfit.
#include "ax/cluster.h"

#include "base/vec.h"
#include "linkage/lattice.h"

#include <assert.h>
#include <stdlib.h>
#include <string.h>

enum { ROUNDS = 8 };
static const double most_work = 3e8; // comparisons of a panel with a size

void ax_clusters_free(ax_clusters* clusters)
{
    if (!clusters)
        return;
    ax_free(clusters->sizes);
    ax_free(clusters->size_of);
    ax_free(clusters->turn);
    *clusters = (ax_clusters){0};
}

typedef double edges[3];

typedef struct sorted {
    double mean;
    int panel;
} sorted;

static int by_mean(const void* a, const void* b)
{
    const sorted *x = a, *y = b;
    return x->mean != y->mean ? (x->mean > y->mean) - (x->mean < y->mean) : x->panel - y->panel;
}

typedef struct work {
    const ax_design* design;
    int n;
    edges* edge;   // mm
    sorted* order; // by mean edge
} work;

static void begin(work* w, const ax_design* design)
{
    double mm = 1000 * ax_unit_in_metres(design->unit);
    *w = (work){.design = design, .n = design->linkage.triangle_count};
    w->edge = ax_alloc((size_t)w->n, sizeof *w->edge);
    w->order = AX_NEW(sorted, w->n);
    for (int t = 0; t < w->n; ++t) {
        const int* h = design->linkage.triangles[t];
        for (int k = 0; k < 3; ++k)
            w->edge[t][k] = mm * ax_distance2(design->flat[h[(k + 1) % 3]], design->flat[h[(k + 2) % 3]]);
        w->order[t] = (sorted){(w->edge[t][0] + w->edge[t][1] + w->edge[t][2]) / 3, t};
    }
    qsort(w->order, (size_t)w->n, sizeof *w->order, by_mean);
}

static void end(work* w)
{
    ax_free(w->edge);
    ax_free(w->order);
}

// Largest difference of an edge, with corner `turn` of the panel at the size's corner 0; the best turn.
static double difference(const edges panel, const edges size, int* turn)
{
    double best = INFINITY;
    for (int r = 0; r < 3; ++r) {
        double worst = 0;
        for (int k = 0; k < 3; ++k)
            worst = fmax(worst, fabs(panel[(k + r) % 3] - size[k]));
        if (worst < best)
            best = worst, *turn = r;
    }
    return best;
}

// --- sizes

// How many intervals of `width` cover the mean edges; with `size_of`, numbers them.
static int cover(const work* w, double width, int* size_of)
{
    int count = 0;
    double start = -INFINITY;
    for (int i = 0; i < w->n; ++i) {
        if (w->order[i].mean > start + width) {
            start = w->order[i].mean;
            ++count;
        }
        if (size_of)
            size_of[w->order[i].panel] = count - 1;
    }
    return count;
}

// Narrowest intervals, at most `count`, that cover the mean edges: exact where panels are equilateral.
static int divide_by_mean(const work* w, int count, int* size_of)
{
    double lo = 0,
           hi = (w->order[w->n - 1].mean - w->order[0].mean) * (1 + 1e-9); // one interval, whatever rounding does
    for (int i = 0; i < 60 && cover(w, lo, NULL) > count; ++i) {
        double middle = (lo + hi) / 2;
        if (cover(w, middle, NULL) > count)
            lo = middle;
        else
            hi = middle;
    }
    return cover(w, cover(w, lo, NULL) > count ? hi : lo, size_of);
}

// The farthest panel from all chosen begins the next size (Gonzalez 1985).
static int divide_by_distance(const work* w, int count, int* size_of)
{
    double* far = AX_NEW(double, w->n);
    int next = w->order[0].panel, sizes = 0, turn;
    for (int t = 0; t < w->n; ++t)
        far[t] = INFINITY;
    while (sizes < count && far[next] > 0) {
        int centre = next;
        for (int t = 0; t < w->n; ++t) {
            double d = difference(w->edge[t], w->edge[centre], &turn);
            if (d < far[t])
                far[t] = d, size_of[t] = sizes;
        }
        ++sizes;
        for (int t = 0; t < w->n; ++t)
            next = far[t] > far[next] ? t : next;
    }
    ax_free(far);
    return sizes;
}

// The middle of each size's panels, turned to fit what it was (at first its first panel); counts, turns and errors.
static void measure_sizes(const work* w, ax_clusters* c, bool first)
{
    edges *lo = ax_alloc((size_t)c->size_count, sizeof *lo), *hi = ax_alloc((size_t)c->size_count, sizeof *hi);
    for (int s = 0; s < c->size_count; ++s) {
        c->sizes[s].count = 0;
        for (int k = 0; k < 3; ++k)
            lo[s][k] = INFINITY, hi[s][k] = -INFINITY;
    }
    for (int t = 0; t < w->n; ++t) {
        ax_panel_size* s = &c->sizes[c->size_of[t]];
        int turn = 0;
        if (first && s->count == 0)
            memcpy(s->edges, w->edge[t], sizeof s->edges);
        difference(w->edge[t], s->edges, &turn);
        ++s->count;
        for (int k = 0; k < 3; ++k) {
            lo[c->size_of[t]][k] = fmin(lo[c->size_of[t]][k], w->edge[t][(k + turn) % 3]);
            hi[c->size_of[t]][k] = fmax(hi[c->size_of[t]][k], w->edge[t][(k + turn) % 3]);
        }
    }
    for (int s = 0; s < c->size_count; ++s)
        for (int k = 0; k < 3 && c->sizes[s].count; ++k)
            c->sizes[s].edges[k] = lo[s][k] / 2 + hi[s][k] / 2;
    ax_free(lo);
    ax_free(hi);
}

static void measure_errors(const work* w, ax_clusters* c)
{
    double squares = 0;
    c->edge_max = 0;
    for (int s = 0; s < c->size_count; ++s)
        c->sizes[s].error = 0;
    for (int t = 0; t < w->n; ++t) {
        ax_panel_size* s = &c->sizes[c->size_of[t]];
        s->error = fmax(s->error, difference(w->edge[t], s->edges, &c->turn[t]));
        for (int k = 0; k < 3; ++k) {
            double e = w->edge[t][(k + c->turn[t]) % 3] - s->edges[k];
            squares += e * e;
        }
        c->edge_max = fmax(c->edge_max, s->error);
    }
    c->edge_rms = sqrt(squares / (3 * w->n));
}

static ax_clusters start(const work* w, int count)
{
    return (ax_clusters){.panel_count = w->n,
                         .sizes = AX_NEW0(ax_panel_size, count),
                         .size_of = AX_NEW0(int, w->n),
                         .turn = AX_NEW0(int, w->n)};
}

// Every panel to the size that fits it best.
static void assign(const work* w, ax_clusters* c)
{
    for (int t = 0; t < w->n; ++t) {
        double best = INFINITY;
        for (int s = 0, turn; s < c->size_count; ++s) {
            double d = difference(w->edge[t], c->sizes[s].edges, &turn);
            if (c->sizes[s].count && d < best)
                best = d, c->size_of[t] = s;
        }
    }
}

// Where panels are not equilateral the mean edge does not tell all.
static void try_by_distance(const work* w, int count, ax_clusters* best)
{
    ax_clusters c = start(w, count);
    c.size_count = divide_by_distance(w, count, c.size_of);
    for (int round = 0; round < ROUNDS; ++round) {
        if (round)
            assign(w, &c);
        measure_sizes(w, &c, round == 0);
        measure_errors(w, &c);
        if (c.edge_max >= best->edge_max)
            continue;
        memcpy(best->size_of, c.size_of, (size_t)w->n * sizeof *c.size_of);
        memcpy(best->turn, c.turn, (size_t)w->n * sizeof *c.turn);
        memcpy(best->sizes, c.sizes, (size_t)c.size_count * sizeof *c.sizes);
        best->size_count = c.size_count;
        best->edge_max = c.edge_max, best->edge_rms = c.edge_rms;
    }
    ax_clusters_free(&c);
}

// --- order of sizes

typedef struct ranked {
    double mean;
    int size;
} ranked;

static int by_size(const void* a, const void* b)
{
    const ranked *x = a, *y = b;
    return x->mean != y->mean ? (x->mean > y->mean) - (x->mean < y->mean) : x->size - y->size;
}

// From the smallest to the largest, without those that no panel has taken.
static void rank_sizes(ax_clusters* c)
{
    int kept = 0, *place = AX_NEW(int, c->size_count);
    ranked* r = AX_NEW(ranked, c->size_count);
    ax_panel_size* sizes = AX_NEW(ax_panel_size, c->size_count);
    for (int s = 0; s < c->size_count; ++s)
        r[s] = (ranked){(c->sizes[s].edges[0] + c->sizes[s].edges[1] + c->sizes[s].edges[2]) / 3, s};
    qsort(r, (size_t)c->size_count, sizeof *r, by_size);
    for (int i = 0; i < c->size_count; ++i)
        if (c->sizes[r[i].size].count) {
            place[r[i].size] = kept;
            sizes[kept++] = c->sizes[r[i].size];
        }
    for (int t = 0; t < c->panel_count; ++t)
        c->size_of[t] = place[c->size_of[t]];
    ax_free(c->sizes);
    c->sizes = sizes, c->size_count = kept;
    ax_free(place);
    ax_free(r);
}

// --- misfit

// Corners of a triangle with the given edges: the first at the origin, the second to the right.
static void lay(const double e[3], double at[3][2])
{
    double x = (e[2] * e[2] + e[1] * e[1] - e[0] * e[0]) / (2 * e[2]);
    at[0][0] = at[0][1] = at[1][1] = 0;
    at[1][0] = e[2];
    at[2][0] = x, at[2][1] = sqrt(fmax(0, e[1] * e[1] - x * x));
}

// How far the corners of panel t move, in the directions of its first edge and across, when the cut size takes its place by the rigid
// motion of least squares.
static void move_corners(const work* w, const ax_clusters* c, int t, double moved[3][2])
{
    double size[3], a[3][2], b[3][2], mid_a[2] = {0, 0}, mid_b[2] = {0, 0}, dot = 0, cross = 0;
    for (int k = 0; k < 3; ++k)
        size[(k + c->turn[t]) % 3] = c->sizes[c->size_of[t]].edges[k];
    lay(w->edge[t], a);
    lay(size, b);
    for (int k = 0; k < 3; ++k)
        for (int d = 0; d < 2; ++d)
            mid_a[d] += a[k][d] / 3, mid_b[d] += b[k][d] / 3;
    for (int k = 0; k < 3; ++k) {
        for (int d = 0; d < 2; ++d)
            a[k][d] -= mid_a[d], b[k][d] -= mid_b[d];
        dot += b[k][0] * a[k][0] + b[k][1] * a[k][1];
        cross += b[k][0] * a[k][1] - b[k][1] * a[k][0];
    }
    double length = hypot(dot, cross), cosine = dot / length, sine = cross / length;
    for (int k = 0; k < 3; ++k) {
        moved[k][0] = cosine * b[k][0] - sine * b[k][1] - a[k][0];
        moved[k][1] = sine * b[k][0] + cosine * b[k][1] - a[k][1];
    }
}

static void measure_gaps(const work* w, ax_clusters* c)
{
    const ax_linkage* l = &w->design->linkage;
    double(*gap)[3] = ax_calloc((size_t)l->hinge_count, sizeof *gap);
    unsigned char* met = AX_NEW0(unsigned char, l->hinge_count);
    for (int t = 0; t < w->n; ++t) {
        double u[3], v[3], n[3], moved[3][2];
        const int* h = l->triangles[t];
        ax_sub3(w->design->deployed[h[1]], w->design->deployed[h[0]], u);
        ax_sub3(w->design->deployed[h[2]], w->design->deployed[h[0]], v);
        ax_cross(u, v, n);
        ax_cross(n, u, v);
        double lu = ax_norm3(u), lv = ax_norm3(v);
        move_corners(w, c, t, moved);
        for (int k = 0; k < 3; ++k) {
            double sign = met[h[k]]++ ? -1 : 1;
            for (int d = 0; d < 3; ++d)
                gap[h[k]][d] += sign * (moved[k][0] * u[d] / lu + moved[k][1] * v[d] / lv);
        }
    }
    double squares = 0;
    for (int h = 0; h < l->hinge_count; ++h) {
        double g = ax_norm3(gap[h]);
        c->gap_max = fmax(c->gap_max, g);
        squares += g * g;
    }
    c->gap_rms = sqrt(squares / l->hinge_count);
    ax_free(gap);
    ax_free(met);
}

// Change of the edge opposite corner k.
static double change(const work* w, const ax_clusters* c, int t, int k)
{
    return c->sizes[c->size_of[t]].edges[(k - c->turn[t] + 3) % 3] - w->edge[t][k];
}

// Fully open, an edge goes straight on through each hinge as an edge of the next panel. From corner `from` of t along its edge
// to corner `to`, and so on, until the rim or an edge that was met; the sum of changes.
static double follow_line(const work* w, const ax_clusters* c, const int (*held)[2], int t, int from, int to,
                          unsigned char* met)
{
    double sum = 0;
    while (!met[3 * t + (3 - from - to)]) {
        int opposite = 3 - from - to, hinge = w->design->linkage.triangles[t][to];
        met[3 * t + opposite] = 1;
        sum += change(w, c, t, opposite);
        int next = held[hinge][0] == t ? held[hinge][1] : held[hinge][0];
        if (next < 0)
            break;
        int j = 0;
        while (w->design->linkage.triangles[next][j] != hinge)
            ++j;
        bool before =
            from == (to + 1) % 3; // seen from the hinge, counter-clockwise, the first of the panel's two edges
        t = next, from = j, to = (j + (before ? 1 : 2)) % 3;
    }
    return sum;
}

static void measure_lines(const work* w, ax_clusters* c)
{
    const ax_linkage* l = &w->design->linkage;
    unsigned char* met = AX_NEW0(unsigned char, 3 * (size_t)w->n);
    int(*held)[2] = ax_linkage_hinge_triangles(l);
    for (int pass = 0; pass < 2; ++pass) // lines from rim to rim, then those that close
        for (int t = 0; t < w->n; ++t)
            for (int k = 0; k < 3; ++k)
                if (pass || l->on_rim[l->triangles[t][k]])
                    for (int s = 1; s < 3; ++s) {
                        double sum = follow_line(w, c, (const int(*)[2])held, t, k, (k + s) % 3, met);
                        c->line_max = fmax(c->line_max, fabs(sum));
                    }
    ax_free(met);
    ax_free(held);
}

static ax_clusters cluster(const work* w, int count)
{
    count = count < w->n ? count : w->n;
    ax_clusters c = start(w, count);
    c.size_count = divide_by_mean(w, count, c.size_of);
    measure_sizes(w, &c, true);
    measure_errors(w, &c);
    double widest = 0, lo = INFINITY, hi = 0; // what equilateral panels could not do better
    for (int i = 0, last = -1; i < w->n; ++i) {
        int s = c.size_of[w->order[i].panel];
        lo = s == last ? lo : w->order[i].mean;
        hi = w->order[i].mean;
        widest = fmax(widest, hi - lo);
        last = s;
    }
    if (c.edge_max > widest / 2 + 1e-3 && (double)w->n * count * ROUNDS < most_work)
        try_by_distance(w, count, &c);
    rank_sizes(&c);
    return c;
}

static void measure_misfit(const work* w, ax_clusters* c)
{
    measure_gaps(w, c);
    measure_lines(w, c);
}

ax_clusters ax_cluster_panels(const ax_design* design, int count)
{
    assert(count >= 1);
    work w;
    begin(&w, design);
    ax_clusters c = cluster(&w, count);
    measure_misfit(&w, &c);
    end(&w);
    return c;
}

ax_clusters ax_cluster_within(const ax_design* design, double tolerance)
{
    assert(tolerance > 0);
    work w;
    begin(&w, design);
    int count = cover(&w, 2 * tolerance, NULL);
    ax_clusters c = cluster(&w, count);
    while (c.edge_max > tolerance * (1 + 1e-9) && count < w.n) { // panels that are not equilateral need more
        ax_clusters_free(&c);
        count = count + (count + 4) / 5;
        c = cluster(&w, count);
    }
    measure_misfit(&w, &c);
    end(&w);
    return c;
}
