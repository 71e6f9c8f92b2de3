// Pictures of surfaces and linkages as PNG, drawn without a display.
#pragma once

#include "ax/design.h"
#include "ax/export.h"

// A picture of one state of a design, panels coloured by lambda on the fixed scale 1 to 2. Flat: seen from above with a scale
// bar; deployed and simulated: in perspective with a ground shadow. width, height in pixels, 64 to 8192.
ax_status ax_picture_design(const ax_design* design, ax_state state, int width, int height, const char* path,
                            ax_error* error);

typedef enum ax_field { AX_FIELD_CURVATURE, AX_FIELD_SCALE } ax_field;
// A picture of a screened target surface coloured by mean curvature (blue: H <= 0, orange: H > 0) or by lambda, with legend.
ax_status ax_picture_screen(const ax_mesh* mesh, const ax_screen* screen, ax_field field, int width, int height,
                            const char* path, ax_error* error);
