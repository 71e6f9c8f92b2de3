// Plays a recipe and draws the state after every operator whose note begins a stage: flat, from above and from the side, a row each.
// usage: make_figure_4 RECIPE OUT.png
#include "ax/recipe.h"

#include "base/vec.h"
#include "picture/colour.h"

#include <cairo.h>
#include <jansson.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { VIEWS = 3, CELL = 300, TEXT = 40, MOST_ROWS = 12 };
static const char* const view_names[VIEWS] = {"flat", "from above", "from the side"};

typedef struct page {
    const ax_recipe* recipe;
    cairo_t* cairo;
    int rows;
    double reach; // half the width of a cell, document units
} page;

typedef struct panel {
    double x[3][2], depth, rgb[3];
} panel;

static int by_depth(const void* a, const void* b)
{
    double d = ((const panel*)a)->depth - ((const panel*)b)->depth;
    return d < 0 ? -1 : d > 0;
}

// Columns of the places that go to the right, up, and towards the eye.
static void draw_panels(const page* p, const ax_form_view* v, const double* places, int width, const int axes[3])
{
    int n = v->linkage->triangle_count;
    panel* panels = AX_NEW0(panel, n);
    double middle[3] = {0};
    for (int h = 0; h < v->linkage->hinge_count; ++h)
        for (int d = 0; d < width; ++d)
            middle[d] += places[width * h + d] / v->linkage->hinge_count;
    for (int t = 0; t < n; ++t) {
        double q[3][3] = {{0}}, a[3], b[3], normal[3];
        for (int k = 0; k < 3; ++k)
            for (int d = 0; d < width; ++d)
                q[k][d] = places[width * v->linkage->triangles[t][k] + d] - middle[d];
        ax_sub3(q[1], q[0], a);
        ax_sub3(q[2], q[0], b);
        ax_cross(a, b, normal);
        double length = ax_norm3(normal);
        double light = 0.75 + 0.25 * (length > 0 ? (normal[2] - 0.5 * normal[0] - 0.3 * normal[1]) / length : 1);
        bool back = axes[2] == 2 && normal[2] < 0; // looks down, seen from above
        ax_colour_scale(v->realised[t], panels[t].rgb);
        for (int c = 0; c < 3; ++c)
            panels[t].rgb[c] *= back ? 0.25 : light;
        for (int k = 0; k < 3; ++k) {
            panels[t].x[k][0] = q[k][axes[0]];
            panels[t].x[k][1] = q[k][axes[1]];
            panels[t].depth += (axes[2] == 1 ? -1 : 1) * q[k][axes[2]];
        }
    }
    qsort(panels, (size_t)n, sizeof *panels, by_depth);
    for (int t = 0; t < n; ++t) {
        for (int k = 0; k < 3; ++k)
            cairo_line_to(p->cairo, panels[t].x[k][0], -panels[t].x[k][1]);
        cairo_close_path(p->cairo);
        cairo_set_source_rgb(p->cairo, panels[t].rgb[0], panels[t].rgb[1], panels[t].rgb[2]);
        cairo_fill_preserve(p->cairo);
        cairo_set_source_rgba(p->cairo, 0, 0, 0, 0.55);
        cairo_stroke(p->cairo);
    }
    ax_free(panels);
}

static void draw_row(page* p, const ax_form_view* v, const char* note)
{
    static const int axes[VIEWS][3] = {{0, 1, 2}, {0, 1, 2}, {0, 2, 1}};
    const double* places[VIEWS] = {(const double*)v->flat, (const double*)(v->simulated ? v->simulated : v->deployed),
                                   NULL};
    places[2] = places[1];
    double top = p->rows * (CELL + TEXT), scale = CELL / (2 * p->reach);
    cairo_t* c = p->cairo;
    for (int view = 0; view < VIEWS; ++view) {
        cairo_save(c);
        cairo_rectangle(c, view * CELL, top + TEXT, CELL, CELL);
        cairo_clip(c);
        cairo_translate(c, (view + 0.5) * CELL, top + TEXT + CELL / 2);
        cairo_scale(c, scale, scale);
        cairo_set_line_width(c, 0.5 / scale);
        cairo_set_line_join(c, CAIRO_LINE_JOIN_ROUND);
        draw_panels(p, v, places[view], view ? 3 : 2, axes[view]);
        cairo_restore(c);
        cairo_set_source_rgb(c, 0.45, 0.45, 0.45);
        cairo_set_font_size(c, 11);
        cairo_move_to(c, view * CELL + 14, top + TEXT + CELL - 10);
        cairo_show_text(c, view_names[view]);
    }
    cairo_set_source_rgb(c, 0.1, 0.1, 0.1);
    cairo_set_font_size(c, 15);
    cairo_move_to(c, 14, top + 28);
    cairo_show_text(c, note);
    ++p->rows;
}

static bool draw_stage(void* context, int k, ax_form* form)
{
    page* p = context;
    json_t* operator= json_loads(ax_recipe_operator(p->recipe, k), 0, NULL);
    const char* note = json_string_value(json_object_get(operator, "note"));
    ax_form_view v = ax_form_look(form);
    if (k == 0)
        for (int h = 0; h < v.linkage->hinge_count; ++h)
            p->reach = fmax(p->reach, 1.3 * sqrt(v.sheet[h][0] * v.sheet[h][0] + v.sheet[h][1] * v.sheet[h][1]));
    if (note && strncmp(note, "Stage ", 6) == 0 && p->rows < MOST_ROWS)
        draw_row(p, &v, note);
    json_decref(operator);
    return true;
}

static void require(ax_status status, const ax_error* error)
{
    if (status == AX_OK)
        return;
    fprintf(stderr, "make_figure_4: %s\n", error->message);
    exit(1);
}

int main(int argc, char** argv)
{
    if (argc != 3) {
        fprintf(stderr, "usage: make_figure_4 RECIPE OUT.png\n");
        return 2;
    }
    ax_recipe* recipe;
    ax_form* form;
    ax_error error;
    int done;
    require(ax_recipe_read(argv[1], &recipe, &error), &error);
    cairo_surface_t* all = cairo_image_surface_create(CAIRO_FORMAT_RGB24, VIEWS * CELL, MOST_ROWS * (CELL + TEXT));
    page p = {.recipe = recipe, .cairo = cairo_create(all)};
    cairo_set_source_rgb(p.cairo, 1, 1, 1);
    cairo_paint(p.cairo);
    cairo_select_font_face(p.cairo, "Inter", CAIRO_FONT_SLANT_NORMAL, CAIRO_FONT_WEIGHT_NORMAL);
    require(ax_recipe_play(recipe, -1, ".", NULL, draw_stage, &p, &form, &done, &error), &error);
    cairo_destroy(p.cairo);
    cairo_surface_t* used =
        cairo_image_surface_create_for_data(cairo_image_surface_get_data(all), CAIRO_FORMAT_RGB24, VIEWS * CELL,
                                            p.rows * (CELL + TEXT), cairo_image_surface_get_stride(all));
    if (cairo_surface_write_to_png(used, argv[2]) != CAIRO_STATUS_SUCCESS) {
        fprintf(stderr, "make_figure_4: %s cannot be written.\n", argv[2]);
        return 1;
    }
    cairo_surface_destroy(used);
    cairo_surface_destroy(all);
    ax_form_free(form);
    ax_recipe_free(recipe);
    return 0;
}
