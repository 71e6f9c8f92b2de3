#include "ax/picture.h"

#include "base/file.h"
#include "mesh/geometry.h"
#include "picture/legend.h"
#include "picture/panels.h"
#include "picture/render.h"

#include <assert.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static const double degree = AX_PI / 180;
enum { SMALLEST = 64, LARGEST = 8192 };

typedef struct sheet {
    int width, height;
    double unit;        // pixels of a unit of text and lines
    bool legend, title; // enough room for them
} sheet;

static ax_status make_sheet(int width, int height, sheet* out, ax_error* error)
{
    if (width < SMALLEST || width > LARGEST || height < SMALLEST || height > LARGEST)
        return ax_fail(error, AX_USAGE, "A picture must be %d to %d pixels wide and high, not %d x %d.", SMALLEST,
                       LARGEST, width, height);
    *out = (sheet){
        .width = width,
        .height = height,
        .unit = fmax(0.9, fmin(width / 1280.0, height / 800.0)),
        .legend = width >= 480 && height >= 320,
        .title = width >= 320 && height >= 200,
    };
    return AX_OK;
}

static cairo_status_t write_stream(void* stream, const unsigned char* bytes, unsigned count)
{
    return fwrite(bytes, 1, count, stream) == count ? CAIRO_STATUS_SUCCESS : CAIRO_STATUS_WRITE_ERROR;
}

static ax_status save(cairo_surface_t* surface, const char* path, ax_error* error)
{
    ax_file file;
    ax_status status = ax_file_begin(&file, path, error);
    if (status != AX_OK)
        return status;
    cairo_status_t written = cairo_surface_write_to_png_stream(surface, write_stream, file.stream);
    if (written == CAIRO_STATUS_SUCCESS || written == CAIRO_STATUS_WRITE_ERROR)
        return ax_file_commit(&file, error); // which names what the disk said
    ax_file_abandon(&file);
    return ax_fail(error, AX_FAILED, "Cannot write %s: %s.", path, cairo_status_to_string(written));
}

// The space left for the model by the title and the margins: 88 % of the width, 86 % in the flat view.
static ax_rectangle free_space(const sheet* s, double share)
{
    double side = (1 - share) / 2 * s->width, top = s->title ? 48 * s->unit : 0.06 * s->height;
    double bottom = 0.05 * s->height;
    return (ax_rectangle){side, top, s->width - 2 * side, s->height - top - bottom};
}

// How a model is looked at: a shell seen from above and from the front, with its outer side towards the eye.
typedef struct stance {
    double azimuth; // of the eye
    int front;      // side of the faces that faces the eye, as in ax_panels_look
} stance;

// `normal`: sum of the faces' area normals, any length.
static stance take_stance(const double normal[3])
{
    stance s = {.azimuth = -62 * degree, .front = 1};
    double length = ax_norm3(normal);
    if (length > 0 && fabs(normal[2]) < 0.5 * length) // a shell that stands upright is seen from its outer side
        s.azimuth = atan2(normal[1], normal[0]) + 28 * degree;
    else if (normal[2] < 0) // one that hangs down is looked into
        s.front = -1;
    return s;
}

// Light from over the left shoulder of the eye.
static void turn(const double from[3], double angle, double to[3])
{
    double c = cos(angle), s = sin(angle);
    to[0] = c * from[0] - s * from[1], to[1] = s * from[0] + c * from[1], to[2] = from[2];
}

static ax_light_setup light_setup(const stance* s, double ground, double thickness)
{
    static const double key[3] = {-0.80, -0.22, 1.15}, fill[3] = {1, -1, 0.6};
    ax_light_setup setup = {.ground = ground,
                            .thickness = thickness,
                            .contact_blur = 0.003,
                            .height_blur = 0.13,
                            .shadow_size = 768,
                            .self_shadow = true};
    turn(key, s->azimuth + 62 * degree, setup.key);
    turn(fill, s->azimuth + 62 * degree, setup.fill);
    return setup;
}

