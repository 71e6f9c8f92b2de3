// The solver's benchmark problem: a hexagonal kagome patch whose triangles want to grow 15 % inside a fixed outline. The interior
// must buckle or counter-rotate. Sizes N = 13, 41, 129, 224, 408 give 1,014 to 998,784 triangles (6 N^2).
#pragma once

#include "ax/base.h"

typedef struct kagome {
    int n, vertices, triangles, edges, fixed, hexagons;
    bool dynamic; // time steps of `inner` iterations each; else a static solve with a bump, and circles in the holes
    double (*regular)[3]; // unperturbed places, unit edges; NULL in a file of some other mesh
    double (*start)[3];   // free vertices moved by at most 0.01 per coordinate
    int (*edge)[2];
    double *rest, *stiffness; // of each edge: length, and the weight of |length - rest|^2
    int* fixed_vertex;        // held by w_fixed |x - start|^2
    int (*hexagon)[6];
    double mass, damping, time_step, gravity[3], w_fixed, w_circle;
    int inner;
} kagome;

kagome kagome_make(int n, bool dynamic);
// Reads a problem file ("kagome 1", whitespace-separated; through xz if its name ends in .xz). False, with a message on stderr, if it
// is not one.
bool kagome_read(const char* path, kagome* problem);
void kagome_free(kagome* k);
// Largest and root mean square relative error of the edges.
void kagome_error(const kagome* k, const double (*x)[3], double* max, double* rms);
