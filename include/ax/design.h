// A design: one linkage in its flat, deployed and simulated states, made from a target surface and proven by simulation.
#pragma once

#include "ax/linkage.h"
#include "ax/target.h"

typedef enum ax_border {
    AX_BORDER_EQUILATERAL, // every triangle equilateral, every rim hinge on the boundary curve
    AX_BORDER_RELEASED,    // border triangles may deviate from equilateral
    AX_BORDER_INSIDE,      // whole triangles inside the boundary curve
} ax_border;
const char* ax_border_name(ax_border border);              // "equilateral", "released", "inside"
bool ax_border_parse(const char* name, ax_border* border); // false: there is no such word; so below

typedef enum ax_load_kind { AX_LOAD_NONE, AX_LOAD_GRAVITY, AX_LOAD_INFLATION } ax_load_kind;
const char* ax_load_kind_name(ax_load_kind kind); // "none", "gravity", "inflation"
bool ax_load_kind_parse(const char* name, ax_load_kind* kind);

typedef struct ax_load {
    ax_load_kind kind;
    double direction[3]; // gravity: unit vector in the document's frame
    double pressure;     // inflation: Pa, > 0
    double density;      // gravity: kg per m2 of panel, > 0
} ax_load;

typedef enum ax_unit { AX_MILLIMETRE, AX_CENTIMETRE, AX_METRE } ax_unit;
const char* ax_unit_name(ax_unit unit); // "mm", "cm", "m"
double ax_unit_in_metres(ax_unit unit);
// The unit in which a shell of this length is likely drawn: `unit` itself from 5 cm to 1 km, else the one that brings it there, if any.
ax_unit ax_unit_likely(double length, ax_unit unit);
bool ax_unit_parse(const char* name, ax_unit* unit);

struct ax_design;
// For looking at a design while it is made. `look` is called from the calling thread, before progress is reported, with a design of
// which linkage, unit, flat and deployed state and the scale factors measured on them are there; all of it only during the call.
typedef struct ax_design_watch {
    void (*look)(void* context, const struct ax_design* so_far);
    void* context;
} ax_design_watch;

typedef struct ax_design_options {
    int triangles;            // wanted count, 24 to 2,000,000; used when edge is 0. Default 600
    double edge;              // or the wanted mean triangle edge, document units; 0 = by count
    ax_target_options target; // scale band and flattening
    double mouth_min;         // smallest mouth angle allowed, degrees, 0 to 60; default 2
    ax_border border;
    bool angle_given;             // false: the lattice angle is searched
    double angle;                 // degrees, lattice rows against the flattening's x axis
    bool align_to_edge;           // lattice rows along the longest straight part of the rim
    bool project;                 // project to positive mean curvature first if needed
    ax_load load;                 // what deploys it; kind AX_LOAD_NONE: not simulated
    ax_unit unit;                 // of the target's coordinates
    const ax_design_watch* watch; // borrowed; NULL: nobody looks
} ax_design_options;
ax_design_options ax_design_options_default(void); // inflation at 100 Pa, 4 kg/m2 should gravity be chosen

// Refines a target until its facets are half as wide as the panels that these options ask for. Flat facets wider than panels hold taut,
// straight rows of them, which no finite force keeps in balance.
ax_refinement ax_design_refine_target(ax_mesh* target, const ax_design_options* options);

// Freedom that a support leaves a hinge, without friction.
typedef enum ax_freedom { AX_HELD_FAST, AX_FREE_ALONG, AX_FREE_ACROSS } ax_freedom;
typedef struct ax_slide {
    ax_freedom freedom;
    double axis[3]; // unit: the tangent of the curve along which, or the normal of the plane across which it slides
} ax_slide;