// A picture in the making: pixels that ax_render fills and cairo then writes on.
static cairo_surface_t* render(const sheet* s, const ax_scene* scene, const ax_view* view, const ax_light* light,
                               const ax_render_setup* setup)
{
    cairo_surface_t* surface = cairo_image_surface_create(CAIRO_FORMAT_RGB24, s->width, s->height);
    if (cairo_surface_status(surface) != CAIRO_STATUS_SUCCESS)
        return surface;
    cairo_surface_flush(surface);
    ax_render(scene, view, light, setup, s->width, s->height, (uint32_t*)(void*)cairo_image_surface_get_data(surface),
              cairo_image_surface_get_stride(surface) / 4);
    cairo_surface_mark_dirty(surface);
    return surface;
}

static void write_lengths(char* text, size_t size, const double* lengths, int count, const char* unit)
{
    double largest = 0;
    for (int k = 0; k < count; ++k)
        largest = fmax(largest, lengths[k]);
    size_t used = 0;
    for (int k = 0; k < count; ++k) {
        char number[32];
        ax_write_number(number, sizeof number, lengths[k], ax_decimals_for(largest));
        int more = snprintf(text + used, size - used, "%s%s", k ? " \u00d7 " : "", number);
        used = used + (size_t)more < size ? used + (size_t)more : size - 1;
    }
    snprintf(text + used, size - used, "%s%s", *unit ? " " : "", unit);
}

static void extents(int count, const double (*places)[3], double size[3])
{
    for (int c = 0; c < 3; ++c) {
        double lo = INFINITY, hi = -INFINITY;
        for (int i = 0; i < count; ++i)
            lo = fmin(lo, places[i][c]), hi = fmax(hi, places[i][c]);
        size[c] = hi - lo;
    }
}

static int compare_doubles(const void* a, const void* b)
{
    double x = *(const double*)a, y = *(const double*)b;
    return (x > y) - (x < y);
}

// Symmetric range for signed values: rounded up from the 99th percentile of their magnitudes.
static double signed_limit(const double* values, int count)
{
    double* sizes = AX_NEW(double, count);
    int kept = 0;
    for (int i = 0; i < count; ++i)
        if (isfinite(values[i]))
            sizes[kept++] = fabs(values[i]);
    qsort(sizes, (size_t)kept, sizeof *sizes, compare_doubles);
    double high = kept ? sizes[(int)(0.99 * (kept - 1))] : 0;
    ax_free(sizes);
    return ax_palette_limit(high > 1e-300 ? high : 1);
}

static ax_legend design_legend(const ax_design* design, const ax_palette* palette)
{
    bool forces = palette->kind == AX_PALETTE_FORCE;
    ax_legend legend = ax_legend_make(forces ? "Axial force, N" : "Scale factor \u03bb", palette);
    if (forces)
        legend.words[0] = "Compression", legend.words[1] = "Tension";
    for (int t = 0; t < design->linkage.triangle_count; ++t)
        for (int k = 0; k < (forces ? 3 : 1); ++k)
            ax_legend_count(&legend, forces ? design->edge_forces[t][k] : design->scale[t], 1);
    return legend;
}

static double mean_edge(const ax_linkage* linkage, const double (*places)[3])
{
    double sum = 0;
    for (int t = 0; t < linkage->triangle_count; ++t)
        for (int k = 0; k < 3; ++k)
            sum += ax_distance3(places[linkage->triangles[t][k]], places[linkage->triangles[t][(k + 1) % 3]]);
    return sum / (3 * linkage->triangle_count);
}

static void sum_of_normals(int count, const int (*faces)[3], const double (*places)[3], double sum[3])
{
    sum[0] = sum[1] = sum[2] = 0;
    for (int f = 0; f < count; ++f) {
        double a[3], b[3], normal[3];
        ax_sub3(places[faces[f][1]], places[faces[f][0]], a);
        ax_sub3(places[faces[f][2]], places[faces[f][0]], b);
        ax_cross(a, b, normal);
        for (int c = 0; c < 3; ++c)
            sum[c] += normal[c];
    }
}

