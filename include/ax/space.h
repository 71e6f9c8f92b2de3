// The room under a shell: how much there is of it, and over how much of the floor people stand upright.
#pragma once

#include "ax/design.h"
#include "ax/export.h"

// Lengths, areas and volumes in the document's unit. Holes and the openings at the rim count as closed, by triangles to their middles:
// by a membrane or by glass.
typedef struct ax_space {
    double ground;        // height of the ground
    double floor;         // area of the horizontal section at the ground
    double volume;        // between ground and shell
    double height;        // of the shell's highest place over the ground
    double headroom;      // the clear height that was asked for
    double headroom_area; // of the section at that height: of the floor that has so much clear height
    double surface;       // area of the shell itself, holes included
} ax_space;

// Sections and volume are exact for the faceted shell, whose parts that look down count against those above them (divergence
// theorem), so that overhanging walls are right. Heights are those of z. `ground` NaN: the lowest support; `headroom` >= 0.
// AX_BAD_INPUT when the state is missing, or when it hangs below the ground and covers nothing.
ax_status ax_space_measure(const ax_design* design, ax_state state, double ground, double headroom, ax_space* out,
                           ax_error* error);
