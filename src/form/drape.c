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

// Panels, holes as fans about a point in their middle, and what is open along the rim: the open linkage as one surface over the deployed hinges.
static ax_mesh cover(const ax_form* f)
{
    const ax_linkage* l = &f->lattice.linkage;
    int n = l->hinge_count,
        faces = l->triangle_count + l->hole_start[l->hole_count] + l->opening_start[l->opening_count];
    ax_mesh mesh = {.vertex_count = n + l->hole_count, .face_count = 0};
    mesh.positions = ax_alloc((size_t)mesh.vertex_count, sizeof *mesh.positions);
    mesh.faces = ax_alloc((size_t)faces, sizeof *mesh.faces);
    memcpy(mesh.positions, f->deployed, (size_t)n * sizeof *f->deployed);
    for (int t = 0; t < l->triangle_count; ++t)
        memcpy(mesh.faces[mesh.face_count++], l->triangles[t], sizeof *mesh.faces);
    for (int k = 0; k < l->hole_count; ++k) {
        const int* h = l->hole_hinges + l->hole_start[k];
        int count = l->hole_start[k + 1] - l->hole_start[k];
        double* middle = mesh.positions[n + k];
        memset(middle, 0, 3 * sizeof *middle);
        for (int i = 0; i < count; ++i) {
            for (int c = 0; c < 3; ++c)
                middle[c] += f->deployed[h[i]][c] / count;
            int* face = mesh.faces[mesh.face_count++];
            face[0] = h[i], face[1] = h[(i + 1) % count], face[2] = n + k;
        }
    }
    for (int k = 0; k < l->opening_count; ++k)
        for (int i = l->opening_start[k] + 1; i + 1 < l->opening_start[k + 1]; ++i) {
            int* face = mesh.faces[mesh.face_count++];
            face[0] = l->opening_hinges[l->opening_start[k]];
            face[1] = l->opening_hinges[i], face[2] = l->opening_hinges[i + 1];
        }
    return mesh;
}

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

// Lays the sheet, turned, shifted and scaled as a whole, as near as it goes to what its rim is held by (Besl and McKay 1992, iterated
// closest points), from its own middle and the middle of those; then puts the rim there. Elsewhere the sheet lies level.
static void lay_on_rim(ax_form* f)
{
    enum { ROUNDS = 50, SAMPLES = 200 };
    const ax_linkage* l = &f->lattice.linkage;
    double(*to)[3] = ax_calloc((size_t)l->hinge_count, sizeof *to);
    double middle[2] = {0, 0}, spread = 0, weight = 0; // of what holds the rim, by numbers of hinges
    for (int pass = 0; pass < 2; ++pass) {
        for (int k = 0; k < f->rim_count; ++k) {
            const ax_rim_part* part = f->rim + k;
            bool fixed = part->kind == AX_RIM_FIXED;
            const ax_curve* curve = f->rim_holder[k].curve;
            bool bounded = !fixed && isfinite(ax_curve_extent(curve).to);
            double whole = bounded ? ax_curve_length(curve, ax_curve_extent(curve).to) : 0;
            int count = fixed ? part->count : SAMPLES;
            for (int i = 0; i < count && (fixed || bounded); ++i) {
                double x[3];
                if (fixed)
                    memcpy(x, part->places[i], sizeof x);
                else
                    ax_curve_point(curve, ax_curve_at_length(curve, whole * (i + 0.5) / count), x);
                double share = (double)part->count / count;
                for (int c = 0; c < 2 && pass == 0; ++c)
                    middle[c] += share * x[c];
                weight += pass == 0 ? share : 0;
                spread += pass == 1 ? share * (pow(x[0] - middle[0], 2) + pow(x[1] - middle[1], 2)) : 0;
            }
        }
        for (int c = 0; c < 2 && pass == 0; ++c)
            middle[c] /= fmax(weight, 1);
    }
    double own[2] = {0, 0}, own_spread = 0;
    int rim = 0;
    for (int h = 0; h < l->hinge_count; ++h)
        for (int c = 0; c < 2 && l->on_rim[h]; rim += c == 0, ++c)
            own[c] += f->lattice.hinges[h][c];
    own[0] /= rim, own[1] /= rim;
    for (int h = 0; h < l->hinge_count; ++h)
        own_spread += l->on_rim[h] ? pow(ax_distance2(f->lattice.hinges[h], own), 2) : 0;
    // the map z -> turn z + shift of the plane, as complex numbers
    double turn[2] = {weight > 0 && spread > 0 ? sqrt(spread / weight * rim / own_spread) : 1, 0}, shift[2], level = 0;
    shift[0] = weight > 0 ? middle[0] - turn[0] * own[0] : 0, shift[1] = weight > 0 ? middle[1] - turn[0] * own[1] : 0;
    for (int round = 0; round <= ROUNDS; ++round) {
        for (int h = 0; h < l->hinge_count; ++h) {
            const double* z = f->lattice.hinges[h];
            f->deployed[h][0] = turn[0] * z[0] - turn[1] * z[1] + shift[0];
            f->deployed[h][1] = turn[1] * z[0] + turn[0] * z[1] + shift[1];
            f->deployed[h][2] = level;
        }
        aim_rim(f, (const double(*)[3])f->deployed, to);
        double re = 0, im = 0, mean[3] = {0, 0, 0};
        for (int h = 0; h < l->hinge_count; ++h)
            for (int c = 0; c < 3 && l->on_rim[h]; ++c)
                mean[c] += to[h][c] / rim;
        for (int h = 0; h < l->hinge_count; ++h)
            if (l->on_rim[h]) {
                double x = f->lattice.hinges[h][0] - own[0], y = f->lattice.hinges[h][1] - own[1];
                double u = to[h][0] - mean[0], v = to[h][1] - mean[1];
                re += (x * u + y * v) / own_spread, im += (x * v - y * u) / own_spread;
            }
        turn[0] = re, turn[1] = im, level = mean[2];
        shift[0] = mean[0] - re * own[0] + im * own[1], shift[1] = mean[1] - im * own[0] - re * own[1];
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
    ax_mesh film = cover(f);
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
