// The frame on which a design's supports stand: their curves, measured, and drawn at true size.
#include "ax/assembly.h"

#include "base/vec.h"
#include "constraint/eigen3.h"
#include "fabricate/arches.h"
#include "fabricate/plan.h"
#include "fabricate/stroke_font.h"
#include "linkage/lattice.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { PIECES = 8 };               // of the smooth curve between two supports, when it is drawn
static const double far_apart = 3; // times the usual number of rim hinges from one support to the next
static const double corner = 30 * AX_PI / 180;
static const double upright = 0.7; // vertical part of the normal, below which a plane stands

void ax_frame_free(ax_support_frame* frame)
{
    if (!frame)
        return;
    ax_free(frame->points);
    ax_free(frame->curves);
    *frame = (ax_support_frame){0};
}

static int ascending(const void* a, const void* b)
{
    int x = *(const int*)a, y = *(const int*)b;
    return (x > y) - (x < y);
}

// Rim places at[0 .. count) of the supports, out of `rim` places all round, to runs: ends[k] tells that a curve ends with support
// k. Returns whether any does.
static bool find_ends(int count, const int* at, int rim, bool* ends)
{
    int *gaps = AX_NEW(int, count), *sorted = AX_NEW(int, count);
    bool any = false;
    for (int k = 0; k < count; ++k)
        gaps[k] = sorted[k] = k + 1 < count ? at[k + 1] - at[k] : at[0] + rim - at[k];
    qsort(sorted, (size_t)count, sizeof *sorted, ascending);
    for (int k = 0; k < count; ++k) {
        ends[k] = gaps[k] > far_apart * sorted[count / 2];
        any |= ends[k];
    }
    ax_free(gaps);
    ax_free(sorted);
    return any;
}

// --- measuring

static void fit_plane(const ax_support_frame* f, ax_frame_curve* c)
{
    ax_lane3* y = ax_alloc_aligned((size_t)c->count, sizeof *y);
    ax_lane3 axis[3];
    memset(y, 0, (size_t)c->count * sizeof *y);
    memset(c->origin, 0, sizeof c->origin);
    for (int k = 0; k < c->count; ++k)
        for (int d = 0; d < 3; ++d)
            c->origin[d] += f->points[c->first + k].place[d] / c->count;
    for (int k = 0; k < c->count; ++k)
        for (int d = 0; d < 3; ++d)
            y[k][d][0] = f->points[c->first + k].place[d] - c->origin[d];
    ax_principal_axes(c->count, (const ax_lane3*)y, axis);
    double n[3], x[3] = {1, 0, 0};
    for (int d = 0; d < 3; ++d)
        n[d] = axis[2][d][0];
    if (n[2] < 0 || (n[2] == 0 && n[1] > 0)) // seen from above, or from the front
        for (int d = 0; d < 3; ++d)
            n[d] = -n[d];
    if (n[2] < upright) // a plane that stands is drawn standing
        x[0] = -n[1], x[1] = n[0];
    double out = ax_dot3(x, n), length;
    for (int d = 0; d < 3; ++d)
        x[d] -= out * n[d];
    length = ax_norm3(x);
    for (int d = 0; d < 3; ++d)
        c->axes[0][d] = x[d] / length, c->axes[2][d] = n[d];
    ax_cross(c->axes[2], c->axes[0], c->axes[1]);
    c->off_plane = 0;
    for (int k = 0; k < c->count; ++k) {
        double r[3];
        ax_sub3(f->points[c->first + k].place, c->origin, r);
        c->off_plane = fmax(c->off_plane, fabs(ax_dot3(r, c->axes[2])));
    }
    ax_free(y);
}

static void in_plane(const ax_frame_curve* c, const double place[3], double out[2])
{
    double r[3];
    ax_sub3(place, c->origin, r);
    out[0] = ax_dot3(r, c->axes[0]), out[1] = ax_dot3(r, c->axes[1]);
}

