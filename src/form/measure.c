// What came of what was asked: measured on the states alone.
#include "form/state.h"

#include "analysis/measure.h"
#include "base/vec.h"
#include "constraint/cyclic.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

// Area of each hole over that of the cyclic polygon with its sides; 1 where the sides reach no polygon.
const double* ax_form_opening(ax_form* f)
{
    const ax_linkage* linkage = &f->lattice.linkage;
    const double(*x)[3] = (const double(*)[3])(ax_form_hangs(f) ? f->simulated : f->deployed);
    for (int k = 0; k < linkage->hole_count; ++k) {
        const int* h = linkage->hole_hinges + linkage->hole_start[k];
        int n = linkage->hole_start[k + 1] - linkage->hole_start[k];
        f->opening[k] = 1;
        if (n < 3 || n > AX_CYCLIC_MOST)
            continue;
        double side[AX_CYCLIC_MOST], corner[AX_CYCLIC_MOST][2], most = 0, normal[3] = {0};
        for (int i = 0; i < n; ++i)
            side[i] = ax_distance3(x[h[i]], x[h[(i + 1) % n]]);
        ax_cyclic_inscribe(n, side, corner);
        for (int i = 0; i < n; ++i) {
            most += 0.5 * ax_cross2(corner[i], corner[(i + 1) % n]);
            double a[3], b[3], c[3];
            ax_sub3(x[h[i]], x[h[0]], a);
            ax_sub3(x[h[(i + 1) % n]], x[h[0]], b);
            ax_cross(a, b, c);
            for (int d = 0; d < 3; ++d)
                normal[d] += 0.5 * c[d];
        }
        f->opening[k] = most > 0 ? ax_norm3(normal) / most : 1;
    }
    return f->opening;
}

const double* ax_form_material(ax_form* f)
{
    const ax_linkage* linkage = &f->lattice.linkage;
    double mean = ax_form_sides_mean(f);
    memset(f->material, 0, (size_t)linkage->hinge_count * sizeof *f->material);
    memset(f->pull, 0, (size_t)linkage->triangle_count * sizeof *f->pull);
    if (f->pending) // of a form that was stored
        ax_form_build(f);
    ax_solver* s = ax_form_hangs(f) ? f->hang : f->shape;
    const ax_form_groups* g = ax_form_hangs(f) ? &f->hang_groups : &f->shape_groups;
    if (f->stale || !s)
        return f->material;
    for (int t = 0; t < linkage->triangle_count; ++t) {
        double u = ax_solver_multiplier(s, g->panels, t) / mean;
        f->pull[t] = u;
        for (int k = 0; k < 3; ++k)
            f->material[linkage->triangles[t][k]] = fmax(f->material[linkage->triangles[t][k]], u);
    }
    return f->material;
}

ax_form_view ax_form_look(ax_form* f)
{
    const ax_linkage* linkage = &f->lattice.linkage;
    ax_measure_scale(linkage, (const double(*)[2])f->flat, f->realised);
    return (ax_form_view){.linkage = linkage,
                          .unit = f->unit,
                          .spacing = f->lattice.spacing,
                          .sheet = (const double(*)[2])f->lattice.hinges,
                          .outline_count = f->outline_count,
                          .outline = (const double(*)[2])f->outline,
                          .prescribed = f->prescribed,
                          .realised = f->realised,
                          .flat = (const double(*)[2])f->flat,
                          .deployed = (const double(*)[3])f->deployed,
                          .simulated = ax_form_hangs(f) ? (const double(*)[3])f->simulated : NULL,
                          .revision = f->revision};
}

// ---- what holds -----------------------------------------------------------------------------------------------------------------

// A residual, the largest of distances, and the hinge that has it.
static void take_further(double distance, int hinge, double* most, int* worst)
{
    if (distance > *most || *worst < 0)
        *worst = hinge;
    *most = fmax(*most, distance);
}

