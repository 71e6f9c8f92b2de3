// Exact closest points on a mesh (bounding volume tree) and on polylines.
#pragma once

#include "constraint/constraint_type.h"

#include "ax/mesh.h"

typedef struct ax_closest ax_closest;

// Builds the tree; `mesh` must stay alive and unchanged. Interpolated vertex normals are used for `normal` below.
ax_closest* ax_closest_make(const ax_mesh* mesh);
void ax_closest_free(ax_closest* tree);

typedef struct ax_closest_point {
    int face;
    double weight[3]; // barycentric
    double point[3];
    double normal[3]; // unit, interpolated from vertex normals
    double distance;
} ax_closest_point;

// The closest point of the surface to x; `hint` is a face to start from (the previous answer) or -1. Thread safe.
ax_closest_point ax_closest_find(const ax_closest* tree, const double x[3], int hint);

// Distance between the surface and a triangle, 0 where they cross, if it is below `limit`, which may be infinite; else `limit`.
// Thread safe.
double ax_closest_to_triangle(const ax_closest* tree, const double corners[3][3], double limit);

// The surface as a place for constraints that keep points on it, borrowed.
ax_place ax_closest_place(const ax_closest* tree);

// Closed polyline in 3D or in the plane (z = 0), with a tree over its segments.
typedef struct ax_polyline ax_polyline;
ax_polyline* ax_polyline_make(int count, const double (*points)[3]); // copies the points
void ax_polyline_free(ax_polyline* line);

typedef struct ax_polyline_point {
    int segment;      // from point segment to segment + 1 (cyclic)
    double parameter; // 0 to 1 on it
    double point[3];
    double tangent[3]; // unit, interpolated between the mean directions at the segment's ends
    double distance;
} ax_polyline_point;
ax_polyline_point ax_polyline_find(const ax_polyline* line, const double x[3]);
