// Analytic target surfaces for tests, made in memory: nothing a newcomer has to download.
#pragma once

#include "ax/mesh.h"

// Disk-like polar mesh over the unit disk with `rings` rings, lifted by z = height(x, y); rim on the unit circle.
ax_mesh shape_over_disk(int rings, double (*height)(double x, double y));
// Spherical cap of a sphere of radius 1: polar angle from 0 to `angle` (pi / 2 is the hemisphere), rim in the plane z = 0
// when `angle` is pi / 2, else z = cos(angle).
ax_mesh shape_cap(int rings, double angle);
// z = c (1 - x^2 - y^2) over the unit disk: H > 0 everywhere.
ax_mesh shape_paraboloid(int rings, double c);
// Grid over the square [-1, 1]^2 with 2 n^2 triangles, lifted by z = height(x, y); its diagonals alternate.
ax_mesh shape_over_square(int n, double (*height)(double x, double y));
// Reads `mesh` in another frame: turned by `angle` (radians) about the x-axis, then moved.
void shape_move(ax_mesh* mesh, double angle, double x, double y, double z);
// The other side out.
void shape_turn_over(ax_mesh* mesh);
