// A load type: one file in src/solver/loads, found by the build, named by its file.
//
// A load acts on loops of points: panels, and the holes and openings between them. A dead load (gravity) is one force per
// point, made when its parameters change. A follower (pressure) is formed anew at the places of every iteration, AX_W loops of one
// number of corners side by side. Neither touches the solver's matrix.
#pragma once

#include "constraint/constraint_type.h"

enum { AX_MOST_LOAD_VALUES = 8 };

typedef struct ax_load_type {
    const char *name, *doc, *reference; // key in recipes, tool tip, paper
    // `offset` counts doubles within a load's values. Units beside those of constraints: "pressure" (force / area),
    // "density" (mass / area) and "acceleration", consistent with the length in use.
    const ax_parameter* parameters;
    int parameter_count, values;
    bool follows;
    // Fills what describes the shape from the centre of its points (NULL: nothing does).
    void (*rest)(double* value, const double centre[3]);
    // Force on every corner of AX_W loops, whose areas are `area` and, of types that follow, the potential energy of each: its
    // gradient is minus the force once the loops close a surface. (A dead load's is -f . x.)
    void (*act)(const double* value, const ax_lane area, int points, const ax_lane3* restrict x,
                ax_lane3* restrict force, ax_lane potential);
} ax_load_type;

// All types, in order of their names, written by the build; and one by name, NULL if there is none.
const ax_load_type* const* ax_load_types(int* count);
const ax_load_type* ax_load_find(const char* name);
