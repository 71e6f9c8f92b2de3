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
    int *sheet_start, *sheet_panels; // panels of sheet s: sheet_panels[sheet_start[s] .. sheet_start[s + 1])
    int* seam;                       // number of the seam at each hinge, 0: none
    double (*outside)[3];            // where names beside their panels stand: x, from, to; x NaN: none
    unsigned char* met;              // corners that a drawn opening has passed
    double strip;                    // mm, height kept for notes at the foot of a sheet
} ax_work;

static inline ax_panel_outline ax_work_outline(const ax_work* w, int triangle, double grow)
{
    const int* corner = w->linkage->triangles[triangle];
    const double* at[3] = {w->flat[corner[0]], w->flat[corner[1]], w->flat[corner[2]]};
    return ax_panel_make(&w->rule, at, grow);
}

// pieces.c: numbers the pieces in which a one-piece sheet is cut so that each fits `room` (width, height in mm).
ax_status ax_cut_pieces(ax_work* w, const double room[2], int* count, ax_error* error);
// The motion that turns a set of panels so that it lies in [0, width] x [0, height] within `room`; false if there is none.
bool ax_turn_to_fit(const ax_work* w, int count, const int* panels, const double room[2], ax_motion* motion,
                    double size[2]);

// clearance.c: least distance of two panels of one layer in the flat state, mm, as far as it is under `within`.
double ax_flat_clearance(const ax_work* w, double within);

// Whatever joint and material bear at each hinge, clearance and clashes; fills the plan's hinges and clashes.
ax_status ax_prove_clearance(ax_work* w, const ax_progress* progress, ax_error* error);

// layout.c: numbers the pieces of the panels; then, with panels shaped, places them on sheets. Fills the plan's sheets (size only) and
// the panels' placement and sheet.
ax_status ax_find_pieces(ax_work* w, int* count, ax_error* error);
ax_status ax_lay_out(ax_work* w, int pieces, ax_error* error);

// label.c: middle and radius of a triangle's inscribed circle.
double ax_inscribed_circle(const ax_work* w, int triangle, double middle[2]);

// Names inside panels, upright as in the flat state; what stands at corners; seams between pieces.
void ax_choose_labels(ax_work* w);
void ax_put_label(ax_work* w, int panel);
void ax_put_neighbours(ax_work* w, int panel);
void ax_number_seams(ax_work* w);
void ax_put_seams(ax_work* w, int panel);
// A name beside its panel: height that it takes, 0 if it is inside; least distance of two; drawing it at x between the heights
// where the panel ends and the name begins.
double ax_label_zone(const ax_work* w, int panel);
double ax_label_pitch(void);
void ax_put_label_outside(ax_work* w, int panel, double x, double from, double to);

// overview.c: all panels in place with their names and sheets.
void ax_draw_overview(ax_work* w);

// note.c: check bar, legend and figures at the foot of a sheet. Measuring comes first, when the sheet's number is not yet known.
#define AX_NOTE_BAR 100.0                              // mm
double ax_notes_width(void);                           // least width of a sheet between its margins
double ax_notes_strip(const ax_work* w, double width); // height of the strip
void ax_put_notes(ax_work* w, int sheet);

// order.c
void ax_order_sheet(ax_cut_plan* plan, ax_cut_sheet* sheet);
