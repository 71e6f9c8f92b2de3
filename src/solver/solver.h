// Projective (local/global) solver: constraints project their rows independently, one linear solve brings all points together.
//   min over x of  sum_c w_c |A_c x - p_c|^2 + (m / h^2) |x - s|^2 + 2 U(x),   p_c the nearest admissible rows to A_c x,
// U the potential energy of the loads, so that w is a stiffness (force / length) and loads are forces.
// Bouaziz et al. 2012 (Shape-Up), 2014 (Projective Dynamics); with multipliers it is ADMM (Overby et al. 2017).
//
// Four kinds of change, four prices. A parameter, a target, a load's size: nothing is factorised. A new load: nothing either, but the
// next iteration lists who sums what again. A weight, mass or time step: one factorisation. A new group of constraints: one analysis
// and one factorisation. Counters tell. In the steady state nothing is allocated, and results are the same bits for every number of
// threads.
//
// How to find the shape under a load: add constraints (supports as "fixed", panels as "rigid_triangle"), ax_solver_add_load,
// ax_solver_use_multipliers, ax_solver_scale_loads to a tenth (below), ax_solver_settle.
#pragma once

#include "constraint/constraint_type.h"
#include "linalg/panels.h"
#include "solver/load.h"

#include "ax/base.h"

typedef struct ax_solver ax_solver;

// `places` (points x 3) is the start and the rest state that constraints learn from. `pool` is borrowed, NULL: one thread.
ax_solver* ax_solver_make(int points, const double (*places)[3], ax_pool* pool);
void ax_solver_free(ax_solver* solver);

// Adds `count` constraints of one type on `points_each` points each (indices count x points_each) with one weight > 0, a stiffness.
// `place` is the geometry of types that need one, borrowed. Parameters have their defaults and what the type learns from the
// present places. Returns the group. Points of a type that is `eliminated` ("fixed") leave the unknowns: no weight is read.
int ax_solver_add(ax_solver* solver, const ax_constraint_type* type, int points_each, int count, const int* points,
                  double weight, const ax_place* place);
void ax_solver_set_weight(ax_solver* solver, int group, double weight);
// Parameter `lane` (its offset in the type's table) of one constraint.
void ax_solver_set(ax_solver* solver, int group, int constraint, int lane, double value);
// Parameters `first` .. `first + lanes - 1` of all constraints of a group at once, constraint by constraint.
void ax_solver_set_all(ax_solver* solver, int group, int first, int lanes, const double* values);
double ax_solver_get(const ax_solver* solver, int group, int constraint, int lane);

void ax_solver_set_places(ax_solver* solver, const double (*places)[3]);
void ax_solver_get_places(const ax_solver* solver, double (*places)[3]);

// Loads, in units of force. Any number act together.
//
// Adds a load on `loops` loops of points in CSR (loop k is points[start[k] .. start[k + 1])), counter-clockwise seen from outside:
// panels for gravity; panels, holes and openings for pressure. Values have their defaults and what the type learns from the
// present places. Returns the load.
int ax_solver_add_load(ax_solver* solver, const ax_load_type* type, int loops, const int* start, const int* points);
// Value `at` (a parameter's offset in the type's table).
void ax_solver_set_load_value(ax_solver* solver, int load, int at, double value);
// Measures the areas of the loops anew, from places of the rest state, or from the present ones (NULL).
void ax_solver_measure_load(ax_solver* solver, int load, const double (*places)[3]);
// Point forces, one per point, NULL: none.
void ax_solver_set_load(ax_solver* solver, const double (*force)[3]);
// All loads are multiplied by this; 1 at first. Where constraints are rigid the shape does not depend on it, but the number of
// iterations does: see ax_solver_load_ratio. Forces of the constraints are then that multiple of the true ones.
void ax_solver_scale_loads(ax_solver* solver, double factor);
// Strain to expect in a group under the loads as they are, factor 1, at the present places, if its constraints were springs: (sum of
// |force|) / (pi R w), R the radius of a disk with the spread of the points, w the weight of the group. With multipliers a
// strain of 0.1, ax_solver_scale_loads(s, 0.1 / ax_solver_load_ratio(s, group)), settles in 20 to 30 iterations at any mesh size;
// less creeps, more wrinkles.
double ax_solver_load_ratio(ax_solver* solver, int group);

// Implicit time integration: one mass for every point, time step, velocity damping (0..1 kept per step) and an acceleration.
// mass 0 turns it off: the static solve.
typedef struct ax_dynamics {
    double mass, time_step, damping, acceleration[3];
} ax_dynamics;
void ax_solver_set_dynamics(ax_solver* solver, const ax_dynamics* dynamics);

// Every static iteration is drawn to the places before it with this stiffness > 0; 0, the standard: none. What it settles at is
// the same, and nothing flies off that no row holds (Parikh and Boyd 2014, Proximal Algorithms, section 4.1).
void ax_solver_set_proximal(ax_solver* solver, double stiffness);

