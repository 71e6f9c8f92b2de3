#include "mesh/stream.h"

#include <string.h>

bool ax_stream_receive(bool (*take)(void* context, void* into, size_t bytes), void* context, ax_mesh* mesh,
                       ax_vertex_order* order)
{
    *mesh = (ax_mesh){0};
    ax_stream_header header;
    if (!take(context, &header, sizeof header) || memcmp(header.magic, ax_stream_magic, sizeof header.magic) != 0 ||
        header.order > AX_VERTICES_SPLIT || header.vertex_count > ax_stream_most_vertices ||
        header.face_count > ax_stream_most_faces)
        return false;
    mesh->vertex_count = (int)header.vertex_count;
    mesh->face_count = (int)header.face_count;
    mesh->positions = ax_alloc(header.vertex_count, sizeof *mesh->positions);
    mesh->faces = ax_alloc(header.face_count, sizeof *mesh->faces);
    *order = (ax_vertex_order)header.order;
    char end[sizeof ax_stream_end];
    if (take(context, mesh->positions, header.vertex_count * sizeof *mesh->positions) &&
        take(context, mesh->faces, header.face_count * sizeof *mesh->faces) && take(context, end, sizeof end) &&
        memcmp(end, ax_stream_end, sizeof end) == 0)
        return true;
    ax_mesh_free(mesh);
    return false;
}
