// Differential quantities of a triangle mesh. Arrays are the caller's, sized as noted.
#pragma once

#include "ax/mesh.h"
#include "linalg/sparse.h"

double ax_face_area(const ax_mesh* mesh, int face);
double ax_mesh_area(const ax_mesh* mesh);
// Side of the equilateral triangle of mean area; 0 without faces.
double ax_mean_facet(const ax_mesh* mesh);
void ax_face_normal(const ax_mesh* mesh, int face, double normal[3]); // unit; zero for a degenerate face
void ax_bounds(const ax_mesh* mesh, double lo[3], double hi[3]);
double ax_diagonal(const ax_mesh* mesh);

// Area-weighted unit normals. out: vertex_count.
void ax_vertex_normals(const ax_mesh* mesh, double (*out)[3]);
// The part of the surface nearest to each vertex: Voronoi areas, in obtuse faces cut off at their middle lines (Meyer
// et al. 2003). out: vertex_count.
void ax_vertex_areas(const ax_mesh* mesh, double* out);
// Corner angles in radians. out: face_count x 3.
void ax_corner_angles(const ax_mesh* mesh, double (*out)[3]);

// Cotangent Laplacian (Pinkall and Polthier 1993), positive semidefinite: row i sums 1/2 (cot a + cot b)(x_i - x_j).
ax_sparse ax_cotan_laplacian(const ax_mesh* mesh);

// Mean curvature H = n . (A x) / (2 m) with respect to the vertex normal: 1/R on a sphere of radius R with outward
// faces. On the rim the average of the interior neighbours (0 if there are none). out: vertex_count.
void ax_mean_curvature(const ax_mesh* mesh, double* out);
