// The two projective solvers of a form, and what moves between them.
//
// Shape: flat and deployed hinges in one system, tied by shared panels; mouths and panel centres hold the flat state, open holes,
// fair kagome lines, rim and constraints the deployed one. Hang: the deployed hinges under load with panels of the sizes that
// the shape has, so that what is soft in the one is rigid in the other. Panels, mouths, rim and constraints carry multipliers.
#include "form/state.h"

#include "base/vec.h"

#include <assert.h>
#include <math.h>
#include <string.h>

// Weights, with panels at 1. docs/form-finding.md tells how each was found.
static const double hole_weight = 0.1, fair_weight = 0.1, held_fair_weight = 0.02, hang_fair_weight = 0.005,
                    bend_weight = 0.01, held_bend_weight = 0.002, hang_bend_weight = 0.003, wide_weight = 0.01,
                    hang_wide_weight = 0.005, rim_weight = 0.3, hang_rim_weight = 1, centre_weight = 0.3,
                    proximal = 1e-5, load_strain = 0.1, multiplier_cap = 2;
static const double border_lo = 0.6, border_hi = 1.4, border_skew = 0.35;
enum {
    RESIZE_EVERY = 25,
    FRESH_ITERATIONS = 100,
    FLAT_ITERATIONS = 400,
    SHAPE_ITERATIONS = 650,
    LOAD_ITERATIONS = 400,
    MOST_ITERATIONS = 2000,
    REST_CHECK = 25
};
static const double rest_error = 1e-4, rest_step = 1e-5, near_error = 1e-3, good_error = 5e-3;
static const char loading[] = "Loading the sheet";

void ax_form_drop_solvers(ax_form* f)
{
    if (f->stale && !f->shape)
        return;
    ax_solver_free(f->shape);
    ax_solver_free(f->hang);
    f->shape = f->hang = NULL;
    ax_free(f->shape_groups.rim);
    ax_free(f->shape_groups.held);
    ax_free(f->hang_groups.rim);
    ax_free(f->hang_groups.held);
    f->shape_groups = f->hang_groups = (ax_form_groups){0};
    for (int k = 0; k < f->rim_holders; ++k)
        ax_curve_free(f->rim_holder[k].curve);
    for (int k = 0; k < f->held_holders; ++k) {
        ax_curve_free(f->held_holder[k].curve);
        ax_closest_free(f->held_holder[k].surface);
    }
    ax_free(f->rim_holder);
    ax_free(f->held_holder);
    f->rim_holder = f->held_holder = NULL;
    f->rim_holders = f->held_holders = 0;
    f->stale = true;
}

static const ax_constraint_type* type_of(const char* name)
{
    const ax_constraint_type* type = ax_constraint_find(name);
    assert(type);
    return type;
}

static int lane_of(const char* type, const char* parameter)
{
    return ax_parameter_find(type_of(type), parameter)->offset;
}

// A group on `count` sets of `each` hinges; hinge h is point h + first of the solver.
static int add(ax_solver* s, const char* type, int each, int count, const int* hinges, int first, double weight,
               const ax_place* place)
{
    if (count == 0)
        return -1;
    size_t total = (size_t)each * (size_t)count;
    int* points = AX_NEW(int, total);
    for (size_t k = 0; k < total; ++k)
        points[k] = hinges[k] + first;
    int group = ax_solver_add(s, type_of(type), each, count, points, weight, place);
    ax_free(points);
    return group;
}

// Fair rows: `near` of neighbours, `bend` of three, and `wide` of every second hinge, which slack holes do not bend as they make kagome
// lines zigzag. The last one is the stiffness of a length of the design, not of a panel: without, finer sheets fold more finely where
// there is too much of them. Third differences are a^3 of those of the surface, a the spacing, and 1 / a^2 in number: weights that
// grow with a^-4, the square of the number of panels, mean the same at every size. `wide` is that of 600 panels, and grows with
// the power `growth` of their number.
typedef struct fair_rows {
    int points, count;
    const int* hinges;
    double weight;
} fair_rows;

enum { FAIR_KINDS = 3 };

static void list_fairness(const ax_form* f, double near, double bend, double wide, double growth,
                          fair_rows rows[FAIR_KINDS])
{
    wide *= f->wide_share * pow(ax_form_fineness(f), growth);
    rows[0] = (fair_rows){4, f->line_count, (const int*)f->lines, near};
    rows[1] = (fair_rows){3, f->bend_count, (const int*)f->bends, bend};
    rows[2] = (fair_rows){4, wide > 0 ? f->wide_count : 0, (const int*)f->wide, wide};
}

