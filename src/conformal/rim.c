#include "conformal/rim.h"

#include "base/vec.h"

#include <assert.h>
#include <stdlib.h>
#include <string.h>

void ax_rim_close(int count, const double* turning, const double* target, const double* length, double (*curve)[2])
{
    double(*tangent)[2] = ax_alloc((size_t)count, sizeof *tangent);
    double gap[2] = {0}, xx = 0, xy = 0, yy = 0, direction = 0;
    for (int k = 0; k < count; ++k) {
        direction += k ? turning[k] : 0;
        double x = cos(direction), y = sin(direction);
        tangent[k][0] = x, tangent[k][1] = y;
        gap[0] += target[k] * x, gap[1] += target[k] * y;
        xx += length[k] * x * x, xy += length[k] * x * y, yy += length[k] * y * y;
    }
    // l~ = l* - N^-1 T' (T N^-1 T')^-1 T l*, where 1 / N is the length on the surface
    double determinant = xx * yy - xy * xy;
    double a = (yy * gap[0] - xy * gap[1]) / determinant, b = (xx * gap[1] - xy * gap[0]) / determinant;
    double at[2] = {0};
    for (int k = 0; k < count; ++k) {
        double l = target[k] - length[k] * (tangent[k][0] * a + tangent[k][1] * b);
        for (int d = 0; d < 2; ++d) {
            curve[k][d] = at[d];
            at[d] += l * tangent[k][d];
        }
    }
    ax_free(tangent);
}

static double sum(int count, const double* x)
{
    double s = 0;
    for (int k = 0; k < count; ++k)
        s += x[k];
    return s;
}

void ax_rim_circle(int count, const double* target, double (*curve)[2])
{
    double perimeter = sum(count, target), chords = 0, arc = 0;
    for (int k = 0; k < count; ++k)
        chords += 2 * sin(AX_PI * target[k] / perimeter);
    double radius = perimeter / chords;
    for (int k = 0; k < count; ++k) {
        curve[k][0] = radius * cos(2 * AX_PI * arc / perimeter);
        curve[k][1] = radius * sin(2 * AX_PI * arc / perimeter);
        arc += target[k];
    }
}

void ax_rim_circle_turning(int count, const double* target, double* turning)
{
    double perimeter = sum(count, target);
    for (int k = 0; k < count; ++k)
        turning[k] = AX_PI * (target[k ? k - 1 : count - 1] + target[k]) / perimeter;
}

typedef struct candidate {
    double sharpness;
    int vertex;
} candidate;

static int sharpest_first(const void* a, const void* b)
{
    const candidate *x = a, *y = b;
    return x->sharpness != y->sharpness ? (x->sharpness < y->sharpness ? 1 : -1) : x->vertex - y->vertex;
}

static int ascending(const void* a, const void* b)
{
    return *(const int*)a - *(const int*)b;
}

// Distance along the rim from vertex a forward to vertex b, with b up to one round ahead.
static double forward(int count, const double* place, int a, int b)
{
    return b < count ? place[b] - place[a] : place[b - count] + place[count] - place[a];
}

// Turning within `reach` of vertex k, weighted by nearness: a corner rounded off over less than that still counts.
static double turning_near(int count, const double* turning, const double* place, double reach, int k)
{
    double near = turning[k];
    for (int j = 1; j < count; ++j) {
        double distance = forward(count, place, k, k + j);
        if (distance >= reach)
            break;
        near += turning[(k + j) % count] * (1 - distance / reach);
    }
    for (int j = 1; j < count; ++j) {
        int before = (k - j + count) % count;
        double distance = forward(count, place, before, before + (k - before + count) % count);
        if (distance >= reach)
            break;
        near += turning[before] * (1 - distance / reach);
    }
    return near;
}

// Corners of the rim itself: turning by more than 30 degrees, sharpest first, a quarter of an even spacing apart.
static int find_corners(int count, const double* turning, const double* place, int wanted, int* corner)
{
    double perimeter = place[count];
    candidate* candidates = AX_NEW(candidate, count);
    for (int k = 0; k < count; ++k)
        candidates[k] = (candidate){fabs(turning_near(count, turning, place, perimeter / (16 * wanted), k)), k};
    qsort(candidates, (size_t)count, sizeof *candidates, sharpest_first);
    int found = 0;
    for (int c = 0; c < count && found < wanted && candidates[c].sharpness > AX_PI / 6; ++c) {
        bool apart = true;
        for (int k = 0; k < found; ++k) {
            double distance = fabs(place[candidates[c].vertex] - place[corner[k]]);
            apart = apart && fmin(distance, perimeter - distance) > perimeter / (4 * wanted);
        }
        if (apart)
            corner[found++] = candidates[c].vertex;
    }
    if (found == 0)
        corner[found++] = candidates[0].vertex;
    ax_free(candidates);
    qsort(corner, (size_t)found, sizeof *corner, ascending);
    return found;
}

