// Where panels lie on sheets.
#include "fabricate/work.h"

#include "base/vec.h"

// The flat state as it is, on a sheet of whole millimetres with the notes below.
static void lay_in_place(ax_work* w)
{
    ax_cut_plan* plan = w->plan;
    double lo[2] = {INFINITY, INFINITY}, hi[2] = {-INFINITY, -INFINITY}, margin = w->options->margin,
           grow = plan->kerf / 2;
    for (int t = 0; t < plan->panel_count; ++t)
        ax_path_bounds(plan, &plan->paths[plan->panels[t].first], lo, hi);
    double width = fmax(hi[0] - lo[0] + 2 * grow, ax_notes_width());
    w->strip = ax_notes_strip(w, width);
    ax_cut_sheet* sheet = plan->sheets = AX_NEW0(ax_cut_sheet, 1);
    plan->sheet_count = 1;
    sheet->width = ceil(width + 2 * margin);
    sheet->height = ceil(hi[1] - lo[1] + 2 * grow + w->strip + 3 * margin);
    for (int t = 0; t < plan->panel_count; ++t) {
        plan->panels[t].piece = t;
        plan->panels[t].placement[0] = 1;
        plan->panels[t].placement[2] = margin + grow - lo[0];
        plan->panels[t].placement[3] = sheet->height - margin - grow - hi[1];
    }
    plan->in_place = true;
}

ax_status ax_lay_out(ax_work* w, ax_error* error)
{
    (void)error;
    lay_in_place(w);
    return AX_OK;
}
