#include "ax/design.h"

#include "base/clock.h"
#include "base/vec.h"
#include "design/place.h"
#include "design/simulate.h"
#include "mesh/geometry.h"

#include <assert.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static const double standard_gravity = 9.80665; // m/s2

static void clear_simulated(ax_design* design)
{
    ax_free(design->simulated);
    ax_free(design->forces);
    ax_free(design->edge_forces);
    ax_free(design->slides);
    design->slides = NULL;
    design->simulated = NULL;
    design->forces = NULL;
    design->edge_forces = NULL;
}

// Which way a hinge can move from where it came to rest: not at all at a corner or an end of its curve.
static ax_slide free_directions(const ax_hold* hold, const double place[3])
{
    ax_slide slide = {.freedom = AX_FREE_ACROSS};
    if (hold->kind == AX_HOLD_IN_PLANE) {
        memcpy(slide.axis, hold->normal, sizeof slide.axis);
        return slide;
    }
    double on[3], second[3], t = ax_curve_nearest(hold->curve, place, on);
    ax_curve_derivatives(hold->curve, t, slide.axis, second);
    double speed = ax_norm3(slide.axis);
    slide.freedom = ax_curve_stops(hold->curve, t) || !(speed > 0) ? AX_HELD_FAST : AX_FREE_ALONG;
    for (int c = 0; c < 3 && speed > 0; ++c)
        slide.axis[c] /= speed;
    return slide;
}

// Loads and edge forces in newton from the solution of load 1.
static void keep_solution(ax_design* design, const ax_deploy_model* model, const double (*x)[3], const double* force,
                          double newton)
{
    int n = design->linkage.hinge_count;
    design->simulated = ax_alloc((size_t)n, sizeof *design->simulated);
    design->forces = ax_alloc((size_t)n, sizeof *design->forces);
    design->edge_forces = ax_calloc((size_t)design->linkage.triangle_count, sizeof *design->edge_forces);
    ax_deploy_energy(model, x, design->forces);
    for (int h = 0; h < n; ++h)
        for (int c = 0; c < 3; ++c) {
            design->simulated[h][c] = x[h][c] * model->unit + model->centre[c];
            design->forces[h][c] *= -newton;
        }
    for (int h = 0; h < n; ++h)
        if (model->hold[h].kind == AX_HOLD_FIXED) // to the last bit where they are held
            memcpy(design->simulated[h], design->deployed[h], sizeof design->simulated[h]);
    if (model->slide_count)
        design->slides = AX_NEW0(ax_slide, n);
    for (int k = 0; k < model->slide_count; ++k) {
        int h = model->slide[k];
        design->slides[h] = free_directions(&model->hold[h], design->simulated[h]);
    }
    for (int e = 0; e < model->edge_count; ++e)
        design->edge_forces[model->edge_source[e] / 3][model->edge_source[e] % 3] = force[e] * newton;
}

// Flat facets wider than a panel hold straight, taut rows of panels, which no finite force keeps in balance under a load across
// them: the most common reason why a sound design does not settle.
static bool has_wide_facets(const ax_design* design)
{
    return ax_mean_facet(&design->target) > design->report.edge_mean;
}

ax_status ax_design_simulate(ax_design* design, const ax_load* load, const ax_progress* progress, ax_error* error)
{
    ax_hold* holds = AX_NEW0(ax_hold, design->linkage.hinge_count);
    for (int h = 0; h < design->linkage.hinge_count; ++h)
        holds[h].kind = design->supports[h] ? AX_HOLD_FIXED : AX_HOLD_FREE;
    ax_status status = ax_design_simulate_held(design, load, holds, progress, error);
    ax_free(holds);
    return status;
}

// Whether all that is held lies in planes along which the shell can slide, their normals in one plane: no equilibrium is its only one.
static bool slides_along_planes(int n, const ax_hold* holds)
{
    double sum[3][3] = {{0}}, across[3], trace = 0;
    for (int h = 0; h < n; ++h) {
        if (holds[h].kind == AX_HOLD_FIXED || holds[h].kind == AX_HOLD_ON_CURVE)
            return false;
        for (int i = 0; i < 3 && holds[h].kind == AX_HOLD_IN_PLANE; ++i)
            for (int j = 0; j < 3; ++j)
                sum[i][j] += holds[h].normal[i] * holds[h].normal[j];
    }
    for (int i = 0; i < 3; ++i)
        trace += sum[i][i];
    ax_cross(sum[1], sum[2], across);
    return ax_dot3(sum[0], across) < 1e-9 * trace * trace * trace;
}

