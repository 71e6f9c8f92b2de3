// From a soup of triangles to a surface: what ax_mesh_make_surface does, for a reader that knows how its vertices came
// about.
#pragma once

#include "ax/mesh.h"

typedef enum ax_vertex_order {
    AX_VERTICES_NUMBERED, // as in the file, so messages may give their numbers
    AX_VERTICES_REPEATED, // the format repeats them for every triangle: no numbers
    AX_VERTICES_SPLIT,    // the importer repeated them: no numbers, and undoing that is no repair
} ax_vertex_order;

ax_status ax_surface_make(ax_mesh* mesh, ax_vertex_order order, ax_mesh_repairs* repairs, ax_error* error);
