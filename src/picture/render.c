#include "picture/render.h"

#include "base/vec.h"

#include <string.h>

enum { TONES = 1 << 14, SHADES = 1024 };

// sRGB: the view's ground from its bright spot to the corners, its grid, its shadow; linear light: what is drawn on panels.
static const double bright[3] = {0xfa / 255.0, 0xfb / 255.0, 0xfc / 255.0};
static const double corner[3] = {0xe4 / 255.0, 0xe7 / 255.0, 0xeb / 255.0};
static const double grid_minor[3] = {0xc9 / 255.0, 0xce / 255.0, 0xd6 / 255.0};
static const double grid_major[3] = {0xb3 / 255.0, 0xba / 255.0, 0xc5 / 255.0};
static const double shadow_tint[3] = {0x2b / 255.0, 0x31 / 255.0, 0x40 / 255.0};
static const double ink[3] = {0.0033, 0.0037, 0.0044};
static const double back_gain = 0.55;

// Line a x + b y + c, the distance inside an outline's edge in pixels.
typedef struct line {
    float a, b, c;
} line;

typedef struct work {
    const ax_scene* scene;
    const ax_view* view;
    const ax_light* light;
    const ax_render_setup* setup;
    int width, height, stride;
    uint32_t* pixels;
    ax_raster_vertex* vertices;
    line* lines; // of paint p from first_line[p] on
    int* first_line;
    unsigned char tones[TONES + 1]; // linear light to sRGB bytes
    float shades[SHADES][3];        // the palette in linear light
    double palette_range[2];
    double places[AX_RASTER_SAMPLES][2]; // of the samples within a pixel
} work;

// hypot guards against overflow, at a price per pixel.
static double length2(double x, double y)
{
    return sqrt(x * x + y * y);
}

static void prepare_outlines(work* w)
{
    const ax_scene* scene = w->scene;
    w->first_line = AX_NEW(int, scene->paint_count + 1);
    int count = 0;
    for (int p = 0; p < scene->paint_count; ++p) {
        w->first_line[p] = count;
        count += scene->paints[p].outline_count;
    }
    w->lines = AX_NEW(line, count + 1);
    for (int p = 0; p < scene->paint_count; ++p) {
        const ax_paint* paint = &scene->paints[p];
        const ax_raster_vertex* corners = w->vertices + paint->outline_first;
        double area = 0;
        for (int k = 0; k < paint->outline_count; ++k) {
            const ax_raster_vertex *a = &corners[k], *b = &corners[(k + 1) % paint->outline_count];
            area += (a->x - corners->x) * (b->y - corners->y) - (a->y - corners->y) * (b->x - corners->x);
        }
        double turn = area < 0 ? -1 : 1; // seen from its back
        for (int k = 0; k < paint->outline_count; ++k) {
            const ax_raster_vertex *a = &corners[k], *b = &corners[(k + 1) % paint->outline_count];
            double dx = b->x - a->x, dy = b->y - a->y, length = length2(dx, dy) * turn;
            line* edge = &w->lines[w->first_line[p] + k];
            *edge = (line){0, 0, INFINITY}; // two points in one place: no edge
            if (fabs(length) > 1e-6)
                *edge = (line){(float)(-dy / length), (float)(dx / length), (float)((dy * a->x - dx * a->y) / length)};
        }
    }
}

static void prepare_tones(work* w)
{
    for (int k = 0; k <= TONES; ++k)
        w->tones[k] = (unsigned char)lrint(255 * ax_colour_from_linear(k / (double)TONES));
    if (!w->scene->values)
        return;
    ax_palette_range(&w->scene->palette, w->palette_range);
    for (int k = 0; k < SHADES; ++k) {
        double span = w->palette_range[1] - w->palette_range[0], rgb[3];
        ax_palette_colour(&w->scene->palette, w->palette_range[0] + span * (k + 0.5) / SHADES, rgb);
        for (int c = 0; c < 3; ++c)
            w->shades[k][c] = (float)ax_colour_to_linear(rgb[c]);
    }
}

// Share of a pixel that a line of a width at a distance from its middle covers.
static double covered(double distance, double width)
{
    return ax_clamp(width / 2 + 0.5 - distance, 0, 1) * fmin(width, 1);
}

// Lines of the grid in one direction. `at`: position over the grid's distance, `step`: its change from pixel to pixel.
static double grid_line(double at, double step, double width)
{
    double distance = fabs(at - nearbyint(at)) / step;
    return covered(distance, width) * ax_clamp(0.5 / step / 8, 0, 1); // far away lines would merge: they fade
}

