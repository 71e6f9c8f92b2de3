// The frame: each curve drawn with its dimensions, and a table of its supports.
#include "export/booklet.h"

#include "base/vec.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

typedef struct drawing {
    ax_booklet* b;
    const ax_frame_curve* c;
    double scale, shift[2];
    bool unrolled;
} drawing;

static const ax_frame_point* point_at(const drawing* d, int k)
{
    return &d->b->frame.points[d->c->first + k % d->c->count];
}

// A place in the curve's plane, or from above; unrolled: its length and height.
static void project(const drawing* d, const double place[3], double along, double out[2])
{
    double r[3];
    if (d->unrolled)
        out[0] = along, out[1] = place[2];
    else if (d->c->planar) {
        ax_sub3(place, d->c->origin, r);
        out[0] = ax_dot3(r, d->c->axes[0]), out[1] = ax_dot3(r, d->c->axes[1]);
    } else
        out[0] = place[0], out[1] = place[1];
    out[0] = d->shift[0] + d->scale * out[0];
    out[1] = d->shift[1] - d->scale * out[1];
}

static int span_count(const drawing* d)
{
    return d->c->closed ? d->c->count : d->c->count - 1;
}

static double end_along(const drawing* d, int k)
{
    return k + 1 < d->c->count ? point_at(d, k + 1)->plan : d->c->plan;
}

static void draw_curve(const drawing* d)
{
    enum { PIECES = 8 };
    cairo_t* c = d->b->cairo;
    for (int k = 0; k < span_count(d); ++k)
        for (int i = 0; i <= PIECES; ++i) {
            double place[3], at[2], from = point_at(d, k)->plan, t = i / (double)PIECES;
            ax_frame_at(&d->b->frame, d->c, k, t, place);
            project(d, place, from + t * (end_along(d, k) - from), at);
            if (i == 0 && k == 0)
                cairo_move_to(c, at[0], at[1]);
            else
                cairo_line_to(c, at[0], at[1]);
        }
    ax_booklet_ink(d->b, 0);
    cairo_set_line_width(c, 0.35);
    cairo_stroke(c);
}

// Lengths of chords beside them inside, numbers of supports outside, where there is room.
static void put_dimensions(const drawing* d)
{
    ax_booklet* b = d->b;
    double middle[2] = {0, 0}, at[2], to[2], last[2] = {-1e9, -1e9};
    for (int k = 0; k < d->c->count; ++k) {
        project(d, point_at(d, k)->place, point_at(d, k)->plan, at);
        middle[0] += at[0] / d->c->count, middle[1] += at[1] / d->c->count;
    }
    for (int k = 0; k < d->c->count; ++k) {
        const ax_frame_point *p = point_at(d, k), *next = point_at(d, k + 1);
        char text[32];
        project(d, p->place, p->plan, at);
        project(d, next->place, end_along(d, k), to);
        cairo_set_source_rgb(b->cairo, 0.75, 0.1, 0.1);
        ax_booklet_dot(b, at);
        ax_booklet_dots(b, 0.7);
        double normal[2] = {to[1] - at[1], at[0] - to[0]}, length = fmax(hypot(normal[0], normal[1]), 1e-9);
        double side = normal[0] * (at[0] - middle[0]) + normal[1] * (at[1] - middle[1]) > 0 || d->unrolled ? 1 : -1;
        double unit[2] = {side * normal[0] / length, side * normal[1] / length};
        if (d->unrolled)
            unit[0] = 0, unit[1] = -1;
        bool room = ax_distance2(at, last) > (d->unrolled ? 7 : 6);
        if (room) {
            snprintf(text, sizeof text, "S%d", d->c->first + k + 1);
            ax_booklet_text(b, at[0] + 4 * unit[0], at[1] + 4 * unit[1] + 0.9, 2.5, AX_CENTRE, text);
            memcpy(last, at, sizeof last);
        }
        ax_booklet_ink(b, 0.25);
        snprintf(text, sizeof text, d->unrolled ? "%+.0f" : "%.1f", d->unrolled ? p->place[2] : p->chord);
        if (d->unrolled && room)
            ax_booklet_text(b, at[0], at[1] + 4, 2, AX_CENTRE, text);
        if (!d->unrolled && k < span_count(d) && length > 1.15 * ax_booklet_text_width(b, 2, text)) {
            double turn = atan2(to[1] - at[1], to[0] - at[0]);
            if (cos(turn) < 0)
                turn += AX_PI;
            cairo_save(b->cairo);
            cairo_translate(b->cairo, (at[0] + to[0]) / 2 - 2 * unit[0], (at[1] + to[1]) / 2 - 2 * unit[1]);
            cairo_rotate(b->cairo, turn);
            ax_booklet_text(b, 0, 0.7, 2, AX_CENTRE, text);
            cairo_restore(b->cairo);
        }
    }
    ax_booklet_ink(b, 0);
}

