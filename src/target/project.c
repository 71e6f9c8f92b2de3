// The nearest surface of positive mean curvature outside a given one, rim fixed, as an obstacle problem: with x = x0 +
// h n along fixed directions n, find h >= 0 with H >= eps where h = 0 and H = eps where h > 0. H is that of the
// cotangent Laplacian, whose weights lag one step behind (Pinkall and Polthier 1993, for minimal surfaces); each linear
// complementarity problem is solved by a primal-dual active set (Hintermueller, Ito and Kunisch 2002). A mean curvature
// flow that only moves outward took 200 steps where this takes ten, and broke meshes with deep valleys:
// docs/projection.md.
#include "ax/target.h"

#include "base/vec.h"
#include "linalg/cholesky.h"
#include "mesh/geometry.h"
#include "mesh/topology.h"
#include "target/curvature.h"

#include <assert.h>
#include <string.h>

// eps in units of 1 / sqrt(area). A bare H > 0 leaves parts so flat that they deploy badly.
static const double LEAST_CURVATURE = 0.3;
// The linear problems aim this much higher, so that what the lagging weights lose does not fall below eps.
static const double AIM = 1.02;
static const double SETTLED = 1e-6; // largest change of h in a step, over the diagonal
enum { MOST_STEPS = 60, MOST_ACTIVE_SETS = 40, MOST_HALVINGS = 6 };

typedef struct obstacle {
    const ax_mesh* start; // the given surface, near the origin to keep digits
    ax_mesh mesh;         // start + h direction
    double (*direction)[3];
    double *h, *trial;
    unsigned char* on_rim;
    int* order;          // of elimination, that of all vertices: good for any set of them
    ax_cholesky* factor; // for those that `factored` tells
    bool* factored;
    double curvature; // eps
    double diagonal;
    const ax_progress* progress;
    double change; // of h in the last step, over the diagonal; infinite before the first
    bool cancelled;
} obstacle;

static bool go_on(obstacle* o)
{
    double fraction = isinf(o->change) ? 0 : ax_clamp(log(o->change) / log(SETTLED), 0, 1);
    o->cancelled = !ax_progress_report(o->progress, "Projecting to positive mean curvature", fraction, o->change);
    return !o->cancelled;
}

static double least_facing(const ax_mesh* mesh, const double axis[3])
{
    double least = INFINITY;
    for (int f = 0; f < mesh->face_count; ++f) {
        double normal[3];
        ax_face_normal(mesh, f, normal);
        least = fmin(least, ax_dot3(normal, axis));
    }
    return least;
}

// Twice the area vector of the surface, which its rim determines, made a unit vector.
static bool mean_normal(const ax_mesh* mesh, double normal[3])
{
    memset(normal, 0, 3 * sizeof *normal);
    for (int f = 0; f < mesh->face_count; ++f) {
        double n[3], area = ax_face_area(mesh, f);
        ax_face_normal(mesh, f, n);
        for (int d = 0; d < 3; ++d)
            normal[d] += area * n[d];
    }
    double length = ax_norm3(normal);
    for (int d = 0; d < 3 && length > 0; ++d)
        normal[d] /= length;
    return length > 0;
}

// The axis along which the surface is a height field, z before the mean normal: along one direction no face can turn
// over, and along z the plan stays as it is.
static bool find_axis(const ax_mesh* mesh, double axis[3])
{
    double axes[3][3] = {{0, 0, 1}, {0, 0, -1}};
    int count = 2 + mean_normal(mesh, axes[2]);
    for (int k = 0; k < count; ++k)
        if (least_facing(mesh, axes[k]) > 0.02) {
            memcpy(axis, axes[k], sizeof axes[k]);
            return true;
        }
    return false;
}

static void move(obstacle* o, const double* h)
{
    for (int v = 0; v < o->mesh.vertex_count; ++v)
        for (int d = 0; d < 3; ++d)
            o->mesh.positions[v][d] = o->start->positions[v][d] + h[v] * o->direction[v][d];
}

// Whether every face still faces the way in which its corners move, if it did so at the start.
static bool faces_outward(const obstacle* o)
{
    for (int f = 0; f < o->mesh.face_count; ++f) {
        const int* corner = o->mesh.faces[f];
        double before[3], now[3], way[3];
        ax_face_normal(o->start, f, before);
        ax_face_normal(&o->mesh, f, now);
        for (int d = 0; d < 3; ++d)
            way[d] = o->direction[corner[0]][d] + o->direction[corner[1]][d] + o->direction[corner[2]][d];
        if (ax_dot3(before, way) > 0 && !(ax_dot3(now, way) > 0))
            return false;
    }
    return true;
}

