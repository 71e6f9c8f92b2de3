// Boundary First Flattening (Sawhney and Crane 2017). The logarithm u of the length scale of a conformal map to the
// plane satisfies A u = -K inside and A u = k~ - k on the rim (Cherrier), with the cotangent Laplacian A, the angle
// defect K, the turning k of the rim on the surface and k~ in the plane. u and k~ on the rim give the rim's curve, and
// its harmonic extension the map.
//
// Both coordinates are extended harmonically, from the one factorisation of the interior block that also gives u. The
// second as harmonic conjugate of the first needs a factorisation of all of A as well, and is no more conformal:
// docs/flattening.md.
#include "ax/flatten.h"

#include "base/vec.h"
#include "conformal/rim.h"
#include "linalg/cholesky.h"
#include "mesh/geometry.h"
#include "mesh/topology.h"

#include <assert.h>
#include <string.h>

typedef struct problem {
    const ax_mesh* mesh;
    int n, rim_count, interior_count;
    int* rim;
    int* interior; // the other vertices, ascending
    ax_sparse laplacian;
    double* curvature; // per vertex: K inside, k on the rim
    double* length;    // per rim edge
    ax_cholesky* factor;
} problem;

static void release(problem* p)
{
    ax_free(p->rim);
    ax_free(p->interior);
    ax_sparse_free(&p->laplacian);
    ax_free(p->curvature);
    ax_free(p->length);
    ax_cholesky_free(p->factor);
}

static ax_status breakdown(ax_error* error)
{
    return ax_fail(error, AX_FAILED,
                   "The equations of the flattening could not be factored: some triangles are too thin. Remesh the "
                   "surface with rounder triangles.");
}

static double* angle_defects(const ax_mesh* mesh, const ax_topology* topology)
{
    double* defect = AX_NEW(double, mesh->vertex_count);
    double(*angle)[3] = ax_alloc((size_t)mesh->face_count, sizeof *angle);
    for (int v = 0; v < mesh->vertex_count; ++v)
        defect[v] = topology->on_rim[v] ? AX_PI : 2 * AX_PI;
    ax_corner_angles(mesh, angle);
    for (int f = 0; f < mesh->face_count; ++f)
        for (int k = 0; k < 3; ++k)
            defect[mesh->faces[f][k]] -= angle[f][k];
    ax_free(angle);
    return defect;
}

static ax_cholesky* factor_principal(const ax_sparse* matrix, const int* index)
{
    ax_sparse part = ax_sparse_principal(matrix, index);
    ax_cholesky* factor = ax_cholesky_analyse(&part);
    if (!ax_cholesky_factor(factor, &part)) {
        ax_cholesky_free(factor);
        factor = NULL;
    }
    ax_sparse_free(&part);
    return factor;
}

static ax_status prepare(const ax_mesh* mesh, problem* p, ax_error* error)
{
    ax_topology topology = ax_topology_make(mesh);
    int rim_count = topology.loop_count == 1 ? topology.loop_start[1] : 0;
    int euler = mesh->vertex_count - (3 * mesh->face_count + rim_count) / 2 + mesh->face_count;
    if (topology.loop_count != 1 || euler != 1) {
        int loops = topology.loop_count;
        ax_topology_free(&topology);
        return loops == 1 ? ax_fail(error, AX_CANNOT_REALISE,
                                    "The surface has a handle, so it cannot be flattened in one piece. Cut it open.")
                          : ax_fail(error, AX_CANNOT_REALISE,
                                    "The surface has %d boundary loops; exactly one can be flattened. Close the inner "
                                    "ones, or cut the surface.",
                                    loops);
    }
    *p = (problem){.mesh = mesh,
                   .n = mesh->vertex_count,
                   .rim_count = rim_count,
                   .rim = ax_copy(topology.loop, (size_t)rim_count, sizeof *topology.loop),
                   .interior = AX_NEW(int, mesh->vertex_count),
                   .laplacian = ax_cotan_laplacian(mesh),
                   .curvature = angle_defects(mesh, &topology),
                   .length = AX_NEW(double, rim_count)};
    int* index = AX_NEW(int, p->n);
    for (int v = 0; v < p->n; ++v) {
        index[v] = topology.on_rim[v] ? -1 : p->interior_count;
        if (index[v] >= 0)
            p->interior[p->interior_count++] = v;
    }
    for (int k = 0; k < rim_count; ++k)
        p->length[k] = ax_distance3(mesh->positions[p->rim[k]], mesh->positions[p->rim[(k + 1) % rim_count]]);
    if (p->interior_count)
        p->factor = factor_principal(&p->laplacian, index);
    ax_free(index);
    ax_topology_free(&topology);
    return p->factor || !p->interior_count ? AX_OK : breakdown(error);
}

