// Deployment of the flat linkage under gravity or inflation to the exact rigid limit. Reads the flat state, the supports' places
// and the load, nothing else.
#pragma once

#include "deploy/newton.h"

// How the exact state was reached.
typedef enum ax_opening {
    AX_NOT_OPENED,
    AX_OPENED_AT_ONCE,   // from flat, supports at their places from the beginning
    AX_OPENED_INFLATED,  // from flat by inflation, then under the weight
    AX_OPENED_IN_STAGES, // from flat, the supports moved to their places by and by
    AX_OPENED_DESIGNED,  // from the designed state: an equilibrium, but none that the flat sheet has been seen to reach
} ax_opening;
enum { AX_OPENING_STAGES = 4 };

typedef struct ax_deployment {
    bool exact; // edge error and force residual at most 1e-10, and stable
    ax_opening opening;
    bool stable;
    ax_residuals residuals;
    double energy;             // of the normalised problem: load 1, edge 1
    double force_over_tension; // largest edge force over load x edge / rim: thousands tell of supports too far apart
    // Smallest and largest gap between neighbours on their curve, in length and over the mean; 1 where nothing slides on
    // curves. Below 0: hinges have passed each other, and the state is not exact whatever its residuals.
    double gap_least, gap_most;
    int tightest, furthest; // edges with the largest force and furthest from their length, where the first way up led
    bool taut;     // edges reach their lengths only as forces grow without bound: the sheet has no room to bulge
    bool gathered; // hinges leave a part of their curve bare: it is longer than the linkage can reach. Not exact either
    int projective_steps, newton_steps, factorisations;
} ax_deployment;

// Solves `model`. `designed` (hinges x 3, model units; NULL: none) is looked at only where the flat sheet does not reach an equilibrium, and
// only if it has the right edges; its supported hinges are where the supports are. x receives hinge places (hinges x 3, model units) and force the edge forces (edge_count), both valid only if
// exact. False only if cancelled.
bool ax_deploy(const ax_deploy_model* model, const double (*designed)[3], double (*x)[3], double* force,
               const ax_progress* progress, ax_deployment* result);
