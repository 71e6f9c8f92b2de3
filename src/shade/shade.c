#include "ax/shade.h"

#include "base/vec.h"

#include <math.h>
#include <stdint.h>
#include <string.h>

enum { SIDE = 8 }; // samples along the side of a cell: a row of one is a byte

static const double (*places_of(const ax_layer* l))[3]
{
    return l->state == AX_STATE_SIMULATED ? l->design->simulated : l->design->deployed;
}

// Where a layer's panels fall on the ground along a ray: its turn, its move and the projection in one affine map.
typedef struct throw
{
    double a[2][3], b[2];
}
throw;

// In the unit of the first layer, as the ground is.
static throw throw_of(const ax_layer* first, const ax_layer* l, const ax_ray* ray, double ground)
{
    double unit = ax_unit_in_metres(l->design->unit) / ax_unit_in_metres(first->design->unit);
    double c = unit * cos(l->turn), s = unit * sin(l->turn);
    double x = ray->to_sun[0] / ray->to_sun[2], y = ray->to_sun[1] / ray->to_sun[2], up = l->move[2] - ground;
    return (throw){{{c, -s, -x * unit}, {s, c, -y * unit}}, {l->move[0] - x * up, l->move[1] - y * up}};
}

static void fall(const throw *t, const double place[3], double out[2])
{
    for (int d = 0; d < 2; ++d)
        out[d] = t->a[d][0] * place[0] + t->a[d][1] * place[1] + t->a[d][2] * place[2] + t->b[d];
}

static bool is_kept(const ax_layer* l, const double (*x)[3], const int corner[3])
{
    if (isinf(l->extent))
        return true;
    double middle[2] = {0};
    for (int k = 0; k < 3; ++k)
        for (int d = 0; d < 2; ++d)
            middle[d] += x[corner[k]][d] / 3;
    return middle[0] * middle[0] + middle[1] * middle[1] <= l->extent * l->extent;
}

static ax_status check(int layer_count, const ax_layer* layers, int ray_count, const ax_ray* rays, ax_error* error)
{
    if (layer_count < 1)
        return ax_fail(error, AX_USAGE, "There is no layer to throw shade.");
    for (int k = 0; k < layer_count; ++k)
        if (!places_of(&layers[k]))
            return ax_fail(error, AX_BAD_INPUT, "Layer %d has no such state. Deploy it first.", k + 1);
    if (ray_count < 1)
        return ax_fail(error, AX_USAGE, "The sun is below the horizon all the time. Choose another time.");
    for (int k = 0; k < ray_count; ++k)
        if (!(rays[k].to_sun[2] > 0 && rays[k].weight > 0))
            return ax_fail(error, AX_USAGE, "Ray %d comes from below the horizon.", k + 1);
    return AX_OK;
}

ax_status ax_shade_ground(int layer_count, const ax_layer* layers, int ray_count, const ax_ray* rays, double height,
                          int cells, ax_ground* out, ax_error* error)
{
    ax_status status = check(layer_count, layers, ray_count, rays, error);
    if (status != AX_OK)
        return status;
    double lo[2] = {INFINITY, INFINITY}, hi[2] = {-INFINITY, -INFINITY};
    for (int k = 0; k < layer_count; ++k)
        for (int r = 0; r < ray_count; ++r) {
            throw t = throw_of(layers, &layers[k], &rays[r], height);
            for (int h = 0; h < layers[k].design->linkage.hinge_count; ++h) {
                double p[2];
                fall(&t, places_of(&layers[k])[h], p);
                for (int d = 0; d < 2; ++d)
                    lo[d] = fmin(lo[d], p[d]), hi[d] = fmax(hi[d], p[d]);
            }
        }
    double width = hi[0] - lo[0], depth = hi[1] - lo[1];
    double cell = sqrt(width * depth / cells);
    *out = (ax_ground){height, {lo[0], lo[1]}, cell, (int)ceil(width / cell), (int)ceil(depth / cell)};
    return AX_OK;
}

// Bits of a row of samples from `first` to before `end`.
static void set_bits(uint8_t* row, int first, int end)
{
    int a = first / SIDE, b = end / SIDE;
    unsigned head = 0xffu << first % SIDE, tail = (1u << end % SIDE) - 1;
    if (a == b) {
        row[a] |= (uint8_t)(head & tail);
        return;
    }
    row[a] |= (uint8_t)head;
    memset(row + a + 1, 0xff, (size_t)(b - a - 1));
    if (tail)
        row[b] |= (uint8_t)tail;
}

