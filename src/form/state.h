// What a form holds: what was asked, the states, and the solvers that tie them. Shared by the files of this module only.
#pragma once

#include "ax/form.h"
#include "base/pool.h"
#include "constraint/place.h"
#include "deploy/model.h"
#include "joint/joint.h"
#include "linkage/lattice.h"
#include "mesh/closest.h"
#include "solver/solver.h"

typedef struct ax_named_set {
    char* name;
    int count;
    int* hinges;
} ax_named_set;

// A rim part or a constraint with what is derived from it.
typedef struct ax_holder {
    ax_curve* curve;
    ax_closest* surface;
    ax_place place; // of either
} ax_holder;

// Of a panel whose edges k to k + 1 are a (w^k + lean w^-k), w a third of a turn: not equilateral where the sheet has been stretched to fit its
// outline.
typedef struct ax_panel_shape {
    double lean[2]; // a complex number
    double size;    // |a| over the mean edge
    double edge[3]; // over half the lattice spacing, edge k opposite corner k
} ax_panel_shape;

// Where a coarser sheet of the same design rests, at the hinges of this one, while this one settles. NULL: it was not asked.
typedef struct ax_form_coarse {
    double (*deployed)[3], (*simulated)[3];
} ax_form_coarse;

// Groups of the solvers below, -1 where there is none.
typedef struct ax_form_groups {
    int panels, mouths, centres, holes, drawn;
    int *rim, *held; // per rim part and per constraint
} ax_form_groups;

struct ax_form {
    ax_lattice lattice;
    ax_unit unit;
    int outline_count;
    double (*outline)[2]; // that the sheet was laid over; none: it comes from a design

    // derived from the lattice
    double centre[2], radius;      // of the sheet
    double (*centres)[2];          // of the panels, on the sheet
    int (*holder)[2];              // panels of every hinge, -1: none
    int mouth_count, (*mouths)[3]; // hinge, next, previous: the smaller angle of every inner hinge
    int line_count, (*lines)[4];   // four hinges in a row on kagome lines
    int bend_count, (*bends)[3];   // three in a row
    int wide_count, (*wide)[4];    // every second one of seven in a row, on some lines
    double wide_share;             // rows that one of them stands for
    ax_panel_shape* panel;         // of the sheet
    int hole_count, *holes;        // those with six hinges, by number

    // asked
    double* prescribed;
    // Edge k of each panel over lambda spacing / 2: near 1 but in sheets of designs, which are uneven, at the rim above all.
    double (*stretch)[3];
    double mouth_min; // radians
    bool released;
    ax_form_dynamics dynamics;
    int rim_count;
    ax_rim_part* rim;
    int held_count;
    ax_form_constraint* held;
    int set_count;
    ax_named_set* sets;
    int underlay_count;
    const char** underlay_names;
    ax_mesh* underlays;
    double* clearances;

    // states
    double (*flat)[2], (*deployed)[3], (*simulated)[3]; // simulated: always allocated
    double (*side)[3]; // edge k of each panel, opposite corner k: what the load pass keeps
    double growth;
    bool exact, settled;
    bool turned;      // what was painted when it last settled turned over
    int folds;        // pairs of panels that were folded onto each other when it last had opened afresh
    ax_form* coarser; // the same design in fewer panels, as it last rested; NULL: there is none yet
    bool outdated;    // it has not got this one's rim, constraints or dynamics yet
    ax_form_coarse coarse;
    // Where the deployed hinges are drawn to, since they would rest elsewhere than a coarser sheet; NULL: they are not. Lightly: by softer
    // springs, since edges would not be right there.
    double (*drawn)[3];
    bool lightly;
    double apart; // how far from that one it rests at most, over its size, and which hinge; 0: not known
    int apart_hinge;
    unsigned revision;
    int iterations;
    double scaled_step; // largest move of the last iteration over the spacing
    bool opens;         // afresh: all of its load leans on it
    double drag;        // proximal stiffness while it opens to be watched, 0: it does not
    int dragged;        // iterations since

    // solvers, made when needed
    ax_pool* pool;
    ax_solver *shape, *hang;
    ax_form_groups shape_groups, hang_groups;
    int load; // of the hanging solver
    ax_holder *rim_holder, *held_holder;
    int rim_holders, held_holders; // of when they were made: rim and constraints may have changed since
    bool stale;                    // the solvers no longer fit what is asked
    double* pending; // multipliers that were loaded and go into the next solvers: shape, then hang; NULL: none
    size_t pending_count;

    // measured on demand
    double *realised, *opening, *material; // per panel, hole and hinge
    double* pull;                          // per panel: its multiplier over L

    double (*scratch)[3]; // two per hinge
    double* lanes;        // three per panel, six per hole
};