// A third of every face counts for each of its corners.
static void count_by_area(const ax_mesh* mesh, const double* values, ax_legend* legend)
{
    for (int f = 0; f < mesh->face_count; ++f)
        for (int k = 0; k < 3; ++k)
            ax_legend_count(legend, values[mesh->faces[f][k]], ax_face_area(mesh, f));
}

// Pixels of a length of 1 at the middle of the scene.
static double pixels_at_middle(const ax_view* view)
{
    return view->scale * (view->perspective ? 1 / ax_norm3(view->eye) : 1);
}

static double fading(double low, double high, double x)
{
    return ax_clamp((x - low) / (high - low), 0, 1);
}

// Everything about a picture but its scene.
typedef struct composition {
    sheet sheet;
    stance stance;
    ax_view view;
    ax_legend legend;
    ax_light_setup light;
    ax_render_setup render;
    ax_scale_bar bar; // flat view only, else of length 0
    double grid;      // distance of the ground's lines, in the document's unit
    char title[64], text[128];
    const char* unit_name; // "" if unknown
} composition;

// Fits the points of a scene into the sheet, clear of the legend and of what stands at the bottom right.
static void compose(composition* c, bool flat, int count, const float (*points)[3], const ax_scene_frame* frame)
{
    const sheet* s = &c->sheet;
    c->view = flat ? ax_view_along((const double[3]){0, 0, -1})
                   : ax_view_from(c->stance.azimuth, 36 * degree, 0.5 / sin(15 * degree));
    ax_rectangle space = free_space(s, flat ? 0.86 : 0.88), obstacles[2];
    ax_rectangle card = ax_legend_card(&c->legend, s->height, s->unit);
    double gap = 16 * s->unit;
    obstacles[0] = (ax_rectangle){0, card.y - gap, card.x + card.width + gap, s->height - card.y + gap};
    obstacles[1] = (ax_rectangle){s->width - 160 * s->unit, s->height - 56 * s->unit, 160 * s->unit, 56 * s->unit};
    ax_view_frame(&c->view, count, points, space, s->legend ? 2 : 0, obstacles);
    c->render.pixel = fmax(1, s->unit);
    c->grid = ax_round_length(0.12 * frame->size); // some ten cells over the model
    c->render.grid = c->grid / frame->size;
    c->render.grid_fade = 1.1;
    if (flat)
        c->bar = ax_scale_bar_make(c->view.scale / frame->size, 120 * s->unit);
}

static ax_status paint(const composition* c, const ax_scene* scene, const char* path, ax_error* error)
{
    const sheet* s = &c->sheet;
    ax_light light = ax_light_make(scene, &c->light);
    cairo_surface_t* surface = render(s, scene, &c->view, &light, &c->render);
    ax_light_free(&light);
    cairo_t* cr = cairo_create(surface);
    if (s->legend)
        ax_legend_draw(cr, &c->legend, s->height, s->unit);
    if (s->title)
        ax_title_draw(cr, c->title, c->text, s->unit);
    if (s->legend && c->bar.length > 0)
        ax_scale_bar_draw(cr, &c->bar, c->unit_name, s->width, s->height, s->unit);
    else if (s->legend)
        ax_grid_note_draw(cr, c->grid, c->unit_name, s->width, s->height, s->unit);
    cairo_status_t drawn = cairo_status(cr);
    cairo_destroy(cr);
    ax_status status = drawn == CAIRO_STATUS_SUCCESS
                           ? save(surface, path, error)
                           : ax_fail(error, AX_FAILED, "Cannot draw a picture of %d x %d pixels: %s.", s->width,
                                     s->height, cairo_status_to_string(drawn));
    cairo_surface_destroy(surface);
    return status;
}