// The linear problem of one step, weights frozen at the present surface: B h + base >= 0, h >= 0, complementary, with
// B_ij = A_ij n_i.n_j and base_i = n_i.(A x0)_i - 2 m_i eps n_i.N_i, so that B h + base = 2 m (H - eps) to first order.
static void linearise(const obstacle* o, ax_sparse* matrix, double* base)
{
    int n = o->mesh.vertex_count;
    *matrix = ax_cotan_laplacian(&o->mesh);
    double* column = AX_NEW(double, 2 * (size_t)n); // one coordinate of x0, then of A x0
    double(*normal)[3] = ax_alloc((size_t)n, sizeof *normal);
    double* area = AX_NEW(double, n);
    ax_vertex_normals(&o->mesh, normal);
    ax_vertex_areas(&o->mesh, area);
    for (int v = 0; v < n; ++v) {
        double facing = fmax(ax_dot3(o->direction[v], normal[v]), 0.05);
        base[v] = -2 * area[v] * AIM * o->curvature * facing;
    }
    for (int d = 0; d < 3; ++d) {
        for (int v = 0; v < n; ++v)
            column[v] = o->start->positions[v][d];
        ax_sparse_multiply(matrix, column, column + n, 1);
        for (int v = 0; v < n; ++v)
            base[v] += o->direction[v][d] * column[n + v];
    }
    for (int j = 0; j < n; ++j)
        for (int k = matrix->start[j]; k < matrix->start[j + 1]; ++k)
            matrix->value[k] *= ax_dot3(o->direction[j], o->direction[matrix->row[k]]);
    ax_free(column);
    ax_free(normal);
    ax_free(area);
}

// Solves matrix trial = -base for the moved vertices, leaving the others where they are. Sets of moved vertices differ by few from one
// round to the next: they are eliminated in one order, and one that stays is not analysed again.
static bool solve_moved(obstacle* o, const ax_sparse* matrix, const double* base, const bool* moved, int* index)
{
    int n = matrix->n, count = 0;
    double* part = AX_NEW(double, n);
    for (int v = 0; v < n; ++v) {
        index[v] = moved[v] ? count : -1;
        if (moved[v])
            part[count++] = -base[v];
    }
    memset(o->trial, 0, (size_t)n * sizeof *o->trial);
    bool sound = true;
    if (count) {
        ax_sparse active = ax_sparse_principal(matrix, index);
        if (!o->factor || memcmp(o->factored, moved, (size_t)n * sizeof *moved) != 0) {
            int* order = AX_NEW(int, n);
            for (int k = 0, at = 0; k < n; ++k)
                if (moved[o->order[k]])
                    order[at++] = index[o->order[k]];
            ax_cholesky_free(o->factor);
            o->factor = ax_cholesky_analyse_ordered(&active, order);
            memcpy(o->factored, moved, (size_t)n * sizeof *moved);
            ax_free(order);
        }
        sound = ax_cholesky_factor(o->factor, &active);
        if (sound)
            ax_cholesky_solve(o->factor, part, part, 1);
        ax_sparse_free(&active);
        for (int v = 0; v < n && sound; ++v)
            if (moved[v])
                o->trial[v] = part[index[v]];
    }
    ax_free(part);
    return sound;
}

// Solves that problem into o->trial, starting from the set of moved vertices that o->h and the residual suggest.
static bool solve_complementarity(obstacle* o, const ax_sparse* matrix, const double* base)
{
    int n = o->mesh.vertex_count, *index = AX_NEW(int, n);
    double* residual = AX_NEW(double, n);
    ax_sparse_multiply(matrix, o->h, residual, 1);
    double scale = 0;
    for (int v = 0; v < n; ++v)
        scale = fmax(scale, fabs(base[v]));
    bool* moved = AX_NEW(bool, n);
    for (int v = 0; v < n; ++v)
        moved[v] = !o->on_rim[v] && (o->h[v] > 0 || residual[v] + base[v] < 0);

    bool sound = true, changed = true;
    for (int round = 0; round < MOST_ACTIVE_SETS && sound && changed; ++round) {
        sound = go_on(o) && solve_moved(o, matrix, base, moved, index);
        ax_sparse_multiply(matrix, o->trial, residual, 1);
        changed = false;
        for (int v = 0; v < n; ++v) {
            bool next = moved[v] ? o->trial[v] > 0 : !o->on_rim[v] && residual[v] + base[v] < -1e-14 * scale;
            changed = changed || next != moved[v];
            moved[v] = next;
        }
    }
    for (int v = 0; v < n; ++v)
        o->trial[v] = o->trial[v] < 0 ? 0 : o->trial[v]; // keeps NaN, which step() looks for
    ax_free(index);
    ax_free(residual);
    ax_free(moved);
    return sound;
}

