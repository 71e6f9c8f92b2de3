#include "ax/target.h"

#include "base/vec.h"
#include "conformal/rim.h"
#include "mesh/geometry.h"
#include "target/curvature.h"

#include <assert.h>
#include <stdarg.h>
#include <stdio.h>
#include <string.h>

// A ratio this much above the band's is let pass: so far u itself can be off on a coarse mesh.
static const double RATIO_SLACK = 1.005;
// Faces may lean back from the vertical by this (sine of the angle) before a surface stops being a height field.
static const double LEAN = 1e-6;

ax_target_options ax_target_options_default(void)
{
    return (ax_target_options){.scale_lo = 1.02, .scale_hi = 1.9};
}

void ax_screen_free(ax_screen* screen)
{
    if (!screen)
        return;
    ax_free(screen->curvature);
    ax_free(screen->scale);
    ax_flattening_free(&screen->flattening);
    ax_mesh_free(&screen->nearest);
    *screen = (ax_screen){0};
}

__attribute__((format(printf, 2, 3))) static void say(ax_screen* screen, const char* format, ...)
{
    size_t used = strlen(screen->words);
    va_list arguments;
    va_start(arguments, format);
    vsnprintf(screen->words + used, sizeof screen->words - used, format, arguments);
    va_end(arguments);
}

// A place to the thousandth of the surface's size.
static void say_place(ax_screen* screen, const double place[3])
{
    int decimals = (int)ax_clamp(ceil(3 - log10(screen->diagonal)), 0, 12);
    say(screen, "(%.*f, %.*f, %.*f)", decimals, place[0], decimals, place[1], decimals, place[2]);
}

// Every face looks along an axis, or every face against it, and the rim seen that way does not cross itself; then the surface covers its
// plan once. Gravity asks for it along z.
static bool find_height_field(const ax_mesh* mesh, const ax_flattening* flattening, int axis, double* side)
{
    double lowest = 1, highest = -1, sum = 0;
    for (int f = 0; f < mesh->face_count; ++f) {
        double normal[3];
        ax_face_normal(mesh, f, normal);
        lowest = fmin(lowest, normal[axis]);
        highest = fmax(highest, normal[axis]);
        sum += normal[axis] * ax_face_area(mesh, f);
    }
    *side = sum < 0 ? -1 : 1;
    if (lowest < -LEAN && highest > LEAN)
        return false;
    int n = flattening->rim_count;
    double(*plan)[2] = ax_alloc((size_t)n, sizeof *plan);
    for (int k = 0; k < n; ++k)
        for (int d = 0; d < 2; ++d)
            plan[k][d] = mesh->positions[flattening->rim[k]][(axis + 1 + d) % 3];
    bool simple = ax_rim_is_simple(n, (const double(*)[2])plan);
    ax_free(plan);
    return simple;
}

// The scale factors that the conformal map of a surface needs, centred in the band.
typedef struct scale_fit {
    ax_flattening flattening;
    double ratio, factor, lo, hi; // lambda = factor e^-u
    bool fits;                    // in the band
    bool sound;                   // the flat surface covers its place in the plane once
} scale_fit;

static ax_status fit_scale(const ax_mesh* mesh, const ax_target_options* options, scale_fit* fit, ax_error* error)
{
    *fit = (scale_fit){0};
    ax_status status = ax_flatten(mesh, &options->flatten, &fit->flattening, error);
    if (status != AX_OK)
        return status;
    const ax_flattening* flat = &fit->flattening;
    fit->ratio = exp(flat->u_max - flat->u_min);
    fit->factor = sqrt(options->scale_lo * options->scale_hi) * exp((flat->u_max + flat->u_min) / 2);
    fit->lo = fit->factor * exp(-flat->u_max);
    fit->hi = fit->factor * exp(-flat->u_min);
    fit->fits = fit->ratio <= options->scale_hi / options->scale_lo * RATIO_SLACK;
    double(*outline)[2] = ax_alloc((size_t)flat->rim_count, sizeof *outline);
    for (int k = 0; k < flat->rim_count; ++k)
        memcpy(outline[k], flat->uv[flat->rim[k]], sizeof outline[k]);
    fit->sound = !flat->flipped_faces && ax_rim_is_simple(flat->rim_count, (const double(*)[2])outline);
    ax_free(outline);
    return AX_OK;
}

