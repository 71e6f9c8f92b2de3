// Whether panels can move from flat to open without touching: at every hinge over the way from its flat mouth to the open one, by
// closed form, and between all panels in the states that are known and in some between them.
#include "fabricate/work.h"

#include "analysis/measure.h"
#include "base/pool.h"
#include "base/vec.h"
#include "fabricate/way.h"
#include "linkage/lattice.h"

#include <stdlib.h>
#include <string.h>

// --- panels in the plane

// A loose panel is what lies within its straight edges, and three discs; wherever another panel comes nearest, a disc (a corner, if
// the radius is 0) is on one side or the other.
typedef struct region {
    double edge[3][2][2];
    double disc[3][2], radius;
} region;

static region region_of(const ax_work* w, int t)
{
    ax_panel_outline o = ax_work_outline(w, t, 0);
    region r = {.radius = o.radius};
    for (int k = 0; k < 3; ++k) {
        memcpy(r.disc[k], o.corner[k].disc, sizeof r.disc[k]);
        memcpy(r.edge[k][0], o.corner[k].leave, sizeof r.edge[k][0]);
        memcpy(r.edge[k][1], o.corner[(k + 1) % 3].enter, sizeof r.edge[k][1]);
    }
    return r;
}

static double to_segment(const double x[2], const double segment[2][2])
{
    double d[2] = {segment[1][0] - segment[0][0], segment[1][1] - segment[0][1]};
    double along = (x[0] - segment[0][0]) * d[0] + (x[1] - segment[0][1]) * d[1], square = d[0] * d[0] + d[1] * d[1];
    double s = square > 0 ? ax_clamp(along / square, 0, 1) : 0;
    const double foot[2] = {segment[0][0] + s * d[0], segment[0][1] + s * d[1]};
    return ax_distance2(x, foot);
}

// A point that turns about the origin by up to `sweep`, counter-clockwise.
typedef struct turning {
    double radius, start, sweep;
} turning;

static turning turning_of(const double x[2], const double pivot[2], double sweep)
{
    return (turning){ax_distance2(x, pivot), atan2(x[1] - pivot[1], x[0] - pivot[0]), sweep};
}

// Least distance from the turning point to a segment with ends relative to the pivot. It is taken at an end of the way, in line with
// an end of the segment or with its normal, or where the point crosses the segment's line.
static double turn_to_segment(const turning* p, const double segment[2][2])
{
    double d[2] = {segment[1][0] - segment[0][0], segment[1][1] - segment[0][1]}, length = hypot(d[0], d[1]);
    double normal = atan2(-d[0], d[1]), from_pivot = length > 0 ? ax_cross2(d, segment[0]) / -length : 0;
    double crossing = acos(ax_clamp(from_pivot / fmax(p->radius, 1e-300), -1, 1));
    const double angle[8] = {p->start,
                             p->start + p->sweep,
                             normal,
                             normal + AX_PI,
                             normal + crossing,
                             normal - crossing,
                             atan2(segment[0][1], segment[0][0]),
                             atan2(segment[1][1], segment[1][0])};
    double least = INFINITY;
    for (int k = 0; k < 8; ++k) {
        double turned = fmod(angle[k] - p->start + 6 * AX_PI, 2 * AX_PI);
        if (k > 1 && turned > p->sweep)
            continue;
        const double x[2] = {p->radius * cos(angle[k]), p->radius * sin(angle[k])};
        least = fmin(least, to_segment(x, segment));
    }
    return least;
}

// Least distance of two panels while `b` turns about `pivot` by `sweep`, away from `a`; negative by how far a disc enters.
static double sweep_distance(const region* a, const region* b, const double pivot[2], double sweep)
{
    double least = INFINITY;
    for (int i = 0; i < 3; ++i) {
        // b's disc turns; seen from b, a's disc turns the other way, which is the same way from its end on
        turning b_disc = turning_of(b->disc[i], pivot, sweep), a_disc = turning_of(a->disc[i], pivot, sweep);
        a_disc.start -= sweep;
        for (int k = 0; k < 3; ++k) {
            double edge[2][2][2], disc[2][2];
            for (int d = 0; d < 2; ++d) {
                for (int end = 0; end < 2; ++end) {
                    edge[0][end][d] = a->edge[k][end][d] - pivot[d];
                    edge[1][end][d] = b->edge[k][end][d] - pivot[d];
                }
                disc[0][d] = disc[1][d] = a->disc[k][d] - pivot[d];
            }
            least = fmin(least, turn_to_segment(&b_disc, (const double(*)[2])edge[0]) - b->radius);
            least = fmin(least, turn_to_segment(&a_disc, (const double(*)[2])edge[1]) - a->radius);
            least = fmin(least, turn_to_segment(&b_disc, (const double(*)[2])disc) - a->radius - b->radius);
        }
    }
    return least;
}

