#include "mesh/geometry.h"

#include "base/vec.h"
#include "mesh/corners.h"
#include "mesh/topology.h"

#include <string.h>

// Twice the area, along the normal.
static void area_vector(const ax_mesh* mesh, int face, double out[3])
{
    const int* f = mesh->faces[face];
    double a[3], b[3];
    ax_sub3(mesh->positions[f[1]], mesh->positions[f[0]], a);
    ax_sub3(mesh->positions[f[2]], mesh->positions[f[0]], b);
    ax_cross(a, b, out);
}

static void normalise(double v[3])
{
    double length = ax_norm3(v);
    if (length > 0)
        for (int d = 0; d < 3; ++d)
            v[d] /= length;
}

double ax_face_area(const ax_mesh* mesh, int face)
{
    double a[3];
    area_vector(mesh, face, a);
    return 0.5 * ax_norm3(a);
}

double ax_mesh_area(const ax_mesh* mesh)
{
    double area = 0;
    for (int f = 0; f < mesh->face_count; ++f)
        area += ax_face_area(mesh, f);
    return area;
}

double ax_mean_facet(const ax_mesh* mesh)
{
    return mesh->face_count ? sqrt(4 * ax_mesh_area(mesh) / (sqrt(3) * mesh->face_count)) : 0;
}

void ax_face_normal(const ax_mesh* mesh, int face, double normal[3])
{
    area_vector(mesh, face, normal);
    normalise(normal);
}

void ax_bounds(const ax_mesh* mesh, double lo[3], double hi[3])
{
    for (int d = 0; d < 3; ++d)
        lo[d] = hi[d] = mesh->vertex_count ? mesh->positions[0][d] : 0;
    for (int v = 1; v < mesh->vertex_count; ++v)
        for (int d = 0; d < 3; ++d) {
            double x = mesh->positions[v][d];
            lo[d] = x < lo[d] ? x : lo[d];
            hi[d] = x > hi[d] ? x : hi[d];
        }
}

double ax_diagonal(const ax_mesh* mesh)
{
    double lo[3], hi[3];
    ax_bounds(mesh, lo, hi);
    return ax_distance3(lo, hi);
}

void ax_vertex_normals(const ax_mesh* mesh, double (*out)[3])
{
    memset(out, 0, (size_t)mesh->vertex_count * sizeof *out);
    for (int f = 0; f < mesh->face_count; ++f) {
        double a[3];
        area_vector(mesh, f, a);
        for (int k = 0; k < 3; ++k)
            for (int d = 0; d < 3; ++d)
                out[mesh->faces[f][k]][d] += a[d];
    }
    for (int v = 0; v < mesh->vertex_count; ++v)
        normalise(out[v]);
}

// The edges that leave corner k: their cross product's length over their dot product is the tangent of the angle.
static void corner_sine_cosine(const ax_mesh* mesh, int face, int k, double* sine, double* cosine)
{
    const int* f = mesh->faces[face];
    double a[3], b[3], n[3];
    ax_sub3(mesh->positions[f[(k + 1) % 3]], mesh->positions[f[k]], a);
    ax_sub3(mesh->positions[f[(k + 2) % 3]], mesh->positions[f[k]], b);
    ax_cross(a, b, n);
    *sine = ax_norm3(n);
    *cosine = ax_dot3(a, b);
}

void ax_corner_angles(const ax_mesh* mesh, double (*out)[3])
{
    for (int f = 0; f < mesh->face_count; ++f)
        for (int k = 0; k < 3; ++k) {
            double sine, cosine;
            corner_sine_cosine(mesh, f, k, &sine, &cosine);
            out[f][k] = atan2(sine, cosine);
        }
}

static double half_cotangent(const ax_mesh* mesh, int face, int k)
{
    double sine, cosine;
    corner_sine_cosine(mesh, face, k, &sine, &cosine);
    return 0.5 * cosine / sine;
}

// Thirds of the face areas would do for sums, but leave H at irregular vertices off by up to half.
void ax_vertex_areas(const ax_mesh* mesh, double* out)
{
    memset(out, 0, (size_t)mesh->vertex_count * sizeof *out);
    for (int f = 0; f < mesh->face_count; ++f) {
        const int* corner = mesh->faces[f];
        double half_cot[3], area = ax_face_area(mesh, f);
        int obtuse = -1;
        for (int k = 0; k < 3; ++k) {
            half_cot[k] = half_cotangent(mesh, f, k);
            obtuse = half_cot[k] < 0 ? k : obtuse;
        }
        for (int k = 0; k < 3; ++k) {
            int a = (k + 1) % 3, b = (k + 2) % 3;
            double e = ax_distance3(mesh->positions[corner[k]], mesh->positions[corner[a]]);
            double g = ax_distance3(mesh->positions[corner[k]], mesh->positions[corner[b]]);
            out[corner[k]] +=
                obtuse < 0 ? 0.25 * (e * e * half_cot[b] + g * g * half_cot[a]) : (k == obtuse ? 0.5 : 0.25) * area;
        }
    }
}