static void describe(const ax_design* design, ax_state state, int hinge_count, const double (*places)[3],
                     composition* c)
{
    static const char* const names[] = {"Deployed", "Flat", "Deployed", "Simulated"};
    snprintf(c->title, sizeof c->title, "%s", names[state]);
    c->unit_name = ax_unit_name(design->unit);
    char number[32], text[96];
    if (state == AX_STATE_SIMULATED) {
        bool inflation = design->load.kind == AX_LOAD_INFLATION;
        double amount = inflation ? design->load.pressure : design->load.density;
        ax_write_number(number, sizeof number, amount, amount < 10 ? 1 : 0);
        snprintf(text, sizeof text, "%s %s %s", inflation ? "inflation" : "gravity", number,
                 inflation ? "Pa" : "kg/m\u00b2");
    } else {
        double size[3];
        extents(hinge_count, places, size);
        write_lengths(text, sizeof text, size, state == AX_STATE_FLAT ? 2 : 3, c->unit_name);
    }
    snprintf(c->text, sizeof c->text, "%d panels, %s", design->linkage.triangle_count, text);
}

// A state in a frame that holds all of `around`, the last `hinge_count` of which say from where it is seen.
static ax_status draw_state(composition* c, const ax_design* design, ax_state state, const double (*at)[3],
                            int around_count, const double (*around)[3], const char* path, ax_error* error)
{
    bool flat = state == AX_STATE_FLAT;
    const ax_linkage* linkage = &design->linkage;
    int hinges = linkage->hinge_count;
    ax_scene scene = {0};
    if (!ax_scene_find_frame(around_count, around, &scene.frame))
        return ax_fail(error, AX_BAD_INPUT, "A hinge of the design has no finite place. Make the design again.");
    double(*places)[3] = ax_alloc((size_t)hinges, sizeof *places);
    float(*points)[3] = ax_alloc((size_t)around_count, sizeof *points);
    double lowest = INFINITY;
    for (int k = 0; k < 3; ++k) {
        for (int h = 0; h < hinges; ++h)
            places[h][k] = (at[h][k] - scene.frame.centre[k]) / scene.frame.size;
        for (int h = 0; h < around_count; ++h) {
            points[h][k] = (float)((around[h][k] - scene.frame.centre[k]) / scene.frame.size);
            lowest = k == 2 ? fmin(lowest, points[h][2]) : lowest;
        }
    }
    double normal[3], edge = mean_edge(linkage, (const double(*)[3])places);
    sum_of_normals(linkage->triangle_count, (const int(*)[3])linkage->triangles, around + around_count - hinges,
                   normal);
    c->stance = take_stance(normal);

    bool forces = state == AX_STATE_SIMULATED && design->edge_forces;
    ax_panels_look look = {
        .front = c->stance.front,
        .palette = {forces ? AX_PALETTE_FORCE : AX_PALETTE_SCALE,
                    forces ? signed_limit(*design->edge_forces, 3 * linkage->triangle_count) : 1},
        .scale = design->scale,
        .edge_forces = (const double(*)[3])design->edge_forces,
    };
    c->legend = design_legend(design, &look.palette);
    compose(c, flat, around_count, (const float(*)[3])points, &scene.frame);
    look.edge_pixels = edge * pixels_at_middle(&c->view) / c->render.pixel;
    ax_panels_add(&scene, linkage, (const double(*)[3])places, edge, &look);
    ax_free(places), ax_free(points);

    c->light = light_setup(&c->stance, lowest - 0.1 * edge, 0.11 * edge);
    c->render.shadow = 0.46;
    if (flat) { // a sheet lying a little above the ground
        const double key[3] = {-0.35, 0.55, 1.4};
        memcpy(c->light.key, key, sizeof key);
        c->light.ground = lowest - 0.35 * edge;
        c->light.contact_blur = fmax(0.16 * edge, 1 / c->view.scale), c->light.height_blur = 0;
        c->light.self_shadow = false;
        c->light.shadow_size = (int)ax_clamp(fmax(c->sheet.width, c->sheet.height), 512, 4096);
    }
    c->render.outlines =
        (forces ? 0.2 : 0.45) * fading(2, 6, look.edge_pixels) * (0.25 + 0.75 * fading(8, 32, look.edge_pixels));
    ax_status status = paint(c, &scene, path, error);
    ax_scene_free(&scene);
    return status;
}

