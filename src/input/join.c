// Drawings often hold an outline as loose pieces: curves whose ends touch become one.
#include "input/pen.h"

#include "base/vec.h"

#include <math.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

// Ends are numbered 2 curve + (0 first point, 1 last point) and sorted by the cell of a grid, which is narrow enough that all
// ends of one cell touch: crowded cells are then decided at once, and the whole takes n log n.
typedef struct end {
    int64_t cell[2];
    int number;
} end;

enum { none = -1, several = -2 };

static int compare_ends(const void* a, const void* b)
{
    const end *x = a, *y = b;
    for (int d = 0; d < 2; ++d)
        if (x->cell[d] != y->cell[d])
            return x->cell[d] < y->cell[d] ? -1 : 1;
    return (x->number > y->number) - (x->number < y->number);
}

static const double* end_place(const ax_outline* outline, int number)
{
    const ax_outline_curve* curve = outline->curves + number / 2;
    return curve->points[number % 2 ? curve->count - 1 : 0];
}

// First of the sorted ends that is in this cell or behind it.
static int find_cell(const end* ends, int count, int64_t x, int64_t y)
{
    end wanted = {{x, y}, -1};
    int lo = 0, hi = count;
    while (lo < hi) {
        int middle = lo + (hi - lo) / 2;
        if (compare_ends(&ends[middle], &wanted) < 0)
            lo = middle + 1;
        else
            hi = middle;
    }
    return lo;
}

// The one end that touches end `e`, `none` or `several`.
static int find_partner(const ax_outline* outline, const end* ends, int count, const end* e, double tolerance)
{
    static const int near_first[] = {0, -1, 1, -2, 2};
    int partner = none;
    for (int column = 0; column < 5; ++column)
        for (int row = 0; row < 5; ++row) {
            int64_t x = e->cell[0] + near_first[column], y = e->cell[1] + near_first[row];
            for (int k = find_cell(ends, count, x, y); k < count && ends[k].cell[0] == x && ends[k].cell[1] == y; ++k) {
                if (ends[k].number == e->number ||
                    ax_distance2(end_place(outline, ends[k].number), end_place(outline, e->number)) > tolerance)
                    continue;
                if (partner != none)
                    return several;
                partner = ends[k].number;
            }
        }
    return partner;
}

// partner[e] of every end, `none` unless just two ends touch. Owned by the caller. `lo` is the lowest corner of the drawing.
static int* find_partners(const ax_outline* outline, const double lo[2], double tolerance)
{
    int count = 0;
    end* ends = AX_NEW(end, 2 * outline->count + 1);
    int* partner = AX_NEW(int, 2 * outline->count + 1);
    double width = tolerance / 1.5;
    for (int e = 0; e < 2 * outline->count; ++e) {
        partner[e] = none;
        if (outline->curves[e / 2].closed)
            continue;
        const double* x = end_place(outline, e);
        ends[count++] = (end){{(int64_t)((x[0] - lo[0]) / width), (int64_t)((x[1] - lo[1]) / width)}, e};
    }
    qsort(ends, (size_t)count, sizeof *ends, compare_ends);
    for (int k = 0; k < count; ++k)
        partner[ends[k].number] = find_partner(outline, ends, count, &ends[k], tolerance);
    for (int e = 0; e < 2 * outline->count; ++e)
        if (partner[e] >= 0 && (partner[partner[e]] != e)) // that one touches others too
            partner[e] = none;
    ax_free(ends);
    return partner;
}

static void append(ax_outline_curve* to, const ax_outline_curve* piece, bool reversed)
{
    for (int k = to->count > 0; k < piece->count; ++k) // but for the first of all, a first point touches the last one
        memcpy(to->points[to->count++], piece->points[reversed ? piece->count - 1 - k : k], sizeof *to->points);
}

// The chain of curves through curve c, as one that runs as c does; marks them as used.
static ax_outline_curve chain(const ax_outline* outline, const int* partner, bool* used, int c)
{
    const ax_outline_curve* curve = outline->curves + c;
    int start = 2 * c; // the end at which the chain is entered
    while (partner[start] >= 0 && partner[start] / 2 != c)
        start = partner[start] ^ 1;
    bool loop = partner[start] >= 0;
    if (loop)
        start = 2 * c;
    int points = 0, entry = start;
    do {
        used[entry / 2] = true;
        points += outline->curves[entry / 2].count;
        entry = partner[entry ^ 1];
    } while (entry >= 0 && entry != start);
    ax_outline_curve result = {.line = curve->line,
                               .closed = curve->closed || loop,
                               .points = ax_alloc((size_t)points, sizeof *result.points)};
    memcpy(result.name, curve->name, sizeof result.name);
    entry = start;
    do {
        append(&result, outline->curves + entry / 2, entry % 2);
        entry = partner[entry ^ 1];
    } while (entry >= 0 && entry != start);
    return result;
}

// Drops points on top of the one before, the repeated first one of closed curves too.
static void thin(ax_outline_curve* curve, double least)
{
    int count = 0;
    for (int k = 0; k < curve->count; ++k)
        if (count == 0 || ax_distance2(curve->points[k], curve->points[count - 1]) > least)
            memmove(curve->points[count++], curve->points[k], sizeof *curve->points);
    while (curve->closed && count > 1 && ax_distance2(curve->points[count - 1], curve->points[0]) <= least)
        --count;
    curve->count = count;
}

ax_outline ax_pen_finish(ax_pen* pen)
{
    ax_outline* pieces = &pen->outline;
    double lo[2], hi[2];
    double size = ax_pen_bounds(pen, lo, hi) ? ax_distance2(lo, hi) : 0;
    double least = 1e-12 * size, touching = fmax(pen->tolerance, 1e-9 * size);
    int kept = 0;
    for (int c = 0; c < pieces->count; ++c) {
        thin(&pieces->curves[c], least);
        if (pieces->curves[c].count > 1)
            pieces->curves[kept++] = pieces->curves[c];
        else
            ax_free(pieces->curves[c].points);
    }
    pieces->count = kept;
    int* partner = find_partners(pieces, lo, touching);
    bool* used = AX_NEW0(bool, kept + 1);
    ax_outline result = {.curves = AX_NEW(ax_outline_curve, kept + 1)};
    for (int c = 0; c < kept; ++c) {
        if (used[c])
            continue;
        ax_outline_curve whole = chain(pieces, partner, used, c);
        thin(&whole, least);
        if (whole.count >= (whole.closed ? 3 : 2))
            result.curves[result.count++] = whole;
        else
            ax_free(whole.points);
    }
    ax_free(used);
    ax_free(partner);
    ax_outline_free(pieces);
    return result;
}
