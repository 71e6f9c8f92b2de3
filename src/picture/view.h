// Where a picture is taken from, and how what it shows is fitted into it.
#pragma once

#include "ax/base.h"
#include "base/vec.h"
#include "picture/raster.h"

typedef struct ax_view {
    bool perspective;
    double eye[3], right[3], up[3], forward[3];
    double scale, offset[2]; // image plane to pixels
} ax_view;

typedef struct ax_rectangle {
    double x, y, width, height;
} ax_rectangle;

// Perspective towards the origin from `distance` in the direction azimuth (from x towards y), elevation; radians.
ax_view ax_view_from(double azimuth, double elevation, double distance);
// Parallel projection along a direction (a unit vector): above, or as the sun sees it.
ax_view ax_view_along(const double direction[3]);

ax_raster_vertex ax_view_project(const ax_view* view, const float place[3]);
// Ray through a point of the picture; `direction` has unit length.
void ax_view_ray(const ax_view* view, double x, double y, double origin[3], double direction[3]);

// Sets scale and offset so that all points fall within `safe`, clear of the obstacles (at most a few), as large and then as close
// to the middle of `safe` as possible. The perspective itself does not change, as if cropping.
void ax_view_frame(ax_view* view, int count, const float (*points)[3], ax_rectangle safe, int obstacle_count,
                   const ax_rectangle* obstacles);
