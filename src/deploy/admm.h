// The projective stage of a deployment: the alternating direction method of multipliers with rigid edges as hard constraints.
#pragma once

#include "base/pool.h"
#include "deploy/model.h"

typedef struct ax_admm ax_admm;

// One scalar factorisation of the edge Laplacian serves the whole run. `x` (hinges x 3) is the start and is copied, `pool` is
// borrowed; NULL: one thread.
ax_admm* ax_admm_make(const ax_deploy_model* model, const double (*x)[3], ax_pool* pool);
void ax_admm_free(ax_admm* admm);

// Starts the multipliers from edge forces instead of zero.
void ax_admm_set_forces(ax_admm* admm, const double* force);

typedef struct ax_residuals {
    double edge;  // largest relative edge error, and distance of a sliding hinge from its curve or plane
    double force; // |gradient + J' force| in the directions in which hinges can move / load
} ax_residuals;

// Hinges on curves stay where they start until they are released.
void ax_admm_release(ax_admm* admm);

// Iterates until both residuals are at most `level`, at most `iterations` times, or until they stand still far above. False if cancelled.
bool ax_admm_run(ax_admm* admm, double level, int iterations, const ax_progress* progress, ax_residuals* residuals);

const double (*ax_admm_places(const ax_admm* admm))[3];
void ax_admm_forces(const ax_admm* admm, double* force); // edge_count, tension positive
int ax_admm_iterations(const ax_admm* admm);