static inline bool ax_form_hangs(const ax_form* f)
{
    return f->dynamics.kind == AX_DYNAMICS_GRAVITY || f->dynamics.kind == AX_DYNAMICS_INFLATION;
}

// The deployed state has panels of its own that share their sizes with the flat ones.
static inline bool ax_form_shares(const ax_form* f)
{
    return f->dynamics.kind == AX_DYNAMICS_EXPAND || (ax_form_hangs(f) && f->dynamics.adapt);
}

// Panels over those of the sheets for which weights of fairness were found, 600.
static inline double ax_form_fineness(const ax_form* f)
{
    return f->lattice.linkage.triangle_count / 600.0;
}

// Ends of edge k of a panel.
static inline void ax_form_edge_ends(const ax_form* f, int triangle, int k, int* a, int* b)
{
    *a = f->lattice.linkage.triangles[triangle][(k + 1) % 3];
    *b = f->lattice.linkage.triangles[triangle][(k + 2) % 3];
}

// Edge k of a panel as prescribed, and the mean of the three.
static inline double ax_form_edge(const ax_form* f, int triangle, int k)
{
    return 0.5 * f->prescribed[triangle] * f->stretch[triangle][k] * f->lattice.spacing;
}
static inline double ax_form_side(const ax_form* f, int triangle)
{
    return (ax_form_edge(f, triangle, 0) + ax_form_edge(f, triangle, 1) + ax_form_edge(f, triangle, 2)) / 3;
}

// Stiffness, panels at 1, with which solvers always draw hinges to where they are: nothing flies off that no row holds.
#define AX_FORM_PROXIMAL 1e-5

#define AX_FORM_OVERLAP 1e-6 // of the mean edge: closed panels touch

enum { AX_FORM_LEAST = 12, AX_FORM_MOST = 2000000 }; // panels

// The sheet: a lattice over the outline, stretched by up to 2 % to its area and proportions where no edge is given, and brought to its
// border where that has corners which whole panels miss.
ax_status ax_form_lay(const ax_form_start* start, ax_lattice* lattice, ax_error* error);

// An outline, closed, to find places on. The caller frees it.
ax_polyline* ax_form_outline_line(int count, const double (*points)[2]);

// Moves a lattice so that its rim keeps to an outline, counter-clockwise; `border` is the same. Sizes of panels come out up to 5 % apart.
void ax_form_fit_border(ax_lattice* lattice, const ax_outline* outline, const ax_polyline* border,
                        const double middle[2]);
// Hinges of the rim that are fixed on the outline and stand to their neighbours as on the sheet, whose panels have nothing to reach for.
void ax_form_list_fitting(const ax_form* form, unsigned char* fits);

// Everything but the linkage, allocated for it and derived from it; states at the sheet.
ax_form* ax_form_over(ax_lattice* lattice, ax_unit unit);

// Drops the rows of fairness on panels of other sizes than their factors tell, as `stretch` has them: such a row takes hinges to be evenly
// spaced, and would bend what is straight.
void ax_form_spare_uneven(ax_form* form);

// Something asked has changed: solvers that no longer fit go; `forget` their multipliers too.
void ax_form_changed(ax_form* form, bool rebuild, bool forget);

// AX_USAGE unless these can be held, wherever they come from.
ax_status ax_form_check_rim(const ax_form* form, int count, const ax_rim_part* parts, ax_error* error);
ax_status ax_form_check_constraint(const ax_form* form, const ax_form_constraint* constraint, ax_error* error);

// Deep copies of what a part or a constraint points to, and their release.
ax_rim_part ax_rim_part_copy(const ax_rim_part* part);
void ax_rim_part_release(ax_rim_part* part);
ax_form_constraint ax_form_constraint_copy(const ax_form_constraint* constraint);
void ax_form_constraint_release(ax_form_constraint* constraint);
ax_curve* ax_curve_of_shape(const ax_curve_shape* shape);

// AX_CANNOT_REALISE, and what to do, where nothing holds the form under its load, or all that does lies on a straight line.
ax_status ax_form_check_support(const ax_form* form, ax_error* error);

