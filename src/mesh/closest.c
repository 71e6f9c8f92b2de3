#include "mesh/closest.h"

#include "mesh/boxtree.h"
#include "mesh/geometry.h"

#include <assert.h>
#include <string.h>

struct ax_closest {
    const ax_mesh* mesh;
    ax_box_tree tree;
    double (*corners)[3][3]; // of the faces in the order of the leaves, so that a leaf is one stretch of memory
    double (*normals)[3];    // per vertex
};

ax_closest* ax_closest_make(const ax_mesh* mesh)
{
    assert(mesh->face_count > 0);
    ax_closest* closest = AX_NEW0(ax_closest, 1);
    closest->mesh = mesh;
    double(*boxes)[2][3] = ax_alloc((size_t)mesh->face_count, sizeof *boxes);
    for (int f = 0; f < mesh->face_count; ++f)
        for (int d = 0; d < 3; ++d) {
            double a = mesh->positions[mesh->faces[f][0]][d], b = mesh->positions[mesh->faces[f][1]][d];
            double c = mesh->positions[mesh->faces[f][2]][d];
            boxes[f][0][d] = fmin(a, fmin(b, c));
            boxes[f][1][d] = fmax(a, fmax(b, c));
        }
    closest->tree = ax_box_tree_make(mesh->face_count, (const double(*)[2][3])boxes);
    ax_free(boxes);

    closest->corners = ax_alloc((size_t)mesh->face_count, sizeof *closest->corners);
    for (int i = 0; i < mesh->face_count; ++i)
        for (int k = 0; k < 3; ++k)
            for (int d = 0; d < 3; ++d)
                closest->corners[i][k][d] = mesh->positions[mesh->faces[closest->tree.order[i]][k]][d];
    closest->normals = ax_alloc((size_t)mesh->vertex_count, sizeof *closest->normals);
    ax_vertex_normals(mesh, closest->normals);
    return closest;
}

void ax_closest_free(ax_closest* closest)
{
    if (!closest)
        return;
    ax_box_tree_free(&closest->tree);
    ax_free(closest->corners);
    ax_free(closest->normals);
    ax_free(closest);
}

// Barycentric weights of the closest point of a triangle (Ericson 2005, Real-Time Collision Detection, section 5.1.5).
static void closest_weights(const double x[3], const double a[3], const double b[3], const double c[3],
                            double weight[3])
{
    double ab[3], ac[3], ax[3], bx[3], cx[3];
    ax_sub3(b, a, ab);
    ax_sub3(c, a, ac);
    ax_sub3(x, a, ax);
    ax_sub3(x, b, bx);
    ax_sub3(x, c, cx);
    double d1 = ax_dot3(ab, ax), d2 = ax_dot3(ac, ax);
    double d3 = ax_dot3(ab, bx), d4 = ax_dot3(ac, bx);
    double d5 = ax_dot3(ab, cx), d6 = ax_dot3(ac, cx);
    double v = 0, w = 0; // of b and c
    double va = d3 * d6 - d5 * d4, vb = d5 * d2 - d1 * d6, vc = d1 * d4 - d3 * d2;
    if (d1 <= 0 && d2 <= 0) {
        v = 0;
    } else if (d3 >= 0 && d4 <= d3) {
        v = 1;
    } else if (vc <= 0 && d1 >= 0 && d3 <= 0) {
        v = d1 / (d1 - d3);
    } else if (d6 >= 0 && d5 <= d6) {
        w = 1;
    } else if (vb <= 0 && d2 >= 0 && d6 <= 0) {
        w = d2 / (d2 - d6);
    } else if (va <= 0 && d4 - d3 >= 0 && d5 - d6 >= 0) {
        w = (d4 - d3) / ((d4 - d3) + (d5 - d6));
        v = 1 - w;
    } else {
        double sum = va + vb + vc;
        v = vb / sum;
        w = vc / sum;
    }
    weight[0] = 1 - v - w;
    weight[1] = v;
    weight[2] = w;
}

typedef struct search {
    const ax_closest* closest;
    const double* x;
    double squared; // distance
    int face;
    double weight[3], point[3];
} search;

static void try_triangle(search* s, int face, const double corners[3][3])
{
    double weight[3], point[3], d[3];
    closest_weights(s->x, corners[0], corners[1], corners[2], weight);
    for (int e = 0; e < 3; ++e)
        point[e] = weight[0] * corners[0][e] + weight[1] * corners[1][e] + weight[2] * corners[2][e];
    ax_sub3(s->x, point, d);
    double squared = ax_dot3(d, d);
    // the lower face on a tie, so that the answer depends on neither the tree nor the hint
    if (squared > s->squared || (squared == s->squared && face > s->face))
        return;
    s->squared = squared;
    s->face = face;
    for (int e = 0; e < 3; ++e) {
        s->weight[e] = weight[e];
        s->point[e] = point[e];
    }
}

static void try_place(void* context, int place)
{
    search* s = context;
    try_triangle(s, s->closest->tree.order[place], s->closest->corners[place]);
}