// With multipliers (ADMM) constraints end exact instead of balanced against each other; they are kept between calls.
void ax_solver_use_multipliers(ax_solver* solver, bool use);
void ax_solver_reset_multipliers(ax_solver* solver);
// A soft group never carries multipliers: it yields to the others by its weight. Groups start hard.
void ax_solver_set_soft(ax_solver* solver, int group, bool soft);
// Multipliers u of all groups, three numbers a row, lengths, by group, constraint and row whatever the elimination order is: with the
// places they are all that a plain iteration depends on. -w A'u are the forces of a constraint on its points.
size_t ax_solver_multiplier_count(const ax_solver* solver);
void ax_solver_get_multipliers(const ax_solver* solver, double* out);
void ax_solver_set_multipliers(ax_solver* solver, const double* multipliers);
// Largest multiplier among the rows of one constraint, a length: far above the edges' own tells of a conflict.
double ax_solver_multiplier(const ax_solver* solver, int group, int constraint);
// Multipliers of constraints that cannot be met grow without end. A bound on their length per row, 0: none; twice the edge of a panel
// keeps such a problem in sight of a compromise and leaves problems that can be met alone.
void ax_solver_cap_multipliers(ax_solver* solver, double length);

// Anderson acceleration: every iteration starts from a combination of the last `window` + 1 (1 .. 8, 5 is a good one; 0: none, the
// standard), taken back where it raises the energy or, with multipliers or a proximal term, where the step does not shorten. Memory grows by
// 2 window + 3 copies of places and multipliers; results then depend on the iterations before. Any change by one of the
// functions above forgets those.
void ax_solver_accelerate(ax_solver* solver, int window);

// Analyses and factorises what has changed; called by those below. False if the matrix is not positive definite: some point is
// bound by nothing. (A structure that floats as a whole may pass by rounding: hold a point of it.)
bool ax_solver_prepare(ax_solver* solver);
// Plain local/global iterations. False as above.
bool ax_solver_iterate(ax_solver* solver, int iterations);
// One time step of `iterations` inner iterations from s = x + h v + h^2 a; velocities are kept.
bool ax_solver_step(ax_solver* solver, int iterations);

// Energy of the constraints and the loads, sum_c w_c |A_c x - p_c|^2 + 2 U(x). Never rises in a plain static iteration under dead
// loads; nor under pressure, unless it is so large that the structure is unstable as a balloon is.
double ax_solver_energy(ax_solver* solver);
// Root mean square of |A x - p| over the rows of a group: its residual, in lengths.
double ax_solver_residual(ax_solver* solver, int group);
// Force left at every point (points x 3): loads minus sum w A'u, u = A x - p without multipliers. Zero in equilibrium; at a point
// that is held, minus the reaction of its support (which under pressure carries the membrane to the origin too, see pressure.c).
void ax_solver_get_forces(ax_solver* solver, double (*force)[3]);

// What a group contributes to a conflict. All in lengths, over rows.
typedef struct ax_group_report {
    double residual, residual_most;     // of |A x - p|: root mean square and largest
    double multiplier, multiplier_most; // of |u|; without multipliers u = A x - p
    int capped;                         // constraints whose multipliers are at the bound
} ax_group_report;
ax_group_report ax_solver_report(ax_solver* solver, int group);

// Iterates until the problem is solved, or until it is clear that it will not be.
typedef struct ax_settle {
    double
        force; // largest force residual to accept: |force left at free points| / |loads on them|, both 2-norms; without
               // loads the latter is |stiffness| x length, stiffness the diagonal of the matrix
    double
        primal; // largest primal residual to accept, / length: the worst group's root mean square of |A x - p|, over the
                // groups with multipliers (the others balance, they need not vanish)
    double length; // edge of a panel; 0: measured, the root mean square distance of the first two points of constraints
    int iterations; // at most
    int patience;   // that neither halve the worse residual nor end: stagnation
    int check;      // residuals are measured once in so many, at about the price of a local step
} ax_settle;
#define AX_SETTLE_STANDARD                                                                                             \
    (ax_settle)                                                                                                        \
    {                                                                                                                  \
        .force = 1e-6, .primal = 1e-6, .iterations = 10000, .patience = 1000, .check = 10                              \
    }

typedef enum ax_settle_end {
    AX_SETTLE_DONE,      // both residuals are small enough
    AX_SETTLE_STAGNATED, // not halved within `patience` iterations: a conflict, or a very soft mode
    AX_SETTLE_DIVERGED,  // not finite, or a thousand times its least
    AX_SETTLE_LIMIT,     // `iterations` are done
    AX_SETTLE_CANCELLED,
    AX_SETTLE_UNBOUND, // some point is bound by nothing; nothing was done
} ax_settle_end;

typedef struct ax_settled {
    ax_settle_end end;
    int iterations;
    double force, primal, length;
    double multiplier_most; // largest |u| / length: below 1 where constraints can be met, growing where they cannot
    int capped;             // constraints whose multipliers are at the bound
    int worst_group;        // the largest primal residual of all groups, -1: there are none
} ax_settled;
// Boyd et al. 2011, Distributed Optimization and Statistical Learning via ADMM, section 3.3: the force residual is the dual one. The
// places are those of the last iteration whatever the end. Static solves only.
ax_settled ax_solver_settle(ax_solver* solver, const ax_settle* settle, const ax_progress* progress);

typedef struct ax_solver_counters {
    int analyses, factorisations, iterations;
    double factor_entries;
    size_t bytes;                              // held by the solver
    size_t bytes_per_solve;                    // read by one global solve
    double seconds_local, seconds_global;      // since the solver was made
    double seconds_prepare, seconds_factorise; // the latter within the former
    double seconds_anderson;
    int jumps_refused; // by the safeguard of the acceleration
} ax_solver_counters;
ax_solver_counters ax_solver_count(const ax_solver* solver);
