// Where a fresh sheet stands: over its own place, or by what holds its rim if that is elsewhere or leans.
#include "form/state.h"

#include "base/vec.h"
#include "constraint/eigen3.h"

#include <math.h>
#include <string.h>

enum { SAMPLES = 60 };               // of a curve
static const double elsewhere = 0.5; // of the sheet's radius: what is nearer draws the rim to it

// What holds the rim, as points in space, and where the hinges that it holds are in the flat state.
typedef struct footing {
    int count, hinges;
    double (*points)[3], *weight, middle[3], from[2], now[3]; // now: of these hinges in the deployed state
    double area[3]; // twice that of the closed curves, as a vector: they run round it counter-clockwise
} footing;

static void put(footing* g, const double x[3], double weight)
{
    memcpy(g->points[g->count], x, sizeof *g->points);
    g->weight[g->count++] = weight;
}

static void put_curve(footing* g, const ax_curve* curve, const double near[3], int hinges)
{
    ax_curve_range range = ax_curve_extent(curve);
    double x[SAMPLES][3], turn[3];
    if (!isfinite(range.to)) { // a line goes on for ever: it holds beside the sheet
        ax_curve_nearest(curve, near, x[0]);
        put(g, x[0], hinges);
        return;
    }
    double whole = ax_curve_length(curve, range.to);
    for (int k = 0; k < SAMPLES; ++k) {
        ax_curve_point(curve, ax_curve_at_length(curve, whole * (k + 0.5) / SAMPLES), x[k]);
        put(g, x[k], (double)hinges / SAMPLES);
    }
    for (int k = 0; k < SAMPLES && range.closed; ++k) {
        ax_cross(x[k], x[(k + 1) % SAMPLES], turn);
        for (int c = 0; c < 3; ++c)
            g->area[c] += turn[c];
    }
}

static footing find_footing(const ax_form* f)
{
    footing g = {0};
    int room = 0;
    for (int k = 0; k < f->rim_count; ++k)
        room += f->rim[k].count + SAMPLES;
    g.points = ax_alloc((size_t)room + 1, sizeof *g.points);
    g.weight = AX_NEW(double, room + 1);
    for (int k = 0; k < f->rim_count; ++k) {
        const ax_rim_part* part = f->rim + k;
        if (part->kind == AX_RIM_FREE || part->count == 0)
            continue;
        double near[3] = {0, 0, 0};
        for (int i = 0; i < part->count; ++i)
            for (int c = 0; c < 3; ++c) {
                if (c < 2)
                    near[c] += f->flat[part->hinges[i]][c] / part->count;
                g.now[c] += f->deployed[part->hinges[i]][c];
            }
        g.hinges += part->count;
        for (int c = 0; c < 2; ++c)
            g.from[c] += near[c] * part->count;
        for (int i = 0; i < part->count && part->kind == AX_RIM_FIXED; ++i)
            put(&g, part->places[i], 1);
        if (part->kind == AX_RIM_SLIDE) {
            ax_curve* curve = ax_curve_of_shape(&part->curve);
            put_curve(&g, curve, near, part->count);
            ax_curve_free(curve);
        }
    }
    for (int c = 0; c < 3 && g.hinges; ++c) {
        for (int k = 0; k < g.count; ++k)
            g.middle[c] += g.weight[k] * g.points[k][c] / g.hinges;
        g.now[c] /= g.hinges;
    }
    for (int c = 0; c < 2 && g.hinges; ++c)
        g.from[c] /= g.hinges;
    return g;
}

static void forget(footing* g)
{
    ax_free(g->points);
    ax_free(g->weight);
}

