// Loop's subdivision (Smooth Subdivision Surfaces Based on Triangles, Master's thesis, University of Utah 1987), with cubic B-splines along
// the rim (Hoppe et al. 1994, Piecewise smooth surface reconstruction, crease rules) that keep its corners.
#include "base/vec.h"
#include "mesh/closest.h"
#include "mesh/corners.h"
#include "mesh/geometry.h"
#include "mesh/topology.h"

#include <assert.h>
#include <math.h>
#include <string.h>

static const double corner_turn = 50 * AX_PI / 180; // a rim that turns more at a vertex has a corner there, which stays

typedef struct rim_neighbours {
    int before, after; // along the rim, -1 inside
} rim_neighbours;

static rim_neighbours* rim_of(const ax_mesh* mesh, const ax_topology* t)
{
    rim_neighbours* rim = AX_NEW(rim_neighbours, mesh->vertex_count);
    for (int v = 0; v < mesh->vertex_count; ++v)
        rim[v] = (rim_neighbours){-1, -1};
    for (int h = 0; h < 3 * mesh->face_count; ++h)
        if (t->twin[h] < 0) {
            int from = ax_half_edge_from(mesh, h), to = ax_half_edge_to(mesh, h);
            rim[from].after = to, rim[to].before = from;
        }
    return rim;
}

// Corners of the rim, by its first shape: what later rounds make of a bend is smooth.
static unsigned char* corners_of_rim(const ax_mesh* mesh)
{
    ax_topology t = ax_topology_make(mesh);
    rim_neighbours* rim = rim_of(mesh, &t);
    unsigned char* corner = AX_NEW0(unsigned char, mesh->vertex_count);
    for (int v = 0; v < mesh->vertex_count; ++v)
        if (rim[v].after >= 0) {
            double a[3], b[3];
            ax_sub3(mesh->positions[v], mesh->positions[rim[v].before], a);
            ax_sub3(mesh->positions[rim[v].after], mesh->positions[v], b);
            corner[v] = ax_dot3(a, b) < cos(corner_turn) * ax_norm3(a) * ax_norm3(b);
        }
    ax_free(rim);
    ax_topology_free(&t);
    return corner;
}

// Where an old vertex goes: a share of itself, the rest evenly of its neighbours.
static void move_vertices(const ax_mesh* mesh, const rim_neighbours* rim, const unsigned char* corner, double (*out)[3])
{
    ax_corners around = ax_corners_make(mesh);
    for (int v = 0; v < mesh->vertex_count; ++v) {
        const double* x = mesh->positions[v];
        int degree = around.start[v + 1] - around.start[v];
        double sum[3] = {0}, own;
        if (rim[v].after < 0) {
            for (int i = around.start[v]; i < around.start[v + 1]; ++i)
                for (int c = 0; c < 3; ++c)
                    sum[c] += mesh->positions[ax_corner_vertex(mesh, ax_corner_after(around.corner[i]))][c] / degree;
            double wave = 0.375 + cos(2 * AX_PI / degree) / 4;
            own = 0.375 + wave * wave;
        } else {
            for (int c = 0; c < 3; ++c)
                sum[c] = (mesh->positions[rim[v].before][c] + mesh->positions[rim[v].after][c]) / 2;
            own = corner[v] ? 1 : 0.75;
        }
        for (int c = 0; c < 3; ++c)
            out[v][c] = own * x[c] + (1 - own) * sum[c];
    }
    ax_corners_free(&around);
}

// One round; `mesh` is replaced.
static void subdivide(ax_mesh* mesh, unsigned char** corner)
{
    ax_topology t = ax_topology_make(mesh);
    rim_neighbours* rim = rim_of(mesh, &t);
    int edges = 0, sides = 3 * mesh->face_count;
    int* middle = AX_NEW(int, sides); // per half-edge: the vertex that divides it
    for (int h = 0; h < sides; ++h)
        middle[h] = t.twin[h] < 0 || h < t.twin[h] ? mesh->vertex_count + edges++ : middle[t.twin[h]];
    ax_mesh fine = {.vertex_count = mesh->vertex_count + edges, .face_count = 4 * mesh->face_count};
    fine.positions = ax_alloc((size_t)fine.vertex_count, sizeof *fine.positions);
    fine.faces = ax_alloc((size_t)fine.face_count, sizeof *fine.faces);
    move_vertices(mesh, rim, *corner, fine.positions);
    for (int h = 0; h < sides; ++h) {
        if (t.twin[h] >= 0 && t.twin[h] < h)
            continue;
        const double *a = mesh->positions[ax_half_edge_from(mesh, h)], *b = mesh->positions[ax_half_edge_to(mesh, h)];
        double* x = fine.positions[middle[h]];
        for (int c = 0; c < 3; ++c)
            x[c] = t.twin[h] < 0
                       ? (a[c] + b[c]) / 2
                       : 0.375 * (a[c] + b[c]) + 0.125 * (mesh->positions[ax_corner_vertex(mesh, h)][c] +
                                                          mesh->positions[ax_corner_vertex(mesh, t.twin[h])][c]);
    }
    for (int f = 0; f < mesh->face_count; ++f) {
        const int *v = mesh->faces[f], *m = middle + 3 * f; // m[k] divides the side opposite corner k
        const int parts[4][3] = {{v[0], m[2], m[1]}, {v[1], m[0], m[2]}, {v[2], m[1], m[0]}, {m[0], m[1], m[2]}};
        memcpy(fine.faces[4 * f], parts, sizeof parts);
    }
    *corner = ax_realloc(*corner, (size_t)fine.vertex_count, 1);
    memset(*corner + mesh->vertex_count, 0, (size_t)edges);
    ax_free(middle);
    ax_free(rim);
    ax_topology_free(&t);
    ax_mesh_free(mesh);
    *mesh = fine;
}

ax_refinement ax_mesh_refine(ax_mesh* mesh, double facet)
{
    enum { MOST_FACES = 2000000 };
    assert(facet > 0 && mesh->face_count > 0);
    ax_refinement done = {.largest_move = 0};
    int old = mesh->vertex_count;
    double(*before)[3] = ax_copy(mesh->positions, (size_t)old, sizeof *before);
    unsigned char* corner = corners_of_rim(mesh);
    for (; ax_mean_facet(mesh) > facet && 4 * mesh->face_count <= MOST_FACES; ++done.rounds)
        subdivide(mesh, &corner);
    ax_closest* tree = done.rounds ? ax_closest_make(mesh) : NULL;
    for (int v = 0; v < old && tree; ++v)
        done.largest_move = fmax(done.largest_move, ax_closest_find(tree, before[v], -1).distance);
    ax_closest_free(tree);
    ax_free(corner);
    ax_free(before);
    return done;
}