// Least squares of |x - centre|^2 - radius^2 (Kasa 1976), about the centroid.
static void fit_circle(const ax_support_frame* f, ax_frame_curve* c)
{
    double uu = 0, uv = 0, vv = 0, ru = 0, rv = 0, r2 = 0;
    for (int k = 0; k < c->count; ++k) {
        double p[2];
        in_plane(c, f->points[c->first + k].place, p);
        double s = p[0] * p[0] + p[1] * p[1];
        uu += p[0] * p[0], uv += p[0] * p[1], vv += p[1] * p[1];
        ru += s * p[0] / 2, rv += s * p[1] / 2, r2 += s / c->count;
    }
    double det = uu * vv - uv * uv;
    if (!(det > 1e-9 * uu * vv))
        return; // on a line
    double u = (ru * vv - rv * uv) / det, v = (rv * uu - ru * uv) / det;
    c->radius = sqrt(r2 + u * u + v * v);
    c->off_circle = 0;
    for (int d = 0; d < 3; ++d)
        c->centre[d] = c->origin[d] + u * c->axes[0][d] + v * c->axes[1][d];
    for (int k = 0; k < c->count; ++k) {
        double p[2];
        in_plane(c, f->points[c->first + k].place, p);
        c->off_circle = fmax(c->off_circle, fabs(hypot(p[0] - u, p[1] - v) - c->radius));
    }
}

static const ax_frame_point* point_of(const ax_support_frame* f, const ax_frame_curve* c, int k)
{
    return &f->points[c->first + (k + c->count) % c->count];
}

static double radius_through(const double a[3], const double b[3], const double c[3])
{
    double u[3], v[3], n[3];
    ax_sub3(b, a, u);
    ax_sub3(c, a, v);
    ax_cross(u, v, n);
    double product = ax_norm3(u) * ax_norm3(v) * ax_distance3(b, c), twice = 2 * ax_norm3(n);
    return twice > 1e-9 * product / fmax(ax_norm3(u), ax_norm3(v)) ? product / twice : INFINITY;
}

static int span_count(const ax_frame_curve* c)
{
    return c->closed ? c->count : c->count - 1;
}

// Length, seen from above, of a piece of the way from point k to the next.
static double piece_from_above(const ax_support_frame* f, const ax_frame_curve* c, int k, int piece)
{
    double a[3], b[3];
    ax_frame_at(f, c, k, piece / (double)PIECES, a);
    ax_frame_at(f, c, k, (piece + 1) / (double)PIECES, b);
    return ax_distance2(a, b);
}

static void measure_curve(ax_support_frame* f, ax_frame_curve* c)
{
    c->off_plane = c->off_circle = NAN;
    for (int k = 0; k < c->count; ++k) {
        ax_frame_point* p = &f->points[c->first + k];
        const ax_frame_point *next = point_of(f, c, k + 1), *last = point_of(f, c, k - 1);
        bool end = !c->closed && k + 1 == c->count, lies_between = c->closed || (k > 0 && !end);
        p->along = c->length;
        p->chord = end ? NAN : ax_distance3(p->place, next->place);
        p->radius = lies_between ? radius_through(last->place, p->place, next->place) : NAN;
        c->length += end ? 0 : p->chord;
    }
    for (int k = 0; k < c->count; ++k) {
        f->points[c->first + k].plan = c->plan;
        for (int i = 0; i < PIECES && k < span_count(c); ++i)
            c->plan += piece_from_above(f, c, k, i);
    }
    if (c->count < 3)
        return;
    double tolerance = fmax(AX_FRAME_TOLERANCE, 1e-4 * c->length);
    fit_plane(f, c);
    c->planar = c->off_plane <= tolerance;
    if (!c->planar || c->count < 4)
        return;
    fit_circle(f, c);
    c->circle = c->off_circle <= tolerance; // not if it is NaN
}

// --- finding

static void add_point(ax_support_frame* f, const ax_design* design, const int* pair, int hinge)
{
    double mm = 1000 * ax_unit_in_metres(design->unit);
    ax_frame_point* p = &f->points[f->point_count++];
    *p = (ax_frame_point){
        .hinge = hinge, .panel = pair[0], .slides = design->slides && design->slides[hinge].freedom != AX_HELD_FAST};
    for (int d = 0; d < 3; ++d)
        p->place[d] = mm * design->deployed[hinge][d];
}

