#include "form/state.h"

#include "base/vec.h"

#include <assert.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

static const double standard_mouth = 2 * AX_PI / 180, standard_give = 3;

ax_form_dynamics ax_form_dynamics_default(void)
{
    return (ax_form_dynamics){.kind = AX_DYNAMICS_NONE,
                              .load = {.kind = AX_LOAD_NONE, .direction = {0, 0, -1}, .pressure = 100, .density = 4},
                              .adapt = true,
                              .give = standard_give};
}

// ---- making -------------------------------------------------------------------------------------------------------------------

// The smaller of the two angles at each inner hinge, seen where the linkage is half open.
static void list_mouths(ax_form* f)
{
    const ax_linkage* linkage = &f->lattice.linkage;
    double* scale = AX_NEW(double, linkage->triangle_count);
    for (int t = 0; t < linkage->triangle_count; ++t)
        scale[t] = 1.5;
    double(*half)[2] = ax_alloc((size_t)linkage->hinge_count, sizeof *half);
    ax_lattice_twist(&f->lattice, scale, half);
    int count;
    int(*all)[3] = ax_linkage_mouths(linkage, &count);
    f->mouths = ax_alloc((size_t)count, sizeof *f->mouths);
    f->mouth_count = 0;
    for (int k = 0; k < count; ++k)
        if (ax_mouth_angle(half[all[k][0]], half[all[k][1]], half[all[k][2]]) < 2 * AX_PI / 3) {
            int* to = f->mouths[f->mouth_count++];
            to[0] = all[k][1], to[1] = all[k][2], to[2] = all[k][0];
        }
    ax_free(all);
    ax_free(half);
    ax_free(scale);
}

// What follows hinge `h` on the kagome line that comes from `from`: corner k + 1 of one panel, the hinge, corner k + 1 of the other.
// -1 at the rim.
static int follow(const ax_linkage* linkage, const int (*holder)[2], int from, int h)
{
    if (linkage->on_rim[h])
        return -1;
    for (int side = 0; side < 2; ++side) {
        const int *t = linkage->triangles[holder[h][side]], *u = linkage->triangles[holder[h][!side]];
        int at = t[0] == h ? 0 : (t[1] == h ? 1 : 2), on = u[0] == h ? 0 : (u[1] == h ? 1 : 2);
        for (int k = 1; k <= 2; ++k)
            if (t[(at + k) % 3] == from)
                return u[(on + k) % 3];
    }
    return -1;
}

// Four hinges in a row on every kagome line, once each.
static void list_lines(ax_form* f)
{
    const ax_linkage* linkage = &f->lattice.linkage;
    f->holder = ax_linkage_hinge_triangles(linkage);
    f->lines = ax_alloc(3 * (size_t)linkage->triangle_count, sizeof *f->lines);
    f->bends = ax_alloc(3 * (size_t)linkage->triangle_count, sizeof *f->bends);
    f->line_count = f->bend_count = 0;
    for (int t = 0; t < linkage->triangle_count; ++t)
        for (int k = 0; k < 3; ++k) { // an edge is the middle of one row
            int b = linkage->triangles[t][k], c = linkage->triangles[t][(k + 1) % 3];
            int a = follow(linkage, (const int(*)[2])f->holder, c, b),
                d = follow(linkage, (const int(*)[2])f->holder, b, c);
            if (d >= 0) {
                int* to = f->bends[f->bend_count++];
                to[0] = b, to[1] = c, to[2] = d;
            }
            if (a < 0 || d < 0)
                continue;
            int* to = f->lines[f->line_count++];
            to[0] = a, to[1] = b, to[2] = c, to[3] = d;
        }
}

