// States between flat and open, with rigid panels.
//
// Of a design that has been simulated they are taken from a simulation in time: supports go from the flat sheet to where they end
// while the load opens the holes. Such a state's panels are not quite rigid; the projective solver finds the linkage of rigid panels
// whose middles are nearest to it. Without a load the panels' middles go straight from where they lie to where they end.
#pragma once

#include "ax/design.h"
#include "base/pool.h"

typedef struct ax_way ax_way;

// Ends at the simulated state, if there is one, else at the deployed one. `pool` is borrowed.
ax_way* ax_way_make(const ax_design* design, ax_pool* pool);
void ax_way_free(ax_way* way);

typedef struct ax_way_state {
    const double (*places)[3]; // of hinges, document units; until the next call
    double error;              // largest relative error of an edge
    // of the simulation, before panels were made rigid: largest relative error of an edge, largest distance of a hinge from there
    double strain, moved;
} ax_way_state;

// At `t`, 0 flat, 1 open: of the simulation, the time. It goes on from the state asked before. False if cancelled.
bool ax_way_at(ax_way* way, double t, const ax_progress* progress, ax_way_state* state);
