#include "support/shapes.h"

#include <math.h>

static const double pi = 3.14159265358979323846;

// Concentric rings, ring r with 6 r vertices: nearly equilateral triangles, no fan of slivers at the centre.
static ax_mesh polar(int rings)
{
    ax_mesh mesh = {.vertex_count = 1 + 3 * rings * (rings + 1), .face_count = 6 * rings * rings};
    mesh.positions = ax_alloc((size_t)mesh.vertex_count, sizeof *mesh.positions);
    mesh.faces = ax_alloc((size_t)mesh.face_count, sizeof *mesh.faces);
    mesh.positions[0][0] = mesh.positions[0][1] = mesh.positions[0][2] = 0;
    int v = 1, f = 0;
    for (int r = 1; r <= rings; ++r)
        for (int k = 0; k < 6 * r; ++k, ++v) {
            double t = 2 * pi * k / (6 * r), s = (double)r / rings;
            mesh.positions[v][0] = s * cos(t);
            mesh.positions[v][1] = s * sin(t);
            mesh.positions[v][2] = 0;
        }
    for (int r = 1; r <= rings; ++r) {
        int outer = 1 + 3 * r * (r - 1), inner = r == 1 ? 0 : 1 + 3 * (r - 1) * (r - 2);
        int m = 6 * r, n = r == 1 ? 1 : 6 * (r - 1);
        for (int side = 0; side < 6; ++side)
            for (int k = 0; k < r; ++k) {
                int o0 = outer + side * r + k, o1 = outer + (side * r + k + 1) % m;
                int i0 = inner + (side * (r - 1) + k) % n, i1 = inner + (side * (r - 1) + k + 1) % n;
                mesh.faces[f][0] = o0, mesh.faces[f][1] = o1, mesh.faces[f][2] = i0, ++f;
                if (k < r - 1)
                    mesh.faces[f][0] = o1, mesh.faces[f][1] = i1, mesh.faces[f][2] = i0, ++f;
            }
    }
    return mesh;
}

ax_mesh shape_over_disk(int rings, double (*height)(double x, double y))
{
    ax_mesh mesh = polar(rings);
    for (int v = 0; v < mesh.vertex_count; ++v)
        mesh.positions[v][2] = height(mesh.positions[v][0], mesh.positions[v][1]);
    return mesh;
}

ax_mesh shape_cap(int rings, double angle)
{
    ax_mesh mesh = polar(rings);
    for (int v = 0; v < mesh.vertex_count; ++v) {
        double *x = mesh.positions[v], r = hypot(x[0], x[1]), s = r > 0 ? sin(r * angle) / r : 0;
        x[0] *= s, x[1] *= s, x[2] = cos(r * angle);
    }
    return mesh;
}

ax_mesh shape_paraboloid(int rings, double c)
{
    ax_mesh mesh = polar(rings);
    for (int v = 0; v < mesh.vertex_count; ++v) {
        double* x = mesh.positions[v];
        x[2] = c * (1 - x[0] * x[0] - x[1] * x[1]);
    }
    return mesh;
}

ax_mesh shape_over_square(int n, double (*height)(double x, double y))
{
    ax_mesh mesh = {.vertex_count = (n + 1) * (n + 1), .face_count = 2 * n * n};
    mesh.positions = ax_alloc((size_t)mesh.vertex_count, sizeof *mesh.positions);
    mesh.faces = ax_alloc((size_t)mesh.face_count, sizeof *mesh.faces);
    for (int j = 0; j <= n; ++j)
        for (int i = 0; i <= n; ++i) {
            double* x = mesh.positions[j * (n + 1) + i];
            x[0] = -1 + 2.0 * i / n, x[1] = -1 + 2.0 * j / n, x[2] = height(x[0], x[1]);
        }
    int(*face)[3] = mesh.faces;
    for (int j = 0; j < n; ++j)
        for (int i = 0; i < n; ++i) {
            int a = j * (n + 1) + i, b = a + 1, c = b + n + 1, d = c - 1;
            int corners[2][2][3] = {{{a, b, c}, {a, c, d}}, {{a, b, d}, {b, c, d}}};
            for (int k = 0; k < 2; ++k, ++face)
                for (int q = 0; q < 3; ++q)
                    (*face)[q] = corners[(i + j) % 2][k][q];
        }
    return mesh;
}

void shape_move(ax_mesh* mesh, double angle, double x, double y, double z)
{
    for (int v = 0; v < mesh->vertex_count; ++v) {
        double *p = mesh->positions[v], b = p[1], c = p[2];
        p[0] += x;
        p[1] = cos(angle) * b - sin(angle) * c + y;
        p[2] = sin(angle) * b + cos(angle) * c + z;
    }
}

void shape_turn_over(ax_mesh* mesh)
{
    for (int f = 0; f < mesh->face_count; ++f) {
        int corner = mesh->faces[f][1];
        mesh->faces[f][1] = mesh->faces[f][2];
        mesh->faces[f][2] = corner;
    }
}