// Which of the three directions of the lattice the edge has whose midpoint a hinge is: 0 along columns, 1 along rows, 2 across.
static int* list_directions(const ax_form* f)
{
    const ax_linkage* linkage = &f->lattice.linkage;
    int* direction = AX_NEW0(int, linkage->hinge_count);
    for (int h = 0; h < linkage->hinge_count; ++h) {
        if (f->holder[h][1] < 0)
            continue;
        const int *a = linkage->panels[f->holder[h][0]], *b = linkage->panels[f->holder[h][1]];
        const int *up = a[2] ? b : a, *down = a[2] ? a : b;
        direction[h] = down[0] < up[0] ? 1 : down[1] < up[1] ? 0 : 2;
    }
    // on the rim from the others of the panel: 2, 1, 0 counter-clockwise
    for (int t = 0; t < linkage->triangle_count; ++t)
        for (int k = 0; k < 3; ++k) {
            const int* h = linkage->triangles[t];
            if (linkage->on_rim[h[k]])
                direction[h[k]] = linkage->on_rim[h[(k + 1) % 3]] ? (direction[h[(k + 2) % 3]] + 2) % 3
                                                                  : (direction[h[(k + 1) % 3]] + 1) % 3;
        }
    return direction;
}

// Every second one of seven hinges on kagome lines. In fine sheets some of these rows stand for all, as far apart as all are in one of
// 600 panels: those on every second, third ... line, and of the two kinds of hinges that take turns on it those of one, in turn from line to
// line: mirror images of the sheet stay alike. Folds are wider than that, and a row that spans six panels is dear: at 2,000 panels a fifth
// of the work of a factorisation is left.
static void list_wide(ax_form* f)
{
    const ax_linkage* linkage = &f->lattice.linkage;
    int *direction = list_directions(f), all = 0;
    f->wide = ax_alloc(3 * (size_t)linkage->triangle_count, sizeof *f->wide);
    f->wide_count = 0;
    int apart = (int)fmax(1, round(sqrt(ax_form_fineness(f))));
    for (int t = 0; t < linkage->triangle_count; ++t)
        for (int k = 0; k < 6; ++k) { // an edge begins a row in both directions
            int from = linkage->triangles[t][k % 3], at = linkage->triangles[t][(k + 1 + k / 3) % 3];
            int along = 3 - direction[from] - direction[at];
            int row[4] = {from};
            for (int step = 1; at >= 0; ++step) {
                if (step % 2 == 0)
                    row[step / 2] = at;
                if (step == 6)
                    break;
                int next = follow(linkage, (const int(*)[2])f->holder, from, at);
                from = at, at = next;
            }
            if (at < 0 || row[0] > row[3])
                continue;
            ++all;
            const int* p = linkage->panels[t];
            int line = along == 0 ? p[1] : along == 1 ? p[0] : p[0] + p[1] + p[2];
            if (line % apart == 0 && (apart == 1 || direction[row[0]] == (along + 1 + (line / apart & 1)) % 3))
                memcpy(f->wide[f->wide_count++], row, sizeof row);
        }
    f->wide_share = f->wide_count > 0 ? (double)all / f->wide_count : 0;
    ax_free(direction);
}

// Keeps the rows of `each` hinges that no uneven panel has; returns how many.
static int keep_even(int count, int each, int* rows, const unsigned char* uneven)
{
    int kept = 0;
    for (int k = 0; k < count; ++k) {
        bool even = true;
        for (int i = 0; i < each; ++i)
            even = even && !uneven[rows[each * k + i]];
        if (even)
            memmove(rows + each * kept++, rows + each * k, (size_t)each * sizeof *rows);
    }
    return kept;
}

void ax_form_spare_uneven(ax_form* f)
{
    static const double even_enough = 0.1;
    const ax_linkage* linkage = &f->lattice.linkage;
    unsigned char* uneven = AX_NEW0(unsigned char, linkage->hinge_count);
    for (int t = 0; t < linkage->triangle_count; ++t)
        for (int k = 0; k < 3; ++k)
            if (fabs(f->stretch[t][k] - 1) > even_enough)
                for (int i = 0; i < 3; ++i)
                    uneven[linkage->triangles[t][i]] = 1;
    f->line_count = keep_even(f->line_count, 4, (int*)f->lines, uneven);
    f->bend_count = keep_even(f->bend_count, 3, (int*)f->bends, uneven);
    f->wide_count = keep_even(f->wide_count, 4, (int*)f->wide, uneven);
    ax_free(uneven);
}

