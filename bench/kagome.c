#include "kagome.h"

#include "base/random.h"
#include "base/vec.h"

#include <stdio.h>
#include <stdlib.h>
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

// What the problems have in common.
static kagome with_parameters(int n, bool dynamic)
{
    return (kagome){.n = n,
                    .dynamic = dynamic,
                    .mass = 1,
                    .damping = 0.95,
                    .time_step = 1,
                    .gravity = {0, 0, -0.02 / (2 * n)},
                    .w_fixed = 100,
                    .w_circle = dynamic ? 0 : 0.1,
                    .inner = 10};
}

kagome kagome_make(int n, bool dynamic)
{
    kagome k = with_parameters(n, dynamic);
    k.vertices = 9 * n * n + 3 * n;
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
    k.stiffness = AX_NEW(double, k.edges);
    for (int t = 0; t < k.triangles; ++t) {
        bool rim = uses[triangle[t][0]] == 1 || uses[triangle[t][1]] == 1 || uses[triangle[t][2]] == 1;
        for (int c = 0; c < 3; ++c) {
            k.edge[3 * t + c][0] = triangle[t][c], k.edge[3 * t + c][1] = triangle[t][(c + 1) % 3];
            k.rest[3 * t + c] = rim ? 1 : 1.15;
            k.stiffness[3 * t + c] = 1 / (k.rest[3 * t + c] * k.rest[3 * t + c]);
        }
    }
    k.hexagon = ax_alloc(dynamic ? 0 : (size_t)(3 * n * n), sizeof *k.hexagon);
    for (int r = -n + 1; r < n && !dynamic; ++r) // only static problems have circles
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
            k.start[v][c] += ax_random_uniform(&random, -0.01, 0.01) + (!dynamic && c == 2 ? 0.25 * 2 * n * rise : 0);
        }
    }
    ax_free(uses);
    ax_free(triangle);
    ax_free(g.first);
    return k;
}

// A count, then that many records read by `record`.
static bool read_section(FILE* file, const char* name, int* count, void* records, size_t size,
                         bool (*record)(FILE*, void*))
{
    char word[32];
    if (fscanf(file, "%31s %d", word, count) != 2 || strcmp(word, name) != 0 || *count < 0)
        return false;
    char* to = *(void**)records = ax_alloc((size_t)*count, size);
    for (int k = 0; k < *count; ++k)
        if (!record(file, to + (size_t)k * size))
            return false;
    return true;
}

static bool read_place(FILE* file, void* to)
{
    double* x = to;
    return fscanf(file, "%lf %lf %lf", x, x + 1, x + 2) == 3;
}

typedef struct edge_record {
    int i, j;
    double rest, stiffness;
} edge_record;

static bool read_edge(FILE* file, void* to)
{
    edge_record* e = to;
    return fscanf(file, "%d %d %lf %lf", &e->i, &e->j, &e->rest, &e->stiffness) == 4;
}

static bool read_index(FILE* file, void* to)
{
    return fscanf(file, "%d", (int*)to) == 1;
}

static bool read_triangle(FILE* file, void* to)
{
    int* t = to;
    return read_index(file, t) && read_index(file, t + 1) && read_index(file, t + 2);
}

static bool read_hexagon(FILE* file, void* to)
{
    return read_triangle(file, to) && read_triangle(file, (int*)to + 3);
}

static bool indices_within(const int* index, int count, int limit)
{
    for (int k = 0; k < count; ++k)
        if (index[k] < 0 || index[k] >= limit)
            return false;
    return true;
}

bool kagome_read(const char* path, kagome* problem)
{
    size_t length = strlen(path);
    bool packed = length > 3 && strcmp(path + length - 3, ".xz") == 0;
    char command[4096], mode[8];
    snprintf(command, sizeof command, "xz -dc -- '%s'", path);
    FILE* file = packed ? popen(command, "r") : fopen(path, "r");
    if (!file) {
        perror(path);
        return false;
    }
    int n = 0;
    bool sound = fscanf(file, " kagome 1 mode %7s n %d", mode, &n) == 2 && n > 1 && n < 1000;
    kagome k = with_parameters(n, sound && strcmp(mode, "dyn") == 0);
    double w_edge, scale, *g = k.gravity;
    int(*triangle)[3] = NULL;
    edge_record* edges = NULL;
    sound =
        sound &&
        fscanf(file,
               " params mass %lf damping %lf dt %lf gravity %lf %lf %lf inner %d w_edge %lf w_fixed %lf w_circle %lf "
               "scale %lf",
               &k.mass, &k.damping, &k.time_step, g, g + 1, g + 2, &k.inner, &w_edge, &k.w_fixed, &k.w_circle,
               &scale) == 11 &&
        read_section(file, "vertices", &k.vertices, &k.start, sizeof *k.start, read_place) &&
        read_section(file, "triangles", &k.triangles, &triangle, sizeof *triangle, read_triangle) &&
        read_section(file, "edges", &k.edges, &edges, sizeof *edges, read_edge) &&
        read_section(file, "fixed", &k.fixed, &k.fixed_vertex, sizeof *k.fixed_vertex, read_index) &&
        read_section(file, "hexagons", &k.hexagons, &k.hexagon, sizeof *k.hexagon, read_hexagon);
    if (packed)
        pclose(file);
    else
        fclose(file);
    k.edge = ax_alloc((size_t)k.edges, sizeof *k.edge);
    k.rest = AX_NEW(double, k.edges);
    k.stiffness = AX_NEW(double, k.edges);
    for (int e = 0; sound && e < k.edges; ++e) {
        k.edge[e][0] = edges[e].i, k.edge[e][1] = edges[e].j;
        k.rest[e] = edges[e].rest, k.stiffness[e] = edges[e].stiffness;
    }
    sound = sound && k.inner > 0 && indices_within(k.edge[0], 2 * k.edges, k.vertices) &&
            indices_within(k.fixed_vertex, k.fixed, k.vertices) &&
            indices_within(k.hexagons ? k.hexagon[0] : NULL, 6 * k.hexagons, k.vertices);
    ax_free(triangle);
    ax_free(edges);
    if (!sound) {
        fprintf(stderr, "%s: not a problem file (kagome 1)\n", path);
        kagome_free(&k);
        return false;
    }
    kagome made = kagome_make(n, k.dynamic); // the file's mesh, unless somebody made another
    bool same = made.vertices == k.vertices;
    for (int v = 0; v < k.vertices && same; ++v)
        same = ax_distance3(made.start[v], k.start[v]) < 1e-9;
    if (same) {
        k.regular = made.regular;
        made.regular = NULL;
    }
    kagome_free(&made);
    *problem = k;
    return true;
}

void kagome_free(kagome* k)
{
    void* blocks[] = {k->regular, k->start, k->edge, k->rest, k->stiffness, k->fixed_vertex, k->hexagon};
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
