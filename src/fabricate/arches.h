// Supports inside the shell that follow each other: arches.
#pragma once

#include "ax/design.h"

// Arch k is hinges[start[k] .. start[k + 1]), in order; single supports are arches of one. A hinge where arches meet belongs to each.
typedef struct ax_arches {
    int count, hinge_count;
    int *start, *hinges;
    bool* closed;
} ax_arches;

// Supports that panels join one after the other, going on straight, the longest arches first; each ends with the support on the rim that
// it leads to. `held`: triangles of each hinge, -1 on the rim.
ax_arches ax_arches_find(const ax_design* design, const int (*held)[2]);
void ax_arches_free(ax_arches* arches);
