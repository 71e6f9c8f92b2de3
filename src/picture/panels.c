#include "picture/panels.h"

#include "base/vec.h"

#include <string.h>

// Over the mean triangle edge. The tips cut off are shorter than a joint's radius, so that a joint always touches its panels.
static const double thickness = 0.11, inset = 0.015, bevel = 0.022, tip = 0.064, joint_radius = 0.07,
                    joint_height = 0.12;
// Sides and undersides are darker, so that a lattice of panels reads as one surface seen from its front.
static const double side_gain = 0.62, under_gain = 0.55;
static const double joint_rgb[3] = {0x3a / 255.0, 0x3f / 255.0, 0x48 / 255.0};

enum { JOINT_SIDES = 16, MOST_CORNERS = 12 };

// Points of a panel's plane are written in its barycentric coordinates: the distance to edge k is coordinate k times the
// altitude over it, so insets, clipped corners and strips along edges are all half-planes without further geometry.
typedef struct polygon {
    int count;
    double at[MOST_CORNERS][3];
} polygon;

typedef struct panel {
    double corner[3][3], normal[3], altitude[3];
} panel;

static panel make_panel(const int hinges[3], const double (*places)[3], int front)
{
    panel p;
    for (int k = 0; k < 3; ++k)
        memcpy(p.corner[k], places[hinges[front > 0 ? k : (3 - k) % 3]], sizeof p.corner[k]);
    double a[3], b[3];
    ax_sub3(p.corner[1], p.corner[0], a);
    ax_sub3(p.corner[2], p.corner[0], b);
    ax_cross(a, b, p.normal);
    double area = ax_norm3(p.normal);
    for (int k = 0; k < 3; ++k) {
        p.normal[k] = area > 0 ? p.normal[k] / area : k == 2;
        p.altitude[k] = area / fmax(ax_distance3(p.corner[(k + 1) % 3], p.corner[(k + 2) % 3]), 1e-30);
    }
    return p;
}

// The panel less a margin along its edges and less its corners, cut off at a distance from their tips: a hexagon, two of whose
// points coincide where the margins alone reach further than the cut.
static polygon outline(const panel* p, double margin, double corner)
{
    polygon out = {.count = 6};
    double in[3];
    for (int k = 0; k < 3; ++k)
        in[k] = fmin(margin / fmax(p->altitude[k], 1e-30), 0.3);
    for (int k = 0; k < 3; ++k) {
        int next = (k + 1) % 3, previous = (k + 2) % 3;
        double cut_off = fmax(fmin(corner / fmax(p->altitude[k], 1e-30), 0.3), in[next] + in[previous]);
        double *first = out.at[2 * k], *second = out.at[2 * k + 1];
        first[k] = second[k] = 1 - cut_off;
        first[next] = in[next], first[previous] = cut_off - in[next];
        second[previous] = in[previous], second[next] = cut_off - in[previous];
    }
    return out;
}

// The part of a convex polygon where the dot product with `half` is not negative.
static polygon cut(const polygon* from, const double half[3])
{
    polygon out = {0};
    for (int k = 0; k < from->count; ++k) {
        const double *a = from->at[k], *b = from->at[(k + 1) % from->count];
        double at_a = ax_dot3(half, a), at_b = ax_dot3(half, b);
        if (at_a >= 0 && out.count < MOST_CORNERS)
            memcpy(out.at[out.count++], a, sizeof *out.at);
        if ((at_a < 0) != (at_b < 0) && out.count < MOST_CORNERS) {
            for (int c = 0; c < 3; ++c)
                out.at[out.count][c] = a[c] + (b[c] - a[c]) * at_a / (at_a - at_b);
            ++out.count;
        }
    }
    return out;
}

// Adds the corners of a polygon raised by `height` above the panel's plane; returns the first.
static int add_corners(ax_scene* scene, const panel* p, const polygon* shape, double height)
{
    int first = scene->vertex_count;
    for (int k = 0; k < shape->count; ++k) {
        double place[3];
        for (int c = 0; c < 3; ++c)
            place[c] = shape->at[k][0] * p->corner[0][c] + shape->at[k][1] * p->corner[1][c] +
                       shape->at[k][2] * p->corner[2][c] + height * p->normal[c];
        ax_scene_add_vertex(scene, place);
    }
    return first;
}