static ax_panel_shape shape_of(const ax_form* f, int triangle)
{
    static const double equilateral = 1e-9;
    const int* h = f->lattice.linkage.triangles[triangle];
    ax_panel_shape s;
    double e[3][2], a[2] = {0, 0}, b[2] = {0, 0}; // edges k to k + 1 are a w^k + b w^-k, w a third of a turn
    for (int k = 0; k < 3; ++k) {
        const double *from = f->lattice.hinges[h[k]], *to = f->lattice.hinges[h[(k + 1) % 3]];
        e[k][0] = to[0] - from[0], e[k][1] = to[1] - from[1];
        double c = cos(2 * AX_PI * k / 3) / 3, d = sin(2 * AX_PI * k / 3) / 3;
        a[0] += c * e[k][0] + d * e[k][1], a[1] += c * e[k][1] - d * e[k][0];
        b[0] += c * e[k][0] - d * e[k][1], b[1] += c * e[k][1] + d * e[k][0];
        s.edge[(k + 2) % 3] = hypot(e[k][0], e[k][1]) / (0.5 * f->lattice.spacing);
    }
    double square = a[0] * a[0] + a[1] * a[1];
    s.lean[0] = (b[0] * a[0] + b[1] * a[1]) / square, s.lean[1] = (b[1] * a[0] - b[0] * a[1]) / square;
    s.size = 3 * sqrt(square) / (0.5 * f->lattice.spacing * (s.edge[0] + s.edge[1] + s.edge[2]));
    if (hypot(s.lean[0], s.lean[1]) < equilateral) // but for rounding
        s = (ax_panel_shape){.size = 1, .edge = {1, 1, 1}};
    return s;
}

ax_form* ax_form_over(ax_lattice* lattice, ax_unit unit)
{
    ax_form* f = AX_NEW0(ax_form, 1);
    f->lattice = *lattice;
    *lattice = (ax_lattice){0};
    f->unit = unit;
    const ax_linkage* linkage = &f->lattice.linkage;
    size_t n = (size_t)linkage->hinge_count, t = (size_t)linkage->triangle_count;
    f->prescribed = AX_NEW(double, t);
    f->stretch = ax_alloc(t, sizeof *f->stretch);
    f->centres = ax_alloc(t, sizeof *f->centres);
    f->flat = ax_alloc(n, sizeof *f->flat);
    f->deployed = ax_alloc(n, sizeof *f->deployed);
    f->simulated = ax_alloc(n, sizeof *f->simulated);
    f->side = ax_alloc(t, sizeof *f->side);
    f->panel = ax_alloc(t, sizeof *f->panel);
    f->realised = AX_NEW(double, t);
    f->opening = AX_NEW(double, linkage->hole_count + 1);
    f->material = AX_NEW0(double, n);
    f->pull = AX_NEW0(double, t);
    f->scratch = ax_alloc(2 * n, sizeof *f->scratch);
    f->lanes = AX_NEW(double, 3 * t + 6 * (size_t)linkage->hole_count);
    for (size_t k = 0; k < t; ++k) {
        const int* h = linkage->triangles[k];
        f->prescribed[k] = 1;
        f->panel[k] = shape_of(f, (int)k);
        for (int c = 0; c < 2; ++c) {
            f->centres[k][c] =
                (f->lattice.hinges[h[0]][c] + f->lattice.hinges[h[1]][c] + f->lattice.hinges[h[2]][c]) / 3;
            f->centre[c] += f->centres[k][c] / (double)t;
        }
        for (int c = 0; c < 3; ++c)
            f->stretch[k][c] = f->panel[k].edge[c], f->side[k][c] = ax_form_edge(f, (int)k, c);
    }
    for (size_t k = 0; k < t; ++k)
        f->radius = fmax(f->radius, ax_distance2(f->centres[k], f->centre));
    f->holes = AX_NEW(int, linkage->hole_count + 1);
    for (int k = 0; k < linkage->hole_count; ++k)
        if (linkage->hole_start[k + 1] - linkage->hole_start[k] == 6)
            f->holes[f->hole_count++] = k;
    list_mouths(f);
    list_lines(f);
    list_wide(f);
    f->mouth_min = standard_mouth;
    f->released = true;
    f->dynamics = ax_form_dynamics_default();
    f->growth = 1;
    f->pool = ax_pool_make(0);
    f->stale = true;
    return f;
}

