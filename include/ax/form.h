// Form-finding from scratch: a linkage laid over an outline, whose flat and deployed states are solved again after every edit.
// A form holds what was asked (scale factors, rim, constraints, dynamics) and what comes of it (the states). Operators edit it;
// `ax_form_iterate` follows the hand, `ax_form_settle` ends a gesture, `ax_form_finish` makes it exact.
// Words as in Konakovic-Lukovic et al. 2018 and docs/form-finding.md.
//
// Sheet coordinates: places on the undeformed lattice that was laid over the outline. They never change, so strokes, boxes and
// gradients given in them mean the same whatever the states are. Lengths are in the document's unit.
#pragma once

#include "ax/design.h"

typedef struct ax_form ax_form;

typedef struct ax_form_start {
    int outline_count; // >= 3; a closed curve in the plane, either sense
    const double (*outline)[2];
    int triangles; // wanted count, 12 to 2,000,000; used when edge is 0
    double edge;   // or the edge of a fully open, unscaled panel: half the lattice spacing
    double scale;  // prescribed all over at first, 1 to 2
    double angle;  // radians, lattice rows against the x axis
    bool inside;   // only panels wholly inside the outline
    ax_unit unit;
} ax_form_start;

// AX_CANNOT_REALISE when the outline holds fewer than 12 panels; AX_USAGE for values out of range.
ax_status ax_form_make(const ax_form_start* start, ax_form** out, ax_error* error);
// A form that starts from an exact design: its states, its scale factors, its rim held where it is, and all hinges held on the target
// surface, if there is one, by a constraint "target" that may be dropped.
ax_status ax_form_from_design(const ax_design* design, ax_form** out, ax_error* error);
void ax_form_free(ax_form* form);

// Everything that later results depend on as bytes, owned by the caller (ax_free). A form loaded from them goes on with the
// same bits. AX_BAD_INPUT when the bytes are damaged or of another version.
void* ax_form_save(const ax_form* form, size_t* size);
ax_status ax_form_load(const void* bytes, size_t size, ax_form** out, ax_error* error);

// ---- what is asked -----------------------------------------------------------------------------------------------------------

// Prescribed scale factors, one per triangle, 1 to 2 (values outside are clamped). Changes no factor.
void ax_form_prescribe(ax_form* form, const double* scale);

typedef enum ax_curve_kind {
    AX_CURVE_LINE,     // points: a point, a direction
    AX_CURVE_CIRCLE,   // points: centre, normal, (radius, 0, 0)
    AX_CURVE_ELLIPSE,  // points: centre, semi-axis a, semi-axis b, as vectors
    AX_CURVE_POLYLINE, // points: corners
    AX_CURVE_SPLINE,   // points: control points of a centripetal Catmull-Rom spline
} ax_curve_kind;

const char* ax_curve_kind_name(ax_curve_kind kind); // "line", "circle", ...

typedef struct ax_curve_shape {
    ax_curve_kind kind;
    bool closed; // polylines and splines
    int count;
    const double (*points)[3]; // borrowed: calls that take a shape copy it
    double fillet; // polylines: corners are rounded by arcs of this radius, where the sides have room; 0: sharp
} ax_curve_shape;

typedef enum ax_rim_kind {
    AX_RIM_FREE,
    AX_RIM_FIXED, // held at `places`
    AX_RIM_SLIDE, // on the curve, in order round the rim
} ax_rim_kind;

// What a set of hinges on the rim is held by. Hinges in no part are free.
typedef struct ax_rim_part {
    ax_rim_kind kind;
    int count;
    const int* hinges;
    const double (*places)[3]; // AX_RIM_FIXED: one per hinge
    ax_curve_shape curve;      // AX_RIM_SLIDE
} ax_rim_part;
// Replaces all parts; a hinge belongs to at most one. AX_USAGE otherwise.
ax_status ax_form_set_rim(ax_form* form, int count, const ax_rim_part* parts, ax_error* error);
// Smallest mouth angle of the flat state, radians, 0 to pi/3: room for joints and the saw. Default 2 degrees.
void ax_form_set_mouth_min(ax_form* form, double angle);
// Border panels (with a rim hinge) may deviate from equilateral, within bounds. Default true.
void ax_form_release_border(ax_form* form, bool released);