ax_status ax_picture_design(const ax_design* design, ax_state state, int width, int height, const char* path,
                            ax_error* error)
{
    composition c = {0};
    ax_status status = make_sheet(width, height, &c.sheet, error);
    if (status != AX_OK)
        return status;
    if (state == AX_STATE_SIMULATED && !design->simulated)
        return ax_fail(error, AX_BAD_INPUT,
                       "The design has no simulated state. Simulate it first, or choose flat or deployed.");
    int hinges = design->linkage.hinge_count;
    double(*places)[3] = ax_calloc((size_t)hinges, sizeof *places);
    for (int h = 0; h < hinges; ++h)
        if (state == AX_STATE_FLAT)
            memcpy(places[h], design->flat[h], sizeof design->flat[h]);
        else
            memcpy(places[h], (state == AX_STATE_SIMULATED ? design->simulated : design->deployed)[h],
                   sizeof places[h]);
    describe(design, state, hinges, (const double(*)[3])places, &c);
    status = draw_state(&c, design, state, (const double(*)[3])places, hinges, (const double(*)[3])places, path, error);
    ax_free(places);
    return status;
}

ax_status ax_picture_motion(const ax_design* design, int frame_count, double (*const* frames)[3], int width, int height,
                            const char* pattern, ax_error* error)
{
    composition whole = {.unit_name = ""};
    ax_status status = make_sheet(width, height, &whole.sheet, error);
    whole.sheet.legend = whole.sheet.title = false;
    size_t hinges = (size_t)design->linkage.hinge_count;
    double(*around)[3] = ax_alloc(hinges * (size_t)frame_count, sizeof *around);
    for (int k = 0; k < frame_count; ++k)
        memcpy(around + hinges * (size_t)k, frames[k], hinges * sizeof *around);
    for (int k = 0; k < frame_count && status == AX_OK; ++k) {
        composition c = whole;
        char path[4096];
#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wformat-nonliteral"
        snprintf(path, sizeof path, pattern, k);
#pragma GCC diagnostic pop
        status = draw_state(&c, design, AX_STATE_DEPLOYED, (const double(*)[3])frames[k], (int)hinges * frame_count,
                            (const double(*)[3])around, path, error);
    }
    ax_free(around);
    return status;
}

ax_status ax_picture_screen(const ax_mesh* mesh, const ax_screen* screen, ax_screen_field field, int width, int height,
                            const char* path, ax_error* error)
{
    composition c = {0};
    ax_status status = make_sheet(width, height, &c.sheet, error);
    if (status != AX_OK)
        return status;
    bool curvature = field == AX_SCREEN_CURVATURE;
    const double* values = curvature ? screen->curvature : screen->scale;
    if (!values)
        return ax_fail(error, AX_BAD_INPUT,
                       "The surface was not flattened, so it has no scale factors to show. Choose the curvature.");
    assert(screen->vertex_count == mesh->vertex_count);
    int vertices = mesh->vertex_count;
    double normal[3], size[3];
    sum_of_normals(mesh->face_count, (const int(*)[3])mesh->faces, (const double(*)[3])mesh->positions, normal);
    c.stance = take_stance(normal);

    ax_palette palette = {curvature ? AX_PALETTE_CURVATURE : AX_PALETTE_SCALE,
                          curvature ? signed_limit(values, vertices) : 1};
    c.legend = ax_legend_make(curvature ? "Mean curvature H" : "Scale factor \u03bb", &palette);
    if (curvature)
        c.legend.words[0] = "Dips inward", c.legend.words[1] = "Bulges outward";
    count_by_area(mesh, values, &c.legend);
    extents(vertices, (const double(*)[3])mesh->positions, size);
    snprintf(c.title, sizeof c.title, "Target surface");
    c.unit_name = "";
    write_lengths(c.text, sizeof c.text, size, 3, "");

    ax_scene scene = ax_scene_of_surface(mesh, values, &palette, c.stance.front);
    compose(&c, false, scene.vertex_count, (const float(*)[3])scene.places, &scene.frame);
    double lowest = INFINITY;
    for (int v = 0; v < vertices; ++v)
        lowest = fmin(lowest, scene.places[v][2]);
    c.light = light_setup(&c.stance, lowest - 0.002, 0.01);
    c.render.shadow = 0.36;
    status = paint(&c, &scene, path, error);
    ax_scene_free(&scene);
    return status;
}