// Column w takes its rows in the order in which the vertices v > w come up, which is sorted; the last one entered tells
// whether the edge was met before, so there is neither sorting nor searching.
ax_sparse ax_cotan_laplacian(const ax_mesh* mesh)
{
    int n = mesh->vertex_count, corner_count = 3 * mesh->face_count;
    double* weight = AX_NEW(double, corner_count); // of the half-edge opposite
    for (int c = 0; c < corner_count; ++c)
        weight[c] = half_cotangent(mesh, c / 3, c % 3);

    ax_corners corners = ax_corners_make(mesh);
    ax_sparse matrix = {.n = n, .start = AX_NEW0(int, n + 1)};
    int* last = AX_NEW(int, n);
    for (int v = 0; v < n; ++v) {
        matrix.start[v + 1] += 1;
        last[v] = v;
        for (int i = corners.start[v]; i < corners.start[v + 1]; ++i) {
            int a = ax_corner_after(corners.corner[i]), b = ax_corner_before(corners.corner[i]);
            int neighbours[2] = {ax_corner_vertex(mesh, a), ax_corner_vertex(mesh, b)};
            for (int side = 0; side < 2; ++side) {
                int w = neighbours[side];
                if (w < v && last[w] != v) {
                    last[w] = v;
                    matrix.start[w + 1] += 1;
                }
            }
        }
    }
    for (int v = 0; v < n; ++v)
        matrix.start[v + 1] += matrix.start[v];
    matrix.row = AX_NEW(int, matrix.start[n]);
    matrix.value = AX_NEW(double, matrix.start[n]);

    int* end = last; // of what column v holds so far
    for (int v = 0; v < n; ++v) {
        double diagonal = 0;
        end[v] = matrix.start[v] + 1;
        for (int i = corners.start[v]; i < corners.start[v + 1]; ++i) {
            int a = ax_corner_after(corners.corner[i]), b = ax_corner_before(corners.corner[i]);
            int neighbours[2] = {ax_corner_vertex(mesh, a), ax_corner_vertex(mesh, b)};
            double opposite[2] = {weight[b], weight[a]};
            for (int side = 0; side < 2; ++side) {
                int w = neighbours[side];
                diagonal += opposite[side];
                if (w > v)
                    continue;
                if (matrix.row[end[w] - 1] != v) {
                    matrix.row[end[w]] = v;
                    matrix.value[end[w]++] = 0;
                }
                matrix.value[end[w] - 1] -= opposite[side];
            }
        }
        matrix.row[matrix.start[v]] = v;
        matrix.value[matrix.start[v]] = diagonal;
    }
    ax_free(last);
    ax_free(weight);
    ax_corners_free(&corners);
    return matrix;
}

// Sums w (x_i - x_j) from differences: A x from the matrix would lose digits far from the origin.
static void cotan_gradient(const ax_mesh* mesh, double (*out)[3])
{
    memset(out, 0, (size_t)mesh->vertex_count * sizeof *out);
    for (int f = 0; f < mesh->face_count; ++f)
        for (int k = 0; k < 3; ++k) {
            int i = mesh->faces[f][(k + 1) % 3], j = mesh->faces[f][(k + 2) % 3];
            double w = half_cotangent(mesh, f, k), d[3];
            ax_sub3(mesh->positions[i], mesh->positions[j], d);
            for (int e = 0; e < 3; ++e) {
                out[i][e] += w * d[e];
                out[j][e] -= w * d[e];
            }
        }
}

void ax_mean_curvature(const ax_mesh* mesh, double* out)
{
    int n = mesh->vertex_count;
    double(*normal)[3] = ax_alloc((size_t)n, sizeof *normal);
    double(*gradient)[3] = ax_alloc((size_t)n, sizeof *gradient);
    double* area = AX_NEW(double, n);
    ax_vertex_normals(mesh, normal);
    ax_vertex_areas(mesh, area);
    cotan_gradient(mesh, gradient);
    ax_topology topology = ax_topology_make(mesh);
    for (int v = 0; v < n; ++v)
        out[v] = topology.on_rim[v] ? 0 : ax_dot3(normal[v], gradient[v]) / (2 * area[v]);

    // An edge from the rim to the interior has two half-edges, so each is met once in this direction.
    int* count = AX_NEW0(int, n);
    for (int h = 0; h < 3 * mesh->face_count; ++h) {
        int from = ax_half_edge_from(mesh, h), to = ax_half_edge_to(mesh, h);
        if (topology.on_rim[from] && !topology.on_rim[to]) {
            out[from] += out[to];
            ++count[from];
        }
    }
    for (int v = 0; v < n; ++v)
        if (count[v])
            out[v] /= count[v];
    ax_free(count);
    ax_topology_free(&topology);
    ax_free(area);
    ax_free(gradient);
    ax_free(normal);
}
