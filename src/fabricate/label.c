// Names inside panels. The label lies in the middle of the inscribed circle, 0.8 of which it fills, and is upright where the flat
// state is, so that it also tells how a loose panel is turned.
#include "fabricate/work.h"

#include "base/vec.h"
#include "fabricate/stroke_font.h"

#include <stdio.h>

static const double least = 2, most = 10; // mm, letter heights: below 2 mm engraved letters run together
static const double filled = 0.8;
static const double underline = 0.8; // letter heights below the middle
static const double mark = 5;        // mm, length of alignment marks
static const double leader = 1.5;    // mm, least length of a leader

double ax_inscribed_circle(const ax_work* w, int triangle, double middle[2])
{
    const int* corner = w->linkage->triangles[triangle];
    double side[3], sum = 0;
    for (int k = 0; k < 3; ++k)
        sum += side[k] = ax_distance2(w->flat[corner[(k + 1) % 3]], w->flat[corner[(k + 2) % 3]]);
    middle[0] = middle[1] = 0;
    for (int k = 0; k < 3; ++k)
        for (int d = 0; d < 2; ++d)
            middle[d] += side[k] / sum * w->flat[corner[k]][d];
    return ax_orient2(w->flat[corner[0]], w->flat[corner[1]], w->flat[corner[2]]) / sum;
}

