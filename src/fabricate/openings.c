#include "fabricate/openings.h"

#include "base/vec.h"

static void direction(const double from[2], const double to[2], double out[2])
{
    double length = ax_distance2(from, to);
    for (int d = 0; d < 2; ++d)
        out[d] = (to[d] - from[d]) / length;
}

// An opening at a hinge: its edges' directions, half its angle, and the direction of its middle.
typedef struct gap {
    double in[2], out[2], middle[2], half;
} gap;

static gap gap_of(const double before[2], const double at[2], const double after[2])
{
    gap g;
    direction(before, at, g.in);
    direction(at, after, g.out);
    g.half = (AX_PI - atan2(ax_cross2(g.in, g.out), g.in[0] * g.out[0] + g.in[1] * g.out[1])) / 2;
    double c = cos(g.half), s = sin(g.half);
    g.middle[0] = c * g.out[0] - s * g.out[1], g.middle[1] = s * g.out[0] + c * g.out[1];
    return g;
}

// Where the circle about o->centre meets an edge through `at`, moved left by `grow`, on the side that `way` (1 or -1) points to.
static void meet_edge(const ax_opening_corner* o, double radius, const double at[2], const double along[2], double grow,
                      double way, double out[2])
{
    double from_edge = (o->centre[1] - at[1]) * along[0] - (o->centre[0] - at[0]) * along[1] - grow;
    double reach = way * sqrt(fmax(0, radius * radius - from_edge * from_edge));
    out[0] = o->centre[0] + from_edge * along[1] + reach * along[0];
    out[1] = o->centre[1] - from_edge * along[0] + reach * along[1];
}

// Angle from `a` to `b` about the arc's centre, in the sense of `way`.
static double turn_between(const ax_opening_corner* o, const double a[2], const double b[2], double way)
{
    const double x[2] = {a[0] - o->centre[0], a[1] - o->centre[1]}, y[2] = {b[0] - o->centre[0], b[1] - o->centre[1]};
    double angle = atan2(ax_cross2(x, y), x[0] * y[0] + x[1] * y[1]) * way;
    return way * (angle < -1e-9 ? angle + 2 * AX_PI : fmax(angle, 0));
}

static ax_opening_corner plain_corner(const gap* g, const double at[2], double grow)
{
    ax_opening_corner o = {0};
    for (int d = 0; d < 2; ++d)
        o.enter[d] = o.leave[d] = o.tip[d] = at[d] + grow / sin(g->half) * g->middle[d];
    return o;
}

// `own`: the opening; `other`: the one across the hinge; grow: half the kerf.
static ax_opening_corner round_corner(const gap* own, const gap* other, bool mouth, const double at[2], double ligament,
                                      double grow)
{
    ax_opening_corner o = {0};
    const gap* m = mouth ? own : other;
    double s = sin(m->half), radius = ligament / 2 * s / (1 - s), way = mouth ? 1 : -1;
    for (int d = 0; d < 2; ++d)
        o.centre[d] = at[d] + radius / s * m->middle[d];
    radius += mouth ? -grow : ligament + grow;
    if (radius <= 0) { // the beam is wider than the mouth's end
        o = plain_corner(own, at, grow);
        o.line = true;
        for (int d = 0; d < 2; ++d)
            o.line_end[d] = at[d] + (ligament / 2 + grow) * own->middle[d];
        return o;
    }
    meet_edge(&o, radius, at, own->in, grow, -1, o.enter);
    meet_edge(&o, radius, at, own->out, grow, 1, o.leave);
    for (int d = 0; d < 2; ++d)
        o.tip[d] = o.centre[d] - radius * m->middle[d];
    o.sweep[0] = turn_between(&o, o.enter, o.tip, way);
    o.sweep[1] = turn_between(&o, o.tip, o.leave, way);
    return o;
}

// Openings are followed with their panels to the right: along edge k of a triangle from corner k + 1 to corner k, and on from there
// along the other panel of the hinge, or along the same panel where the sheet ends.

// The corner of the other panel of the same piece at a corner (3 triangle + k), or the same corner.
static int across(const ax_work* w, int corner)
{
    int t = corner / 3, hinge = w->linkage->triangles[t][corner % 3];
    int other = w->held[hinge][w->held[hinge][0] == t];
    if (other < 0 || w->plan->panels[other].piece != w->plan->panels[t].piece)
        return corner;
    int k = 0;
    while (w->linkage->triangles[other][k] != hinge)
        ++k;
    return 3 * other + k;
}

