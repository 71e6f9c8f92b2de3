// What a sheet says of itself, in a strip at its foot: a bar to measure, the design, the settings, and what the colours mean.
#include "fabricate/work.h"

#include "fabricate/stroke_font.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

static const double height = 3, advance = 5; // mm, letters and lines
static const double tick = 2, gap = 2;       // mm, either side of the bar, and below it
static const char bar_text[] = "100 mm";

double ax_notes_width(void)
{
    return AX_NOTE_BAR + height * (1 + ax_stroke_width(bar_text));
}

typedef struct flow {
    double room;
    char (*line)[160];
    int count;
} flow;

// Appends words to the last line, or to a new one if it is full.
static void say(flow* f, const char* words)
{
    if (f->count) {
        char joined[sizeof *f->line];
        int length = snprintf(joined, sizeof joined, "%s; %s", f->line[f->count - 1], words);
        if (length < (int)sizeof joined && height * ax_stroke_width(joined) <= f->room) {
            memcpy(f->line[f->count - 1], joined, sizeof joined);
            return;
        }
    }
    if (f->count < 24)
        snprintf(f->line[f->count++], sizeof *f->line, "%.159s", words);
}

// The words of a colour, or its hexadecimal figures.
static void colour_words(const unsigned char rgb[3], char words[16])
{
    static const struct {
        unsigned char rgb[3];
        const char* name;
    } known[] = {{{0, 0, 0}, "black"},      {{255, 0, 0}, "red"},     {{0, 255, 0}, "green"},
                 {{0, 0, 255}, "blue"},     {{0, 255, 255}, "cyan"},  {{255, 0, 255}, "magenta"},
                 {{255, 255, 0}, "yellow"}, {{128, 128, 128}, "grey"}};
    snprintf(words, 16, "%02x%02x%02x", rgb[0], rgb[1], rgb[2]);
    for (size_t k = 0; k < sizeof known / sizeof *known; ++k)
        if (memcmp(known[k].rgb, rgb, 3) == 0)
            snprintf(words, 16, "%s", known[k].name);
}

static int compose(const ax_work* w, double width, int sheet, char (*line)[160])
{
    const ax_cut_plan* p = w->plan;
    flow f = {.room = width, .line = line};
    char words[160];
    if (*p->title || *p->date) {
        snprintf(words, sizeof words, "%.100s%s%.31s", p->title, *p->title && *p->date ? ", " : "", p->date);
        say(&f, words);
    }
    int panels = 0;
    for (int t = 0; t < p->panel_count; ++t)
        panels += p->panels[t].sheet == sheet;
    snprintf(words, sizeof words, "sheet %d of %d", sheet + 1, p->sheet_count);
    say(&f, words);
    snprintf(words, sizeof words, "%d panels", panels);
    if (panels)
        say(&f, words);
    snprintf(words, sizeof words, "joint %s", p->joint->name);
    say(&f, words);
    snprintf(words, sizeof words, "%s, %g mm thick", p->material.name, p->material.thickness);
    say(&f, words);
    snprintf(words, sizeof words, p->kerf > 0 ? "kerf %g mm, compensated" : "kerf not compensated", p->kerf);
    say(&f, words);
    snprintf(words, sizeof words, "drawn in mm%s%s", w->design ? ", design in " : "",
             w->design ? ax_unit_name(w->design->unit) : "");
    say(&f, words);
    if (p->labels_dropped) {
        snprintf(words, sizeof words, "%d panels are too small for a label", p->labels_dropped);
        say(&f, words);
    }
    for (int k = 0; k < AX_OPERATIONS; ++k) {
        const ax_profile_pen* pen = &p->profile->pens[k];
        char colour[16];
        colour_words(pen->rgb, colour);
        snprintf(words, sizeof words, "%s%s %s", k ? "" : "colours: ", pen->layer, colour);
        say(&f, words);
    }
    return f.count;
}

double ax_notes_strip(const ax_work* w, double width)
{
    char line[24][160];
    // as many digits as the sheet's number may come to have
    return 2 * tick + gap + compose(w, width, w->plan->panel_count, line) * advance;
}

void ax_put_notes(ax_work* w, int sheet)
{
    const ax_cut_sheet* s = &w->plan->sheets[sheet];
    ax_plan_builder* b = &w->builder;
    double left = w->options->margin, top = w->options->margin + w->strip - tick, right = left + AX_NOTE_BAR;
    char line[24][160];
    int count = compose(w, s->width - 2 * left, sheet, line);
    ax_plan_item(b, AX_NOTE, -1, "check-bar");
    const double stroke[3][4] = {
        {left, top - tick, left, top + tick}, {left, top, right, top}, {right, top - tick, right, top + tick}};
    for (int k = 0; k < 3; ++k) {
        ax_plan_path(b, false);
        ax_plan_point(b, stroke[k][0], stroke[k][1]);
        ax_plan_point(b, stroke[k][2], stroke[k][3]);
    }
    ax_plan_item(b, AX_NOTE, -1, "note");
    ax_plan_text(b, bar_text, height, &(ax_motion){1, 0, right + height, top - height / 2});
    for (int k = 0; k < count; ++k)
        ax_plan_text(b, line[k], height,
                     &(ax_motion){1, 0, left, top - tick - gap - (k + 1) * advance + (advance - height)});
}
