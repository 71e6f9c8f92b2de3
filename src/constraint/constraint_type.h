// A constraint type: one file in src/constraint/types, found by the build, named by its file.
//
// A constraint sees rows y = A x of the points it binds and returns the nearest rows p that satisfy it (Bouaziz et al.
// 2012, Shape-Up; 2014, Projective Dynamics). Which rows, is one of a few patterns below, so the solver's matrix
// depends on the pattern and the weight alone and never on a parameter: changing a length, a target or a curve
// factorises nothing. Rows are in absolute lengths for the same reason.
//
// AX_W constraints of one type and one number of points are projected side by side: [row][x, y, z][lane]. A type is
// pure arithmetic on lanes: no allocation, no state, no lane sees another, finite rows for every finite input up to
// AX_HUGE in size (beyond it squares and cubes overflow).
#pragma once

#include "base/vec.h"

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

// AX_MOST_POINTS: a straight line of hinges in a sheet of a million triangles.
enum { AX_W = 8, AX_MOST_POINTS = 1024 };
#define AX_HUGE 1e90
typedef double ax_lane[AX_W];
typedef ax_lane ax_lane3[3]; // x, y, z of one row, AX_W constraints side by side

// A point may stand in several places of one constraint.
typedef enum ax_row_pattern {
    AX_ROWS_POINTS,  // n rows: the points themselves
    AX_ROWS_CENTRED, // n rows: the points minus their mean, for what does not care where it is; p has mean 0 if y has
    AX_ROWS_EDGES,   // n / 2 rows: x1 - x0, x3 - x2, ...
    AX_ROWS_ARMS,    // n - 1 rows: x1 - x0, x2 - x0, ...
    AX_ROWS_SUM,     // 1 row: the sum of coefficient(n, k) x_k
} ax_row_pattern;

// What must hold for every instance of a type with its parameters left alone; the contract test checks it. With
// lengths, points and directions among the parameters moved along, every type follows every motion of space (of the
// plane z = 0 if `flat`).
enum { AX_SYMMETRY_TRANSLATION = 1, AX_SYMMETRY_ROTATION = 2, AX_SYMMETRY_SCALE = 4 };

// One parameter of a type: `lanes` doubles per constraint starting at lane `offset` of its block. Units: "1", "length",
// "area", "rad", "point" (3 lanes) and "direction" (3 lanes, of any length).
typedef struct ax_parameter {
    const char *name, *unit, *doc;
    double standard, least, most; // default and range of each lane; the default direction is +z
    int offset, lanes;
} ax_parameter;

// Geometry shared by many constraints of one group (a curve, a surface): nearest point of it. Thread safe, pure.
typedef struct ax_place {
    void (*nearest)(const void* geometry, const double x[3], double out[3]);
    const void* geometry; // borrowed
    // Curves only: the same with the length along it, the point at a length, and the length at which a closed curve begins again (0: open).
    double (*parameter)(const void* geometry, const double x[3], double out[3]);
    void (*point)(const void* geometry, double t, double out[3]);
    double period;
} ax_place;

typedef struct ax_constraint_type {
    const char *name, *doc, *reference; // key in recipes, tool tip, paper
    ax_row_pattern pattern;
    int least_points, most_points;
    int symmetry;
    bool flat;        // lives in the plane z = 0: reads x and y, returns z = 0
    bool partly_flat; // some of its rows live there
    bool approximate; // p is admissible, and y stays if it is, but p is only nearly the nearest; `doc` says how
    bool needs_place; // project() asks the group's geometry
    bool vanishes;    // p is 0 whatever y: without multipliers such rows are in the matrix alone
    bool eliminated;  // one point, always exactly at p: the solver takes it out of the unknowns
    int lanes; // per block of AX_W constraints: parameter k of constraint l is block[k][l], prepared lanes after them
    const ax_parameter* parameters;
    int parameter_count;
    double (*coefficient)(int points, int point); // AX_ROWS_SUM
    // Fills the parameters that describe a rest shape from the points at rest, all lanes (NULL: there are none).
    void (*rest)(ax_lane* restrict block, int points, const ax_lane3* restrict x);
    // Derives the prepared lanes from the parameters, all lanes; due after any of them has changed (NULL: there are none).
    void (*prepare)(ax_lane* restrict block, int points);
    // p = nearest admissible rows to y. `place` is the group's geometry, NULL for types without one.
    void (*project)(const ax_lane* restrict block, const ax_place* place, int points, const ax_lane3* restrict y,
                    ax_lane3* restrict p);
} ax_constraint_type;

// Number of rows of a constraint on `points` points.
static inline int ax_row_count(const ax_constraint_type* type, int points)
{
    switch (type->pattern) {
    case AX_ROWS_POINTS:
    case AX_ROWS_CENTRED:
        return points;
    case AX_ROWS_EDGES:
        return points / 2;
    case AX_ROWS_ARMS:
        return points - 1;
    default:
        return 1;
    }
}

// Entry of A: how much of point `point` is in row `row`.
static inline double ax_row_coefficient(const ax_constraint_type* type, int points, int row, int point)
{
    switch (type->pattern) {
    case AX_ROWS_POINTS:
        return row == point;
    case AX_ROWS_CENTRED:
        return (row == point) - 1.0 / points;
    case AX_ROWS_EDGES:
        return point == 2 * row + 1 ? 1 : point == 2 * row ? -1 : 0;
    case AX_ROWS_ARMS:
        return point == row + 1 ? 1 : point == 0 ? -1 : 0;
    default:
        return type->coefficient(points, point);
    }
}

// All types, in order of their names, written by the build; and one by name, NULL if there is none.
const ax_constraint_type* const* ax_constraint_types(int* count);
const ax_constraint_type* ax_constraint_find(const char* name);

// A parameter by name, NULL if there is none.
const ax_parameter* ax_parameter_find(const ax_constraint_type* type, const char* name);

// Sets every parameter of a block to its default and prepares it.
void ax_constraint_defaults(const ax_constraint_type* type, int points, ax_lane* block);