// ---- shade ---------------------------------------------------------------------------------------------------------------------

// From the ground in the first layer's unit to pixels, y up.
typedef struct map_view {
    double scale, x, y; // of the ground's lower left corner
    const ax_ground* ground;
} map_view;

static void map_point(const map_view* v, double x, double y, double out[2])
{
    out[0] = v->x + v->scale * (x - v->ground->lo[0]);
    out[1] = v->y - v->scale * (y - v->ground->lo[1]);
}

static void draw_ground(cairo_t* cr, const map_view* v, const double* opacity, ax_legend* legend)
{
    const ax_ground* g = v->ground;
    cairo_surface_t* image = cairo_image_surface_create(CAIRO_FORMAT_RGB24, g->columns, g->rows);
    if (cairo_surface_status(image) == CAIRO_STATUS_SUCCESS) {
        uint32_t* pixels = (uint32_t*)(void*)cairo_image_surface_get_data(image);
        int stride = cairo_image_surface_get_stride(image) / 4;
        for (int row = 0; row < g->rows; ++row)
            for (int c = 0; c < g->columns; ++c) {
                double rgb[3], value = opacity[(size_t)row * (size_t)g->columns + (size_t)c];
                ax_palette_colour(&legend->palette, value, rgb);
                ax_legend_count(legend, value, 1);
                uint32_t pixel = 0;
                for (int k = 0; k < 3; ++k)
                    pixel = pixel << 8 | (uint32_t)lrint(255 * rgb[k]);
                pixels[(g->rows - 1 - row) * stride + c] = pixel;
            }
        cairo_surface_mark_dirty(image);
        cairo_save(cr);
        cairo_translate(cr, v->x, v->y - v->scale * g->cell * g->rows);
        cairo_scale(cr, v->scale * g->cell, v->scale * g->cell);
        cairo_set_source_surface(cr, image, 0, 0);
        cairo_pattern_set_filter(cairo_get_source(cr), CAIRO_FILTER_GOOD);
        cairo_rectangle(cr, 0, 0, g->columns, g->rows);
        cairo_fill(cr);
        cairo_restore(cr);
    }
    cairo_surface_destroy(image);
}

// The layer's rim as it hangs, seen from above: dark over light, so that it is seen on every colour.
static void draw_rim(cairo_t* cr, const map_view* v, const ax_layer* first, const ax_layer* l, double unit)
{
    double metre = ax_unit_in_metres(l->design->unit) / ax_unit_in_metres(first->design->unit);
    const double(*x)[3] = l->state == AX_STATE_SIMULATED ? l->design->simulated : l->design->deployed;
    int* order = AX_NEW(int, l->design->linkage.hinge_count);
    int count = ax_linkage_rim(&l->design->linkage, order);
    for (int k = 0; k < count; ++k) {
        const double *p = x[order[k]], c = metre * cos(l->turn), s = metre * sin(l->turn);
        double at[2];
        map_point(v, c * p[0] - s * p[1] + l->move[0], s * p[0] + c * p[1] + l->move[1], at);
        cairo_line_to(cr, at[0], at[1]);
    }
    ax_free(order);
    cairo_close_path(cr);
    cairo_set_line_join(cr, CAIRO_LINE_JOIN_ROUND);
    cairo_set_line_width(cr, 3 * unit);
    cairo_set_source_rgba(cr, 1, 1, 1, 0.7);
    cairo_stroke_preserve(cr);
    cairo_set_line_width(cr, 1.2 * unit);
    cairo_set_source_rgb(cr, 0.08, 0.09, 0.12);
    cairo_stroke(cr);
}

