// Half-edge connectivity of a triangle mesh in two arrays. Half-edge h = 3 f + k is the side of face f opposite its
// corner k: it runs from corner (k + 1) % 3 to corner (k + 2) % 3.
#pragma once

#include "ax/mesh.h"

typedef struct ax_topology {
    int vertex_count, face_count;
    int* twin;             // per half-edge, -1 on the rim
    int loop_count;        // boundary loops
    int* loop_start;       // loop_count + 1
    int* loop;             // boundary vertices of each loop, with the surface on the left of the direction of travel
    unsigned char* on_rim; // per vertex
} ax_topology;

static inline int ax_half_edge_from(const ax_mesh* mesh, int h)
{
    return mesh->faces[h / 3][(h % 3 + 1) % 3];
}
static inline int ax_half_edge_to(const ax_mesh* mesh, int h)
{
    return mesh->faces[h / 3][(h % 3 + 2) % 3];
}

// `mesh` must be an oriented manifold (ax_mesh_make_surface has seen to it). Linear time.
ax_topology ax_topology_make(const ax_mesh* mesh);
void ax_topology_free(ax_topology* topology);
