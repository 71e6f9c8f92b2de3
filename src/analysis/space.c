#include "ax/space.h"

#include "base/vec.h"

#include <math.h>

typedef struct sums {
    double area, volume; // in plan, and over the level
} sums;

// Adds what of a triangle lies above a level: its signed area in plan, and the volume between it and the level.
static void add_above(const double* const corner[3], double level, sums* s)
{
    double polygon[4][3];
    int count = 0;
    for (int k = 0; k < 3; ++k) {
        const double *a = corner[k], *b = corner[(k + 1) % 3];
        double za = a[2] - level, zb = b[2] - level;
        if (za >= 0) {
            polygon[count][0] = a[0], polygon[count][1] = a[1], polygon[count][2] = za;
            ++count;
        }
        if ((za >= 0) != (zb >= 0)) {
            double t = za / (za - zb);
            polygon[count][0] = a[0] + t * (b[0] - a[0]), polygon[count][1] = a[1] + t * (b[1] - a[1]);
            polygon[count][2] = 0;
            ++count;
        }
    }
    for (int k = 2; k < count; ++k) {
        double area = 0.5 * ax_orient2(polygon[0], polygon[k - 1], polygon[k]);
        s->area += area;
        s->volume += area * (polygon[0][2] + polygon[k - 1][2] + polygon[k][2]) / 3;
    }
}

typedef struct shell {
    const double (*x)[3];
    double ground, level;
    sums at_ground, at_level;
    double surface;
} shell;

static void add_triangle(shell* s, const double* a, const double* b, const double* c)
{
    const double* const corner[3] = {a, b, c};
    double u[3], v[3], normal[3];
    add_above(corner, s->ground, &s->at_ground);
    add_above(corner, s->level, &s->at_level);
    ax_sub3(b, a, u);
    ax_sub3(c, a, v);
    ax_cross(u, v, normal);
    s->surface += 0.5 * ax_norm3(normal);
}

static double lowest_support(const ax_design* d, const double (*x)[3])
{
    double lowest = INFINITY;
    for (int h = 0; h < d->linkage.hinge_count; ++h)
        if (d->supports[h])
            lowest = fmin(lowest, x[h][2]);
    for (int h = 0; h < d->linkage.hinge_count && isinf(lowest); ++h)
        lowest = fmin(lowest, x[h][2]);
    return lowest;
}

ax_status ax_space_measure(const ax_design* d, ax_state state, double ground, double headroom, ax_space* out,
                           ax_error* error)
{
    const ax_linkage* l = &d->linkage;
    shell s = {.x = state == AX_STATE_SIMULATED ? d->simulated : d->deployed};
    if (state == AX_STATE_FLAT || !s.x)
        return ax_fail(error, AX_BAD_INPUT, "There is no such state in space. Deploy the design first.");
    s.ground = isnan(ground) ? lowest_support(d, s.x) : ground;
    s.level = s.ground + headroom;
    ax_mesh cover = ax_linkage_cover(l, s.x);
    for (int k = 0; k < cover.face_count; ++k) {
        const int* face = cover.faces[k];
        add_triangle(&s, cover.positions[face[0]], cover.positions[face[1]], cover.positions[face[2]]);
    }
    ax_mesh_free(&cover);
    double top = -INFINITY;
    for (int h = 0; h < l->hinge_count; ++h)
        top = fmax(top, s.x[h][2]);
    if (!(s.at_ground.volume > 1e-9 * pow(s.surface, 1.5))) // a rim in the ground is off by rounding
        return ax_fail(error, AX_BAD_INPUT,
                       "The shell covers nothing above the ground at height %.4g. Give a lower ground.", s.ground);
    *out = (ax_space){.ground = s.ground,
                      .floor = s.at_ground.area,
                      .volume = s.at_ground.volume,
                      .height = top - s.ground,
                      .headroom = headroom,
                      .headroom_area = fmax(s.at_level.area, 0),
                      .surface = s.surface};
    return AX_OK;
}
