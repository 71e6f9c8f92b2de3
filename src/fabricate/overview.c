// The overview of several sheets: the flat state with every panel's name and sheet. Nothing of it is machined.
#include "fabricate/work.h"

#include "base/vec.h"
#include "fabricate/stroke_font.h"

#include <stdio.h>

static const double margin = 10, filled = 0.8; // mm; of the inscribed circle

// Letters fill each panel, so that the whole can be printed small.
static void put_name(ax_work* w, int t, const ax_motion* m)
{
    const ax_cut_panel* p = &w->plan->panels[t];
    double centre[2], at[2], radius = ax_inscribed_circle(w, t, centre);
    char text[40];
    snprintf(text, sizeof text, "%s/%d", p->name, p->sheet + 1);
    double height = 2 * filled * radius / hypot(ax_stroke_width(text), 1);
    ax_move(m, centre[0] - ax_stroke_width(text) * height / 2, centre[1] - height / 2, at);
    ax_plan_item(&w->builder, AX_NOTE, t, "label-%s", p->name);
    ax_plan_text(&w->builder, text, height, &(ax_motion){1, 0, at[0], at[1]});
}

void ax_draw_overview(ax_work* w)
{
    ax_cut_plan* plan = w->plan;
    double lo[2] = {INFINITY, INFINITY}, hi[2] = {-INFINITY, -INFINITY};
    for (int t = 0; t < plan->panel_count; ++t)
        ax_path_bounds(plan, &plan->paths[plan->panels[t].first], lo, hi);
    const ax_motion m = {1, 0, margin - lo[0], margin - lo[1]};
    plan->overview = (ax_cut_sheet){.width = ceil(hi[0] - lo[0] + 2 * margin),
                                    .height = ceil(hi[1] - lo[1] + 2 * margin),
                                    .first = plan->item_count};
    for (int t = 0; t < plan->panel_count; ++t) {
        ax_plan_item(&w->builder, AX_NOTE, t, "panel-%s", plan->panels[t].name);
        ax_plan_copy(&w->builder, plan->panels[t].first, &m);
        put_name(w, t, &m);
    }
    plan->overview.count = plan->item_count - plan->overview.first;
    plan->overview.utilisation = plan->area / (plan->overview.width * plan->overview.height);
}