static void add_curve(ax_support_frame* f, int first, bool closed)
{
    f->curves[f->curve_count++] = (ax_frame_curve){.first = first, .count = f->point_count - first, .closed = closed};
}

ax_support_frame ax_frame_of(const ax_design* design)
{
    const ax_linkage* l = &design->linkage;
    int *rim = AX_NEW(int, l->hinge_count), *at = AX_NEW(int, l->hinge_count), count = 0;
    int(*held)[2] = ax_linkage_hinge_triangles(l);
    ax_arches arches = ax_arches_find(design, (const int(*)[2])held);
    ax_support_frame f = {.points = AX_NEW0(ax_frame_point, l->hinge_count + arches.hinge_count),
                          .curves = AX_NEW0(ax_frame_curve, l->hinge_count + arches.count)};
    int around = ax_linkage_rim(l, rim);
    for (int k = 0; k < around; ++k)
        if (design->supports[rim[k]])
            at[count++] = k;
    bool* ends = AX_NEW0(bool, count + 1);
    bool any = count > 0 && find_ends(count, at, around, ends);
    int begin = 0;
    while (any && !ends[begin])
        ++begin;
    for (int k = 0, first = 0; k < count; ++k) {
        int i = any ? (begin + 1 + k) % count : k;
        add_point(&f, design, held[rim[at[i]]], rim[at[i]]);
        if (any ? ends[i] : k + 1 == count) {
            add_curve(&f, first, !any && count > 2);
            first = f.point_count;
        }
    }
    for (int k = 0; k < arches.count; ++k) {
        int first = f.point_count;
        for (int i = arches.start[k]; i < arches.start[k + 1]; ++i)
            add_point(&f, design, held[arches.hinges[i]], arches.hinges[i]);
        add_curve(&f, first, arches.closed[k]);
        f.curves[f.curve_count - 1].arch = true;
    }
    for (int h = 0; h < l->hinge_count; ++h)
        f.support_count += design->supports[h];
    for (int k = 0; k < f.curve_count; ++k)
        measure_curve(&f, &f.curves[k]);
    ax_free(rim);
    ax_free(at);
    ax_free(ends);
    ax_free(held);
    ax_arches_free(&arches);
    return f;
}

// --- the curve

// Direction of the curve at point k, per unit of the chord that it is needed for: the quadratic through three points, whose chords
// may differ (Bessel's tangents); of a corner or an end the chord itself.
static void tangent_at(const ax_support_frame* f, const ax_frame_curve* c, int k, const double chord[3], double length,
                       double out[3])
{
    const ax_frame_point *p = point_of(f, c, k), *last = point_of(f, c, k - 1), *next = point_of(f, c, k + 1);
    memcpy(out, chord, 3 * sizeof *out);
    if (isnan(p->radius))
        return;
    double u[3], v[3];
    ax_sub3(p->place, last->place, u);
    ax_sub3(next->place, p->place, v);
    double a = ax_norm3(u), b = ax_norm3(v);
    if (!(ax_dot3(u, v) > cos(corner) * a * b))
        return;
    for (int d = 0; d < 3; ++d)
        out[d] = length * (u[d] / a * b + v[d] / b * a) / (a + b);
}

void ax_frame_at(const ax_support_frame* frame, const ax_frame_curve* curve, int k, double t, double place[3])
{
    const ax_frame_point *a = point_of(frame, curve, k), *b = point_of(frame, curve, k + 1);
    double chord[3], from[3], to[3];
    ax_sub3(b->place, a->place, chord);
    tangent_at(frame, curve, k, chord, ax_norm3(chord), from);
    tangent_at(frame, curve, k + 1, chord, ax_norm3(chord), to);
    double h = t * t * (3 - 2 * t), s = t * (1 - t) * (1 - t), e = t * t * (t - 1); // Hermite's
    for (int d = 0; d < 3; ++d)
        place[d] = a->place[d] + h * chord[d] + s * from[d] + e * to[d];
}

// --- the template

static const double margin = 15, letters = 5, arm = 6, between = 40; // mm

