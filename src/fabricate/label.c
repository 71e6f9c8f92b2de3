// Names inside panels. The label lies in the middle of the inscribed circle, 0.8 of which it fills, and is upright where the flat
// state is, so that it also tells how a loose panel is turned.
#include "fabricate/work.h"

#include "base/vec.h"
#include "fabricate/stroke_font.h"

static const double least = 2, most = 10; // mm, letter heights: below 2 mm engraved letters run together
static const double filled = 0.8;

// Middle and radius of the circle that the label may use.
static double free_circle(const ax_work* w, int triangle, double centre[2])
{
    const int* corner = w->linkage->triangles[triangle];
    double side[3], sum = 0;
    for (int k = 0; k < 3; ++k)
        sum += side[k] = ax_distance2(w->flat[corner[(k + 1) % 3]], w->flat[corner[(k + 2) % 3]]);
    centre[0] = centre[1] = 0;
    for (int k = 0; k < 3; ++k)
        for (int d = 0; d < 2; ++d)
            centre[d] += side[k] / sum * w->flat[corner[k]][d];
    double radius = ax_orient2(w->flat[corner[0]], w->flat[corner[1]], w->flat[corner[2]]) / sum - w->rule.inset;
    if (w->rule.hole_radius > 0) {
        ax_panel_outline o = ax_work_outline(w, triangle, 0);
        for (int k = 0; k < 3; ++k)
            radius = fmin(radius, ax_distance2(centre, o.corner[k].hole) - o.hole_radius);
    }
    return radius;
}

static double height_in(double radius, const char* name)
{
    return 2 * filled * radius / hypot(ax_stroke_width(name), 1);
}

// One height for all, that of the tightest panel, unless this is too small to read: then panels that cannot hold the least
// height go without.
void ax_choose_labels(ax_work* w)
{
    ax_cut_plan* plan = w->plan;
    double height = most;
    for (int t = 0; t < plan->panel_count; ++t) {
        double centre[2], fits = height_in(free_circle(w, t, centre), plan->panels[t].name);
        plan->panels[t].label_height = fits;
        height = fmin(height, fits);
    }
    height = fmax(height, least);
    for (int t = 0; t < plan->panel_count; ++t) {
        bool small = plan->panels[t].label_height < height;
        plan->panels[t].label_height = small ? 0 : height;
        plan->labels_dropped += small;
    }
}

void ax_put_label(ax_work* w, int panel)
{
    const ax_cut_panel* p = &w->plan->panels[panel];
    double height = p->label_height;
    if (height <= 0)
        return;
    double centre[2], at[2];
    free_circle(w, panel, centre);
    const double* m = p->placement;
    ax_move(&(ax_motion){m[0], m[1], m[2], m[3]}, centre[0] - ax_stroke_width(p->name) * height / 2,
            centre[1] - height / 2, at);
    ax_plan_item(&w->builder, AX_LABEL, panel, "label-%s", p->name);
    ax_plan_text(&w->builder, p->name, height, &(ax_motion){m[0], m[1], at[0], at[1]});
}