void ax_form_use_threads(ax_form* f, int threads)
{
    if (ax_pool_threads(f->pool) == threads)
        return;
    size_t count;
    double* multipliers = ax_form_multipliers(f, &count);
    ax_form_drop_solvers(f); // they borrow the pool
    ax_free(f->pending);
    f->pending = multipliers;
    f->pending_count = count;
    ax_pool_free(f->pool);
    f->pool = ax_pool_make(threads);
}

void ax_form_free(ax_form* f)
{
    if (!f)
        return;
    ax_form_drop_solvers(f);
    ax_pool_free(f->pool);
    ax_lattice_free(&f->lattice);
    for (int k = 0; k < f->rim_count; ++k)
        ax_rim_part_release(f->rim + k);
    for (int k = 0; k < f->held_count; ++k)
        ax_form_constraint_release(f->held + k);
    for (int k = 0; k < f->set_count; ++k) {
        ax_free(f->sets[k].name);
        ax_free(f->sets[k].hinges);
    }
    for (int k = 0; k < f->underlay_count; ++k) {
        ax_free((void*)f->underlay_names[k]);
        ax_mesh_free(f->underlays + k);
    }
    void* blocks[] = {f->wide,
                      f->centres,
                      f->mouths,
                      f->lines,
                      f->bends,
                      f->holder,
                      f->holes,
                      f->prescribed,
                      f->rim,
                      f->held,
                      f->sets,
                      f->underlays,
                      f->flat,
                      f->deployed,
                      f->simulated,
                      f->side,
                      f->underlay_names,
                      f->clearances,
                      f->pending,
                      f->realised,
                      f->opening,
                      f->material,
                      f->scratch,
                      f->lanes,
                      f->stretch,
                      f->pull,
                      f->outline,
                      f->panel,
                      f->drawn,
                      f->coarse.deployed,
                      f->coarse.simulated};
    for (size_t k = 0; k < sizeof blocks / sizeof *blocks; ++k)
        ax_free(blocks[k]);
    ax_form_free(f->coarser);
    ax_free(f);
}

void ax_form_twist(ax_form* f)
{
    ax_lattice_twist(&f->lattice, f->prescribed, f->flat);
}

ax_status ax_form_make(const ax_form_start* start, ax_form** out, ax_error* error)
{
    *out = NULL;
    ax_lattice lattice;
    ax_status status = ax_form_lay(start, &lattice, error);
    if (status != AX_OK)
        return status;
    ax_form* f = ax_form_over(&lattice, start->unit);
    f->outline_count = start->outline_count;
    f->outline = ax_copy(start->outline, (size_t)start->outline_count, sizeof *start->outline);
    for (int t = 0; t < f->lattice.linkage.triangle_count; ++t) {
        f->prescribed[t] = start->scale;
        for (int k = 0; k < 3; ++k)
            f->side[t][k] = ax_form_edge(f, t, k);
    }
    ax_form_twist(f);
    for (int h = 0; h < f->lattice.linkage.hinge_count; ++h)
        for (int c = 0; c < 3; ++c)
            f->deployed[h][c] = c < 2 ? f->centre[c] + start->scale * (f->lattice.hinges[h][c] - f->centre[c]) : 0;
    memcpy(f->simulated, f->deployed, (size_t)f->lattice.linkage.hinge_count * sizeof *f->simulated);
    *out = f;
    return AX_OK;
}