// Why the flattening of `mesh` does not serve, and what to do.
static void explain_misfit(ax_screen* screen, const ax_mesh* mesh, const ax_target_options* options,
                           const scale_fit* fit)
{
    const ax_flattening* flat = &fit->flattening;
    if (!fit->sound) {
        say(screen, "Flattened, the surface overlaps itself%s. Choose a smaller or flatter piece.",
            options->flatten.boundary == AX_FLATTEN_POLYGON ? " or turns over; other corner angles may help" : "");
        return;
    }
    int largest = 0, smallest = 0;
    for (int v = 0; v < flat->vertex_count; ++v) {
        largest = flat->u[v] < flat->u[largest] ? v : largest;
        smallest = flat->u[v] > flat->u[smallest] ? v : smallest;
    }
    say(screen,
        "Laid flat it needs scale factors in a ratio of %.3f, more than the %.3f that the band %g to %g allows; they "
        "are largest near ",
        fit->ratio, options->scale_hi / options->scale_lo, options->scale_lo, options->scale_hi);
    say_place(screen, mesh->positions[largest]);
    say(screen, " and smallest near ");
    say_place(screen, mesh->positions[smallest]);
    say(screen, ". ");
    if (options->flatten.boundary != AX_FLATTEN_FREE)
        say(screen, "Flatten it with a free rim, which needs the least (--flatten free). ");
    if (fit->ratio <= 2 * RATIO_SLACK)
        say(screen, "Widen the band (--scale 1,2 allows 2.000), or choose a smaller or flatter piece. ");
    else
        say(screen, "Even the widest band, 1 to 2, is too narrow: choose a smaller or flatter piece. ");
    say(screen, "Cones or several pieces would lower the ratio too; they are not supported.");
}

static void say_loads(ax_screen* screen)
{
    if (!screen->by_gravity)
        say(screen, "by inflation; not by gravity, since it is no height field over the xy-plane%s",
            screen->lies_on_side ? " (it is one over the xz-plane: if the file's y axis points up, give --up y)" : "");
    else if (screen->gravity_direction > 0)
        say(screen, "by inflation, and by gravity towards +z, hung upside down");
    else
        say(screen, "by inflation, and by gravity towards -z");
}

static void accept(ax_screen* screen, const ax_mesh* mesh, const ax_target_options* options, const scale_fit* fit)
{
    screen->by_inflation = fit->fits && fit->sound;
    screen->by_gravity = screen->by_inflation && screen->height_field;
    screen->verdict = screen->by_inflation ? AX_DEPLOYABLE : AX_NOT_DEPLOYABLE;
    if (screen->by_inflation) {
        say(screen, "Deployable ");
        say_loads(screen);
        say(screen, ". ");
    } else
        say(screen, "Not deployable. ");
    say(screen,
        "The surface bulges outwards everywhere: its mean curvature is %.3g at the median, %.3g or more on 99 %% of "
        "the area. ",
        screen->curvature_median, screen->curvature_q01);
    if (screen->curvature_nonpositive_share > 0) {
        say(screen, "On %.2g %% of the area, near ", 100 * screen->curvature_nonpositive_share);
        say_place(screen, screen->curvature_worst_place);
        say(screen, ", it does not; up to 1 %% is taken for noise. ");
    }
    if (screen->by_inflation)
        say(screen, "It needs scale factors from %.3f to %.3f, a ratio of %.3f.", fit->lo, fit->hi, fit->ratio);
    else
        explain_misfit(screen, mesh, options, fit);
}

static void refuse_curvature(ax_screen* screen, const ax_curvature_screen* curvature)
{
    screen->verdict = AX_NOT_DEPLOYABLE;
    double size = sqrt(curvature->area);
    say(screen,
        "Not deployable. No part of the surface is dome-like: its mean curvature is not positive on %.0f %% of the "
        "area, and even the most curved twentieth of it ",
        100 * curvature->nonpositive_share);
    if (curvature->q95 * size < 1e-6)
        say(screen, "does not bulge");
    else
        say(screen, "is flatter than a sphere of radius %.5g, where %.5g or less is asked", 1 / curvature->q95,
            1 / curvature->asked);
    say(screen, ". Projection would replace all of it. ");
    if (curvature->median < 0 && curvature->q01 * size < -0.5)
        say(screen, "Turned over, it would bulge. Check which way its faces look.");
    else
        say(screen, "Start from a surface that bulges outwards.%s",
            curvature->q01 < 0 && curvature->q95 * size >= 1e-6
                ? " A saddle between held edges is found from its rim instead, by the operators rim_spline and drape "
                  "of a recipe."
                : "");
}