static void add_fan(ax_scene* scene, int first, int count, bool upward, int paint)
{
    for (int k = 1; k + 1 < count; ++k)
        ax_scene_add_face(scene, first, first + (upward ? k : k + 1), first + (upward ? k + 1 : k), paint);
}

// Between two rings of the same number of corners, `lower` below `upper`.
static void add_band(ax_scene* scene, int lower, int upper, int count, int paint)
{
    for (int k = 0; k < count; ++k) {
        int next = (k + 1) % count;
        ax_scene_add_face(scene, lower + k, lower + next, upper + next, paint);
        ax_scene_add_face(scene, lower + k, upper + next, upper + k, paint);
    }
}

// Forces along the edges of panel t, in the order of its corners as seen from the front.
static void forces_of(const ax_panels_look* look, int t, double force[3])
{
    for (int k = 0; k < 3; ++k)
        force[k] = look->edge_forces[t][look->front > 0 ? k : (3 - k) % 3];
}

static double strongest(const double force[3])
{
    double f = force[0];
    for (int k = 1; k < 3; ++k)
        f = fabs(force[k]) > fabs(f) ? force[k] : f;
    return f;
}

// A bar along each edge, as wide as its force is large, tiles the top together with what is left in the middle.
static void add_bars(ax_scene* scene, const panel* p, const polygon* top, double height, double edge,
                     const double force[3], const ax_palette* palette, int middle_paint)
{
    double width[3]; // in the coordinate of each edge
    for (int k = 0; k < 3; ++k) {
        double share = fmin(fabs(force[k]) / palette->limit, 1);
        width[k] = fmin(((0.05 + 0.09 * share) * edge + inset * edge) / fmax(p->altitude[k], 1e-30), 0.32);
    }
    polygon middle = *top;
    for (int k = 0; k < 3; ++k) {
        int next = (k + 1) % 3, previous = (k + 2) % 3;
        double beside[3] = {-width[k], -width[k], -width[k]}, within[3] = {width[k], width[k], width[k]};
        beside[k] += 1, within[k] -= 1; // coordinates sum to 1: these compare coordinate k with the width
        middle = cut(&middle, beside);
        polygon bar = cut(top, within);
        for (int end = 0; end < 2; ++end) { // mitred with its neighbours
            double mitre[3] = {0};
            int other = end ? previous : next;
            mitre[other] = width[k], mitre[k] = -width[other];
            bar = cut(&bar, mitre);
        }
        double rgb[3];
        ax_palette_colour(palette, force[k], rgb);
        int paint = ax_scene_add_paint(scene, rgb, 1);
        scene->paints[paint].hatched = ax_palette_hatched(palette, force[k]);
        add_fan(scene, add_corners(scene, p, &bar, height), bar.count, true, paint);
    }
    add_fan(scene, add_corners(scene, p, &middle, height), middle.count, true, middle_paint);
}

static void add_joint(ax_scene* scene, const double place[3], const double axis[3], double edge, int paint)
{
    double across[3], along[3], aside[3] = {0};
    int least = fabs(axis[0]) < fabs(axis[1]) ? 0 : 1;
    least = fabs(axis[2]) < fabs(axis[least]) ? 2 : least;
    aside[least] = 1;
    ax_cross(axis, aside, across);
    double length = ax_norm3(across);
    for (int c = 0; c < 3; ++c)
        across[c] /= length;
    ax_cross(axis, across, along);
    int ring[2];
    for (int level = 0; level < 2; ++level) {
        ring[level] = scene->vertex_count;
        for (int k = 0; k < JOINT_SIDES; ++k) {
            double angle = 2 * AX_PI * k / JOINT_SIDES, at[3];
            for (int c = 0; c < 3; ++c)
                at[c] = place[c] + edge * ((level - 0.5) * joint_height * axis[c] +
                                           joint_radius * (cos(angle) * across[c] + sin(angle) * along[c]));
            ax_scene_add_vertex(scene, at);
        }
    }
    add_band(scene, ring[0], ring[1], JOINT_SIDES, paint);
    add_fan(scene, ring[0], JOINT_SIDES, false, paint);
    add_fan(scene, ring[1], JOINT_SIDES, true, paint);
}

