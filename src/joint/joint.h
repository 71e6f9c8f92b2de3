// The joint solve of the flat and the deployed state: Gauss-Newton with congruence of the two as a hard constraint.
// Konakovic-Lukovic et al. 2018 (the joint optimisation); normal equations condensed by an augmented Lagrangian.
#pragma once

#include "ax/linkage.h"
#include "mesh/closest.h"

typedef struct ax_joint_problem {
    const ax_linkage* linkage;
    const ax_closest* surface; // deployed hinges lie on it
    const ax_polyline* rim;    // rim hinges lie on this curve; NULL: they lie on the surface only
    bool released;             // border triangles may deviate from equilateral
    double mouth_min;          // radians, lower bound of every mouth angle
    double scale_max;          // largest scale factor, which tells what mouths to expect
    int apart_count;           // pairs of panels that would overlap flat without being held apart
    const int (*apart)[2];
} ax_joint_problem;

typedef struct ax_joint_result {
    int steps, factorisations;
    bool converged;
    double congruence; // largest relative difference of an edge, flat against deployed
} ax_joint_result;

// Solves from the given states (hinge_count points each), which are replaced by the solution; the start must be near it, as
// the twisted conformal lattice and its lift are. AX_CANCELLED leaves them unchanged. A solve that does not reach a congruence
// of 1e-10 returns AX_OK with converged = false and the best state found.
ax_status ax_joint_solve(const ax_joint_problem* problem, double (*flat)[2], double (*deployed)[3],
                         const ax_progress* progress, ax_joint_result* result, ax_error* error);
