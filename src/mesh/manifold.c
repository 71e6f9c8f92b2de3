#include "mesh/manifold.h"

#include "mesh/corners.h"

// The half-edges that leave vertex v, as out[neighbour] = mark; -1 or the face at which one leaves twice.
static int mark_leaving(const ax_mesh* mesh, const ax_corners* corners, int v, int* out)
{
    for (int k = corners->start[v]; k < corners->start[v + 1]; ++k) {
        int c = corners->corner[k], to = ax_corner_vertex(mesh, ax_corner_after(c));
        if (out[to] == v)
            return c / 3;
        out[to] = v;
    }
    return -1;
}

bool ax_mesh_is_manifold(const ax_mesh* mesh, int* face)
{
    int n = mesh->vertex_count;
    for (int f = 0; f < mesh->face_count; ++f)
        for (int k = 0; k < 3; ++k) {
            int v = mesh->faces[f][k];
            if (v < 0 || v >= n || v == mesh->faces[f][(k + 1) % 3]) {
                *face = f;
                return false;
            }
        }
    ax_corners corners = ax_corners_make(mesh);
    int *out = AX_NEW(int, n), rim = 0;
    for (int v = 0; v < n; ++v)
        out[v] = -1;
    *face = -1;
    for (int v = 0; v < n && *face < 0; ++v) {
        *face = mark_leaving(mesh, &corners, v, out);
        int ends = 0; // rim edges that arrive at v: one per sheet
        for (int k = corners.start[v]; k < corners.start[v + 1] && *face < 0; ++k) {
            int c = corners.corner[k];
            if (out[ax_corner_vertex(mesh, ax_corner_before(c))] != v && ++ends > 1)
                *face = c / 3;
        }
        rim += ends;
    }
    ax_free(out);
    ax_corners_free(&corners);
    if (*face < 0 && rim == 0)
        *face = 0; // closed
    return *face < 0;
}
