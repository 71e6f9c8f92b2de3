// The title page of the assembly plan.
#include "export/booklet.h"

#include "base/vec.h"

#include <stdarg.h>
#include <stdio.h>
#include <string.h>

static const double margin = AX_BOOKLET_MARGIN;

typedef struct listing {
    ax_booklet* b;
    double x, y;
} listing;

static void say(listing* l, const char* label, const char* format, ...) __attribute__((format(printf, 3, 4)));
static void say(listing* l, const char* label, const char* format, ...)
{
    char text[256];
    va_list arguments;
    va_start(arguments, format);
    vsnprintf(text, sizeof text, format, arguments);
    va_end(arguments);
    ax_booklet_ink(l->b, 0.4);
    ax_booklet_text(l->b, l->x, l->y, 3.6, AX_LEFT, label);
    ax_booklet_ink(l->b, 0);
    ax_booklet_text(l->b, l->x + 38, l->y, 3.6, AX_LEFT, text);
    l->y += 6.4;
}

static void write_force(char text[32], double newton)
{
    if (newton >= 1e4)
        snprintf(text, 32, "%.1f kN", newton / 1000);
    else
        snprintf(text, 32, newton >= 100 ? "%.0f N" : "%.3g N", newton);
}

static void say_load(listing* l)
{
    const ax_design* d = l->b->design;
    if (d->load.kind == AX_LOAD_GRAVITY)
        say(l, "Load", "gravity, %.3g kg/m2, towards (%.3g, %.3g, %.3g)", d->load.density, d->load.direction[0],
            d->load.direction[1], d->load.direction[2]);
    else if (d->load.kind == AX_LOAD_INFLATION)
        say(l, "Load", d->load.pressure >= 100 ? "inflation, %.0f Pa" : "inflation, %.3g Pa", d->load.pressure);
    else
        say(l, "Load", "none given");
    if (d->simulated) {
        char all[32], supports[32], hinge[32];
        write_force(all, d->report.load_total);
        write_force(supports, d->report.reaction_total);
        write_force(hinge, d->report.hinge_force_max);
        say(l, "", "%s in all, %s on the supports", all, supports);
        say(l, "Hinge force", "%s at most", hinge);
    } else {
        say(l, "", "not simulated: forces are unknown");
    }
}

static void say_frame(listing* l)
{
    const ax_support_frame* f = &l->b->frame;
    const ax_slide* slides = l->b->design->slides;
    int sliding = 0;
    for (int h = 0; h < l->b->design->linkage.hinge_count && slides; ++h)
        sliding += l->b->design->supports[h] && slides[h].freedom != AX_HELD_FAST;
    if (sliding)
        say(l, "Supports", "%d, of which %d slide", f->support_count, sliding);
    else
        say(l, "Supports", "%d", f->support_count);
    for (int k = 0, told = 0; k < f->curve_count && told < 6; ++k) {
        const ax_frame_curve* c = &f->curves[k];
        if (c->count < 2)
            continue;
        ++told;
        if (c->circle)
            say(l, c->arch ? "Arch" : "Frame", "circle of radius %.1f mm, %d supports", c->radius, c->count);
        else
            say(l, c->arch ? "Arch" : "Frame", "%s curve, %.3f m, %d supports", c->planar ? "plane" : "spatial",
                c->length / 1000, c->count);
    }
}

static void extents(const ax_design* d, double flat[2], double space[3])
{
    for (int c = 0; c < 3; ++c) {
        double lo = INFINITY, hi = -INFINITY, l = INFINITY, h = -INFINITY;
        for (int k = 0; k < d->linkage.hinge_count; ++k) {
            lo = fmin(lo, d->deployed[k][c]), hi = fmax(hi, d->deployed[k][c]);
            if (c < 2)
                l = fmin(l, d->flat[k][c]), h = fmax(h, d->flat[k][c]);
        }
        space[c] = hi - lo;
        if (c < 2)
            flat[c] = h - l;
    }
}

static void say_joint(listing* l)
{
    const ax_cut_plan* p = l->b->plan;
    char text[200];
    int used = snprintf(text, sizeof text, "%s", p->joint->name);
    for (int k = 0; k < p->joint->parameter_count && used < (int)sizeof text; ++k)
        used += snprintf(text + used, sizeof text - (size_t)used, "%s %s %g %s", k ? "," : ":",
                         p->joint->parameters[k].name, p->joint_values[k], p->joint->parameters[k].unit);
    say(l, "Joint", "%s", text);
    for (int k = 0; k < p->part_count; ++k)
        say(l, "Parts", "%d x %s", p->parts[k].count, p->parts[k].name);
}

void ax_booklet_title(ax_booklet* b)
{
    const ax_cut_plan* p = b->plan;
    const ax_design* d = b->design;
    double flat[2], space[3], metre = ax_unit_in_metres(d->unit);
    char heading[160], scale[32];
    snprintf(heading, sizeof heading, "%s%sassembly plan", p->title, *p->title ? ": " : "");
    ax_booklet_page(b, "Overview", heading,
                    "Panels keep their names in the cut files, in the schedule and on these pages.");
    listing l = {b, margin, AX_BOOKLET_TOP + 8};
    extents(d, flat, space);
    say(&l, "Panels", "%d", p->panel_count);
    say(&l, "Hinges", "%d between panels", p->hinge_count);
    if (p->seam_count)
        say(&l, "Seams", "%d hinges to close between pieces", p->seam_count);
    say_joint(&l);
    say(&l, "Material", "%s, %g mm thick", p->material.name, p->material.thickness);
    say(&l, "Panels weigh", "%.3f kg (%.4g m2)", p->mass, p->area * 1e-6);
    if (p->sheet_count == 1)
        say(&l, "Sheets", "1 of %.0f x %.0f mm", p->sheets[0].width, p->sheets[0].height);
    else
        say(&l, "Sheets", "%d of %.0f x %.0f mm, %.0f %% used", p->sheet_count, p->sheets[0].width, p->sheets[0].height,
            100 * p->utilisation);
    say(&l, "Flat", "%.3f x %.3f m", flat[0] * metre, flat[1] * metre);
    say(&l, "Deployed", "%.3f x %.3f x %.3f m", space[0] * metre, space[1] * metre, space[2] * metre);
    say_load(&l);
    say_frame(&l);
    say(&l, "Steps", b->assembly.by_pieces ? "%d, by pieces" : "%d, by rows", b->assembly.step_count);
    if (p->clashes_found)
        say(&l, "Attention", "%d pairs of panels collide: red, listed on the last pages", p->clashes_found);
    if (d->load.kind == AX_LOAD_GRAVITY && d->load.direction[2] > 0) {
        l.y += 4;
        ax_booklet_text(b, l.x, l.y, 3.2, AX_LEFT,
                        "On these pages the load points up: the shell finds this shape as it hangs");
        ax_booklet_text(b, l.x, l.y + 4.6, 3.2, AX_LEFT, "from its frame, upside down.");
    }
    ax_box box = {margin + 150, AX_BOOKLET_TOP, AX_BOOKLET_WIDTH - 2 * margin - 150, ax_booklet_body().height};
    ax_booklet_draw_view(b, AX_VIEW_AXONOMETRIC, &box, false, scale);
    ax_booklet_end_page(b);
}
