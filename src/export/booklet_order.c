// The flat layout, numbered, and the order of joining: a table, then every step drawn with what it is joined to.
#include "export/booklet.h"

#include "base/vec.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { MOST_DETAILS = 200 };
static const double name_size = 2.1; // mm, of the font, for most names on detailed drawings

static void corners_of(const ax_booklet* b, int t, double scale, const double origin[2], double out[3][2])
{
    for (int k = 0; k < 3; ++k) {
        ax_booklet_flat(b, b->design->linkage.triangles[t][k], scale, out[k]);
        out[k][0] += origin[0], out[k][1] += origin[1];
    }
}

static void widen(double bounds[4], const double corners[3][2])
{
    for (int k = 0; k < 3; ++k)
        for (int d = 0; d < 2; ++d) {
            bounds[d] = fmin(bounds[d], corners[k][d]);
            bounds[2 + d] = fmax(bounds[2 + d], corners[k][d]);
        }
}

static const double nothing[4] = {INFINITY, INFINITY, -INFINITY, -INFINITY}, origin[2] = {0, 0};

static void flat_bounds(const ax_booklet* b, double scale, double bounds[4])
{
    memcpy(bounds, nothing, sizeof nothing);
    for (int t = 0; t < b->plan->panel_count; ++t) {
        double c[3][2];
        corners_of(b, t, scale, origin, c);
        widen(bounds, (const double(*)[2])c);
    }
}

// --- layout

// A step's number left of where it begins, or in the middle of its piece.
static void put_step_number(ax_booklet* b, int step, double scale, const double shift[2])
{
    const ax_assembly_step* s = &b->assembly.steps[step];
    double left[2] = {INFINITY, 0}, middle[2] = {0, 0};
    char text[16];
    for (int i = s->first; i < s->first + s->count; ++i) {
        double c[3][2], low = INFINITY;
        corners_of(b, b->assembly.order[i], scale, shift, c);
        for (int k = 0; k < 3; ++k) {
            low = fmin(low, c[k][0]);
            for (int d = 0; d < 2; ++d)
                middle[d] += c[k][d] / (3 * s->count);
        }
        if (low < left[0])
            left[0] = low, left[1] = (c[0][1] + c[1][1] + c[2][1]) / 3;
    }
    snprintf(text, sizeof text, "%d", step + 1);
    cairo_set_source_rgb(b->cairo, 0.75, 0.1, 0.1);
    if (s->piece < 0)
        ax_booklet_text(b, left[0] - 1.5, left[1] + 0.9, 2.4, AX_RIGHT, text);
    else { // names below stay legible
        cairo_set_source_rgba(b->cairo, 0.75, 0.1, 0.1, 0.45);
        ax_booklet_text(b, middle[0], middle[1] + 4, 11, AX_CENTRE, text);
    }
    ax_booklet_ink(b, 0);
}

static void draw_layout(ax_booklet* b, double scale, const double shift[2], const ax_box* box)
{
    bool legible = scale >= ax_booklet_naming_scale(b, AX_BOOKLET_LEGIBLE);
    for (int t = 0; t < b->plan->panel_count; ++t) {
        double c[3][2], bounds[4] = {INFINITY, INFINITY, -INFINITY, -INFINITY};
        corners_of(b, t, scale, shift, c);
        widen(bounds, (const double(*)[2])c);
        if (bounds[0] <= box->x + box->width && bounds[2] >= box->x && bounds[1] <= box->y + box->height &&
            bounds[3] >= box->y)
            ax_booklet_panel(b, t, (const double(*)[2])c, legible ? AX_PANEL_ALWAYS_NAMED : AX_PANEL_NAMED);
    }
    ax_booklet_flush(b);
    for (int k = 0; k < b->assembly.step_count; ++k)
        put_step_number(b, k, scale, shift);
}

static void draw_details(ax_booklet* b, double scale)
{
    ax_box box = ax_booklet_body();
    double bounds[4];
    flat_bounds(b, scale, bounds);
    int columns = (int)ceil((bounds[2] - bounds[0]) / box.width),
        rows = (int)ceil((bounds[3] - bounds[1]) / box.height);
    if ((double)columns * rows > MOST_DETAILS)
        return;
    for (int r = 0; r < rows; ++r)
        for (int c = 0; c < columns; ++c) {
            char heading[96];
            double shift[2] = {box.x - bounds[0] - c * box.width, box.y - bounds[1] - r * box.height};
            snprintf(heading, sizeof heading, "Flat layout, detail: column %d of %d, row %d of %d", c + 1, columns,
                     r + 1, rows);
            ax_booklet_page(b, NULL, heading, "A part of the page before, larger. Rows run from left to right.");
            cairo_save(b->cairo);
            cairo_rectangle(b->cairo, box.x, box.y, box.width, box.height);
            cairo_clip(b->cairo);
            draw_layout(b, scale, shift, &box);
            cairo_restore(b->cairo);
            ax_booklet_end_page(b);
        }
}

