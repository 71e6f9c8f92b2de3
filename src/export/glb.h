// glTF 2.0, binary: one mesh, or a named node for each panel.
#pragma once

#include "ax/export.h"

// By panels: below the root a node for each row of the lattice ("row C"), in it a node with a mesh of its own for each panel ("C14"),
// mesh k being triangle k; else all triangles are one mesh. Both hold the same corners in the same order.
ax_status ax_glb_write(const ax_design* design, ax_state state, bool by_panels, const char* path, ax_error* error);
