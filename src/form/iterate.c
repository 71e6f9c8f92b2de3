// Iterations of both states, and what moves between them: a hole's sides, the sizes of the panels under load, where the rim has slid to.
#include "form/state.h"

#include "base/vec.h"

#include <math.h>
#include <string.h>

enum { RESIZE_EVERY = 25 };

// A turn, a growth and a shift of the plane: from + x goes to to + (re + i im) x.
typedef struct similarity {
    double from[2], to[2], re, im, growth;
} similarity;

// That which brings the sheet's panel centres nearest to the flat state's, grown only if collisions may grow it.
static similarity fit_sheet(const ax_form* f)
{
    const ax_linkage* linkage = &f->lattice.linkage;
    int t = linkage->triangle_count;
    similarity s = {.from = {f->centre[0], f->centre[1]}};
    double norm = 0, (*centres)[2] = (double(*)[2])f->lanes;
    for (int k = 0; k < t; ++k)
        for (int c = 0; c < 2; ++c) {
            const int* h = linkage->triangles[k];
            centres[k][c] = (f->flat[h[0]][c] + f->flat[h[1]][c] + f->flat[h[2]][c]) / 3;
            s.to[c] += centres[k][c] / t;
        }
    for (int k = 0; k < t; ++k) {
        double x = centres[k][0] - s.to[0], y = centres[k][1] - s.to[1];
        double u = f->centres[k][0] - f->centre[0], v = f->centres[k][1] - f->centre[1];
        s.re += u * x + v * y, s.im += u * y - v * x, norm += u * u + v * v;
    }
    s.re /= norm, s.im /= norm;
    double fit = sqrt(s.re * s.re + s.im * s.im);
    s.growth = f->dynamics.collisions ? fmax(1, fit) : 1;
    double grown = fit > 0 ? s.growth / fit : 1;
    s.re = fit > 0 ? s.re * grown : 1, s.im *= grown;
    return s;
}

static void carry(const similarity* s, const double x[2], double to[2])
{
    double u = x[0] - s->from[0], v = x[1] - s->from[1];
    to[0] = s->to[0] + s->re * u - s->im * v, to[1] = s->to[1] + s->im * u + s->re * v;
}

void ax_form_flat_places(const ax_form* f, int count, const int* hinges, double (*places)[2])
{
    similarity s = fit_sheet(f);
    for (int k = 0; k < count; ++k)
        carry(&s, f->lattice.hinges[hinges[k]], places[k]);
}

// The sheet's panel centres where the flat state has them: the targets that choose among the sheet's many flat states the one whose scale
// factors are the prescribed ones.
static void aim_centres(ax_form* f)
{
    similarity s = fit_sheet(f);
    f->growth = s.growth;
    for (int k = 0; k < f->lattice.linkage.triangle_count; ++k) {
        carry(&s, f->centres[k], f->lanes + 3 * k);
        f->lanes[3 * k + 2] = 0;
    }
    ax_solver_set_all(f->shape, f->shape_groups.centres, 0, 3, f->lanes);
}

// Sizes of the panels: shared by both states where they are, else as prescribed.
void ax_form_measure_sides(ax_form* f)
{
    const ax_linkage* linkage = &f->lattice.linkage;
    bool shares = ax_form_shares(f);
    for (int t = 0; t < linkage->triangle_count; ++t)
        for (int k = 0; k < 3; ++k) {
            int a = linkage->triangles[t][(k + 1) % 3], b = linkage->triangles[t][(k + 2) % 3];
            f->side[t][k] =
                shares ? 0.5 * (ax_distance2(f->flat[a], f->flat[b]) + ax_distance3(f->deployed[a], f->deployed[b]))
                       : ax_form_edge(f, t, k);
        }
}

// What the shape's panels are to be.
static void size_panels(ax_form* f)
{
    bool shares = ax_form_shares(f);
    int lanes = shares ? 1 : 3,
        first = shares ? ax_form_lane("shared_panel", "side") : ax_form_lane("flat_triangle", "lengths");
    for (int k = 0; k < lanes * f->lattice.linkage.triangle_count; ++k)
        f->lanes[k] = shares ? f->panel[k].size * ax_form_side(f, k) : ax_form_edge(f, k / 3, k % 3);
    ax_solver_set_all(f->shape, f->shape_groups.panels, first, lanes, f->lanes);
}