static bool cross(const double a[2][2], const double b[2][2])
{
    return ax_orient2(a[0], a[1], b[0]) * ax_orient2(a[0], a[1], b[1]) < 0 &&
           ax_orient2(b[0], b[1], a[0]) * ax_orient2(b[0], b[1], a[1]) < 0;
}

// Distance of two panels at rest; where edges cross, minus how far an end lies beyond the other edge.
static double rest_distance(const region* a, const region* b)
{
    double least = INFINITY, depth = 0;
    for (int i = 0; i < 3; ++i)
        for (int k = 0; k < 3; ++k) {
            const double(*e)[2] = a->edge[i], (*f)[2] = b->edge[k];
            least = fmin(least, to_segment(a->disc[i], f) - a->radius);
            least = fmin(least, to_segment(b->disc[i], a->edge[k]) - b->radius);
            least = fmin(least, ax_distance2(a->disc[i], b->disc[k]) - a->radius - b->radius);
            if (cross(e, f)) {
                double shallow = fmin(fmin(to_segment(e[0], f), to_segment(e[1], f)),
                                      fmin(to_segment(f[0], e), to_segment(f[1], e)));
                depth = fmax(depth, shallow);
            }
        }
    return depth > 0 ? fmin(least, -depth) : least;
}

// --- pairs of panels near each other

typedef struct cell_entry {
    long long cell[3];
    int panel;
} cell_entry;

static int by_cell(const void* a, const void* b)
{
    const cell_entry *x = a, *y = b;
    for (int d = 0; d < 3; ++d)
        if (x->cell[d] != y->cell[d])
            return x->cell[d] < y->cell[d] ? -1 : 1;
    return x->panel - y->panel;
}

typedef struct pairs {
    int count, room;
    int (*list)[2];
} pairs;

static void add_pair(pairs* p, int a, int b)
{
    if (p->count == p->room) {
        p->room = p->room ? 2 * p->room : 1024;
        p->list = ax_realloc(p->list, (size_t)p->room, sizeof *p->list);
    }
    p->list[p->count][0] = a < b ? a : b;
    p->list[p->count++][1] = a < b ? b : a;
}

// Pairs of spheres that come within `within` of each other, by cells as wide as the largest pair may reach.
static pairs near_pairs(int count, const double (*centre)[3], const double* radius, double within)
{
    pairs found = {0};
    double widest = 0;
    for (int i = 0; i < count; ++i)
        widest = fmax(widest, radius[i]);
    cell_entry* entries = AX_NEW(cell_entry, count);
    for (int i = 0; i < count; ++i) {
        entries[i].panel = i;
        for (int d = 0; d < 3; ++d)
            entries[i].cell[d] = (long long)floor(centre[i][d] / (2 * widest + within));
    }
    qsort(entries, (size_t)count, sizeof *entries, by_cell);
    // the 3 x 3 columns of cells around, in each of which the third coordinate runs; their starts move on with the entries
    for (int column = 0; column < 9; ++column)
        for (int i = 0, low = 0; i < count; ++i) {
            cell_entry lowest = entries[i];
            lowest.cell[0] += column / 3 - 1, lowest.cell[1] += column % 3 - 1, --lowest.cell[2];
            lowest.panel = -1;
            while (low < count && by_cell(&entries[low], &lowest) < 0)
                ++low;
            for (int j = low; j < count && entries[j].cell[0] == lowest.cell[0] &&
                              entries[j].cell[1] == lowest.cell[1] && entries[j].cell[2] <= lowest.cell[2] + 2;
                 ++j) {
                int a = entries[i].panel, b = entries[j].panel;
                if (a < b && ax_distance3(centre[a], centre[b]) < radius[a] + radius[b] + within)
                    add_pair(&found, a, b);
            }
        }
    ax_free(entries);
    return found;
}

