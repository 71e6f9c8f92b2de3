#include "export/writing.h"

#include "base/vec.h"

#include <assert.h>
#include <errno.h>
#include <math.h>
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

void ax_put_mm(FILE* out, double mm)
{
    assert(fabs(mm) < 1e12);
    long long units = llround(mm * 1e4), left = units < 0 ? -units : units;
    char text[24], *at = text + sizeof text;
    int decimals = 4;
    while (decimals && left % 10 == 0)
        left /= 10, --decimals;
    for (bool first = true; first || left || decimals >= 0; first = false) {
        if (decimals == 0 && !first)
            *--at = '.';
        *--at = (char)('0' + left % 10);
        left /= 10, --decimals;
    }
    if (units < 0)
        *--at = '-';
    fwrite(at, 1, (size_t)(text + sizeof text - at), out);
}