static void draw_disc(cairo_t* cr, const map_view* v, const ax_shade_wish* w, double mean, double unit)
{
    double at[2];
    char number[32], text[48];
    map_point(v, w->at[0], w->at[1], at);
    ax_write_number(number, sizeof number, mean, 2);
    snprintf(text, sizeof text, "%s", number);
    cairo_new_path(cr);
    cairo_arc(cr, at[0], at[1], v->scale * w->radius, 0, 2 * AX_PI);
    cairo_set_line_width(cr, 2 * unit);
    cairo_set_source_rgb(cr, 1, 1, 1);
    cairo_stroke(cr);
    ax_label_draw(cr, text, at[0], at[1], unit);
}

// An arrow to the north in the upper right corner.
static void draw_north(cairo_t* cr, const sheet* s, double north)
{
    double x = s->width - 44 * s->unit, y = 62 * s->unit, size = 18 * s->unit;
    double to[2] = {-sin(north), -cos(north)}; // y of the picture goes down
    cairo_new_path(cr);
    cairo_move_to(cr, x + size * to[0], y + size * to[1]);
    cairo_line_to(cr, x - size * to[0] + 0.5 * size * to[1], y - size * to[1] - 0.5 * size * to[0]);
    cairo_line_to(cr, x - 0.55 * size * to[0], y - 0.55 * size * to[1]);
    cairo_line_to(cr, x - size * to[0] - 0.5 * size * to[1], y - size * to[1] + 0.5 * size * to[0]);
    cairo_close_path(cr);
    cairo_set_source_rgb(cr, 0.08, 0.09, 0.12);
    cairo_fill(cr);
    ax_label_draw(cr, "N", x + 1.7 * size * to[0], y + 1.7 * size * to[1], s->unit);
}

ax_status ax_picture_shade(const ax_shade_picture* p, int width, int height, const char* path, ax_error* error)
{
    sheet s;
    ax_status status = make_sheet(width, height, &s, error);
    if (status != AX_OK)
        return status;
    const ax_ground* g = p->ground;
    ax_legend legend = ax_legend_make("Opacity", &(ax_palette){.kind = AX_PALETTE_SHADE, .limit = 1});
    legend.words[0] = "Sun", legend.words[1] = "Shade";
    ax_rectangle card = ax_legend_card(&legend, s.height, s.unit);
    double left = s.legend ? card.x + card.width + 24 * s.unit : 0.05 * width,
           top = s.title ? 56 * s.unit : 0.05 * height;
    double right = width - 88 * s.unit, bottom = height - 40 * s.unit;
    double across = g->cell * g->columns, down = g->cell * g->rows;
    map_view v = {.scale = fmin((right - left) / across, (bottom - top) / down), .ground = g};
    v.x = 0.5 * (left + right - v.scale * across), v.y = 0.5 * (top + bottom + v.scale * down);
    cairo_surface_t* surface = cairo_image_surface_create(CAIRO_FORMAT_RGB24, width, height);
    cairo_t* cr = cairo_create(surface);
    cairo_set_source_rgb(cr, 0.955, 0.96, 0.968);
    cairo_paint(cr);
    draw_ground(cr, &v, p->opacity, &legend);
    cairo_save(cr);
    cairo_rectangle(cr, v.x, v.y - v.scale * down, v.scale * across, v.scale * down);
    cairo_clip(cr);
    for (int k = 0; k < p->layer_count; ++k)
        draw_rim(cr, &v, p->layers, &p->layers[k], s.unit);
    for (int k = 0; k < p->wish_count; ++k)
        draw_disc(cr, &v, &p->wishes[k], ax_shade_mean(g, p->opacity, &p->wishes[k]), s.unit);
    cairo_restore(cr);
    if (s.legend) {
        ax_scale_bar bar = ax_scale_bar_make(v.scale, 120 * s.unit);
        ax_legend_draw(cr, &legend, s.height, s.unit);
        ax_scale_bar_draw(cr, &bar, ax_unit_name(p->layers[0].design->unit), s.width, s.height, s.unit);
        draw_north(cr, &s, p->north);
    }
    if (s.title)
        ax_title_draw(cr, "Shade on the ground", p->text ? p->text : "", s.unit);
    cairo_destroy(cr);
    status = save(surface, path, error);
    cairo_surface_destroy(surface);
    return status;
}
