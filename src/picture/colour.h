// Colour maps of the data. sRGB values in [0, 1] throughout; NaN (no value) becomes a neutral grey.
#pragma once

// Tide, for the scale factor: lambda from 1 (dark blue) to 2 (light yellow), clamped. The range is fixed, so that a colour means
// the same lambda in every picture. OKLab lightness rises evenly from 0.37 to 0.92, also under simulated colour blindness.
void ax_colour_scale(double lambda, double rgb[3]);

// Level, for what has a sign: from -1 (blue) over 0 (pale) to 1 (orange), clamped.
void ax_colour_level(double value, double rgb[3]);
