// Hinges that a Newton step holds back. Where the sheet is slack, the reduced Hessian is negative in a few directions, each that of one
// hinge or of a few about it; a shift of the whole matrix would hold back the whole sheet for them. Instead these hinges are pinned by
// springs, which make the matrix positive definite. How far each goes, all else following it, is a small dense problem that knows
// their true curvature: it is solved within a reach, downhill where the curvature is negative.
#pragma once

#include "base/vec.h"
#include "linalg/block_factor.h"

enum { AX_PINS = 8 };

typedef struct ax_pins {
    int unknowns, count, hinge[AX_PINS]; // hinges: indices of unknowns
    double spring;
    double (*mode)[3]; // what follows a pinned hinge in each direction, unknowns each
    double slope[3 * AX_PINS], curvature[3 * AX_PINS][3 * AX_PINS]; // of the energy along the modes,
    double damped[3 * AX_PINS][3 * AX_PINS];                        // and with the shift
    double along[3 * AX_PINS];                                      // how far each goes
    bool definite;                                                  // the curvature
} ax_pins;

ax_pins ax_pins_make(int unknowns);
void ax_pins_free(ax_pins* pins);

// False if it is pinned already, or there is no room.
bool ax_pins_add(ax_pins* pins, int hinge);
// After a factorisation has failed: pins the hinges that move most where it came upon negative curvature; `scratch` is one move of all.
// False if there are no more, or no room.
bool ax_pins_find(ax_pins* pins, ax_block_factor* factor, double (*scratch)[3]);
// Adds the springs to the matrix.
void ax_pins_hold(const ax_pins* pins, ax_blocks* matrix);
// a'Db of the springs D.
double ax_pins_held(const ax_pins* pins, const double (*a)[3], const double (*b)[3]);

// Modes, from the factor of the matrix with springs, which has `shift` on its diagonal, and slopes after the step d of that matrix.
void ax_pins_follow(ax_pins* pins, ax_block_factor* factor, double shift, const double (*d)[3]);
// The move along the modes that lowers the energy most while no pin goes further than `reach`; returns by how much.
double ax_pins_move(ax_pins* pins, double reach, double (*move)[3]);
double ax_pins_longest(const ax_pins* pins); // how far the one that goes farthest goes, in one direction
