#include "picture/light.h"

#include "base/vec.h"

#include <string.h>

enum { SUN_SIZE = 2048, MOST_BANDS = 9 };

// Linear light. Sky from above, the ground's reflection from below, a warm key, a cool fill.
static const double sky[3] = {1, 1, 1}, reflected[3] = {0.62, 0.645, 0.694}, key_colour[3] = {1, 0.922, 0.823},
                    fill_colour[3] = {0.738, 0.815, 1};
static const double sky_power = 1.55, key_power = 2.35, fill_power = 0.7;
static const double self_shadow = 0.7;

static void normalise(const double from[3], double to[3])
{
    double length = ax_norm3(from);
    for (int c = 0; c < 3; ++c)
        to[c] = from[c] / length;
}

static void keep_depth(void* context, const ax_raster_tile* tile)
{
    ax_light* light = context;
    for (int j = 0; j < tile->height; ++j)
        for (int i = 0; i < tile->width; ++i)
            light->sun_near[(tile->y + j) * light->sun_size + tile->x + i] =
                tile->near ? tile->near[j * AX_RASTER_TILE + i] : -INFINITY;
}

static ax_raster_vertex* project(const ax_scene* scene, const ax_view* view)
{
    ax_raster_vertex* vertices = AX_NEW(ax_raster_vertex, scene->vertex_count);
    for (int v = 0; v < scene->vertex_count; ++v)
        vertices[v] = ax_view_project(view, scene->places[v]);
    return vertices;
}

static void look_from_sun(ax_light* light, const ax_scene* scene)
{
    const double along[3] = {-light->key[0], -light->key[1], -light->key[2]};
    light->sun = ax_view_along(along);
    light->sun_size = SUN_SIZE;
    light->sun_near = AX_NEW(float, SUN_SIZE* SUN_SIZE);
    ax_rectangle all = {8, 8, SUN_SIZE - 16, SUN_SIZE - 16};
    ax_view_frame(&light->sun, scene->vertex_count, (const float(*)[3])scene->places, all, 0, NULL);
    ax_raster_vertex* vertices = project(scene, &light->sun);
    ax_raster(SUN_SIZE, SUN_SIZE, 1, scene->vertex_count, vertices, scene->face_count, (const int(*)[3])scene->faces,
              keep_depth, light);
    ax_free(vertices);
}

// The scene laid along the light onto the ground, split by height into bands, each of which is blurred by its height: crisp where
// the shell touches, soft under its crown.
typedef struct casting {
    int columns, rows, bands;
    float* band[MOST_BANDS];
    float lowest, step; // height of band 0, distance of bands
} casting;

static void collect(void* context, const ax_raster_tile* tile)
{
    const casting* cast = context;
    if (!tile->faces)
        return;
    for (int j = 0; j < tile->height; ++j)
        for (int i = 0; i < tile->width; ++i)
            for (int k = 0; k < AX_RASTER_SAMPLES; ++k) {
                int at = (j * AX_RASTER_TILE + i) * AX_RASTER_SAMPLES + k;
                if (tile->faces[at] < 0)
                    continue;
                float height = (-tile->near[at] - cast->lowest) / cast->step; // the lowest part seen from below
                int band = height > 0 ? (int)height : 0;
                band = band < cast->bands - 2 ? band : cast->bands - 2;
                band = band > 0 ? band : 0;
                float upper = cast->bands > 1 ? (float)ax_clamp(height - band, 0, 1) : 0;
                size_t cell = (size_t)(tile->y + j) * (size_t)cast->columns + (size_t)(tile->x + i);
                cast->band[band][cell] += (1 - upper) / AX_RASTER_SAMPLES;
                if (upper > 0)
                    cast->band[band + 1][cell] += upper / AX_RASTER_SAMPLES;
            }
}