static bool share_hinge(const ax_work* w, int a, int b)
{
    const int(*corner)[3] = (const int(*)[3])w->linkage->triangles;
    for (int i = 0; i < 9; ++i)
        if (corner[a][i / 3] == corner[b][i % 3])
            return true;
    return false;
}

// Spheres round the panels of a state, in mm.
static void bound_panels(const ax_work* w, const double (*places)[3], double (*centre)[3], double* radius)
{
    for (int t = 0; t < w->linkage->triangle_count; ++t) {
        const int* corner = w->linkage->triangles[t];
        for (int d = 0; d < 3; ++d)
            centre[t][d] = (places[corner[0]][d] + places[corner[1]][d] + places[corner[2]][d]) / 3;
        radius[t] = 0;
        for (int k = 0; k < 3; ++k)
            radius[t] = fmax(radius[t], ax_distance3(centre[t], places[corner[k]]));
        radius[t] += ax_panel_reach(&w->rule, w->plan->kerf / 2) + w->plan->material.thickness;
    }
}

// The places of a state in mm, seen from its first hinge so that nothing is lost far from the origin.
static double (*state_in_mm(const ax_work* w, const double (*places)[3]))[3]
{
    double mm = 1000 * ax_unit_in_metres(w->design->unit);
    double(*out)[3] = ax_alloc((size_t)w->linkage->hinge_count, sizeof *out);
    for (int h = 0; h < w->linkage->hinge_count; ++h)
        for (int d = 0; d < 3; ++d)
            out[h][d] = mm * (places  ? places[h][d] - places[0][d]
                              : d < 2 ? w->design->flat[h][d] - w->design->flat[0][d]
                                      : 0);
    return out;
}

static pairs near_in_state(const ax_work* w, const double (*places)[3], double within)
{
    int n = w->linkage->triangle_count;
    double(*centre)[3] = ax_alloc((size_t)n, sizeof *centre), *radius = AX_NEW(double, n);
    bound_panels(w, places, centre, radius);
    pairs found = near_pairs(n, (const double(*)[3])centre, radius, within);
    ax_free(centre);
    ax_free(radius);
    return found;
}

double ax_flat_clearance(const ax_work* w, double within)
{
    double(*places)[3] = state_in_mm(w, NULL), least = within;
    pairs near = near_in_state(w, (const double(*)[3])places, within);
    for (int i = 0; i < near.count; ++i) {
        region a = region_of(w, near.list[i][0]), b = region_of(w, near.list[i][1]);
        double distance = rest_distance(&a, &b);
        least = fmin(least, share_hinge(w, near.list[i][0], near.list[i][1]) && fabs(distance) < 1e-6 ? 0 : distance);
    }
    ax_free(near.list);
    ax_free(places);
    return least;
}

// --- clashes

static const double touching = 1e-3; // mm, less than anything that is cut can tell

static void add_clash(ax_cut_plan* plan, const ax_cut_clash* clash)
{
    ++plan->clashes_found;
    if (!plan->clashes)
        plan->clashes = AX_NEW(ax_cut_clash, AX_CLASHES);
    if (plan->clash_count < AX_CLASHES)
        plan->clashes[plan->clash_count++] = *clash;
}

// --- hinges

static double opening_angle(const double (*places)[3], const int mouth[3])
{
    double a[3], b[3], c[3];
    ax_sub3(places[mouth[0]], places[mouth[1]], a);
    ax_sub3(places[mouth[2]], places[mouth[1]], b);
    ax_cross(a, b, c);
    return atan2(ax_norm3(c), ax_dot3(a, b));
}

// The panel that holds two hinges.
static int panel_between(const ax_work* w, int a, int b)
{
    for (int side = 0; side < 2; ++side) {
        int t = w->held[a][side];
        if (t >= 0)
            for (int k = 0; k < 3; ++k)
                if (w->linkage->triangles[t][k] == b)
                    return t;
    }
    return -1;
}