// What a curve's points are drawn as.
typedef enum aspect { IN_PLANE, FROM_ABOVE, UNROLLED } aspect;

typedef struct template
{
    const ax_design* design;
    const ax_support_frame* frame;
    ax_plan_builder b;
    double origin[2]; // of what is being drawn
    double lo[2], hi[2];
}
template;

static void flatten(const template* t, const ax_frame_curve* c, aspect a, const double place[3], double unrolled,
                    double out[2])
{
    if (a == IN_PLANE)
        in_plane(c, place, out);
    else
        out[0] = a == FROM_ABOVE ? place[0] : unrolled, out[1] = place[a == FROM_ABOVE ? 1 : 2];
    out[0] += t->origin[0], out[1] += t->origin[1];
}

static void put_point(template* t, const double p[2])
{
    ax_plan_point(&t->b, p[0], p[1]);
    for (int d = 0; d < 2; ++d)
        t->lo[d] = fmin(t->lo[d], p[d]), t->hi[d] = fmax(t->hi[d], p[d]);
}

static void put_line(template* t, const ax_frame_curve* c, aspect a, int index)
{
    bool round = c->circle && a == IN_PLANE;
    double turn = 0, centre[2];
    if (round) { // the way round, from the first chord
        double p[2], q[2];
        in_plane(c, c->centre, centre);
        in_plane(c, point_of(t->frame, c, 0)->place, p);
        in_plane(c, point_of(t->frame, c, 1)->place, q);
        turn = (p[0] - centre[0]) * (q[1] - centre[1]) - (p[1] - centre[1]) * (q[0] - centre[0]) > 0 ? 1 : -1;
    }
    bool closes = c->closed && a != UNROLLED;
    ax_plan_item(&t->b, AX_CUT, -1, "curve-%d", index + 1);
    ax_plan_path(&t->b, closes);
    for (int k = 0; k < span_count(c); ++k) {
        const ax_frame_point* p = point_of(t->frame, c, k);
        double at[2], unrolled = p->plan;
        for (int i = 0; i < (round ? 1 : PIECES); ++i) {
            double place[3];
            ax_frame_at(t->frame, c, k, i / (double)PIECES, place);
            flatten(t, c, a, place, unrolled, at);
            put_point(t, at);
            unrolled += piece_from_above(t->frame, c, k, i);
        }
        if (round) // a chord's arc; |chord| <= 2 radius but for the tolerance
            t->b.plan->points[t->b.plan->point_count - 1].bulge =
                turn * tan(asin(fmin(1, p->chord / (2 * c->radius))) / 2);
    }
    if (!closes) {
        const ax_frame_point* p = point_of(t->frame, c, span_count(c));
        double at[2];
        flatten(t, c, a, p->place, c->plan, at);
        put_point(t, at);
    }
}

static void put_stroke(template* t, double ax, double ay, double bx, double by)
{
    ax_plan_path(&t->b, false);
    put_point(t, (double[2]){ax, ay});
    put_point(t, (double[2]){bx, by});
}

static void put_supports(template* t, const ax_frame_curve* c, aspect a, int index)
{
    ax_plan_item(&t->b, AX_SCORE, -1, "supports-%d", index + 1);
    for (int k = 0; k < c->count; ++k) {
        const ax_frame_point *p = point_of(t->frame, c, k), *next = point_of(t->frame, c, k + 1);
        double at[2], to[2];
        flatten(t, c, a, p->place, p->plan, at);
        put_stroke(t, at[0] - arm, at[1], at[0] + arm, at[1]);
        put_stroke(t, at[0], at[1] - arm, at[0], at[1] + arm);
        if (k < span_count(c) && (a != UNROLLED || k + 1 < c->count)) {
            flatten(t, c, a, next->place, next->plan, to);
            put_stroke(t, at[0], at[1], to[0], to[1]);
        }
    }
    for (int k = 0; k < c->count; ++k) {
        const ax_frame_point* p = point_of(t->frame, c, k);
        char name[16], text[64];
        double at[2];
        ax_panel_name(&t->design->linkage, p->panel, name);
        snprintf(text, sizeof text, a == FROM_ABOVE ? "S%d %s %+.1f" : "S%d %s", c->first + k + 1, name, p->place[2]);
        flatten(t, c, a, p->place, p->plan, at);
        ax_plan_item(&t->b, AX_LABEL, p->panel, "support-%d.%d", c->first + k + 1, (int)a);
        ax_plan_text(&t->b, text, letters, &(ax_motion){1, 0, at[0] + letters / 2, at[1] + letters / 2});
        t->hi[0] = fmax(t->hi[0], at[0] + letters * (ax_stroke_width(text) + 1));
        t->hi[1] = fmax(t->hi[1], at[1] + 2 * letters);
    }
}

