#include "picture/raster.h"

#include "base/vec.h"

#include <assert.h>
#include <stdint.h>

// With pictures of up to 8192 pixels, an edge function changes by less than 2^28 within a pixel, which leaves room for sums in 32 bits.
enum { SUBPIXEL = 128, FARTHEST = 8192 * SUBPIXEL, SATURATED = 1 << 30, TILE = AX_RASTER_TILE };

typedef struct point {
    int x, y; // 1/SUBPIXEL pixel
    float near;
} point;

// A rank-1 lattice: sample k in column k, row 5 k mod 16.
static int sample_column(int samples, int k)
{
    return samples == 1 ? SUBPIXEL / 2 : (2 * k + 1) * SUBPIXEL / (2 * AX_RASTER_SAMPLES);
}

static int sample_row(int samples, int k)
{
    return sample_column(samples, 5 * k % AX_RASTER_SAMPLES);
}

void ax_raster_sample(int samples, int k, double place[2])
{
    place[0] = sample_column(samples, k) / (double)SUBPIXEL;
    place[1] = sample_row(samples, k) / (double)SUBPIXEL;
}

static point* snap(int count, const ax_raster_vertex* vertices)
{
    point* points = AX_NEW(point, count);
    for (int v = 0; v < count; ++v) {
        points[v].x = (int)lrint(ax_clamp(vertices[v].x * SUBPIXEL, -SUBPIXEL, FARTHEST + SUBPIXEL));
        points[v].y = (int)lrint(ax_clamp(vertices[v].y * SUBPIXEL, -SUBPIXEL, FARTHEST + SUBPIXEL));
        points[v].near = vertices[v].near;
    }
    return points;
}

typedef struct range {
    int x0, y0, x1, y1; // inclusive
} range;

// Pixels or, with a larger cell, tiles that a face's box touches.
static range touched(const point* a, const point* b, const point* c, int cell, range within)
{
    int size = cell * SUBPIXEL;
    int x0 = a->x < b->x ? a->x : b->x, x1 = a->x > b->x ? a->x : b->x;
    int y0 = a->y < b->y ? a->y : b->y, y1 = a->y > b->y ? a->y : b->y;
    x0 = x0 < c->x ? x0 : c->x, x1 = x1 > c->x ? x1 : c->x;
    y0 = y0 < c->y ? y0 : c->y, y1 = y1 > c->y ? y1 : c->y;
    range r = {x0 < 0 ? 0 : x0 / size, y0 < 0 ? 0 : y0 / size, x1 < 0 ? -1 : x1 / size, y1 < 0 ? -1 : y1 / size};
    r.x0 = r.x0 > within.x0 ? r.x0 : within.x0, r.x1 = r.x1 < within.x1 ? r.x1 : within.x1;
    r.y0 = r.y0 > within.y0 ? r.y0 : within.y0, r.y1 = r.y1 < within.y1 ? r.y1 : within.y1;
    return r;
}

// Edge function a to b, positive to the left as seen with y down; samples on an edge belong to one of its two sides.
typedef struct edge {
    int64_t value; // at the corner of the pixel in work
    int64_t right, down;
    int at_sample[AX_RASTER_SAMPLES], largest;
} edge;

static inline __attribute__((always_inline)) edge make_edge(const point* a, const point* b, int samples, int x, int y)
{
    int64_t dx = b->x - a->x, dy = b->y - a->y;
    bool owns = dy > 0 || (dy == 0 && dx < 0);
    edge e = {
        .value = dx * (y * (int64_t)SUBPIXEL - a->y) - dy * (x * (int64_t)SUBPIXEL - a->x) - !owns,
        .right = -dy * SUBPIXEL,
        .down = dx * SUBPIXEL,
        .largest = INT32_MIN,
    };
    for (int k = 0; k < samples; ++k) {
        e.at_sample[k] = (int)(dx * sample_row(samples, k) - dy * sample_column(samples, k));
        e.largest = e.at_sample[k] > e.largest ? e.at_sample[k] : e.largest;
    }
    return e;
}

static inline int saturate(int64_t value)
{
    return value < SATURATED ? (int)value : SATURATED;
}

