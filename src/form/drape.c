// Draping: scale factors of a sheet that hangs from its rim like a film.
//
// Under an even load a film in even tension has div grad z = const over its plan: it curves to the load's side everywhere, between lobes and
// round re-entrant corners too, where fields painted by hand leave the sheet slack or so taut that no finite force holds it. Sizes that
// keep every hole open on such a surface are the conformal factors, which the shape system finds when panels give way.
#include "form/state.h"

#include "base/vec.h"
#include "linalg/cholesky.h"

#include <assert.h>
#include <math.h>
#include <string.h>

static const double draping_give = 30;

// The net of the cover's edges with one tension per length in all of them (Schek 1974, The force density method), held at the rim where it
// is: its places without a load, and how far an even load sinks them, 1 at most. Both per vertex.
static void hang_net(const ax_form* f, ax_mesh* net, double* sunk)
{
    const ax_linkage* l = &f->lattice.linkage;
    int v = net->vertex_count;
    const double hold = 1e9;
    ax_entries entries = {0};
    double* columns = AX_NEW0(double, 4 * (size_t)v);
    for (int i = 0; i < v; ++i) {
        bool held = i < l->hinge_count && l->on_rim[i];
        ax_entries_add(&entries, i, i, held ? hold : 0);
        for (int c = 0; c < 3 && held; ++c)
            columns[(size_t)c * (size_t)v + (size_t)i] = hold * net->positions[i][c];
        columns[3 * (size_t)v + (size_t)i] = held ? 0 : 1;
    }
    for (int k = 0; k < net->face_count; ++k)
        for (int c = 0; c < 3; ++c) {
            int i = net->faces[k][c], j = net->faces[k][(c + 1) % 3];
            ax_entries_add(&entries, i, i, 1);
            ax_entries_add(&entries, j, j, 1);
            ax_entries_add(&entries, i, j, -1);
        }
    ax_sparse matrix = ax_entries_sparse(&entries, v);
    ax_cholesky* factor = ax_cholesky_analyse(&matrix);
    bool definite = ax_cholesky_factor(factor, &matrix);
    assert(definite); // connected, and held at the rim
    (void)definite;
    ax_cholesky_solve(factor, columns, columns, 4);
    double most = 0;
    for (int i = 0; i < v; ++i) {
        for (int c = 0; c < 3; ++c)
            net->positions[i][c] = columns[(size_t)c * (size_t)v + (size_t)i];
        sunk[i] = columns[3 * (size_t)v + (size_t)i];
        most = fmax(most, sunk[i]);
    }
    for (int i = 0; i < v; ++i)
        sunk[i] /= most;
    ax_cholesky_free(factor);
    ax_sparse_free(&matrix);
    ax_free(columns);
}

// Where the hinges of the rim are to be, given where they are: fixed places, or the nearest of their curve.
static void aim_rim(const ax_form* f, const double (*at)[3], double (*to)[3])
{
    for (int k = 0; k < f->rim_count; ++k)
        for (int i = 0; i < f->rim[k].count; ++i) {
            int h = f->rim[k].hinges[i];
            if (f->rim[k].kind == AX_RIM_FIXED)
                memcpy(to[h], f->rim[k].places[i], sizeof *to);
            else
                ax_curve_nearest(f->rim_holder[k].curve, at[h], to[h]);
        }
}

// Points of a plane: how many or with what weight, their middle, and the sum of their squared distances from it.
typedef struct cloud {
    double weight, middle[2], spread;
} cloud;

// Points are added in any order (Welford 1962).
static void add_point(cloud* c, const double at[2], double weight)
{
    double off[2] = {at[0] - c->middle[0], at[1] - c->middle[1]};
    c->weight += weight;
    for (int d = 0; d < 2; ++d) {
        c->middle[d] += weight / c->weight * off[d];
        c->spread += weight * off[d] * (at[d] - c->middle[d]);
    }
}

// What holds the rim, seen from above: fixed places, and bounded curves with the weight of the hinges on them.
static cloud cloud_of_holders(const ax_form* f)
{
    enum { SAMPLES = 200 };
    cloud c = {0};
    for (int k = 0; k < f->rim_count; ++k) {
        const ax_rim_part* part = f->rim + k;
        const ax_curve* curve = f->rim_holder[k].curve;
        if (part->kind == AX_RIM_FIXED)
            for (int i = 0; i < part->count; ++i)
                add_point(&c, part->places[i], 1);
        else if (isfinite(ax_curve_extent(curve).to)) {
            double whole = ax_curve_length(curve, ax_curve_extent(curve).to), x[3];
            for (int i = 0; i < SAMPLES; ++i) {
                ax_curve_point(curve, ax_curve_at_length(curve, whole * (i + 0.5) / SAMPLES), x);
                add_point(&c, x, (double)part->count / SAMPLES);
            }
        }
    }
    return c;
}

static cloud cloud_of_rim(const ax_form* f)
{
    cloud c = {0};
    for (int h = 0; h < f->lattice.linkage.hinge_count; ++h)
        if (f->lattice.linkage.on_rim[h])
            add_point(&c, f->lattice.hinges[h], 1);
    return c;
}

// z -> turn z + shift of the sheet's plane, as complex numbers, onto a level one.
typedef struct laying {
    double turn[2], shift[2], level;
} laying;

static void lay(ax_form* f, const laying* at)
{
    for (int h = 0; h < f->lattice.linkage.hinge_count; ++h) {
        const double* z = f->lattice.hinges[h];
        f->deployed[h][0] = at->turn[0] * z[0] - at->turn[1] * z[1] + at->shift[0];
        f->deployed[h][1] = at->turn[1] * z[0] + at->turn[0] * z[1] + at->shift[1];
        f->deployed[h][2] = at->level;
    }
}

