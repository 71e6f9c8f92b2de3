// Bringing the rim of a sheet to its outline where whole panels miss it: a regular octagon of 600 panels lacked its corners and bulged
// between them. The sheet is moved by d(z) = sum c_k z^k, complex numbers, which with its few terms is small and smooth: z + d(z)
// stretches alike in all directions, so panels stay nearly equilateral and turn as before, and only their sizes differ.
#include "form/state.h"

#include "base/vec.h"
#include "linalg/cholesky.h"
#include "linalg/sparse.h"

#include <math.h>
#include <string.h>

enum { TERMS = 10, UNKNOWNS = 2 * TERMS };
static const double most_uneven = 0.05; // of the sizes of panels
static const double stiffness = 2e-3;   // of a term, times the square of its power, with the rim's mean square gap at 1

typedef struct series {
    double middle[2], radius, term[TERMS][2]; // z = (x - middle) / radius
} series;

// 1, z, z^2 ...
static void list_powers(const series* s, const double x[2], double power[TERMS][2])
{
    double z[2] = {(x[0] - s->middle[0]) / s->radius, (x[1] - s->middle[1]) / s->radius};
    power[0][0] = 1, power[0][1] = 0;
    for (int k = 1; k < TERMS; ++k) {
        power[k][0] = power[k - 1][0] * z[0] - power[k - 1][1] * z[1];
        power[k][1] = power[k - 1][0] * z[1] + power[k - 1][1] * z[0];
    }
}

// Least squares of the rim's gaps along its outline's normals. False, with no terms, where they are not determined.
static bool fit_series(const ax_lattice* lattice, const ax_outline* outline, const ax_polyline* border, series* s)
{
    const ax_linkage* linkage = &lattice->linkage;
    const double(*x)[2] = (const double(*)[2])lattice->hinges;
    int *rim = AX_NEW(int, linkage->hinge_count), count = ax_linkage_rim(linkage, rim);
    double length = 0, square[UNKNOWNS][UNKNOWNS] = {{0}}, right[UNKNOWNS] = {0};
    for (int k = 0; k < count; ++k)
        length += ax_distance2(x[rim[k]], x[rim[(k + 1) % count]]);
    for (int k = 0; k < count; ++k) {
        const double *at = x[rim[k]], *before = x[rim[(k + count - 1) % count]], *after = x[rim[(k + 1) % count]];
        double share = (ax_distance2(at, before) + ax_distance2(at, after)) / (2 * length);
        ax_polyline_point on = ax_polyline_find(border, (const double[3]){at[0], at[1], 0});
        const double *a = outline->points[on.segment], *b = outline->points[(on.segment + 1) % outline->count];
        double side = ax_distance2(a, b);
        if (!(side > 0)) // a point that is given twice
            continue;
        double normal[2] = {(b[1] - a[1]) / side, (a[0] - b[0]) / side};
        double gap = (on.point[0] - at[0]) * normal[0] + (on.point[1] - at[1]) * normal[1];
        double power[TERMS][2], row[UNKNOWNS]; // of (u + iv) z^j along the normal
        list_powers(s, at, power);
        for (int j = 0; j < TERMS; ++j) {
            row[2 * j] = normal[0] * power[j][0] + normal[1] * power[j][1];
            row[2 * j + 1] = normal[1] * power[j][0] - normal[0] * power[j][1];
        }
        for (int i = 0; i < UNKNOWNS; ++i) {
            right[i] += share * row[i] * gap;
            for (int j = 0; j < UNKNOWNS; ++j)
                square[i][j] += share * row[i] * row[j];
        }
    }
    ax_free(rim);
    square[3][3] += 1; // it does not turn
    ax_entries entries = {0};
    for (int i = 0; i < UNKNOWNS; ++i)
        for (int j = 0; j <= i; ++j) {
            int power = i / 2;
            double own = i == j ? 1e-6 + stiffness * power * power : 0;
            ax_entries_add(&entries, i, j, square[i][j] + own);
        }
    ax_sparse matrix = ax_entries_sparse(&entries, UNKNOWNS);
    ax_cholesky* factor = ax_cholesky_analyse(&matrix);
    bool found = ax_cholesky_factor(factor, &matrix);
    memset(s->term, 0, sizeof s->term);
    if (found)
        ax_cholesky_solve(factor, right, s->term[0], 1);
    ax_cholesky_free(factor);
    ax_sparse_free(&matrix);
    return found;
}

