// The linkage: rigid triangles joined at shared corners in the trihexagonal (kagome) pattern. Connectivity only.
#pragma once

#include "ax/base.h"
#include "ax/mesh.h"

typedef struct ax_linkage {
    int triangle_count, hinge_count;
    int (*triangles)[3]; // hinges, counter-clockwise in the flat state
    // Stable panel identity: the triangle's place in the lattice, (column, row, 0 up / 1 down). It does not change when the
    // design is solved again or its rim is edited.
    int (*panels)[3];
    // Holes are closed loops of hinges, counter-clockwise in the flat state; openings are the partial holes on the rim,
    // in order, first and last hinge on the rim. CSR: loop k is hinges[start[k] .. start[k + 1]).
    int hole_count, opening_count;
    int *hole_start, *hole_hinges;
    int *opening_start, *opening_hinges;
    unsigned char* on_rim; // per hinge: 1 where only one triangle holds it
} ax_linkage;

void ax_linkage_free(ax_linkage* linkage);
ax_linkage ax_linkage_copy(const ax_linkage* linkage);

// For linkages that come from outside: AX_BAD_INPUT, with the place, unless all indices are in range, every hinge is held by one
// (then it is on the rim) or two triangles, and every edge of a triangle, turned round, lies on exactly one hole or opening.
ax_status ax_linkage_check(const ax_linkage* linkage, ax_error* error);

// Rim hinges in their order round the shell, along each opening from its first to its last hinge; `order` holds hinge_count. Returns
// their number.
int ax_linkage_rim(const ax_linkage* linkage, int* order);

// The linkage as one surface over `hinges`, hinge_count points: its panels, then each hole k as a fan about a vertex hinge_count + k in
// the middle of its hinges, then what is open along the rim as fans from the first hinge of each opening. The caller frees it.
ax_mesh ax_linkage_cover(const ax_linkage* linkage, const double (*hinges)[3]);

// Largest magnitude of a panel's column and row, so that its name fits.
#define AX_PANEL_LIMIT 10000000

// Short name of a panel for people, e.g. "C14": row letters, then the place within the row, each with a minus before the
// lattice's origin ("-B-3"). Unique, and stable like the panel itself. `text` holds at least 16 characters.
void ax_panel_name(const ax_linkage* linkage, int triangle, char text[16]);
