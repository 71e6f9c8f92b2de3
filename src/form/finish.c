// From projective to exact: the joint solve near the present states, then deployment of the flat one.
#include "form/state.h"

#include "analysis/measure.h"
#include "base/clock.h"
#include "base/vec.h"
#include "design/apart.h"
#include "design/simulate.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

// Of the mean edge, what released border panels may differ by. With the most room a panel at a sharp corner may turn over, and with
// less it may not.
static const double border_unequal[] = {0.7, 0.35, 0};

typedef struct moved {
    double rms, max;
} moved;

static moved distance(int n, int width, const double* before, const double* after, double unit)
{
    moved m = {0, 0};
    for (int h = 0; h < n; ++h) {
        double sum = 0;
        for (int c = 0; c < width; ++c)
            sum += (after[width * h + c] - before[width * h + c]) * (after[width * h + c] - before[width * h + c]);
        m.rms += sum / n;
        m.max = fmax(m.max, sqrt(sum));
    }
    return (moved){sqrt(m.rms) / unit, m.max / unit};
}

// What holds each deployed hinge in the joint solve, and in the simulation.
static void list_places(const ax_form* f, ax_joint_place* places, ax_hold* holds)
{
    for (int k = 0; k < f->rim_count; ++k)
        for (int i = 0; i < f->rim[k].count; ++i) {
            int h = f->rim[k].hinges[i];
            if (f->rim[k].kind == AX_RIM_FIXED) {
                places[h].kind = AX_JOINT_FIXED;
                holds[h].kind = AX_HOLD_FIXED;
            } else if (f->rim[k].kind == AX_RIM_SLIDE) {
                places[h] = (ax_joint_place){.kind = AX_JOINT_ON_CURVE, .curve = f->rim_holder[k].curve};
                // the frame is built as designed: its hinges stay where the design has them
                holds[h].kind = AX_HOLD_FIXED;
            }
        }
    for (int k = 0; k < f->held_count; ++k) {
        const ax_form_constraint* c = f->held + k;
        for (int i = 0; i < c->count; ++i) {
            int h = c->hinges[i];
            if (places[h].kind != AX_JOINT_FREE)
                continue;
            if (c->kind == AX_HELD_FIXED)
                places[h].kind = AX_JOINT_FIXED;
            else if (c->kind == AX_HELD_CURVE)
                places[h] = (ax_joint_place){.kind = AX_JOINT_ON_CURVE, .curve = f->held_holder[k].curve};
            else if (c->kind == AX_HELD_SURFACE)
                places[h] = (ax_joint_place){.kind = AX_JOINT_ON_SURFACE, .surface = f->held_holder[k].surface};
            if (c->support && (c->kind == AX_HELD_FIXED || c->kind == AX_HELD_SURFACE))
                holds[h].kind = AX_HOLD_FIXED;
            else if (c->support && c->kind == AX_HELD_CURVE)
                holds[h] = (ax_hold){.kind = AX_HOLD_ON_CURVE, .curve = f->held_holder[k].curve};
        }
    }
}

// Planes of the joint solve; counted in *count, owned by the caller.
static ax_joint_plane* list_planes(const ax_form* f, int* count)
{
    ax_joint_plane* planes = AX_NEW0(ax_joint_plane, f->held_count + 1);
    *count = 0;
    for (int k = 0; k < f->held_count; ++k) {
        const ax_form_constraint* c = f->held + k;
        if (c->kind != AX_HELD_PLANE && c->kind != AX_HELD_PLANE_GIVEN)
            continue;
        ax_joint_plane* plane = planes + (*count)++;
        *plane = (ax_joint_plane){.count = c->count, .hinges = c->hinges, .given = c->kind == AX_HELD_PLANE_GIVEN};
        memcpy(plane->point, c->point, sizeof plane->point);
        memcpy(plane->normal, c->direction, sizeof plane->normal);
    }
    return planes;
}