void ax_booklet_layout(ax_booklet* b)
{
    char line[320], text[32];
    double bounds[4], legible = ax_booklet_naming_scale(b, AX_BOOKLET_LEGIBLE);
    ax_box box = ax_booklet_body(), inner = {box.x + 8, box.y, box.width - 8, box.height};
    flat_bounds(b, 1, bounds);
    double scale = ax_booklet_scale(&inner, bounds[2] - bounds[0], bounds[3] - bounds[1], text);
    double turn = -atan2(b->assembly.along[1], b->assembly.along[0]) * 180 / AX_PI;
    snprintf(line, sizeof line,
             "Seen from above, %s; rows run from left to right (the flat state turned by %.1f degrees). Red: %s.%s%s",
             text, turn,
             b->assembly.by_pieces ? "number of the step that adds the piece" : "number of the step that adds the row",
             b->plan->joint->two_layers ? " Darker panels lie on top." : "",
             legible > scale ? " All names are on the next pages." : "");
    ax_booklet_page(b, "Flat layout", "Flat layout", line);
    double shift[2] = {inner.x + inner.width / 2 - scale * (bounds[0] + bounds[2]) / 2,
                       inner.y + inner.height / 2 - scale * (bounds[1] + bounds[3]) / 2};
    draw_layout(b, scale, shift, &box);
    ax_booklet_end_page(b);
    if (legible > scale)
        draw_details(b, ax_booklet_naming_scale(b, name_size));
}

// --- order

typedef struct step_words {
    char what[64], from[48], begin[24], sheets[32];
} step_words;

// "C1 to C24" by the places in the row, "3" for a piece.
static step_words words_of(const ax_booklet* b, int step)
{
    const ax_assembly_step* s = &b->assembly.steps[step];
    step_words w = {0};
    int low = b->assembly.order[s->first], high = low, first = b->plan->panels[low].sheet, last = first;
    for (int i = s->first; i < s->first + s->count; ++i) {
        const int *p = b->design->linkage.panels[b->assembly.order[i]], *l = b->design->linkage.panels[low],
                  *h = b->design->linkage.panels[high];
        int sheet = b->plan->panels[b->assembly.order[i]].sheet;
        first = sheet < first ? sheet : first, last = sheet > last ? sheet : last;
        if (2 * p[0] + p[2] < 2 * l[0] + l[2])
            low = b->assembly.order[i];
        if (2 * p[0] + p[2] > 2 * h[0] + h[2])
            high = b->assembly.order[i];
    }
    if (s->piece >= 0)
        snprintf(w.what, sizeof w.what, "piece %d", s->piece + 1);
    else
        snprintf(w.what, sizeof w.what, low == high ? "%s" : "%s to %s", b->plan->panels[low].name,
                 b->plan->panels[high].name);
    snprintf(w.sheets, sizeof w.sheets, first == last ? "%d" : "%d to %d", first + 1, last + 1);
    snprintf(w.from, sizeof w.from, "%s", s->piece >= 0 ? "" : s->from_right ? "right" : "left");
    snprintf(w.begin, sizeof w.begin, "%s", s->piece >= 0 ? "" : b->plan->panels[b->assembly.order[s->first]].name);
    return w;
}

static void table_of_steps(ax_booklet* b, const char* heading, const char* line)
{
    static const char* const rows[] = {
        "Step",       "Panels", "Sheets", "From", "Begin with", "Count", "Hinges in the row", "To what is there",
        "Then joined"};
    static const char* const pieces[] = {"Step",   "Piece", "Sheets",          "",           "",
                                         "Panels", "",      "Hinges to close", "Then joined"};
    static const double widths[] = {11, 32, 20, 15, 22, 16, 32, 30, 24};
    ax_table table = {.b = b,
                      .heading = heading,
                      .line = line,
                      .box = ax_booklet_body(),
                      .columns = 9,
                      .titles = b->assembly.by_pieces ? pieces : rows,
                      .widths = widths};
    for (int k = 0; k < b->assembly.step_count; ++k) {
        const ax_assembly_step* s = &b->assembly.steps[k];
        step_words w = words_of(b, k);
        char number[5][16];
        const int numbers[5] = {k + 1, s->count, s->hinges_within, s->hinges_before, s->first + s->count};
        for (int i = 0; i < 5; ++i)
            snprintf(number[i], sizeof number[i], "%d", numbers[i]);
        const char* row[9] = {number[0], w.what,   w.sheets, w.from, w.begin, number[1], s->piece < 0 ? number[2] : "",
                              number[3], number[4]};
        ax_table_row(&table, row);
    }
}