static void add_fairness(ax_solver* s, int first, const fair_rows rows[FAIR_KINDS])
{
    for (int k = 0; k < FAIR_KINDS; ++k) {
        int group = add(s, "fairness", rows[k].points, rows[k].count, rows[k].hinges, first, rows[k].weight, NULL);
        if (group >= 0)
            ax_solver_set_soft(s, group, true);
    }
}

// What is fair under load.
static void list_hang_fairness(const ax_form* f, fair_rows rows[FAIR_KINDS])
{
    list_fairness(f, hang_fair_weight, hang_bend_weight, hang_wide_weight, 2, rows);
}

void ax_form_keep_fair(const ax_form* f, ax_deploy_model* model, double scale)
{
    const ax_constraint_type* type = type_of("fairness");
    fair_rows rows[FAIR_KINDS];
    list_hang_fairness(f, rows);
    for (int k = 0; k < FAIR_KINDS; ++k) {
        double coefficients[4];
        for (int i = 0; i < rows[k].points; ++i)
            coefficients[i] = type->coefficient(rows[k].points, i);
        ax_deploy_model_keep_fair(model, rows[k].count, rows[k].points, rows[k].hinges, coefficients,
                                  scale * rows[k].weight);
    }
}

// Rim parts and constraints on the deployed hinges, which start at point `first`; under load only what supports.
static void add_holders(ax_form* f, ax_solver* s, int first, bool hang, ax_form_groups* groups)
{
    double rim = hang ? hang_rim_weight : rim_weight;
    groups->rim = AX_NEW(int, f->rim_count + 1);
    groups->held = AX_NEW(int, f->held_count + 1);
    for (int k = 0; k < f->rim_count; ++k) {
        const ax_rim_part* part = f->rim + k;
        groups->rim[k] = -1;
        if (part->kind == AX_RIM_FIXED) {
            groups->rim[k] = add(s, hang ? "fixed" : "closeness", 1, part->count, part->hinges, first, rim, NULL);
            if (groups->rim[k] >= 0)
                ax_solver_set_all(s, groups->rim[k], 0, 3, part->places[0]);
        } else if (part->kind == AX_RIM_SLIDE && hang && ax_form_shares(f)) { // held where the shape has slid to
            groups->rim[k] = add(s, "fixed", 1, part->count, part->hinges, first, rim, NULL);
        } else if (part->kind == AX_RIM_SLIDE) {
            // rims longer than one constraint takes keep their order piece by piece
            int pieces = (part->count + AX_MOST_POINTS - 1) / AX_MOST_POINTS;
            for (int i = 0; i < pieces; ++i) {
                int from = (int)((long)part->count * i / pieces), to = (int)((long)part->count * (i + 1) / pieces);
                int group =
                    add(s, "ordered_on_curve", to - from, 1, part->hinges + from, first, rim, &f->rim_holder[k].place);
                groups->rim[k] = i ? groups->rim[k] : group;
            }
        }
    }
    for (int k = 0; k < f->held_count; ++k) {
        const ax_form_constraint* c = f->held + k;
        groups->held[k] = -1;
        if (hang && !c->support)
            continue;
        const ax_place* place = &f->held_holder[k].place;
        int group = -1;
        switch (c->kind) {
        case AX_HELD_PLANE:
        case AX_HELD_LINE:
        case AX_HELD_CIRCLE: {
            const char* type = c->kind == AX_HELD_PLANE ? "plane" : (c->kind == AX_HELD_LINE ? "line" : "circle");
            group = add(s, type, c->count < AX_MOST_POINTS ? c->count : AX_MOST_POINTS, 1, c->hinges, first, c->weight,
                        NULL);
            break;
        }
        case AX_HELD_PLANE_GIVEN:
            group = add(s, "plane_given", 1, c->count, c->hinges, first, c->weight, NULL);
            for (int i = 0; i < c->count; ++i)
                for (int d = 0; d < 3; ++d) {
                    ax_solver_set(s, group, i, lane_of("plane_given", "point") + d, c->point[d]);
                    ax_solver_set(s, group, i, lane_of("plane_given", "normal") + d, c->direction[d]);
                }
            break;
        case AX_HELD_CURVE:
        case AX_HELD_SURFACE:
            group = add(s, "on_geometry", 1, c->count, c->hinges, first, c->weight, place);
            break;
        case AX_HELD_FIXED:
            group = add(s, "closeness", 1, c->count, c->hinges, first, c->weight, NULL);
            ax_solver_set_all(s, group, 0, 3, c->places[0]);
            break;
        case AX_HELD_MIRROR:
            group = add(s, "mirror", 2, c->count / 2, c->hinges, first, c->weight, NULL);
            for (int i = 0; i < c->count / 2; ++i)
                for (int d = 0; d < 3; ++d) {
                    ax_solver_set(s, group, i, lane_of("mirror", "point") + d, c->point[d]);
                    ax_solver_set(s, group, i, lane_of("mirror", "normal") + d, c->direction[d]);
                }
            break;
        case AX_HELD_ROTATION:
            group = add(s, "rotation_symmetry", c->order, c->count / c->order, c->hinges, first, c->weight, NULL);
            for (int i = 0; i < c->count / c->order; ++i)
                for (int d = 0; d < 3; ++d) {
                    ax_solver_set(s, group, i, lane_of("rotation_symmetry", "point") + d, c->point[d]);
                    ax_solver_set(s, group, i, lane_of("rotation_symmetry", "axis") + d, c->direction[d]);
                }
            break;
        case AX_HELD_FAIR: {
            unsigned char* wanted = AX_NEW0(unsigned char, f->lattice.linkage.hinge_count);
            int(*lines)[4] = ax_alloc((size_t)f->line_count, sizeof *lines), count = 0;
            for (int i = 0; i < c->count; ++i)
                wanted[c->hinges[i]] = 1;
            for (int i = 0; i < f->line_count; ++i)
                if (wanted[f->lines[i][1]] && wanted[f->lines[i][2]])
                    memcpy(lines[count++], f->lines[i], sizeof *lines);
            group = add(s, "fairness", 4, count, (const int*)lines, first, c->weight, NULL);
            if (group >= 0)
                ax_solver_set_soft(s, group, true);
            ax_free(lines);
            ax_free(wanted);
            break;
        }
        }
        groups->held[k] = group;
    }
}