// Where x goes to, and by how much lengths there change.
static double move(const series* s, double share, const double x[2], double to[2])
{
    double power[TERMS][2], slope[2] = {0, 0};
    list_powers(s, x, power);
    to[0] = x[0], to[1] = x[1];
    for (int k = 0; k < TERMS; ++k) {
        const double* c = s->term[k];
        to[0] += share * (c[0] * power[k][0] - c[1] * power[k][1]);
        to[1] += share * (c[0] * power[k][1] + c[1] * power[k][0]);
        if (k > 0) {
            slope[0] += k * (c[0] * power[k - 1][0] - c[1] * power[k - 1][1]) / s->radius;
            slope[1] += k * (c[0] * power[k - 1][1] + c[1] * power[k - 1][0]) / s->radius;
        }
    }
    return hypot(slope[0], slope[1]);
}

void ax_form_fit_border(ax_lattice* lattice, const ax_outline* outline, const ax_polyline* border,
                        const double middle[2])
{
    int n = lattice->linkage.hinge_count;
    series s = {.middle = {middle[0], middle[1]}};
    for (int h = 0; h < n; ++h)
        s.radius = fmax(s.radius, ax_distance2(lattice->hinges[h], middle));
    if (!fit_series(lattice, outline, border, &s))
        return;
    double uneven = 0, ignored[2];
    for (int h = 0; h < n; ++h)
        uneven = fmax(uneven, move(&s, 1, lattice->hinges[h], ignored));
    double share = uneven > most_uneven ? most_uneven / uneven : 1;
    for (int h = 0; h < n; ++h)
        move(&s, share, (const double[2]){lattice->hinges[h][0], lattice->hinges[h][1]}, lattice->hinges[h]);
}

// Whether places of three hinges in a row are to each other as on the sheet.
static bool is_alike(const double* const place[3], const double* const sheet[3])
{
    static const double alike = 0.02;
    double across = ax_distance3(place[0], place[2]), whole = ax_distance2(sheet[0], sheet[2]);
    bool is = across > 0 && whole > 0;
    for (int k = 0; k < 3 && is; k += 2)
        is = fabs(ax_distance3(place[k], place[1]) / across - ax_distance2(sheet[k], sheet[1]) / whole) < alike;
    return is;
}

void ax_form_list_fitting(const ax_form* f, unsigned char* fits)
{
    static const double on_outline = 0.15; // spacings
    const ax_linkage* linkage = &f->lattice.linkage;
    int n = linkage->hinge_count, *rim = AX_NEW(int, n), count = ax_linkage_rim(linkage, rim);
    const double** place = AX_NEW0(const double*, n);
    for (int k = 0; k < f->rim_count; ++k)
        for (int i = 0; i < f->rim[k].count && f->rim[k].kind == AX_RIM_FIXED; ++i)
            place[f->rim[k].hinges[i]] = f->rim[k].places[i];
    ax_polyline* outline =
        f->outline_count > 0 ? ax_form_outline_line(f->outline_count, (const double(*)[2])f->outline) : NULL;
    memset(fits, 0, (size_t)n);
    for (int k = 0; k < count && outline; ++k) {
        int row[3] = {rim[(k + count - 1) % count], rim[k], rim[(k + 1) % count]};
        const double *held[3], *sheet[3];
        for (int i = 0; i < 3; ++i)
            held[i] = place[row[i]], sheet[i] = f->lattice.hinges[row[i]];
        double at[3] = {sheet[1][0], sheet[1][1], 0};
        fits[rim[k]] = held[0] && held[1] && held[2] && is_alike(held, sheet) &&
                       ax_polyline_find(outline, at).distance < on_outline * f->lattice.spacing;
    }
    ax_polyline_free(outline);
    ax_free(place);
    ax_free(rim);
}
