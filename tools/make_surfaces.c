// Writes the example surfaces, examples/surfaces/*.obj. usage: make_surfaces FOLDER
//
// Domes over a plan are surfaces of constant mean curvature H: the height field z with div(grad z / w) = -2 H,
// w = sqrt(1 + |grad z|^2), and z = 0 on the rim, by linear finite elements with w lagged one iteration behind. A soap
// film under pressure takes this shape, so such a dome deploys by inflation. Lengths are metres.
#include "base/vec.h"
#include "linalg/cholesky.h"
#include "mesh/geometry.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { RINGS = 30 };

static int first_in_ring(int ring)
{
    return ring == 0 ? 0 : 1 + 3 * ring * (ring - 1);
}

// The unit disk as concentric rings, ring r with 6 r vertices: triangles of like size, no fan of slivers at the centre.
static ax_mesh unit_disk(int rings)
{
    ax_mesh mesh = {.vertex_count = first_in_ring(rings + 1), .face_count = 6 * rings * rings};
    mesh.positions = ax_calloc((size_t)mesh.vertex_count, sizeof *mesh.positions);
    mesh.faces = ax_alloc((size_t)mesh.face_count, sizeof *mesh.faces);
    for (int r = 1; r <= rings; ++r)
        for (int k = 0; k < 6 * r; ++k) {
            double* x = mesh.positions[first_in_ring(r) + k];
            x[0] = (double)r / rings * cos(2 * AX_PI * k / (6 * r));
            x[1] = (double)r / rings * sin(2 * AX_PI * k / (6 * r));
        }
    int(*face)[3] = mesh.faces;
    for (int r = 1; r <= rings; ++r)
        for (int k = 0; k < 6 * r; ++k) {
            int side = k / r, within = k % r, inner_count = r == 1 ? 1 : 6 * (r - 1);
            int outer = first_in_ring(r) + k, next = first_in_ring(r) + (k + 1) % (6 * r);
            int inner = first_in_ring(r - 1) + (side * (r - 1) + within) % inner_count;
            memcpy(face++, (int[3]){outer, next, inner}, sizeof *face);
            if (within < r - 1) {
                int inner_next = first_in_ring(r - 1) + (side * (r - 1) + within + 1) % inner_count;
                memcpy(face++, (int[3]){next, inner_next, inner}, sizeof *face);
            }
        }
    return mesh;
}

// The disk stretched along its rays to a plan whose rim is at `radius(t)` in direction t.
static ax_mesh plan(double (*radius)(double t))
{
    ax_mesh mesh = unit_disk(RINGS);
    for (int v = 0; v < mesh.vertex_count; ++v) {
        double *x = mesh.positions[v], r = radius(atan2(x[1], x[0]));
        x[0] *= r, x[1] *= r;
    }
    return mesh;
}

static bool on_rim(const ax_mesh* mesh, int vertex)
{
    return vertex >= first_in_ring(RINGS) && mesh->vertex_count == first_in_ring(RINGS + 1);
}

// Gradients of the three hat functions of a face over the plan; returns the plan's area.
static double hat_gradients(const ax_mesh* mesh, int f, double gradient[3][2])
{
    const double* x[3];
    for (int k = 0; k < 3; ++k)
        x[k] = mesh->positions[mesh->faces[f][k]];
    double twice = ax_orient2(x[0], x[1], x[2]);
    for (int k = 0; k < 3; ++k) {
        const double *a = x[(k + 1) % 3], *b = x[(k + 2) % 3];
        gradient[k][0] = (a[1] - b[1]) / twice;
        gradient[k][1] = (b[0] - a[0]) / twice;
    }
    return twice / 2;
}

