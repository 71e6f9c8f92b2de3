// Draws the pictures of the README. usage: make_pictures SURFACES OUT
#include "ax/picture.h"

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

int main(int argc, char** argv)
{
    if (argc != 3) {
        fprintf(stderr, "usage: make_pictures SURFACES OUT\n");
        return 2;
    }
    ax_mesh kidney = read_surface(argv[1], "kidney_dome"), valley = read_surface(argv[1], "valley_roof");
    draw_design(argv[2], "kidney_dome", &kidney, AX_STATE_FLAT);
    draw_screen(argv[2], "valley_roof", &valley);
    draw_design(argv[2], "valley_roof", &valley, AX_STATE_SIMULATED);
    ax_mesh_free(&kidney);
    ax_mesh_free(&valley);
    return 0;
}
