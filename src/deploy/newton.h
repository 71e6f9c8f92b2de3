// The exact stage of a deployment: primal-dual Newton with edge lengths as hard constraints.
#pragma once

#include "deploy/admm.h"

typedef struct ax_newton ax_newton;

// Analyses the matrix once; several runs share it. `pool` is borrowed; NULL: one thread.
ax_newton* ax_newton_make(const ax_deploy_model* model, ax_pool* pool);
void ax_newton_free(ax_newton* newton);

typedef struct ax_newton_result {
    bool reached; // both residuals are small enough
    bool exact;   // at most AX_NEWTON_EXACT
    bool stable;  // and the reduced Hessian is positive definite there
    bool cancelled;
    int steps, factorisations;
    ax_residuals residuals;
    double energy;
} ax_newton_result;

// From places x (hinges x 3) and edge forces, both replaced by the last accepted iterate, until both residuals are at most `enough`;
// AX_NEWTON_EXACT is as small as can be reached.
#define AX_NEWTON_EXACT 1e-10
ax_newton_result ax_newton_run(ax_newton* newton, double (*x)[3], double* force, double enough, int most_steps,
                               const ax_progress* progress);

// Edge forces that balance the load best in the least-squares sense at x, for a start without multipliers.
void ax_newton_fit_forces(ax_newton* newton, const double (*x)[3], double* force);