typedef enum ax_dynamics_kind {
    AX_DYNAMICS_NONE,    // flat state only; the deployed one keeps its place
    AX_DYNAMICS_EXPAND,  // every hole fully open: the natural shape
    AX_DYNAMICS_GRAVITY, // hangs, or inflates, with the sizes it has (adapt: after an expansion that adapts them)
    AX_DYNAMICS_INFLATION,
} ax_dynamics_kind;

typedef struct ax_form_dynamics {
    ax_dynamics_kind kind;
    // Kind, direction, density or pressure, for reports and the exact stage: the shape does not depend on its size.
    ax_load load;
    bool adapt;      // panel sizes may give way a little so that holes open fully within rim and constraints
    double give;     // how easily they do: 0 not at all, default 3, at most 100
    bool adopt;      // finishing takes the loaded state as the deployed one: what hangs is the design
    bool collisions; // the sheet may grow in the plane until no panels overlap
} ax_form_dynamics;
ax_form_dynamics ax_form_dynamics_default(void); // none, adapt, give 3, no collisions
void ax_form_set_dynamics(ax_form* form, const ax_form_dynamics* dynamics);
const ax_form_dynamics* ax_form_get_dynamics(const ax_form* form);

typedef enum ax_held_kind {
    AX_HELD_PLANE,       // in one plane, the best one
    AX_HELD_PLANE_GIVEN, // in the plane `point`, `direction`
    AX_HELD_LINE,        // on one straight line, the best one
    AX_HELD_CIRCLE,      // on one circle, the best one
    AX_HELD_CURVE,       // on `curve`
    AX_HELD_FIXED,       // at `places`
    AX_HELD_SURFACE,     // on `surface`
    AX_HELD_MIRROR,   // pairs (2 hinges each), mirrored in the plane `point`, `direction`; a hinge may pair with itself
    AX_HELD_ROTATION, // orbits (`order` hinges each), about the axis `point`, `direction`
    AX_HELD_FAIR,     // kagome lines through these hinges bend evenly
} ax_held_kind;
const char* ax_held_kind_name(ax_held_kind kind); // "plane", "plane given", ...

typedef struct ax_form_constraint {
    const char* name; // unique; the report and later edits call it so
    ax_held_kind kind;
    int count; // of hinges; of mirror and rotation: all orbits one after the other
    const int* hinges;
    double weight; // > 0; 1 is as stiff as a panel
    double point[3], direction[3];
    int order;                 // AX_HELD_ROTATION
    const double (*places)[3]; // AX_HELD_FIXED
    ax_curve_shape curve;
    const ax_mesh* surface;
    bool support; // stays a support under the load (plane and curve: slides in it)
} ax_form_constraint;
// Adds, or replaces the one of this name. AX_USAGE for malformed ones.
ax_status ax_form_put_constraint(ax_form* form, const ax_form_constraint* constraint, ax_error* error);
bool ax_form_drop_constraint(ax_form* form, const char* name);

// Named sets of hinges, in order.
void ax_form_name_selection(ax_form* form, const char* name, int count, const int* hinges);
const int* ax_form_selection(const ax_form* form, const char* name, int* count); // NULL if there is none

// Reference geometry of the site, and how far the shell must keep from it.
void ax_form_put_underlay(ax_form* form, const char* name, const ax_mesh* mesh, double clearance);

// ---- solving -----------------------------------------------------------------------------------------------------------------

