#include "ax/mesh.h"
#include "base/file.h"

ax_status ax_mesh_write(const ax_mesh* mesh, const char* path, ax_error* error)
{
    ax_file file;
    ax_status status = ax_file_begin(&file, path, error);
    if (status != AX_OK)
        return status;
    for (int v = 0; v < mesh->vertex_count; ++v)
        fprintf(file.stream, "v %.17g %.17g %.17g\n", mesh->positions[v][0], mesh->positions[v][1],
                mesh->positions[v][2]);
    for (int f = 0; f < mesh->face_count; ++f)
        fprintf(file.stream, "f %d %d %d\n", mesh->faces[f][0] + 1, mesh->faces[f][1] + 1, mesh->faces[f][2] + 1);
    return ax_file_commit(&file, error);
}