// The smaller of the two openings at each hinge between two panels.
static void find_mouths(ax_work* w, int (*mouth)[3])
{
    ax_cut_plan* plan = w->plan;
    int count, (*all)[3] = ax_linkage_mouths(w->linkage, &count);
    int* place = AX_NEW(int, w->linkage->hinge_count);
    memset(place, -1, (size_t)w->linkage->hinge_count * sizeof *place);
    plan->hinges = AX_NEW0(ax_cut_hinge, count / 2 + 1);
    for (int m = 0; m < count; ++m) {
        int h = all[m][1];
        double angle = ax_mouth_angle(w->flat[all[m][0]], w->flat[h], w->flat[all[m][2]]);
        if (place[h] < 0) {
            place[h] = plan->hinge_count++;
            plan->hinges[place[h]] =
                (ax_cut_hinge){.hinge = h, .seam = w->seam[h], .mouth = INFINITY, .clearance = NAN, .force = NAN};
        }
        ax_cut_hinge* hinge = &plan->hinges[place[h]];
        if (angle < hinge->mouth) {
            hinge->mouth = angle;
            hinge->panels[0] = panel_between(w, all[m][2], h);
            hinge->panels[1] = panel_between(w, all[m][0], h);
            memcpy(mouth[place[h]], all[m], sizeof *mouth);
        }
    }
    ax_free(place);
    ax_free(all);
}

typedef struct sweeping {
    const ax_work* w;
    const int (*mouth)[3];
    ax_cut_hinge* hinges;
} sweeping;

// From the flat mouth to the widest of the states, at least to 120 degrees, where a linkage is fully open in the plane.
static void sweep_hinge(void* context, int i)
{
    const sweeping* s = context;
    ax_cut_hinge* hinge = &s->hinges[i];
    const ax_design* d = s->w->design;
    double open = fmax(2 * AX_PI / 3, opening_angle((const double(*)[3])d->deployed, s->mouth[i]));
    if (d->simulated)
        open = fmax(open, opening_angle((const double(*)[3])d->simulated, s->mouth[i]));
    region a = region_of(s->w, hinge->panels[0]), b = region_of(s->w, hinge->panels[1]);
    hinge->clearance = sweep_distance(&a, &b, s->w->flat[hinge->hinge], fmax(0, open - hinge->mouth));
    if (fabs(hinge->clearance) < 1e-6) // bare corners touch at the hinge all the way
        hinge->clearance = 0;
}

static void name_hinge_clashes(ax_work* w)
{
    for (int i = 0; i < w->plan->hinge_count; ++i) {
        const ax_cut_hinge* h = &w->plan->hinges[i];
        if (h->clearance < -touching)
            add_clash(w->plan, &(ax_cut_clash){.panels = {h->panels[0], h->panels[1]},
                                               .hinge = h->hinge,
                                               .angle = h->mouth,
                                               .frame = -1,
                                               .opening = NAN,
                                               .overlap = -h->clearance});
    }
}

static void set_forces(ax_work* w)
{
    const ax_design* d = w->design;
    const struct ax_joint_work* work = w->plan->joint->work;
    double rated = work->rated ? work->rated(&w->joint) : NAN;
    for (int i = 0; i < w->plan->hinge_count; ++i) {
        ax_cut_hinge* h = &w->plan->hinges[i];
        h->rated = rated;
        if (!d->simulated)
            continue;
        h->force = 0;
        for (int side = 0; side < 2; ++side) {
            double f[3];
            int t = h->panels[side], k = 0;
            while (w->linkage->triangles[t][k] != h->hinge)
                ++k;
            ax_measure_corner_force(w->linkage, (const double(*)[3])d->simulated, (const double(*)[3])d->edge_forces, t,
                                    k, f);
            h->force = fmax(h->force, ax_norm3(f));
        }
    }
}

// --- panels in space, as convex prisms

enum { CORNERS = 12 };
typedef struct prism {
    double at[2][CORNERS][3]; // lower and upper face
    double normal[3];
    int count;
} prism;

