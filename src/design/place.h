// Places of a design in words.
#pragma once

#include "ax/design.h"

// "panel AB12 at (0.5, -1, 2.25)": its name and where its centroid is in the deployed state. Returns `text`.
const char* ax_design_name_place(const ax_design* design, int triangle, char text[96]);