// Solves A x = -source inside for given x on the rim, for `columns` functions stored one after the other. NULL source:
// 0.
static void solve_dirichlet(const problem* p, const double* source, double* x, int columns)
{
    if (!p->interior_count)
        return;
    int n = p->n, m = p->interior_count;
    double *product = AX_NEW(double, (size_t)n*(size_t)columns), *part = AX_NEW(double, (size_t)m*(size_t)columns);
    for (int c = 0; c < columns; ++c)
        for (int i = 0; i < m; ++i)
            x[(size_t)c * (size_t)n + (size_t)p->interior[i]] = 0;
    ax_sparse_multiply(&p->laplacian, x, product, columns);
    for (int c = 0; c < columns; ++c)
        for (int i = 0; i < m; ++i) {
            int v = p->interior[i];
            part[(size_t)c * (size_t)m + (size_t)i] =
                -product[(size_t)c * (size_t)n + (size_t)v] - (source ? source[v] : 0);
        }
    ax_cholesky_solve(p->factor, part, part, columns);
    for (int c = 0; c < columns; ++c)
        for (int i = 0; i < m; ++i)
            x[(size_t)c * (size_t)n + (size_t)p->interior[i]] = part[(size_t)c * (size_t)m + (size_t)i];
    ax_free(product);
    ax_free(part);
}

// k~ = k - h with h = -(A u) on the rim: the turning in the plane that belongs to the scale u.
static void flat_turning(const problem* p, const double* u, double* turning)
{
    double* product = AX_NEW(double, p->n);
    ax_sparse_multiply(&p->laplacian, u, product, 1);
    for (int k = 0; k < p->rim_count; ++k)
        turning[k] = p->curvature[p->rim[k]] + product[p->rim[k]];
    ax_free(product);
}

// l* = exp((u_i + u_j) / 2) l per rim edge.
static void flat_lengths(const problem* p, const double* u, double* target)
{
    for (int k = 0; k < p->rim_count; ++k)
        target[k] = exp((u[p->rim[k]] + u[p->rim[(k + 1) % p->rim_count]]) / 2) * p->length[k];
}

// Finds u from the turning of the rim in the plane. A with one rim vertex held at 0 is positive definite; the constant
// that stays free is set so that u averages 0 over the rim's length.
typedef struct neumann {
    int* index;
    ax_cholesky* factor;
    double* right;
} neumann;

static bool neumann_make(const problem* p, neumann* solver)
{
    *solver = (neumann){.index = AX_NEW(int, p->n), .right = AX_NEW(double, p->n)};
    for (int v = 0; v < p->n; ++v)
        solver->index[v] = v < p->rim[0] ? v : v - 1;
    solver->index[p->rim[0]] = -1;
    solver->factor = factor_principal(&p->laplacian, solver->index);
    return solver->factor;
}

static void neumann_free(neumann* solver)
{
    ax_free(solver->index);
    ax_free(solver->right);
    ax_cholesky_free(solver->factor);
}