// The laying that brings the rim nearest to `to`, in least squares.
static laying fit(const ax_form* f, const cloud* rim, const double (*to)[3])
{
    const ax_linkage* l = &f->lattice.linkage;
    double mean[3] = {0, 0, 0}, re = 0, im = 0;
    for (int h = 0; h < l->hinge_count; ++h)
        for (int c = 0; c < 3 && l->on_rim[h]; ++c)
            mean[c] += to[h][c] / rim->weight;
    for (int h = 0; h < l->hinge_count; ++h)
        if (l->on_rim[h]) {
            double x = f->lattice.hinges[h][0] - rim->middle[0], y = f->lattice.hinges[h][1] - rim->middle[1];
            double u = to[h][0] - mean[0], v = to[h][1] - mean[1];
            re += (x * u + y * v) / rim->spread, im += (x * v - y * u) / rim->spread;
        }
    return (laying){
        {re, im},
        {mean[0] - re * rim->middle[0] + im * rim->middle[1], mean[1] - im * rim->middle[0] - re * rim->middle[1]},
        mean[2]};
}

// Lays the sheet, turned, shifted and scaled as a whole, as near as it goes to what its rim is held by (Besl and McKay 1992, iterated
// closest points), from its own middle and the middle of those; then puts the rim there. Elsewhere the sheet lies level.
static void lay_on_rim(ax_form* f)
{
    enum { ROUNDS = 50 };
    const ax_linkage* l = &f->lattice.linkage;
    double(*to)[3] = ax_calloc((size_t)l->hinge_count, sizeof *to);
    cloud rim = cloud_of_rim(f), holders = cloud_of_holders(f);
    laying at = {.turn = {1, 0}};
    if (holders.weight > 0) {
        if (holders.spread > 0)
            at.turn[0] = sqrt(holders.spread / holders.weight * rim.weight / rim.spread);
        for (int d = 0; d < 2; ++d)
            at.shift[d] = holders.middle[d] - at.turn[0] * rim.middle[d];
    }
    lay(f, &at);
    for (int round = 0; round <= ROUNDS; ++round) {
        aim_rim(f, (const double(*)[3])f->deployed, to);
        if (round < ROUNDS) {
            at = fit(f, &rim, (const double(*)[3])to);
            lay(f, &at);
        }
    }
    for (int h = 0; h < l->hinge_count; ++h)
        if (l->on_rim[h])
            memcpy(f->deployed[h], to[h], sizeof *to);
    ax_free(to);
}

static bool is_held_all_round(const ax_form* f, int* loose)
{
    const ax_linkage* l = &f->lattice.linkage;
    unsigned char* held = AX_NEW0(unsigned char, l->hinge_count);
    for (int k = 0; k < f->rim_count; ++k)
        for (int i = 0; i < f->rim[k].count; ++i)
            held[f->rim[k].hinges[i]] = f->rim[k].kind != AX_RIM_FREE;
    *loose = -1;
    for (int h = 0; h < l->hinge_count && *loose < 0; ++h)
        *loose = l->on_rim[h] && !held[h] ? h : -1;
    ax_free(held);
    return *loose < 0;
}

// Shapes the sheet on the film; what it takes on is in the sides.
static ax_status shape_on(ax_form* f, const ax_mesh* film, const ax_progress* progress, ax_error* error)
{
    static const char name[] = "drape";
    const ax_linkage* l = &f->lattice.linkage;
    int *inner = AX_NEW(int, l->hinge_count), count = 0;
    for (int h = 0; h < l->hinge_count; ++h) {
        memcpy(f->deployed[h], film->positions[h], sizeof *f->deployed);
        if (!l->on_rim[h])
            inner[count++] = h;
    }
    const ax_form_constraint on = {
        .name = name, .kind = AX_HELD_SURFACE, .count = count, .hinges = inner, .weight = 1, .surface = film};
    ax_status status = ax_form_put_constraint(f, &on, error);
    if (status == AX_OK)
        status = ax_form_settle(f, 0, progress, error);
    ax_free(inner);
    return status;
}

ax_status ax_form_drape(ax_form* f, double depth, const ax_progress* progress, ax_error* error)
{
    const ax_linkage* l = &f->lattice.linkage;
    int loose;
    if (!is_held_all_round(f, &loose))
        return ax_fail(error, AX_CANNOT_REALISE,
                       "A film needs a rim that is held all the way round, and hinge %d is free: put rim_polyline, "
                       "rim_spline or another rim before it.",
                       loose);
    ax_form_dynamics before = f->dynamics, opening = f->dynamics;
    opening.kind = AX_DYNAMICS_EXPAND, opening.adapt = true, opening.give = draping_give;
    ax_form_set_dynamics(f, &opening);
    ax_form_build(f);
    lay_on_rim(f);
    ax_mesh film = ax_linkage_cover(l, (const double(*)[3])f->deployed);
    double* sunk = AX_NEW(double, film.vertex_count);
    hang_net(f, &film, sunk);
    for (int i = 0; i < film.vertex_count; ++i)
        film.positions[i][2] -= depth * sunk[i];
    ax_status status = shape_on(f, &film, progress, error);
    ax_free(sunk);
    ax_mesh_free(&film);
    for (int t = 0; t < l->triangle_count && status == AX_OK; ++t)
        f->prescribed[t] =
            ax_clamp(2 * (f->side[t][0] + f->side[t][1] + f->side[t][2]) / (3 * f->lattice.spacing), 1, 2);
    if (before.kind == AX_DYNAMICS_NONE)
        before.kind = AX_DYNAMICS_EXPAND;
    ax_form_set_dynamics(f, &before);
    return status;
}
