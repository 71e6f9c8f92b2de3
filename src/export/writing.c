#include "export/writing.h"

#include "base/vec.h"

#include <assert.h>
#include <errno.h>
#include <math.h>
#include <stdarg.h>
#include <string.h>

double (*ax_state_places(const ax_design* design, ax_state state))[3]
{
    size_t count = (size_t)design->linkage.hinge_count;
    if (state != AX_STATE_FLAT)
        return ax_copy(state == AX_STATE_SIMULATED ? design->simulated : design->deployed, count, sizeof(double[3]));
    double(*places)[3] = ax_alloc(count, sizeof *places);
    for (size_t h = 0; h < count; ++h)
        places[h][0] = design->flat[h][0], places[h][1] = design->flat[h][1], places[h][2] = 0;
    return places;
}

void ax_panel_normal(const double (*places)[3], const int triangle[3], double normal[3])
{
    double a[3], b[3];
    ax_sub3(places[triangle[1]], places[triangle[0]], a);
    ax_sub3(places[triangle[2]], places[triangle[0]], b);
    ax_cross(a, b, normal);
    double length = ax_norm3(normal);
    for (int c = 0; c < 3; ++c)
        normal[c] = length > 0 ? normal[c] / length : 0;
}

void ax_export_remark(const ax_design* design, ax_state state, char text[80])
{
    snprintf(text, 80, "Auxshell %s, %s state, lengths in %s", ax_version(), ax_state_name(state),
             ax_unit_name(design->unit));
}

static ax_status fail_to_write(const char* path, ax_error* error)
{
    return ax_fail(error, AX_FAILED, "Cannot write %s: %s.", path,
                   errno ? strerror(errno) : "the disk did not take it");
}

FILE* ax_export_open(const char* path, ax_error* error)
{
    errno = 0;
    FILE* out = fopen(path, "wb");
    if (!out)
        fail_to_write(path, error);
    return out;
}

ax_status ax_export_close(FILE* out, const char* path, ax_error* error)
{
    bool sound = !ferror(out);
    sound = fclose(out) == 0 && sound;
    return sound ? AX_OK : fail_to_write(path, error);
}

// Room for `more` characters at w->at + w->count.
static char* reserve(ax_writer* w, size_t more)
{
    enum { ROOM = 1 << 16 };
    if (w->room - w->count < more && w->count && w->out) {
        fwrite(w->at, 1, w->count, w->out);
        w->count = 0;
    }
    if (w->room - w->count < more) {
        size_t twice = 2 * w->room > ROOM ? 2 * w->room : ROOM;
        w->room = twice > w->count + more ? twice : w->count + more;
        w->at = ax_realloc(w->at, w->room, 1);
    }
    return w->at + w->count;
}

static void add(ax_writer* w, const char* characters, size_t count)
{
    memcpy(reserve(w, count), characters, count);
    w->count += count;
}

void ax_put_words(ax_writer* w, const char* words)
{
    add(w, words, strlen(words));
}

void ax_put_format(ax_writer* w, const char* format, ...)
{
    char words[256];
    va_list arguments;
    va_start(arguments, format);
    int count = vsnprintf(words, sizeof words, format, arguments);
    va_end(arguments);
    assert(count >= 0 && count < (int)sizeof words);
    add(w, words, (size_t)count);
}

// A number of units, `decimals` of whose digits stand behind the point.
static void add_units(ax_writer* w, long long units, int decimals)
{
    char digits[32], *at = digits + sizeof digits;
    unsigned long long left = units < 0 ? 0 - (unsigned long long)units : (unsigned long long)units;
    for (int behind = decimals; behind > 0; --behind, left /= 10)
        *--at = (char)('0' + left % 10);
    if (decimals)
        *--at = '.';
    do
        *--at = (char)('0' + left % 10);
    while (left /= 10);
    if (units < 0)
        *--at = '-';
    add(w, at, (size_t)(digits + sizeof digits - at));
}

void ax_put_whole(ax_writer* w, long long value)
{
    add_units(w, value, 0);
}

static const double scales[] = {1, 1e1, 1e2, 1e3, 1e4, 1e5, 1e6, 1e7, 1e8, 1e9};

void ax_put_fixed(ax_writer* w, double value, int decimals)
{
    assert(decimals >= 0 && decimals < (int)(sizeof scales / sizeof *scales));
    assert(fabs(value) * scales[decimals] < 1e18);
    add_units(w, llround(value * scales[decimals]), decimals);
}

void ax_put_mm(ax_writer* w, double mm)
{
    assert(fabs(mm) < 1e12);
    long long units = llround(mm * 1e4);
    int decimals = 4;
    for (; decimals && units % 10 == 0; --decimals)
        units /= 10;
    add_units(w, units, decimals);
}

void ax_writer_free(ax_writer* w)
{
    ax_free(w->at);
    *w = (ax_writer){0};
}

ax_status ax_writer_close(ax_writer* w, const char* path, ax_error* error)
{
    FILE* out = w->out;
    fwrite(w->at, 1, w->count, out);
    ax_writer_free(w);
    return ax_export_close(out, path, error);
}
