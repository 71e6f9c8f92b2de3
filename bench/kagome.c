#include "kagome.h"

#include "base/random.h"
#include "base/vec.h"

#include <string.h>

// Lattice rows r = -n .. n hold 2 n + 1 - |r| points, two apart; vertices are the midpoints of the lattice's edges, row by row:
// along the row, then up to the right, then up to the left.
typedef struct grid {
    int n;
    int* first; // per row: id of its first edge of each kind, 3 per row; -1 marks none
} grid;

static int row_points(int n, int r)
{
    return r < -n || r > n ? 0 : 2 * n + 1 - (r < 0 ? -r : r);
}

// Position within row r + 1 of the point up to the right of point i of row r; the one up to the left is one less.
static int up_right(int r, int i)
{
    return r < 0 ? i + 1 : i;
}

// Edge of `kind` (0 along, 1 up right, 2 up left) that starts at point i of row r, -1 if there is none.
static int edge_at(const grid* g, int r, int i, int kind)
{
    int count = row_points(g->n, r);
    if (i < 0 || i >= count)
        return -1;
    if (kind == 0)
        return i + 1 < count ? g->first[3 * (r + g->n)] + i : -1;
    int up = up_right(r, i) - (kind == 2);
    if (up < 0 || up >= row_points(g->n, r + 1))
        return -1;
    int start = g->first[3 * (r + g->n) + kind];
    return start + i - (kind == 2 && r >= 0); // the first point of an upper row has no neighbour up left
}

static void add_triangle(kagome* k, int (*triangle)[3], int a, int b, int c)
{
    if (a < 0 || b < 0 || c < 0)
        return;
    int* t = triangle[k->triangles++];
    t[0] = a, t[1] = b, t[2] = c;
}

kagome kagome_make(int n, bool bump)
{
    kagome k = {.n = n, .vertices = 9 * n * n + 3 * n};
    k.regular = ax_calloc((size_t)k.vertices, sizeof *k.regular);
    k.start = ax_alloc((size_t)k.vertices, sizeof *k.start);
    grid g = {.n = n, .first = AX_NEW(int, 3 * (2 * n + 1))};
    int v = 0;
    for (int r = -n; r <= n; ++r) {
        int count = row_points(n, r);
        double x0 = -(count - 1), y = r * sqrt(3);
        for (int kind = 0; kind < 3; ++kind) {
            g.first[3 * (r + n) + kind] = v;
            for (int i = 0; i < count; ++i) {
                if (edge_at(&g, r, i, kind) < 0)
                    continue;
                k.regular[v][0] = x0 + 2 * i + (kind == 0 ? 1 : kind == 1 ? 0.5 : -0.5);
                k.regular[v][1] = y + (kind ? sqrt(3) / 2 : 0);
                ++v;
            }
        }
    }
    int(*triangle)[3] = ax_alloc((size_t)(6 * n * n), sizeof *triangle);
    for (int r = -n; r <= n; ++r)
        for (int i = 0; i < row_points(n, r); ++i) {
            int along = edge_at(&g, r, i, 0); // triangle above this edge, then the one below
            add_triangle(&k, triangle, along, along < 0 ? -1 : edge_at(&g, r, i + 1, 2),
                         along < 0 ? -1 : edge_at(&g, r, i, 1));
            // below: the edges that come up to its ends from the point between them
            int below = r <= 0 ? i : i + 1;
            add_triangle(&k, triangle, along, along < 0 ? -1 : edge_at(&g, r - 1, below, 2),
                         along < 0 ? -1 : edge_at(&g, r - 1, below, 1));
        }
    unsigned char* uses = AX_NEW0(unsigned char, k.vertices);
    for (int t = 0; t < k.triangles; ++t)
        for (int c = 0; c < 3; ++c)
            ++uses[triangle[t][c]];
    k.fixed_vertex = AX_NEW(int, 6 * n);
    for (v = 0; v < k.vertices; ++v)
        if (uses[v] == 1)
            k.fixed_vertex[k.fixed++] = v;
    k.edges = 3 * k.triangles;
    k.edge = ax_alloc((size_t)k.edges, sizeof *k.edge);
    k.rest = AX_NEW(double, k.edges);
    for (int t = 0; t < k.triangles; ++t) {
        bool rim = uses[triangle[t][0]] == 1 || uses[triangle[t][1]] == 1 || uses[triangle[t][2]] == 1;
        for (int c = 0; c < 3; ++c) {
            k.edge[3 * t + c][0] = triangle[t][c], k.edge[3 * t + c][1] = triangle[t][(c + 1) % 3];
            k.rest[3 * t + c] = rim ? 1 : 1.15;
        }
    }
    k.hexagon = ax_alloc((size_t)(3 * n * n), sizeof *k.hexagon);
    for (int r = -n + 1; r < n; ++r)
        for (int i = 1; i + 1 < row_points(n, r); ++i) {
            int down = r <= 0 ? i - 1 : i; // of the point below left; the one below right follows
            int* h = k.hexagon[k.hexagons++];
            h[0] = edge_at(&g, r, i, 0), h[1] = edge_at(&g, r, i, 1), h[2] = edge_at(&g, r, i, 2);
            h[3] = edge_at(&g, r, i - 1, 0), h[4] = edge_at(&g, r - 1, down, 1), h[5] = edge_at(&g, r - 1, down + 1, 2);
        }
    memcpy(k.start, k.regular, (size_t)k.vertices * sizeof *k.start);
    double apothem = n * sqrt(3);
    for (v = 0; v < k.vertices; ++v) {
        if (uses[v] == 1)
            continue;
        double rise = 1;
        for (int axis = 0; axis < 3; ++axis) {
            double angle = AX_PI / 2 + axis * AX_PI / 3;
            double d = (k.regular[v][0] * cos(angle) + k.regular[v][1] * sin(angle)) / apothem;
            rise *= 1 - d * d;
        }
        for (int c = 0; c < 3; ++c) {
            ax_random random = {(uint64_t)(3 * v + c)};
            k.start[v][c] += ax_random_uniform(&random, -0.01, 0.01) + (bump && c == 2 ? 0.25 * 2 * n * rise : 0);
        }
    }
    ax_free(uses);
    ax_free(triangle);
    ax_free(g.first);
    return k;
}

void kagome_free(kagome* k)
{
    void* blocks[] = {k->regular, k->start, k->edge, k->rest, k->fixed_vertex, k->hexagon};
    for (size_t b = 0; b < sizeof blocks / sizeof *blocks; ++b)
        ax_free(blocks[b]);
}

void kagome_error(const kagome* k, const double (*x)[3], double* max, double* rms)
{
    double sum = 0;
    *max = 0;
    for (int e = 0; e < k->edges; ++e) {
        double error = fabs(ax_distance3(x[k->edge[e][0]], x[k->edge[e][1]]) / k->rest[e] - 1);
        *max = fmax(*max, error);
        sum += error * error;
    }
    *rms = sqrt(sum / k->edges);
}
