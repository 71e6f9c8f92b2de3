#include "analysis/measure.h"
#include "ax/design.h"
#include "base/vec.h"
#include "mesh/geometry.h"
#include "mesh/topology.h"

#include <string.h>

static void extent(int count, int dimension, const double* places, double* out)
{
    for (int d = 0; d < dimension; ++d) {
        double lo = INFINITY, hi = -INFINITY;
        for (int k = 0; k < count; ++k) {
            lo = fmin(lo, places[k * dimension + d]);
            hi = fmax(hi, places[k * dimension + d]);
        }
        out[d] = hi - lo;
    }
}

// Deployed hinges against the target: the surface, its boundary curve, and how much of it is covered.
static void measure_fit(const ax_design* design, ax_report* r)
{
    const ax_mesh* target = &design->target;
    const ax_linkage* linkage = &design->linkage;
    r->surface_max_over_L = r->surface_rms_over_L = r->rim_max_over_L = r->cover_p99_over_L = NAN;
    if (target->face_count == 0)
        return;
    ax_closest* tree = ax_closest_make(target);
    ax_topology topology = ax_topology_make(target);
    int rim_count = topology.loop_start[1];
    double(*rim)[3] = ax_alloc((size_t)rim_count, sizeof *rim), sum = 0, most = 0, rim_most = 0;
    for (int k = 0; k < rim_count; ++k)
        memcpy(rim[k], target->positions[topology.loop[k]], sizeof *rim);
    ax_polyline* curve = ax_polyline_make(rim_count, (const double(*)[3])rim);
    for (int h = 0, hint = -1; h < linkage->hinge_count; ++h) {
        ax_closest_point at = ax_closest_find(tree, design->deployed[h], hint);
        hint = at.face;
        sum += at.distance * at.distance;
        most = fmax(most, at.distance);
        if (linkage->on_rim[h])
            rim_most = fmax(rim_most, ax_polyline_find(curve, design->deployed[h]).distance);
    }
    r->surface_max_over_L = most / r->edge_mean;
    r->surface_rms_over_L = sqrt(sum / linkage->hinge_count) / r->edge_mean;
    r->rim_max_over_L = rim_most / r->edge_mean;
    r->cover_p99_over_L = ax_measure_cover(target, linkage, (const double(*)[3])design->deployed, 0.99) / r->edge_mean;
    ax_free(rim);
    ax_polyline_free(curve);
    ax_topology_free(&topology);
    ax_closest_free(tree);
}

static void measure_simulated(const ax_design* design, ax_report* r)
{
    const ax_linkage* linkage = &design->linkage;
    const double(*places)[3] = (const double(*)[3])design->simulated;
    r->simulated = design->simulated != NULL;
    r->simulated_rms_over_L = r->simulated_max_over_L = r->simulated_edge_error_max = r->force_residual = NAN;
    r->edge_force_min = r->edge_force_max = r->compressed_share = r->hinge_force_max = NAN;
    r->load_total = r->reaction_total = NAN;
    r->simulated_max_hinge = -1;
    if (!r->simulated) {
        r->from_flat = r->inflated_first = false;
        r->rim_stages = 0;
        r->energy = NAN;
        return;
    }
    double sum = 0, most = 0;
    for (int h = 0; h < linkage->hinge_count; ++h) {
        double distance = ax_distance3(places[h], design->deployed[h]);
        sum += distance * distance;
        if (distance > most)
            most = distance, r->simulated_max_hinge = h;
    }
    r->simulated_rms_over_L = sqrt(sum / linkage->hinge_count) / r->edge_mean;
    r->simulated_max_over_L = most / r->edge_mean;
    r->simulated_edge_error_max = ax_measure_congruence(linkage, (const double(*)[2])design->flat, places);

    const double(*forces)[3] = (const double(*)[3])design->edge_forces,
          (*loads)[3] = (const double(*)[3])design->forces;
    r->force_residual = ax_measure_force_residual(linkage, places, forces, loads, design->supports, design->slides);
    ax_measure_hinge_forces(linkage, places, forces, loads, design->supports, &r->hinge_force_max, &r->reaction_total);
    r->load_total = r->compressed_share = 0;
    for (int h = 0; h < linkage->hinge_count; ++h)
        r->load_total += ax_norm3(loads[h]);
    r->edge_force_min = INFINITY, r->edge_force_max = -INFINITY;
    for (int t = 0; t < linkage->triangle_count; ++t)
        for (int k = 0; k < 3; ++k) {
            r->edge_force_min = fmin(r->edge_force_min, forces[t][k]);
            r->edge_force_max = fmax(r->edge_force_max, forces[t][k]);
            r->compressed_share += (forces[t][k] < 0) / (3.0 * linkage->triangle_count);
        }
}

void ax_design_measure(ax_design* design)
{
    const ax_linkage* linkage = &design->linkage;
    const double(*flat)[2] = (const double(*)[2])design->flat;
    ax_report* r = &design->report;
    ax_edge_measure edges = ax_measure_edges(linkage, flat);
    r->edge_mean = edges.mean, r->edge_min = edges.min, r->edge_max = edges.max;
    r->equilateral_inner_max = edges.equilateral_inner, r->equilateral_border_max = edges.equilateral_border;
    r->congruence_max = ax_measure_congruence(linkage, flat, (const double(*)[3])design->deployed);
    if (!design->scale)
        design->scale = AX_NEW(double, linkage->triangle_count);
    ax_measure_scale(linkage, flat, design->scale);
    r->scale_min = INFINITY, r->scale_max = -INFINITY, r->panel_area = 0;
    for (int t = 0; t < linkage->triangle_count; ++t) {
        const int* corner = linkage->triangles[t];
        r->scale_min = fmin(r->scale_min, design->scale[t]);
        r->scale_max = fmax(r->scale_max, design->scale[t]);
        r->panel_area += fabs(ax_orient2(flat[corner[0]], flat[corner[1]], flat[corner[2]])) / 2;
    }
    ax_mouth_measure mouths = ax_measure_mouths(linkage, flat);
    r->mouth_min_deg = mouths.min_deg, r->mouth_median_deg = mouths.median_deg, r->mouth_min_hinge = mouths.min_hinge;
    r->flipped_flat = ax_measure_flipped(linkage, flat, NULL);
    r->overlap_first[0] = r->overlap_first[1] = -1;
    r->overlap_pairs = ax_measure_overlaps(linkage, flat, 1e-6 * edges.mean, 1, &r->overlap_first);
    ax_measure_hole_angles(linkage, (const double(*)[3])design->deployed, r->hole_angle_deployed_deg);
    extent(linkage->hinge_count, 2, design->flat[0], r->flat_bounds);
    extent(linkage->hinge_count, 3, design->deployed[0], r->deployed_bounds);
    measure_fit(design, r);
    measure_simulated(design, r);
}