// How much of a panel is made, from its size in the picture.
typedef struct detail {
    bool outlined, solid, jointed, bevelled, bars;
    double edge; // mean of all panels
} detail;

// Adds a panel's top, whose corners are those from `first` on, and the outline around it.
static void add_top(ax_scene* scene, const panel* p, const polygon* face, int first, double height, const double rgb[3],
                    bool hatched, const detail* d, const double force[3], const ax_palette* palette)
{
    int paint = ax_scene_add_paint(scene, rgb, 1);
    scene->paints[paint].hatched = hatched;
    if (d->bars)
        add_bars(scene, p, face, height, d->edge, force, palette, paint);
    else
        add_fan(scene, first, face->count, true, paint);
    for (int k = paint; d->outlined && k < scene->paint_count; ++k)
        scene->paints[k].outline_first = first, scene->paints[k].outline_count = face->count;
}

static void add_panel(ax_scene* scene, const panel* p, const double force[3], double scale, const detail* d,
                      const ax_palette* palette)
{
    static const polygon whole = {3, {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}};
    double value = palette->kind == AX_PALETTE_FORCE ? strongest(force) : scale, rgb[3], flank[3];
    ax_palette_colour(palette, value, rgb);
    for (int c = 0; c < 3; ++c) { // under bars the panel itself is paler than they are
        flank[c] = d->bars ? 0.7 * rgb[c] + 0.3 * 0.93 : rgb[c];
        rgb[c] = d->bars ? 0.42 * rgb[c] + 0.58 * 0.93 : rgb[c];
    }
    bool hatched = !d->bars && ax_palette_hatched(palette, value);
    if (!d->solid) {
        add_top(scene, p, &whole, add_corners(scene, p, &whole, 0), 0, rgb, hatched, d, force, palette);
        return;
    }
    double half = thickness * d->edge / 2, round = d->bevelled ? bevel * d->edge : 0;
    double margin = d->jointed ? inset * d->edge : 0, corner = d->jointed ? tip * d->edge : 0;
    polygon body = outline(p, margin, corner), face = outline(p, margin + round, corner + round);
    int bottom = add_corners(scene, p, &body, -half), shoulder = add_corners(scene, p, &body, half - round);
    add_fan(scene, bottom, body.count, false, ax_scene_add_paint(scene, flank, under_gain));
    add_band(scene, bottom, shoulder, body.count, ax_scene_add_paint(scene, flank, side_gain));
    int top = shoulder;
    if (d->bevelled) {
        top = add_corners(scene, p, &face, half);
        add_band(scene, shoulder, top, face.count, ax_scene_add_paint(scene, flank, 1));
    }
    add_top(scene, p, &face, top, half, rgb, hatched, d, force, palette);
}

void ax_panels_add(ax_scene* scene, const ax_linkage* linkage, const double (*places)[3], double edge,
                   const ax_panels_look* look)
{
    bool forces = look->palette.kind == AX_PALETTE_FORCE;
    detail d = {
        .outlined = look->edge_pixels >= 2,
        .solid = look->edge_pixels >= 4,
        .jointed = look->edge_pixels >= 8,
        .bars = forces && look->edge_pixels >= 8,
        .bevelled = look->edge_pixels >= 20,
        .edge = edge,
    };
    scene->two_sided = !d.solid;
    double(*axis)[3] = ax_calloc((size_t)linkage->hinge_count, sizeof *axis);
    for (int t = 0; t < linkage->triangle_count; ++t) {
        panel p = make_panel(linkage->triangles[t], places, look->front);
        double force[3] = {0};
        if (forces)
            forces_of(look, t, force);
        add_panel(scene, &p, force, forces ? 0 : look->scale[t], &d, &look->palette);
        for (int k = 0; k < 3; ++k)
            for (int c = 0; c < 3; ++c)
                axis[linkage->triangles[t][k]][c] += p.normal[c];
    }
    int paint = d.jointed ? ax_scene_add_paint(scene, joint_rgb, 1) : 0;
    for (int h = 0; d.jointed && h < linkage->hinge_count; ++h) {
        double length = ax_norm3(axis[h]);
        for (int c = 0; c < 3; ++c)
            axis[h][c] = length > 0 ? axis[h][c] / length : c == 2;
        add_joint(scene, places[h], axis[h], edge, paint);
    }
    ax_free(axis);
}