// Every figure of the report. Lengths "over L" are divided by the mean triangle edge L; NaN where a state is missing.
typedef struct ax_report {
    // geometry
    double edge_mean, edge_min, edge_max;                 // L and the range of edges, document units
    double congruence_max;                                // |flat edge / deployed edge - 1|
    double equilateral_inner_max, equilateral_border_max; // largest |edge / mean edge of its triangle - 1|
    double scale_min, scale_max;                          // realised, measured on the flat state
    double mouth_min_deg, mouth_median_deg;
    int mouth_min_hinge;
    int flipped_flat, overlap_pairs;               // flat triangles turned over; pairs overlapping by more than 1e-6 L
    int overlap_first[2];                          // the first such pair, -1 if none
    double surface_max_over_L, surface_rms_over_L; // deployed hinges to the target surface
    double rim_max_over_L;                         // deployed rim hinges to the target's boundary curve
    double cover_p99_over_L;                       // 99 % of the target lies within this distance of a triangle
    double hole_angle_deployed_deg[3];             // 5 %, 50 %, 95 % quantile over hexagonal holes: 120 is fully open
    double flat_bounds[2], deployed_bounds[3];     // extents
    double panel_area;                             // total, document unit squared
    // deployment
    bool simulated;                                    // an exact simulated state exists
    double simulated_rms_over_L, simulated_max_over_L; // simulated against deployed
    int simulated_max_hinge;
    double simulated_edge_error_max; // |edge / flat edge - 1|
    double force_residual;           // |force at free hinges| / |load|, from positions and edge forces alone
    bool stable;                     // the reduced Hessian is positive definite
    bool from_flat;                  // the flat sheet was opened to it; else it was found from the designed state
    bool inflated_first;             // by inflation, whatever the load
    int rim_stages;                  // in which the supports moved to their places: 1, at once; 0 when not from flat
    double edge_force_min, edge_force_max; // N, tension positive
    double compressed_share;               // share of edges pushed
    double hinge_force_max;                // N, the largest force one panel passes on at a hinge
    double energy;                         // J, of the load at the simulated state: compare where equilibria are many
    double load_total, reaction_total;     // N, sums of magnitudes
    // effort
    int joint_steps, projective_steps, newton_steps;
    double seconds_flatten, seconds_joint, seconds_deploy, seconds_total;
} ax_report;

typedef struct ax_design {
    ax_unit unit;
    ax_mesh target; // the surface as designed for (after projection, if any)
    ax_linkage linkage;
    double (*flat)[2];
    double (*deployed)[3];
    double (*simulated)[3];  // NULL unless exact
    double* scale;           // lambda per triangle, realised, measured on the flat state
    unsigned char* supports; // per hinge: 1 where the simulation holds it, at its deployed place unless it slides
    ax_slide* slides;        // per hinge, at the simulated state; NULL: every support holds fast
    ax_load load;
    double (*forces)[3];      // N per hinge at the simulated state; NULL unless simulated
    double (*edge_forces)[3]; // N per triangle, tension positive, edge k opposite corner k; NULL unless simulated
    ax_mesh_repairs repairs;
    bool projected;
    ax_projection projection;
    double scale_ratio; // the range the conformal map needed
    double mouth_min;   // degrees, the bound it was solved with
    ax_border border;
    ax_report report;
} ax_design;

void ax_design_free(ax_design* design);

// Target surface to linkage to proof. `target` as ax_mesh_read returns it; it is copied. On AX_OK every geometric state is
// exact and, unless load.kind is AX_LOAD_NONE, so is the simulated one. AX_CANNOT_REALISE when the surface, the scale band or
// the mouth bound forbid it (design left empty). A deployment that does not converge leaves a valid design whose
// `simulated` is NULL, and returns AX_FAILED with the residuals in the message.
ax_status ax_design_from_target(const ax_mesh* target, const ax_design_options* options, const ax_progress* progress,
                                ax_design* out, ax_error* error);

// Deploys the flat state again under `load` with the present supports. Reads the flat state, the supports' deployed places
// and the load, nothing of the deployed interior unless no equilibrium is reached from flat: then an equilibrium near the designed state is
// looked for, and the report's from_flat is false. Replaces simulated, forces, edge_forces and the report's deployment part; on
// failure these are cleared (a state that is not exact is not kept).
ax_status ax_design_simulate(ax_design* design, const ax_load* load, const ax_progress* progress, ax_error* error);

// How the simulated state was reached, in words: "opened from flat in one go". Empty without one.
const char* ax_report_opening(const ax_report* report);

// Makes these hinges the supports (ax_select finds them by words), and drops the simulated state, which belonged to others.
void ax_design_set_supports(ax_design* design, int count, const int* hinges);

// Measures everything again from the states (not from what the solvers say). Called by the functions above.
void ax_design_measure(ax_design* design);
