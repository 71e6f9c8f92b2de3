// Small meshes from bytes: whatever comes in, a surface comes out that keeps its promises, or a message.
#include "ax/mesh.h"
#include "mesh/geometry.h"
#include "mesh/topology.h"

#include <math.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size);

static void promise(bool kept)
{
    if (!kept)
        abort();
}

static void check_surface(const ax_mesh* mesh)
{
    ax_topology topology = ax_topology_make(mesh); // asserts that it is an oriented manifold
    promise(topology.loop_count == 1);
    int rim = topology.loop_start[1], edges = (3 * mesh->face_count + rim) / 2;
    promise(mesh->vertex_count - edges + mesh->face_count == 1);
    promise(rim < mesh->vertex_count);
    ax_topology_free(&topology);
    for (int f = 0; f < mesh->face_count; ++f)
        promise(ax_face_area(mesh, f) > 0);

    ax_mesh again = ax_mesh_copy(mesh);
    ax_mesh_repairs repairs;
    promise(ax_mesh_make_surface(&again, &repairs, NULL) == AX_OK);
    promise(memcmp(&repairs, &(ax_mesh_repairs){0}, sizeof repairs) == 0);
    ax_mesh_free(&again);
}

// Coarse, so that vertices and faces coincide; the last values stand for what no coordinate should be.
static double coordinate(uint8_t byte)
{
    static const double strange[] = {NAN, INFINITY, 1e300, 1e-300, 1e-8, 1e7};
    size_t from_end = 255 - byte;
    return from_end < sizeof strange / sizeof *strange ? strange[from_end] : byte % 16;
}

static ax_mesh empty_mesh(int vertices, int faces)
{
    return (ax_mesh){vertices, faces, ax_calloc((size_t)vertices, sizeof(double[3])),
                     ax_calloc((size_t)faces, sizeof(int[3]))};
}

// A byte count of vertices, a byte a coordinate, then a byte a corner.
static ax_mesh any_mesh(const uint8_t* data, size_t size)
{
    int vertices = size ? data[0] % 64 : 0;
    if (size < 1 + 3 * (size_t)vertices)
        return (ax_mesh){0};
    ax_mesh mesh = empty_mesh(vertices, (int)((size - 1 - 3 * (size_t)vertices) / 3));
    for (int i = 0; i < 3 * vertices; ++i)
        mesh.positions[i / 3][i % 3] = coordinate(data[1 + i]);
    for (int i = 0; i < 3 * mesh.face_count; ++i) {
        uint8_t byte = data[1 + 3 * vertices + i];
        mesh.faces[i / 3][i % 3] = byte == 255 ? -1 : byte % (vertices + 1);
    }
    return mesh;
}

// A sound sheet with some damage: each three bytes turn a face, move a corner or move a coordinate.
static ax_mesh damaged_sheet(const uint8_t* data, size_t size)
{
    enum { n = 5 };
    ax_mesh mesh = empty_mesh(n * n, 2 * (n - 1) * (n - 1));
    for (int v = 0; v < n * n; ++v)
        mesh.positions[v][0] = v % n, mesh.positions[v][1] = v / n;
    for (int i = 0, f = 0; i < n - 1; ++i)
        for (int j = 0; j < n - 1; ++j) {
            int a = i * n + j, b = a + 1, c = a + n, d = c + 1;
            memcpy(mesh.faces[f++], (int[3]){a, b, d}, sizeof(int[3]));
            memcpy(mesh.faces[f++], (int[3]){a, d, c}, sizeof(int[3]));
        }
    for (size_t i = 0; i + 3 <= size; i += 3) {
        int* face = mesh.faces[data[i + 1] % mesh.face_count];
        int corner = data[i + 2] % (n * n);
        switch (data[i] % 6) {
        case 0:
            corner = face[1], face[1] = face[2], face[2] = corner;
            break;
        case 1:
        case 2:
        case 3:
            face[data[i] % 3] = corner;
            break;
        default:
            mesh.positions[corner][data[i] / 6 % 3] = coordinate(data[i + 1]);
            break;
        }
    }
    return mesh;
}

int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size)
{
    if (size < 1)
        return 0;
    ax_mesh mesh = data[0] % 2 ? any_mesh(data + 1, size - 1) : damaged_sheet(data + 1, size - 1);
    ax_error error = {0};
    ax_status status = ax_mesh_make_surface(&mesh, NULL, &error);
    if (status == AX_OK)
        check_surface(&mesh);
    else
        promise((status == AX_BAD_INPUT || status == AX_CANNOT_REALISE) && error.status == status && !mesh.faces &&
                error.message[0] && error.message[strlen(error.message) - 1] == '.');
    ax_mesh_free(&mesh);
    return 0;
}
