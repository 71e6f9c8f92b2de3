// The rigid linkage under a load: edges of fixed length, supports, and the energy of gravity or inflation.
//
// Lengths are in units of the mean edge, the total load is 1, so every tolerance below is a pure number. With
// c_e(x) = (|x_i - x_j|^2 / l - l) / 2 the gradient at a feasible state is a unit vector, so the multiplier of an edge is its axial
// force, tension positive, and the Hessian of lambda c is the constant lambda / l [I -I; -I I].
#pragma once

#include "ax/linkage.h"
#include "linalg/sparse.h"

typedef struct ax_deploy_model {
    int hinges, unknowns; // unknowns: free hinges
    int* unknown;         // per hinge: index among the free ones, -1 if supported
    int* hinge;           // per free hinge: its hinge
    int edge_count;       // edges with at least one free end
    int (*edge)[2];
    double* length;
    int* edge_source;     // 3 triangle + corner of each
    double (*rest)[2];    // flat places, per hinge
    double (*support)[3]; // places of the supported hinges (others are not read)
    bool inflated;
    double (*gravity)[3]; // force per hinge, sum of magnitudes 1 (zero when inflated)
    double pressure;      // such that pressure times four times the panel area is 1 (zero under gravity)
    int polygon_count;    // panels, holes and openings, the closed surface that the pressure acts on
    int *polygon_start, *polygon;
    double origin[3];                 // apex of the volume: an unsupported rim is closed by a membrane to this point
    double tension;                   // mean edge force to expect: load x edge / length of the rim
    double unit;                      // document length of one
    double centre[3], flat_centre[2]; // document places of the origins
} ax_deploy_model;

// `flat` and `supported_places` are hinge_count points in document units; places of unsupported hinges are not read.
// `direction` is the unit vector of gravity, NULL for inflation. `unit_load` receives the document's own load for solver load
// 1: for gravity the panel area (times density and g it is N), for inflation four times it (times pressure).
ax_deploy_model ax_deploy_model_make(const ax_linkage* linkage, const double (*flat)[2],
                                     const double (*supported_places)[3], const unsigned char* supports,
                                     const double direction[3], double* unit_load);
void ax_deploy_model_free(ax_deploy_model* model);

// Energy and its gradient (per hinge, supported ones included); gradient may be NULL.
double ax_deploy_energy(const ax_deploy_model* model, const double (*x)[3], double (*gradient)[3]);

// Constraint values c_e.
void ax_deploy_constraints(const ax_deploy_model* model, const double (*x)[3], double* c);
// Largest relative edge error | |d| / l - 1 |.
double ax_deploy_edge_error(const ax_deploy_model* model, const double (*x)[3]);
// gradient += J'(x) force.
void ax_deploy_add_edge_forces(const ax_deploy_model* model, const double (*x)[3], const double* force,
                               double (*gradient)[3]);

// The matrix H(lambda) - p V'' + shift I + mu J'J over the free hinges.
typedef struct ax_deploy_hessian {
    ax_blocks blocks;
    int* edge_block;    // per edge, -1 if one end is supported
    int* polygon_block; // per polygon, its pairs in order (first < second position), -1 if an end is supported
    int* polygon_block_start;
} ax_deploy_hessian;
ax_deploy_hessian ax_deploy_hessian_make(const ax_deploy_model* model);
void ax_deploy_hessian_free(ax_deploy_hessian* hessian);
void ax_deploy_hessian_fill(ax_deploy_hessian* hessian, const ax_deploy_model* model, const double (*x)[3],
                            const double* force, double shift, double mu);

// Start from the flat state alone: aligned with the supports, their displacement spread harmonically, and a small
// reproducible noise that leaves the plane.
void ax_deploy_start(const ax_deploy_model* model, double noise, double (*x)[3]);
