// A small real design for tests of what comes after designing: export, documents, pictures.
#pragma once

#include "ax/design.h"

// About 100 triangles on a spherical cap of radius 1 m, deployed by inflation: every state and force is there. Takes 20 ms.
ax_design sample_design(void);
