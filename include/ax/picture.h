// Pictures of surfaces and linkages as PNG, drawn without a display.
#pragma once

#include "ax/design.h"
#include "ax/export.h"
#include "ax/shade.h"

// A picture of one state of a design. Flat: seen from above with a scale bar; deployed (the default) and simulated: in perspective
// over a ground with a grid. Panels are coloured by lambda on the fixed scale 1 to 2, simulated ones by their edges' axial forces. z
// is up. width, height in pixels, 64 to 8192 (else AX_USAGE). AX_BAD_INPUT when the state is missing; AX_FAILED when the file
// cannot be written.
ax_status ax_picture_design(const ax_design* design, ax_state state, int width, int height, const char* path,
                            ax_error* error);

// Pictures of a motion, one for each frame, all from where the whole of it is seen; without title and legend. A frame holds a place for
// every hinge. `pattern` takes the frame's number, from 0: "frames/%03d.png".
ax_status ax_picture_motion(const ax_design* design, int frame_count, double (*const* frames)[3], int width, int height,
                            const char* pattern, ax_error* error);

typedef enum ax_screen_field { AX_SCREEN_CURVATURE, AX_SCREEN_SCALE } ax_screen_field;
// A picture of a screened target surface coloured by mean curvature (blue and hatched: H <= 0, orange: H > 0) or by lambda (hatched
// outside 1 to 2), with legend. AX_BAD_INPUT when lambda is asked of a surface that was not flattened.
ax_status ax_picture_screen(const ax_mesh* mesh, const ax_screen* screen, ax_screen_field field, int width, int height,
                            const char* path, ax_error* error);

// A map of the shade on the ground, as ax_shade_map makes it, with the rims of the layers in plan, discs with the mean opacity in them,
// and north. `text` stands beside the title.
typedef struct ax_shade_picture {
    int layer_count;
    const ax_layer* layers;
    const ax_ground* ground;
    const double* opacity;
    int wish_count;
    const ax_shade_wish* wishes;
    double north; // as in ax_sun_ray
    const char* text;
} ax_shade_picture;
ax_status ax_picture_shade(const ax_shade_picture* shade, int width, int height, const char* path, ax_error* error);
