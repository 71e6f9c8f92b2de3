// Curves in the plane from drawings: SVG and DXF.
//
// SVG: path (all commands), rect, circle, ellipse, line, polyline, polygon in groups with transforms, all of it scaled by the
// viewBox. Text, images, uses and what stands in defs are passed over. y is turned to point up: y_here = height - y_svg.
// DXF: LINE, LWPOLYLINE and POLYLINE with bulges, CIRCLE, ARC, ELLIPSE and SPLINE of the ENTITIES section, as text, seen along
// -z; blocks are passed over.
//
// A file that says its unit ($INSUNITS of DXF, a unit on width or height of an SVG) is converted to the document's. Without
// one its numbers are taken as they are.
#pragma once

#include "ax/base.h"

typedef struct ax_outline_curve {
    char name[64]; // id of the SVG element or the nearest group with one, layer of the DXF entity; may be empty
    int line;      // of the file, where its first element begins
    bool closed;   // the first point is not repeated at the end
    int count;     // points: 2 or more, 3 or more if closed
    double (*points)[2];
} ax_outline_curve;

typedef struct ax_outline {
    int count;
    ax_outline_curve* curves; // in the order of the file
} ax_outline;

// Flattened so that chords lie within `tolerance` of the curve (document units; 0: 1e-4 of the drawing's diagonal). Ends of open
// curves that lie within the tolerance of one another, of just two curves, are joined. `unit` is the length of a document unit in
// metres (ax_unit_in_metres). AX_BAD_INPUT with the line when the file is no drawing, is damaged, has no curve, or more than a
// million points. Which of the two formats it is shows in the contents.
ax_status ax_outline_read(const char* path, double unit, double tolerance, ax_outline* out, ax_error* error);
// The same from memory; `path` is for messages, and `bytes` must be followed by a zero byte.
ax_status ax_outline_parse(const char* path, const char* bytes, size_t size, double unit, double tolerance,
                           ax_outline* out, ax_error* error);
void ax_outline_free(ax_outline* outline);

// The curve of this name, the first if several have it; with NULL or "", the closed one with the largest area, or the longest open
// one if `closed` is false. Only curves that are `closed` or not as asked. -1 if there is none.
int ax_outline_find(const ax_outline* outline, const char* name, bool closed);