// Raises a plan to the surface of mean curvature `h`.
static void raise_to_constant_curvature(ax_mesh* mesh, double h)
{
    int n = mesh->vertex_count;
    double *z = AX_NEW0(double, n), *next = AX_NEW(double, n);
    ax_cholesky* factor = NULL;
    for (double change = 1; change > 1e-13;) {
        ax_entries entries = {0};
        memset(next, 0, (size_t)n * sizeof *next);
        for (int f = 0; f < mesh->face_count; ++f) {
            const int* v = mesh->faces[f];
            double gradient[3][2], area = hat_gradients(mesh, f, gradient), slope[2] = {0};
            for (int k = 0; k < 3; ++k)
                slope[0] += gradient[k][0] * z[v[k]], slope[1] += gradient[k][1] * z[v[k]];
            double w = sqrt(1 + slope[0] * slope[0] + slope[1] * slope[1]);
            for (int k = 0; k < 3; ++k) {
                if (on_rim(mesh, v[k]))
                    continue;
                next[v[k]] += 2 * h * area / 3;
                for (int l = 0; l <= k; ++l)
                    if (!on_rim(mesh, v[l]))
                        ax_entries_add(&entries, v[k], v[l],
                                       area / w * (gradient[k][0] * gradient[l][0] + gradient[k][1] * gradient[l][1]));
            }
        }
        for (int v = 0; v < n; ++v)
            if (on_rim(mesh, v))
                ax_entries_add(&entries, v, v, 1);
        ax_sparse stiffness = ax_entries_sparse(&entries, n);
        if (!factor)
            factor = ax_cholesky_analyse(&stiffness);
        if (!ax_cholesky_factor(factor, &stiffness)) {
            fprintf(stderr, "make_surfaces: no surface of mean curvature %g over this plan\n", h);
            exit(1);
        }
        ax_cholesky_solve(factor, next, next, 1);
        ax_sparse_free(&stiffness);
        change = 0;
        for (int v = 0; v < n; ++v) {
            change = fmax(change, fabs(next[v] - z[v]));
            z[v] = next[v];
        }
    }
    for (int v = 0; v < n; ++v)
        mesh->positions[v][2] = z[v];
    ax_cholesky_free(factor);
    ax_free(z);
    ax_free(next);
}

static double ellipse(double t)
{
    double a = 5.5, b = 3.5;
    return a * b / hypot(b * cos(t), a * sin(t));
}

// A kidney: the rim is concave on one side.
static double kidney(double t)
{
    return 4.4 * (1 + 0.22 * cos(2 * t) - 0.12 * sin(t) + 0.08 * sin(3 * t));
}

static double rounded(double t)
{
    return 9 * (1 + 0.1 * cos(2 * t) + 0.03 * sin(3 * t));
}

// Part of the unit sphere around its top: `angle` is the polar angle of the rim.
static ax_mesh sphere_part(double angle)
{
    ax_mesh mesh = unit_disk(RINGS);
    for (int v = 0; v < mesh.vertex_count; ++v) {
        double *x = mesh.positions[v], r = hypot(x[0], x[1]), s = r > 0 ? sin(r * angle) / r : 0;
        x[0] *= s, x[1] *= s, x[2] = cos(r * angle) - cos(angle);
    }
    return mesh;
}

static ax_mesh hemisphere(void)
{
    return sphere_part(AX_PI / 2);
}

static ax_mesh spherical_cap(void)
{
    return sphere_part(AX_PI / 3);
}

static ax_mesh ellipse_dome(void)
{
    ax_mesh mesh = plan(ellipse);
    raise_to_constant_curvature(&mesh, 0.2);
    return mesh;
}

static ax_mesh kidney_dome(void)
{
    ax_mesh mesh = plan(kidney);
    raise_to_constant_curvature(&mesh, 0.17);
    return mesh;
}

// A roof that sags along a valley, so that its mean curvature is negative there; faces turned inward, as modellers
// often leave them. It needs projection.
static ax_mesh valley_roof(void)
{
    ax_mesh mesh = plan(rounded);
    raise_to_constant_curvature(&mesh, 0.07);
    for (int v = 0; v < mesh.vertex_count; ++v) {
        double *x = mesh.positions[v], across = (x[0] - 0.3 * x[1] - 1) / 2.4;
        x[2] *= 1 - 0.4 * exp(-across * across);
    }
    for (int f = 0; f < mesh.face_count; ++f) {
        int* face = mesh.faces[f];
        memcpy(face, (int[3]){face[0], face[2], face[1]}, sizeof mesh.faces[f]);
    }
    return mesh;
}