// Largest distance of hinges from the plane, line or circle that fits them best: the constraint's own projection.
static double fit_distance(const char* name, int count, const int* hinges, const double (*x)[3], int* worst)
{
    const ax_constraint_type* type = ax_constraint_find(name);
    ax_lane3 *y = ax_alloc_aligned((size_t)count, sizeof *y), *p = ax_alloc_aligned((size_t)count, sizeof *p);
    double mean[3] = {0}, most = 0;
    for (int i = 0; i < count; ++i)
        for (int c = 0; c < 3; ++c)
            mean[c] += x[hinges[i]][c] / count;
    for (int i = 0; i < count; ++i)
        for (int c = 0; c < 3; ++c)
            for (int l = 0; l < AX_W; ++l)
                y[i][c][l] = x[hinges[i]][c] - mean[c];
    type->project(NULL, NULL, count, (const ax_lane3*)y, p);
    for (int i = 0; i < count; ++i) {
        double d[3];
        for (int c = 0; c < 3; ++c)
            d[c] = y[i][c][0] - p[i][c][0];
        take_further(ax_norm3(d), hinges[i], &most, worst);
    }
    ax_free(y);
    ax_free(p);
    return most;
}

static double plane_distance(const ax_form_constraint* c, const double x[3])
{
    double d[3];
    ax_sub3(x, c->point, d);
    double length = ax_norm3(c->direction);
    return length > 0 ? ax_dot3(d, c->direction) / length : d[2];
}

static double constraint_residual(const ax_form* f, int k, const double (*x)[3], int* worst)
{
    const ax_form_constraint* c = f->held + k;
    double most = 0;
    switch (c->kind) {
    case AX_HELD_PLANE:
        return fit_distance("plane", c->count, c->hinges, x, worst);
    case AX_HELD_LINE:
        return fit_distance("line", c->count, c->hinges, x, worst);
    case AX_HELD_CIRCLE:
        return fit_distance("circle", c->count, c->hinges, x, worst);
    case AX_HELD_PLANE_GIVEN:
        for (int i = 0; i < c->count; ++i)
            take_further(fabs(plane_distance(c, x[c->hinges[i]])), c->hinges[i], &most, worst);
        return most;
    case AX_HELD_CURVE:
    case AX_HELD_SURFACE: {
        ax_curve* curve = c->kind == AX_HELD_CURVE ? ax_curve_of_shape(&c->curve) : NULL;
        ax_closest* surface = curve ? NULL : ax_closest_make(c->surface);
        for (int i = 0; i < c->count; ++i) {
            double on[3];
            if (curve)
                ax_curve_nearest(curve, x[c->hinges[i]], on);
            else {
                ax_closest_point at = ax_closest_find(surface, x[c->hinges[i]], -1);
                memcpy(on, at.point, sizeof on);
            }
            take_further(ax_distance3(on, x[c->hinges[i]]), c->hinges[i], &most, worst);
        }
        ax_curve_free(curve);
        ax_closest_free(surface);
        return most;
    }
    case AX_HELD_FIXED:
        for (int i = 0; i < c->count; ++i)
            take_further(ax_distance3(c->places[i], x[c->hinges[i]]), c->hinges[i], &most, worst);
        return most;
    case AX_HELD_MIRROR:
        for (int i = 0; i + 1 < c->count; i += 2) {
            const double* a = x[c->hinges[i]];
            double length = ax_norm3(c->direction), height = plane_distance(c, a), image[3];
            for (int d = 0; d < 3; ++d)
                image[d] = a[d] - 2 * height * (length > 0 ? c->direction[d] / length : d == 2);
            take_further(ax_distance3(image, x[c->hinges[i + 1]]), c->hinges[i + 1], &most, worst);
        }
        return most;
    case AX_HELD_ROTATION: {
        double length = ax_norm3(c->direction), w[3];
        for (int d = 0; d < 3; ++d)
            w[d] = length > 0 ? c->direction[d] / length : d == 2;
        double cosine = cos(2 * AX_PI / c->order), sine = sin(2 * AX_PI / c->order);
        for (int i = 0; i < c->count; ++i) {
            int next = i / c->order * c->order + (i + 1) % c->order;
            double a[3], across[3], image[3];
            ax_sub3(x[c->hinges[i]], c->point, a);
            ax_cross(w, a, across);
            double along = ax_dot3(a, w);
            for (int d = 0; d < 3; ++d) // Rodrigues
                image[d] = c->point[d] + cosine * a[d] + sine * across[d] + (1 - cosine) * along * w[d];
            take_further(ax_distance3(image, x[c->hinges[next]]), c->hinges[next], &most, worst);
        }
        return most;
    }
    case AX_HELD_FAIR: {
        unsigned char* wanted = AX_NEW0(unsigned char, f->lattice.linkage.hinge_count);
        for (int i = 0; i < c->count; ++i)
            wanted[c->hinges[i]] = 1;
        for (int i = 0; i < f->line_count; ++i)
            if (wanted[f->lines[i][1]] && wanted[f->lines[i][2]]) {
                const int* h = f->lines[i];
                double d[3];
                for (int q = 0; q < 3; ++q)
                    d[q] = x[h[0]][q] - 3 * x[h[1]][q] + 3 * x[h[2]][q] - x[h[3]][q];
                take_further(ax_norm3(d), h[1], &most, worst);
            }
        ax_free(wanted);
        return most;
    }
    }
    return most;
}