// A visual update: so many projective iterations of every state. Keeps multipliers, so that the hand feels no jump.
void ax_form_iterate(ax_form* form, int iterations);
// Iterates with so many threads from now on, as many as there are cores unless told; what it computes is the same for any number.
void ax_form_use_threads(ax_form* form, int threads);
// Iterates until the states rest or `iterations` are done (0: 400, and up to five times that while edges are still off). AX_CANCELLED leaves
// the form as it was before the call, and so does AX_CANNOT_REALISE: a load on a form that nothing holds. What could not be met is in the
// report; the return is AX_OK all the same.
ax_status ax_form_settle(ax_form* form, int iterations, const ax_progress* progress, ax_error* error);
// The deployment as time goes by, of a form under load: the sheet lies flat where it opens; its supports go to their places while the load
// opens the holes, by implicit time steps of the projective solver. Panels have the sizes that they have, and are not quite rigid on the
// way; there is no contact. NULL of a form without a simulated state. Keeps nothing of the form.
typedef struct ax_form_motion ax_form_motion;
ax_form_motion* ax_form_motion_make(ax_form* form);
void ax_form_motion_free(ax_form_motion* motion);
// Goes on to time `t`, 0 flat, 1 at rest, and gives the hinges' places, borrowed until the next call; NULL if cancelled.
const double (*ax_form_motion_to(ax_form_motion* motion, double t, const ax_progress* progress))[3];

// Start of the deployed states: `height` out of plane (over the sheet's radius), a bowl or dome; forgets multipliers.
void ax_form_restart(ax_form* form, double height);
// Lays the state that opens last (the loaded one, else the deployed one) flat where it stands, tied to what holds it and bulged by `height`
// towards where it was: `ax_form_iterate` then opens it slowly, by a proximal term, in about a hundred iterations, before it goes on as
// always. For watching: panels are not quite rigid on the way.
void ax_form_reopen(ax_form* form, double height);

// Prescribes scale factors with which the sheet hangs from its rim like a film, evenly pulled and with every hole open: its lowest point
// `depth` below the film that the rim alone would span (negative: above it). Keeps the dynamics; without any, the form expands.
// AX_CANNOT_REALISE unless the rim is held all the way round. On failure the form is left half-way: keep a copy.
ax_status ax_form_drape(ax_form* form, double depth, const ax_progress* progress, ax_error* error);

typedef struct ax_finish {
    bool exact;                            // every state exact; otherwise `reason` tells
    double flat_moved_rms, flat_moved_max; // how far the exact solve moved the states, over L
    double deployed_moved_rms, deployed_moved_max;
    char reason[512];
} ax_finish;
// The exact joint solve and, if there is a load, exact deployment: a design like one from a target surface. The form takes
// over the exact states. AX_CANNOT_REALISE when the form is not near a solution (the report says where).
ax_status ax_form_finish(ax_form* form, const ax_progress* progress, ax_design* design, ax_finish* finish,
                         ax_error* error);

// ---- what comes of it --------------------------------------------------------------------------------------------------------

// Borrowed, valid until the next call that changes the form.
typedef struct ax_form_view {
    const ax_linkage* linkage;
    ax_unit unit;
    double spacing;           // of the undeformed lattice; a panel of scale lambda has edges lambda spacing / 2
    const double (*sheet)[2]; // hinges of the undeformed lattice
    int outline_count;        // points of the outline that it was laid over; 0: over none
    const double (*outline)[2];
    const double* prescribed;     // per triangle
    const double* realised;       // scale factors measured on the present flat state
    const double (*flat)[2];      // hinge places
    const double (*deployed)[3];  // fully open as far as rim and constraints allow
    const double (*simulated)[3]; // under the load; NULL without one
    unsigned revision;            // rises with every change
} ax_form_view;
ax_form_view ax_form_look(ax_form* form);
// Where hinges of the sheet come to lie as it is turned, shifted and grown to the flat state: `count` places. The turn of a panel against the
// sheet, by which its own hinges lie beside them, is left out: sides stay straight, and places are the same at any number of panels.
void ax_form_flat_places(const ax_form* form, int count, const int* hinges, double (*places)[2]);
// Measured when asked for; borrowed likewise. Per hole: area over that of the cyclic polygon of its sides, of the simulated state if
// there is one. Per hinge: largest multiplier over L of its panels; above 2: too little material here.
const double* ax_form_opening(ax_form* form);
const double* ax_form_material(ax_form* form);

