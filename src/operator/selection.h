// Sets of hinges by their place in the linkage and on the sheet.
#pragma once

#include "operator/operator.h"

// Hinges in order, each once.
typedef struct ax_hinges {
    int count;
    int* hinges;       // room for all; owned
    unsigned char* in; // per hinge of the linkage; owned
} ax_hinges;
ax_hinges ax_hinges_make(const ax_linkage* linkage);
void ax_hinges_free(ax_hinges* set);
void ax_hinges_add(ax_hinges* set, int hinge);

// The middle of the hinges' extents on the sheet.
void ax_sheet_middle(const ax_form_view* view, double middle[2]);
double ax_angle_about(const double middle[2], const double x[2]); // degrees, 0 to 360
// The rim counter-clockwise on the sheet, from the hinge at the smallest angle from 0 about the sheet's middle.
void ax_select_rim(const ax_form_view* view, ax_hinges* set);
// The kagome line through two hinges, from rim to rim; false if no line runs through both.
bool ax_select_line(const ax_linkage* linkage, int a, int b, ax_hinges* set);
// The shortest way along panel edges from hinge a to b, on the sheet close to the straight line.
void ax_select_curve(const ax_form_view* view, int a, int b, ax_hinges* set);
// Hinges on the sheet within a box, bounds included.
void ax_select_box(const ax_form_view* view, const double lo[2], const double hi[2], ax_hinges* set);
// Hinges on the sheet within a distance of a polyline (or point), closed or not.
void ax_select_near(const ax_form_view* view, int count, const double (*points)[2], bool closed, double distance,
                    ax_hinges* set);

// Corners of the outline that the sheet was laid over, or of the rim if it was over none: in the rim's order, counter-clockwise from the one at
// the smallest angle from 0 about the sheet's middle. The same at every number of panels and angle of the lattice. `rim` is in the order of
// ax_select_rim. Their number; 0 if there are fewer than two, more than AX_CORNERS_MOST, or fewer hinges than they need.
enum { AX_CORNERS_MOST = 12 };
typedef struct ax_corner {
    int place;    // in `rim`, of the nearest hinge
    double at[2]; // on the sheet; of a rounded corner the middle of its arc
} ax_corner;
int ax_select_corners(const ax_form_view* view, int count, const int* rim, ax_corner corners[AX_CORNERS_MOST]);

// Of these hinges those within a distance of a point of the sheet, in their order; of none the nearest, with all that are as near.
void ax_select_nearest(const ax_form_view* view, const ax_hinges* among, const double at[2], double distance,
                       ax_hinges* set);

// Names that users give to selections and constraints: 1 to 48 letters, digits, "-", "_" or ".", the first a letter.
bool ax_is_name(const char* text);
extern const char ax_no_name[]; // the sentence that says so