// Sets the samples within a triangle, whose corners are in units of samples.
static void fill(const double corner[3][2], int width, int height, uint8_t* bits)
{
    double lo = fmin(corner[0][1], fmin(corner[1][1], corner[2][1]));
    double hi = fmax(corner[0][1], fmax(corner[1][1], corner[2][1]));
    int first = (int)ax_clamp(ceil(lo - 0.5), 0, height), end = (int)ax_clamp(ceil(hi - 0.5), 0, height);
    for (int row = first; row < end; ++row) {
        double y = row + 0.5, left = INFINITY, right = -INFINITY;
        for (int k = 0; k < 3; ++k) {
            const double *a = corner[k], *b = corner[(k + 1) % 3];
            if ((a[1] <= y) == (b[1] <= y))
                continue;
            double x = a[0] + (y - a[1]) / (b[1] - a[1]) * (b[0] - a[0]);
            left = fmin(left, x), right = fmax(right, x);
        }
        int from = (int)ax_clamp(ceil(left - 0.5), 0, width), to = (int)ax_clamp(ceil(right - 0.5), 0, width);
        if (from < to)
            set_bits(bits + (size_t)row * (size_t)(width / SIDE), from, to);
    }
}

static void cast(const ax_layer* first, const ax_layer* l, const ax_ray* ray, const ax_ground* g, uint8_t* bits)
{
    const double(*x)[3] = places_of(l);
    throw t = throw_of(first, l, ray, g->height);
    double samples = SIDE / g->cell;
    for (int k = 0; k < l->design->linkage.triangle_count; ++k) {
        const int* corner = l->design->linkage.triangles[k];
        if (!is_kept(l, x, corner))
            continue;
        double p[3][2];
        for (int i = 0; i < 3; ++i) {
            fall(&t, x[corner[i]], p[i]);
            for (int d = 0; d < 2; ++d)
                p[i][d] = samples * (p[i][d] - g->lo[d]);
        }
        fill(p, SIDE * g->columns, SIDE * g->rows, bits);
    }
}

ax_status ax_shade_map(int layer_count, const ax_layer* layers, int ray_count, const ax_ray* rays, const ax_ground* g,
                       const ax_progress* progress, double* opacity, ax_error* error)
{
    ax_status status = check(layer_count, layers, ray_count, rays, error);
    if (status != AX_OK)
        return status;
    if (g->columns < 1 || g->rows < 1 || !(g->cell > 0) || (double)g->columns * g->rows > AX_GROUND_CELLS)
        return ax_fail(error, AX_USAGE, "The ground must have 1 to %d cells.", AX_GROUND_CELLS);
    size_t cells = (size_t)g->columns * (size_t)g->rows;
    uint8_t* bits = AX_NEW(uint8_t, SIDE * cells);
    double total = 0;
    for (int r = 0; r < ray_count; ++r)
        total += rays[r].weight;
    memset(opacity, 0, cells * sizeof *opacity);
    for (int r = 0; r < ray_count && status == AX_OK; ++r) {
        memset(bits, 0, SIDE * cells);
        for (int k = 0; k < layer_count; ++k)
            cast(layers, &layers[k], &rays[r], g, bits);
        for (int row = 0; row < g->rows; ++row)
            for (int c = 0; c < g->columns; ++c) {
                int count = 0;
                for (int i = 0; i < SIDE; ++i)
                    count +=
                        __builtin_popcount(bits[((size_t)row * SIDE + (size_t)i) * (size_t)g->columns + (size_t)c]);
                opacity[(size_t)row * (size_t)g->columns + (size_t)c] += rays[r].weight / total * count / (SIDE * SIDE);
            }
        if (!ax_progress_report(progress, "Casting shadows", (r + 1.0) / ray_count, NAN))
            status = ax_fail(error, AX_CANCELLED, "Cancelled.");
    }
    ax_free(bits);
    return status;
}

double ax_shade_mean(const ax_ground* g, const double* opacity, const ax_shade_wish* disc)
{
    double sum = 0;
    int count = 0;
    for (int row = 0; row < g->rows; ++row)
        for (int c = 0; c < g->columns; ++c) {
            double x = g->lo[0] + (c + 0.5) * g->cell - disc->at[0], y = g->lo[1] + (row + 0.5) * g->cell - disc->at[1];
            if (x * x + y * y > disc->radius * disc->radius)
                continue;
            sum += opacity[(size_t)row * (size_t)g->columns + (size_t)c];
            ++count;
        }
    return count ? sum / count : NAN;
}