// A hole's sides are those of its panels, flat and deployed alike.
static void size_holes(ax_form* f)
{
    const ax_linkage* linkage = &f->lattice.linkage;
    for (int k = 0; k < f->hole_count; ++k) {
        const int* h = linkage->hole_hinges + linkage->hole_start[f->holes[k]];
        for (int i = 0; i < 6; ++i) {
            int a = h[i], b = h[(i + 1) % 6];
            f->lanes[6 * k + i] =
                0.5 * (ax_distance2(f->flat[a], f->flat[b]) + ax_distance3(f->deployed[a], f->deployed[b]));
        }
    }
    ax_solver_set_all(f->shape, f->shape_groups.holes, ax_form_lane("cyclic_polygon", "sides"), 6, f->lanes);
}

static void put_states(ax_form* f)
{
    int n = f->lattice.linkage.hinge_count;
    for (int h = 0; h < n; ++h)
        f->scratch[h][0] = f->flat[h][0], f->scratch[h][1] = f->flat[h][1], f->scratch[h][2] = 0;
    if (ax_form_shares(f))
        memcpy(f->scratch + n, f->deployed, (size_t)n * sizeof *f->deployed);
    ax_solver_set_places(f->shape, (const double(*)[3])f->scratch);
}

static void take_states(ax_form* f)
{
    int n = f->lattice.linkage.hinge_count;
    ax_solver_get_places(f->shape, f->scratch);
    double most = 0;
    for (int h = 0; h < n; ++h)
        for (int c = 0; c < 2; ++c) {
            most = fmax(most, fabs(f->scratch[h][c] - f->flat[h][c]));
            f->flat[h][c] = f->scratch[h][c];
        }
    if (ax_form_shares(f))
        for (int h = 0; h < n; ++h)
            for (int c = 0; c < 3; ++c) {
                most = fmax(most, fabs(f->scratch[n + h][c] - f->deployed[h][c]));
                f->deployed[h][c] = f->scratch[n + h][c];
            }
    f->scaled_step = most / f->lattice.spacing;
}

// Between a painted dome and a rim with too little room for it what is left over opens to either side with equal ease, and as fairness has it,
// against the load. So the load leans on the open sheet, in one direction and spread as panels are large: all of it while a fresh sheet opens,
// later a little, where the rim is held all the way round. Sizes give way to that by one or two in a hundred; a sheet that has just the room to lie flat
// would bulge by nothing else, so the less it bulges the less leans on it.
static const double kept_lean = 0.07, full_bulge = 0.15;

bool ax_form_held_all_round(const ax_form* f)
{
    int loose = 0;
    for (int h = 0; h < f->lattice.linkage.hinge_count; ++h)
        loose += f->lattice.linkage.on_rim[h];
    for (int k = 0; k < f->rim_count; ++k)
        loose -= f->rim[k].kind != AX_RIM_FREE ? f->rim[k].count : 0;
    return loose == 0 && ax_form_may_fold(f);
}

// `bulge`: by how much the sheet's area is more than its shadow's, over the former.
static double lean_share(const ax_form* f, double bulge)
{
    return f->opens ? 1 : ax_form_held_all_round(f) ? kept_lean * fmin(1, bulge / full_bulge) : 0;
}

static void lean(ax_form* f)
{
    const ax_linkage* linkage = &f->lattice.linkage;
    int n = linkage->hinge_count;
    double along[3] = {0, 0, 0}, area = 0;
    for (int t = 0; t < linkage->triangle_count; ++t) {
        double normal[3];
        ax_form_panel_normal(f, t, (const double(*)[3])f->deployed, normal);
        area += ax_norm3(normal);
        for (int c = 0; c < 3; ++c)
            along[c] += normal[c];
    }
    double bulge = area > 0 ? 1 - ax_norm3(along) / area : 0;
    if (f->dynamics.kind == AX_DYNAMICS_GRAVITY)
        memcpy(along, f->dynamics.load.direction, sizeof along);
    double length = ax_norm3(along), force = length > 0 ? lean_share(f, bulge) * ax_form_load_per_area(f) / length : 0;
    memset(f->scratch, 0, 2 * (size_t)n * sizeof *f->scratch);
    for (int t = 0; t < linkage->triangle_count; ++t) {
        double side = ax_form_side(f, t), share = sqrt(3) * side * side / 3; // it carries four times its area
        for (int k = 0; k < 3; ++k)
            for (int c = 0; c < 3; ++c)
                f->scratch[n + linkage->triangles[t][k]][c] += force * share * along[c];
    }
    ax_solver_set_load(f->shape, (const double(*)[3])f->scratch);
}