// One drawing of a curve, right of the ones before.
static void put_aspect(template* t, const ax_frame_curve* c, aspect a, int index, double* x)
{
    // where it would begin, from the points alone
    double lo[2] = {INFINITY, INFINITY};
    t->origin[0] = t->origin[1] = 0;
    for (int k = 0; k < span_count(c); ++k)
        for (int i = 0; i <= PIECES; ++i) {
            double place[3], at[2];
            ax_frame_at(t->frame, c, k, i / (double)PIECES, place);
            flatten(t, c, a, place, point_of(t->frame, c, k)->plan, at);
            lo[0] = fmin(lo[0], at[0]), lo[1] = fmin(lo[1], at[1]);
        }
    t->origin[0] = *x - lo[0] + arm, t->origin[1] = margin + 3 * letters - lo[1] + arm;
    t->lo[0] = t->lo[1] = INFINITY;
    t->hi[0] = t->hi[1] = -INFINITY;
    put_line(t, c, a, index);
    put_supports(t, c, a, index);
    static const char* const words[] = {"in its plane", "from above, with heights",
                                        "unrolled: height over length from above"};
    char text[128];
    snprintf(text, sizeof text, "%s %d %s", c->arch ? "arch" : "frame", index + 1, words[a]);
    ax_plan_item(&t->b, AX_NOTE, -1, "name-%d.%d", index + 1, (int)a);
    ax_plan_text(&t->b, text, letters, &(ax_motion){1, 0, *x, margin + letters / 2});
    *x = fmax(t->hi[0], *x + letters * ax_stroke_width(text)) + between;
}

ax_status ax_frame_plan(const ax_design* design, const ax_support_frame* frame, const char* title, ax_cut_plan* plan,
                        ax_error* error)
{
    *plan = (ax_cut_plan){0};
    int drawn = 0, profiles;
    for (int k = 0; k < frame->curve_count; ++k)
        drawn += frame->curves[k].count > 1;
    if (!drawn)
        return ax_fail(error, AX_BAD_INPUT,
                       "No two supports follow each other on the rim, so there is no frame to draw. Support the rim "
                       "(simulate with --support rim) and export again.");
    plan->profile = ax_profiles(&profiles);
    ax_plan_set_title(plan, title);
    template t = {.design = design, .frame = frame, .b = {.plan = plan}};
    double x = margin + 100 + between, height = 3 * margin; // the check bar stands left of all
    for (int k = 0; k < frame->curve_count; ++k)
        if (frame->curves[k].count > 1)
            for (int a = frame->curves[k].planar ? IN_PLANE : FROM_ABOVE;
                 a <= (frame->curves[k].planar ? IN_PLANE : UNROLLED); ++a) {
                put_aspect(&t, &frame->curves[k], (aspect)a, k, &x);
                height = fmax(height, t.hi[1]);
            }
    ax_plan_item(&t.b, AX_NOTE, -1, "check-bar");
    put_stroke(&t, margin, margin, margin + 100, margin);
    put_stroke(&t, margin, margin - 3, margin, margin + 3);
    put_stroke(&t, margin + 100, margin - 3, margin + 100, margin + 3);
    ax_plan_text(&t.b, "100 mm", letters, &(ax_motion){1, 0, margin, margin + letters});
    plan->sheets = AX_NEW0(ax_cut_sheet, 1);
    plan->sheet_count = 1;
    plan->sheets[0] =
        (ax_cut_sheet){.width = ceil(x - between + margin), .height = ceil(height + margin), .count = plan->item_count};
    return AX_OK;
}