ax_status ax_design_simulate_held(ax_design* design, const ax_load* load, const ax_hold* holds,
                                  const ax_progress* progress, ax_error* error)
{
    clear_simulated(design);
    design->load = *load;
    if (load->kind == AX_LOAD_NONE) {
        ax_design_measure(design);
        return AX_OK;
    }
    int held = 0;
    for (int h = 0; h < design->linkage.hinge_count; ++h) {
        design->supports[h] = holds[h].kind != AX_HOLD_FREE;
        held += holds[h].kind != AX_HOLD_FREE;
    }
    if (held < 3)
        return ax_fail(error, AX_USAGE, "%d hinges are supported; at least three are needed to hold the shell.", held);
    if (slides_along_planes(design->linkage.hinge_count, holds))
        return ax_fail(error, AX_CANNOT_REALISE,
                       "The supports lie in planes along which the shell can slide away. Fix at least one hinge too "
                       "(hold_fixed).");
    bool gravity = load->kind == AX_LOAD_GRAVITY;
    double metre = ax_unit_in_metres(design->unit), unit_load, start = ax_seconds();
    ax_deploy_model model =
        ax_deploy_model_make(&design->linkage, (const double(*)[2])design->flat, (const double(*)[3])design->deployed,
                             holds, gravity ? load->direction : NULL, &unit_load);
    double newton = unit_load * metre * metre * (gravity ? load->density * standard_gravity : load->pressure);
    double(*x)[3] = ax_alloc((size_t)model.hinges, sizeof *x), *force = AX_NEW0(double, model.edge_count);
    double(*designed)[3] = ax_alloc((size_t)model.hinges, sizeof *designed);
    for (int h = 0; h < model.hinges; ++h)
        for (int c = 0; c < 3; ++c)
            designed[h][c] = (design->deployed[h][c] - model.centre[c]) / model.unit;
    bool reached = ax_deploy_edge_error(&model, (const double(*)[3])designed) <
                   1e-6; // its supports are no further than it reaches
    ax_deployment result;
    bool finished = ax_deploy(&model, (const double(*)[3])designed, x, force, progress, &result);
    ax_free(designed);
    ax_status status = AX_OK;
    char tightest[96] = "", furthest[96] = "";
    if (finished && !result.exact) {
        ax_design_name_place(design, model.edge_source[result.tightest] / 3, tightest);
        ax_design_name_place(design, model.edge_source[result.furthest] / 3, furthest);
    }
    if (!finished)
        status = ax_fail(error, AX_CANCELLED, "Cancelled.");
    else if (result.exact)
        keep_solution(design, &model, (const double(*)[3])x, force, newton);
    else if (result.gathered)
        status = ax_fail(
            error, AX_CANNOT_REALISE,
            "The rim gathers on one side of the curve that it slides on: the curve is longer than the open linkage can "
            "reach round, and the largest gap grew to %.0f times the mean. Shorten the curve, fix some hinges, or "
            "raise the scale factors.",
            result.gap_most);
    else if (result.gap_least < -1e-9)
        status =
            ax_fail(error, AX_FAILED,
                    "Rim hinges would pass each other on the curve that they slide on, which panels cannot do. Fix "
                    "some of them, or choose a curve with gentler bends.");
    else if (result.taut && !has_wide_facets(design))
        status = ax_fail(error, AX_CANNOT_REALISE,
                         "The sheet is pulled taut between its supports, most at %s: edge forces are beyond %.0f times "
                         "what the load "
                         "asks of a sheet that bulges, and grow without bound. Bring the supports closer by a few per "
                         "cent, or raise "
                         "the scale factors there.",
                         tightest, result.force_over_tension);
    else if (result.force_over_tension > 100 && result.residuals.edge > 1e-3 && !reached)
        status = ax_fail(
            error, AX_CANNOT_REALISE,
            "The supports are too far apart: even fully open the linkage does not reach them, and edge forces grow "
            "without bound, most at %s. Bring the supports closer, or raise the scale factors there.",
            tightest);
    else
        status = ax_fail(
            error, AX_FAILED,
            "The deployment did not reach equilibrium: edges are off by %.1e, most at %s, and forces by %.1e of "
            "the load after %d projective and %d exact steps%s. Nothing simulated is kept. %s",
            result.residuals.edge, furthest, result.residuals.force, result.projective_steps, result.newton_steps,
            result.stable || result.residuals.force > 1e-10 ? "" : ", and the state found is not stable",
            has_wide_facets(design) ? "The target's facets are wider than the panels, and flat facets carry no "
                                      "load: refine the mesh (--refine)."
                                    : "Try the other load, more supports, or another number of triangles.");
    ax_design_measure(design);
    design->report.energy = status == AX_OK ? result.energy * newton * model.unit * metre : NAN;
    design->report.stable = status == AX_OK && result.stable;
    design->report.from_flat = status == AX_OK && result.opening != AX_OPENED_DESIGNED;
    design->report.inflated_first = status == AX_OK && result.opening == AX_OPENED_INFLATED;
    design->report.rim_stages = !design->report.from_flat               ? 0
                                : result.opening == AX_OPENED_IN_STAGES ? AX_OPENING_STAGES
                                                                        : 1;
    design->report.projective_steps = result.projective_steps;
    design->report.newton_steps = result.newton_steps;
    design->report.seconds_deploy = ax_seconds() - start;
    ax_free(x);
    ax_free(force);
    ax_deploy_model_free(&model);
    return status;
}

void ax_design_set_supports(ax_design* design, int count, const int* hinges)
{
    memset(design->supports, 0, (size_t)design->linkage.hinge_count);
    for (int k = 0; k < count; ++k) {
        assert(hinges[k] >= 0 && hinges[k] < design->linkage.hinge_count);
        design->supports[hinges[k]] = 1;
    }
    clear_simulated(design); // it belonged to other supports
    ax_design_measure(design);
}