// The outline's convex hull on the panel's plane in a state; arcs are replaced by two tangents each, which lie outside.
static prism prism_of(const ax_work* w, const double (*places)[3], int t)
{
    const int* corner = w->linkage->triangles[t];
    const double *p0 = w->flat[corner[0]], *p1 = w->flat[corner[1]];
    ax_panel_outline o = ax_work_outline(w, t, 0);
    double flat[CORNERS][2], e[3], f[3], side[3], length = ax_distance2(p0, p1);
    prism out = {0};
    for (int k = 0; k < 3; ++k) {
        const ax_panel_corner* c = &o.corner[k];
        if (o.radius <= 0) {
            memcpy(flat[out.count++], c->enter, sizeof *flat);
            continue;
        }
        // ears are wider than the hull's corner: begin where the disc leaves the hull's edges
        double sweep = fmin(c->sweep, 2 * AX_PI / 3),
               middle[2] = {(c->enter[0] + c->leave[0]) / 2 - c->disc[0], (c->enter[1] + c->leave[1]) / 2 - c->disc[1]};
        if (c->sweep > AX_PI) // the chord lies behind the disc's centre
            middle[0] = -middle[0], middle[1] = -middle[1];
        double mid = atan2(middle[1], middle[0]);
        for (int i = 0; i < 4; ++i) {
            double angle = mid + sweep * (i - 1.5) / 3, reach = o.radius / cos(sweep / 6);
            flat[out.count][0] = c->disc[0] + reach * cos(angle);
            flat[out.count++][1] = c->disc[1] + reach * sin(angle);
        }
    }
    ax_sub3(places[corner[1]], places[corner[0]], e);
    ax_sub3(places[corner[2]], places[corner[0]], side);
    ax_cross(e, side, out.normal);
    double scale = ax_norm3(e), area = ax_norm3(out.normal);
    for (int d = 0; d < 3; ++d)
        e[d] /= scale, out.normal[d] /= area;
    ax_cross(out.normal, e, f);
    double low = w->plan->joint->two_layers ? w->plan->panels[t].layer - 1 : -0.5;
    for (int i = 0; i < out.count; ++i) {
        double dx = flat[i][0] - p0[0], dy = flat[i][1] - p0[1];
        double u = (dx * (p1[0] - p0[0]) + dy * (p1[1] - p0[1])) / length,
               v = (dy * (p1[0] - p0[0]) - dx * (p1[1] - p0[1])) / length;
        for (int face = 0; face < 2; ++face)
            for (int d = 0; d < 3; ++d)
                out.at[face][i][d] = places[corner[0]][d] + u * e[d] + v * f[d] +
                                     (low + face) * w->plan->material.thickness * out.normal[d];
    }
    return out;
}

static void project(const prism* p, const double axis[3], double* lo, double* hi)
{
    *lo = INFINITY, *hi = -INFINITY;
    for (int face = 0; face < 2; ++face)
        for (int i = 0; i < p->count; ++i) {
            double x = ax_dot3(p->at[face][i], axis);
            *lo = fmin(*lo, x), *hi = fmax(*hi, x);
        }
}

// Overlap along an axis, in units of length; an axis without direction separates nothing.
static double overlap_along(const prism* a, const prism* b, const double axis[3])
{
    double length = ax_norm3(axis), lo[2], hi[2];
    if (length < 1e-9)
        return INFINITY;
    project(a, axis, &lo[0], &hi[0]);
    project(b, axis, &lo[1], &hi[1]);
    return fmin(hi[0] - lo[1], hi[1] - lo[0]) / length;
}

static void edge_of(const prism* p, int i, double out[3])
{
    ax_sub3(p->at[0][(i + 1) % p->count], p->at[0][i], out);
    double length = ax_norm3(out);
    for (int d = 0; d < 3; ++d)
        out[d] /= length > 0 ? length : 1;
}

// Depth by which two prisms overlap, by their separating axes; at most 0 where they do not. Axes that mostly separate come first.
static double prism_overlap(const prism* a, const prism* b)
{
    double least = fmin(overlap_along(a, b, a->normal), overlap_along(a, b, b->normal)), axis[3], edge[2][3];
    for (int side = 0; side < 2 && least > 0; ++side) {
        const prism* p = side ? b : a;
        for (int i = 0; i < p->count && least > 0; ++i) {
            edge_of(p, i, edge[0]);
            ax_cross(edge[0], p->normal, axis);
            least = fmin(least, overlap_along(a, b, axis));
        }
    }
    for (int i = 0; i <= a->count && least > 0; ++i)
        for (int k = 0; k <= b->count && least > 0; ++k) {
            if (i < a->count)
                edge_of(a, i, edge[0]);
            else
                memcpy(edge[0], a->normal, sizeof edge[0]);
            if (k < b->count)
                edge_of(b, k, edge[1]);
            else
                memcpy(edge[1], b->normal, sizeof edge[1]);
            ax_cross(edge[0], edge[1], axis);
            least = fmin(least, overlap_along(a, b, axis));
        }
    return least;
}

typedef struct colliding {
    const ax_work* w;
    const double (*places)[3];
    const pairs* near;
    double* overlap;
} colliding;

