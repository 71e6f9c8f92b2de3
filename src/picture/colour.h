// Colour maps of the data. sRGB values in [0, 1] throughout; NaN (no value) becomes a neutral grey.
#pragma once

#include <stdbool.h>

// Tide, for the scale factor: lambda from 1 (dark blue) to 2 (light yellow), clamped. The range is fixed, so that a colour means
// the same lambda in every picture. OKLab lightness rises evenly from 0.37 to 0.92, also under simulated colour blindness.
void ax_colour_scale(double lambda, double rgb[3]);

// Level, for what has a sign: from -1 (blue) over 0 (pale) to 1 (orange), clamped.
void ax_colour_level(double value, double rgb[3]);

// A map together with what it shows.
typedef enum ax_palette_kind {
    AX_PALETTE_SCALE,     // Tide, 1 to 2
    AX_PALETTE_FORCE,     // Level, -limit to limit
    AX_PALETTE_SHADE,     // Tide the other way, 0 (light) to 1 (dark)
    AX_PALETTE_CURVATURE, // Level with a step at 0, so that the sign of the weakest curvature is seen too
} ax_palette_kind;

typedef struct ax_palette {
    ax_palette_kind kind;
    double limit; // > 0; unused by AX_PALETTE_SCALE and AX_PALETTE_SHADE
} ax_palette;

void ax_palette_range(const ax_palette* palette, double range[2]);
void ax_palette_colour(const ax_palette* palette, double value, double rgb[3]);
// True where colour alone must not carry the message: beyond the ends of the map, or where the curvature is not positive.
bool ax_palette_hatched(const ax_palette* palette, double value);

// Least of 1, 2, 5, 6 times a power of ten that is at least x; x > 0.
double ax_palette_limit(double x);

// One channel between sRGB and linear light, both in [0, 1].
double ax_colour_to_linear(double srgb);
double ax_colour_from_linear(double linear);
