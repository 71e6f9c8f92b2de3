// Deployment of the flat linkage under gravity or inflation to the exact rigid limit. Reads the flat state, the supports' places
// and the load, nothing else.
#pragma once

#include "deploy/newton.h"

typedef struct ax_deployment {
    bool exact; // edge error and force residual at most 1e-10, and stable
    bool stable;
    ax_residuals residuals;
    double energy;             // of the normalised problem: load 1, edge 1
    double force_over_tension; // largest edge force over load x edge / rim: thousands tell of supports too far apart
    // Smallest and largest gap between neighbours on their curve, in length and over the mean; 1 where nothing slides on
    // curves. Below 0: hinges have passed each other, and the state is not exact whatever its residuals.
    double gap_least, gap_most;
    bool gathered; // hinges leave a part of their curve bare: it is longer than the linkage can reach. Not exact either
    int projective_steps, newton_steps, factorisations;
} ax_deployment;

// Solves `model`; x receives hinge places (hinges x 3, model units) and force the edge forces (edge_count), both valid only if
// exact. False only if cancelled.
bool ax_deploy(const ax_deploy_model* model, double (*x)[3], double* force, const ax_progress* progress,
               ax_deployment* result);
