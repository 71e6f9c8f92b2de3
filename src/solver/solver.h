// Projective (local/global) solver: constraints project their rows independently, one linear solve brings all points together.
//   min over x of  sum_c w_c |A_c x - p_c|^2 + (m / h^2) |x - s|^2 - 2 f . x,   p_c the nearest admissible rows to A_c x
// Bouaziz et al. 2012 (Shape-Up), 2014 (Projective Dynamics); with multipliers it is ADMM (Overby et al. 2017).
//
// Three kinds of change, three prices. A parameter, a target, a load: nothing is factorised. A weight, mass or time step: one
// factorisation. A new group of constraints: one analysis and one factorisation. Counters tell. In the steady state nothing is
// allocated, and results are the same bits for every number of threads.
#pragma once

#include "constraint/constraint_type.h"
#include "linalg/panels.h"

typedef struct ax_solver ax_solver;

// `places` (points x 3) is the start and the rest state that constraints learn from. `pool` is borrowed, NULL: one thread.
ax_solver* ax_solver_make(int points, const double (*places)[3], ax_pool* pool);
void ax_solver_free(ax_solver* solver);

// Adds `count` constraints of one type on `points_each` points each (indices count x points_each) with one weight > 0. `place` is
// the geometry of types that need one, borrowed. Parameters have their defaults and what the type learns from the present
// places. Returns the group.
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
// Forces per point for the static solve, NULL: none. They act as  - 2 f . x  in the energy above.
void ax_solver_set_load(ax_solver* solver, const double (*force)[3]);

// Implicit time integration: one mass for every point, time step, velocity damping (0..1 kept per step) and an acceleration.
// mass 0 turns it off: the static solve.
typedef struct ax_dynamics {
    double mass, time_step, damping, acceleration[3];
} ax_dynamics;
void ax_solver_set_dynamics(ax_solver* solver, const ax_dynamics* dynamics);

// With multipliers (ADMM) constraints end exact instead of balanced against each other; they are kept between calls.
void ax_solver_use_multipliers(ax_solver* solver, bool use);
void ax_solver_reset_multipliers(ax_solver* solver);
// A soft group never carries multipliers: it yields to the others by its weight. Groups start hard.
void ax_solver_set_soft(ax_solver* solver, int group, bool soft);
// Multipliers of all groups, three numbers a row, by group, constraint and row whatever the elimination order is: with the places
// they are all that an iteration depends on.
size_t ax_solver_multiplier_count(const ax_solver* solver);
void ax_solver_get_multipliers(const ax_solver* solver, double* out);
void ax_solver_set_multipliers(ax_solver* solver, const double* multipliers);
// Largest multiplier among the rows of one constraint, a length: far above the edges' own tells of a conflict.
double ax_solver_multiplier(const ax_solver* solver, int group, int constraint);

// Analyses and factorises what has changed; called by the two below. False if the matrix is not positive definite: some point
// is bound by nothing.
bool ax_solver_prepare(ax_solver* solver);
// Plain local/global iterations. False as above.
bool ax_solver_iterate(ax_solver* solver, int iterations);
// One time step of `iterations` inner iterations from s = x + h v + h^2 a; velocities are kept.
bool ax_solver_step(ax_solver* solver, int iterations);

// Energy of the constraints, sum_c w_c |A_c x - p_c|^2 minus the load's work: never rises in a plain static iteration.
double ax_solver_energy(ax_solver* solver);
// Root mean square of |A x - p| over the rows of a group: its residual, in lengths.
double ax_solver_residual(ax_solver* solver, int group);

typedef struct ax_solver_counters {
    int analyses, factorisations, iterations;
    double factor_entries;
    size_t bytes;                         // held by the solver
    size_t bytes_per_solve;               // read by one global solve
    double seconds_local, seconds_global; // since the solver was made
    double seconds_prepare;
} ax_solver_counters;
ax_solver_counters ax_solver_count(const ax_solver* solver);
