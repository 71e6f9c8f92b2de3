#include "mesh/topology.h"

#include "mesh/corners.h"

#include <assert.h>

ax_corners ax_corners_make(const ax_mesh* mesh)
{
    int n = mesh->vertex_count, corner_count = 3 * mesh->face_count;
    const int* vertex = (const int*)mesh->faces;
    ax_corners corners = {AX_NEW0(int, n + 1), AX_NEW(int, corner_count)};
    for (int c = 0; c < corner_count; ++c)
        ++corners.start[vertex[c] + 1];
    for (int v = 0; v < n; ++v)
        corners.start[v + 1] += corners.start[v];
    for (int c = 0; c < corner_count; ++c)
        corners.corner[corners.start[vertex[c]]++] = c;
    for (int v = n; v > 0; --v)
        corners.start[v] = corners.start[v - 1];
    corners.start[0] = 0;
    return corners;
}

void ax_corners_free(ax_corners* corners)
{
    ax_free(corners->start);
    ax_free(corners->corner);
    *corners = (ax_corners){0};
}

// Pairs v -> w with w -> v around one vertex at a time: linear also where thousands of faces meet, and without a hash.
static void match_twins(const ax_mesh* mesh, int* twin)
{
    ax_corners corners = ax_corners_make(mesh);
    int* outgoing = AX_NEW(int, mesh->vertex_count); // the half-edge from v to each neighbour, else -1
    for (int v = 0; v < mesh->vertex_count; ++v)
        outgoing[v] = -1;
    for (int v = 0; v < mesh->vertex_count; ++v) {
        const int *begin = corners.corner + corners.start[v], *end = corners.corner + corners.start[v + 1];
        for (const int* c = begin; c < end; ++c) {
            int h = ax_corner_before(*c);
            assert(outgoing[ax_half_edge_to(mesh, h)] < 0 && "not an oriented manifold");
            outgoing[ax_half_edge_to(mesh, h)] = h;
        }
        for (const int* c = begin; c < end; ++c) {
            int h = ax_corner_after(*c);
            twin[h] = outgoing[ax_half_edge_from(mesh, h)];
        }
        for (const int* c = begin; c < end; ++c)
            outgoing[ax_half_edge_to(mesh, ax_corner_before(*c))] = -1;
    }
    ax_free(outgoing);
    ax_corners_free(&corners);
}

ax_topology ax_topology_make(const ax_mesh* mesh)
{
    int n = mesh->vertex_count, half_edge_count = 3 * mesh->face_count;
    ax_topology topology = {.vertex_count = n,
                            .face_count = mesh->face_count,
                            .twin = AX_NEW(int, half_edge_count),
                            .on_rim = AX_NEW0(unsigned char, n)};
    match_twins(mesh, topology.twin);

    int* next = AX_NEW(int, n); // along the rim
    int rim_count = 0;
    for (int h = 0; h < half_edge_count; ++h)
        if (topology.twin[h] < 0) {
            int from = ax_half_edge_from(mesh, h);
            assert(!topology.on_rim[from] && "two sheets touch in one vertex");
            topology.on_rim[from] = 1;
            next[from] = ax_half_edge_to(mesh, h);
            ++rim_count;
        }

    topology.loop = AX_NEW(int, rim_count);
    topology.loop_start = AX_NEW(int, rim_count / 3 + 1); // no loop is shorter than three
    unsigned char* seen = AX_NEW0(unsigned char, n);
    int length = 0;
    for (int v = 0; v < n; ++v) {
        if (!topology.on_rim[v] || seen[v])
            continue;
        topology.loop_start[topology.loop_count++] = length;
        for (int w = v; !seen[w]; w = next[w]) {
            seen[w] = 1;
            topology.loop[length++] = w;
        }
    }
    topology.loop_start[topology.loop_count] = length;
    ax_free(seen);
    ax_free(next);
    return topology;
}

void ax_topology_free(ax_topology* topology)
{
    ax_free(topology->twin);
    ax_free(topology->loop_start);
    ax_free(topology->loop);
    ax_free(topology->on_rim);
    *topology = (ax_topology){0};
}
