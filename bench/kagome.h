// The solver's benchmark problem: a hexagonal kagome patch whose triangles want to grow 15 % inside a fixed outline. The interior
// must buckle or counter-rotate. Sizes N = 13, 41, 129, 224, 408 give 1,014 to 998,784 triangles (6 N^2).
#pragma once

#include "ax/base.h"

typedef struct kagome {
    int n, vertices, triangles, edges, fixed, hexagons;
    double (*regular)[3]; // unperturbed places, unit edges
    double (*start)[3];   // free vertices moved by at most 0.01 per coordinate; with a bump if `bump`
    int (*edge)[2];
    double* rest; // rest length of each edge
    int* fixed_vertex;
    int (*hexagon)[6];
} kagome;

kagome kagome_make(int n, bool bump);
void kagome_free(kagome* k);
// Largest and root mean square relative error of the edges.
void kagome_error(const kagome* k, const double (*x)[3], double* max, double* rms);