// Running mean of 2 radius + 1 values, nothing beyond the ends.
static void box_blur(const float* from, float* to, int count, int stride, int radius)
{
    double sum = 0, weight = 1.0 / (2 * radius + 1);
    for (int i = 0; i < radius && i < count; ++i)
        sum += from[(size_t)i * (size_t)stride];
    for (int i = 0; i < count; ++i) {
        if (i + radius < count)
            sum += from[(size_t)(i + radius) * (size_t)stride];
        if (i - radius > 0)
            sum -= from[(size_t)(i - radius - 1) * (size_t)stride];
        to[(size_t)i * (size_t)stride] = (float)(sum * weight);
    }
}

// Nearly Gaussian: three boxes of together the variance sigma^2, in cells.
static void blur(float* cells, float* spare, int columns, int rows, double sigma)
{
    int radius = (int)lrint((sqrt(4 * sigma * sigma + 1) - 1) / 2);
    for (int pass = 0; radius > 0 && pass < 3; ++pass) {
        for (int j = 0; j < rows; ++j)
            box_blur(cells + (size_t)j * (size_t)columns, spare + (size_t)j * (size_t)columns, columns, 1, radius);
        for (int i = 0; i < columns; ++i)
            box_blur(spare + i, cells + i, rows, columns, radius);
    }
}

static void cast_shadow(ax_light* light, const ax_scene* scene, const ax_light_setup* setup)
{
    // Sheared along the light, so that the shadow of a vertex stands at its x, y and its nearness is minus its height.
    double lo[2] = {INFINITY, INFINITY}, hi[2] = {-INFINITY, -INFINITY}, low = INFINITY, high = -INFINITY;
    ax_raster_vertex* vertices = AX_NEW(ax_raster_vertex, scene->vertex_count);
    for (int v = 0; v < scene->vertex_count; ++v) {
        double height = scene->places[v][2] - setup->ground, at[2];
        for (int c = 0; c < 2; ++c) {
            at[c] = scene->places[v][c] - height * light->key[c] / light->key[2];
            lo[c] = fmin(lo[c], at[c]), hi[c] = fmax(hi[c], at[c]);
        }
        low = fmin(low, height), high = fmax(high, height);
        vertices[v] = (ax_raster_vertex){at[0], at[1], (float)-height};
    }
    double margin = 3 * (setup->contact_blur + setup->height_blur * high);
    double extent = fmax(hi[0] - lo[0], hi[1] - lo[1]) + 2 * margin;
    light->shadow_cell = extent / setup->shadow_size;
    for (int c = 0; c < 2; ++c)
        light->shadow_origin[c] = lo[c] - margin;
    casting cast = {.lowest = (float)low, .step = (float)fmax((high - low) / (MOST_BANDS - 1), 1e-6)};
    cast.bands = setup->height_blur > 0 ? MOST_BANDS : 1;
    cast.columns = (int)ceil((hi[0] - lo[0] + 2 * margin) / light->shadow_cell);
    cast.rows = (int)ceil((hi[1] - lo[1] + 2 * margin) / light->shadow_cell);
    for (int v = 0; v < scene->vertex_count; ++v) {
        vertices[v].x = (vertices[v].x - light->shadow_origin[0]) / light->shadow_cell;
        vertices[v].y = (vertices[v].y - light->shadow_origin[1]) / light->shadow_cell;
    }
    size_t cells = (size_t)cast.columns * (size_t)cast.rows;
    for (int b = 0; b < cast.bands; ++b)
        cast.band[b] = AX_NEW0(float, cells);
    ax_raster(cast.columns, cast.rows, AX_RASTER_SAMPLES, scene->vertex_count, vertices, scene->face_count,
              (const int(*)[3])scene->faces, collect, &cast);
    ax_free(vertices);

    light->shadow_columns = cast.columns, light->shadow_rows = cast.rows;
    light->shadow = AX_NEW0(float, cells);
    float* spare = AX_NEW(float, cells);
    for (int b = 0; b < cast.bands; ++b) {
        double height = cast.lowest + b * cast.step;
        blur(cast.band[b], spare, cast.columns, cast.rows,
             (setup->contact_blur + setup->height_blur * height) / light->shadow_cell);
        for (size_t i = 0; i < cells; ++i)
            light->shadow[i] += cast.band[b][i];
        ax_free(cast.band[b]);
    }
    ax_free(spare);
}