// Places of the sheet, once or twice: the order of elimination depends on these alone, so that forms which are stored and
// loaded go on with the same bits.
static void sheet_places(const ax_form* f, double (*to)[3])
{
    for (int h = 0; h < f->lattice.linkage.hinge_count; ++h)
        to[h][0] = f->lattice.hinges[h][0], to[h][1] = f->lattice.hinges[h][1], to[h][2] = 0;
}

// How far panels give way: as asked, or not at all for now.
static void allow_give(ax_form* f, bool allowed)
{
    const ax_linkage* linkage = &f->lattice.linkage;
    if (!ax_form_shares(f))
        return;
    bool gives = allowed && f->dynamics.give > 0;
    double(*lanes)[4] = ax_alloc((size_t)linkage->triangle_count, sizeof *lanes);
    for (int t = 0; t < linkage->triangle_count; ++t) {
        const int* h = linkage->triangles[t];
        bool border = linkage->on_rim[h[0]] || linkage->on_rim[h[1]] || linkage->on_rim[h[2]];
        bool released = border && f->released && gives;
        lanes[t][0] = gives ? 1 / ((released ? 3 : 1) * f->dynamics.give) : 1e6; // border panels give way more easily
        lanes[t][1] = released ? border_skew : 0;
        lanes[t][2] = border_lo, lanes[t][3] = border_hi;
    }
    int first = lane_of("shared_panel", "draw");
    assert(lane_of("shared_panel", "hi") == first + 3);
    ax_solver_set_all(f->shape, f->shape_groups.panels, first, 4, lanes[0]);
    ax_free(lanes);
}

// A rim that is held may have too much between it. A free one gives way, and a surface that holds every hinge says itself how the
// sheet bends.
static bool may_fold(const ax_form* f)
{
    for (int k = 0; k < f->held_count; ++k)
        if (f->held[k].kind == AX_HELD_SURFACE && f->held[k].count == f->lattice.linkage.hinge_count)
            return false;
    for (int k = 0; k < f->rim_count; ++k)
        if (f->rim[k].kind != AX_RIM_FREE)
            return true;
    return false;
}

