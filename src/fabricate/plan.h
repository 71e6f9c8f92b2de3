// Building a cut plan: points, paths and items are appended to pools that double.
#pragma once

#include "ax/fabricate.h"

typedef struct ax_plan_builder {
    ax_cut_plan* plan;
    int point_room, path_room, item_room;
} ax_plan_builder;

// A motion of the plane: x' = c x - s y + dx, y' = s x + c y + dy.
typedef struct ax_motion {
    double c, s, dx, dy;
} ax_motion;
static const ax_motion ax_stay = {1, 0, 0, 0};

static inline void ax_move(const ax_motion* motion, double x, double y, double out[2])
{
    out[0] = motion->c * x - motion->s * y + motion->dx;
    out[1] = motion->s * x + motion->c * y + motion->dy;
}

// An item takes the paths, and a path the points, appended until the next one begins.
void ax_plan_item(ax_plan_builder* b, ax_operation operation, int panel, const char* format, ...)
    __attribute__((format(printf, 4, 5)));
void ax_plan_path(ax_plan_builder* b, bool closed);
void ax_plan_point(ax_plan_builder* b, double x, double y);
// From the last point round `centre` to (x, y), by `sweep` radians, counter-clockwise positive; in two arcs if it is more than a
// half circle. With `last`, the point (x, y) is the path's first and is not repeated.
void ax_plan_arc(ax_plan_builder* b, const double centre[2], double x, double y, double sweep, bool last);
void ax_plan_circle(ax_plan_builder* b, double x, double y, double radius, bool clockwise);
// Appends a copy of a path, moved.
void ax_plan_copy(ax_plan_builder* b, int path, const ax_motion* motion);
// Appends the strokes of `text`, its base line's left end at (x, y), running in direction (cos, sin) of the motion.
void ax_plan_text(ax_plan_builder* b, const char* text, double height, const ax_motion* place);

// Sets the plan's title (NULL: none): whole characters, as many as fit; bytes that are not UTF-8, as names of files may have, become '?'.
void ax_plan_set_title(ax_cut_plan* plan, const char* title);

// Area with the sign of the turning sense, and length, of a path.
double ax_path_area(const ax_cut_plan* plan, const ax_cut_path* path);
double ax_path_length(const ax_cut_plan* plan, const ax_cut_path* path);
// Widens lo, hi to hold the path with its arcs.
void ax_path_bounds(const ax_cut_plan* plan, const ax_cut_path* path, double lo[2], double hi[2]);
