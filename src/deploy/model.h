// The rigid linkage under a load: edges of fixed length, supports, and the energy of gravity or inflation.
//
// Lengths are in units of the mean edge, the total load is 1, so every tolerance below is a pure number. With
// c_e(x) = (|x_i - x_j|^2 / l - l) / 2 the gradient at a feasible state is a unit vector, so the multiplier of an edge is its axial
// force, tension positive, and the Hessian of lambda c is the constant lambda / l [I -I; -I I].
#pragma once

#include "ax/linkage.h"
#include "constraint/place.h"
#include "linalg/sparse.h"

// How a support holds a hinge. One in a plane and on a curve besides is on the line or the point where they meet.
typedef enum ax_hold_kind { AX_HOLD_FREE, AX_HOLD_FIXED, AX_HOLD_ON_CURVE, AX_HOLD_IN_PLANE } ax_hold_kind;

typedef struct ax_hold {
    ax_hold_kind kind;
    const ax_curve* curve; // ON_CURVE, without friction: borrowed, document units
    double normal[3];      // IN_PLANE, unit: the plane goes through the place given for the hinge
} ax_hold;

// A row of hinges that should lie evenly: energy stiffness / 2 |sum of coefficient x place|^2, a little of which decides where the
// rigid linkage alone leaves it open how slack parts lie.
typedef struct ax_fair_row {
    int points, hinge[4];
    double coefficient[4], stiffness;
} ax_fair_row;

typedef struct ax_deploy_model {
    int hinges, unknowns; // unknowns: hinges that are not fixed
    int* unknown;         // per hinge: index among those, -1 if fixed
    int* hinge;           // per unknown: its hinge
    int slide_count;      // hinges on curves and in planes
    int* slide;           // their hinges
    ax_hold* hold;        // per hinge
    int edge_count;       // edges with at least one free end
    int (*edge)[2];
    double* length;
    int* edge_source;     // 3 triangle + corner of each
    double (*rest)[2];    // flat places, per hinge
    double (*support)[3]; // places of fixed hinges, start of those on curves, a point of the plane of those in planes
    bool inflated;
    double (*gravity)[3]; // force per hinge, sum of magnitudes 1 (zero when inflated)
    double pressure;      // such that pressure times four times the panel area is 1 (zero under gravity)
    int polygon_count;    // panels, holes and openings, the closed surface that the pressure acts on
    int *polygon_start, *polygon;
    int fair_count;
    ax_fair_row* fair;                // none at first
    double tension;                   // mean edge force to expect: load x edge / length of the rim
    double unit;                      // document length of one
    double centre[3], flat_centre[2]; // document places of the origins
} ax_deploy_model;

// `flat` and `places` are hinge_count points in document units; places of free hinges are not read. Hinges on a curve are
// opened where they start, so that they keep their spread along it, and then released.
// `direction` is the unit vector of gravity, NULL for inflation. `unit_load` receives the document's own load for solver load
// 1: for gravity the panel area (times density and g it is N), for inflation four times it (times pressure).
ax_deploy_model ax_deploy_model_make(const ax_linkage* linkage, const double (*flat)[2], const double (*places)[3],
                                     const ax_hold* holds, const double direction[3], double* unit_load);
void ax_deploy_model_free(ax_deploy_model* model);

// Adds `count` rows to keep fair, hinges count x points. `stiffness` is in total loads over document lengths.
void ax_deploy_model_keep_fair(ax_deploy_model* model, int count, int points, const int* hinges,
                               const double* coefficients, double stiffness);

// Is a hinge held at a known place at first, fixed or on a curve?
static inline bool ax_deploy_placed(const ax_deploy_model* model, int h)
{
    return model->hold[h].kind == AX_HOLD_FIXED || model->hold[h].kind == AX_HOLD_ON_CURVE;
}

// Puts x[h], near its curve or plane, back on it. On a curve with corners it goes no further than to the next corner from
// `from` on, where the direction is chosen anew.
void ax_deploy_return(const ax_deploy_model* model, int h, const double from[3], double x[3]);

// Length along its curve, document units, to the point nearest to a place of hinge h.
double ax_deploy_along(const ax_deploy_model* model, int h, const double x[3]);

// The directions in which hinge slide[k] can move: out = allowed v is the part of v along its curve or plane, nothing at a
// corner or an end towards which it is pulled from both sides.
typedef struct ax_deploy_frame {
    double allowed[3][3];
    // Second derivative of `gradient` . x along the curve, which bends the energy though its gradient is constant.
    double bend;
} ax_deploy_frame;
// `gradient` of the Lagrangian, per hinge.
void ax_deploy_frames(const ax_deploy_model* model, const double (*x)[3], const double (*gradient)[3],
                      ax_deploy_frame* frame);
// v, per hinge, loses at hinges that slide what is not allowed.
void ax_deploy_allow(const ax_deploy_model* model, const ax_deploy_frame* frame, double (*v)[3]);

// Energy and its gradient (per hinge, supported ones included); gradient may be NULL.
double ax_deploy_energy(const ax_deploy_model* model, const double (*x)[3], double (*gradient)[3]);

// Constraint values c_e.
void ax_deploy_constraints(const ax_deploy_model* model, const double (*x)[3], double* c);
// Largest relative edge error | |d| / l - 1 |.
double ax_deploy_edge_error(const ax_deploy_model* model, const double (*x)[3]);
// gradient += J'(x) force.
void ax_deploy_add_edge_forces(const ax_deploy_model* model, const double (*x)[3], const double* force,
                               double (*gradient)[3]);

// The matrix H(lambda) - p V'' + shift I + mu J'J over the unknown hinges; directions that are not allowed stand for themselves
// with stiffness mu. `frame` may be NULL where nothing slides.
typedef struct ax_deploy_hessian {
    ax_blocks blocks;
    int* edge_block;    // per edge, -1 if one end is supported
    int* polygon_block; // per polygon, its pairs in order (first < second position), -1 if an end is supported
    int* polygon_block_start;
    int (*fair_block)[6]; // per fair row, its pairs in order (first < second position)
    int* slide;           // per unknown: its index among those that slide, -1 if it does not
} ax_deploy_hessian;
ax_deploy_hessian ax_deploy_hessian_make(const ax_deploy_model* model);
void ax_deploy_hessian_free(ax_deploy_hessian* hessian);
void ax_deploy_hessian_fill(ax_deploy_hessian* hessian, const ax_deploy_model* model, const double (*x)[3],
                            const ax_deploy_frame* frame, const double* force, double shift, double mu);

// The flat state in space, turned as the supports are.
void ax_deploy_lay(const ax_deploy_model* model, double (*x)[3]);

// Start from the flat state alone: aligned with the supports, their displacement spread harmonically, and a small
// reproducible noise that leaves the plane.
void ax_deploy_start(const ax_deploy_model* model, double noise, double (*x)[3]);
