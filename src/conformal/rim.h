// Closed curves in the plane, counter-clockwise, for the rim of a flattening. Rim edge k runs from rim vertex k to k +
// 1.
#pragma once

#include "ax/base.h"

// The closed curve whose edges turn by turning[k] (sum 2 pi) before edge k and are as long as target[k], except for the
// smallest change that closes it, weighted by 1 / length (Sawhney and Crane 2017, section 4.3).
void ax_rim_close(int count, const double* turning, const double* target, const double* length, double (*curve)[2]);

// The polygon inscribed in a circle about the origin, arcs in proportion to target, with the perimeter sum(target).
void ax_rim_circle(int count, const double* target, double (*curve)[2]);

// Turning angles of the inscribed polygon above: half of the two arcs that meet. out: count.
void ax_rim_circle_turning(int count, const double* target, double* turning);

// Where a polygon with the given interior angles (degrees) has its corners on a rim with these turning angles and edge
// lengths. out: rim vertices, in the order of the angles along the rim.
void ax_rim_corners(int count, const double* turning, const double* length, int corner_count, const double* angles,
                    int* corner);

// Whether no two edges of a closed polygon cross. Linear time for evenly spread edges.
bool ax_rim_is_simple(int count, const double (*points)[2]);