static void build_shape(ax_form* f)
{
    const ax_linkage* linkage = &f->lattice.linkage;
    int n = linkage->hinge_count, t = linkage->triangle_count;
    bool shares = ax_form_shares(f);
    sheet_places(f, f->scratch);
    sheet_places(f, f->scratch + n);
    ax_solver* s = ax_solver_make(shares ? 2 * n : n, (const double(*)[3])f->scratch, f->pool);
    ax_form_groups* g = &f->shape_groups;
    *g = (ax_form_groups){-1, -1, -1, -1, NULL, NULL};
    if (shares) {
        int(*points)[12] = ax_alloc((size_t)t, sizeof *points);
        for (int k = 0; k < t; ++k) {
            const int* h = linkage->triangles[k];
            for (int e = 0; e < 3; ++e) {
                points[k][2 * e] = h[e], points[k][2 * e + 1] = h[(e + 1) % 3];
                points[k][6 + 2 * e] = n + h[e], points[k][7 + 2 * e] = n + h[(e + 1) % 3];
            }
        }
        // an edge row weighs a third: the three of them are the panel
        g->panels = ax_solver_add(s, type_of("shared_panel"), 12, t, points[0], 1.0 / 3, NULL);
        ax_free(points);
        int* loops = AX_NEW(int, 6 * (size_t)f->hole_count + 1);
        for (int k = 0; k < f->hole_count; ++k)
            memcpy(loops + 6 * k, linkage->hole_hinges + linkage->hole_start[f->holes[k]], 6 * sizeof *loops);
        g->holes = add(s, "cyclic_polygon", 6, f->hole_count, loops, n, hole_weight, NULL);
        ax_free(loops);
        ax_solver_set_soft(s, g->holes, true);
        fair_rows rows[FAIR_KINDS];
        if (may_fold(f)) // a little less than the square: where there is far too much, 2,500 panels settle too
            list_fairness(f, held_fair_weight, held_bend_weight, wide_weight, 1.5, rows);
        else
            list_fairness(f, fair_weight, bend_weight, 0, 0, rows);
        add_fairness(s, n, rows);
        add_holders(f, s, n, false, g);
    } else
        g->panels = add(s, "flat_triangle", 3, t, (const int*)linkage->triangles, 0, 1, NULL);
    g->mouths = add(s, "mouth_angle", 3, f->mouth_count, (const int*)f->mouths, 0, 1, NULL);
    double* bounds = AX_NEW(double, 2 * (size_t)f->mouth_count + 1);
    for (int k = 0; k < f->mouth_count; ++k)
        bounds[2 * k] = f->mouth_min, bounds[2 * k + 1] = 2 * AX_PI / 3;
    ax_solver_set_all(s, g->mouths, lane_of("mouth_angle", "lo"), 2, bounds);
    ax_free(bounds);
    double size = f->lattice.spacing / f->radius;
    g->centres = add(s, "centroid", 3, t, (const int*)linkage->triangles, 0, centre_weight * size * size, NULL);
    ax_solver_set_soft(s, g->centres, true);
    f->shape = s;
    allow_give(f, true);
}

static void set_load_value(ax_solver* s, int load, const ax_load_type* type, const char* name, int lane, double value)
{
    for (int k = 0; k < type->parameter_count; ++k)
        if (strcmp(type->parameters[k].name, name) == 0)
            ax_solver_set_load_value(s, load, type->parameters[k].offset + lane, value);
}

// A load that strains the panels by `load_strain` of an edge over the whole sheet: the rigid limit does not depend on its size, the
// number of iterations does.
static double load_per_area(const ax_form* f)
{
    return load_strain / f->radius;
}