static void collide_pair(void* context, int i)
{
    const colliding* c = context;
    int a = c->near->list[i][0], b = c->near->list[i][1];
    const ax_panel_rule* rule = &c->w->rule;
    bool apart = !c->w->plan->joint->one_piece && !c->w->plan->joint->two_layers && rule->inset > 0;
    c->overlap[i] = 0;
    // panels that are made to touch at their hinge are not held against each other there
    if (!apart && share_hinge(c->w, a, b))
        return;
    prism p = prism_of(c->w, c->places, a), q = prism_of(c->w, c->places, b);
    c->overlap[i] = prism_overlap(&p, &q);
}

// Calls `found` for pairs that overlap by more than `allowed` mm in a state.
static void check_state(ax_work* w, ax_pool* pool, const double (*state)[3], double allowed,
                        void (*found)(void* context, const int pair[2], double overlap), void* context)
{
    double(*places)[3] = state_in_mm(w, state);
    pairs near = near_in_state(w, (const double(*)[3])places, 0);
    colliding c = {w, (const double(*)[3])places, &near, AX_NEW(double, near.count + 1)};
    ax_pool_run(pool, collide_pair, &c, near.count);
    for (int i = 0; i < near.count; ++i)
        if (c.overlap[i] > allowed)
            found(context, near.list[i], c.overlap[i]);
    ax_free(c.overlap);
    ax_free(near.list);
    ax_free(places);
}

typedef struct naming {
    ax_cut_plan* plan;
    int frame;
} naming;

static void name_clash(void* context, const int pair[2], double overlap)
{
    const naming* n = context;
    add_clash(n->plan, &(ax_cut_clash){.panels = {pair[0], pair[1]},
                                       .hinge = -1,
                                       .angle = NAN,
                                       .frame = n->frame,
                                       .opening = NAN,
                                       .overlap = overlap});
}

// --- the way from flat to open

typedef struct meeting {
    int panels[2];
    double opening, overlap;
} meeting;

typedef struct meetings {
    int count, room;
    meeting* list;
    double opening; // of the state at hand
} meetings;

static void keep_meeting(void* context, const int pair[2], double overlap)
{
    meetings* m = context;
    if (m->count == m->room) {
        m->room = 2 * m->room + 64;
        m->list = ax_realloc(m->list, (size_t)m->room, sizeof *m->list);
    }
    m->list[m->count++] = (meeting){{pair[0], pair[1]}, m->opening, overlap};
}

static int by_pair_then_depth(const void* a, const void* b)
{
    const meeting *x = a, *y = b;
    for (int side = 0; side < 2; ++side)
        if (x->panels[side] != y->panels[side])
            return x->panels[side] - y->panels[side];
    return (x->overlap < y->overlap) - (x->overlap > y->overlap);
}

// Every pair once, where it overlaps most.
static void name_meetings(ax_cut_plan* plan, meetings* m)
{
    if (m->count)
        qsort(m->list, (size_t)m->count, sizeof *m->list, by_pair_then_depth);
    for (int i = 0; i < m->count; ++i) {
        const meeting *at = &m->list[i], *before = at - (i > 0);
        if (i == 0 || memcmp(at->panels, before->panels, sizeof at->panels) != 0)
            add_clash(plan, &(ax_cut_clash){.panels = {at->panels[0], at->panels[1]},
                                            .hinge = -1,
                                            .angle = NAN,
                                            .frame = 3,
                                            .opening = at->opening,
                                            .overlap = at->overlap});
    }
}

// False if cancelled. States whose panels do not stay rigid prove nothing and are not counted.
static bool check_way(ax_work* w, ax_pool* pool, const ax_progress* progress)
{
    static const double most_error = 1e-3;
    int count = w->options->frames;
    double mm = 1000 * ax_unit_in_metres(w->design->unit), edge = mm * w->design->report.edge_max;
    ax_way* way = ax_way_make(w->design, pool);
    meetings met = {0};
    bool go_on = true;
    w->plan->frames = AX_NEW0(ax_cut_frame, count + 1);
    w->plan->simulated_way = w->design->simulated != NULL;
    for (int k = 1; k <= count && go_on; ++k) {
        ax_progress_part slot;
        ax_way_state state;
        met.opening = (double)k / (count + 1);
        go_on = ax_progress_report(progress, "Proving clearance on the way", (double)(k - 1) / count, NAN) &&
                ax_way_at(way, met.opening,
                          ax_progress_within(&slot, progress, (double)(k - 1) / count, (double)k / count), &state);
        if (!go_on)
            break;
        ax_cut_frame* frame = &w->plan->frames[w->plan->frame_count++];
        *frame = (ax_cut_frame){.opening = met.opening,
                                .strain = state.strain,
                                .moved = mm * state.moved,
                                .error = state.error,
                                .checked = state.error <= most_error};
        if (!frame->checked)
            continue;
        int before = met.count;
        ++w->plan->frames_checked;
        w->plan->frame_error = fmax(w->plan->frame_error, state.error * edge);
        check_state(w, pool, state.places, touching + state.error * edge, keep_meeting, &met);
        frame->clashes = met.count - before;
    }
    name_meetings(w->plan, &met);
    ax_free(met.list);
    ax_way_free(way);
    return go_on;
}