static ax_mesh saddle(void)
{
    ax_mesh mesh = unit_disk(RINGS);
    for (int v = 0; v < mesh.vertex_count; ++v) {
        double* x = mesh.positions[v];
        x[0] *= 4, x[1] *= 4;
        x[2] = 0.08 * (x[0] * x[0] - x[1] * x[1]);
    }
    return mesh;
}

// A dome over a square, whose sharp corners make it a case for --flatten polygon. Diagonals point to the centre, so that no
// corner of the plan is cut off by a single face.
static ax_mesh square_dome(void)
{
    enum { SIDE = 40 };
    ax_mesh mesh = {.vertex_count = (SIDE + 1) * (SIDE + 1), .face_count = 2 * SIDE * SIDE};
    mesh.positions = ax_alloc((size_t)mesh.vertex_count, sizeof *mesh.positions);
    mesh.faces = ax_alloc((size_t)mesh.face_count, sizeof *mesh.faces);
    for (int v = 0; v < mesh.vertex_count; ++v) {
        double x = 4.0 * (v % (SIDE + 1)) / SIDE - 2, y = 4.0 * (v / (SIDE + 1)) / SIDE - 2;
        memcpy(mesh.positions[v], (double[3]){x, y, 0.05 * (4 - x * x) * (4 - y * y)}, sizeof mesh.positions[v]);
    }
    int(*face)[3] = mesh.faces;
    for (int row = 0; row < SIDE; ++row)
        for (int column = 0; column < SIDE; ++column) {
            int a = row * (SIDE + 1) + column, b = a + 1, c = b + SIDE + 1, d = c - 1;
            bool rising = (row < SIDE / 2) == (column < SIDE / 2);
            memcpy(face++, rising ? (int[3]){a, b, c} : (int[3]){a, b, d}, sizeof *face);
            memcpy(face++, rising ? (int[3]){a, c, d} : (int[3]){b, c, d}, sizeof *face);
        }
    return mesh;
}

static bool write_obj(const char* folder, const char* name, const char* words, const ax_mesh* mesh)
{
    char path[4096];
    snprintf(path, sizeof path, "%s/%s.obj", folder, name);
    FILE* out = fopen(path, "w");
    if (!out) {
        perror(path);
        return false;
    }
    fprintf(out, "# %s; metres\n", words);
    for (int v = 0; v < mesh->vertex_count; ++v) {
        double* x = mesh->positions[v];
        for (int k = 0; k < 3; ++k)
            x[k] = fabs(x[k]) < 5e-10 ? 0 : x[k]; // no -0, and no noise where the exact value is 0
        fprintf(out, "v %.9g %.9g %.9g\n", x[0], x[1], x[2]);
    }
    for (int f = 0; f < mesh->face_count; ++f)
        fprintf(out, "f %d %d %d\n", mesh->faces[f][0] + 1, mesh->faces[f][1] + 1, mesh->faces[f][2] + 1);
    return fclose(out) == 0;
}

int main(int argc, char** argv)
{
    static const struct {
        const char *name, *words;
        ax_mesh (*make)(void);
    } surfaces[] = {
        {"hemisphere", "Half of the unit sphere: the exact limit of a scale factor from 1 to 2", hemisphere},
        {"spherical_cap", "A cap of the unit sphere, 60 degrees from top to rim", spherical_cap},
        {"ellipse_dome", "Constant mean curvature 0.2 over an ellipse of 11 by 7", ellipse_dome},
        {"kidney_dome", "Constant mean curvature 0.17 over a kidney, whose rim is concave on one side", kidney_dome},
        {"valley_roof", "A roof with a valley where the mean curvature is negative, faces turned inward", valley_roof},
        {"square_dome", "A dome over a square of 4 by 4, with sharp corners", square_dome},
        {"saddle", "A saddle: nowhere dome-like, not deployable", saddle},
    };
    if (argc != 2) {
        fprintf(stderr, "usage: make_surfaces FOLDER\n");
        return 2;
    }
    for (size_t k = 0; k < sizeof surfaces / sizeof *surfaces; ++k) {
        ax_mesh mesh = surfaces[k].make();
        bool written = write_obj(argv[1], surfaces[k].name, surfaces[k].words, &mesh);
        ax_mesh_free(&mesh);
        if (!written)
            return 1;
    }
    return 0;
}