static void add_load(ax_form* f, ax_solver* s)
{
    const ax_linkage* l = &f->lattice.linkage;
    double unit = load_per_area(f);
    bool weight = f->dynamics.kind == AX_DYNAMICS_GRAVITY;
    int loops = l->triangle_count + (weight ? 0 : l->hole_count + l->opening_count);
    int total = 3 * l->triangle_count + l->hole_start[l->hole_count] + l->opening_start[l->opening_count];
    int *start = AX_NEW(int, loops + 1), *points = AX_NEW(int, total), count = 0, at = 0;
    start[0] = 0;
    for (int t = 0; t < l->triangle_count; ++t) {
        for (int k = 0; k < 3; ++k)
            points[at++] = l->triangles[t][k];
        start[++count] = at;
    }
    for (int k = 0; k < l->hole_count && !weight; ++k) {
        for (int i = l->hole_start[k]; i < l->hole_start[k + 1]; ++i)
            points[at++] = l->hole_hinges[i];
        start[++count] = at;
    }
    for (int k = 0; k < l->opening_count && !weight; ++k) {
        for (int i = l->opening_start[k]; i < l->opening_start[k + 1]; ++i)
            points[at++] = l->opening_hinges[i];
        start[++count] = at;
    }
    const ax_load_type* type = ax_load_find(weight ? "gravity" : "pressure");
    f->load = ax_solver_add_load(s, type, loops, start, points);
    if (weight) { // panels carry four times their area, fully open
        set_load_value(s, f->load, type, "density", 0, 4);
        set_load_value(s, f->load, type, "acceleration", 0, unit);
        for (int c = 0; c < 3; ++c)
            set_load_value(s, f->load, type, "direction", c, f->dynamics.load.direction[c]);
    } else
        set_load_value(s, f->load, type, "pressure", 0, unit);
    ax_free(start);
    ax_free(points);
}

static void build_hang(ax_form* f)
{
    const ax_linkage* linkage = &f->lattice.linkage;
    sheet_places(f, f->scratch);
    ax_solver* s = ax_solver_make(linkage->hinge_count, (const double(*)[3])f->scratch, f->pool);
    ax_form_groups* g = &f->hang_groups;
    *g = (ax_form_groups){-1, -1, -1, -1, NULL, NULL};
    g->panels = add(s, "rigid_triangle", 3, linkage->triangle_count, (const int*)linkage->triangles, 0, 1, NULL);
    fair_rows rows[FAIR_KINDS];
    list_hang_fairness(f, rows);
    add_fairness(s, 0, rows);
    add_holders(f, s, 0, true, g);
    add_load(f, s);
    f->hang = s;
}

void ax_form_build(ax_form* f)
{
    if (!f->stale)
        return;
    ax_form_drop_solvers(f);
    f->rim_holders = f->rim_count;
    f->held_holders = f->held_count;
    f->rim_holder = AX_NEW0(ax_holder, f->rim_holders + 1);
    f->held_holder = AX_NEW0(ax_holder, f->held_holders + 1);
    for (int k = 0; k < f->rim_count; ++k)
        if (f->rim[k].kind == AX_RIM_SLIDE) {
            f->rim_holder[k].curve = ax_curve_of_shape(&f->rim[k].curve);
            f->rim_holder[k].place = ax_curve_place(f->rim_holder[k].curve);
        }
    for (int k = 0; k < f->held_count; ++k) {
        ax_holder* holder = f->held_holder + k;
        if (f->held[k].kind == AX_HELD_CURVE) {
            holder->curve = ax_curve_of_shape(&f->held[k].curve);
            holder->place = ax_curve_place(holder->curve);
        } else if (f->held[k].kind == AX_HELD_SURFACE) {
            holder->surface = ax_closest_make(f->held[k].surface);
            holder->place = ax_closest_place(holder->surface);
        }
    }
    build_shape(f);
    if (ax_form_hangs(f))
        build_hang(f);
    ax_solver* solvers[] = {f->shape, f->hang};
    for (int k = 0; k < 2; ++k)
        if (solvers[k]) {
            ax_solver_set_proximal(solvers[k], proximal); // nothing flies off that no row holds
            ax_solver_use_multipliers(solvers[k], true);
            ax_solver_cap_multipliers(solvers[k], multiplier_cap * f->lattice.spacing);
        }
    size_t first = ax_solver_multiplier_count(f->shape), second = f->hang ? ax_solver_multiplier_count(f->hang) : 0;
    if (f->pending && f->pending_count == first + second) {
        ax_solver_set_multipliers(f->shape, f->pending);
        if (f->hang)
            ax_solver_set_multipliers(f->hang, f->pending + first);
    }
    ax_free(f->pending);
    f->pending = NULL;
    f->stale = false;
}

