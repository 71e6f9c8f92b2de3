#include "ax/shade.h"

#include "base/vec.h"

#include <math.h>

enum { WAYS = 4 }; // x, y, turn, extent

typedef struct search {
    int layer_count;
    ax_layer* layers;
    int ray_count;
    const ax_ray* rays;
    const ax_ground* ground;
    const ax_shade_search* how;
    double* opacity;
    int tried;
} search;

static ax_status measure(search* s, double* missed, ax_error* error)
{
    ax_status status =
        ax_shade_map(s->layer_count, s->layers, s->ray_count, s->rays, s->ground, NULL, s->opacity, error);
    *missed = 0;
    for (int k = 0; k < s->how->wish_count && status == AX_OK; ++k) {
        double mean = ax_shade_mean(s->ground, s->opacity, &s->how->wishes[k]);
        if (isnan(mean))
            return ax_fail(
                error, AX_USAGE,
                "Wish %d, a disc of radius %.4g at %.4g, %.4g, is smaller than a cell of the ground (%.3g), or "
                "lies off it. Give a larger disc.",
                k + 1, s->how->wishes[k].radius, s->how->wishes[k].at[0], s->how->wishes[k].at[1], s->ground->cell);
        *missed += (mean - s->how->wishes[k].opacity) * (mean - s->how->wishes[k].opacity) / s->how->wish_count;
    }
    *missed = sqrt(*missed);
    ++s->tried;
    return status;
}

// Farthest panel's middle in plan, so that cutting down begins where something is cut.
static double reach_of(const ax_layer* l)
{
    const double(*x)[3] = l->state == AX_STATE_SIMULATED ? l->design->simulated : l->design->deployed;
    double reach = 0;
    for (int t = 0; t < l->design->linkage.triangle_count; ++t) {
        const int* c = l->design->linkage.triangles[t];
        reach = fmax(reach, hypot(x[c[0]][0] + x[c[1]][0] + x[c[2]][0], x[c[0]][1] + x[c[1]][1] + x[c[2]][1]) / 3);
    }
    return reach;
}

static double* place_of(ax_layer* l, int way)
{
    return way < 2 ? &l->move[way] : way == 2 ? &l->turn : &l->extent;
}

// Tries the layer a step along a way; keeps it if that is better.
static ax_status try_step(search* s, int layer, int way, double to, double* best, bool* better, ax_error* error)
{
    double *place = place_of(&s->layers[layer], way), before = *place, missed;
    *place = to;
    ax_status status = measure(s, &missed, error);
    *better = status == AX_OK && missed < *best - 1e-9;
    if (*better)
        *best = missed;
    else
        *place = before;
    return status;
}

ax_status ax_shade_arrange(int layer_count, ax_layer* layers, int ray_count, const ax_ray* rays,
                           const ax_ground* ground, const ax_shade_search* how, const ax_progress* progress,
                           ax_shade_found* found, ax_error* error)
{
    search s = {layer_count, layers, ray_count, rays, ground, how, NULL, 0};
    *found = (ax_shade_found){0};
    if (how->wish_count < 1 || how->rounds < 1 || how->rounds > 12)
        return ax_fail(error, AX_USAGE, "A search takes at least one wish, and 1 to 12 rounds.");
    s.opacity = AX_NEW(double, (size_t)ground->columns*(size_t)ground->rows);
    double best;
    ax_status status = measure(&s, &best, error);
    found->before = found->after = best;
    ax_layer* start = ax_copy(layers, (size_t)layer_count, sizeof *layers);
    double* reach = AX_NEW0(double, layer_count);
    for (int k = 1; k < layer_count && status == AX_OK; ++k)
        reach[k] = reach_of(&layers[k]);
    for (int round = 0; round < how->rounds && status == AX_OK; ++round) {
        double share = ldexp(0.5, -round);
        for (bool moved = true; moved && status == AX_OK;) {
            moved = false;
            for (int k = 1; k < layer_count && status == AX_OK; ++k)
                for (int step = 0; step < 2 * WAYS && status == AX_OK; ++step) {
                    int way = step / 2;
                    double most = way < 2 ? how->shift : way == 2 ? how->turn : how->extent ? reach[k] : 0;
                    double from = *place_of(&layers[k], way), to = (step % 2 ? -1 : 1) * share * most;
                    if (most == 0)
                        continue;
                    if (way < 3)
                        to = ax_clamp(from + to, *place_of(&start[k], way) - most, *place_of(&start[k], way) + most);
                    else
                        to = ax_clamp(fmin(from, most) + to, 0, most);
                    if (to == from)
                        continue;
                    bool better;
                    status = try_step(&s, k, way, to, &best, &better, error);
                    moved |= better;
                    if (status == AX_OK &&
                        !ax_progress_report(progress, "Arranging layers", (round + 0.5 * moved) / how->rounds, best))
                        status = ax_fail(error, AX_CANCELLED, "Cancelled.");
                }
        }
    }
    found->after = best;
    found->tried = s.tried;
    ax_free(reach);
    ax_free(start);
    ax_free(s.opacity);
    return status;
}
