#include "ax/mesh.h"

#include "mesh/geometry.h"

#include <math.h>

void ax_mesh_free(ax_mesh* mesh)
{
    if (!mesh)
        return;
    ax_free(mesh->positions);
    ax_free(mesh->faces);
    *mesh = (ax_mesh){0};
}

ax_mesh ax_mesh_copy(const ax_mesh* mesh)
{
    return (ax_mesh){
        .vertex_count = mesh->vertex_count,
        .face_count = mesh->face_count,
        .positions = ax_copy(mesh->positions, (size_t)mesh->vertex_count, sizeof *mesh->positions),
        .faces = ax_copy(mesh->faces, (size_t)mesh->face_count, sizeof *mesh->faces),
    };
}

double ax_mesh_resize(ax_mesh* mesh, double size)
{
    double lo[3], hi[3], longest = 0;
    ax_bounds(mesh, lo, hi);
    for (int d = 0; d < 3; ++d)
        longest = fmax(longest, hi[d] - lo[d]);
    double factor = longest > 0 ? size / longest : 1;
    for (int v = 0; v < mesh->vertex_count; ++v)
        for (int d = 0; d < 3; ++d)
            mesh->positions[v][d] *= factor;
    return factor;
}