static void solve_neumann(const problem* p, const neumann* solver, const double* turning, double* u)
{
    double* right = u; // per vertex, then renumbered
    for (int v = 0; v < p->n; ++v)
        right[v] = -p->curvature[v];
    for (int k = 0; k < p->rim_count; ++k)
        right[p->rim[k]] += turning[k];
    for (int v = 0; v < p->n; ++v)
        if (solver->index[v] >= 0)
            solver->right[solver->index[v]] = right[v];
    ax_cholesky_solve(solver->factor, solver->right, solver->right, 1);
    double mean = 0, perimeter = 0;
    for (int v = 0; v < p->n; ++v)
        u[v] = solver->index[v] >= 0 ? solver->right[solver->index[v]] : 0;
    for (int k = 0; k < p->rim_count; ++k) {
        mean += p->length[k] * (u[p->rim[k]] + u[p->rim[(k + 1) % p->rim_count]]) / 2;
        perimeter += p->length[k];
    }
    for (int v = 0; v < p->n; ++v)
        u[v] -= mean / perimeter;
}

static void free_rim(const problem* p, double* u, double (*curve)[2])
{
    double *turning = AX_NEW(double, p->rim_count), *target = AX_NEW(double, p->rim_count);
    memset(u, 0, (size_t)p->n * sizeof *u);
    solve_dirichlet(p, p->curvature, u, 1);
    flat_turning(p, u, turning);
    flat_lengths(p, u, target);
    ax_rim_close(p->rim_count, turning, target, p->length, curve);
    ax_free(turning);
    ax_free(target);
}

static void polygon_rim(const problem* p, const neumann* solver, const ax_flatten_options* options, double* u,
                        double (*curve)[2])
{
    int n = p->rim_count, *corner = AX_NEW(int, options->corner_count);
    double *turning = AX_NEW(double, n), *target = AX_NEW(double, n);
    for (int k = 0; k < n; ++k)
        turning[k] = p->curvature[p->rim[k]];
    ax_rim_corners(n, turning, p->length, options->corner_count, options->corner_angles, corner);
    memset(turning, 0, (size_t)n * sizeof *turning);
    for (int k = 0; k < options->corner_count; ++k)
        turning[corner[k]] = AX_PI - options->corner_angles[k] * AX_PI / 180;
    solve_neumann(p, solver, turning, u);
    flat_lengths(p, u, target);
    ax_rim_close(n, turning, target, p->length, curve);
    ax_free(corner);
    ax_free(turning);
    ax_free(target);
}

// Turning in proportion to the lengths, iterated (section 5.2 of the paper). A wave of m periods along the rim shrinks
// by m in each step; ten steps, as in the paper, leave a thousandth of an ellipse, so it goes on to 1e-9 or forty.
static void circle_rim(const problem* p, const neumann* solver, double* u, double (*curve)[2])
{
    int n = p->rim_count;
    double *turning = AX_NEW(double, n), *target = AX_NEW(double, n), *last = AX_NEW0(double, n), change = INFINITY;
    memset(u, 0, (size_t)p->n * sizeof *u);
    for (int step = 0; step < 40 && change > 1e-9; ++step) {
        flat_lengths(p, u, target);
        ax_rim_circle_turning(n, target, turning);
        solve_neumann(p, solver, turning, u);
        change = 0;
        for (int k = 0; k < n; ++k) {
            change = fmax(change, fabs(u[p->rim[k]] - last[k]));
            last[k] = u[p->rim[k]];
        }
    }
    flat_lengths(p, u, target);
    ax_rim_circle(n, target, curve);
    ax_free(turning);
    ax_free(target);
    ax_free(last);
}

static ax_status shape_rim(const problem* p, const ax_flatten_options* options, double* u, double (*curve)[2],
                           ax_error* error)
{
    if (options->boundary == AX_FLATTEN_FREE) {
        free_rim(p, u, curve);
        return AX_OK;
    }
    neumann solver;
    bool sound = neumann_make(p, &solver);
    if (sound && options->boundary == AX_FLATTEN_DISK)
        circle_rim(p, &solver, u, curve);
    if (sound && options->boundary == AX_FLATTEN_POLYGON)
        polygon_rim(p, &solver, options, u, curve);
    neumann_free(&solver);
    return sound ? AX_OK : breakdown(error);
}

