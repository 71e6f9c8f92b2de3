// The shade of one or several shells on the ground: where the sun stands, how much of it the layers stop, and how to place layers so
// that they stop as much as is wanted.
#pragma once

#include "ax/design.h"
#include "ax/export.h"

// ---- the sun

typedef struct ax_instant {
    int year, month, day; // Gregorian
    double hours;         // universal time; may be negative or beyond 24
} ax_instant;

typedef struct ax_sun {
    double azimuth, elevation; // radians; azimuth from north through east
} ax_sun;
// The direction of the sun's centre, without refraction (0.02 degrees at 40 degrees of height, 0.1 at 10). `latitude`, `longitude` in
// degrees, north and east positive. Within 0.02 degrees from 1950 to 2050: the low-precision formulae of The Astronomical Almanac as in
// Michalsky, Solar Energy 40 (1988) 227-235.
ax_sun ax_sun_at(double latitude, double longitude, ax_instant t);

// Light from one direction, and its share in a mean.
typedef struct ax_ray {
    double to_sun[3]; // unit vector in the document's frame, z up
    double weight;    // > 0
} ax_ray;
// In a frame whose y axis points `north` radians clockwise from north seen from above (0: y is north, x east). The weight is what a
// clear sky leaves of the beam on level ground, in W/m2: Meinel and Meinel, Applied Solar Energy (1976), with the air mass of Kasten
// and Young, Applied Optics 28 (1989) 4735-4738. Zero below the horizon.
ax_ray ax_sun_ray(ax_sun sun, double north);
// Rays of a day, or a part of it, at the middles of `count` equal steps from t to `hours` later; those below the horizon are left
// out. Returns their number; rays holds `count`.
int ax_sun_day(double latitude, double longitude, double north, ax_instant t, double hours, int count, ax_ray* rays);

// ---- shade

typedef struct ax_layer {
    const ax_design* design;
    ax_state state; // AX_STATE_DEPLOYED or AX_STATE_SIMULATED
    double turn;    // radians, about the vertical through the document's origin
    double move[3]; // after that, in the unit of the first layer's document
    double extent;  // only panels whose middle, unmoved, is so near to the origin in plan; INFINITY: all
} ax_layer;

// A level rectangle on the ground in square cells.
typedef struct ax_ground {
    double height, lo[2]; // lower left corner
    double cell;          // side of a cell
    int columns, rows;
} ax_ground;

enum { AX_GROUND_CELLS = 4000000 };
// The ground on which these layers throw all their shade, in about `cells` cells: between the lowest and highest coordinates of all
// shadows. AX_USAGE if a state is missing or no ray is given.
ax_status ax_shade_ground(int layer_count, const ax_layer* layers, int ray_count, const ax_ray* rays, double height,
                          int cells, ax_ground* out, ax_error* error);

// How opaque the layers together are for each cell (rows x columns, from lo): the shaded part of its area, mean over the rays by their
// weights. 0: sun all the time; 1: none. Shadows are cast exactly and counted at 8 x 8 points a cell; the sun is a point, panels have
// no thickness. AX_USAGE for a ground without cells or with more than AX_GROUND_CELLS, and for no rays.
ax_status ax_shade_map(int layer_count, const ax_layer* layers, int ray_count, const ax_ray* rays,
                       const ax_ground* ground, const ax_progress* progress, double* opacity, ax_error* error);

// A disc on the ground, and the mean opacity wanted there.
typedef struct ax_shade_wish {
    double at[2], radius, opacity;
} ax_shade_wish;
// Mean over the cells whose middles lie in the disc; NaN if there is none.
double ax_shade_mean(const ax_ground* ground, const double* opacity, const ax_shade_wish* disc);

typedef struct ax_shade_search {
    int wish_count;
    const ax_shade_wish* wishes;
    double shift; // largest move of a layer in x and y from where it is; 0: none
    double turn;  // largest turn from where it is, radians
    bool extent;  // whether layers may be cut down
    int rounds;   // each halves the steps; 1 to 12
} ax_shade_search;
typedef struct ax_shade_found {
    double before, after; // rms of what the wishes are missed by
    int tried;            // placements
} ax_shade_found;
// Moves, turns and cuts down every layer but the first until the wishes are met as well as can be found: a compass search (Kolda,
// Lewis and Torczon, SIAM Review 45 (2003) 385-482) on `ground`. The result is never worse than the start; it need not be the best
// there is. AX_CANCELLED leaves the best so far.
ax_status ax_shade_arrange(int layer_count, ax_layer* layers, int ray_count, const ax_ray* rays,
                           const ax_ground* ground, const ax_shade_search* search, const ax_progress* progress,
                           ax_shade_found* found, ax_error* error);
