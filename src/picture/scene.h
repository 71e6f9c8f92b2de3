// What a picture shows, as triangles: about the origin, with a bounding box of diagonal 1, whatever the model's place and size, so
// that every later step can work in single precision.
#pragma once

#include "ax/mesh.h"
#include "picture/colour.h"

// Maps the model into the scene: (place - centre) / size.
typedef struct ax_scene_frame {
    double centre[3], size;
} ax_scene_frame;

// How a face looks.
typedef struct ax_paint {
    float rgb[3];                     // linear light
    bool hatched;                     // with ink, at 45 degrees
    int outline_first, outline_count; // vertices of a convex polygon whose edges are drawn, counter-clockwise; 0: none
} ax_paint;

typedef struct ax_scene {
    ax_scene_frame frame;
    int vertex_count, vertex_capacity;
    float (*places)[3];
    int face_count, face_capacity;
    int (*faces)[3]; // counter-clockwise seen from their front
    int* face_paint;
    int paint_count, paint_capacity;
    ax_paint* paints;
    // A smooth surface instead of flat faces: unit normals towards the front and values, per vertex; paints are then unused.
    float (*normals)[3];
    float* values;
    ax_palette palette;
    bool two_sided; // faces without thickness: backs are seen, and darker
} ax_scene;

void ax_scene_free(ax_scene* scene);

// The frame of some points, false if any of them is not finite.
bool ax_scene_find_frame(int count, const double (*places)[3], ax_scene_frame* frame);

// Each returns the index of what it adds.
int ax_scene_add_vertex(ax_scene* scene, const double place[3]); // in the scene's frame already
int ax_scene_add_face(ax_scene* scene, int a, int b, int c, int paint);
int ax_scene_add_paint(ax_scene* scene, const double rgb[3], double gain); // rgb in sRGB, gain on linear light

// A target surface coloured by a value per vertex; the side named by `front` (1: that of the normals, -1) faces the eye.
ax_scene ax_scene_of_surface(const ax_mesh* mesh, const double* values, const ax_palette* palette, int front);