// Sheet of a linkage that is known by its panels' places in the lattice only.
static void lay_by_panels(ax_lattice* lattice)
{
    const ax_linkage* linkage = &lattice->linkage;
    double across[2] = {0.5, 0.5 * sqrt(3)};
    for (int t = 0; t < linkage->triangle_count; ++t) {
        const int* panel = linkage->panels[t];
        double third = panel[2] ? 2.0 / 3 : 1.0 / 3;
        double i = panel[0] + third, j = panel[1] + third;
        double centre[2] = {lattice->spacing * (i + j * across[0]), lattice->spacing * j * across[1]};
        // corners of up panels: right side, left side, base (ax_lattice_lay); of down panels the same turned round
        for (int k = 0; k < 3; ++k) {
            double angle = (30 + 120 * k + (panel[2] ? 60 : 0)) * AX_PI / 180;
            double r = lattice->spacing / (2 * sqrt(3));
            int h = linkage->triangles[t][k];
            lattice->hinges[h][0] = centre[0] + r * cos(angle);
            lattice->hinges[h][1] = centre[1] + r * sin(angle);
        }
    }
}

static int ascending(const void* a, const void* b)
{
    double x = *(const double*)a, y = *(const double*)b;
    return (x > y) - (x < y);
}

// All hinges on the surface that the design was made for, until that is released.
static ax_status hold_on_target(ax_form* f, const ax_mesh* target, ax_error* error)
{
    int n = f->lattice.linkage.hinge_count, *all = AX_NEW(int, n);
    for (int h = 0; h < n; ++h)
        all[h] = h;
    ax_form_constraint c = {
        .name = "target", .kind = AX_HELD_SURFACE, .count = n, .hinges = all, .weight = 1, .surface = target};
    ax_status status = ax_form_put_constraint(f, &c, error);
    ax_free(all);
    return status;
}

ax_status ax_form_from_design(const ax_design* design, ax_form** out, ax_error* error)
{
    *out = NULL;
    const ax_linkage* from = &design->linkage;
    if (from->triangle_count < AX_FORM_LEAST)
        return ax_fail(error, AX_USAGE, "A design of %d triangles is too small.", from->triangle_count);
    ax_lattice lattice = {.linkage = ax_linkage_copy(from),
                          .hinges = ax_calloc((size_t)from->hinge_count, sizeof *lattice.hinges)};
    // the spacing that the scale factors refer to: 2 L / lambda, the same for all but for the measuring of lambda
    double* spacing = AX_NEW(double, from->triangle_count);
    for (int t = 0; t < from->triangle_count; ++t) {
        const int* h = from->triangles[t];
        double sum = 0;
        for (int k = 0; k < 3; ++k)
            sum += ax_distance2(design->flat[h[k]], design->flat[h[(k + 1) % 3]]);
        spacing[t] = 2 * sum / (3 * design->scale[t]);
    }
    qsort(spacing, (size_t)from->triangle_count, sizeof *spacing, ascending);
    lattice.spacing = spacing[from->triangle_count / 2];
    ax_free(spacing);
    lay_by_panels(&lattice);
    ax_form* f = ax_form_over(&lattice, design->unit);
    size_t n = (size_t)from->hinge_count;
    memcpy(f->flat, design->flat, n * sizeof *f->flat);
    memcpy(f->deployed, design->deployed, n * sizeof *f->deployed);
    memcpy(f->simulated, design->simulated ? design->simulated : design->deployed, n * sizeof *f->simulated);
    f->mouth_min = design->mouth_min * AX_PI / 180;
    f->released = design->border == AX_BORDER_RELEASED;
    for (int t = 0; t < from->triangle_count; ++t) {
        const int* h = from->triangles[t];
        f->prescribed[t] = ax_clamp(design->scale[t], 1, 2);
        for (int k = 0; k < 3; ++k) {
            f->side[t][k] = ax_distance2(f->flat[h[(k + 1) % 3]], f->flat[h[(k + 2) % 3]]);
            f->stretch[t][k] = 2 * f->side[t][k] / (f->prescribed[t] * f->lattice.spacing);
        }
    }
    ax_form_spare_uneven(f);
    // the rim stays where it is
    int* rim = AX_NEW(int, n);
    double(*places)[3] = ax_alloc(n, sizeof *places);
    int count = 0;
    for (int h = 0; h < from->hinge_count; ++h)
        if (design->supports ? design->supports[h] : from->on_rim[h]) {
            rim[count] = h;
            memcpy(places[count++], design->deployed[h], sizeof *places);
        }
    ax_rim_part part = {.kind = AX_RIM_FIXED, .count = count, .hinges = rim, .places = (const double(*)[3])places};
    ax_status status = count ? ax_form_set_rim(f, 1, &part, error) : AX_OK;
    ax_free(rim);
    ax_free(places);
    if (design->target.face_count && status == AX_OK)
        status = hold_on_target(f, &design->target, error);
    f->dynamics.load = design->load;
    f->dynamics.kind = design->load.kind == AX_LOAD_GRAVITY     ? AX_DYNAMICS_GRAVITY
                       : design->load.kind == AX_LOAD_INFLATION ? AX_DYNAMICS_INFLATION
                                                                : AX_DYNAMICS_EXPAND;
    f->exact = f->settled = true;
    if (status == AX_OK)
        *out = f;
    else
        ax_form_free(f);
    return status;
}