static void light_in_the_open(const ax_light* light, const double normal[3], double visible, double rgb[3])
{
    double up = 0.5 + 0.5 * normal[2], key = fmax(0, ax_dot3(normal, light->key)) * visible;
    double fill = fmax(0, ax_dot3(normal, light->fill));
    for (int c = 0; c < 3; ++c)
        rgb[c] = sky_power * (reflected[c] + (sky[c] - reflected[c]) * up) + key_power * key * key_colour[c] +
                 fill_power * fill * fill_colour[c];
}

ax_light ax_light_make(const ax_scene* scene, const ax_light_setup* setup)
{
    ax_light light = {.ground = setup->ground, .bias = 0.3 * setup->thickness};
    normalise(setup->key, light.key);
    normalise(setup->fill, light.fill);
    light_in_the_open(&light, (const double[3]){0, 0, 1}, 1, light.white);
    if (setup->self_shadow)
        look_from_sun(&light, scene);
    cast_shadow(&light, scene, setup);
    return light;
}

void ax_light_free(ax_light* light)
{
    ax_free(light->sun_near);
    ax_free(light->shadow);
    *light = (ax_light){0};
}

// Share of the key light that reaches a place: a disc of taps in what the light sees.
static double visible_share(const ax_light* light, const double place[3], const double normal[3])
{
    enum { TAPS = 12 };
    static const double radius = 3; // texels
    // Vogel's spiral, by golden angles: even over the disc.
    static const double spiral[TAPS][2] = {{0.2041, 0.0000},   {-0.2607, 0.2388}, {0.0399, -0.4547}, {0.3286, 0.4286},
                                           {-0.6030, -0.1067}, {0.5712, -0.3634}, {-0.1911, 0.7107}, {-0.3644, -0.7016},
                                           {0.7906, 0.2887},   {-0.8224, 0.3395}, {0.3965, -0.8472}, {0.2930, 0.9341}};
    float at[3];
    for (int c = 0; c < 3; ++c)
        at[c] = (float)(place[c] + light->bias * normal[c]);
    ax_raster_vertex seen = ax_view_project(&light->sun, at);
    float near = seen.near + (float)(light->bias * 0.5);
    int open = 0;
    for (int k = 0; k < TAPS; ++k) {
        int x = (int)(seen.x + radius * spiral[k][0]), y = (int)(seen.y + radius * spiral[k][1]);
        x = x < 0 ? 0 : (x < light->sun_size ? x : light->sun_size - 1);
        y = y < 0 ? 0 : (y < light->sun_size ? y : light->sun_size - 1);
        open += near >= light->sun_near[y * light->sun_size + x];
    }
    return open / (double)TAPS;
}

void ax_light_on(const ax_light* light, const double place[3], const double normal[3], double rgb[3])
{
    double visible = 1;
    if (light->sun_near && ax_dot3(normal, light->key) > 0)
        visible = 1 - self_shadow * (1 - visible_share(light, place, normal));
    light_in_the_open(light, normal, visible, rgb);
    for (int c = 0; c < 3; ++c)
        rgb[c] /= light->white[c];
}

double ax_light_ground_shadow(const ax_light* light, double x, double y)
{
    double u = (x - light->shadow_origin[0]) / light->shadow_cell - 0.5;
    double v = (y - light->shadow_origin[1]) / light->shadow_cell - 0.5;
    if (!(u >= 0 && v >= 0 && u < light->shadow_columns - 1 && v < light->shadow_rows - 1))
        return 0;
    int i = (int)u, j = (int)v;
    double s = u - i, t = v - j;
    const float* cell = light->shadow + (size_t)j * (size_t)light->shadow_columns + i;
    double upper = cell[0] * (1 - s) + cell[1] * s;
    double lower = cell[light->shadow_columns] * (1 - s) + cell[light->shadow_columns + 1] * s;
    return fmin(1, upper * (1 - t) + lower * t);
}
