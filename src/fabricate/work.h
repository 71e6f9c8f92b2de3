// What the stages of ax_fabricate share.
#pragma once

#include "fabricate/joint_work.h"
#include "fabricate/outline.h"
#include "fabricate/plan.h"

typedef struct ax_work {
    const ax_design* design;
    const ax_linkage* linkage;
    const ax_fabricate_options* options;
    const ax_progress* progress;
    double (*flat)[2]; // mm
    int (*held)[2];    // triangles of each hinge, -1 on the rim
    ax_joint_job joint;
    ax_panel_rule rule;
    ax_cut_plan* plan;
    ax_plan_builder builder;
    double strip; // mm, height kept for notes at the foot of a sheet
} ax_work;

static inline ax_panel_outline ax_work_outline(const ax_work* w, int triangle, double grow)
{
    const int* corner = w->linkage->triangles[triangle];
    const double* at[3] = {w->flat[corner[0]], w->flat[corner[1]], w->flat[corner[2]]};
    return ax_panel_make(&w->rule, at, grow);
}

// layout.c: places panels on sheets. Fills the plan's sheets (size only) and the panels' placement, sheet and piece.
ax_status ax_lay_out(ax_work* w, ax_error* error);

// label.c: the name inside the panel, upright as in the flat state.
void ax_choose_labels(ax_work* w);
void ax_put_label(ax_work* w, int panel);

// note.c: check bar, legend and figures at the foot of a sheet. Measuring comes first, when the sheet's number is not yet known.
#define AX_NOTE_BAR 100.0                              // mm
double ax_notes_width(void);                           // least width of a sheet between its margins
double ax_notes_strip(const ax_work* w, double width); // height of the strip
void ax_put_notes(ax_work* w, int sheet);

// order.c
void ax_order_sheet(ax_cut_plan* plan, ax_cut_sheet* sheet);