// The present states as a design of its own, exact or not, for pictures and exports; `loaded`: the loaded state takes the place of the
// deployed one. Freed by ax_design_free.
void ax_form_snapshot(ax_form* form, bool loaded, ax_design* design);

// What was asked, borrowed until the next change. Return how many there are.
int ax_form_rim(const ax_form* form, const ax_rim_part** parts);
int ax_form_constraints(const ax_form* form, const ax_form_constraint** constraints);
int ax_form_underlays(const ax_form* form, const char*** names, const ax_mesh** meshes, const double** clearances);

typedef enum ax_severity { AX_SEVERITY_NOTE, AX_SEVERITY_WARNING, AX_SEVERITY_FAILURE } ax_severity;
const char* ax_severity_name(ax_severity severity); // "note", "warning", "failure"
typedef struct ax_finding {
    ax_severity severity;
    const char* kind;    // "mouth", "overlap", "unequal", "slack", "tight", "overhang", "held", "scale",
                         // "clearance", "folded", "flipped", "unsettled", "rim", "resolution"
    int triangle, hinge; // where; -1 if nowhere in particular
    int other;           // second panel of a pair, else -1
    double value, limit;
    char text[320]; // for people: what, where, with figures and units, and what to do about it
} ax_finding;

// What a constraint or a rim part was asked, and what came of it.
typedef struct ax_held_figure {
    const char* name;
    const char* kind;
    int count;
    double residual;   // largest distance of a hinge from what holds it, document units; fairness: third differences
    int hinge;         // whose that is
    double multiplier; // largest |u| over L: far above 1 tells of a conflict
    bool supports;     // under the load too, which the others only shape it for
} ax_held_figure;

typedef struct ax_form_report {
    bool settled; // residuals small and at rest
    bool exact;   // since ax_form_finish nothing was edited
    int iterations;
    double edge;                                        // L, the mean panel edge
    double flat_error, deployed_error, simulated_error; // largest |edge / its length - 1|; NaN without the state
    double mouth_min;                                   // radians
    int mouth_hinge;
    int flipped, overlap_pairs; // in the flat state; overlaps deeper than 1e-6 L
    int scale_judged;           // panels whose scale factor can be told: no border panels, nor those beside them
    // Least and greatest factor of these, and |realised - prescribed|; without any: of all panels, 0, and -1.
    double realised_min, realised_max, scale_off_rms, scale_off_max;
    int scale_off_triangle;
    double opening_min, opening_mean;
    double overhang;      // share of panels that look down: no height field
    double curvature_max; // painted curvature summed over the worst disc, radians; above 2 pi the surface turns over
    double growth;        // of the flat sheet by collisions, 1 = none
    double simulated_rms, simulated_max; // simulated against deployed, over L
    int held_count;
    ax_held_figure* held;       // rim parts, then constraints
    char (*boundary_names)[24]; // what these name the rim's parts by
    int finding_count;
    ax_finding* findings; // failures first
} ax_form_report;
// Measures everything now. `report` is owned by the caller.
void ax_form_measure(ax_form* form, ax_form_report* report);
void ax_form_report_free(ax_form_report* report);

// How far the shapes of two forms lie apart, over the largest extent of either. Places are smoothed over the hinges about them.
typedef struct ax_form_apart {
    double size;                       // that extent, document units
    double surfaces_rms, surfaces_max; // from each surface to the nearest point of the other
    // Of the same points of the sheet, and the first form's hinge where that is most; NaN and -1 unless both were laid over one outline.
    double points_rms, points_max;
    int hinge;
} ax_form_apart;
#define AX_FORM_APART_MARGIN 0.025 // nearer to the rim a sheet goes by steps of panels
// Of the deployed states, or of the simulated ones, which both forms must have. What is nearer to the rim than `margin`, 0 to 0.4 of the sheet's
// size, is left out.
void ax_form_measure_apart(const ax_form* a, const ax_form* b, bool simulated, double margin, ax_form_apart* apart);
