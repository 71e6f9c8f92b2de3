// Triangles to samples: a depth buffer with exact coverage. Corners are snapped to 1/128 pixel, so that triangles which share
// an edge leave no gap and no sample is hit twice. Works tile by tile: memory does not grow with the picture.
#pragma once

#include "ax/base.h"

enum { AX_RASTER_TILE = 64, AX_RASTER_SAMPLES = 16 };

typedef struct ax_raster_vertex {
    double x, y; // pixels, y down
    float near;  // grows towards the eye, and is affine over the picture: 1/depth in perspective, -depth without
} ax_raster_vertex;

// What is seen in one tile. Sample k of the pixel in column i, row j of the tile stands at [(j * AX_RASTER_TILE + i) * samples + k].
typedef struct ax_raster_tile {
    int x, y, width, height; // in the picture
    const int* faces;        // face seen, -1 for none; NULL if no face touches the tile
    const float* near;       // its nearness, -infinity for none; NULL likewise
} ax_raster_tile;

// Place of sample k within its pixel, in [0, 1): with several samples, no two share a row or a column, so that edges of every
// direction get as many steps as there are samples.
void ax_raster_sample(int samples, int k, double place[2]);

// Calls `resolve` for every tile of the picture, in reading order. samples: 1 or AX_RASTER_SAMPLES. Of equally near faces the
// first is seen; both sides of a face are.
void ax_raster(int width, int height, int samples, int vertex_count, const ax_raster_vertex* vertices, int face_count,
               const int (*faces)[3], void (*resolve)(void* context, const ax_raster_tile* tile), void* context);
