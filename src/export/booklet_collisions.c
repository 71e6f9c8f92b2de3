// Panels that come too close, where there are any.
#include "export/booklet.h"

#include <stdio.h>

static void say_when(const ax_cut_clash* c, char cell[48])
{
    static const char* const states[] = {"flat", "deployed", "simulated"};
    if (c->frame < 0)
        snprintf(cell, 48, "turning at hinge %d", c->hinge);
    else if (c->frame < 3)
        snprintf(cell, 48, "%s", states[c->frame]);
    else
        snprintf(cell, 48, "%.0f %% of the way to open", 100 * c->opening);
}

void ax_booklet_collisions(ax_booklet* b)
{
    static const char* const titles[] = {"Panel", "Panel", "When", "Overlap mm"};
    static const double widths[] = {18, 18, 54, 26};
    const ax_cut_plan* p = b->plan;
    char line[160];
    if (!p->clashes_found)
        return;
    int used = snprintf(line, sizeof line, "%d pairs of panels are in each other's way at %g mm of thickness.",
                        p->clashes_found, p->material.thickness);
    if (p->clash_count < p->clashes_found)
        snprintf(line + used, sizeof line - (size_t)used, " The first %d are listed.", p->clash_count);
    ax_booklet_page(b, "Collisions", "Collisions", line);
    ax_table table = {.b = b,
                      .heading = "Collisions",
                      .line = line,
                      .box = ax_booklet_body(),
                      .columns = 4,
                      .titles = titles,
                      .widths = widths};
    for (int i = 0; i < p->clash_count; ++i) {
        const ax_cut_clash* c = &p->clashes[i];
        char when[48], overlap[16];
        say_when(c, when);
        snprintf(overlap, sizeof overlap, "%.2f", c->overlap);
        ax_table_row(&table,
                     (const char* const[]){p->panels[c->panels[0]].name, p->panels[c->panels[1]].name, when, overlap});
    }
    ax_booklet_end_page(b);
}