// The corner at which the edge that leaves corner `corner` ends.
static int along_edge(int corner)
{
    return corner - corner % 3 + (corner + 2) % 3;
}

static const double* place(const ax_work* w, int corner)
{
    return w->flat[w->linkage->triangles[corner / 3][corner % 3]];
}

static gap gap_at(const ax_work* w, int corner, int next)
{
    int before = corner - corner % 3 + (corner + 1) % 3;
    return gap_of(place(w, before), place(w, corner), place(w, along_edge(next)));
}

// The corner of the opening that is reached at `corner` and left from `next` (the same hinge).
static ax_opening_corner corner_at(const ax_work* w, int corner, int next, double grow)
{
    gap own = gap_at(w, corner, next);
    if (corner == next)
        return plain_corner(&own, place(w, corner), grow);
    gap other = gap_at(w, next, corner);
    bool mouth = own.half < other.half || (own.half == other.half && corner < next);
    return round_corner(&own, &other, mouth, place(w, corner), w->rule.ligament, grow);
}

void ax_openings_put_panel(ax_work* w, int triangle)
{
    ax_plan_builder* b = &w->builder;
    ax_plan_path(b, true);
    for (int k = 0; k < 3; ++k) {
        int corner = 3 * triangle + k, other = across(w, corner);
        if (other == corner) {
            ax_plan_point(b, place(w, corner)[0], place(w, corner)[1]);
            continue;
        }
        ax_opening_corner in = corner_at(w, other, corner, 0), out = corner_at(w, corner, other, 0);
        ax_plan_point(b, in.leave[0], in.leave[1]);
        ax_plan_arc(b, in.centre, in.tip[0], in.tip[1], -in.sweep[1], false);
        ax_plan_point(b, out.tip[0], out.tip[1]);
        ax_plan_arc(b, out.centre, out.enter[0], out.enter[1], -out.sweep[0], false);
    }
}

// Length that is left of the edge between two corners of an opening, negative if they meet.
static double left_between(const ax_work* w, int from, int to, const ax_opening_corner* a, const ax_opening_corner* b)
{
    double along[2];
    direction(place(w, from), place(w, to), along);
    return (b->enter[0] - a->leave[0]) * along[0] + (b->enter[1] - a->leave[1]) * along[1];
}

ax_status ax_openings_check(const ax_work* w, ax_error* error)
{
    for (int start = 0; start < 3 * w->linkage->triangle_count; ++start) {
        int next = across(w, start), end = along_edge(next), after = across(w, end);
        ax_opening_corner a = corner_at(w, start, next, 0), b = corner_at(w, end, after, 0);
        double left = left_between(w, next, end, &a, &b);
        if (left < 0)
            return ax_fail(
                error, AX_CANNOT_REALISE,
                "Panel %s is too small for ligaments of %g mm: they take %.3g mm of an edge of %.3g mm. Set a "
                "smaller ligament, or design with fewer and larger panels.",
                w->plan->panels[next / 3].name, w->rule.ligament, ax_distance2(place(w, next), place(w, end)) - left,
                ax_distance2(place(w, next), place(w, end)));
    }
    return AX_OK;
}

typedef struct loop {
    int count, room;
    int* corners; // reached, in order
    ax_opening_corner* shapes;
} loop;

static void follow(const ax_work* w, int start, unsigned char* met, loop* l)
{
    l->count = 0;
    for (int corner = start; !met[corner]; corner = along_edge(across(w, corner))) {
        met[corner] = 1;
        if (l->count == l->room) {
            l->room = l->room ? 2 * l->room : 64;
            l->corners = ax_realloc(l->corners, (size_t)l->room, sizeof *l->corners);
            l->shapes = ax_realloc(l->shapes, (size_t)l->room, sizeof *l->shapes);
        }
        l->corners[l->count] = corner;
        l->shapes[l->count++] = corner_at(w, corner, across(w, corner), w->plan->kerf / 2);
    }
}

