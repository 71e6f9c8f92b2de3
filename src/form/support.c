// Whether anything holds a form under its load, told before it is solved: what is free falls without end.
#include "form/state.h"

#include "base/vec.h"

#include <math.h>
#include <string.h>

// Places at which hinges are held, as far as they matter: the first, the one furthest from it, and the distance of the others from the
// line of both.
typedef struct spread {
    int count;
    double first[3], furthest[3], off;
} spread;

static void reach(spread* s, const double x[3], int pass)
{
    if (s->count++ == 0)
        memcpy(s->first, x, sizeof s->first), memcpy(s->furthest, x, sizeof s->furthest);
    if (pass == 0) {
        if (ax_distance3(x, s->first) > ax_distance3(s->furthest, s->first))
            memcpy(s->furthest, x, sizeof s->furthest);
        return;
    }
    double along[3], d[3], across[3], length = ax_distance3(s->furthest, s->first);
    ax_sub3(s->furthest, s->first, along);
    ax_sub3(x, s->first, d);
    ax_cross(along, d, across);
    s->off = fmax(s->off, length > 0 ? ax_norm3(across) / length : 0);
}

static void reach_curve(spread* s, const ax_curve_shape* shape, int pass)
{
    enum { SAMPLES = 7 };
    ax_curve* curve = ax_curve_of_shape(shape);
    double end = ax_curve_extent(curve).to, whole = isfinite(end) ? ax_curve_length(curve, end) : 1, x[3];
    for (int k = 0; k < SAMPLES; ++k) {
        ax_curve_point(curve, ax_curve_at_length(curve, whole * k / SAMPLES), x);
        reach(s, x, pass);
    }
    ax_curve_free(curve);
}

ax_status ax_form_check_support(const ax_form* f, ax_error* error)
{
    spread s = {0};
    bool rests = false; // on a plane or a surface
    for (int pass = 0; pass < 2; ++pass) {
        for (int k = 0; k < f->rim_count; ++k) {
            const ax_rim_part* part = f->rim + k;
            for (int i = 0; i < part->count && part->kind == AX_RIM_FIXED; ++i)
                reach(&s, part->places[i], pass);
            if (part->kind == AX_RIM_SLIDE)
                reach_curve(&s, &part->curve, pass);
        }
        for (int k = 0; k < f->held_count; ++k) {
            const ax_form_constraint* c = f->held + k;
            for (int i = 0; i < c->count && c->support && c->kind == AX_HELD_FIXED; ++i)
                reach(&s, c->places[i], pass);
            if (c->support && c->kind == AX_HELD_CURVE)
                reach_curve(&s, &c->curve, pass);
            rests = rests || (c->support && (c->kind == AX_HELD_PLANE_GIVEN || c->kind == AX_HELD_SURFACE));
        }
    }
    const char* load = f->dynamics.kind == AX_DYNAMICS_GRAVITY ? "gravity" : "inflation";
    if (s.count == 0 && !rests)
        return ax_fail(
            error, AX_CANNOT_REALISE,
            "Nothing holds the sheet, so under %s it would move off without end. Hold its rim before (rim_fixed, "
            "rim_circle, rim_polyline ...), or hinges by a constraint with \"support\": true (hold_fixed, "
            "hold_curve).",
            load);
    if (!rests && s.off < 1e-6 * f->radius)
        return ax_fail(
            error, AX_CANNOT_REALISE,
            "All supports lie on one straight line, about which the sheet turns under %s. Hold a hinge beside that "
            "line too.",
            load);
    return AX_OK;
}
