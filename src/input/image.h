// Grey images: PNG of 8 or 16 bits (and fewer). Colours become grey by 0.2126 R + 0.7152 G + 0.0722 B of the values as stored,
// without regard to gamma, so that a height or scale map keeps its numbers; transparent parts show white.
#pragma once

#include "ax/base.h"

#include <stdint.h>

typedef struct ax_image {
    int width, height;
    uint16_t* grey; // rows from top to bottom; 0 black, 65535 white
} ax_image;

// At most 25 million pixels. AX_BAD_INPUT when the file is no PNG or damaged.
ax_status ax_image_read(const char* path, ax_image* out, ax_error* error);
// The same from memory; `path` is for messages.
ax_status ax_image_parse(const char* path, const void* bytes, size_t size, ax_image* out, ax_error* error);
void ax_image_free(ax_image* image);

// Grey, 0 to 1, at place x of the plane when the image is stretched over the box lo..hi, its top at hi[1]: bilinear between the centres
// of pixels, beyond them constant.
double ax_image_at(const ax_image* image, const double lo[2], const double hi[2], const double x[2]);