// False where the beam is wider than the opening somewhere, so that grown edges would cross.
static bool is_open(const ax_work* w, const loop* l)
{
    for (int i = 0; i < l->count; ++i) {
        int j = (i + 1) % l->count, next = across(w, l->corners[i]);
        if (left_between(w, next, l->corners[j], &l->shapes[i], &l->shapes[j]) <= 0)
            return false;
    }
    return true;
}

static double loop_area(const ax_work* w, const loop* l)
{
    double area = 0;
    for (int i = 1; i + 1 < l->count; ++i)
        area += ax_orient2(place(w, l->corners[0]), place(w, l->corners[i]), place(w, l->corners[i + 1]));
    return area / 2;
}

static void put_loop(ax_work* w, const loop* l, const ax_motion* motion)
{
    ax_plan_builder* b = &w->builder;
    ax_plan_path(b, true);
    for (int i = 0; i < l->count; ++i) {
        const ax_opening_corner* o = &l->shapes[i];
        double enter[2], leave[2], centre[2];
        ax_move(motion, o->enter[0], o->enter[1], enter);
        ax_plan_point(b, enter[0], enter[1]);
        if (o->sweep[0] == 0)
            continue;
        ax_move(motion, o->leave[0], o->leave[1], leave);
        ax_move(motion, o->centre[0], o->centre[1], centre);
        ax_plan_arc(b, centre, leave[0], leave[1], o->sweep[0] + o->sweep[1], false);
    }
}

static void put_line(ax_work* w, const double from[2], const double to[2], const ax_motion* motion)
{
    double at[2];
    ax_plan_path(&w->builder, false);
    ax_move(motion, from[0], from[1], at);
    ax_plan_point(&w->builder, at[0], at[1]);
    ax_move(motion, to[0], to[1], at);
    ax_plan_point(&w->builder, at[0], at[1]);
}

// An opening that the beam fills: a line along the middle of each mouth, from its end to the middle of the bulging corners, which
// lie together where an opening is nearly closed.
static void put_lines(ax_work* w, const loop* l, const ax_motion* motion)
{
    double middle[2] = {0, 0};
    int bulges = 0;
    for (int i = 0; i < l->count; ++i)
        if (l->shapes[i].sweep[0] < 0) {
            ++bulges;
            for (int d = 0; d < 2; ++d)
                middle[d] += place(w, l->corners[i])[d];
        }
    for (int i = 0; i < l->count && bulges; ++i) {
        const ax_opening_corner* o = &l->shapes[i];
        double end[2] = {middle[0] / bulges, middle[1] / bulges};
        if (o->sweep[0] >= 0)
            put_line(w, o->line ? o->line_end : o->tip, end, motion);
    }
}

void ax_openings_draw(ax_work* w, int sheet)
{
    const ax_cut_plan* plan = w->plan;
    int first = w->sheet_start[sheet], count = 3 * (w->sheet_start[sheet + 1] - first), openings = 0, rims = 0;
    loop l = {0};
    for (int i = 0; i < count; ++i) {
        int t = w->sheet_panels[first + i / 3], start = 3 * t + i % 3;
        if (w->met[start])
            continue;
        const double* m = plan->panels[t].placement;
        const ax_motion motion = {m[0], m[1], m[2], m[3]};
        follow(w, start, w->met, &l);
        if (loop_area(w, &l) < 0) {
            ax_plan_item(&w->builder, AX_CUT, -1, "cut-rim-%d", ++rims);
            put_loop(w, &l, &motion);
            for (int k = 0; k < l.count; ++k)
                if (l.shapes[k].line) {
                    ax_plan_item(&w->builder, AX_SLIT, -1, "rim-slit-%d.%d", rims, k);
                    put_line(w, l.shapes[k].enter, l.shapes[k].line_end, &motion);
                }
            continue;
        }
        ax_plan_item(&w->builder, AX_SLIT, -1, "opening-%d", ++openings);
        if (!is_open(w, &l)) {
            put_lines(w, &l, &motion);
            continue;
        }
        put_loop(w, &l, &motion);
        for (int k = 0; k < l.count; ++k)
            if (l.shapes[k].line)
                put_line(w, l.shapes[k].enter, l.shapes[k].line_end, &motion);
    }
    ax_free(l.corners);
    ax_free(l.shapes);
}
