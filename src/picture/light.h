// The light on a scene: sky, one key light with shadows, one fill, and the shadow on the ground below.
#pragma once

#include "picture/scene.h"
#include "picture/view.h"

typedef struct ax_light {
    double key[3], fill[3]; // unit vectors towards the lights
    double white[3];        // light on an upward face in the open, per channel: it shows a map's colours as they are
    // What the key light sees.
    ax_view sun;
    int sun_size;
    float* sun_near;
    double bias; // how far off a face its shadow is looked up
    // What the ground gets to see: share of the light that is kept off, 0..1, on a grid of square cells.
    double ground; // its height
    double shadow_origin[2], shadow_cell;
    int shadow_columns, shadow_rows;
    float* shadow;
} ax_light;

typedef struct ax_light_setup {
    double key[3], fill[3]; // towards the lights, any length
    double ground;          // height of the ground, below the scene
    double thickness;       // of what casts shadows
    double contact_blur;    // width of the softest edge of a shadow where the scene touches the ground
    double height_blur;     // and how much it grows with height
    int shadow_size;        // cells of the ground's shadow along its longer side
    bool self_shadow;
} ax_light_setup;

ax_light ax_light_make(const ax_scene* scene, const ax_light_setup* setup);
void ax_light_free(ax_light* light);

// Light on a face at a place, per channel, relative to `white`.
void ax_light_on(const ax_light* light, const double place[3], const double normal[3], double rgb[3]);
// Share of light missing at a place on the ground.
double ax_light_ground_shadow(const ax_light* light, double x, double y);