// Axes of the view along the rim's mean normal, which is that of the surface: x to the right where it can be.
static void seen_from_outside(const problem* p, double right[3], double up[3])
{
    double normal[3] = {0};
    const double(*x)[3] = (const double(*)[3])p->mesh->positions;
    for (int k = 0; k < p->rim_count; ++k) {
        double a[3], b[3], c[3];
        ax_sub3(x[p->rim[k]], x[p->rim[0]], a);
        ax_sub3(x[p->rim[(k + 1) % p->rim_count]], x[p->rim[0]], b);
        ax_cross(a, b, c);
        for (int d = 0; d < 3; ++d)
            normal[d] += c[d];
    }
    double length = ax_norm3(normal);
    for (int d = 0; d < 3; ++d)
        normal[d] = length > 0 ? normal[d] / length : d == 2;
    double axis[3] = {fabs(normal[0]) < 0.9, fabs(normal[0]) >= 0.9, 0};
    ax_cross(normal, axis, up);
    length = ax_norm3(up);
    for (int d = 0; d < 3; ++d)
        up[d] /= length;
    ax_cross(up, normal, right);
}

// Turns the map to lie as the surface does when seen from its outer side, by the best fit of the rim's edges.
static void turn(const problem* p, double (*uv)[2])
{
    double right[3], up[3], cosine = 0, sine = 0;
    seen_from_outside(p, right, up);
    for (int k = 0; k < p->rim_count; ++k) {
        int v = p->rim[k], w = p->rim[(k + 1) % p->rim_count];
        double edge[3], a = uv[w][0] - uv[v][0], b = uv[w][1] - uv[v][1];
        ax_sub3(p->mesh->positions[w], p->mesh->positions[v], edge);
        double x = ax_dot3(edge, right), y = ax_dot3(edge, up);
        cosine += a * x + b * y;
        sine += a * y - b * x;
    }
    double length = hypot(cosine, sine);
    if (!(length > 0))
        return;
    cosine /= length, sine /= length;
    for (int v = 0; v < p->n; ++v) {
        double x = uv[v][0], y = uv[v][1];
        uv[v][0] = cosine * x - sine * y;
        uv[v][1] = sine * x + cosine * y;
    }
}

static void centre(const problem* p, double (*uv)[2])
{
    double area = 0, sum[2] = {0};
    for (int f = 0; f < p->mesh->face_count; ++f) {
        const int* corner = p->mesh->faces[f];
        double a = ax_orient2(uv[corner[0]], uv[corner[1]], uv[corner[2]]);
        area += a;
        for (int d = 0; d < 2; ++d)
            sum[d] += a * (uv[corner[0]][d] + uv[corner[1]][d] + uv[corner[2]][d]) / 3;
    }
    for (int v = 0; v < p->n; ++v)
        for (int d = 0; d < 2; ++d)
            uv[v][d] -= sum[d] / area;
}

// The map on one face as f = a z + b conj(z): its singular values are |a| + |b| and ||a| - |b||, and it turns over when
// |a| < |b|. True unless the face is turned over.
static bool face_distortion(const ax_mesh* mesh, const double (*uv)[2], int face, double* ratio, double* area)
{
    const int* corner = mesh->faces[face];
    double e[3], g[3];
    ax_sub3(mesh->positions[corner[1]], mesh->positions[corner[0]], e);
    ax_sub3(mesh->positions[corner[2]], mesh->positions[corner[0]], g);
    double l = ax_norm3(e), c = ax_dot3(e, g) / l, n[3];
    ax_cross(e, g, n);
    double h = ax_norm3(n) / l;
    double x[2], y[2]; // images of the unit vectors along and across the first edge
    for (int d = 0; d < 2; ++d) {
        x[d] = (uv[corner[1]][d] - uv[corner[0]][d]) / l;
        y[d] = (uv[corner[2]][d] - uv[corner[0]][d] - c * x[d]) / h;
    }
    double conformal = hypot(x[0] + y[1], x[1] - y[0]), anticonformal = hypot(x[0] - y[1], x[1] + y[0]);
    *ratio = (conformal + anticonformal) / fabs(conformal - anticonformal);
    *area = 0.5 * l * h;
    return conformal > anticonformal;
}

