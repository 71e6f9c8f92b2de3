// Triangle meshes: reading them from files, and what is wrong with them.
#pragma once

#include "ax/base.h"

// A triangle mesh in the file's own coordinates. `faces` index `positions` from 0. Owned arrays, freed by ax_mesh_free.
typedef struct ax_mesh {
    int vertex_count, face_count;
    double (*positions)[3];
    int (*faces)[3];
} ax_mesh;

void ax_mesh_free(ax_mesh* mesh); // also resets to an empty mesh; NULL allowed
ax_mesh ax_mesh_copy(const ax_mesh* mesh);

// What was mended while reading, each a count; none of these is an error by itself.
typedef struct ax_mesh_repairs {
    int welded_vertices;  // vertices closer than 1e-7 of the diagonal, merged
    int degenerate_faces; // faces without area: dropped, or taken in by the neighbour on their long side
    int duplicate_faces;  // the same three vertices again, dropped
    int unused_vertices;  // in no face, dropped
    int flipped_faces;    // turned to agree with their neighbours
    bool turned_outward;  // all faces turned, so that normals point to the side on which the surface bulges
} ax_mesh_repairs;

// Which axis of a file points up. Meshes that were read have z up: where y points up, the file's (x, y, z) became (x, -z, y).
typedef enum ax_up {
    AX_UP_FILE, // as the format or the file says: y for glTF, what Collada and FBX name, else z
    AX_UP_Y,
    AX_UP_Z,
} ax_up;
extern const char* const ax_up_words[3]; // "file", "y", "z"

// How to read, and limits for the separate process in which files are parsed.
typedef struct ax_read_options {
    double seconds; // wall time, > 0
    size_t bytes;   // memory, > 0
    ax_up up;
} ax_read_options;
ax_read_options ax_read_options_default(void); // 120 s, 6 GiB, as the file says

// Reads a surface that can become a linkage: OBJ, STL, PLY, OFF and whatever else the importer knows, chosen by content
// and ending. Coordinates have single precision, as the importer keeps them. The file is parsed by the program
// auxshell-read-mesh, in a process of its own that is gone when this returns. NULL options: the defaults. Welds, drops
// what has no area, orients, and validates: one part, manifold, orientable, one boundary loop. AX_BAD_INPUT names the
// fault and its place (vertex, face or edge with coordinates) and how to mend it; AX_CANNOT_REALISE names a sound mesh
// of a kind that is not handled (several boundary loops). `repairs` may be NULL. On failure `mesh` is empty.
ax_status ax_mesh_read(const char* path, const ax_read_options* options, ax_mesh* mesh, ax_mesh_repairs* repairs,
                       ax_error* error);

// Reads whatever triangles a file has, as they stand: geometry to keep away from or to lie on, not to flatten. Only indices and
// coordinates are checked. Options and errors as above.
ax_status ax_mesh_read_faces(const char* path, const ax_read_options* options, ax_mesh* mesh, ax_error* error);

// The same as ax_mesh_read from arrays in memory, for meshes that a program makes: welds, drops, orients, validates in place. Faults
// are placed by the numbers of the arrays handed in. On failure the mesh is freed and empty.
ax_status ax_mesh_make_surface(ax_mesh* mesh, ax_mesh_repairs* repairs, ax_error* error);

// Writes a mesh as OBJ, whole or not at all; vertex k + 1 is positions[k], exactly. AX_FAILED when it cannot be written.
ax_status ax_mesh_write(const ax_mesh* mesh, const char* path, ax_error* error);

// Scales about the origin until the longest of its extents in x, y and z is `size`, > 0. Returns the factor; 1 for a mesh without size.
double ax_mesh_resize(ax_mesh* mesh, double size);

// What refining has done.
typedef struct ax_refinement {
    int rounds;          // each divides every face into four; 0: fine enough already
    double largest_move; // largest distance of a vertex as it was from the surface as it is, in the mesh's unit
} ax_refinement;

// Divides and rounds a surface (as ax_mesh_read returns it) by Loop's subdivision until the side of its mean facet is `facet` or less, or the
// mesh would have more than two million faces. The rim becomes a smooth curve but for corners that turn by more than 50 degrees, which stay.
// Vertices keep their numbers; new ones follow. The surface shrinks a little where it bulges.
ax_refinement ax_mesh_refine(ax_mesh* mesh, double facet);
