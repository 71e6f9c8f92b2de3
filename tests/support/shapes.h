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
