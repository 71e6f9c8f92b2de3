// A sheet as a surface in the plane, to find places on and to carry what its hinges have to other places.
#pragma once

#include "form/state.h"

typedef struct ax_sheet_map {
    const ax_form* form;
    ax_mesh cover;
    ax_closest* tree;
    int rim_count, *rim_hinges; // in their order round it
    ax_polyline* rim;
} ax_sheet_map;

ax_sheet_map* ax_sheet_map_make(const ax_form* form);
void ax_sheet_map_free(ax_sheet_map* map);

// Values that the hinges of the sheet have, at `count` places on it: linear on its cover, and on beyond its rim.
void ax_sheet_map_carry(const ax_sheet_map* map, const double (*values)[3], int count, const double (*places)[2],
                        double (*out)[3]);
