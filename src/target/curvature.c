#include "target/curvature.h"

#include "base/vec.h"
#include "mesh/geometry.h"
#include "mesh/topology.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

// All in units of 1 / sqrt(area), so that they mean the same at any size. H up to FLAT counts as zero: a sag of a seven
// thousandth of the span, below what is made. DOME_LIKE is asked of the most curved twentieth of the area: a saddle
// that projection would replace altogether reaches 0.15, roofs with valleys 1.3 and more.
static const double FLAT = 1e-3, DOME_LIKE = 0.5;
// Share of the area on which noise is let pass.
static const double NOISE_SHARE = 0.01;

// Average over the one-ring, weighted by area, of the vertices off the rim, where the cotangent formula does not
// measure H. It is what keeps single noisy vertices out of the verdict.
static void average_over_rings(const ax_mesh* mesh, const unsigned char* on_rim, const double* area, double* mean)
{
    int n = mesh->vertex_count;
    double *sum = AX_NEW(double, n), *weight = AX_NEW(double, n);
    for (int v = 0; v < n; ++v) {
        weight[v] = on_rim[v] ? 0 : area[v];
        sum[v] = weight[v] * mean[v];
    }
    for (int h = 0; h < 3 * mesh->face_count; ++h) {
        int from = ax_half_edge_from(mesh, h), to = ax_half_edge_to(mesh, h);
        if (!on_rim[to]) {
            sum[from] += area[to] * mean[to];
            weight[from] += area[to];
        }
    }
    for (int v = 0; v < n; ++v)
        mean[v] = weight[v] > 0 ? sum[v] / weight[v] : NAN;
    // the tip of an ear has no neighbour inside and takes the value of the ones beside it
    for (int pass = 0; pass < 2; ++pass)
        for (int f = 0; f < mesh->face_count; ++f)
            for (int k = 0; k < 3; ++k) {
                const int* corner = mesh->faces[f];
                double beside = (mean[corner[(k + 1) % 3]] + mean[corner[(k + 2) % 3]]) / 2;
                if (isnan(mean[corner[k]]) && !isnan(beside))
                    mean[corner[k]] = beside;
            }
    for (int v = 0; v < n; ++v)
        mean[v] = isnan(mean[v]) ? 0 : mean[v];
    ax_free(sum);
    ax_free(weight);
}

typedef struct sample {
    double mean, area;
    int vertex;
} sample;

static int flattest_first(const void* a, const void* b)
{
    const sample *x = a, *y = b;
    return x->mean != y->mean ? (x->mean < y->mean ? -1 : 1) : x->vertex - y->vertex;
}

static double quantile(int n, const sample* samples, double area)
{
    double sum = 0;
    for (int k = 0; k < n; ++k) {
        sum += samples[k].area;
        if (sum >= area)
            return samples[k].mean;
    }
    return samples[n - 1].mean;
}

static int find_root(int* parent, int v)
{
    while (parent[v] != v)
        v = parent[v] = parent[parent[v]];
    return v;
}

// Centroid of the connected part with H <= limit that has the most area; the vertex of the smallest H if there is none.
static void find_worst(const ax_mesh* mesh, const ax_curvature_screen* screen, double limit, double place[3])
{
    int n = mesh->vertex_count, *parent = AX_NEW(int, n);
    double* area = AX_NEW0(double, n);
    for (int v = 0; v < n; ++v)
        parent[v] = v;
    for (int h = 0; h < 3 * mesh->face_count; ++h) {
        int a = ax_half_edge_from(mesh, h), b = ax_half_edge_to(mesh, h);
        if (screen->mean[a] <= limit && screen->mean[b] <= limit) {
            a = find_root(parent, a), b = find_root(parent, b);
            parent[a > b ? a : b] = a > b ? b : a;
        }
    }
    int worst = -1, lowest = 0;
    for (int v = 0; v < n; ++v) {
        if (screen->mean[v] < screen->mean[lowest])
            lowest = v;
        if (screen->mean[v] <= limit)
            area[find_root(parent, v)] += screen->vertex_area[v];
    }
    for (int v = 0; v < n; ++v)
        if (area[v] > 0 && (worst < 0 || area[v] > area[worst]))
            worst = v;
    memset(place, 0, 3 * sizeof *place);
    if (worst < 0)
        memcpy(place, mesh->positions[lowest], 3 * sizeof *place);
    for (int v = 0; worst >= 0 && v < n; ++v)
        if (screen->mean[v] <= limit && find_root(parent, v) == worst)
            for (int d = 0; d < 3; ++d)
                place[d] += screen->vertex_area[v] / area[worst] * mesh->positions[v][d];
    ax_free(parent);
    ax_free(area);
}

ax_curvature_screen ax_curvature_measure(const ax_mesh* mesh)
{
    int n = mesh->vertex_count;
    ax_curvature_screen screen = {.mean = AX_NEW(double, n), .vertex_area = AX_NEW(double, n)};
    ax_vertex_areas(mesh, screen.vertex_area);
    ax_mean_curvature(mesh, screen.mean);
    ax_topology topology = ax_topology_make(mesh);
    average_over_rings(mesh, topology.on_rim, screen.vertex_area, screen.mean);
    ax_topology_free(&topology);

    sample* samples = AX_NEW(sample, n);
    for (int v = 0; v < n; ++v)
        samples[v] = (sample){screen.mean[v], screen.vertex_area[v], v};
    qsort(samples, (size_t)n, sizeof *samples, flattest_first);
    for (int k = 0; k < n; ++k)
        screen.area += samples[k].area; // in this order, so that the share below can be 1
    double unit = 1 / sqrt(screen.area), nonpositive = 0;
    for (int k = 0; k < n && samples[k].mean <= FLAT * unit; ++k)
        nonpositive += samples[k].area;
    screen.nonpositive_share = nonpositive / screen.area;
    screen.min = samples[0].mean;
    screen.q01 = quantile(n, samples, 0.01 * screen.area);
    screen.median = quantile(n, samples, 0.5 * screen.area);
    screen.q95 = quantile(n, samples, 0.95 * screen.area);
    screen.positive = screen.nonpositive_share <= NOISE_SHARE;
    screen.asked = DOME_LIKE * unit;
    screen.dome_like = screen.q95 >= screen.asked;
    ax_free(samples);
    find_worst(mesh, &screen, FLAT * unit, screen.worst_place);
    return screen;
}

void ax_curvature_free(ax_curvature_screen* screen)
{
    ax_free(screen->mean);
    ax_free(screen->vertex_area);
    *screen = (ax_curvature_screen){0};
}
