#include "ax/linkage.h"

#include <assert.h>
#include <stdio.h>
#include <stdlib.h>

void ax_linkage_free(ax_linkage* linkage)
{
    if (!linkage)
        return;
    ax_free(linkage->triangles);
    ax_free(linkage->panels);
    ax_free(linkage->hole_start);
    ax_free(linkage->hole_hinges);
    ax_free(linkage->opening_start);
    ax_free(linkage->opening_hinges);
    ax_free(linkage->on_rim);
    *linkage = (ax_linkage){0};
}

static int* copy_loops(const int* start, int count, const int* hinges, int** out_hinges)
{
    *out_hinges = start ? ax_copy(hinges, (size_t)start[count], sizeof *hinges) : NULL;
    return ax_copy(start, (size_t)count + 1, sizeof *start);
}

ax_linkage ax_linkage_copy(const ax_linkage* linkage)
{
    ax_linkage copy = *linkage;
    copy.triangles = ax_copy(linkage->triangles, (size_t)linkage->triangle_count, sizeof *linkage->triangles);
    copy.panels = ax_copy(linkage->panels, (size_t)linkage->triangle_count, sizeof *linkage->panels);
    copy.hole_start = copy_loops(linkage->hole_start, linkage->hole_count, linkage->hole_hinges, &copy.hole_hinges);
    copy.opening_start =
        copy_loops(linkage->opening_start, linkage->opening_count, linkage->opening_hinges, &copy.opening_hinges);
    copy.on_rim = ax_copy(linkage->on_rim, (size_t)linkage->hinge_count, sizeof *linkage->on_rim);
    return copy;
}

// Rows count A, B, ... Z, AA, ... from row 0 up and -A, -B, ... from row -1 down; places within a row 1, 2, ... and -1, -2, ...
// likewise. Names that were counted from the first row in use would change with every edit of the rim.
void ax_panel_name(const ax_linkage* linkage, int triangle, char text[16])
{
    assert(triangle >= 0 && triangle < linkage->triangle_count);
    const int* panel = linkage->panels[triangle];
    int row = panel[1], place = 2 * panel[0] + panel[2];
    assert(abs(row) <= AX_PANEL_LIMIT && abs(panel[0]) <= AX_PANEL_LIMIT); // else the text is too short
    char letters[8];
    char* first = letters + sizeof letters - 1;
    *first = '\0';
    for (int n = row < 0 ? -row : row + 1; n > 0; n = (n - 1) / 26) // bijective base 26: after Z comes AA
        *--first = (char)('A' + (n - 1) % 26);
    snprintf(text, 16, "%s%s%d", row < 0 ? "-" : "", first, place < 0 ? place : place + 1);
}
