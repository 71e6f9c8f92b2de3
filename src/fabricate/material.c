// Stock in common use. Densities, moduli and strengths are round figures of makers' data sheets for the weaker direction; kerfs
// are those of a CO2 laser of 40 to 100 W (fabric and leather: of a knife).
#include "ax/fabricate.h"

#include <string.h>

static const ax_material materials[] = {
    {"card-0.5", "card, 350 g/m2", 0.5, 700, 0.1, 0.8, 20, 2500, true},
    {"greyboard-2", "grey board", 2, 650, 0.15, 2, 8, 1500, false},
    {"polypropylene-0.8", "polypropylene sheet, which makes lasting hinges", 0.8, 905, 0.2, 0.8, 30, 1300, true},
    {"polypropylene-3", "polypropylene sheet, stiff; its hinges want a trial", 3, 905, 0.2, 2, 30, 1300, true},
    {"leather-2", "vegetable-tanned leather", 2, 900, 0.1, 2, 15, 60, true},
    {"felt-3", "wool felt", 3, 300, 0.2, 4, 2, 5, true},
    {"rubber-3", "natural rubber sheet", 3, 950, 0.2, 2, 10, 3, true},
    {"plywood-3", "birch plywood, 3 ply", 3, 680, 0.2, 2, 30, 6000, false},
    {"plywood-6", "birch plywood, 5 ply", 6, 680, 0.25, 3, 30, 6000, false},
    {"mdf-3", "MDF", 3, 780, 0.2, 2, 15, 3000, false},
    {"acrylic-3", "cast acrylic", 3, 1190, 0.2, 2, 60, 3200, false},
    {"aluminium-1.5", "aluminium sheet, fibre laser", 1.5, 2700, 0.15, 1.5, 180, 70000, false},
    {"steel-1", "steel sheet, fibre laser", 1, 7850, 0.15, 1, 235, 210000, false},
};

const ax_material* ax_materials(int* count)
{
    *count = (int)(sizeof materials / sizeof *materials);
    return materials;
}

const ax_material* ax_material_named(const char* name)
{
    int count;
    const ax_material* all = ax_materials(&count);
    for (int k = 0; k < count; ++k)
        if (strcmp(all[k].name, name) == 0)
            return &all[k];
    return NULL;
}
