// The deployed shell from four sides: panels from back to front, those that turn their backs pale.
#include "export/booklet.h"

#include "base/vec.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

typedef struct view {
    const char *section, *heading;
    double right[3], up[3], toward[3];
} view;

#define AXO_S 0.70710678118654752 // of 45 degrees
#define AXO_A 0.40824829046386302 // 1 / sqrt 6
#define AXO_B 0.81649658092772603
#define AXO_C 0.57735026918962576
static const view views[] = {
    [AX_VIEW_PLAN] = {"Plan", "Deployed, from above", {1, 0, 0}, {0, 1, 0}, {0, 0, 1}},
    [AX_VIEW_FRONT] = {"Front", "Deployed, from the front (looking along y)", {1, 0, 0}, {0, 0, 1}, {0, -1, 0}},
    [AX_VIEW_SIDE] = {"Side", "Deployed, from the right (looking against x)", {0, 1, 0}, {0, 0, 1}, {1, 0, 0}},
    [AX_VIEW_AXONOMETRIC] =
        {"Axonometric", "Deployed, axonometric", {AXO_S, AXO_S, 0}, {-AXO_A, AXO_A, AXO_B}, {AXO_C, -AXO_C, AXO_C}},
};

typedef struct depth {
    double at;
    int panel; // or point of the frame
} depth;

static int far_first(const void* a, const void* b)
{
    const depth *x = a, *y = b;
    return x->at != y->at ? (x->at > y->at) - (x->at < y->at) : x->panel - y->panel;
}

// Twice the area, along the normal of the side from which corners run counter-clockwise: outwards on a shell.
static void panel_vector(const ax_booklet* b, int t, double out[3])
{
    const int* h = b->design->linkage.triangles[t];
    double u[3], v[3];
    ax_sub3(b->design->deployed[h[1]], b->design->deployed[h[0]], u);
    ax_sub3(b->design->deployed[h[2]], b->design->deployed[h[0]], v);
    ax_cross(u, v, out);
}

typedef struct sight {
    const view* v;
    double scale, middle[2], centre[2]; // of the design, in the view, mm; on paper
    double mm;
} sight;

static void see(const sight* s, const double place[3], double out[2])
{
    out[0] = s->centre[0] + s->scale * (s->mm * ax_dot3(place, s->v->right) - s->middle[0]);
    out[1] = s->centre[1] - s->scale * (s->mm * ax_dot3(place, s->v->up) - s->middle[1]);
}

// Marks supports; their numbers, the nearest first, where they hide no other.
static void put_supports(ax_booklet* b, const sight* s, bool names)
{
    int n = b->frame.point_count, written = 0;
    depth* order = AX_NEW(depth, n);
    double(*place)[2] = ax_alloc((size_t)n, sizeof *place);
    cairo_set_source_rgb(b->cairo, 0.75, 0.1, 0.1);
    for (int k = 0; k < n; ++k) {
        double at[2];
        order[k] = (depth){-ax_dot3(b->frame.points[k].place, s->v->toward), k};
        see(s, b->design->deployed[b->frame.points[k].hinge], at);
        ax_booklet_dot(b, at);
    }
    ax_booklet_dots(b, 0.6);
    qsort(order, (size_t)n, sizeof *order, far_first);
    for (int k = 0; k < n && names; ++k) {
        double at[2], *to = place[written];
        see(s, b->design->deployed[b->frame.points[order[k].panel].hinge], at);
        double out[2] = {at[0] - s->centre[0], at[1] - s->centre[1]}, length = fmax(hypot(out[0], out[1]), 1e-9);
        bool free_place = true;
        for (int d = 0; d < 2; ++d)
            to[d] = at[d] + 3.5 * out[d] / length;
        for (int i = 0; i < written && free_place; ++i)
            free_place = fabs(to[0] - place[i][0]) > 6 || fabs(to[1] - place[i][1]) > 2.4;
        if (!free_place)
            continue;
        char text[16];
        snprintf(text, sizeof text, "S%d", order[k].panel + 1);
        ax_booklet_text(b, to[0], to[1] + 0.8, 2.2, AX_CENTRE, text);
        ++written;
    }
    ax_booklet_ink(b, 0);
    ax_free(order);
    ax_free(place);
}

