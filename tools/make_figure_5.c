// A plate of designs, a row each: the sheet as it is cut and the shell deployed, with name, number of triangles and what deploys it.
// Panels along arches, which are supports off the rim, are grey. usage: make_figure_5 OUT.png P.auxshell...
#include "ax/document.h"
#include "ax/picture.h"

#include <cairo.h>
#include <ctype.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

enum { WIDTH = 640, HEIGHT = 440, TEXT = 44, SCALE = 2 }; // of a cell; pictures are drawn larger and shrunk

static void require(ax_status status, const ax_error* error)
{
    if (status == AX_OK)
        return;
    fprintf(stderr, "make_figure_5: %s\n", error->message);
    exit(1);
}

// A value that no colour stands for.
static void mark_arches(ax_design* d)
{
    const ax_linkage* l = &d->linkage;
    for (int t = 0; t < l->triangle_count; ++t) {
        int on = 0;
        for (int k = 0; k < 3; ++k)
            on += d->supports[l->triangles[t][k]] && !l->on_rim[l->triangles[t][k]];
        if (on >= 2)
            d->scale[t] = NAN;
    }
}

static void draw_state(cairo_t* cr, const ax_design* d, ax_state state, double x, double y)
{
    char path[] = "/tmp/auxshell-plate-XXXXXX";
    ax_error error;
    int file = mkstemp(path), places = d->linkage.hinge_count;
    double(*flat)[3] = ax_calloc((size_t)places, sizeof *flat);
    for (int h = 0; h < places; ++h)
        memcpy(flat[h], d->flat[h], sizeof d->flat[h]);
    if (file < 0)
        exit(1);
    close(file);
    if (state == AX_STATE_FLAT)
        require(ax_picture_motion(d, 1, &flat, SCALE * WIDTH, SCALE * HEIGHT, path, &error), &error);
    else
        require(
            ax_picture_motion(d, 1, (double(*const*)[3]) & d->deployed, SCALE * WIDTH, SCALE * HEIGHT, path, &error),
            &error);
    cairo_surface_t* picture = cairo_image_surface_create_from_png(path);
    cairo_save(cr);
    cairo_translate(cr, x, y);
    cairo_scale(cr, 1.0 / SCALE, 1.0 / SCALE);
    cairo_set_source_surface(cr, picture, 0, 0);
    cairo_pattern_set_filter(cairo_get_source(cr), CAIRO_FILTER_GOOD);
    cairo_paint(cr);
    cairo_restore(cr);
    cairo_surface_destroy(picture);
    ax_free(flat);
    unlink(path);
}

static void write_line(cairo_t* cr, const char* path, const ax_design* d, double y)
{
    char name[256], text[400];
    const char* slash = strrchr(path, '/');
    snprintf(name, sizeof name, "%s", slash ? slash + 1 : path);
    *strrchr(name, '.') = 0;
    name[0] = (char)toupper((unsigned char)name[0]);
    for (char* c = name; *c; ++c)
        if (*c == '-')
            *c = ' ';
    snprintf(text, sizeof text, "%s: %d triangles, %s", name, d->linkage.triangle_count,
             ax_load_kind_name(d->load.kind));
    cairo_set_source_rgb(cr, 0.08, 0.09, 0.12);
    cairo_set_font_size(cr, 17);
    cairo_move_to(cr, 18, y + 29);
    cairo_show_text(cr, text);
}

int main(int argc, char** argv)
{
    if (argc < 3) {
        fprintf(stderr, "usage: make_figure_5 OUT.png P.auxshell...\n");
        return 2;
    }
    cairo_surface_t* plate = cairo_image_surface_create(CAIRO_FORMAT_RGB24, 2 * WIDTH, (argc - 2) * (HEIGHT + TEXT));
    cairo_t* cr = cairo_create(plate);
    cairo_set_source_rgb(cr, 1, 1, 1);
    cairo_paint(cr);
    cairo_select_font_face(cr, "Inter", CAIRO_FONT_SLANT_NORMAL, CAIRO_FONT_WEIGHT_NORMAL);
    for (int k = 2; k < argc; ++k) {
        ax_design d;
        ax_error error;
        require(ax_document_load(argv[k], &d, &error), &error);
        double y = (k - 2) * (HEIGHT + TEXT);
        mark_arches(&d);
        write_line(cr, argv[k], &d, y);
        draw_state(cr, &d, AX_STATE_FLAT, 0, y + TEXT);
        draw_state(cr, &d, AX_STATE_DEPLOYED, WIDTH, y + TEXT);
        ax_design_free(&d);
    }
    cairo_destroy(cr);
    if (cairo_surface_write_to_png(plate, argv[1]) != CAIRO_STATUS_SUCCESS) {
        fprintf(stderr, "make_figure_5: %s cannot be written.\n", argv[1]);
        return 1;
    }
    cairo_surface_destroy(plate);
    return 0;
}
