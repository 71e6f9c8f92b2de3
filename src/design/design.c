#include "ax/design.h"

#include <assert.h>
#include <string.h>

static const struct {
    const char* name;
    double metres;
} units[] = {[AX_MILLIMETRE] = {"mm", 1e-3}, [AX_CENTIMETRE] = {"cm", 1e-2}, [AX_METRE] = {"m", 1}};

static const size_t unit_count = sizeof units / sizeof *units;

const char* ax_unit_name(ax_unit unit)
{
    assert((size_t)unit < unit_count);
    return units[unit].name;
}

double ax_unit_in_metres(ax_unit unit)
{
    assert((size_t)unit < unit_count);
    return units[unit].metres;
}

bool ax_unit_parse(const char* name, ax_unit* unit)
{
    for (size_t k = 0; k < unit_count; ++k)
        if (strcmp(name, units[k].name) == 0) {
            *unit = (ax_unit)k;
            return true;
        }
    return false;
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
    ax_free(design->forces);
    ax_free(design->edge_forces);
    *design = (ax_design){0};
}
