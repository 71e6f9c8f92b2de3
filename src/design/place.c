#include "design/place.h"

#include "base/vec.h"

#include <math.h>
#include <stdio.h>

const char* ax_design_name_place(const ax_design* d, int triangle, char text[96])
{
    char panel[16];
    const int* corner = d->linkage.triangles[triangle];
    double at[3] = {0}, rounding = 1e-9 * ax_distance3(d->deployed[corner[0]], d->deployed[corner[1]]);
    ax_panel_name(&d->linkage, triangle, panel);
    for (int k = 0; k < 3; ++k)
        for (int c = 0; c < 3; ++c)
            at[c] += d->deployed[corner[k]][c] / 3;
    for (int c = 0; c < 3; ++c)
        at[c] = fabs(at[c]) < rounding ? 0 : at[c];
    snprintf(text, 96, "panel %s at (%.3g, %.3g, %.3g)", panel, at[0], at[1], at[2]);
    return text;
}