// --- steps, drawn

typedef struct strips {
    ax_booklet* b;
    const char *heading, *line;
    double scale, y;     // where the next drawing may begin
    const int* hinge_of; // entry of the plan's hinges, -1
    int (*held)[2];
    int part, *drawn; // the drawing at hand; the last one that shows a panel as there
} strips;

static bool is_there(const strips* s, int panel, int step)
{
    return panel >= 0 && s->b->assembly.step_of[panel] < step;
}

static int other_panel(const strips* s, int panel, int hinge)
{
    return s->held[hinge][0] == panel ? s->held[hinge][1] : s->held[hinge][0];
}

// Whether a panel of a step lies between lo and hi along the row; its corners, unmoved.
static bool is_in_part(const strips* s, int t, double lo, double hi, double scale, double corners[3][2])
{
    corners_of(s->b, t, scale, origin, corners);
    double x = (corners[0][0] + corners[1][0] + corners[2][0]) / 3;
    return x >= lo && x < hi;
}

// Panels of a step between lo and hi along the row, with those they hang on; `box` on paper is as high as they need.
static void draw_part(strips* s, int step, double lo, double hi, double scale, const double shift[2])
{
    ax_booklet* b = s->b;
    const ax_assembly_step* st = &b->assembly.steps[step];
    double c[3][2];
    ++s->part;
    for (int i = st->first; i < st->first + st->count; ++i) {
        int t = b->assembly.order[i];
        if (!is_in_part(s, t, lo, hi, scale, c))
            continue;
        corners_of(b, t, scale, shift, c);
        ax_booklet_panel(b, t, (const double(*)[2])c, AX_PANEL_ALWAYS_NAMED);
        for (int k = 0; k < 3; ++k) {
            int o = other_panel(s, t, b->design->linkage.triangles[t][k]);
            if (!is_there(s, o, step) || s->drawn[o] == s->part)
                continue;
            s->drawn[o] = s->part;
            corners_of(b, o, scale, shift, c);
            ax_booklet_panel(b, o, (const double(*)[2])c, AX_PANEL_THERE);
        }
    }
    ax_booklet_flush(b);
    for (int red = 0; red < 2; ++red) { // hinges along the row, then those to what is there
        for (int i = st->first; i < st->first + st->count; ++i) {
            int t = b->assembly.order[i];
            if (!is_in_part(s, t, lo, hi, scale, c))
                continue;
            corners_of(b, t, scale, shift, c);
            for (int k = 0; k < 3; ++k) {
                int o = other_panel(s, t, b->design->linkage.triangles[t][k]);
                bool same = st->piece < 0 && o >= 0 && b->assembly.step_of[o] == step;
                if (red ? is_there(s, o, step) : same)
                    ax_booklet_dot(b, c[k]);
            }
        }
        if (red)
            cairo_set_source_rgb(b->cairo, 0.8, 0.1, 0.1);
        else
            ax_booklet_ink(b, 0.2);
        ax_booklet_dots(b, red ? 0.7 : 0.45);
    }
    ax_booklet_ink(b, 0);
    for (int i = st->first; i < st->first + st->count && st->piece >= 0; ++i) {
        int t = b->assembly.order[i];
        if (!is_in_part(s, t, lo, hi, scale, c))
            continue;
        corners_of(b, t, scale, shift, c);
        for (int k = 0; k < 3; ++k) {
            int h = b->design->linkage.triangles[t][k];
            char number[16];
            if (!is_there(s, other_panel(s, t, h), step) || s->hinge_of[h] < 0)
                continue;
            snprintf(number, sizeof number, "%d", b->plan->hinges[s->hinge_of[h]].seam);
            ax_booklet_text(b, c[k][0] + 1, c[k][1] - 0.8, 1.9, AX_LEFT, number);
        }
    }
}

static void bounds_of_part(const strips* s, int step, double lo, double hi, double scale, double bounds[4])
{
    const ax_booklet* b = s->b;
    const ax_assembly_step* st = &b->assembly.steps[step];
    memcpy(bounds, nothing, sizeof nothing);
    for (int i = st->first; i < st->first + st->count; ++i) {
        int t = b->assembly.order[i];
        double c[3][2];
        if (!is_in_part(s, t, lo, hi, scale, c))
            continue;
        widen(bounds, (const double(*)[2])c);
        for (int k = 0; k < 3; ++k) {
            int o = other_panel(s, t, b->design->linkage.triangles[t][k]);
            if (is_there(s, o, step)) {
                corners_of(b, o, scale, origin, c);
                widen(bounds, (const double(*)[2])c);
            }
        }
    }
}