// Arches that stay supports under the load are held in the plane they lie in; where two cross, on the line of both. Returns those
// lines, NULL at the end, owned by the caller.
static ax_curve** hold_arches(const ax_form* f, const double (*x)[3], ax_hold* holds)
{
    ax_curve** lines = AX_NEW0(ax_curve*, f->lattice.linkage.hinge_count + 1);
    int crossings = 0;
    for (int k = 0; k < f->held_count; ++k) {
        const ax_form_constraint* c = f->held + k;
        if (!c->support || (c->kind != AX_HELD_PLANE && c->kind != AX_HELD_PLANE_GIVEN))
            continue;
        double normal[3];
        memcpy(normal, c->direction, sizeof normal);
        if (c->kind == AX_HELD_PLANE) { // exact by now: Newell's normal about the middle
            double middle[3] = {0}, best = 0;
            for (int i = 0; i < c->count; ++i)
                for (int d = 0; d < 3; ++d)
                    middle[d] += x[c->hinges[i]][d] / c->count;
            for (int i = 0; i < c->count; ++i)
                for (int j = 0; j < i; ++j) {
                    double a[3], b[3], n[3];
                    ax_sub3(x[c->hinges[i]], middle, a);
                    ax_sub3(x[c->hinges[j]], middle, b);
                    ax_cross(a, b, n);
                    if (ax_dot3(n, n) > best) {
                        best = ax_dot3(n, n);
                        memcpy(normal, n, sizeof normal);
                    }
                }
        }
        double length = ax_norm3(normal);
        for (int i = 0; i < c->count && length > 0; ++i) {
            ax_hold* hold = holds + c->hinges[i];
            double unit[3] = {normal[0] / length, normal[1] / length, normal[2] / length}, along[3];
            if (hold->kind == AX_HOLD_FREE) {
                hold->kind = AX_HOLD_IN_PLANE;
                memcpy(hold->normal, unit, sizeof unit);
            } else if (hold->kind == AX_HOLD_IN_PLANE) {
                ax_cross(hold->normal, unit, along);
                if (ax_norm3(along) < 1e-6)
                    continue; // the same plane twice
                lines[crossings] = ax_curve_line(x[c->hinges[i]], along);
                *hold = (ax_hold){.kind = AX_HOLD_ON_CURVE, .curve = lines[crossings++]};
            } else if (hold->kind == AX_HOLD_ON_CURVE)
                hold->kind = AX_HOLD_FIXED; // a curve meets a plane in a point
        }
    }
    return lines;
}

static void make_design(const ax_form* f, ax_design* design)
{
    size_t n = (size_t)f->lattice.linkage.hinge_count;
    *design = (ax_design){.unit = f->unit,
                          .linkage = ax_linkage_copy(&f->lattice.linkage),
                          .flat = ax_copy(f->flat, n, sizeof *f->flat),
                          .deployed = ax_copy(f->deployed, n, sizeof *f->deployed),
                          .scale = AX_NEW0(double, f->lattice.linkage.triangle_count),
                          .supports = AX_NEW0(unsigned char, n),
                          .mouth_min = f->mouth_min * 180 / AX_PI,
                          .border = f->released ? AX_BORDER_RELEASED : AX_BORDER_EQUILATERAL,
                          .scale_ratio = NAN};
    for (int k = 0; k < f->held_count; ++k)
        if (f->held[k].kind == AX_HELD_SURFACE && strcmp(f->held[k].name, "target") == 0)
            design->target = ax_mesh_copy(f->held[k].surface);
}