// Goes from h to the solution of the linear problem: all of the way, half of it when `cautious`, less where faces would
// turn over. False, with everything left as it was, when that fails or is cancelled.
static bool step(obstacle* o, bool cautious)
{
    int n = o->mesh.vertex_count;
    double* base = AX_NEW(double, n);
    ax_sparse matrix;
    linearise(o, &matrix, base);
    bool sound = solve_complementarity(o, &matrix, base);
    ax_sparse_free(&matrix);
    ax_free(base);

    double change = 0;
    for (int v = 0; v < n; ++v) {
        sound = sound && isfinite(o->trial[v]);
        change = fmax(change, fabs(o->trial[v] - o->h[v]));
    }
    for (int halving = 0; sound; ++halving) {
        for (int v = 0; (halving || cautious) && v < n; ++v)
            o->trial[v] = (o->h[v] + o->trial[v]) / 2;
        move(o, o->trial);
        if (faces_outward(o))
            break;
        sound = halving < MOST_HALVINGS;
    }
    if (!sound) {
        move(o, o->h);
        return false;
    }
    memcpy(o->h, o->trial, (size_t)n * sizeof *o->h);
    o->change = change / o->diagonal;
    return true;
}

static obstacle obstacle_make(const ax_mesh* start, double area, const ax_progress* progress)
{
    int n = start->vertex_count;
    obstacle o = {.start = start,
                  .mesh = ax_mesh_copy(start),
                  .direction = ax_alloc((size_t)n, sizeof *o.direction),
                  .h = AX_NEW0(double, n),
                  .trial = AX_NEW(double, n),
                  .curvature = LEAST_CURVATURE / sqrt(area),
                  .diagonal = ax_diagonal(start),
                  .progress = progress,
                  .factored = AX_NEW0(bool, n)};
    ax_sparse matrix = ax_cotan_laplacian(start);
    ax_cholesky* whole = ax_cholesky_analyse(&matrix);
    o.order = ax_copy(ax_cholesky_order(whole), (size_t)n, sizeof *o.order);
    ax_cholesky_free(whole);
    ax_sparse_free(&matrix);
    ax_topology topology = ax_topology_make(start);
    o.on_rim = ax_copy(topology.on_rim, (size_t)n, 1);
    ax_topology_free(&topology);
    return o;
}

static void obstacle_free(obstacle* o)
{
    ax_mesh_free(&o->mesh);
    ax_free(o->direction);
    ax_free(o->h);
    ax_free(o->trial);
    ax_free(o->on_rim);
    ax_free(o->order);
    ax_free(o->factored);
    ax_cholesky_free(o->factor);
}

// Smallest H off the rim.
static double least_curvature(const obstacle* o)
{
    double *curvature = AX_NEW(double, o->mesh.vertex_count), least = INFINITY;
    ax_mean_curvature(&o->mesh, curvature);
    for (int v = 0; v < o->mesh.vertex_count; ++v)
        if (!o->on_rim[v])
            least = fmin(least, curvature[v]);
    ax_free(curvature);
    return least;
}

// Steps from h = 0 until the surface rests and H >= eps; ends early when a step fails or eight steps have not halved
// the change. What has been reached is kept.
static void settle(obstacle* o, int* steps, bool* settled)
{
    memset(o->h, 0, (size_t)o->mesh.vertex_count * sizeof *o->h);
    move(o, o->h);
    *settled = false;
    double last = INFINITY, eight_ago = INFINITY;
    o->change = INFINITY;
    for (int k = 1; k <= MOST_STEPS && !*settled; ++k) {
        bool cautious = o->change > last;
        last = o->change;
        if (!step(o, cautious))
            break;
        ++*steps;
        *settled = o->change <= SETTLED && least_curvature(o) >= o->curvature;
        if (k % 8 == 0) {
            if (o->change > eight_ago / 2)
                break;
            eight_ago = o->change;
        }
    }
}

