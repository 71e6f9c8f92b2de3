#include "ax/design.h"

#include <assert.h>
#include <string.h>

enum { NAMES = 3 }; // in each of these lists

static const char* const unit_names[NAMES] = {[AX_MILLIMETRE] = "mm", [AX_CENTIMETRE] = "cm", [AX_METRE] = "m"};
static const char* const border_names[NAMES] = {
    [AX_BORDER_EQUILATERAL] = "equilateral", [AX_BORDER_RELEASED] = "released", [AX_BORDER_INSIDE] = "inside"};
static const char* const load_names[NAMES] = {
    [AX_LOAD_NONE] = "none", [AX_LOAD_GRAVITY] = "gravity", [AX_LOAD_INFLATION] = "inflation"};

static const char* name_of(unsigned value, const char* const names[NAMES])
{
    assert(value < NAMES);
    return names[value];
}

static int value_of(const char* name, const char* const names[NAMES])
{
    for (int k = 0; k < NAMES; ++k)
        if (strcmp(name, names[k]) == 0)
            return k;
    return -1;
}

const char* ax_unit_name(ax_unit unit)
{
    return name_of(unit, unit_names);
}

bool ax_unit_parse(const char* name, ax_unit* unit)
{
    int found = value_of(name, unit_names);
    if (found >= 0)
        *unit = (ax_unit)found;
    return found >= 0;
}

double ax_unit_in_metres(ax_unit unit)
{
    static const double metres[NAMES] = {[AX_MILLIMETRE] = 1e-3, [AX_CENTIMETRE] = 1e-2, [AX_METRE] = 1};
    assert((unsigned)unit < NAMES);
    return metres[unit];
}

ax_unit ax_unit_likely(double length, ax_unit unit)
{
    static const ax_unit candidates[] = {AX_METRE, AX_MILLIMETRE, AX_CENTIMETRE};
    const double least = 0.05, most = 1000;
    double given = length * ax_unit_in_metres(unit);
    for (size_t k = 0; k < sizeof candidates / sizeof *candidates && (given < least || given > most); ++k) {
        double metres = length * ax_unit_in_metres(candidates[k]);
        if (metres >= least && metres <= most)
            return candidates[k];
    }
    return unit;
}

const char* ax_border_name(ax_border border)
{
    return name_of(border, border_names);
}

bool ax_border_parse(const char* name, ax_border* border)
{
    int found = value_of(name, border_names);
    if (found >= 0)
        *border = (ax_border)found;
    return found >= 0;
}

const char* ax_load_kind_name(ax_load_kind kind)
{
    return name_of(kind, load_names);
}

bool ax_load_kind_parse(const char* name, ax_load_kind* kind)
{
    int found = value_of(name, load_names);
    if (found >= 0)
        *kind = (ax_load_kind)found;
    return found >= 0;
}

void ax_design_free(ax_design* design)
{
    if (!design)
        return;
    ax_mesh_free(&design->target);
    ax_linkage_free(&design->linkage);
    ax_free(design->flat);
    ax_free(design->deployed);
    ax_free(design->simulated);
    ax_free(design->scale);
    ax_free(design->supports);
    ax_free(design->slides);
    ax_free(design->forces);
    ax_free(design->edge_forces);
    *design = (ax_design){0};
}