void ax_form_iterate_shape(ax_form* f, int iterations)
{
    if (ax_form_hangs(f) && ax_form_shares(f))
        lean(f);
    put_states(f);
    size_panels(f);
    ax_solver_prepare(f->shape);
    for (int k = 0; k < iterations; ++k) {
        if (k % RESIZE_EVERY == 0 && ax_form_shares(f) && f->hole_count)
            size_holes(f);
        aim_centres(f);
        ax_solver_iterate(f->shape, 1);
        take_states(f);
    }
}

// A frame is built as designed. Were its hinges to slide under the load too, the sheet would turn in any rim that is nearly round,
// by next to no force and for thousands of iterations.
static void hold_rim(ax_form* f)
{
    for (int k = 0; k < f->rim_count && ax_form_shares(f); ++k) {
        const ax_rim_part* part = f->rim + k;
        if (part->kind != AX_RIM_SLIDE || part->count == 0)
            continue;
        for (int i = 0; i < part->count; ++i)
            memcpy(f->scratch[i], f->deployed[part->hinges[i]], sizeof *f->scratch);
        ax_solver_set_all(f->hang, f->hang_groups.rim[k], 0, 3, *f->scratch);
    }
}

void ax_form_iterate_hang(ax_form* f, int iterations)
{
    int n = f->lattice.linkage.hinge_count;
    ax_form_measure_sides(f);
    ax_solver_set_all(f->hang, f->hang_groups.panels, ax_form_lane("rigid_triangle", "lengths"), 3, f->side[0]);
    hold_rim(f);
    if (f->dynamics.kind == AX_DYNAMICS_GRAVITY) { // the weight is that of the flat sheet
        for (int h = 0; h < n; ++h)
            f->scratch[h][0] = f->flat[h][0], f->scratch[h][1] = f->flat[h][1], f->scratch[h][2] = 0;
        ax_solver_measure_load(f->hang, f->load, (const double(*)[3])f->scratch);
    }
    ax_solver_set_places(f->hang, (const double(*)[3])f->simulated);
    ax_solver_prepare(f->hang);
    for (int k = 0; k < iterations; ++k) {
        if (k == iterations - 1)
            ax_solver_get_places(f->hang, f->scratch);
        ax_solver_iterate(f->hang, 1);
    }
    ax_solver_get_places(f->hang, f->simulated);
    for (int h = 0; h < n; ++h)
        for (int c = 0; c < 3; ++c)
            f->scaled_step = fmax(f->scaled_step, fabs(f->simulated[h][c] - f->scratch[h][c]) / f->lattice.spacing);
    if (!ax_form_shares(f))
        memcpy(f->deployed, f->simulated, (size_t)n * sizeof *f->deployed);
}

void ax_form_iterate(ax_form* f, int iterations)
{
    ax_form_build(f);
    ax_form_iterate_shape(f, iterations);
    if (ax_form_hangs(f))
        ax_form_iterate_hang(f, iterations);
    else
        ax_form_measure_sides(f);
    f->iterations += iterations;
    if (f->drag > 0)
        ax_form_dragged(f, iterations);
    f->exact = f->settled = false;
    ++f->revision;
}

void ax_form_restart(ax_form* f, double height)
{
    ax_form_free(f->coarser);
    f->coarser = NULL;
    ax_form_let_go(f);
    ax_form_open(f, height);
}

void ax_form_open(ax_form* f, double height)
{
    int n = f->lattice.linkage.hinge_count;
    ax_form_stand stand;
    ax_form_stand_on(f, &stand);
    bool hangs = ax_form_hangs(f), weight = f->dynamics.kind == AX_DYNAMICS_GRAVITY;
    double side = hangs ? (weight ? ax_dot3(f->dynamics.load.direction, stand.axis[2]) : 1) : ax_form_bulge(f);
    for (int h = 0; h < n; ++h) {
        double r = ax_distance2(f->lattice.hinges[h], f->centre) / f->radius;
        double bulge = height * f->radius * fmax(0, 1 - r * r) * (side < 0 ? -1 : 1);
        double x = f->flat[h][0] - stand.from[0], y = f->flat[h][1] - stand.from[1];
        for (int c = 0; c < 3; ++c)
            f->deployed[h][c] = f->simulated[h][c] =
                stand.to[c] + x * stand.axis[0][c] + y * stand.axis[1][c] + bulge * stand.axis[2][c];
    }
    ax_form_changed(f, false, true);
}