// --- layers

// A panel as it is seen: panels of one layer hide nothing of each other, those of higher ones lie in front.
typedef struct seen {
    double corners[3][2];
    int panel, layer, place; // place: from back to front
    ax_panel_style style;
} seen;

static int by_layer(const void* a, const void* b)
{
    const seen *x = a, *y = b;
    return x->layer != y->layer ? x->layer - y->layer : x->place - y->place;
}

// Whether a line along an edge of `a` has `b` on its other side, or nearly.
static bool edge_parts(const double a[3][2], const double b[3][2])
{
    static const double nearly = 0.02; // mm, less than lines are wide
    for (int k = 0; k < 3; ++k) {
        const double *p = a[k], *q = a[(k + 1) % 3];
        double inner = ax_orient2(p, q, a[(k + 2) % 3]), outer = -INFINITY;
        for (int i = 0; i < 3; ++i)
            outer = fmax(outer, (inner < 0 ? -1 : 1) * ax_orient2(p, q, b[i]));
        if (outer <= nearly * ax_distance2(p, q))
            return true;
    }
    return false;
}

static void bounds_of(const seen* s, double cell, int lo[2], int hi[2])
{
    for (int d = 0; d < 2; ++d) {
        const double x[3] = {s->corners[0][d], s->corners[1][d], s->corners[2][d]};
        lo[d] = (int)floor(fmin(fmin(x[0], x[1]), x[2]) / cell);
        hi[d] = (int)floor(fmax(fmax(x[0], x[1]), x[2]) / cell);
    }
}

// Each panel, from back to front, is one layer above the highest that it hides a part of.
static void find_layers(seen* all, int count, const ax_box* box)
{
    double size = 0;
    for (int i = 0; i < count; ++i)
        for (int k = 0; k < 3; ++k)
            size += ax_distance2(all[i].corners[k], all[i].corners[(k + 1) % 3]) / (3 * count);
    const double cell = fmax(size, 0.5);
    const int columns = (int)((box->x + box->width) / cell) + 2, rows = (int)((box->y + box->height) / cell) + 2;
    int* latest = AX_NEW(int, columns* rows); // entry of each cell, each leads to the one before
    int(*entries)[2] = NULL, entry_count = 0, entry_room = 0;
    memset(latest, -1, (size_t)(columns * rows) * sizeof *latest);
    for (int i = 0; i < count; ++i) {
        int lo[2], hi[2];
        bounds_of(&all[i], cell, lo, hi);
        all[i].layer = 0;
        for (int y = lo[1]; y <= hi[1]; ++y)
            for (int x = lo[0]; x <= hi[0]; ++x) {
                int* at = &latest[y * columns + x];
                for (int e = *at; e >= 0; e = entries[e][1]) {
                    const seen* other = &all[entries[e][0]];
                    if (other->layer >= all[i].layer &&
                        !edge_parts((const double(*)[2])all[i].corners, (const double(*)[2])other->corners) &&
                        !edge_parts((const double(*)[2])other->corners, (const double(*)[2])all[i].corners))
                        all[i].layer = other->layer + 1;
                }
                if (entry_count == entry_room) {
                    entry_room = 2 * entry_room + 1024;
                    entries = ax_realloc(entries, (size_t)entry_room, sizeof *entries);
                }
                entries[entry_count][0] = i, entries[entry_count][1] = *at;
                *at = entry_count++;
            }
    }
    ax_free(entries);
    ax_free(latest);
}

