// Deploys a design as time goes by and draws it: its supports move from the flat sheet to where the frame has them, while the pressure
// or the weight opens the holes. usage: make_deployment RECIPE FOLDER FRAMES WIDTH HEIGHT
#include "ax/picture.h"
#include "ax/session.h"

#include "base/vec.h"
#include "design/motion.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

enum { STEPS = 6 }; // a frame: what moves slower comes nearer to rest

static void require(ax_status status, const ax_error* error)
{
    if (status == AX_OK)
        return;
    fprintf(stderr, "make_deployment: %s\n", error->message);
    exit(1);
}

int main(int argc, char** argv)
{
    if (argc != 6) {
        fprintf(stderr, "usage: make_deployment RECIPE FOLDER FRAMES WIDTH HEIGHT\n");
        return 2;
    }
    char document[4096], pattern[4096];
    ax_error error;
    ax_recipe* recipe;
    ax_session* session;
    const ax_design* d;
    snprintf(document, sizeof document, "%s/deployment.auxshell", argv[2]);
    snprintf(pattern, sizeof pattern, "%s/%%03d.png", argv[2]);
    require(ax_recipe_read(argv[1], &recipe, &error), &error);
    const ax_session_start start = {.recipe = recipe, .until = -1};
    require(ax_session_create(document, &start, NULL, &session, &error), &error);
    require(ax_session_design(session, NULL, &d, &error), &error);

    int n = d->linkage.hinge_count, frames = atoi(argv[3]);
    double(*flat)[3] = ax_calloc((size_t)n, sizeof *flat);
    for (int h = 0; h < n; ++h)
        memcpy(flat[h], d->flat[h], sizeof d->flat[h]);
    ax_pool* pool = ax_pool_make(0);
    ax_design_motion* motion = ax_design_motion_make(d, (const double(*)[3])flat, pool);
    double(**shown)[3] = ax_calloc((size_t)frames, sizeof *shown);
    for (int f = 0; f < frames; ++f) {
        shown[f] = ax_calloc((size_t)n, sizeof **shown);
        for (int step = 1; step <= STEPS; ++step) // each is a time step of its own
            ax_design_motion_to(motion, fmax(0, f - 1 + (double)step / STEPS) / (frames - 1), NULL, shown[f]);
    }
    double far = 0;
    for (int h = 0; h < n; ++h)
        far = fmax(far, ax_distance3(shown[frames - 1][h], d->simulated[h]) / d->report.edge_mean);
    printf("The last frame is %.2f L from the simulated state at most.\n", far);
    require(ax_picture_motion(d, frames, shown, atoi(argv[4]), atoi(argv[5]), pattern, &error), &error);
    for (int f = 0; f < frames; ++f)
        ax_free(shown[f]);
    ax_free(shown);
    ax_free(flat);
    ax_design_motion_free(motion);
    ax_pool_free(pool);
    ax_session_close(session);
    ax_recipe_free(recipe);
    unlink(document);
    return 0;
}