static void draw_step(strips* s, int step)
{
    ax_booklet* b = s->b;
    const ax_assembly_step* st = &b->assembly.steps[step];
    const ax_box box = ax_booklet_body();
    double all[4], scale = s->scale, words = 7;
    bounds_of_part(s, step, -INFINITY, INFINITY, scale, all);
    double room = box.height - words - 4;
    double shrink = fmin(1, room / (all[3] - all[1]));
    if (st->piece >= 0)
        shrink = fmin(shrink, box.width / (all[2] - all[0]));
    scale *= shrink;
    bounds_of_part(s, step, -INFINITY, INFINITY, scale, all);
    int parts = (int)fmax(1, ceil((all[2] - all[0]) / (0.94 * box.width)));
    for (int p = 0; p < parts; ++p) {
        double wide = (all[2] - all[0]) / parts, bounds[4];
        double lo = p ? all[0] + p * wide : -INFINITY, hi = p + 1 < parts ? all[0] + (p + 1) * wide : INFINITY;
        bounds_of_part(s, step, lo, hi, scale, bounds);
        if (!(bounds[2] > bounds[0]))
            continue;
        double tall = bounds[3] - bounds[1];
        if (s->y + words + tall > box.y + box.height) {
            ax_booklet_end_page(b);
            ax_booklet_page(b, NULL, s->heading, s->line);
            s->y = box.y;
        }
        char text[400], part[32] = "";
        step_words w = words_of(b, step);
        if (parts > 1)
            snprintf(part, sizeof part, ", part %d of %d", p + 1, parts);
        if (st->piece >= 0)
            snprintf(text, sizeof text, "Step %d: %s (sheet %s), %d panels; close %d numbered seams to what is there.",
                     step + 1, w.what, w.sheets, st->count, st->hinges_before);
        else if (step == 0)
            snprintf(text, sizeof text, "Step 1%s: %s, from the left; join %d hinges.", part, w.what,
                     st->hinges_within);
        else
            snprintf(
                text, sizeof text,
                "Step %d%s: %s, from the %s, beginning with %s; join %d hinges in the row and %d to what is there.",
                step + 1, part, w.what, w.from, w.begin, st->hinges_within, st->hinges_before);
        ax_booklet_text(b, box.x, s->y + 4, 3.2, AX_LEFT, text);
        double shift[2] = {box.x + (st->piece >= 0 ? 0 : 4) - bounds[0], s->y + words - bounds[1]};
        draw_part(s, step, lo, hi, scale, shift);
        s->y += words + tall + 5;
    }
}

void ax_booklet_order(ax_booklet* b)
{
    const ax_cut_plan* plan = b->plan;
    bool pieces = b->assembly.by_pieces;
    const char* line =
        pieces ? "Each piece is joined to those before it at the seams that carry the same number on both sides."
               : "Lay the rows out on the flat floor. Each row is joined along itself, and to the rows before it; "
                 "every panel hangs on one that is there.";
    ax_booklet_page(b, "Order of joining", "Order of joining", line);
    if (pieces && b->assembly.step_count == 1) {
        ax_booklet_text(b, AX_BOOKLET_MARGIN, AX_BOOKLET_TOP + 8, 4, AX_LEFT,
                        "The sheet is cut as one piece: there is nothing to join.");
        ax_booklet_end_page(b);
        return;
    }
    table_of_steps(b, "Order of joining", line);
    ax_booklet_end_page(b);
    strips s = {.b = b,
                .heading = "Order of joining, step by step",
                .y = ax_booklet_body().y,
                .line = pieces ? "Pale: pieces that are there. Red: hinges to close, with the seam's number."
                               : "Pale: panels that are there. Red: hinges to them. Black: hinges along the row.",
                .held = ax_alloc((size_t)b->design->linkage.hinge_count, sizeof(int[2])),
                .drawn = AX_NEW0(int, plan->panel_count)};
    int* hinge_of = AX_NEW(int, b->design->linkage.hinge_count);
    memset(hinge_of, -1, (size_t)b->design->linkage.hinge_count * sizeof *hinge_of);
    memset(s.held, -1, (size_t)b->design->linkage.hinge_count * sizeof *s.held);
    for (int k = 0; k < plan->hinge_count; ++k) {
        hinge_of[plan->hinges[k].hinge] = k;
        memcpy(s.held[plan->hinges[k].hinge], plan->hinges[k].panels, sizeof *s.held);
    }
    s.hinge_of = hinge_of;
    s.scale = ax_booklet_naming_scale(b, 1.25 * name_size);
    ax_booklet_page(b, "Steps", s.heading, s.line);
    for (int k = 0; k < b->assembly.step_count; ++k)
        draw_step(&s, k);
    ax_booklet_end_page(b);
    ax_free(hinge_of);
    ax_free(s.held);
    ax_free(s.drawn);
}