// sRGB of the ground seen at a pixel.
static void backdrop(const work* w, double x, double y, double rgb[3])
{
    double reach = 0.62 * length2(w->width, w->height);
    double t = fmin(1, length2(x - 0.5 * w->width, y - 0.38 * w->height) / reach);
    for (int c = 0; c < 3; ++c)
        rgb[c] = bright[c] + (corner[c] - bright[c]) * t * t * (3 - 2 * t);
    double origin[3], ray[3], place[3][2]; // on the ground, at this pixel and its neighbours to the right and below
    for (int k = 0; k < 3; ++k) {
        ax_view_ray(w->view, x + (k == 1), y + (k == 2), origin, ray);
        if (ray[2] > -1e-3)
            return;
        double far = (w->light->ground - origin[2]) / ray[2];
        for (int c = 0; c < 2; ++c)
            place[k][c] = origin[c] + far * ray[c];
    }
    const ax_render_setup* setup = w->setup;
    double radius = length2(place[0][0], place[0][1]);
    double fade = setup->grid > 0 ? ax_clamp((setup->grid_fade - radius) / (0.6 * setup->grid_fade), 0, 1) : 0;
    for (int major = 0; major < 2 && fade > 0; ++major) {
        double distance = setup->grid * (major ? 5 : 1), cover = 0;
        for (int c = 0; c < 2; ++c) {
            double step = length2(place[1][c] - place[0][c], place[2][c] - place[0][c]);
            cover = fmax(cover, grid_line(place[0][c] / distance, fmax(step / distance, 1e-9), setup->pixel));
        }
        cover *= (major ? 0.6 : 0.5) * fade;
        for (int c = 0; c < 3; ++c)
            rgb[c] += ((major ? grid_major : grid_minor)[c] - rgb[c]) * cover;
    }
    double shadow = setup->shadow * ax_light_ground_shadow(w->light, place[0][0], place[0][1]);
    for (int c = 0; c < 3; ++c)
        rgb[c] += (shadow_tint[c] - rgb[c]) * shadow;
}

static double hatch(const work* w, double x, double y)
{
    double period = 6 * w->setup->pixel, at = (x + y) / sqrt(2) / period;
    return 0.85 * covered(fabs(at - nearbyint(at)) * period, 1.4 * w->setup->pixel);
}

static void look_up(const work* w, double value, double rgb[3])
{
    double span = w->palette_range[1] - w->palette_range[0];
    double place = (value - w->palette_range[0]) / span * SHADES;
    const float* found = w->shades[place > 0 ? (int)fmin(place, SHADES - 1) : 0];
    for (int c = 0; c < 3; ++c)
        rgb[c] = found[c];
}

// Blends the colours on both sides of 0, where the palette has its step, over the pixel that the line passes through. Returns the
// share of the pixel that is not positive.
static double soften_step(const work* w, const int corners[3], double value, double rgb[3])
{
    const ax_raster_vertex *a = &w->vertices[corners[0]], *b = &w->vertices[corners[1]], *c = &w->vertices[corners[2]];
    double bx = b->x - a->x, by = b->y - a->y, cx = c->x - a->x, cy = c->y - a->y, area = bx * cy - by * cx;
    double rise_b = (double)w->scene->values[corners[1]] - w->scene->values[corners[0]];
    double rise_c = (double)w->scene->values[corners[2]] - w->scene->values[corners[0]];
    double slope = length2(rise_b * cy - rise_c * by, rise_c * bx - rise_b * cx) / fmax(fabs(area), 1e-12);
    double positive = slope > 0 ? ax_clamp(0.5 + value / slope, 0, 1) : value > 0;
    if (positive > 0 && positive < 1) {
        double least = w->palette_range[1] / SHADES, above[3], below[3];
        look_up(w, fmax(value, least), above);
        look_up(w, fmin(value, -least), below);
        for (int k = 0; k < 3; ++k)
            rgb[k] = below[k] + (above[k] - below[k]) * positive;
    }
    return 1 - positive;
}

