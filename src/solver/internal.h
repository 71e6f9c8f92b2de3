// What the files of the solver share. Points are kept in elimination order; constraints and loops in an order that follows it, so that
// neighbours in memory work on neighbours in space.
#pragma once

#include "solver/anderson.h"
#include "solver/solver.h"

enum { CHUNK = 64, POINTS_PER_TASK = 1024 }; // blocks of elements and points that one task takes

// Constraints or loops of one number of points, AX_W to a block.
typedef struct elements {
    int points_each, count, blocks;
    int* slot;     // element -> slot; slot / AX_W is its block, slot % AX_W its lane
    int* index;    // per block: [point][lane], places in elimination order; spare lanes repeat the last element
    int rows_each; // rows that an element writes for the points to sum: one per point, of edges one for both ends
    int first_row, first_task;
} elements;

// Constraints of one type and size.
typedef struct group {
    const ax_constraint_type* type;
    const ax_place* place;
    elements e;
    double weight;
    bool soft;          // no multipliers
    int rows;           // per constraint: rows of A
    ax_lane* parameter; // per block: type->lanes
    ax_lane3* dual;     // per block: rows
} group;

// Loops of one size of a load.
typedef struct load_class {
    elements e;
    ax_lane* area; // per block
} load_class;

typedef struct load {
    const ax_load_type* type;
    double value[AX_MOST_LOAD_VALUES];
    int class_count;
    load_class* classes;
} load;

// Sums of one task over its constraints, loops or points.
typedef struct tally {
    double energy;
    double primal_square, primal_most; // of |A x - p|, per row
    double dual_square, dual_most;     // of |u|, per row
    int capped;
    double residual_square, load_square;
} tally;

struct ax_solver {
    int n, group_count, load_count;
    group* groups;
    load* loads;
    ax_pool* pool;
    // per point as given
    float (*start)[3];        // rest places, for the elimination order
    double (*point_force)[3]; // NULL: none
    double* stiffness;        // diagonal of the matrix
    ax_sparse held_matrix;    // entries between free points and held ones
    // everything below in elimination order
    int *order, *position;
    unsigned char* held; // points that are eliminated
    ax_vec4 *x, *base;
    double (*velocity)[3]; // during a time step the places before it
    ax_vec4* kept; // in accelerated time steps where inertia would take points, in a measurement the forces left; NULL
                   // before the first such
    ax_vec4* dead; // sum of point forces and dead loads, NULL: none
    ax_vec4* row;  // what elements write for the points to sum
    int row_count, first_step_row, first_load_row; // rows before the first of a step are read by measurements only
    int *incident_start, *incident;                // per point: row << 1 | sign
    int* step_start;                               // per point: the first incident row of a step
    tally* tallies;                                // one per task; those of points come last
    int point_tallies;
    ax_panels* panels;
    ax_anderson* anderson;   // NULL: plain iterations
    ax_anderson_part* parts; // room for the places and every group
    bool changed;            // something since the last iteration that the past does not know
    double merit;            // the last energy, or where nothing descends the square of the shortest step
    ax_dynamics dynamics;
    double load_factor, cap, proximal;
    bool dynamic, multipliers, multiplied; // multiplied: some multiplier may not be zero
    bool pattern_changed, values_changed, rows_changed, dead_changed;
    int active_group, active_load, active_class; // what the running tasks work on
    bool tallying, measuring;
    ax_solver_counters counters;
};

// Where `index` has a point of the element in a slot.
static inline size_t place_of(const elements* e, int slot, int point)
{
    return ((size_t)(slot / AX_W) * (size_t)e->points_each + (size_t)point) * AX_W + (size_t)(slot % AX_W);
}

// A point of an element, as given.
static inline int point_of(const ax_solver* s, const elements* e, int element, int point)
{
    return s->order[e->index[place_of(e, e->slot[element], point)]];
}

static inline int task_count(const elements* e)
{
    return (e->blocks + CHUNK - 1) / CHUNK;
}

static inline bool is_hard(const ax_solver* s, const group* g)
{
    return s->multipliers && !g->soft && !g->type->eliminated;
}

// Writes nothing but zeros in a step.
static inline bool is_silent(const group* g)
{
    return g->soft && g->type->vanishes;
}

static inline int point_task_count(const ax_solver* s)
{
    return (s->n + POINTS_PER_TASK - 1) / POINTS_PER_TASK;
}

// Lanes of a block that are not spare.
static inline int live_lanes(const elements* e, int block)
{
    int left = e->count - block * AX_W;
    return left < AX_W ? left : AX_W;
}

// Makes room for `kept`.
void ax_keep(ax_solver* s);

// The local step: every element writes its rows, every point sums them. Afterwards x holds the right-hand side.
void ax_local_step(ax_solver* s);
// Puts the points that are eliminated where they belong.
void ax_pin(ax_solver* s);
// Brings `dead` up to date.
void ax_sum_dead_loads(ax_solver* s);
// The same pass without a step: forces left at the present places go to `kept`, tallies are filled. Sums over
// all constraints of a group, or over the points. Needs a solver that is prepared.
void ax_measure(ax_solver* s);
tally ax_sum_tallies(const ax_solver* s, int first, int count);
