// How far the shapes of two forms lie apart, whatever panels they have.
#include "form/map.h"

#include "base/bucket.h"
#include "base/vec.h"

#include <math.h>
#include <string.h>

static const double reach = 1.5; // of the lattice spacing: a fit takes the hinges so near

// Where a state passes each hinge: a linear fit to the hinges about it, by the sheet. Hinges about a slack hole stand in a zigzag that goes by
// panels.
static double (*smooth(const ax_form* f, const double (*x)[3]))[3]
{
    int n = f->lattice.linkage.hinge_count;
    const double(*sheet)[2] = (const double(*)[2])f->lattice.hinges;
    double lo[2] = {INFINITY, INFINITY}, hi[2] = {-INFINITY, -INFINITY}, cell = reach * f->lattice.spacing;
    for (int h = 0; h < n; ++h)
        for (int c = 0; c < 2; ++c)
            lo[c] = fmin(lo[c], sheet[h][c]), hi[c] = fmax(hi[c], sheet[h][c]);
    int columns = (int)((hi[0] - lo[0]) / cell) + 1, rows = (int)((hi[1] - lo[1]) / cell) + 1;
    int *key = AX_NEW(int, n), *start = AX_NEW(int, columns*rows + 1), *sorted = AX_NEW(int, n);
    for (int h = 0; h < n; ++h)
        key[h] = (int)((sheet[h][1] - lo[1]) / cell) * columns + (int)((sheet[h][0] - lo[0]) / cell);
    ax_bucket_sort(n, columns * rows, key, NULL, start, sorted);
    double(*out)[3] = ax_alloc((size_t)n, sizeof *out);
    for (int h = 0; h < n; ++h) {
        double m[3][3] = {{0}}, right[3][3] = {{0}}, cross[3];
        int row = key[h] / columns, column = key[h] % columns;
        for (int r = row > 0 ? row - 1 : 0; r <= row + 1 && r < rows; ++r)
            for (int c = column > 0 ? column - 1 : 0; c <= column + 1 && c < columns; ++c)
                for (int k = start[r * columns + c]; k < start[r * columns + c + 1]; ++k) {
                    int g = sorted[k];
                    double away = ax_distance2(sheet[g], sheet[h]) / cell;
                    double d[3] = {1, sheet[g][0] - sheet[h][0], sheet[g][1] - sheet[h][1]};
                    for (int i = 0; away < 1 && i < 3; ++i)
                        for (int j = 0; j < 3; ++j) {
                            m[i][j] += (1 - away) * (1 - away) * d[i] * d[j];
                            right[i][j] += (1 - away) * (1 - away) * d[i] * x[g][j];
                        }
                }
        ax_cross(m[1], m[2], cross); // the first row of the inverse, by Cramer's rule
        double determinant = ax_dot3(m[0], cross);
        for (int j = 0; j < 3; ++j)
            out[h][j] = (cross[0] * right[0][j] + cross[1] * right[1][j] + cross[2] * right[2][j]) / determinant;
    }
    ax_free(key);
    ax_free(start);
    ax_free(sorted);
    return out;
}

// A form as it is compared.
typedef struct side {
    const ax_form* form;
    ax_sheet_map* map;
    double (*places)[3];
    unsigned char* inner; // per hinge: beyond the margin
    ax_mesh surface;
    ax_closest* tree;
} side;

// The tree borrows the surface: a side stays where it is.
static void take(const ax_form* f, bool simulated, double margin, side* s)
{
    int n = f->lattice.linkage.hinge_count;
    *s = (side){.form = f,
                .map = ax_sheet_map_make(f),
                .places = smooth(f, (const double(*)[3])(simulated ? f->simulated : f->deployed)),
                .inner = AX_NEW(unsigned char, n)};
    for (int h = 0; h < n; ++h) {
        const double at[3] = {f->lattice.hinges[h][0], f->lattice.hinges[h][1], 0};
        s->inner[h] = ax_polyline_find(s->map->rim, at).distance > 2 * margin * f->radius;
    }
    s->surface = ax_linkage_cover(&f->lattice.linkage, (const double(*)[3])s->places);
    s->tree = ax_closest_make(&s->surface);
}

static void release(side* s)
{
    ax_closest_free(s->tree);
    ax_mesh_free(&s->surface);
    ax_free(s->inner);
    ax_free(s->places);
    ax_sheet_map_free(s->map);
}

static bool same_sheet(const ax_form* a, const ax_form* b)
{
    if (a->outline_count > 0)
        return a->outline_count == b->outline_count &&
               memcmp(a->outline, b->outline, (size_t)a->outline_count * sizeof *a->outline) == 0;
    int n = a->lattice.linkage.hinge_count;
    return n == b->lattice.linkage.hinge_count &&
           memcmp(a->lattice.hinges, b->lattice.hinges, (size_t)n * sizeof *a->lattice.hinges) == 0;
}

static void compare_points(const side* a, const side* b, ax_form_apart* out)
{
    int n = a->form->lattice.linkage.hinge_count, count = 0;
    double(*there)[3] = ax_alloc((size_t)n, sizeof *there), sum = 0;
    ax_sheet_map_carry(b->map, (const double(*)[3])b->places, n, (const double(*)[2])a->form->lattice.hinges, there);
    for (int h = 0; h < n; ++h)
        if (a->inner[h]) {
            double d = ax_distance3(a->places[h], there[h]) / out->size;
            sum += d * d, ++count;
            if (d >= out->points_max)
                out->points_max = d, out->hinge = h;
        }
    out->points_rms = count > 0 ? sqrt(sum / count) : 0;
    ax_free(there);
}

static void compare_surfaces(const side* sides[2], ax_form_apart* out)
{
    double sum = 0;
    int count = 0;
    for (int k = 0; k < 2; ++k) {
        const side *from = sides[k], *to = sides[1 - k];
        int face = -1;
        for (int h = 0; h < from->form->lattice.linkage.hinge_count; ++h)
            if (from->inner[h]) {
                ax_closest_point on = ax_closest_find(to->tree, from->places[h], face);
                face = on.face;
                sum += on.distance * on.distance, ++count;
                out->surfaces_max = fmax(out->surfaces_max, on.distance / out->size);
            }
    }
    out->surfaces_rms = count > 0 ? sqrt(sum / count) / out->size : 0;
}

void ax_form_measure_apart(const ax_form* a, const ax_form* b, bool simulated, double margin, ax_form_apart* out)
{
    side sides[2];
    take(a, simulated, margin, &sides[0]);
    take(b, simulated, margin, &sides[1]);
    *out = (ax_form_apart){.hinge = -1};
    for (int k = 0; k < 2; ++k)
        for (int c = 0; c < 3; ++c) {
            double lo = INFINITY, hi = -INFINITY;
            for (int h = 0; h < sides[k].form->lattice.linkage.hinge_count; ++h)
                lo = fmin(lo, sides[k].places[h][c]), hi = fmax(hi, sides[k].places[h][c]);
            out->size = fmax(out->size, hi - lo);
        }
    if (same_sheet(a, b))
        compare_points(&sides[0], &sides[1], out);
    else
        out->points_rms = out->points_max = NAN;
    compare_surfaces((const side* [2]){&sides[0], &sides[1]}, out);
    for (int k = 0; k < 2; ++k)
        release(&sides[k]);
}