static void measure(const ax_mesh* mesh, ax_flattening* out)
{
    out->u_min = out->u_max = out->u[0];
    for (int v = 1; v < mesh->vertex_count; ++v) {
        out->u_min = fmin(out->u_min, out->u[v]);
        out->u_max = fmax(out->u_max, out->u[v]);
    }
    double total = 0;
    for (int f = 0; f < mesh->face_count; ++f) {
        double ratio, area;
        out->flipped_faces += !face_distortion(mesh, (const double(*)[2])out->uv, f, &ratio, &area);
        out->quasi_conformal_mean += area * ratio;
        out->quasi_conformal_max = fmax(out->quasi_conformal_max, ratio);
        total += area;
    }
    out->quasi_conformal_mean /= total;
}

static ax_status check_options(const ax_flatten_options* options, int rim_count, ax_error* error)
{
    if (options->boundary != AX_FLATTEN_POLYGON)
        return AX_OK;
    if (options->corner_count < 3 || options->corner_count > rim_count)
        return ax_fail(
            error, AX_USAGE,
            "A polygon needs at least 3 corners, and at most the %d vertices of the rim; %d angles were given.",
            rim_count, options->corner_count);
    double sum = 0, wanted = 180.0 * (options->corner_count - 2);
    for (int k = 0; k < options->corner_count; ++k) {
        double angle = options->corner_angles[k];
        if (!(angle > 0 && angle < 360))
            return ax_fail(error, AX_USAGE,
                           "Corner angle %d of the polygon is %g degrees; it must lie between 0 and 360.", k + 1,
                           angle);
        sum += angle;
    }
    if (!(fabs(sum - wanted) <= 1e-6 * wanted))
        return ax_fail(error, AX_USAGE,
                       "The interior angles of a polygon with %d corners sum to %g degrees; the ones given sum to %g.",
                       options->corner_count, wanted, sum);
    return AX_OK;
}

ax_status ax_flatten(const ax_mesh* mesh, const ax_flatten_options* options, ax_flattening* out, ax_error* error)
{
    *out = (ax_flattening){0};
    static const ax_flatten_options free_boundary = {.boundary = AX_FLATTEN_FREE};
    options = options ? options : &free_boundary;
    problem p = {0};
    ax_status status = prepare(mesh, &p, error);
    if (status == AX_OK)
        status = check_options(options, p.rim_count, error);
    if (status != AX_OK) {
        release(&p);
        return status;
    }

    double* u = AX_NEW(double, p.n);
    double(*curve)[2] = ax_alloc((size_t)p.rim_count, sizeof *curve);
    double(*uv)[2] = ax_alloc((size_t)p.n, sizeof *uv);
    status = shape_rim(&p, options, u, curve, error);
    if (status == AX_OK) {
        double* xy = AX_NEW(double, 2 * (size_t)p.n); // all x, then all y
        for (int k = 0; k < p.rim_count; ++k)
            for (int d = 0; d < 2; ++d)
                xy[(size_t)d * (size_t)p.n + (size_t)p.rim[k]] = curve[k][d];
        solve_dirichlet(&p, NULL, xy, 2);
        for (int v = 0; v < p.n; ++v)
            for (int d = 0; d < 2; ++d)
                uv[v][d] = xy[(size_t)d * (size_t)p.n + (size_t)v];
        ax_free(xy);
        turn(&p, uv);
        if (options->boundary != AX_FLATTEN_DISK)
            centre(&p, uv);
        *out = (ax_flattening){.vertex_count = p.n, .rim_count = p.rim_count, .uv = uv, .u = u, .rim = p.rim};
        p.rim = NULL;
        measure(mesh, out);
    } else {
        ax_free(u);
        ax_free(uv);
    }
    ax_free(curve);
    release(&p);
    if (status == AX_OK && !isfinite(out->quasi_conformal_mean + out->u_min + out->u_max)) {
        ax_flattening_free(out);
        status = breakdown(error);
    }
    return status;
}

void ax_flattening_free(ax_flattening* flattening)
{
    if (!flattening)
        return;
    ax_free(flattening->uv);
    ax_free(flattening->u);
    ax_free(flattening->rim);
    *flattening = (ax_flattening){0};
}