static void draw(ax_booklet* b, const ax_frame_curve* c, bool unrolled, const ax_box* box, const char* words)
{
    drawing d = {.b = b, .c = c, .scale = 1, .unrolled = unrolled};
    double lo[2] = {INFINITY, INFINITY}, hi[2] = {-INFINITY, -INFINITY};
    for (int k = 0; k < c->count; ++k) {
        double at[2];
        project(&d, point_at(&d, k)->place, point_at(&d, k)->plan, at);
        for (int i = 0; i < 2; ++i)
            lo[i] = fmin(lo[i], at[i]), hi[i] = fmax(hi[i], at[i]);
    }
    if (unrolled)
        hi[0] = fmax(hi[0], c->plan);
    char scale[32], text[200];
    ax_box inner = {box->x + 8, box->y + 14, box->width - 16, box->height - 22};
    d.scale = ax_booklet_scale(&inner, hi[0] - lo[0], hi[1] - lo[1], scale);
    d.shift[0] = inner.x + inner.width / 2 - d.scale * (lo[0] + hi[0]) / 2;
    d.shift[1] = inner.y + inner.height / 2 - d.scale * (lo[1] + hi[1]) / 2;
    snprintf(text, sizeof text, "%s, %s", words, scale);
    ax_booklet_text(b, box->x, box->y + 4, 3.2, AX_LEFT, text);
    draw_curve(&d);
    put_dimensions(&d);
    if (c->circle && !unrolled) {
        double centre[2];
        project(&d, c->centre, 0, centre);
        cairo_set_line_width(b->cairo, 0.2);
        cairo_move_to(b->cairo, centre[0] - 3, centre[1]), cairo_line_to(b->cairo, centre[0] + 3, centre[1]);
        cairo_move_to(b->cairo, centre[0], centre[1] - 3), cairo_line_to(b->cairo, centre[0], centre[1] + 3);
        cairo_stroke(b->cairo);
        snprintf(text, sizeof text, "R %.1f mm", c->radius);
        ax_booklet_text(b, centre[0], centre[1] + 7, 3.2, AX_CENTRE, text);
    }
}

static double rounded(double x) // no "-0.0000"
{
    return fabs(x) < 5e-5 ? 0 : x;
}

static void draw_page(ax_booklet* b, int index, const char* section)
{
    const ax_frame_curve* c = &b->frame.curves[index];
    char heading[64], line[256];
    snprintf(heading, sizeof heading, "%s %d: %s", c->arch ? "Arch" : "Frame", index + 1,
             c->circle      ? "a circle"
             : c->count < 3 ? "two supports"
             : c->planar    ? "a curve in a plane"
                            : "a curve in space");
    int used = snprintf(line, sizeof line, "%d supports, chords of %.1f mm in all, %s.", c->count, c->length,
                        c->closed ? "closed" : "open");
    if (c->circle)
        used += snprintf(line + used, sizeof line - (size_t)used,
                         " Radius %.1f mm, no support further than %.2f mm from it.", c->radius, c->off_circle);
    if (c->planar)
        snprintf(line + used, sizeof line - (size_t)used,
                 " The plane's normal is (%.4f, %.4f, %.4f), no support further than %.2f mm from it.",
                 rounded(c->axes[2][0]), rounded(c->axes[2][1]), rounded(c->axes[2][2]), c->off_plane);
    else if (c->count > 2)
        snprintf(line + used, sizeof line - (size_t)used, " Best plane: %.1f mm off.", c->off_plane);
    ax_booklet_page(b, section, heading, line);
    ax_box box = ax_booklet_body();
    if (c->planar || c->count < 3) {
        draw(b, c, false, &box, "In its plane; chords in mm");
    } else {
        ax_box upper = {box.x, box.y, box.width, 0.66 * box.height};
        ax_box lower = {box.x, box.y + upper.height, box.width, 0.34 * box.height};
        draw(b, c, false, &upper, "From above; chords (in space) in mm");
        draw(b, c, true, &lower, "Unrolled: height in mm over the length seen from above");
    }
    ax_booklet_end_page(b);
}

static void put_number(char cell[32], double value, const char* format)
{
    value = fabs(value) < 0.05 ? 0 : value; // no "-0.0"
    snprintf(cell, 32, isfinite(value) ? format : isnan(value) ? "" : "straight", value);
}

static void table_of_supports(ax_booklet* b)
{
    static const char* const titles[] = {"Support", "Panel",    "x mm",     "y mm",
                                         "z mm",    "Chord mm", "Along mm", "Radius mm"};
    static const double widths[] = {18, 15, 20, 20, 18, 20, 22, 24};
    static const char heading[] = "Frame: supports";
    static const char line[] = "Places in the design's axes. Chord: to the next support; along: sum of chords; radius: "
                               "of the circle through a support and its neighbours. * slides";
    ax_booklet_page(b, NULL, heading, line);
    ax_table table = {.b = b,
                      .heading = heading,
                      .line = line,
                      .box = ax_booklet_body(),
                      .columns = 8,
                      .titles = titles,
                      .widths = widths};
    for (int k = 0; k < b->frame.point_count; ++k) {
        const ax_frame_point* p = &b->frame.points[k];
        char cells[8][32];
        const char* row[8];
        snprintf(cells[0], 32, "S%d%s", k + 1, p->slides ? "*" : "");
        snprintf(cells[1], 32, "%s", b->plan->panels[p->panel].name);
        for (int d = 0; d < 3; ++d)
            put_number(cells[2 + d], p->place[d], "%.1f");
        put_number(cells[5], p->chord, "%.1f");
        put_number(cells[6], p->along, "%.1f");
        put_number(cells[7], p->radius, "%.0f");
        for (int c = 0; c < 8; ++c)
            row[c] = cells[c];
        ax_table_row(&table, row);
    }
    ax_booklet_end_page(b);
}

void ax_booklet_frame(ax_booklet* b)
{
    const char* section = "Frame";
    if (!b->frame.point_count) {
        ax_booklet_page(b, section, "Frame", "The design has no supports.");
        ax_booklet_end_page(b);
        return;
    }
    for (int k = 0; k < b->frame.curve_count; ++k)
        if (b->frame.curves[k].count > 1) {
            draw_page(b, k, section);
            section = NULL;
        }
    table_of_supports(b);
}
