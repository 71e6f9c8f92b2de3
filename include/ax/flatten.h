// Conformal flattening of a disk-like surface (Boundary First Flattening, Sawhney and Crane 2017).
#pragma once

#include "ax/mesh.h"

typedef enum ax_flatten_boundary {
    AX_FLATTEN_FREE,    // u = 0 on the rim: least area distortion, the shape of the flat rim comes out
    AX_FLATTEN_DISK,    // the rim becomes a circle
    AX_FLATTEN_POLYGON, // the rim becomes a polygon with given corner angles
} ax_flatten_boundary;

typedef struct ax_flatten_options {
    ax_flatten_boundary boundary;
    // Polygon: at least 3 interior angles in degrees, each between 0 and 360, summing to (corner_count - 2) * 180, in
    // their order along the rim. Corners go where the rim turns most, missing ones divide its longest sides evenly.
    int corner_count;
    const double* corner_angles;
} ax_flatten_options;

// uv: one point per vertex, counter-clockwise rim, at the scale at which lengths are e^u times those of the surface. It
// lies as the surface does when seen from its outer side, x to the right, with its centroid (disk: its centre) at the
// origin. u is 0 on a free rim and averages 0 along the others.
typedef struct ax_flattening {
    int vertex_count, rim_count;
    double (*uv)[2];
    double* u;                                        // logarithm of the length scale from surface to plane, per vertex
    int* rim;                                         // vertices of the boundary loop, counter-clockwise
    double u_min, u_max;                              // over all vertices
    double quasi_conformal_mean, quasi_conformal_max; // ratio of singular values per face: 1 is conformal
    int flipped_faces;                                // faces turned over in the plane; 0 for a usable flattening
} ax_flattening;

void ax_flattening_free(ax_flattening* flattening);

// `mesh` must be a disk (as ax_mesh_read returns it). NULL options: AX_FLATTEN_FREE. Fails with AX_USAGE on impossible
// corner angles, with AX_CANNOT_REALISE on a handle or several boundary loops, and with AX_FAILED if the factorisation
// breaks down. On failure `out` is empty.
ax_status ax_flatten(const ax_mesh* mesh, const ax_flatten_options* options, ax_flattening* out, ax_error* error);