// ---- what is asked ------------------------------------------------------------------------------------------------------------

void ax_form_changed(ax_form* f, bool rebuild, bool forget)
{
    ++f->revision;
    f->exact = f->settled = false;
    if (forget) {
        ax_free(f->pending);
        f->pending = NULL;
        if (f->shape)
            ax_solver_reset_multipliers(f->shape);
        if (f->hang)
            ax_solver_reset_multipliers(f->hang);
    }
    f->stale = f->stale || rebuild;
    if (rebuild)
        f->outdated = true, f->folds = 0; // what a start afresh leaves is not known any more
}

void ax_form_prescribe(ax_form* f, const double* scale)
{
    for (int t = 0; t < f->lattice.linkage.triangle_count; ++t)
        f->prescribed[t] = ax_clamp(scale[t], 1, 2);
    ax_form_changed(f, false, false);
}

void ax_form_set_mouth_min(ax_form* f, double angle)
{
    f->mouth_min = ax_clamp(angle, 0, AX_PI / 3);
    ax_form_changed(f, true, true);
}

typedef struct ranked {
    int rank, hinge;
} ranked;

static int by_rank(const void* a, const void* b)
{
    const ranked *x = a, *y = b;
    return x->rank != y->rank ? x->rank - y->rank : x->hinge - y->hinge;
}

// Brings the hinges of a part that slides into their order round the rim; a part of the rim starts after its longest gap.
static void order_part(const ax_linkage* linkage, ax_rim_part* part)
{
    int *order = AX_NEW(int, linkage->hinge_count), count = ax_linkage_rim(linkage, order);
    int* rank = AX_NEW(int, linkage->hinge_count);
    for (int h = 0; h < linkage->hinge_count; ++h)
        rank[h] = count;
    for (int k = 0; k < count; ++k)
        rank[order[k]] = k;
    ranked* sorted = AX_NEW(ranked, part->count + 1);
    for (int k = 0; k < part->count; ++k)
        sorted[k] = (ranked){rank[part->hinges[k]], part->hinges[k]};
    qsort(sorted, (size_t)part->count, sizeof *sorted, by_rank);
    int first = 0, widest = -1;
    for (int k = 0; k < part->count; ++k) {
        int gap = k ? sorted[k].rank - sorted[k - 1].rank : sorted[0].rank + count - sorted[part->count - 1].rank;
        if (gap > widest)
            widest = gap, first = k;
    }
    for (int k = 0; k < part->count; ++k)
        ((int*)part->hinges)[k] = sorted[(first + k) % part->count].hinge;
    ax_free(sorted);
    ax_free(rank);
    ax_free(order);
}

