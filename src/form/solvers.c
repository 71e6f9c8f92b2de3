// The two projective solvers of a form.
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
                    bend_weight = 0.01, held_bend_weight = 0.002, hang_bend_weight = 0.003, wide_weight = 0.03,
                    hang_wide_weight = 0.015, rim_weight = 0.3, hang_rim_weight = 1, centre_weight = 0.3,
                    load_strain = 0.1, multiplier_cap = 2, drawn_weight = 0.05, light_weight = 0.015,
                    drawn_margin = 0.07;
static const double border_lo = 0.6, border_hi = 1.4, border_skew = 0.35;

// Whatever yields, over what it weighs in sheets of 600 panels, those with multipliers at 1. The stiffness of folds grows with the square of
// the number of panels. Were the others to stand still, it would outweigh them, and multipliers would come to their cap; were they to
// grow as much, soft modes would take long: half way between, all kinds of sheets come to rest.
static double softness_of(const ax_form* f)
{
    return 1 / sqrt(fmax(1, ax_form_fineness(f)));
}

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

int ax_form_lane(const char* type, const char* parameter)
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
// grow with a^-4, the square of the number of panels, mean the same at every size. `wide` is that of 600 panels.
typedef struct fair_rows {
    int points, count;
    const int* hinges;
    double weight;
} fair_rows;

enum { FAIR_KINDS = 3 };

