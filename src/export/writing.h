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

// Text on its way to a file, or kept if `out` is NULL: cut files hold millions of numbers, for which printf, and a lock for every
// character, would take most of the time. Begins as {.out = file} or {0}.
typedef struct ax_writer {
    FILE* out;
    char* at;
    size_t count, room;
} ax_writer;
void ax_put_words(ax_writer* w, const char* words);
void ax_put_format(ax_writer* w, const char* format, ...) __attribute__((format(printf, 2, 3)));
void ax_put_whole(ax_writer* w, long long value);
// As "%.*f" in the C locale, but for ties, digits after the 15th and "-0"; at most 9 decimals, |value| 10^decimals < 1e18.
void ax_put_fixed(ax_writer* w, double value, int decimals);
// Millimetres to a tenth of a micrometre, without trailing zeros. |mm| < 1e12.
void ax_put_mm(ax_writer* w, double mm);
void ax_writer_free(ax_writer* w); // of what is kept
// Writes what is left, frees and closes; AX_FAILED if any write since opening has failed.
ax_status ax_writer_close(ax_writer* w, const char* path, ax_error* error);
