// What ax_topology_make and all that follows rely on, for meshes that were not just made a surface.
#pragma once

#include "ax/mesh.h"

// True if all indices are in range and the faces form an oriented manifold with a rim: no directed edge twice, no rim vertex
// where two sheets touch. `face` names a face at fault. Linear time.
bool ax_mesh_is_manifold(const ax_mesh* mesh, int* face);