// Congruent states near the present ones, without panels that overlap or are turned over in the flat state: the first that are found with
// ever less room for border panels; joint->converged tells whether congruent ones were. The states are replaced by the last ones tried.
static ax_status solve_clear(const ax_form* f, ax_joint_problem* problem, double (*flat)[2], double (*deployed)[3],
                             const ax_progress* progress, ax_joint_result* joint, ax_error* error)
{
    const ax_linkage* linkage = &f->lattice.linkage;
    size_t n = (size_t)linkage->hinge_count;
    double unit = ax_form_sides_mean(f), (*start)[2] = ax_copy(flat, n, sizeof *start),
           (*opened)[3] = ax_copy(deployed, n, sizeof *opened);
    enum { TRIES = sizeof border_unequal / sizeof *border_unequal };
    int overlaps = 0, flipped = 0, turned = 0, pair[1][2] = {{0, 0}};
    ax_status status = AX_OK;
    for (int k = f->released ? 0 : TRIES - 1; k < TRIES; ++k) {
        ax_progress_part part;
        double lo = 1 - 1.0 / (1 << k);
        memcpy(flat, start, n * sizeof *flat);
        memcpy(deployed, opened, n * sizeof *deployed);
        problem->border_unequal = border_unequal[k];
        status = ax_solve_apart(problem, AX_FORM_OVERLAP * unit, flat, deployed,
                                ax_progress_within(&part, progress, lo, (1 + lo) / 2), joint, error);
        if (status != AX_OK || !joint->converged)
            break;
        const double(*x)[2] = (const double(*)[2])flat;
        overlaps = ax_measure_overlaps(linkage, x, AX_FORM_OVERLAP * unit, 1, pair);
        flipped = ax_measure_flipped(linkage, x, &turned);
        if (!overlaps && !flipped)
            break;
    }
    ax_free(start);
    ax_free(opened);
    if (status == AX_OK && (overlaps || flipped)) {
        char a[16], b[16];
        int t = overlaps ? pair[0][0] : turned;
        const int* h = linkage->triangles[t];
        ax_panel_name(linkage, t, a);
        ax_panel_name(linkage, pair[0][1], b);
        return ax_fail(
            error, AX_CANNOT_REALISE,
            "Exact states have %d pairs of panels that overlap and %d panels that are turned over in the flat "
            "state, %s%s%s first, at (%.3g, %.3g) on the sheet. Round the corner there by a fillet, move the "
            "rim, or paint scale factors that change less steeply.",
            overlaps, flipped, a, overlaps ? " and " : "", overlaps ? b : "", f->lattice.hinges[h[0]][0],
            f->lattice.hinges[h[0]][1]);
    }
    return status;
}

void ax_form_snapshot(ax_form* f, bool loaded, ax_design* design)
{
    make_design(f, design);
    if (loaded && ax_form_hangs(f))
        memcpy(design->deployed, f->simulated, (size_t)f->lattice.linkage.hinge_count * sizeof *f->simulated);
    for (int k = 0; k < f->rim_count; ++k)
        for (int i = 0; i < f->rim[k].count && f->rim[k].kind != AX_RIM_FREE; ++i)
            design->supports[f->rim[k].hinges[i]] = 1;
    ax_design_measure(design);
}