ax_closest_point ax_closest_find(const ax_closest* closest, const double x[3], int hint)
{
    const ax_mesh* mesh = closest->mesh;
    search s = {.closest = closest, .x = x, .squared = INFINITY, .face = mesh->face_count};
    if (hint >= 0) {
        assert(hint < mesh->face_count);
        double corners[3][3];
        for (int k = 0; k < 3; ++k)
            for (int d = 0; d < 3; ++d)
                corners[k][d] = mesh->positions[mesh->faces[hint][k]][d];
        try_triangle(&s, hint, corners);
    }
    ax_box_tree_nearest(&closest->tree, x, x, &s.squared, try_place, &s);
    assert(s.face < mesh->face_count && "x must be finite");

    ax_closest_point result = {.face = s.face, .distance = sqrt(s.squared)};
    for (int d = 0; d < 3; ++d) {
        result.weight[d] = s.weight[d];
        result.point[d] = s.point[d];
        for (int k = 0; k < 3; ++k)
            result.normal[d] += s.weight[k] * closest->normals[mesh->faces[s.face][k]][d];
    }
    double length = ax_norm3(result.normal);
    if (length > 0)
        for (int d = 0; d < 3; ++d)
            result.normal[d] /= length;
    else
        ax_face_normal(mesh, s.face, result.normal);
    return result;
}

// Squared distance of the segments a b and c d (Ericson 2005, section 5.1.9).
static double segments_squared(const double a[3], const double b[3], const double c[3], const double d[3])
{
    double u[3], v[3], w[3];
    ax_sub3(b, a, u);
    ax_sub3(d, c, v);
    ax_sub3(a, c, w);
    double uu = ax_dot3(u, u), vv = ax_dot3(v, v), uv = ax_dot3(u, v), uw = ax_dot3(u, w), vw = ax_dot3(v, w);
    double area = uu * vv - uv * uv, s = area > 0 ? ax_clamp((uv * vw - uw * vv) / area, 0, 1) : 0;
    double t = vv > 0 ? ax_clamp((uv * s + vw) / vv, 0, 1) : 0;
    s = uu > 0 ? ax_clamp((uv * t - uw) / uu, 0, 1) : 0;
    double between[3];
    for (int e = 0; e < 3; ++e)
        between[e] = w[e] + s * u[e] - t * v[e];
    return ax_dot3(between, between);
}

// Whether the segment a b goes through the triangle: its ends lie on two sides, and its line passes all edges on the same.
static bool goes_through(const double a[3], const double b[3], const double corners[3][3])
{
    double along[3], volume[3], normal[3], from[3], to[3];
    ax_sub3(b, a, along);
    for (int k = 0; k < 3; ++k) {
        double edge[3], reach[3], across[3];
        ax_sub3(corners[(k + 1) % 3], corners[k], edge);
        ax_sub3(a, corners[k], reach);
        ax_cross(edge, reach, across);
        volume[k] = ax_dot3(across, along);
    }
    ax_sub3(corners[1], corners[0], from);
    ax_sub3(corners[2], corners[0], to);
    ax_cross(from, to, normal);
    ax_sub3(a, corners[0], from);
    ax_sub3(b, corners[0], to);
    return ax_dot3(from, normal) * ax_dot3(to, normal) < 0 && volume[0] * volume[1] > 0 && volume[1] * volume[2] > 0;
}

// Two triangles are nearest at a corner of one, between two edges, or where an edge goes through the other.
static double triangles_squared(const double one[3][3], const double other[3][3])
{
    double least = INFINITY;
    const double(*pair[2])[3] = {one, other};
    for (int p = 0; p < 2; ++p)
        for (int k = 0; k < 3; ++k) {
            const double(*of)[3] = pair[p], (*to)[3] = pair[!p];
            double weight[3], away[3];
            if (goes_through(of[k], of[(k + 1) % 3], to))
                return 0;
            closest_weights(of[k], to[0], to[1], to[2], weight);
            for (int e = 0; e < 3; ++e)
                away[e] = of[k][e] - (weight[0] * to[0][e] + weight[1] * to[1][e] + weight[2] * to[2][e]);
            least = fmin(least, ax_dot3(away, away));
        }
    for (int i = 0; i < 3; ++i)
        for (int k = 0; k < 3; ++k)
            least = fmin(least, segments_squared(one[i], one[(i + 1) % 3], other[k], other[(k + 1) % 3]));
    return least;
}

typedef struct triangle_search {
    const ax_closest* closest;
    const double (*corners)[3];
    double squared;
} triangle_search;

static void try_pair(void* context, int place)
{
    triangle_search* s = context;
    s->squared = fmin(s->squared, triangles_squared(s->corners, (const double(*)[3])s->closest->corners[place]));
}

double ax_closest_to_triangle(const ax_closest* closest, const double corners[3][3], double limit)
{
    triangle_search s = {closest, corners, limit * limit};
    double lo[3], hi[3];
    for (int e = 0; e < 3; ++e) {
        lo[e] = fmin(corners[0][e], fmin(corners[1][e], corners[2][e]));
        hi[e] = fmax(corners[0][e], fmax(corners[1][e], corners[2][e]));
    }
    ax_box_tree_nearest(&closest->tree, lo, hi, &s.squared, try_pair, &s);
    return s.squared < limit * limit ? sqrt(s.squared) : limit;
}

static void nearest(const void* geometry, const double x[3], double out[3])
{
    if (!isfinite(4 * ax_dot3(x, x))) { // of a solver that diverges: it stays so, and the solver says it
        memcpy(out, x, 3 * sizeof *out);
        return;
    }
    ax_closest_point found = ax_closest_find(geometry, x, -1);
    memcpy(out, found.point, sizeof found.point);
}

ax_place ax_closest_place(const ax_closest* closest)
{
    return (ax_place){.nearest = nearest, .geometry = closest};
}