ax_status ax_form_set_rim(ax_form* f, int count, const ax_rim_part* parts, ax_error* error)
{
    const ax_linkage* linkage = &f->lattice.linkage;
    ax_status status = ax_form_check_rim(f, count, parts, error);
    if (status != AX_OK)
        return status;
    ax_rim_part* copies = AX_NEW0(ax_rim_part, count + 1);
    for (int k = 0; k < count; ++k) {
        copies[k] = ax_rim_part_copy(parts + k);
        if (copies[k].kind == AX_RIM_SLIDE)
            order_part(linkage, copies + k);
    }
    for (int k = 0; k < f->rim_count; ++k)
        ax_rim_part_release(f->rim + k);
    ax_free(f->rim);
    f->rim = copies;
    f->rim_count = count;
    ax_form_changed(f, true, true);
    return AX_OK;
}

void ax_form_release_border(ax_form* f, bool released)
{
    if (f->released == released)
        return;
    f->released = released;
    ax_form_changed(f, true, true);
}

// Mean height of the deployed hinges above the rim's.
static double bulge(const ax_form* f, double* level)
{
    const ax_linkage* linkage = &f->lattice.linkage;
    double middle = 0;
    int rim = 0;
    *level = 0;
    for (int h = 0; h < linkage->hinge_count; ++h) {
        middle += f->deployed[h][2] / linkage->hinge_count;
        if (linkage->on_rim[h])
            *level += f->deployed[h][2], ++rim;
    }
    *level /= rim;
    return middle - *level;
}

double ax_form_bulge(const ax_form* f)
{
    double level;
    return bulge(f, &level);
}

// A sheet that bulges against its load would have to snap through: it is mirrored in the level of its rim, its panels do not mind. One
// that is held on something in space stays, and is loaded towards the side to which it bulges: an upright dome hangs upside down.
static void face_load(ax_form* f)
{
    if (!ax_form_hangs(f))
        return;
    const ax_linkage* linkage = &f->lattice.linkage;
    ax_form_stand stand;
    ax_form_stand_on(f, &stand);
    if (stand.axis[2][2] < sqrt(0.5)) // upright, it has no level
        return;
    double towards = f->dynamics.kind == AX_DYNAMICS_GRAVITY ? f->dynamics.load.direction[2] : 1, level;
    if (bulge(f, &level) * towards >= 0)
        return;
    for (int c = 0; c < f->held_count && f->dynamics.kind == AX_DYNAMICS_GRAVITY; ++c)
        if (f->held[c].kind == AX_HELD_SURFACE) {
            for (int d = 0; d < 3; ++d)
                f->dynamics.load.direction[d] = -f->dynamics.load.direction[d];
            return;
        }
    for (int h = 0; h < linkage->hinge_count; ++h)
        f->deployed[h][2] = 2 * level - f->deployed[h][2], f->simulated[h][2] = 2 * level - f->simulated[h][2];
}

void ax_form_set_dynamics(ax_form* f, const ax_form_dynamics* dynamics)
{
    bool kind = f->dynamics.kind != dynamics->kind || f->dynamics.adapt != dynamics->adapt;
    bool load = memcmp(f->dynamics.load.direction, dynamics->load.direction, sizeof dynamics->load.direction) != 0;
    // what was hung under one load is the best start for the next, and the open state for the first one
    if (kind && !ax_form_hangs(f))
        memcpy(f->simulated, f->deployed, (size_t)f->lattice.linkage.hinge_count * sizeof *f->simulated);
    else if (kind && dynamics->kind == AX_DYNAMICS_EXPAND && !ax_form_shares(f))
        memcpy(f->deployed, f->simulated, (size_t)f->lattice.linkage.hinge_count * sizeof *f->deployed);
    f->dynamics = *dynamics;
    if (kind || load)
        face_load(f);
    f->growth = dynamics->collisions ? f->growth : 1;
    ax_form_changed(f, kind || load, kind || load);
    f->outdated = true;
}