ax_status ax_form_finish(ax_form* f, const ax_progress* progress, ax_design* design, ax_finish* finish, ax_error* error)
{
    const ax_linkage* linkage = &f->lattice.linkage;
    int n = linkage->hinge_count;
    double start = ax_seconds();
    *design = (ax_design){0};
    *finish = (ax_finish){.reason = ""};
    ax_form_build(f);
    double unit = ax_form_sides_mean(f);
    if (f->dynamics.kind == AX_DYNAMICS_NONE)
        return ax_fail(error, AX_CANNOT_REALISE,
                       "Nothing has been deployed yet: let the form expand, hang or inflate before it is finished.");
    double rim = ax_form_rim_area(f), open = ax_form_open_area(f, 2);
    if (rim > AX_FORM_RIM_ROOM * open)
        return ax_fail(
            error, AX_CANNOT_REALISE,
            "The rim's curve encloses %.3g %s2, and even with scale factors of 2 the sheet covers %.3g %s2 fully "
            "open. Choose a smaller curve, or start with a larger sheet.",
            rim, ax_unit_name(f->unit), open, ax_unit_name(f->unit));
    ax_joint_place* places = AX_NEW0(ax_joint_place, n);
    ax_hold* holds = AX_NEW0(ax_hold, n);
    list_places(f, places, holds);
    int planes;
    ax_joint_plane* plane = list_planes(f, &planes);
    double(*flat)[2] = ax_copy(f->flat, (size_t)n, sizeof *flat),
    (*deployed)[3] = ax_copy(f->deployed, (size_t)n, sizeof *deployed);
    for (int k = 0; k < f->rim_count; ++k) // fixed hinges are fixed where they were asked to be
        for (int i = 0; i < f->rim[k].count && f->rim[k].kind == AX_RIM_FIXED; ++i)
            memcpy(deployed[f->rim[k].hinges[i]], f->rim[k].places[i], sizeof *deployed);
    ax_joint_problem problem = {.linkage = linkage,
                                .places = places,
                                .plane_count = planes,
                                .planes = plane,
                                .mouth_min = f->mouth_min,
                                .scale_max = 2};
    ax_joint_result joint = {0};
    ax_progress_part first, second;
    ax_status status =
        solve_clear(f, &problem, flat, deployed, ax_progress_within(&first, progress, 0, 0.4), &joint, error);
    double solved = ax_seconds();
    if (status == AX_OK && !joint.converged)
        status = ax_form_fail_joint(f, &joint, error);
    if (status == AX_OK) {
        moved a = distance(n, 2, f->flat[0], flat[0], unit);
        double(*before)[3] = ax_copy(f->deployed, (size_t)n, sizeof *before);
        memcpy(f->flat, flat, (size_t)n * sizeof *flat);
        memcpy(f->deployed, deployed, (size_t)n * sizeof *deployed);
        for (int t = 0; t < linkage->triangle_count; ++t)
            for (int k = 0; k < 3; ++k) {
                const int* h = linkage->triangles[t];
                f->side[t][k] = ax_distance2(flat[h[(k + 1) % 3]], flat[h[(k + 2) % 3]]);
            }
        ++f->revision;
        make_design(f, design);
        design->report.joint_steps = joint.steps;
        design->report.seconds_joint = solved - start;
        for (int h = 0; h < n; ++h)
            design->supports[h] = holds[h].kind != AX_HOLD_FREE;
        ax_curve** lines = hold_arches(f, (const double(*)[3])deployed, holds);
        int held = 0;
        for (int h = 0; h < n; ++h)
            held += holds[h].kind != AX_HOLD_FREE;
        bool loaded = ax_form_hangs(f) && held >= 3;
        if (loaded) {
            ax_error trouble = {0};
            ax_status simulated = ax_design_simulate_held(design, &f->dynamics.load, holds,
                                                          ax_progress_within(&second, progress, 0.4, 1), &trouble);
            if (simulated == AX_CANCELLED)
                status = ax_fail(error, AX_CANCELLED, "Cancelled.");
            else if (simulated != AX_OK)
                snprintf(finish->reason, sizeof finish->reason, "%.500s", trouble.message);
            else
                memcpy(f->simulated, design->simulated, (size_t)n * sizeof *f->simulated);
            if (simulated == AX_OK && f->dynamics.adopt) { // as congruent to the flat state as the deployed one was
                memcpy(f->deployed, f->simulated, (size_t)n * sizeof *f->deployed);
                memcpy(design->deployed, f->simulated, (size_t)n * sizeof *f->deployed);
                ax_design_measure(design);
            }
        } else {
            design->load.kind = AX_LOAD_NONE;
            ax_design_measure(design);
            if (ax_form_hangs(f))
                snprintf(finish->reason, sizeof finish->reason,
                         "Fewer than three hinges are held, so nothing can hang.");
        }
        for (int k = 0; lines[k]; ++k)
            ax_curve_free(lines[k]);
        ax_free(lines);
        moved b = distance(n, 3, before[0], f->deployed[0], unit);
        ax_free(before);
        finish->flat_moved_rms = a.rms, finish->flat_moved_max = a.max;
        finish->deployed_moved_rms = b.rms, finish->deployed_moved_max = b.max;
        finish->exact = status == AX_OK && !*finish->reason;
        design->report.seconds_total = ax_seconds() - start;
        f->exact = finish->exact;
        f->settled = true;
        ax_solver_reset_multipliers(f->shape);
        if (f->hang)
            ax_solver_reset_multipliers(f->hang);
    }
    if (status != AX_OK)
        ax_design_free(design);
    ax_free(places);
    ax_free(holds);
    ax_free(plane);
    ax_free(flat);
    ax_free(deployed);
    return status;
}