// Solvers for what is asked now, if there are none.
void ax_form_build(ax_form* form);
void ax_form_drop_solvers(ax_form* form);
// Place of a parameter among the lanes of a constraint type.
int ax_form_lane(const char* type, const char* parameter);
// A rim that is held may have too much between it. A free one gives way, and a surface that holds every hinge says itself how the sheet
// bends.
bool ax_form_may_fold(const ax_form* form);
// Whether there may be, and no hinge of the rim is free.
bool ax_form_held_all_round(const ax_form* form);
// Whether panels of both states may give way, as far as asked, or not at all for now.
void ax_form_allow_give(ax_form* form, bool allowed);
// The load that the solver takes, in forces per area.
double ax_form_load_per_area(const ax_form* form);
// Adds to a model what the loaded state's rows of fairness weigh, times `scale`.
void ax_form_keep_fair(const ax_form* form, ax_deploy_model* model, double scale);
// The loaded state at rest under `load`, the solver's force per area, from where the projective steps have brought it. Not balanced, and nothing
// is changed, if it did not get there or something holds the form that Newton does not know. False if cancelled.
bool ax_form_balance(ax_form* form, double load, const ax_progress* progress, bool* balanced);
// The deployed state, over the sheet, as a shallow dome of this height over the radius; no multipliers.
void ax_form_open(ax_form* form, double height);
// Brings a coarser sheet of the same design to rest, from where it last rested. Not `nested` where there is none. False if cancelled.
bool ax_form_nest(ax_form* form, const ax_progress* progress, bool* nested);
// The states start where that one rests, without multipliers.
void ax_form_start_at_nest(ax_form* form);
// If the sheet rests elsewhere than the coarser one: puts it back there, and draws it there from now on. False if it does not.
bool ax_form_draw_to_nest(ax_form* form);
// Draws it there lightly, from there again. False if it is drawn lightly already, or not at all.
bool ax_form_draw_lightly(ax_form* form);
// A sheet that is drawn there is drawn to where it rests now.
void ax_form_follow_nest(ax_form* form);
// It is drawn there no longer.
void ax_form_let_go(ax_form* form);
// Once it rests: measures how far from where that coarser sheet did.
void ax_form_leave_nest(ax_form* form);
// Hinges that are further from the outline than `margin` times the sheet's radius; returns how many.
int ax_form_list_inner(const ax_form* form, double margin, int* hinges);
// Puts into the shape's solver where it is drawn to.
void ax_form_aim_drawn(ax_form* form);
// Iterations of the shape, flat and deployed, and of the loaded state; solvers are built.
void ax_form_iterate_shape(ax_form* form, int iterations);
void ax_form_iterate_hang(ax_form* form, int iterations);
// Sizes of the panels as both states have them now, or as prescribed: what the loaded state keeps.
void ax_form_measure_sides(ax_form* form);
// Puts the drag into the solvers; counts iterations under it and ends it when the form has opened; ends it.
void ax_form_drag_solvers(ax_form* form);
void ax_form_dragged(ax_form* form, int iterations);
void ax_form_end_drag(ax_form* form);
// The flat state twisted analytically to the prescribed factors.
void ax_form_twist(ax_form* form);
// Where a fresh sheet stands: point `from` of its flat state at `to`, its axes and its upper side along `axis`. As it lies, unless what
// holds the rim is further off than half the sheet's radius, or its plane leans by more than 45 degrees.
typedef struct ax_form_stand {
    double from[2], to[3], axis[3][3];
} ax_form_stand;
void ax_form_stand_on(const ax_form* form, ax_form_stand* stand);
// The deployed rim is that far from what holds it.
bool ax_form_stands_elsewhere(const ax_form* form);
// Area that a closed curve which holds the whole rim encloses, seen along its normal; else 0. No sheet between is smaller.
double ax_form_rim_area(const ax_form* form);
// Area of the sheet fully open, as painted, or with one scale factor everywhere (0: as painted).
double ax_form_open_area(const ax_form* form, double scale);
#define AX_FORM_RIM_ROOM 1.05 // times the open area: sizes give way, and rims end by whole panels
// Multipliers of both solvers, counted in *count; owned by the caller. NULL if there are none.
double* ax_form_multipliers(const ax_form* form, size_t* count);

// Largest |edge / its length - 1| of a state.
double ax_form_flat_error(const ax_form* form);
double ax_form_deployed_error(const ax_form* form);
double ax_form_simulated_error(const ax_form* form);
// Adds to a report, which holds the figures, what they tell people.
void ax_form_find_problems(ax_form* form, ax_form_report* report);
// AX_CANNOT_REALISE: where a joint solve from here stalls, and what is the matter with the form that it starts from.
ax_status ax_form_fail_joint(ax_form* form, const ax_joint_result* joint, ax_error* error);
// Of a panel in a state, twice its area long.
void ax_form_panel_normal(const ax_form* form, int triangle, const double (*x)[3], double normal[3]);
// Pairs of neighbouring panels whose normals oppose each other.
int ax_form_folds(const ax_form* form, const double (*x)[3], int first[2]); // panels of the first; NULL: not wanted
// What is painted turns over: it sums to more than 2 pi of curvature.
bool ax_form_turns_over(const ax_form* form);
// The deployed state is turned over, and what is painted no longer is: it is left from what was painted before.
bool ax_form_left_over(const ax_form* form);
// Mean height of the deployed hinges above the rim's.
double ax_form_bulge(const ax_form* form);
double ax_form_sides_mean(const ax_form* form);
