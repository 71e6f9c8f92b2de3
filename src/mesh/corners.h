// The corners around each vertex, so that algorithms can work vertex by vertex in linear time. Corner c = 3 f + k is
// corner k of face f; half-edge c lies opposite.
#pragma once

#include "ax/mesh.h"

typedef struct ax_corners {
    int* start;  // vertex_count + 1
    int* corner; // 3 face_count, grouped by vertex, ascending within each
} ax_corners;

ax_corners ax_corners_make(const ax_mesh* mesh);
void ax_corners_free(ax_corners* corners);

// The next and previous corner of the same face. Half-edge ax_corner_before(c) leaves the vertex of corner c, half-edge
// ax_corner_after(c) arrives there.
static inline int ax_corner_after(int c)
{
    return c % 3 == 2 ? c - 2 : c + 1;
}
static inline int ax_corner_before(int c)
{
    return c % 3 == 0 ? c + 2 : c - 1;
}
static inline int ax_corner_vertex(const ax_mesh* mesh, int c)
{
    return mesh->faces[c / 3][c % 3];
}