// Middle and radius of the circle that the label may use.
static double free_circle(const ax_work* w, int triangle, double centre[2])
{
    double radius = ax_inscribed_circle(w, triangle, centre) - w->rule.inset;
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

static ax_motion placement_of(const ax_cut_panel* p)
{
    return (ax_motion){p->placement[0], p->placement[1], p->placement[2], p->placement[3]};
}

// Text about a point of the flat state, turned with its panel.
static void put_centred(ax_work* w, const ax_motion* m, const char* text, double height, const double centre[2])
{
    double at[2];
    ax_move(m, centre[0] - ax_stroke_width(text) * height / 2, centre[1] - height / 2, at);
    ax_plan_text(&w->builder, text, height, &(ax_motion){m->c, m->s, at[0], at[1]});
}

static void put_line(ax_work* w, const ax_motion* m, double x0, double y0, double x1, double y1)
{
    double at[2];
    ax_plan_path(&w->builder, false);
    ax_move(m, x0, y0, at);
    ax_plan_point(&w->builder, at[0], at[1]);
    ax_move(m, x1, y1, at);
    ax_plan_point(&w->builder, at[0], at[1]);
}

// Turned panels get a line under the name: it says how the name is read, and with it how the panel lies in the flat state.
void ax_put_label(ax_work* w, int panel)
{
    const ax_cut_panel* p = &w->plan->panels[panel];
    const ax_motion m = placement_of(p);
    double centre[2], height = p->label_height;
    if (height <= 0)
        return;
    free_circle(w, panel, centre);
    ax_plan_item(&w->builder, AX_LABEL, panel, "label-%s", p->name);
    put_centred(w, &m, p->name, height, centre);
    if (!w->plan->in_place) {
        double half = ax_stroke_width(p->name) * height / 2, y = centre[1] - underline * height;
        put_line(w, &m, centre[0] - half, y, centre[0] + half, y);
    }
}

// Middle and letter height of a text between a corner and the panel's name; 0 if there is no room.
static double fit_at_corner(const ax_work* w, int panel, int corner, const char* text, double at[2])
{
    const ax_cut_panel* p = &w->plan->panels[panel];
    const int* triangle = w->linkage->triangles[panel];
    const double* apex = w->flat[triangle[corner]];
    double middle[2], inner = free_circle(w, panel, middle), reach = ax_distance2(apex, middle);
    // the inscribed circle touches both edges, which gives half the corner's angle
    double sine = (inner + w->rule.inset) / reach, outer = hypot(ax_stroke_width(p->name), 1) * p->label_height / 2;
    double from = w->rule.hole_radius > 0 ? w->rule.hole_offset + w->rule.hole_radius : 0, to = reach - 1.2 * outer;
    double x = (from + to) / 2, radius = fmin((to - from) / 2, x * sine - w->rule.inset);
    for (int d = 0; d < 2; ++d)
        at[d] = apex[d] + x / reach * (middle[d] - apex[d]);
    double height = fmin(height_in(radius, text), fmax(p->label_height / 2, least));
    return height >= least ? height : 0;
}

// Loose panels say at each corner which panel is joined there.
void ax_put_neighbours(ax_work* w, int panel)
{
    const ax_cut_panel* p = &w->plan->panels[panel];
    const ax_motion m = placement_of(p);
    for (int k = 0; k < 3; ++k) {
        const int* held = w->held[w->linkage->triangles[panel][k]];
        int other = held[held[0] == panel];
        double at[2], height = other < 0 ? 0 : fit_at_corner(w, panel, k, w->plan->panels[other].name, at);
        if (height <= 0)
            continue;
        ax_plan_item(&w->builder, AX_LABEL, panel, "corner-%s.%d", p->name, k);
        put_centred(w, &m, w->plan->panels[other].name, height, at);
    }
}

// Hinges where a one-piece sheet was cut get a number on both sides, and a mark that lines up with the other's when they are
// joined and fully open.
void ax_put_seams(ax_work* w, int panel)
{
    const ax_cut_panel* p = &w->plan->panels[panel];
    const ax_motion m = placement_of(p);
    for (int k = 0; k < 3; ++k) {
        int hinge = w->linkage->triangles[panel][k], number = w->seam[hinge];
        if (!number)
            continue;
        char text[16];
        snprintf(text, sizeof text, "%d", number);
        double at[2], middle[2], reach, height = fit_at_corner(w, panel, k, text, at);
        const double* apex = w->flat[hinge];
        free_circle(w, panel, middle);
        reach = ax_distance2(apex, middle);
        double first = fmin(1, 0.1 * reach) / reach, last = fmin(mark + 1, 0.3 * reach) / reach;
        ax_plan_item(&w->builder, AX_SCORE, panel, "mark-%s.%d", p->name, k);
        put_line(w, &m, apex[0] + first * (middle[0] - apex[0]), apex[1] + first * (middle[1] - apex[1]),
                 apex[0] + last * (middle[0] - apex[0]), apex[1] + last * (middle[1] - apex[1]));
        if (height <= 0) {
            ++w->plan->labels_dropped;
            continue;
        }
        ax_plan_item(&w->builder, AX_LABEL, panel, "seam-%s.%d", p->name, k);
        put_centred(w, &m, text, height, at);
    }
}

void ax_number_seams(ax_work* w)
{
    w->seam = AX_NEW0(int, w->linkage->hinge_count);
    for (int h = 0; h < w->linkage->hinge_count; ++h) {
        const int* held = w->held[h];
        if (w->plan->joint->one_piece && held[1] >= 0 &&
            w->plan->panels[held[0]].piece != w->plan->panels[held[1]].piece)
            w->seam[h] = ++w->plan->seam_count;
    }
}

double ax_label_zone(const ax_work* w, int panel)
{
    const ax_cut_panel* p = &w->plan->panels[panel];
    return p->label_height > 0 ? 0 : 2 * leader + least * ax_stroke_width(p->name);
}

double ax_label_pitch(void)
{
    return 1.4 * least;
}

// Beside the panel: upwards from a leader that begins at the panel.
void ax_put_label_outside(ax_work* w, int panel, double x, double from, double to)
{
    const ax_cut_panel* p = &w->plan->panels[panel];
    ax_plan_item(&w->builder, AX_LABEL, panel, "label-%s", p->name);
    put_line(w, &ax_stay, x, from + leader / 4, x, to - leader / 2);
    ax_plan_text(&w->builder, p->name, least, &(ax_motion){0, 1, x + least / 2, to});
}
