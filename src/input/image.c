#include "input/image.h"

#include "base/vec.h"
#include "input/bytes.h"

#include <assert.h>
#include <png.h>
#include <stdio.h>
#include <string.h>

enum { most_bytes = 256000000, most_pixels = 25000000 };

typedef struct reader {
    const char* path;
    const unsigned char* bytes;
    size_t size, used;
    ax_image* image;
    png_bytep rows;      // the whole image, 16 bits a channel
    png_bytepp pointers; // to each row
    char what[128];      // libpng's words on a fault
} reader;

static void take_bytes(png_structp png, png_bytep into, size_t count)
{
    reader* r = png_get_io_ptr(png);
    if (count > r->size - r->used)
        png_error(png, "the file breaks off");
    memcpy(into, r->bytes + r->used, count);
    r->used += count;
}

static _Noreturn void on_error(png_structp png, png_const_charp what)
{
    reader* r = png_get_error_ptr(png);
    snprintf(r->what, sizeof r->what, "%s", what);
    png_longjmp(png, 1);
}

static void on_warning(png_structp png, png_const_charp what)
{
    (void)png, (void)what;
}

// White shows through what is transparent.
static uint16_t grey_of(const png_byte* pixel, int channels)
{
    double value[4];
    for (int k = 0; k < channels; ++k)
        value[k] = pixel[2 * k] * 256 + pixel[2 * k + 1];
    double grey = channels < 3 ? value[0] : 0.2126 * value[0] + 0.7152 * value[1] + 0.0722 * value[2];
    double opaque = channels % 2 ? 1 : value[channels - 1] / 65535;
    return (uint16_t)(opaque * grey + (1 - opaque) * 65535 + 0.5);
}

// libpng leaves by longjmp, so what it may leave behind is in `r`.
static bool decode(png_structp png, png_infop info, reader* r)
{
    if (setjmp(png_jmpbuf(png)))
        return false;
    png_set_read_fn(png, r, take_bytes);
    png_set_user_limits(png, 1000000, 1000000);
    png_set_chunk_malloc_max(png, 16000000);
    png_read_info(png, info);
    size_t width = png_get_image_width(png, info), height = png_get_image_height(png, info);
    if (width * height > most_pixels)
        png_error(png, "it has more than 25 million pixels");
    png_set_expand_16(png); // palettes, few bits and transparent colours too
    png_set_interlace_handling(png);
    png_read_update_info(png, info);
    size_t row = png_get_rowbytes(png, info);
    int channels = png_get_channels(png, info);
    r->rows = ax_alloc(height, row);
    r->pointers = AX_NEW(png_bytep, height);
    for (size_t y = 0; y < height; ++y)
        r->pointers[y] = r->rows + y * row;
    png_read_image(png, r->pointers);
    png_read_end(png, NULL);
    *r->image = (ax_image){(int)width, (int)height, AX_NEW(uint16_t, width * height)};
    for (size_t k = 0; k < width * height; ++k)
        r->image->grey[k] = grey_of(r->rows + k * 2 * (size_t)channels, channels);
    return true;
}

ax_status ax_image_parse(const char* path, const void* bytes, size_t size, ax_image* out, ax_error* error)
{
    *out = (ax_image){0};
    if (size < 8 || png_sig_cmp(bytes, 0, 8) != 0)
        return ax_fail(error, AX_BAD_INPUT, "%s is not a PNG image. Save it as PNG.", path);
    reader r = {.path = path, .bytes = bytes, .size = size, .image = out};
    png_structp png = png_create_read_struct(PNG_LIBPNG_VER_STRING, &r, on_error, on_warning);
    png_infop info = png ? png_create_info_struct(png) : NULL;
    bool read = info && decode(png, info, &r);
    png_destroy_read_struct(&png, &info, NULL);
    ax_free(r.rows);
    ax_free(r.pointers);
    return read ? AX_OK
                : ax_fail(error, AX_BAD_INPUT, "%s cannot be read as PNG: %s. Save it again.", path,
                          *r.what ? r.what : "libpng does not start");
}

ax_status ax_image_read(const char* path, ax_image* out, ax_error* error)
{
    *out = (ax_image){0};
    char* bytes;
    size_t size;
    ax_status status = ax_bytes_read(path, "an image", most_bytes, &bytes, &size, error);
    if (status == AX_OK)
        status = ax_image_parse(path, bytes, size, out, error);
    ax_free(bytes);
    return status;
}

void ax_image_free(ax_image* image)
{
    ax_free(image->grey);
    *image = (ax_image){0};
}

double ax_image_at(const ax_image* image, const double lo[2], const double hi[2], const double x[2])
{
    assert(lo[0] < hi[0] && lo[1] < hi[1]);
    double column = ax_clamp((x[0] - lo[0]) / (hi[0] - lo[0]) * image->width - 0.5, 0, image->width - 1);
    double row = ax_clamp((hi[1] - x[1]) / (hi[1] - lo[1]) * image->height - 0.5, 0, image->height - 1);
    int left = (int)column, top = (int)row;
    int right = left + (left + 1 < image->width), bottom = top + (top + 1 < image->height);
    const uint16_t* above = image->grey + (size_t)top * (size_t)image->width;
    const uint16_t* below = image->grey + (size_t)bottom * (size_t)image->width;
    double s = column - left, t = row - top;
    return ((1 - t) * ((1 - s) * above[left] + s * above[right]) + t * ((1 - s) * below[left] + s * below[right])) /
           65535;
}
