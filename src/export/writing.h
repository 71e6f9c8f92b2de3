// What exporters share: a state as points in space, and a file that is written once from start to end.
#pragma once

#include "ax/export.h"

#include <stdio.h>

// Hinges of a state, hinge_count points, owned by the caller. The flat state lies in the plane z = 0.
double (*ax_state_places(const ax_design* design, ax_state state))[3];

// Unit normal of a panel, on the side from which its corners run counter-clockwise; zero if it has no area.
void ax_panel_normal(const double (*places)[3], const int triangle[3], double normal[3]);

// "Auxshell 0.1.0, deployed state, lengths in m": what a file says of itself where its format has a comment.
void ax_export_remark(const ax_design* design, ax_state state, char text[80]);

FILE* ax_export_open(const char* path, ax_error* error); // NULL on failure
// Closes; AX_FAILED if any write since opening has failed.
ax_status ax_export_close(FILE* out, const char* path, ax_error* error);

// Writes millimetres to a tenth of a micrometre, without trailing zeros and whatever the locale: cut files hold millions of numbers,
// which printf would take most of the time for. |mm| < 1e12.
void ax_put_mm(FILE* out, double mm);
