// Screening a target surface: can it become a deployable linkage, by which load, and if not, what is the nearest
// that can?
#pragma once

#include "ax/flatten.h"

typedef enum ax_verdict {
    AX_DEPLOYABLE,           // H > 0 and the scale range fits
    AX_DEPLOYABLE_PROJECTED, // after projection to positive mean curvature
    AX_NOT_DEPLOYABLE,       // and why, in words
} ax_verdict;

// The band of scale factors a design may use, and how the rim is flattened.
typedef struct ax_target_options {
    double scale_lo, scale_hi; // 1 <= lo < hi <= 2; default 1.02 to 1.9
    ax_flatten_options flatten;
} ax_target_options;
ax_target_options ax_target_options_default(void);

// What projection to positive mean curvature has done to a surface.
typedef struct ax_projection {
    double moved_area_share;  // share of area moved by more than 1e-6 of the diagonal
    double largest_move;      // document units
    double curvature_min;     // after: smallest one-ring average of H
    double nonpositive_share; // after: share of area with H <= 0
    int steps;                // 0: H > 0 already, nothing moved
} ax_projection;

typedef struct ax_screen {
    double area, diagonal; // document units
    double bounds[2][3];   // lowest and highest corner
    int rim_count;         // boundary vertices
    double rim_length;
    // Mean curvature with respect to the outward normal, positive where the surface bulges outward; screened by area
    // quantiles of a one-ring average, since single vertices near the rim or a fan's pole are noisy.
    double curvature_min, curvature_q01, curvature_median, curvature_q95; // 1 / unit
    double curvature_nonpositive_share;                                   // share of area with H <= 0
    double curvature_worst_place[3]; // centroid of the largest part with H <= 0, or of the smallest H
    bool height_field;               // single valued over the xy-plane, so that gravity can deploy it
    bool lies_on_side;         // no height field over the xy-plane, but one over the xz-plane: y may be its up axis
    double gravity_direction;  // +1 or -1 along z: the side to which it bulges (an upright dome is hung: +1)
    double scale_ratio;        // exp(u_max - u_min), the scale range a conformal map needs; NaN if not flattened
    double scale_lo, scale_hi; // the range of lambda when centred in the asked band
    bool scale_fits;
    ax_verdict verdict;
    bool by_inflation, by_gravity; // how it deploys, as it is or after projection
    ax_projection projection;      // what the projection does, where H > 0 fails; else zero
    ax_mesh nearest;               // the projected surface; empty without one. Owned
    char words[1024];              // the verdict in sentences
    int vertex_count;
    double* curvature;        // H per vertex (one-ring average), owned
    double* scale;            // lambda per vertex, owned; NULL if not flattened
    ax_flattening flattening; // owned; empty if not flattened
} ax_screen;

void ax_screen_free(ax_screen* screen);

// Screens a surface as ax_mesh_read returns it. NULL options: defaults. Fails only on impossible options, numerical
// breakdown or cancellation: a surface that cannot deploy is an answer (verdict), not an error.
ax_status ax_target_screen(const ax_mesh* mesh, const ax_target_options* options, const ax_progress* progress,
                           ax_screen* out, ax_error* error);

// Moves `mesh` to the nearest surface of positive mean curvature outside it (obstacle problem, rim fixed); topology is
// kept. AX_CANNOT_REALISE if no part of the surface is dome-like, so that projection would replace all of it.
ax_status ax_target_project(ax_mesh* mesh, const ax_progress* progress, ax_projection* report, ax_error* error);