static double rim_residual(const ax_form* f, int k, const double (*x)[3], int* worst)
{
    const ax_rim_part* part = f->rim + k;
    double most = 0;
    ax_curve* curve = part->kind == AX_RIM_SLIDE ? ax_curve_of_shape(&part->curve) : NULL;
    for (int i = 0; i < part->count && part->kind != AX_RIM_FREE; ++i) {
        double on[3];
        if (curve)
            ax_curve_nearest(curve, x[part->hinges[i]], on);
        else
            memcpy(on, part->places[i], sizeof on);
        take_further(ax_distance3(on, x[part->hinges[i]]), part->hinges[i], &most, worst);
    }
    ax_curve_free(curve);
    return most;
}

static double largest_multiplier(const ax_solver* s, int group, int count)
{
    double most = 0;
    for (int c = 0; s && group >= 0 && c < count; ++c)
        most = fmax(most, ax_solver_multiplier(s, group, c));
    return most;
}

// Number of constraints in the solver's group of a held kind on `count` hinges.
static int group_size(const ax_form_constraint* c)
{
    switch (c->kind) {
    case AX_HELD_PLANE:
    case AX_HELD_LINE:
    case AX_HELD_CIRCLE:
        return 1;
    case AX_HELD_MIRROR:
        return c->count / 2;
    case AX_HELD_ROTATION:
        return c->count / c->order;
    case AX_HELD_FAIR:
        return 0; // soft
    default:
        return c->count;
    }
}

static void measure_held(ax_form* f, ax_form_report* r)
{
    bool hangs = ax_form_hangs(f), ready = !f->stale;
    bool slides = hangs && !ax_form_shares(f); // under the load; else in the shape
    const double(*x)[3] = (const double(*)[3])(hangs ? f->simulated : f->deployed);
    double mean = r->edge;
    r->held = AX_NEW0(ax_held_figure, f->rim_count + f->held_count + 1);
    r->boundary_names = ax_alloc((size_t)f->rim_count + 1, sizeof *r->boundary_names);
    int parts = 0;
    for (int k = 0; k < f->rim_count; ++k)
        parts += f->rim[k].kind != AX_RIM_FREE;
    for (int k = 0; k < f->rim_count; ++k) {
        if (f->rim[k].kind == AX_RIM_FREE)
            continue;
        char* name = r->boundary_names[r->held_count];
        snprintf(name, sizeof *r->boundary_names, parts > 1 ? "boundary %d" : "boundary", r->held_count + 1);
        bool fixed = f->rim[k].kind == AX_RIM_FIXED, loaded = fixed ? hangs : slides;
        ax_held_figure* to = r->held + r->held_count++;
        *to = (ax_held_figure){.name = name,
                               .kind = fixed ? "fixed" : ax_curve_kind_name(f->rim[k].curve.kind),
                               .count = f->rim[k].count,
                               .hinge = -1,
                               .supports = true};
        to->residual = rim_residual(f, k, x, &to->hinge);
        const ax_solver* s = ready ? (loaded ? f->hang : f->shape) : NULL;
        const ax_form_groups* g = loaded ? &f->hang_groups : &f->shape_groups;
        to->multiplier = s && g->rim ? largest_multiplier(s, g->rim[k], fixed ? f->rim[k].count : 1) / mean : 0;
    }
    for (int k = 0; k < f->held_count; ++k) {
        const ax_form_constraint* c = f->held + k;
        // what is no support shapes the open state only
        bool here = !hangs || c->support;
        const double(*at)[3] = (const double(*)[3])(here ? x : (const double(*)[3])f->deployed);
        const ax_solver* holder = ready ? (here && hangs ? f->hang : f->shape) : NULL;
        const ax_form_groups* groups = here && hangs ? &f->hang_groups : &f->shape_groups;
        ax_held_figure* to = r->held + r->held_count++;
        *to = (ax_held_figure){.name = c->name,
                               .kind = ax_held_kind_name(c->kind),
                               .count = c->count,
                               .hinge = -1,
                               .supports = c->support};
        to->residual = constraint_residual(f, k, at, &to->hinge);
        to->multiplier = holder && groups->held ? largest_multiplier(holder, groups->held[k], group_size(c)) / mean : 0;
    }
}