static void list_fairness(const ax_form* f, double near, double bend, double wide, fair_rows rows[FAIR_KINDS])
{
    double softness = softness_of(f);
    near *= softness, bend *= softness;
    wide *= softness * f->wide_share * pow(ax_form_fineness(f), 2);
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
    list_fairness(f, hang_fair_weight, hang_bend_weight, hang_wide_weight, rows);
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
                    ax_solver_set(s, group, i, ax_form_lane("plane_given", "point") + d, c->point[d]);
                    ax_solver_set(s, group, i, ax_form_lane("plane_given", "normal") + d, c->direction[d]);
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
                    ax_solver_set(s, group, i, ax_form_lane("mirror", "point") + d, c->point[d]);
                    ax_solver_set(s, group, i, ax_form_lane("mirror", "normal") + d, c->direction[d]);
                }
            break;
        case AX_HELD_ROTATION:
            group = add(s, "rotation_symmetry", c->order, c->count / c->order, c->hinges, first, c->weight, NULL);
            for (int i = 0; i < c->count / c->order; ++i)
                for (int d = 0; d < 3; ++d) {
                    ax_solver_set(s, group, i, ax_form_lane("rotation_symmetry", "point") + d, c->point[d]);
                    ax_solver_set(s, group, i, ax_form_lane("rotation_symmetry", "axis") + d, c->direction[d]);
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
void ax_form_allow_give(ax_form* f, bool allowed)
{
    const ax_linkage* linkage = &f->lattice.linkage;
    if (!ax_form_shares(f))
        return;
    bool gives = allowed && f->dynamics.give > 0;
    double(*lanes)[4] = ax_alloc((size_t)linkage->triangle_count, sizeof *lanes);
    unsigned char* fits = AX_NEW(unsigned char, linkage->hinge_count);
    ax_form_list_fitting(f, fits);
    for (int t = 0; t < linkage->triangle_count; ++t) {
        const int* h = linkage->triangles[t];
        bool border = false, strays = false;
        for (int k = 0; k < 3; ++k)
            border = border || linkage->on_rim[h[k]], strays = strays || (linkage->on_rim[h[k]] && !fits[h[k]]);
        bool released = border && f->released && gives;
        lanes[t][0] = gives ? softness_of(f) / ((released ? 3 : 1) * f->dynamics.give)
                            : 1e6; // border panels give way more easily
        lanes[t][1] = released && strays ? border_skew : 0;
        lanes[t][2] = border_lo, lanes[t][3] = border_hi;
    }
    int first = ax_form_lane("shared_panel", "draw");
    assert(ax_form_lane("shared_panel", "hi") == first + 3);
    ax_solver_set_all(f->shape, f->shape_groups.panels, first, 4, lanes[0]);
    ax_free(fits);
    ax_free(lanes);
}

bool ax_form_may_fold(const ax_form* f)
{
    for (int k = 0; k < f->held_count; ++k)
        if (f->held[k].kind == AX_HELD_SURFACE && f->held[k].count == f->lattice.linkage.hinge_count)
            return false;
    for (int k = 0; k < f->rim_count; ++k)
        if (f->rim[k].kind != AX_RIM_FREE)
            return true;
    return false;
}

// Where the rim skips a row, border panels that stretch to their curve come upon those of the next row. Openings run round a missing hole,
// counter-clockwise: seen from their middle, the first hinge stays ahead of the last in the flat state, as arms of a mouth do.
static void add_notches(const ax_form* f, ax_solver* s)
{
    enum { SHORTEST = 5 }; // hinges: shorter ones are wide open
    const ax_linkage* linkage = &f->lattice.linkage;
    int(*arms)[3] = ax_alloc((size_t)linkage->opening_count + 1, sizeof *arms), count = 0;
    double(*bounds)[2] = ax_alloc((size_t)linkage->opening_count + 1, sizeof *bounds);
    for (int k = 0; k < linkage->opening_count; ++k) {
        const int* hinges = linkage->opening_hinges + linkage->opening_start[k];
        int length = linkage->opening_start[k + 1] - linkage->opening_start[k];
        if (length < SHORTEST)
            continue;
        arms[count][0] = hinges[length / 2], arms[count][1] = hinges[length - 1], arms[count][2] = hinges[0];
        bounds[count][0] = f->mouth_min, bounds[count][1] = 1.5 * AX_PI;
        ++count;
    }
    int group = add(s, "mouth_angle", 3, count, (const int*)arms, 0, 1, NULL);
    if (group >= 0)
        ax_solver_set_all(s, group, ax_form_lane("mouth_angle", "lo"), 2, bounds[0]);
    ax_free(bounds);
    ax_free(arms);
}

void ax_form_aim_drawn(ax_form* f)
{
    int n = f->lattice.linkage.hinge_count, *inner = AX_NEW(int, n), count = ax_form_list_inner(f, drawn_margin, inner);
    for (int k = 0; k < count; ++k)
        memcpy(f->scratch[k], f->drawn[inner[k]], sizeof *f->scratch);
    if (f->shape_groups.drawn >= 0)
        ax_solver_set_all(f->shape, f->shape_groups.drawn, 0, 3, f->scratch[0]);
    ax_free(inner);
}

// As stiff over an area of the design at every number of panels. Nearer to the rim two sheets differ by their steps of panels.
static void add_drawn(const ax_form* f, ax_solver* s, ax_form_groups* g)
{
    int n = f->lattice.linkage.hinge_count, *inner = AX_NEW(int, n), count = ax_form_list_inner(f, drawn_margin, inner);
    g->drawn = add(s, "closeness", 1, count, inner, n,
                   (f->lightly ? light_weight : drawn_weight) * softness_of(f) / ax_form_fineness(f), NULL);
    if (g->drawn >= 0)
        ax_solver_set_soft(s, g->drawn, true);
    ax_free(inner);
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
    *g = (ax_form_groups){-1, -1, -1, -1, -1, NULL, NULL};
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
        for (int k = 0; k < t; ++k)
            for (int c = 0; c < 2; ++c)
                ax_solver_set(s, g->panels, k, ax_form_lane("shared_panel", "lean") + c, f->panel[k].lean[c]);
        int* loops = AX_NEW(int, 6 * (size_t)f->hole_count + 1);
        for (int k = 0; k < f->hole_count; ++k)
            memcpy(loops + 6 * k, linkage->hole_hinges + linkage->hole_start[f->holes[k]], 6 * sizeof *loops);
        g->holes = add(s, "cyclic_polygon", 6, f->hole_count, loops, n, hole_weight * softness_of(f), NULL);
        ax_free(loops);
        ax_solver_set_soft(s, g->holes, true);
        fair_rows rows[FAIR_KINDS];
        if (ax_form_may_fold(f))
            list_fairness(f, held_fair_weight, held_bend_weight, wide_weight, rows);
        else
            list_fairness(f, fair_weight, bend_weight, 0, rows);
        add_fairness(s, n, rows);
        add_holders(f, s, n, false, g);
        if (f->drawn)
            add_drawn(f, s, g);
    } else
        g->panels = add(s, "flat_triangle", 3, t, (const int*)linkage->triangles, 0, 1, NULL);
    g->mouths = add(s, "mouth_angle", 3, f->mouth_count, (const int*)f->mouths, 0, 1, NULL);
    double* bounds = AX_NEW(double, 2 * (size_t)f->mouth_count + 1);
    for (int k = 0; k < f->mouth_count; ++k)
        bounds[2 * k] = f->mouth_min, bounds[2 * k + 1] = 2 * AX_PI / 3;
    ax_solver_set_all(s, g->mouths, ax_form_lane("mouth_angle", "lo"), 2, bounds);
    ax_free(bounds);
    add_notches(f, s);
    double size = f->lattice.spacing / f->radius;
    g->centres =
        add(s, "centroid", 3, t, (const int*)linkage->triangles, 0, centre_weight * size * size * softness_of(f), NULL);
    ax_solver_set_soft(s, g->centres, true);
    f->shape = s;
    ax_form_allow_give(f, true);
    if (f->drawn)
        ax_form_aim_drawn(f);
}

static void set_load_value(ax_solver* s, int load, const ax_load_type* type, const char* name, int lane, double value)
{
    for (int k = 0; k < type->parameter_count; ++k)
        if (strcmp(type->parameters[k].name, name) == 0)
            ax_solver_set_load_value(s, load, type->parameters[k].offset + lane, value);
}

// A load that strains the panels by `load_strain` of an edge over the whole sheet, 600 of them: the rigid limit does not depend on its
// size, the number of iterations does.
double ax_form_load_per_area(const ax_form* f)
{
    return softness_of(f) * load_strain / f->radius;
}

static void add_load(ax_form* f, ax_solver* s)
{
    const ax_linkage* l = &f->lattice.linkage;
    double unit = ax_form_load_per_area(f);
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
    *g = (ax_form_groups){-1, -1, -1, -1, -1, NULL, NULL};
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
            ax_solver_set_proximal(solvers[k], AX_FORM_PROXIMAL);
            ax_solver_use_multipliers(solvers[k], true);
            ax_solver_cap_multipliers(solvers[k], multiplier_cap * f->lattice.spacing);
        }
    if (f->drag > 0)
        ax_form_drag_solvers(f);
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