// Tries the nearest surface of positive mean curvature.
static ax_status try_projection(ax_screen* screen, const ax_mesh* mesh, const ax_target_options* options,
                                const ax_progress* progress, ax_error* error)
{
    say(screen, "The surface dips inwards: its mean curvature is not positive on %.0f %% of the area, most of it near ",
        100 * screen->curvature_nonpositive_share);
    say_place(screen, screen->curvature_worst_place);
    say(screen, ". As it is it cannot deploy. ");
    ax_mesh projected = ax_mesh_copy(mesh);
    ax_status status = ax_target_project(&projected, progress, &screen->projection, error);
    if (status != AX_OK) {
        ax_mesh_free(&projected);
        return status;
    }
    scale_fit fit;
    status = fit_scale(&projected, options, &fit, error);
    if (status == AX_OK) {
        ax_curvature_screen curvature = ax_curvature_measure(&projected);
        double side;
        screen->by_inflation = curvature.positive && fit.fits && fit.sound;
        screen->by_gravity = find_height_field(&projected, &fit.flattening, 2, &side) && screen->by_inflation;
        screen->verdict = screen->by_inflation ? AX_DEPLOYABLE_PROJECTED : AX_NOT_DEPLOYABLE;
        const ax_projection* p = &screen->projection;
        say(screen,
            "The nearest surface that bulges outwards changes %.0f %% of the area and moves it by up to %.3g (%.1f %% "
            "of the diagonal). ",
            100 * p->moved_area_share, p->largest_move, 100 * p->largest_move / screen->diagonal);
        if (!curvature.positive)
            say(screen,
                "It still dips inwards on %.2g %% of the area. Smooth the surface there, or start from a rounder one.",
                100 * curvature.nonpositive_share);
        else if (screen->by_inflation) {
            say(screen, "It deploys ");
            say_loads(screen);
            say(screen, ", with scale factors from %.3f to %.3f.", fit.lo, fit.hi);
        } else
            explain_misfit(screen, &projected, options, &fit);
        ax_curvature_free(&curvature);
        ax_flattening_free(&fit.flattening);
    }
    screen->nearest = projected;
    return status;
}

static void measure(ax_screen* screen, const ax_mesh* mesh, const ax_curvature_screen* curvature, scale_fit* fit)
{
    const ax_flattening* flat = &fit->flattening;
    ax_bounds(mesh, screen->bounds[0], screen->bounds[1]);
    screen->diagonal = ax_distance3(screen->bounds[0], screen->bounds[1]);
    screen->area = curvature->area;
    screen->rim_count = flat->rim_count;
    for (int k = 0; k < flat->rim_count; ++k)
        screen->rim_length +=
            ax_distance3(mesh->positions[flat->rim[k]], mesh->positions[flat->rim[(k + 1) % flat->rim_count]]);
    screen->curvature_min = curvature->min;
    screen->curvature_q01 = curvature->q01;
    screen->curvature_median = curvature->median;
    screen->curvature_q95 = curvature->q95;
    screen->curvature_nonpositive_share = curvature->nonpositive_share;
    memcpy(screen->curvature_worst_place, curvature->worst_place, sizeof screen->curvature_worst_place);
    screen->height_field = find_height_field(mesh, flat, 2, &screen->gravity_direction);
    double side;
    screen->lies_on_side = !screen->height_field && find_height_field(mesh, flat, 1, &side);
    screen->scale_ratio = fit->ratio;
    screen->scale_lo = fit->lo;
    screen->scale_hi = fit->hi;
    screen->scale_fits = fit->fits;
    screen->vertex_count = mesh->vertex_count;
    screen->curvature = ax_copy(curvature->mean, (size_t)mesh->vertex_count, sizeof *curvature->mean);
    screen->scale = AX_NEW(double, mesh->vertex_count);
    for (int v = 0; v < mesh->vertex_count; ++v)
        screen->scale[v] = fit->factor * exp(-flat->u[v]);
}

ax_status ax_target_screen(const ax_mesh* mesh, const ax_target_options* options, const ax_progress* progress,
                           ax_screen* out, ax_error* error)
{
    *out = (ax_screen){0};
    const ax_target_options standard = ax_target_options_default();
    options = options ? options : &standard;
    if (!(options->scale_lo >= 1 && options->scale_hi <= 2 && options->scale_lo < options->scale_hi))
        return ax_fail(error, AX_USAGE, "The scale band must satisfy 1 <= LO < HI <= 2, not %g to %g.",
                       options->scale_lo, options->scale_hi);
    if (!ax_progress_report(progress, "Flattening", 0, NAN))
        return ax_fail(error, AX_CANCELLED, "Cancelled.");
    scale_fit fit;
    ax_status status = fit_scale(mesh, options, &fit, error);
    if (status != AX_OK)
        return status;
    ax_screen screen = {0};
    ax_curvature_screen curvature = ax_curvature_measure(mesh);
    measure(&screen, mesh, &curvature, &fit);
    if (curvature.positive)
        accept(&screen, mesh, options, &fit);
    else if (!curvature.dome_like)
        refuse_curvature(&screen, &curvature);
    else {
        ax_progress_part slot;
        status = try_projection(&screen, mesh, options, ax_progress_within(&slot, progress, 0.2, 1), error);
    }
    screen.flattening = fit.flattening;
    ax_curvature_free(&curvature);
    if (status == AX_OK && !ax_progress_report(progress, "Screened", 1, NAN))
        status = ax_fail(error, AX_CANCELLED, "Cancelled.");
    if (status != AX_OK) {
        ax_screen_free(&screen);
        return status;
    }
    *out = screen;
    return AX_OK;
}