const ax_form_dynamics* ax_form_get_dynamics(const ax_form* f)
{
    return &f->dynamics;
}

ax_status ax_form_put_constraint(ax_form* f, const ax_form_constraint* constraint, ax_error* error)
{
    ax_status status = ax_form_check_constraint(f, constraint, error);
    if (status != AX_OK)
        return status;
    ax_form_constraint copy = ax_form_constraint_copy(constraint);
    int at = 0;
    while (at < f->held_count && strcmp(f->held[at].name, constraint->name) != 0)
        ++at;
    if (at == f->held_count)
        f->held = ax_realloc(f->held, (size_t)++f->held_count, sizeof *f->held);
    else
        ax_form_constraint_release(f->held + at);
    f->held[at] = copy;
    ax_form_changed(f, true, true);
    return AX_OK;
}

bool ax_form_drop_constraint(ax_form* f, const char* name)
{
    for (int k = 0; k < f->held_count; ++k)
        if (strcmp(f->held[k].name, name) == 0) {
            ax_form_drop_solvers(f);
            ax_form_constraint_release(f->held + k);
            memmove(f->held + k, f->held + k + 1, (size_t)(--f->held_count - k) * sizeof *f->held);
            ax_form_changed(f, true, true);
            return true;
        }
    return false;
}

void ax_form_name_selection(ax_form* f, const char* name, int count, const int* hinges)
{
    int at = 0;
    while (at < f->set_count && strcmp(f->sets[at].name, name) != 0)
        ++at;
    if (at == f->set_count) {
        f->sets = ax_realloc(f->sets, (size_t)++f->set_count, sizeof *f->sets);
        f->sets[at].name = ax_copy_text(name);
    } else
        ax_free(f->sets[at].hinges);
    f->sets[at].count = count;
    f->sets[at].hinges = ax_copy(hinges, (size_t)count, sizeof *hinges);
    ++f->revision;
}

const int* ax_form_selection(const ax_form* f, const char* name, int* count)
{
    for (int k = 0; k < f->set_count; ++k)
        if (strcmp(f->sets[k].name, name) == 0) {
            *count = f->sets[k].count;
            return f->sets[k].hinges;
        }
    return NULL;
}

void ax_form_put_underlay(ax_form* f, const char* name, const ax_mesh* mesh, double clearance)
{
    int at = 0;
    while (at < f->underlay_count && strcmp(f->underlay_names[at], name) != 0)
        ++at;
    if (at == f->underlay_count) {
        size_t count = (size_t)++f->underlay_count;
        f->underlay_names = ax_realloc((void*)f->underlay_names, count, sizeof *f->underlay_names);
        f->underlays = ax_realloc(f->underlays, count, sizeof *f->underlays);
        f->clearances = ax_realloc(f->clearances, count, sizeof *f->clearances);
        f->underlay_names[at] = ax_copy_text(name);
    } else
        ax_mesh_free(f->underlays + at);
    f->underlays[at] = ax_mesh_copy(mesh);
    f->clearances[at] = clearance;
    ++f->revision;
}

int ax_form_rim(const ax_form* f, const ax_rim_part** parts)
{
    *parts = f->rim;
    return f->rim_count;
}

int ax_form_constraints(const ax_form* f, const ax_form_constraint** constraints)
{
    *constraints = f->held;
    return f->held_count;
}

int ax_form_underlays(const ax_form* f, const char*** names, const ax_mesh** meshes, const double** clearances)
{
    *names = f->underlay_names;
    *meshes = f->underlays;
    *clearances = f->clearances;
    return f->underlay_count;
}