static inline __attribute__((always_inline)) void draw(const point* a, const point* b, const point* c, int face,
                                                       int samples, range pixels, int x, int y, int* restrict seen,
                                                       float* restrict depth)
{
    int64_t area = (b->x - a->x) * (int64_t)(c->y - a->y) - (b->y - a->y) * (int64_t)(c->x - a->x);
    if (area == 0)
        return;
    if (area < 0) {
        const point* swap = b;
        b = c, c = swap, area = -area;
    }
    edge edges[3] = {make_edge(a, b, samples, pixels.x0, pixels.y0), make_edge(b, c, samples, pixels.x0, pixels.y0),
                     make_edge(c, a, samples, pixels.x0, pixels.y0)};
    double bx = b->x - a->x, by = b->y - a->y, cx = c->x - a->x, cy = c->y - a->y;
    double rise_b = (double)b->near - a->near, rise_c = (double)c->near - a->near;
    double slope_x = (rise_b * cy - rise_c * by) / (double)area, slope_y = (rise_c * bx - rise_b * cx) / (double)area;
    float at_sample[AX_RASTER_SAMPLES];
    for (int k = 0; k < samples; ++k)
        at_sample[k] = (float)(slope_x * sample_column(samples, k) + slope_y * sample_row(samples, k));
    float nearest = fmaxf(a->near, fmaxf(b->near, c->near)), farthest = fminf(a->near, fminf(b->near, c->near));
    for (int row = pixels.y0; row <= pixels.y1; ++row) {
        int64_t value[3] = {edges[0].value, edges[1].value, edges[2].value};
        for (int column = pixels.x0; column <= pixels.x1; ++column) {
            bool touches = true;
            for (int k = 0; k < 3; ++k)
                touches &= value[k] + edges[k].largest >= 0;
            if (touches) {
                int e0 = saturate(value[0]), e1 = saturate(value[1]), e2 = saturate(value[2]);
                float near = (float)(a->near + slope_x * (column * (double)SUBPIXEL - a->x) +
                                     slope_y * (row * (double)SUBPIXEL - a->y));
                size_t first = (size_t)((row - y) * TILE + column - x) * (size_t)samples;
                for (int k = 0; k < samples; ++k) {
                    int outside =
                        (e0 + edges[0].at_sample[k]) | (e1 + edges[1].at_sample[k]) | (e2 + edges[2].at_sample[k]);
                    float z = near + at_sample[k]; // slivers have wild slopes: kept between the corners
                    z = z < nearest ? z : nearest;
                    z = z > farthest ? z : farthest;
                    bool hit = (outside >= 0) & (z > depth[first + k]);
                    depth[first + k] = hit ? z : depth[first + k];
                    seen[first + k] = hit ? face : seen[first + k];
                }
            }
            for (int k = 0; k < 3; ++k)
                value[k] += edges[k].right;
        }
        for (int k = 0; k < 3; ++k)
            edges[k].value += edges[k].down;
    }
}

static void draw_face(const point* points, const int corner[3], int face, int samples, const ax_raster_tile* tile,
                      int* seen, float* depth)
{
    const point *a = &points[corner[0]], *b = &points[corner[1]], *c = &points[corner[2]];
    range inside = {tile->x, tile->y, tile->x + tile->width - 1, tile->y + tile->height - 1};
    range pixels = touched(a, b, c, 1, inside);
    if (samples == 1) // the counts are constants in both copies, so that the loops over samples are unrolled
        draw(a, b, c, face, 1, pixels, tile->x, tile->y, seen, depth);
    else
        draw(a, b, c, face, AX_RASTER_SAMPLES, pixels, tile->x, tile->y, seen, depth);
}

void ax_raster(int width, int height, int samples, int vertex_count, const ax_raster_vertex* vertices, int face_count,
               const int (*faces)[3], void (*resolve)(void* context, const ax_raster_tile* tile), void* context)
{
    assert(width > 0 && width <= 8192 && height > 0 && height <= 8192);
    assert(samples == 1 || samples == AX_RASTER_SAMPLES);
    point* points = snap(vertex_count, vertices);
    int columns = (width + TILE - 1) / TILE, rows = (height + TILE - 1) / TILE;
    range all = {0, 0, columns - 1, rows - 1};

    // Faces of every tile in CSR form, in the order of the faces.
    size_t tiles = (size_t)columns * (size_t)rows;
    size_t* start = AX_NEW0(size_t, tiles + 2);
    for (int f = 0; f < face_count; ++f) {
        range r = touched(&points[faces[f][0]], &points[faces[f][1]], &points[faces[f][2]], TILE, all);
        for (int j = r.y0; j <= r.y1; ++j)
            for (int i = r.x0; i <= r.x1; ++i)
                ++start[j * columns + i + 2];
    }
    for (size_t t = 2; t < tiles + 2; ++t)
        start[t] += start[t - 1];
    int* listed = AX_NEW(int, start[tiles + 1] + 1);
    for (int f = 0; f < face_count; ++f) {
        range r = touched(&points[faces[f][0]], &points[faces[f][1]], &points[faces[f][2]], TILE, all);
        for (int j = r.y0; j <= r.y1; ++j)
            for (int i = r.x0; i <= r.x1; ++i)
                listed[start[j * columns + i + 1]++] = f;
    }

    int cells = TILE * TILE * samples;
    int* seen = AX_NEW(int, cells);
    float* depth = AX_NEW(float, cells);
    for (int j = 0; j < rows; ++j)
        for (int i = 0; i < columns; ++i) {
            ax_raster_tile tile = {.x = i * TILE, .y = j * TILE};
            tile.width = width - tile.x < TILE ? width - tile.x : TILE;
            tile.height = height - tile.y < TILE ? height - tile.y : TILE;
            size_t first = start[j * columns + i], end = start[j * columns + i + 1];
            if (first < end) {
                tile.faces = seen, tile.near = depth;
                for (int k = 0; k < cells; ++k)
                    seen[k] = -1, depth[k] = -INFINITY;
            }
            for (size_t k = first; k < end; ++k)
                draw_face(points, faces[listed[k]], listed[k], samples, &tile, seen, depth);
            resolve(context, &tile);
        }
    ax_free(points);
    ax_free(start);
    ax_free(listed);
    ax_free(seen);
    ax_free(depth);
}