double* ax_form_multipliers(const ax_form* f, size_t* count)
{
    *count = 0;
    if (f->stale || !f->shape) {
        *count = f->pending ? f->pending_count : 0;
        return ax_copy(f->pending, *count, sizeof(double));
    }
    size_t first = ax_solver_multiplier_count(f->shape), second = f->hang ? ax_solver_multiplier_count(f->hang) : 0;
    double* all = AX_NEW(double, first + second);
    ax_solver_get_multipliers(f->shape, all);
    if (f->hang)
        ax_solver_get_multipliers(f->hang, all + first);
    *count = first + second;
    return all;
}

void ax_form_twist(ax_form* f)
{
    ax_lattice_twist(&f->lattice, f->prescribed, f->flat);
}

// ---- iterating ----------------------------------------------------------------------------------------------------------------

// The sheet's panel centres, turned and shifted to where the flat state has them, grown only if collisions may grow it: the targets
// that choose among the sheet's many flat states the one whose scale factors are the prescribed ones.
static void aim_centres(ax_form* f)
{
    const ax_linkage* linkage = &f->lattice.linkage;
    int t = linkage->triangle_count;
    double mean[2] = {0, 0}, re = 0, im = 0, norm = 0;
    for (int k = 0; k < t; ++k)
        for (int c = 0; c < 2; ++c) {
            const int* h = linkage->triangles[k];
            f->lanes[3 * k + c] = (f->flat[h[0]][c] + f->flat[h[1]][c] + f->flat[h[2]][c]) / 3;
            mean[c] += f->lanes[3 * k + c] / t;
        }
    for (int k = 0; k < t; ++k) {
        double x = f->lanes[3 * k] - mean[0], y = f->lanes[3 * k + 1] - mean[1];
        double u = f->centres[k][0] - f->centre[0], v = f->centres[k][1] - f->centre[1];
        re += u * x + v * y, im += u * y - v * x, norm += u * u + v * v;
    }
    re /= norm, im /= norm;
    double fit = sqrt(re * re + im * im), growth = f->dynamics.collisions ? fmax(1, fit) : 1;
    double s = fit > 0 ? growth / fit : 1;
    re = fit > 0 ? re * s : 1, im *= s;
    f->growth = growth;
    for (int k = 0; k < t; ++k) {
        double u = f->centres[k][0] - f->centre[0], v = f->centres[k][1] - f->centre[1];
        f->lanes[3 * k] = mean[0] + re * u - im * v, f->lanes[3 * k + 1] = mean[1] + im * u + re * v;
        f->lanes[3 * k + 2] = 0;
    }
    ax_solver_set_all(f->shape, f->shape_groups.centres, 0, 3, f->lanes);
}

// Sizes of the panels: shared by both states where they are, else as prescribed.
static void measure_sides(ax_form* f)
{
    const ax_linkage* linkage = &f->lattice.linkage;
    bool shares = ax_form_shares(f);
    for (int t = 0; t < linkage->triangle_count; ++t)
        for (int k = 0; k < 3; ++k) {
            int a = linkage->triangles[t][(k + 1) % 3], b = linkage->triangles[t][(k + 2) % 3];
            f->side[t][k] =
                shares ? 0.5 * (ax_distance2(f->flat[a], f->flat[b]) + ax_distance3(f->deployed[a], f->deployed[b]))
                       : ax_form_side(f, t);
        }
}