static void draw_seen(ax_booklet* b, seen* all, int count)
{
    qsort(all, (size_t)count, sizeof *all, by_layer);
    for (int i = 0; i < count; ++i) {
        ax_booklet_panel(b, all[i].panel, (const double(*)[2])all[i].corners, all[i].style);
        if (i + 1 == count || all[i + 1].layer != all[i].layer)
            ax_booklet_flush(b);
    }
}

void ax_booklet_draw_view(ax_booklet* b, ax_booklet_view which, const ax_box* box, bool names, char scale[32])
{
    const view* v = &views[which];
    const ax_linkage* l = &b->design->linkage;
    const double(*places)[3] = (const double(*)[3])b->design->deployed;
    double lo[2] = {INFINITY, INFINITY}, hi[2] = {-INFINITY, -INFINITY}, sum[3] = {0, 0, 0};
    for (int h = 0; h < l->hinge_count; ++h) {
        double p[2] = {b->mm * ax_dot3(places[h], v->right), b->mm * ax_dot3(places[h], v->up)};
        for (int d = 0; d < 2; ++d)
            lo[d] = fmin(lo[d], p[d]), hi[d] = fmax(hi[d], p[d]);
    }
    ax_box inner = {box->x + 8, box->y + 5, box->width - 16, box->height - 10}; // numbers of supports stand outside
    sight s = {.v = v, .mm = b->mm, .scale = ax_booklet_scale(&inner, hi[0] - lo[0], hi[1] - lo[1], scale)};
    for (int d = 0; d < 2; ++d)
        s.middle[d] = (lo[d] + hi[d]) / 2;
    s.centre[0] = box->x + box->width / 2, s.centre[1] = box->y + box->height / 2;
    depth* order = AX_NEW(depth, l->triangle_count);
    for (int t = 0; t < l->triangle_count; ++t) {
        double n[3];
        panel_vector(b, t, n);
        order[t] = (depth){0, t};
        for (int k = 0; k < 3; ++k)
            order[t].at += ax_dot3(places[l->triangles[t][k]], v->toward), sum[k] += n[k];
    }
    // the shell's outer side faces up, or, if it stands, whoever looks at it from over there
    double outer = ax_dot3(sum, v->toward) < 0 && fabs(ax_dot3(sum, v->toward)) > 0.3 * ax_norm3(sum) ? -1 : 1;
    qsort(order, (size_t)l->triangle_count, sizeof *order, far_first);
    int count = 0;
    seen* all = AX_NEW(seen, l->triangle_count);
    for (int pass = 0; pass < 2; ++pass) // backs first: whatever is behind, they are seen through the holes
        for (int i = 0; i < l->triangle_count; ++i) {
            int t = order[i].panel;
            double n[3];
            panel_vector(b, t, n);
            bool back = outer * ax_dot3(n, v->toward) < 0;
            if (back == pass)
                continue;
            all[count] = (seen){.panel = t,
                                .place = count,
                                .style = back    ? AX_PANEL_BACK
                                         : names ? AX_PANEL_NAMED
                                                 : AX_PANEL_PLAIN};
            for (int k = 0; k < 3; ++k)
                see(&s, places[l->triangles[t][k]], all[count].corners[k]);
            ++count;
        }
    find_layers(all, count, box);
    draw_seen(b, all, count);
    ax_free(all);
    put_supports(b, &s, names);
    ax_free(order);
}

void ax_booklet_views(ax_booklet* b)
{
    for (int k = 0; k < 4; ++k) {
        char scale[32];
        ax_box box = ax_booklet_body();
        ax_booklet_page(b, views[k].section, views[k].heading,
                        "Coordinates are those of the design, z up. Red: supports. Pale: panels seen from behind.");
        ax_booklet_draw_view(b, (ax_booklet_view)k, &box, true, scale);
        ax_booklet_text(b, box.x + box.width, 25.5, 3.2, AX_RIGHT, scale);
        ax_booklet_end_page(b);
    }
}
