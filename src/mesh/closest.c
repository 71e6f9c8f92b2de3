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
    ax_box_tree_nearest(&closest->tree, x, &s.squared, try_place, &s);
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
