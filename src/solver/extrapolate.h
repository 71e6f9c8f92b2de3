// Where a slowly converging iteration is heading, from a few of its states: reduced rank extrapolation (Mesina 1977; Sidi, Vector
// Extrapolation Methods with Applications, 2017, chapter 2). Of states z_0 .. z_m, the combination sum c_k z_(k+1), sum c_k = 1, whose
// combined step sum c_k (z_(k+1) - z_k) is shortest: exact where m - 1 slow modes are left.
#pragma once

#include <stdbool.h>
#include <stddef.h>

typedef struct ax_extrapolation ax_extrapolation;

// For states of `size` numbers each, `most` of them at once, 3 to AX_MOST_STATES. Owned by the caller.
enum { AX_MOST_STATES = 8 };
ax_extrapolation* ax_extrapolation_make(size_t size, int most);
void ax_extrapolation_free(ax_extrapolation* e); // NULL is ignored

// Room for the next state, to be filled by the caller; all earlier ones are dropped if there are `most`.
double* ax_extrapolation_next(ax_extrapolation* e);
void ax_extrapolation_clear(ax_extrapolation* e); // drops all states
// The state that was filled last, if there is one.
const double* ax_extrapolation_last(const ax_extrapolation* e);
// The limit of the states kept, `size` numbers, valid until the next call; NULL if there are fewer than `most` or they show none.
const double* ax_extrapolation_limit(ax_extrapolation* e);
