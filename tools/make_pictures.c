// Draws the pictures of the README and of the docs. usage: make_pictures SURFACES OUT
#include "ax/fabricate.h"
#include "ax/picture.h"

#include <cairo.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>

enum { WIDTH = 800, HEIGHT = 600 };

static void require(ax_status status, const ax_error* error)
{
    if (status == AX_OK)
        return;
    fprintf(stderr, "make_pictures: %s\n", error->message);
    exit(1);
}

static ax_mesh read_surface(const char* folder, const char* name)
{
    char path[4096];
    ax_error error;
    ax_mesh mesh;
    snprintf(path, sizeof path, "%s/%s.obj", folder, name);
    require(ax_mesh_read(path, NULL, &mesh, NULL, &error), &error);
    return mesh;
}

static void draw_screen(const char* folder, const char* name, const ax_mesh* mesh)
{
    char path[4096];
    ax_error error;
    ax_screen screen;
    require(ax_target_screen(mesh, NULL, NULL, &screen, &error), &error);
    snprintf(path, sizeof path, "%s/%s-curvature.png", folder, name);
    require(ax_picture_screen(mesh, &screen, AX_SCREEN_CURVATURE, WIDTH, HEIGHT, path, &error), &error);
    ax_screen_free(&screen);
}

// Draws the states from `first` to the simulated one.
static void draw_design(const char* folder, const char* name, const ax_mesh* mesh, ax_state first)
{
    char path[4096];
    ax_error error;
    ax_design design;
    ax_design_options options = ax_design_options_default();
    options.project = true;
    require(ax_design_from_target(mesh, &options, NULL, &design, &error), &error);
    for (ax_state state = first; state <= AX_STATE_SIMULATED; ++state) {
        snprintf(path, sizeof path, "%s/%s-%s.png", folder, name, ax_state_name(state));
        require(ax_picture_design(&design, state, WIDTH, HEIGHT, path, &error), &error);
    }
    ax_design_free(&design);
}

static void trace(cairo_t* to, const ax_cut_plan* plan, const ax_cut_path* path)
{
    const ax_cut_point *first = &plan->points[path->first], *p = first;
    cairo_move_to(to, p->x, p->y);
    for (int k = 1; k < path->count + path->closed; ++k, ++p) {
        const ax_cut_point* next = k < path->count ? p + 1 : first;
        if (p->bulge == 0) {
            cairo_line_to(to, next->x, next->y);
            continue;
        }
        ax_cut_arc arc = ax_cut_arc_of(p, next);
        void (*draw)(cairo_t*, double, double, double, double, double) = arc.sweep > 0 ? cairo_arc : cairo_arc_negative;
        draw(to, arc.centre[0], arc.centre[1], arc.radius, arc.start, arc.start + arc.sweep);
    }
    if (path->closed)
        cairo_close_path(to);
}

// A sheet in the colours of its profile, `width` pixels wide, with lines of `stroke` pixels.
static void draw_sheet(const char* path, const ax_cut_plan* plan, const ax_cut_sheet* sheet, int width, double stroke)
{
    double scale = (width - 2) / sheet->width;
    int height = (int)ceil(sheet->height * scale) + 2;
    cairo_surface_t* surface = cairo_image_surface_create(CAIRO_FORMAT_RGB24, width, height);
    cairo_t* to = cairo_create(surface);
    cairo_set_source_rgb(to, 1, 1, 1);
    cairo_paint(to);
    cairo_translate(to, 1, height - 1);
    cairo_scale(to, scale, -scale);
    cairo_set_line_width(to, stroke / scale);
    cairo_set_line_join(to, CAIRO_LINE_JOIN_ROUND);
    cairo_set_source_rgb(to, 0.6, 0.6, 0.6);
    cairo_rectangle(to, 0, 0, sheet->width, sheet->height);
    cairo_stroke(to);
    for (int i = sheet->first; i < sheet->first + sheet->count; ++i) {
        const ax_cut_item* item = &plan->items[i];
        const unsigned char* rgb = plan->profile->pens[item->operation].rgb;
        cairo_set_source_rgb(to, rgb[0] / 255.0, rgb[1] / 255.0, rgb[2] / 255.0);
        for (int k = item->first; k < item->first + item->count; ++k)
            trace(to, plan, &plan->paths[k]);
        cairo_stroke(to);
    }
    cairo_destroy(to);
    if (cairo_surface_write_to_png(surface, path) != CAIRO_STATUS_SUCCESS) {
        fprintf(stderr, "make_pictures: cannot write %s\n", path);
        exit(1);
    }
    cairo_surface_destroy(surface);
}

// The second sheet of each joint, which is full, from a dome of 1.8 m; and the coupons.
static void draw_sheets(const char* folder, const ax_mesh* mesh)
{
    static const char* const wanted[][3] = {{"living-hinge", "polypropylene-0.8", "900x600"},
                                            {"none", "card-0.5", "600x400"},
                                            {"pin", "plywood-3", "600x400"},
                                            {"ring", "plywood-3", "600x400"}};
    char path[4096];
    ax_error error;
    ax_design design;
    ax_cut_plan plan;
    ax_design_options options = ax_design_options_default();
    options.triangles = 200;
    require(ax_design_from_target(mesh, &options, NULL, &design, &error), &error);
    for (int k = 0; k < 4; ++k) {
        ax_fabricate_options o = ax_fabricate_options_default();
        require(ax_fabricate_set_joint(&o, wanted[k][0], &error), &error);
        require(ax_fabricate_set_material(&o, wanted[k][1], &error), &error);
        require(ax_fabricate_set_sheet(&o, wanted[k][2], &error), &error);
        o.kerf = o.material.kerf, o.title = "dome";
        require(ax_fabricate(&design, &o, NULL, &plan, &error), &error);
        snprintf(path, sizeof path, "%s/sheet-%s.png", folder, wanted[k][0]);
        draw_sheet(path, &plan, &plan.sheets[1], 1000, 1);
        ax_cut_plan_free(&plan);
        if (!o.joint->one_piece)
            continue;
        require(ax_fabricate_coupon(AX_COUPON_HINGE, &o, &plan, &error), &error);
        snprintf(path, sizeof path, "%s/coupon-hinge.png", folder);
        draw_sheet(path, &plan, &plan.sheets[0], 1000, 1);
        ax_cut_plan_free(&plan);
    }
    require(ax_fabricate_coupon(AX_COUPON_KERF, NULL, &plan, &error), &error);
    snprintf(path, sizeof path, "%s/coupon-kerf.png", folder);
    draw_sheet(path, &plan, &plan.sheets[0], 500, 1);
    ax_cut_plan_free(&plan);
    ax_design_free(&design);
}

int main(int argc, char** argv)
{
    if (argc != 3) {
        fprintf(stderr, "usage: make_pictures SURFACES OUT\n");
        return 2;
    }
    ax_mesh cap = read_surface(argv[1], "spherical_cap");
    draw_sheets(argv[2], &cap);
    ax_mesh_free(&cap);
    ax_mesh kidney = read_surface(argv[1], "kidney_dome"), valley = read_surface(argv[1], "valley_roof");
    draw_design(argv[2], "kidney_dome", &kidney, AX_STATE_FLAT);
    draw_screen(argv[2], "valley_roof", &valley);
    draw_design(argv[2], "valley_roof", &valley, AX_STATE_SIMULATED);
    ax_mesh_free(&kidney);
    ax_mesh_free(&valley);
    return 0;
}
