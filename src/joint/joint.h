// The joint solve of the flat and the deployed state: Gauss-Newton with congruence of the two as a hard constraint.
// Konakovic-Lukovic et al. 2018 (the joint optimisation); normal equations condensed by an augmented Lagrangian.
#pragma once

#include "ax/linkage.h"
#include "constraint/place.h"
#include "mesh/closest.h"

// Where one deployed hinge is to lie. What is pointed to is borrowed, and in document units.
typedef enum ax_joint_place_kind {
    AX_JOINT_FREE,
    AX_JOINT_ON_SURFACE,
    AX_JOINT_ON_POLYLINE, // a finely faceted smooth curve: its tangents are interpolated
    AX_JOINT_ON_CURVE,
    AX_JOINT_FIXED, // where the deployed state has it at the start
} ax_joint_place_kind;

typedef struct ax_joint_place {
    ax_joint_place_kind kind;
    union {
        const ax_closest* surface;
        const ax_polyline* polyline;
        const ax_curve* curve;
    };
} ax_joint_place;

// Deployed hinges that are to lie in one plane, beside the place that each may have: a given plane, or whichever fits best
// (through the fixed ones among them, if there are any).
typedef struct ax_joint_plane {
    int count;
    const int* hinges; // borrowed
    bool given;
    double point[3], normal[3]; // of a given plane; the normal of any length
} ax_joint_plane;

typedef struct ax_joint_problem {
    const ax_linkage* linkage;
    const ax_joint_place* places; // per hinge; NULL: all are free
    int plane_count;
    const ax_joint_plane* planes;
    double border_unequal; // edges of a border triangle may differ by up to this share of their mean: 0 equilateral,
                           // INFINITY whatever fits
    double mouth_min;      // radians, lower bound of every mouth angle
    double scale_max;      // largest scale factor, which tells what mouths to expect; 2: no more than mouth_min
    int apart_count;       // pairs of panels that would overlap flat without being held apart
    const int (*apart)[2];
    // For looking at, with the states that a step starts from; called before progress is reported. NULL: nobody looks.
    void (*look)(void* context, const double (*flat)[2], const double (*deployed)[3]);
    void* looking;
} ax_joint_problem;

typedef struct ax_joint_result {
    int steps, factorisations;
    bool converged;    // congruence within 1e-10
    double congruence; // largest relative difference of an edge, flat against deployed
    int congruence_at; // the panel that has it
    double off_place;  // largest distance of a deployed hinge from its surface, curve, place or plane, in mean edges
    double unequal;    // largest difference of two edges of a triangle over its mean edge, beyond what it may have
} ax_joint_result;

// Solves from the given states (hinge_count points each), which are replaced by the solution; the start must be near it, as
// the twisted conformal lattice and its lift are, or states that projective steps have settled to a few per cent. Of the many
// solutions the one near the start is found: what no row asks for stays. AX_CANCELLED leaves them unchanged. A solve that does
// not reach a congruence of 1e-10 returns AX_OK with converged = false and the best state found; places and planes that
// contradict each other show in off_place.
ax_status ax_joint_solve(const ax_joint_problem* problem, double (*flat)[2], double (*deployed)[3],
                         const ax_progress* progress, ax_joint_result* result, ax_error* error);
