// Mean curvature of a state, from its hinges: they lie on the surface, while centres of holes and panels lie beneath it by
// amounts that change with their sizes, which near a rim of uneven panels is more than the surface itself bends.
#include "analysis/measure.h"
#include "base/vec.h"
#include "linkage/lattice.h"

#include <string.h>

enum { RINGS = 2, TERMS = 6 };   // panels two hinges away; 1, x, y, x2/2, xy, y2/2
enum { MOST = 32, ENOUGH = 12 }; // hinges: 21 in a full neighbourhood
static const double flattest =
    1e-4; // least pivot over the largest: hinges that nearly lie on a conic tell no curvature

typedef struct patch {
    int count, hinge[MOST];
    double normal[3]; // twice the vector area of its panels
} patch;

// Hinges of the panels within RINGS steps of panel t.
static patch gather(const ax_linkage* l, const int (*owner)[2], const double (*x)[3], int t)
{
    patch p = {0};
    int panel[MOST] = {t}, panels = 1;
    for (int ring = 0, from = 0; ring <= RINGS; ++ring) {
        int to = panels;
        for (int k = from; k < to; ++k) {
            const int* corner = l->triangles[panel[k]];
            double a[3], b[3], normal[3];
            ax_sub3(x[corner[1]], x[corner[0]], a);
            ax_sub3(x[corner[2]], x[corner[0]], b);
            ax_cross(a, b, normal);
            for (int c = 0; c < 3; ++c) {
                p.normal[c] += normal[c];
                bool known = false;
                for (int i = 0; i < p.count && !known; ++i)
                    known = p.hinge[i] == corner[c];
                if (known || p.count == MOST)
                    continue;
                p.hinge[p.count++] = corner[c];
                int next = owner[corner[c]][owner[corner[c]][0] == panel[k]];
                for (int i = 0; i < panels && next >= 0; ++i)
                    if (panel[i] == next)
                        next = -1;
                if (next >= 0 && panels < MOST)
                    panel[panels++] = next;
            }
        }
        from = to;
    }
    return p;
}

// Cholesky of the normal equations of a least squares fit; false where the hinges do not determine it.
static bool solve(double a[TERMS][TERMS], double right[TERMS])
{
    double most = 0;
    for (int j = 0; j < TERMS; ++j) {
        for (int k = 0; k < j; ++k)
            a[j][j] -= a[j][k] * a[j][k];
        most = fmax(most, a[j][j]);
        if (!(a[j][j] > flattest * most))
            return false;
        a[j][j] = sqrt(a[j][j]);
        for (int i = j + 1; i < TERMS; ++i) {
            for (int k = 0; k < j; ++k)
                a[i][j] -= a[i][k] * a[j][k];
            a[i][j] /= a[j][j];
        }
    }
    for (int i = 0; i < TERMS; ++i) {
        for (int k = 0; k < i; ++k)
            right[i] -= a[i][k] * right[k];
        right[i] /= a[i][i];
    }
    for (int i = TERMS - 1; i >= 0; --i) {
        for (int k = i + 1; k < TERMS; ++k)
            right[i] -= a[k][i] * right[k];
        right[i] /= a[i][i];
    }
    return true;
}

// Positive where the surface bulges to the side of the panels' normals.
static double fit(const patch* p, const double (*x)[3], const double origin[3])
{
    double size = ax_norm3(p->normal);
    if (p->count < ENOUGH || !(size > 0))
        return NAN;
    double n[3] = {p->normal[0] / size, p->normal[1] / size, p->normal[2] / size}, u[3], v[3], unit = 0;
    double along[3] = {fabs(n[0]) < 0.6, fabs(n[0]) >= 0.6, 0};
    ax_cross(n, along, u);
    double length = ax_norm3(u);
    for (int c = 0; c < 3; ++c)
        u[c] /= length;
    ax_cross(n, u, v);
    for (int i = 0; i < p->count; ++i)
        unit = fmax(unit, ax_distance3(x[p->hinge[i]], origin));
    double a[TERMS][TERMS] = {{0}}, right[TERMS] = {0};
    for (int i = 0; i < p->count; ++i) {
        double d[3];
        ax_sub3(x[p->hinge[i]], origin, d);
        double s = ax_dot3(d, u) / unit, t = ax_dot3(d, v) / unit, z = ax_dot3(d, n) / unit;
        double term[TERMS] = {1, s, t, s * s / 2, s * t, t * t / 2};
        for (int j = 0; j < TERMS; ++j) {
            right[j] += term[j] * z;
            for (int k = 0; k < TERMS; ++k)
                a[j][k] += term[j] * term[k];
        }
    }
    if (!solve(a, right))
        return NAN;
    double zs = right[1], zt = right[2], slope = 1 + zs * zs + zt * zt;
    return -((1 + zt * zt) * right[3] - 2 * zs * zt * right[4] + (1 + zs * zs) * right[5]) /
           (2 * slope * sqrt(slope) * unit);
}

void ax_measure_mean_curvature(const ax_linkage* linkage, const double (*places)[3], double* out)
{
    int(*owner)[2] = ax_linkage_hinge_triangles(linkage);
    double total = 0;
    for (int t = 0; t < linkage->triangle_count; ++t) {
        const int* corner = linkage->triangles[t];
        double centre[3];
        for (int c = 0; c < 3; ++c)
            centre[c] = (places[corner[0]][c] + places[corner[1]][c] + places[corner[2]][c]) / 3;
        patch p = gather(linkage, (const int(*)[2])owner, places, t);
        out[t] = fit(&p, places, centre);
        if (isfinite(out[t]))
            total += out[t];
    }
    for (int t = 0; t < linkage->triangle_count && total < 0; ++t)
        out[t] = -out[t];
    ax_free(owner);
}