// Divides the sides between the corners found until there are `wanted`: the side with the longest parts gets one part
// more.
static void divide_sides(int count, const double* place, int found, int wanted, int* corner)
{
    int *parts = AX_NEW(int, found), *first = AX_NEW(int, found + 1);
    double* side = AX_NEW(double, found);
    memcpy(first, corner, (size_t)found * sizeof *first);
    first[found] = first[0] + count;
    for (int k = 0; k < found; ++k) {
        parts[k] = 1;
        side[k] = forward(count, place, first[k], first[k + 1]);
    }
    for (int n = found; n < wanted; ++n) {
        int longest = -1;
        for (int k = 0; k < found; ++k)
            if (parts[k] < first[k + 1] - first[k] &&
                (longest < 0 || side[k] / parts[k] > side[longest] / parts[longest]))
                longest = k;
        ++parts[longest];
    }
    for (int k = 0, n = 0; k < found; ++k)
        for (int part = 0, v = first[k]; part < parts[k]; ++part, ++v) {
            double goal = side[k] * part / parts[k]; // the nearest vertex that leaves one for each later corner
            while (v + parts[k] - part < first[k + 1] && fabs(forward(count, place, first[k], v + 1) - goal) <
                                                             fabs(forward(count, place, first[k], v) - goal))
                ++v;
            corner[n++] = v % count;
        }
    ax_free(parts);
    ax_free(first);
    ax_free(side);
}

void ax_rim_corners(int count, const double* turning, const double* length, int corner_count, const double* angles,
                    int* corner)
{
    assert(corner_count <= count);
    double* place = AX_NEW(double, count + 1); // along the rim
    place[0] = 0;
    for (int k = 0; k < count; ++k)
        place[k + 1] = place[k] + length[k];
    int found = find_corners(count, turning, place, corner_count, corner);
    divide_sides(count, place, found, corner_count, corner);

    // the angles go round the rim in the rotation that changes its turning angles least
    int best = 0;
    double least = INFINITY;
    for (int shift = 0; shift < corner_count; ++shift) {
        double change = 0;
        for (int k = 0; k < corner_count; ++k) {
            double d = AX_PI - angles[k] * AX_PI / 180 - turning[corner[(k + shift) % corner_count]];
            change += d * d;
        }
        if (change < least - 1e-9) {
            least = change;
            best = shift;
        }
    }
    int* turned = AX_NEW(int, corner_count);
    for (int k = 0; k < corner_count; ++k)
        turned[k] = corner[(k + best) % corner_count];
    for (int k = 0; k < corner_count; ++k)
        corner[k] = turned[k];
    ax_free(turned);
    ax_free(place);
}

static bool cross(const double a[2], const double b[2], const double c[2], const double d[2])
{
    return ax_orient2(a, b, c) * ax_orient2(a, b, d) < 0 && ax_orient2(c, d, a) * ax_orient2(c, d, b) < 0;
}

// A uniform grid of about two cells per edge; each edge is entered in the cells that its bounding box touches.
typedef struct edge_grid {
    double corner[2], size;
    int cells[2];
} edge_grid;

static void cells_of_edge(const edge_grid* grid, const double a[2], const double b[2], int lo[2], int hi[2])
{
    for (int d = 0; d < 2; ++d) {
        lo[d] = (int)ax_clamp((fmin(a[d], b[d]) - grid->corner[d]) / grid->size, 0, grid->cells[d] - 1);
        hi[d] = (int)ax_clamp((fmax(a[d], b[d]) - grid->corner[d]) / grid->size, 0, grid->cells[d] - 1);
    }
}

bool ax_rim_is_simple(int count, const double (*points)[2])
{
    double extent[2];
    edge_grid grid;
    for (int d = 0; d < 2; ++d) {
        double lo = points[0][d], hi = points[0][d];
        for (int k = 1; k < count; ++k) {
            lo = fmin(lo, points[k][d]);
            hi = fmax(hi, points[k][d]);
        }
        grid.corner[d] = lo;
        extent[d] = hi - lo;
    }
    grid.size = fmax(sqrt(extent[0] * extent[1] / (2.0 * count)), fmax(extent[0], extent[1]) / (2.0 * count));
    for (int d = 0; d < 2; ++d)
        grid.cells[d] = 1 + (int)(extent[d] / grid.size);

    // the edges of each cell, by counting and then filling
    int cell_count = grid.cells[0] * grid.cells[1], *start = AX_NEW0(int, cell_count + 1), *edges = NULL;
    for (int pass = 0; pass < 2; ++pass) {
        for (int k = 0; k < count; ++k) {
            int lo[2], hi[2];
            cells_of_edge(&grid, points[k], points[(k + 1) % count], lo, hi);
            for (int y = lo[1]; y <= hi[1]; ++y)
                for (int x = lo[0]; x <= hi[0]; ++x) {
                    int cell = y * grid.cells[0] + x;
                    if (pass == 0)
                        ++start[cell + 1];
                    else
                        edges[start[cell]++] = k;
                }
        }
        if (pass == 0) {
            for (int cell = 0; cell < cell_count; ++cell)
                start[cell + 1] += start[cell];
            edges = AX_NEW(int, start[cell_count]);
        }
    }
    bool simple = true;
    for (int cell = 0, begin = 0; cell < cell_count && simple; begin = start[cell++])
        for (int i = begin; i < start[cell] && simple; ++i)
            for (int j = i + 1; j < start[cell] && simple; ++j) {
                int a = edges[i], b = edges[j];
                simple = !cross(points[a], points[(a + 1) % count], points[b], points[(b + 1) % count]);
            }
    ax_free(start);
    ax_free(edges);
    return simple;
}