// A scale factor is what lies between a panel and its three neighbours. Border panels lack one, and shape and size of theirs are what
// reaches the rim: what they show of it says nothing of what was painted, on them or on those beside them.
static bool away_from_rim(const ax_form* f, int t)
{
    const ax_linkage* linkage = &f->lattice.linkage;
    for (int k = 0; k < 3; ++k) {
        int h = linkage->triangles[t][k], other = f->holder[h][f->holder[h][0] == t];
        if (other < 0)
            return false;
        for (int i = 0; i < 3; ++i)
            if (linkage->on_rim[linkage->triangles[other][i]])
                return false;
    }
    return true;
}

static void measure_scale(const ax_form* f, ax_form_report* r)
{
    int count = f->lattice.linkage.triangle_count;
    for (int t = 0; t < count; ++t)
        r->scale_judged += away_from_rim(f, t);
    r->realised_min = INFINITY, r->realised_max = -INFINITY;
    for (int t = 0; t < count; ++t) {
        if (r->scale_judged && !away_from_rim(f, t))
            continue;
        r->realised_min = fmin(r->realised_min, f->realised[t]);
        r->realised_max = fmax(r->realised_max, f->realised[t]);
        if (!r->scale_judged)
            continue;
        double off = fabs(f->realised[t] - f->prescribed[t]);
        r->scale_off_rms += off * off / r->scale_judged;
        if (r->scale_off_triangle < 0 || off > r->scale_off_max)
            r->scale_off_max = off, r->scale_off_triangle = t;
    }
    r->scale_off_rms = sqrt(r->scale_off_rms);
}

static double share_down(const ax_form* f, const double (*x)[3])
{
    int down = 0;
    for (int t = 0; t < f->lattice.linkage.triangle_count; ++t) {
        double normal[3];
        ax_form_panel_normal(f, t, x, normal);
        down += normal[2] < 0;
    }
    return down / (double)f->lattice.linkage.triangle_count;
}