// In the flat state panels of one layer that share no hinge.
static void check_flat(ax_work* w)
{
    double(*places)[3] = state_in_mm(w, NULL);
    pairs near = near_in_state(w, (const double(*)[3])places, 0);
    for (int i = 0; i < near.count; ++i) {
        int a = near.list[i][0], b = near.list[i][1];
        if (w->plan->panels[a].layer != w->plan->panels[b].layer || share_hinge(w, a, b))
            continue;
        region p = region_of(w, a), q = region_of(w, b);
        double distance = rest_distance(&p, &q);
        if (distance < -touching)
            add_clash(
                w->plan,
                &(ax_cut_clash){
                    .panels = {a, b}, .hinge = -1, .angle = NAN, .frame = 0, .opening = NAN, .overlap = -distance});
    }
    ax_free(near.list);
    ax_free(places);
}

static void panel_normal(const int* hinges, const double (*x)[3], double normal[3])
{
    double a[3], b[3];
    ax_sub3(x[hinges[1]], x[hinges[0]], a);
    ax_sub3(x[hinges[2]], x[hinges[0]], b);
    ax_cross(a, b, normal);
}

static void count_folds(ax_work* w)
{
    const ax_design* d = w->design;
    ax_cut_plan* plan = w->plan;
    const double(*x)[3] = (const double(*)[3])(d->simulated ? d->simulated : d->deployed);
    plan->folds = 0, plan->fold[0] = plan->fold[1] = -1;
    for (int i = 0; i < plan->hinge_count; ++i) {
        const int* pair = plan->hinges[i].panels;
        double a[3], b[3];
        panel_normal(w->linkage->triangles[pair[0]], x, a);
        panel_normal(w->linkage->triangles[pair[1]], x, b);
        if (ax_dot3(a, b) < 0 && plan->folds++ == 0)
            memcpy(plan->fold, pair, sizeof plan->fold);
    }
}

ax_status ax_prove_clearance(ax_work* w, const ax_progress* progress, ax_error* error)
{
    const ax_design* d = w->design;
    const ax_joint_type* joint = w->plan->joint;
    int(*mouth)[3] = ax_alloc((size_t)w->linkage->hinge_count, sizeof *mouth);
    find_mouths(w, mouth);
    set_forces(w);
    count_folds(w);
    bool go_on = true;
    if (w->options->clearance) {
        ax_pool* pool = ax_pool_make(0);
        go_on = ax_progress_report(progress, "Proving clearance at the hinges", 0.4, NAN);
        if (!joint->one_piece && !joint->two_layers && go_on) {
            sweeping s = {w, (const int(*)[3])mouth, w->plan->hinges};
            ax_pool_run(pool, sweep_hinge, &s, w->plan->hinge_count);
            name_hinge_clashes(w);
        }
        if (go_on)
            check_flat(w);
        go_on = go_on && ax_progress_report(progress, "Proving clearance of the open panels", 0.6, NAN);
        if (go_on)
            check_state(w, pool, (const double(*)[3])d->deployed, touching, name_clash, &(naming){w->plan, 1});
        if (go_on && d->simulated)
            check_state(w, pool, (const double(*)[3])d->simulated, touching, name_clash, &(naming){w->plan, 2});
        ax_progress_part slot;
        go_on = go_on && check_way(w, pool, ax_progress_within(&slot, progress, 0.65, 1));
        ax_pool_free(pool);
    }
    ax_free(mouth);
    return go_on ? AX_OK : ax_fail(error, AX_CANCELLED, "Cancelled while proving clearance.");
}
