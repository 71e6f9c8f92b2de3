#include "fabricate/outline.h"

#include "base/vec.h"

static void direction(const double from[2], const double to[2], double out[2])
{
    double length = ax_distance2(from, to);
    for (int d = 0; d < 2; ++d)
        out[d] = (to[d] - from[d]) / length;
}

double ax_panel_reach(const ax_panel_rule* rule, double grow)
{
    // a plain corner of 60 degrees moves out by twice what its edges do; sharper ones are rare
    return fmax(0, rule->radius - fmin(rule->ear, rule->radius + rule->inset)) + 2.5 * grow;
}

ax_panel_outline ax_panel_make(const ax_panel_rule* rule, const double* const corner[3], double grow)
{
    ax_panel_outline o = {.radius = rule->radius > 0 ? rule->radius + grow : 0,
                          .hole_radius = rule->hole_radius > 0 ? rule->hole_radius - grow : 0};
    for (int k = 0; k < 3; ++k) {
        const double *at = corner[k], *before = corner[(k + 2) % 3], *after = corner[(k + 1) % 3];
        double in[2], out[2], bisector[2];
        direction(before, at, in);
        direction(at, after, out);
        double half = (AX_PI - atan2(ax_cross2(in, out), in[0] * out[0] + in[1] * out[1])) / 2, c = cos(half),
               s = sin(half);
        bisector[0] = c * out[0] - s * out[1], bisector[1] = s * out[0] + c * out[1];
        ax_panel_corner* p = &o.corner[k];
        // not farther in than where the disc touches both edges
        double offset = fmin(rule->ear, (rule->radius + rule->inset) / s), inset = rule->inset - grow;
        if (rule->radius <= 0)
            offset = inset / s;
        double from_edge = offset * s - inset, along = sqrt(fmax(0, o.radius * o.radius - from_edge * from_edge));
        for (int d = 0; d < 2; ++d)
            p->disc[d] = at[d] + offset * bisector[d], p->hole[d] = at[d] + rule->hole_offset * bisector[d];
        p->enter[0] = p->disc[0] + from_edge * in[1] - along * in[0];
        p->enter[1] = p->disc[1] - from_edge * in[0] - along * in[1];
        p->leave[0] = p->disc[0] + from_edge * out[1] + along * out[0];
        p->leave[1] = p->disc[1] - from_edge * out[0] + along * out[1];
        // both ends lie acos(from_edge / radius) beyond the feet of the edges, which are pi - 2 half apart
        double beyond = o.radius > 0 ? atan2(along, from_edge) : 0;
        p->sweep = AX_PI - 2 * half + 2 * beyond;
    }
    for (int k = 0; k < 3; ++k) {
        double along[2];
        const double *a = o.corner[k].leave, *b = o.corner[(k + 1) % 3].enter;
        direction(corner[k], corner[(k + 1) % 3], along);
        o.slack[k] = (b[0] - a[0]) * along[0] + (b[1] - a[1]) * along[1];
        if (o.slack[k] < o.slack[o.tight])
            o.tight = k;
    }
    return o;
}

void ax_panel_put_outline(ax_plan_builder* b, const ax_panel_outline* outline, const ax_motion* motion)
{
    ax_plan_path(b, true);
    for (int k = 0; k < 3; ++k) {
        const ax_panel_corner* p = &outline->corner[k];
        double enter[2], leave[2], centre[2];
        ax_move(motion, p->enter[0], p->enter[1], enter);
        ax_plan_point(b, enter[0], enter[1]);
        if (outline->radius <= 0)
            continue;
        ax_move(motion, p->leave[0], p->leave[1], leave);
        ax_move(motion, p->disc[0], p->disc[1], centre);
        ax_plan_arc(b, centre, leave[0], leave[1], p->sweep, false);
    }
}

void ax_panel_put_hole(ax_plan_builder* b, const ax_panel_outline* outline, int corner, const ax_motion* motion)
{
    double at[2];
    ax_move(motion, outline->corner[corner].hole[0], outline->corner[corner].hole[1], at);
    ax_plan_circle(b, at[0], at[1], outline->hole_radius, true);
}