// Normals that look down, and the curvature that the painted factors sum to. Curvature of the metric lambda^2: minus the Laplacian
// of ln lambda, summed over discs of several sizes about places spread over the sheet: a surface that carries more than 2 pi turns
// over.
static void measure_overhang(const ax_form* f, ax_form_report* r)
{
    const ax_linkage* linkage = &f->lattice.linkage;
    r->overhang = share_down(f, (const double(*)[3])(ax_form_hangs(f) ? f->simulated : f->deployed));

    // Curvature of a panel: the flow of ln lambda out of it, across each hinge sqrt 3 times the difference (the dual's weight). What lacks
    // a neighbour is left out.
    double* curvature = AX_NEW0(double, linkage->triangle_count);
    for (int h = 0; h < linkage->hinge_count; ++h) {
        int a = f->holder[h][0], b = f->holder[h][1];
        double flow = b < 0 ? NAN : sqrt(3) * (log(f->prescribed[a]) - log(f->prescribed[b]));
        curvature[a] += flow;
        if (b >= 0)
            curvature[b] -= flow;
    }
    enum { CENTRES = 64, RADII = 8 };
    int stride = (linkage->triangle_count + CENTRES - 1) / CENTRES;
    for (int c = 0; c < linkage->triangle_count; c += stride) {
        double ring[RADII] = {0}, sum = 0;
        for (int t = 0; t < linkage->triangle_count; ++t) {
            int at = (int)(RADII * ax_distance2(f->centres[t], f->centres[c]) / f->radius);
            if (at < RADII && !isnan(curvature[t]))
                ring[at] += curvature[t];
        }
        for (int k = 0; k < RADII; ++k) {
            sum += ring[k];
            r->curvature_max = fmax(r->curvature_max, sum);
        }
    }
    ax_free(curvature);
}

bool ax_form_turns_over(const ax_form* f)
{
    ax_form_report painted = {0};
    measure_overhang(f, &painted);
    return painted.curvature_max >= 2 * AX_PI;
}

bool ax_form_left_over(const ax_form* f)
{
    return f->turned && share_down(f, (const double(*)[3])f->deployed) >= 0.02 && !ax_form_turns_over(f);
}

void ax_form_measure(ax_form* f, ax_form_report* r)
{
    const ax_linkage* linkage = &f->lattice.linkage;
    const double(*flat)[2] = (const double(*)[2])f->flat;
    bool moved = f->dynamics.kind != AX_DYNAMICS_NONE, hangs = ax_form_hangs(f);
    ax_form_look(f);
    ax_form_opening(f);
    ax_form_material(f);
    *r =
        (ax_form_report){.exact = f->exact, .iterations = f->iterations, .growth = f->growth, .scale_off_triangle = -1};
    r->edge = ax_form_sides_mean(f);
    r->deployed_error = moved ? ax_form_deployed_error(f) : NAN;
    r->flat_error =
        f->exact ? r->deployed_error : ax_form_flat_error(f); // exact panels have the sizes that they came to
    r->simulated_error = hangs ? ax_form_simulated_error(f) : NAN;
    ax_mouth_measure mouths = ax_measure_mouths(linkage, flat);
    r->mouth_min = mouths.min_deg * AX_PI / 180;
    r->mouth_hinge = mouths.min_hinge;
    r->flipped = ax_measure_flipped(linkage, flat, NULL);
    r->overlap_pairs = ax_measure_overlaps(linkage, flat, AX_FORM_OVERLAP * r->edge, 0, NULL);
    measure_scale(f, r);
    r->opening_min = 1, r->opening_mean = 0;
    for (int k = 0; k < linkage->hole_count; ++k) {
        r->opening_min = fmin(r->opening_min, f->opening[k]);
        r->opening_mean += f->opening[k] / linkage->hole_count;
    }
    r->simulated_rms = r->simulated_max = NAN;
    if (hangs) {
        r->simulated_rms = r->simulated_max = 0;
        for (int h = 0; h < linkage->hinge_count; ++h) {
            double d = ax_distance3(f->simulated[h], f->deployed[h]) / r->edge;
            r->simulated_rms += d * d / linkage->hinge_count;
            r->simulated_max = fmax(r->simulated_max, d);
        }
        r->simulated_rms = sqrt(r->simulated_rms);
    }
    measure_overhang(f, r);
    measure_held(f, r);
    ax_form_find_problems(f, r);
    r->settled = true;
    for (int k = 0; k < r->finding_count; ++k)
        r->settled = r->settled &&
                     !(r->findings[k].severity == AX_SEVERITY_FAILURE && strcmp(r->findings[k].kind, "clearance") != 0);
    f->settled = r->settled;
}

void ax_form_report_free(ax_form_report* r)
{
    ax_free(r->held);
    ax_free(r->boundary_names);
    ax_free(r->findings);
    *r = (ax_form_report){0};
}
