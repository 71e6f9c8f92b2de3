#include "input/outline.h"

#include "base/vec.h"
#include "input/bytes.h"
#include "input/drawing.h"

#include <math.h>
#include <string.h>

enum { most_bytes = 64000000 };

static bool is_markup(const char* bytes)
{
    if (memcmp(bytes, "\xef\xbb\xbf", strnlen(bytes, 3)) == 0) // a byte order mark
        bytes += strnlen(bytes, 3);
    return bytes[strspn(bytes, " \t\r\n")] == '<';
}

static ax_pen draw(const char* path, const char* bytes, size_t size, double unit, double tolerance, ax_error* error)
{
    ax_pen pen = ax_pen_make(path, tolerance, error);
    (is_markup(bytes) ? ax_svg_draw : ax_dxf_draw)(&pen, bytes, size, unit);
    return pen;
}

ax_status ax_outline_parse(const char* path, const char* bytes, size_t size, double unit, double tolerance,
                           ax_outline* out, ax_error* error)
{
    *out = (ax_outline){0};
    double lo[2], hi[2];
    if (!(tolerance > 0)) { // a coarse look tells the size
        ax_pen look = draw(path, bytes, size, unit, INFINITY, error);
        if (look.status == AX_OK && ax_pen_bounds(&look, lo, hi))
            tolerance = 1e-4 * ax_distance2(lo, hi);
        ax_pen_free(&look);
        if (look.status != AX_OK)
            return look.status;
    }
    if (tolerance > 0) {
        ax_pen pen = draw(path, bytes, size, unit, tolerance, error);
        if (pen.status == AX_OK)
            *out = ax_pen_finish(&pen);
        ax_pen_free(&pen);
        if (pen.status != AX_OK)
            return pen.status;
    }
    if (out->count)
        return AX_OK;
    ax_outline_free(out);
    return ax_fail(error, AX_BAD_INPUT,
                   "%s has no curve. Blocks, uses and texts do not count: explode them, or convert them to paths.",
                   path);
}

ax_status ax_outline_read(const char* path, double unit, double tolerance, ax_outline* out, ax_error* error)
{
    *out = (ax_outline){0};
    char* bytes;
    size_t size;
    ax_status status = ax_bytes_read(path, "a drawing", most_bytes, &bytes, &size, error);
    if (status == AX_OK)
        status = ax_outline_parse(path, bytes, size, unit, tolerance, out, error);
    ax_free(bytes);
    return status;
}

// Area within a closed curve, length of an open one.
static double size_of(const ax_outline_curve* curve)
{
    double area = 0, length = 0;
    for (int k = 0; k < curve->count; ++k) {
        const double *a = curve->points[k], *b = curve->points[(k + 1) % curve->count];
        area += ax_orient2(curve->points[0], a, b) / 2;
        length += k + 1 < curve->count ? ax_distance2(a, b) : 0;
    }
    return curve->closed ? fabs(area) : length;
}

int ax_outline_find(const ax_outline* outline, const char* name, bool closed)
{
    int found = -1;
    for (int c = 0; c < outline->count; ++c) {
        const ax_outline_curve* curve = outline->curves + c;
        if (curve->closed != closed)
            continue;
        if (name && *name) {
            if (strcmp(name, curve->name) == 0)
                return c;
        } else if (found < 0 || size_of(curve) > size_of(&outline->curves[found]))
            found = c;
    }
    return found;
}