// Linear light that a face sends from the point of it seen at x, y in the picture.
static void shade(const work* w, int face, double x, double y, double rgb[3])
{
    const ax_scene* scene = w->scene;
    const int* corners = scene->faces[face];
    const ax_raster_vertex* v[3];
    for (int k = 0; k < 3; ++k)
        v[k] = &w->vertices[corners[k]];
    double weight[3], sum = 0;
    for (int k = 0; k < 3; ++k) {
        const ax_raster_vertex *a = v[(k + 1) % 3], *b = v[(k + 2) % 3];
        weight[k] = (a->x - x) * (b->y - y) - (a->y - y) * (b->x - x);
        sum += weight[k];
    }
    double total = 0;
    for (int k = 0; k < 3; ++k) {
        double share = fabs(sum) > 1e-12 ? ax_clamp(weight[k] / sum, 0, 1) : 1 / 3.0;
        weight[k] = share * (w->view->perspective ? v[k]->near : 1); // affine in space, not in the picture
        total += weight[k];
    }
    double place[3] = {0}, normal[3] = {0}, value = 0, base[3], edges[2][3];
    for (int k = 0; k < 3; ++k) {
        weight[k] /= total;
        for (int c = 0; c < 3; ++c)
            place[c] += weight[k] * scene->places[corners[k]][c];
    }
    for (int k = 0; k < 2; ++k)
        for (int c = 0; c < 3; ++c)
            edges[k][c] = (double)scene->places[corners[k + 1]][c] - scene->places[corners[0]][c];
    double facing[3];
    ax_cross(edges[0], edges[1], facing);
    double to_eye[3] = {-w->view->forward[0], -w->view->forward[1], -w->view->forward[2]};
    if (w->view->perspective)
        ax_sub3(w->view->eye, place, to_eye);
    bool back = ax_dot3(facing, to_eye) < 0;

    const ax_paint* paint = NULL;
    double hatched; // share
    if (scene->values) {
        for (int k = 0; k < 3; ++k) {
            value += weight[k] * scene->values[corners[k]];
            for (int c = 0; c < 3; ++c)
                normal[c] += weight[k] * scene->normals[corners[k]][c];
        }
        look_up(w, value, base);
        hatched = ax_palette_hatched(&scene->palette, value);
        if (scene->palette.kind == AX_PALETTE_CURVATURE)
            hatched = soften_step(w, corners, value, base);
    } else {
        memcpy(normal, facing, sizeof normal);
        paint = &scene->paints[scene->face_paint[face]];
        for (int c = 0; c < 3; ++c)
            base[c] = paint->rgb[c];
        hatched = paint->hatched;
    }
    double length = fmax(ax_norm3(normal), 1e-30) * (back ? -1 : 1), gain = back && scene->two_sided ? back_gain : 1;
    for (int c = 0; c < 3; ++c)
        normal[c] /= length;
    double light[3];
    ax_light_on(w->light, place, normal, light);
    double dark = hatched > 0 ? hatched * hatch(w, x, y) : 0;
    if (paint && paint->outline_count) {
        const line* edge = w->lines + w->first_line[paint - scene->paints];
        double distance = INFINITY;
        for (int k = 0; k < paint->outline_count; ++k)
            distance = fmin(distance, edge[k].a * x + edge[k].b * y + edge[k].c);
        double outline = w->setup->outlines * covered(fmax(distance, 0), 2 * w->setup->pixel);
        dark = 1 - (1 - dark) * (1 - outline);
    }
    for (int c = 0; c < 3; ++c)
        rgb[c] = gain * base[c] * light[c] * (1 - dark) + ink[c] * dark;
}

static void resolve(void* context, const ax_raster_tile* tile)
{
    work* w = context;
    for (int j = 0; j < tile->height; ++j)
        for (int i = 0; i < tile->width; ++i) {
            double sum[3] = {0}, x = tile->x + i, y = tile->y + j;
            const int* seen = tile->faces ? tile->faces + (j * AX_RASTER_TILE + i) * AX_RASTER_SAMPLES : NULL;
            bool counted[AX_RASTER_SAMPLES] = {false};
            int hits = 0;
            for (int k = 0; seen && k < AX_RASTER_SAMPLES; ++k) {
                if (counted[k] || seen[k] < 0)
                    continue;
                // Each face once, at the middle of its samples, which lies inside it.
                double at[2] = {0, 0}, rgb[3];
                int count = 0;
                for (int m = k; m < AX_RASTER_SAMPLES; ++m)
                    if (seen[m] == seen[k]) {
                        counted[m] = true, ++count;
                        at[0] += w->places[m][0], at[1] += w->places[m][1];
                    }
                shade(w, seen[k], x + at[0] / count, y + at[1] / count, rgb);
                for (int c = 0; c < 3; ++c)
                    sum[c] += count * fmin(rgb[c], 1);
                hits += count;
            }
            double behind[3] = {0};
            if (hits < AX_RASTER_SAMPLES)
                backdrop(w, x + 0.5, y + 0.5, behind);
            uint32_t pixel = 0;
            for (int c = 0; c < 3; ++c) {
                uint32_t byte = (uint32_t)lrint(255 * behind[c]);
                if (hits) {
                    double rest = hits < AX_RASTER_SAMPLES ? ax_colour_to_linear(behind[c]) : 0;
                    double linear = (sum[c] + (AX_RASTER_SAMPLES - hits) * rest) / AX_RASTER_SAMPLES;
                    byte = w->tones[(int)(linear * TONES + 0.5)];
                }
                pixel = pixel << 8 | byte;
            }
            w->pixels[(size_t)(tile->y + j) * (size_t)w->stride + (size_t)(tile->x + i)] = pixel;
        }
}

void ax_render(const ax_scene* scene, const ax_view* view, const ax_light* light, const ax_render_setup* setup,
               int width, int height, uint32_t* pixels, int stride)
{
    work* w = AX_NEW0(work, 1);
    *w = (work){.scene = scene,
                .view = view,
                .light = light,
                .setup = setup,
                .width = width,
                .height = height,
                .stride = stride,
                .pixels = pixels};
    for (int k = 0; k < AX_RASTER_SAMPLES; ++k)
        ax_raster_sample(AX_RASTER_SAMPLES, k, w->places[k]);
    w->vertices = AX_NEW(ax_raster_vertex, scene->vertex_count);
    for (int v = 0; v < scene->vertex_count; ++v)
        w->vertices[v] = ax_view_project(view, scene->places[v]);
    prepare_tones(w);
    prepare_outlines(w);
    ax_raster(width, height, AX_RASTER_SAMPLES, scene->vertex_count, w->vertices, scene->face_count,
              (const int(*)[3])scene->faces, resolve, w);
    ax_free(w->vertices);
    ax_free(w->lines);
    ax_free(w->first_line);
    ax_free(w);
}