// Normal of the plane that fits the points, upwards; where it stands upright, so that curves run round it. Up where they fix no plane.
static void find_normal(const footing* g, double normal[3])
{
    ax_lane3 *y = ax_alloc_aligned((size_t)g->count, sizeof *y), axis[3];
    memset(y, 0, (size_t)g->count * sizeof *y);
    for (int k = 0; k < g->count; ++k)
        for (int c = 0; c < 3; ++c)
            y[k][c][0] = sqrt(g->weight[k]) * (g->points[k][c] - g->middle[c]);
    ax_principal_axes(g->count, (const ax_lane3*)y, axis);
    double along[2] = {0, 0};
    for (int k = 0; k < g->count; ++k)
        for (int a = 0; a < 2; ++a) {
            double d = 0;
            for (int c = 0; c < 3; ++c)
                d += axis[a][c][0] * y[k][c][0];
            along[a] += d * d;
        }
    ax_free(y);
    for (int c = 0; c < 3; ++c)
        normal[c] = axis[2][c][0];
    if (along[1] < 1e-2 * along[0])
        memcpy(normal, (const double[3]){0, 0, 1}, 3 * sizeof *normal);
    bool upright = fabs(normal[2]) < 0.2;
    double side = upright && ax_dot3(g->area, g->area) > 0 ? ax_dot3(g->area, normal) : normal[2];
    for (int c = 0; c < 3 && side < 0; ++c)
        normal[c] = -normal[c];
}

void ax_form_stand_on(const ax_form* f, ax_form_stand* stand)
{
    *stand = (ax_form_stand){.axis = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}};
    footing g = find_footing(f);
    double n[3] = {0, 0, 1}, off[3] = {g.middle[0] - g.from[0], g.middle[1] - g.from[1], g.middle[2]};
    if (g.hinges)
        find_normal(&g, n);
    if (ax_norm3(off) > elsewhere * f->radius || n[2] < sqrt(0.5)) {
        memcpy(stand->from, g.from, sizeof stand->from);
        memcpy(stand->to, g.middle, sizeof stand->to);
        double k = 1 / (1 + n[2]); // the shortest turn that takes z to n
        const double turn[3][3] = {{1 - n[0] * n[0] * k, -n[0] * n[1] * k, -n[0]},
                                   {-n[0] * n[1] * k, 1 - n[1] * n[1] * k, -n[1]},
                                   {n[0], n[1], n[2]}};
        // and a turn about n, to places that are given hinge by hinge
        double re = 0, im = 0;
        for (int p = 0; p < f->rim_count; ++p)
            for (int i = 0; i < f->rim[p].count && f->rim[p].kind == AX_RIM_FIXED; ++i) {
                const double* z = f->flat[f->rim[p].hinges[i]];
                double d[3], a[2] = {z[0] - g.from[0], z[1] - g.from[1]};
                ax_sub3(f->rim[p].places[i], g.middle, d);
                double b[2] = {ax_dot3(d, turn[0]), ax_dot3(d, turn[1])};
                re += a[0] * b[0] + a[1] * b[1], im += a[0] * b[1] - a[1] * b[0];
            }
        double length = hypot(re, im), cosine = length > 0 ? re / length : 1, sine = length > 0 ? im / length : 0;
        for (int c = 0; c < 3; ++c) {
            stand->axis[0][c] = cosine * turn[0][c] + sine * turn[1][c];
            stand->axis[1][c] = cosine * turn[1][c] - sine * turn[0][c];
            stand->axis[2][c] = turn[2][c];
        }
    }
    forget(&g);
}

double ax_form_rim_area(const ax_form* f)
{
    int rim = 0, held = 0;
    for (int h = 0; h < f->lattice.linkage.hinge_count; ++h)
        rim += f->lattice.linkage.on_rim[h];
    bool closed = f->rim_count == 1 && f->rim[0].kind == AX_RIM_SLIDE;
    held = closed ? f->rim[0].count : 0;
    if (held < rim)
        return 0;
    footing g = find_footing(f);
    double area = 0.5 * ax_norm3(g.area);
    forget(&g);
    return area;
}

double ax_form_open_area(const ax_form* f, double scale)
{
    double area = 0;
    for (int t = 0; t < f->lattice.linkage.triangle_count; ++t) {
        double lambda = scale > 0 ? scale : f->prescribed[t];
        area += lambda * lambda * f->lattice.spacing * f->lattice.spacing * sqrt(3) / 4;
    }
    return area;
}

bool ax_form_stands_elsewhere(const ax_form* f)
{
    footing g = find_footing(f);
    bool is = g.hinges && ax_distance3(g.middle, g.now) > elsewhere * f->radius;
    forget(&g);
    return is;
}