// Says how thin the thinnest triangle is, and where.
static ax_status refuse_thin(const ax_mesh* mesh, ax_error* error)
{
    int thinnest = 0;
    double least = INFINITY;
    for (int f = 0; f < mesh->face_count; ++f) {
        double longest = 0;
        for (int k = 0; k < 3; ++k)
            longest = fmax(longest, ax_distance3(mesh->positions[mesh->faces[f][k]],
                                                 mesh->positions[mesh->faces[f][(k + 1) % 3]]));
        double height = longest > 0 ? 2 * ax_face_area(mesh, f) / (longest * longest) : 0;
        if (height < least)
            least = height, thinnest = f;
    }
    const double* at = mesh->positions[mesh->faces[thinnest][0]];
    return ax_fail(
        error, AX_BAD_INPUT,
        "The surface could not be projected: some triangles are too thin. The thinnest, near (%.4g, %.4g, %.4g), "
        "is %.2g times as high as long. Remesh it with rounder triangles.",
        at[0], at[1], at[2], least);
}

// Along an axis first, if there is one, since that keeps the plan. There a steep part behind a concave rim can have no
// solution (it would have to hang over the rim); along the vertex normals it has. The better of the two is kept.
static ax_status solve(obstacle* o, int* steps, ax_error* error)
{
    int n = o->mesh.vertex_count;
    double axis[3], *along_axis = NULL, least = -INFINITY;
    bool settled = false;
    if (find_axis(o->start, axis)) {
        for (int v = 0; v < n; ++v)
            memcpy(o->direction[v], axis, sizeof axis);
        settle(o, steps, &settled);
        along_axis = ax_copy(o->h, (size_t)n, sizeof *o->h);
        least = least_curvature(o);
    }
    if (!settled && !o->cancelled) {
        ax_vertex_normals(o->start, o->direction);
        settle(o, steps, &settled);
        if (along_axis && least >= least_curvature(o)) {
            memcpy(o->h, along_axis, (size_t)n * sizeof *o->h);
            for (int v = 0; v < n; ++v)
                memcpy(o->direction[v], axis, sizeof axis);
            move(o, o->h);
        }
    }
    ax_free(along_axis);
    if (o->cancelled)
        return ax_fail(error, AX_CANCELLED, "Cancelled.");
    return *steps > 0 ? AX_OK : refuse_thin(o->start, error);
}

ax_status ax_target_project(ax_mesh* mesh, const ax_progress* progress, ax_projection* report, ax_error* error)
{
    *report = (ax_projection){0};
    ax_curvature_screen curvature = ax_curvature_measure(mesh);
    double area = curvature.area;
    bool positive = curvature.positive, dome_like = curvature.dome_like;
    report->curvature_min = curvature.min;
    report->nonpositive_share = curvature.nonpositive_share;
    ax_curvature_free(&curvature);
    if (positive)
        return AX_OK;
    if (!dome_like)
        return ax_fail(error, AX_CANNOT_REALISE,
                       "No part of the surface is dome-like, so projection would replace all of it. Start from a "
                       "surface that bulges outwards.");

    ax_mesh start = ax_mesh_copy(mesh);
    for (int v = 0; v < start.vertex_count; ++v)
        ax_sub3(mesh->positions[v], mesh->positions[0], start.positions[v]);
    obstacle o = obstacle_make(&start, area, progress);
    ax_status status = solve(&o, &report->steps, error);
    if (status == AX_OK) {
        curvature = ax_curvature_measure(&o.mesh);
        report->curvature_min = curvature.min;
        report->nonpositive_share = curvature.nonpositive_share;
        for (int v = 0; v < mesh->vertex_count; ++v) {
            if (o.h[v] > SETTLED * o.diagonal)
                report->moved_area_share += curvature.vertex_area[v] / curvature.area;
            report->largest_move = fmax(report->largest_move, o.h[v]);
            for (int d = 0; d < 3; ++d)
                mesh->positions[v][d] += o.h[v] * o.direction[v][d];
        }
        ax_curvature_free(&curvature);
    } else
        *report = (ax_projection){0};
    obstacle_free(&o);
    ax_mesh_free(&start);
    return status;
}