// What the shape's panels are to be.
static void size_panels(ax_form* f)
{
    bool shares = ax_form_shares(f);
    int lanes = shares ? 1 : 3, first = shares ? lane_of("shared_panel", "side") : lane_of("flat_triangle", "lengths");
    for (int k = 0; k < lanes * f->lattice.linkage.triangle_count; ++k)
        f->lanes[k] = ax_form_side(f, k / lanes);
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
    ax_solver_set_all(f->shape, f->shape_groups.holes, lane_of("cyclic_polygon", "sides"), 6, f->lanes);
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

static void iterate_shape(ax_form* f, int iterations)
{
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

static void iterate_hang(ax_form* f, int iterations)
{
    int n = f->lattice.linkage.hinge_count;
    measure_sides(f);
    ax_solver_set_all(f->hang, f->hang_groups.panels, lane_of("rigid_triangle", "lengths"), 3, f->side[0]);
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
    iterate_shape(f, iterations);
    if (ax_form_hangs(f))
        iterate_hang(f, iterations);
    else
        measure_sides(f);
    f->iterations += iterations;
    f->exact = f->settled = false;
    ++f->revision;
}

void ax_form_restart(ax_form* f, double height)
{
    int n = f->lattice.linkage.hinge_count;
    double up = ax_form_hangs(f)
                    ? (f->dynamics.kind == AX_DYNAMICS_GRAVITY && f->dynamics.load.direction[2] < 0 ? -1 : 1)
                    : (ax_form_bulge(f) < 0 ? -1 : 1);
    for (int h = 0; h < n; ++h) {
        double r = ax_distance2(f->lattice.hinges[h], f->centre) / f->radius;
        double bulge = height * f->radius * fmax(0, 1 - r * r) * up;
        for (int c = 0; c < 2; ++c)
            f->deployed[h][c] = f->simulated[h][c] = f->flat[h][c];
        f->deployed[h][2] = f->simulated[h][2] = bulge;
    }
    ax_form_changed(f, false, true);
}

// While a fresh sheet opens, its load leans on it, spread evenly: what lies between a painted dome and a rim with too little room for it
// opens upwards or downwards with equal ease, and as fairness has it, against the load. Panels keep their sizes meanwhile, so that
// nothing yields to it.
static void lean(ax_form* f, bool on)
{
    const ax_linkage* linkage = &f->lattice.linkage;
    int n = linkage->hinge_count;
    bool weight = f->dynamics.kind == AX_DYNAMICS_GRAVITY;
    const double up[3] = {0, 0, 1}, *along = weight ? f->dynamics.load.direction : up;
    memset(f->scratch, 0, 2 * (size_t)n * sizeof *f->scratch);
    for (int t = 0; t < linkage->triangle_count; ++t) {
        double side = ax_form_side(f, t), share = sqrt(3) * side * side / 3; // it carries four times its area
        for (int k = 0; k < 3; ++k)
            for (int c = 0; c < 3; ++c)
                f->scratch[n + linkage->triangles[t][k]][c] += load_per_area(f) * share * along[c];
    }
    ax_solver_set_load(f->shape, on ? (const double(*)[3])f->scratch : NULL);
}

// States as they were before a call that is cancelled.
typedef struct snapshot {
    double (*flat)[2], (*deployed)[3], (*simulated)[3], (*side)[3], *multipliers, growth;
    size_t count;
    int iterations;
} snapshot;

static snapshot keep(const ax_form* f)
{
    size_t n = (size_t)f->lattice.linkage.hinge_count;
    snapshot s = {.flat = ax_copy(f->flat, n, sizeof *f->flat),
                  .deployed = ax_copy(f->deployed, n, sizeof *f->deployed),
                  .simulated = ax_copy(f->simulated, n, sizeof *f->simulated),
                  .side = ax_copy(f->side, (size_t)f->lattice.linkage.triangle_count, sizeof *f->side),
                  .growth = f->growth,
                  .iterations = f->iterations};
    s.multipliers = ax_form_multipliers(f, &s.count);
    return s;
}

static void restore(ax_form* f, snapshot* s)
{
    size_t n = (size_t)f->lattice.linkage.hinge_count;
    memcpy(f->flat, s->flat, n * sizeof *f->flat);
    memcpy(f->deployed, s->deployed, n * sizeof *f->deployed);
    memcpy(f->simulated, s->simulated, n * sizeof *f->simulated);
    memcpy(f->side, s->side, (size_t)f->lattice.linkage.triangle_count * sizeof *f->side);
    f->growth = s->growth;
    f->iterations = s->iterations;
    ax_form_drop_solvers(f);
    ax_free(f->pending);
    f->pending = s->multipliers;
    f->pending_count = s->count;
    s->multipliers = NULL;
}

static void forget(snapshot* s)
{
    ax_free(s->flat);
    ax_free(s->deployed);
    ax_free(s->simulated);
    ax_free(s->side);
    ax_free(s->multipliers);
}

// Iterates one of the two until its edges are right within `error` and it rests, or for `least` iterations, and on to `most` while edges
// are off. False if cancelled.
static bool run(ax_form* f, bool shape, int least, int most, double error, const ax_progress* progress,
                const char* stage, double lo, double hi)
{
    for (int done = 0; done < most;) {
        int count = REST_CHECK < most - done ? REST_CHECK : most - done;
        f->scaled_step = 0;
        if (shape)
            iterate_shape(f, count);
        else
            iterate_hang(f, count);
        done += count;
        f->iterations += count;
        double off = shape ? fmax(ax_form_flat_error(f), ax_form_shares(f) ? ax_form_deployed_error(f) : 0)
                           : ax_form_simulated_error(f);
        if (!ax_progress_report(progress, stage, lo + (hi - lo) * done / most, off))
            return false;
        bool near = off < error && (error > rest_error || f->scaled_step < rest_step);
        if (near || (done >= least && off < good_error))
            return true;
    }
    return true;
}

// Near the rest and then to it. False if cancelled.
static bool come_to_rest(ax_form* f, const ax_progress* progress, double lo, double hi, bool* balanced)
{
    ax_progress_part part;
    *balanced = false;
    if (!run(f, false, LOAD_ITERATIONS, LOAD_ITERATIONS, near_error, progress, loading, lo, (lo + hi) / 2))
        return false;
    return ax_form_simulated_error(f) > good_error ||
           ax_form_balance(f, load_per_area(f), ax_progress_within(&part, progress, (lo + hi) / 2, hi), balanced);
}

// For given iterations; 0: until forces are in balance. From where it is, so that slack parts stay as they lie; else from the open
// shape, whose edges are right. False if cancelled.
static bool load_sheet(ax_form* f, int iterations, const ax_progress* progress)
{
    if (iterations > 0)
        return run(f, false, iterations, iterations, rest_error, progress, loading, 0.5, 1);
    bool balanced;
    if (!come_to_rest(f, progress, 0.5, 0.65, &balanced))
        return false;
    if (!balanced && ax_form_shares(f)) {
        memcpy(f->simulated, f->deployed, (size_t)f->lattice.linkage.hinge_count * sizeof *f->simulated);
        ax_solver_reset_multipliers(f->hang);
        if (!come_to_rest(f, progress, 0.65, 0.8, &balanced))
            return false;
    }
    return balanced || run(f, false, LOAD_ITERATIONS, MOST_ITERATIONS, rest_error, progress, loading, 0.8, 1);
}

ax_status ax_form_settle(ax_form* f, int iterations, const ax_progress* progress, ax_error* error)
{
    int least = ax_form_shares(f) ? SHAPE_ITERATIONS : FLAT_ITERATIONS, most = MOST_ITERATIONS;
    if (iterations > 0)
        least = most = iterations;
    int n = f->lattice.linkage.hinge_count;
    ax_status held = ax_form_hangs(f) ? ax_form_check_support(f, error) : AX_OK;
    if (held != AX_OK)
        return held;
    snapshot before = keep(f);
    ax_form_build(f);
    // The flat state starts from the twist of its factors, so that it does not depend on the way here; the deployed one starts
    // out of the plane, where it would stay locked, and afresh where panels have folded onto each other or turned over: they would not
    // come back.
    ax_form_twist(f);
    if (!ax_form_shares(f))
        ax_solver_reset_multipliers(f->shape);
    bool fresh = false;
    double lo = INFINITY, hi = -INFINITY;
    for (int h = 0; h < n; ++h)
        lo = fmin(lo, f->deployed[h][2]), hi = fmax(hi, f->deployed[h][2]);
    bool folded =
        ax_form_shares(f) && (ax_form_folds(f, (const double(*)[3])f->deployed, NULL) > 0 || ax_form_left_over(f));
    if (f->dynamics.kind != AX_DYNAMICS_NONE && (hi - lo < 1e-6 * f->radius || folded))
        ax_form_restart(f, 0.05), fresh = true;
    if (fresh) { // panels that give way before the holes are open settle for a flatter shape, and leave it slowly
        bool leans = ax_form_hangs(f) && ax_form_shares(f);
        allow_give(f, false);
        if (leans)
            lean(f, true);
        iterate_shape(f, iterations > 0 ? iterations / 4 : FRESH_ITERATIONS);
        if (leans)
            lean(f, false);
        allow_give(f, true);
    }
    bool going = run(f, true, least, most, rest_error, progress, "Shaping the sheet", 0, ax_form_hangs(f) ? 0.5 : 1);
    measure_sides(f);
    if (going && ax_form_hangs(f))
        going = load_sheet(f, iterations, progress);
    if (!going)
        restore(f, &before);
    forget(&before);
    f->exact = false;
    ++f->revision;
    return going ? AX_OK : ax_fail(error, AX_CANCELLED, "Cancelled.");
}
