// What is written on a picture: a title, the legend of its colours, a scale bar. Numbers are written the same in every locale.
#pragma once

#include "picture/colour.h"
#include "picture/view.h"

#include <cairo.h>

enum { AX_LEGEND_BINS = 50 };

typedef struct ax_legend {
    const char* title;
    ax_palette palette;
    const char* words[2];        // below the map's two ends, NULL: none
    double realised[2];          // range that occurs
    double bins[AX_LEGEND_BINS]; // how often each fiftieth of the map occurs, any unit
} ax_legend;

// A legend without words and values.
ax_legend ax_legend_make(const char* title, const ax_palette* palette);
// Counts a value into the bins and the realised range; NaN is passed over.
void ax_legend_count(ax_legend* legend, double value, double weight);

// Sizes are in units of `unit` pixels. The card's place is known before it is drawn, so that the view can keep clear of it.
ax_rectangle ax_legend_card(const ax_legend* legend, int height, double unit);
void ax_legend_draw(cairo_t* cr, const ax_legend* legend, int height, double unit);

void ax_title_draw(cairo_t* cr, const char* title, const char* text, double unit);

// A word on a light plate about a point.
void ax_label_draw(cairo_t* cr, const char* text, double x, double y, double unit);

// A bar of 1, 2 or 5 times a power of ten, at most `longest` pixels long, for a length of `unit_pixels` pixels.
typedef struct ax_scale_bar {
    double length, pixels; // in the document's unit, in the picture
} ax_scale_bar;
ax_scale_bar ax_scale_bar_make(double unit_pixels, double longest);
void ax_scale_bar_draw(cairo_t* cr, const ax_scale_bar* bar, const char* unit_name, int width, int height, double unit);
// The same corner in a perspective view, where no bar holds: the distance of the ground's grid lines.
void ax_grid_note_draw(cairo_t* cr, double distance, const char* unit_name, int width, int height, double unit);

// A number with a fixed count of decimals, 0 to 9, with a real minus; very large and very small ones as 2e-7.
void ax_write_number(char* text, size_t size, double value, int decimals);
// Decimals for three significant digits of `largest`.
int ax_decimals_for(double largest);
// Largest of 1, 2, 5 times a power of ten that is at most x; x > 0.
double ax_round_length(double x);
