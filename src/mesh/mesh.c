#include "ax/mesh.h"

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
