#include "picture/legend.h"

#include <stdio.h>
#include <string.h>

enum { CARD_WIDTH = 288, PADDING = 16, MARGIN = 16, HISTOGRAM = 36, BAR = 12 };

static const unsigned text1 = 0x15181e, text2 = 0x474e5a, text3 = 0x626a77;

static void set_colour(cairo_t* cr, unsigned rgb, double alpha)
{
    cairo_set_source_rgba(cr, (rgb >> 16 & 255) / 255.0, (rgb >> 8 & 255) / 255.0, (rgb & 255) / 255.0, alpha);
}

// Digits are placed by hand, since printf writes the decimal point of the user's locale.
void ax_write_number(char* text, size_t size, double value, int decimals)
{
    double magnitude = fabs(value);
    int exponent = 0, places = decimals;
    if (magnitude > 0 && (magnitude >= 1e6 || decimals > 5)) { // one or two digits and a power of ten
        exponent = (int)floor(log10(magnitude));
        long tenths = lrint(magnitude / pow(10, exponent - 1));
        exponent += tenths == 100;
        magnitude = (double)(tenths == 100 ? 10 : tenths) / 10;
        places = tenths % 10 ? 1 : 0;
    }
    long long fixed = llround(magnitude * pow(10, places));
    const char* sign = value < 0 && fixed ? "\u2212" : "";
    char digits[32], *first = digits + sizeof digits - 1;
    *first = 0;
    for (int k = 0; k <= places || fixed > 0; ++k, fixed /= 10) {
        if (k > 0 && k == places)
            *--first = '.';
        *--first = (char)('0' + fixed % 10);
    }
    if (exponent)
        snprintf(text, size, "%s%se%d", sign, first, exponent);
    else
        snprintf(text, size, "%s%s", sign, first);
}

int ax_decimals_for(double largest)
{
    int decimals = largest > 0 ? 2 - (int)floor(log10(largest)) : 2;
    return decimals < 0 ? 0 : (decimals < 9 ? decimals : 9);
}

double ax_round_length(double x)
{
    double power = pow(10, floor(log10(x) + 1e-12)), over = x / power * (1 + 1e-9);
    return power * (over >= 5 ? 5 : (over >= 2 ? 2 : 1));
}

#ifdef AX_SANITIZED
// fontconfig holds on to some patterns until the process ends, with no way to say when we are done.
const char* __lsan_default_suppressions(void);
const char* __lsan_default_suppressions(void)
{
    return "leak:libfontconfig";
}
const char* __lsan_default_options(void);
const char* __lsan_default_options(void)
{
    return "print_suppressions=0";
}
#endif

// Text without hinting and colour fringes, so that it looks the same on every system with the same fonts.
static void set_font(cairo_t* cr, bool bold, double size)
{
    cairo_font_options_t* options = cairo_font_options_create();
    cairo_font_options_set_antialias(options, CAIRO_ANTIALIAS_GRAY);
    cairo_font_options_set_hint_style(options, CAIRO_HINT_STYLE_NONE);
    cairo_font_options_set_hint_metrics(options, CAIRO_HINT_METRICS_OFF);
    cairo_set_font_options(cr, options);
    cairo_font_options_destroy(options);
    cairo_select_font_face(cr, "Inter", CAIRO_FONT_SLANT_NORMAL,
                           bold ? CAIRO_FONT_WEIGHT_BOLD : CAIRO_FONT_WEIGHT_NORMAL);
    cairo_set_font_size(cr, size);
}

// align: 0 starts, 0.5 centres, 1 ends at x. Returns the width. Filled as outlines, since glyphs would snap to whole pixels.
static double write(cairo_t* cr, const char* text, double x, double y, double align)
{
    cairo_text_extents_t extents;
    cairo_text_extents(cr, text, &extents);
    cairo_move_to(cr, x - align * extents.x_advance, y);
    cairo_text_path(cr, text);
    cairo_fill(cr);
    return extents.x_advance;
}

static void rounded(cairo_t* cr, double x, double y, double width, double height, double radius)
{
    cairo_new_sub_path(cr);
    cairo_arc(cr, x + width - radius, y + radius, radius, -AX_PI / 2, 0);
    cairo_arc(cr, x + width - radius, y + height - radius, radius, 0, AX_PI / 2);
    cairo_arc(cr, x + radius, y + height - radius, radius, AX_PI / 2, AX_PI);
    cairo_arc(cr, x + radius, y + radius, radius, AX_PI, 3 * AX_PI / 2);
    cairo_close_path(cr);
}

ax_legend ax_legend_make(const char* title, const ax_palette* palette)
{
    return (ax_legend){.title = title, .palette = *palette, .realised = {INFINITY, -INFINITY}};
}

void ax_legend_count(ax_legend* legend, double value, double weight)
{
    if (!isfinite(value))
        return;
    double range[2];
    ax_palette_range(&legend->palette, range);
    int bin = (int)ax_clamp((value - range[0]) / (range[1] - range[0]) * AX_LEGEND_BINS, 0, AX_LEGEND_BINS - 1);
    legend->bins[bin] += weight;
    legend->realised[0] = fmin(legend->realised[0], value), legend->realised[1] = fmax(legend->realised[1], value);
}

ax_rectangle ax_legend_card(const ax_legend* legend, int height, double unit)
{
    double tall = legend->words[0] ? 144 : 126;
    return (ax_rectangle){MARGIN * unit, height - (MARGIN + tall) * unit, CARD_WIDTH * unit, tall * unit};
}

static void draw_hatch(cairo_t* cr, double x, double y, double width, double height)
{
    cairo_save(cr);
    cairo_rectangle(cr, x, y, width, height);
    cairo_clip(cr);
    set_colour(cr, 0x0b0d10, 0.8);
    cairo_set_line_width(cr, 1);
    for (double at = x - height; at < x + width; at += 5) {
        cairo_move_to(cr, at, y + height);
        cairo_line_to(cr, at + height, y);
    }
    cairo_stroke(cr);
    cairo_restore(cr);
}

static void draw_map(cairo_t* cr, const ax_legend* legend, double x, double y, double width)
{
    double range[2];
    ax_palette_range(&legend->palette, range);
    cairo_save(cr);
    rounded(cr, x, y, width, BAR, 2);
    cairo_clip(cr);
    cairo_set_antialias(cr, CAIRO_ANTIALIAS_NONE); // neighbouring stripes must not let the card shine through
    double stripes = 4 * width;
    for (int k = 0; k < stripes; ++k) {
        double rgb[3];
        ax_palette_colour(&legend->palette, range[0] + (range[1] - range[0]) * (k + 0.5) / stripes, rgb);
        cairo_set_source_rgb(cr, rgb[0], rgb[1], rgb[2]);
        cairo_rectangle(cr, x + width * k / stripes, y, width - width * k / stripes, BAR);
        cairo_fill(cr);
    }
    cairo_set_antialias(cr, CAIRO_ANTIALIAS_GRAY);
    if (legend->palette.kind == AX_PALETTE_CURVATURE)
        draw_hatch(cr, x, y, width / 2, BAR);
    cairo_restore(cr);
}

void ax_legend_draw(cairo_t* cr, const ax_legend* legend, int height, double unit)
{
    ax_rectangle card = ax_legend_card(legend, height, unit);
    double range[2], inner = CARD_WIDTH - 2 * PADDING, tall = card.height / unit;
    ax_palette_range(&legend->palette, range);
    cairo_save(cr);
    cairo_translate(cr, card.x, card.y);
    cairo_scale(cr, unit, unit);
    for (int k = 0; k < 8; ++k) { // a soft shadow from stacked outlines
        rounded(cr, -k, 2 - k, CARD_WIDTH + 2 * k, tall + 2 * k, 10 + k);
        set_colour(cr, 0x15181e, 0.008);
        cairo_fill(cr);
    }
    rounded(cr, 0, 0, CARD_WIDTH, tall, 10);
    set_colour(cr, 0xffffff, 1);
    cairo_fill(cr);
    cairo_translate(cr, PADDING, 0);

    bool scale =
        legend->palette.kind == AX_PALETTE_SCALE || legend->palette.kind == AX_PALETTE_SHADE; // no sign, no zero within
    char text[2][32], both[80];
    int decimals = scale ? 2 : ax_decimals_for(legend->palette.limit) - 1;
    set_font(cr, true, 12);
    set_colour(cr, text1, 1);
    write(cr, legend->title, 0, 25, 0);
    if (legend->realised[0] <= legend->realised[1]) {
        for (int k = 0; k < 2; ++k)
            ax_write_number(text[k], sizeof text[k], legend->realised[k], decimals > 0 ? decimals : 0);
        snprintf(both, sizeof both, "%s to %s", text[0], text[1]);
        set_font(cr, false, 12);
        set_colour(cr, text2, 1);
        write(cr, both, inner, 25, 1);
    }

    double most = 0, map = 40 + HISTOGRAM;
    for (int b = 0; b < AX_LEGEND_BINS; ++b)
        most = fmax(most, legend->bins[b]);
    set_colour(cr, text3, 1);
    for (int b = 0; b < AX_LEGEND_BINS; ++b)
        if (legend->bins[b] > 0) { // what occurs at all is seen
            double bar = fmax(1, (HISTOGRAM - 4) * legend->bins[b] / most);
            cairo_rectangle(cr, inner * b / AX_LEGEND_BINS + 0.4, map - 2 - bar, inner / AX_LEGEND_BINS - 0.8, bar);
        }
    cairo_fill(cr);
    draw_map(cr, legend, 0, map, inner);

    set_colour(cr, text2, 1);
    cairo_set_line_width(cr, 1);
    if (legend->realised[0] <= legend->realised[1]) {
        double end[2];
        for (int k = 0; k < 2; ++k)
            end[k] = inner * ax_clamp((legend->realised[k] - range[0]) / (range[1] - range[0]), 0, 1);
        end[1] = fmax(end[1], end[0] + 1);
        cairo_move_to(cr, ax_clamp(end[0], 0.5, inner - 0.5), map + BAR + 2);
        cairo_rel_line_to(cr, 0, 3.5);
        cairo_line_to(cr, ax_clamp(end[1], 0.5, inner - 0.5), map + BAR + 5.5);
        cairo_rel_line_to(cr, 0, -3.5);
        cairo_stroke(cr);
    }
    if (!scale) {
        cairo_move_to(cr, inner / 2, map - HISTOGRAM + 2);
        cairo_line_to(cr, inner / 2, map + BAR);
        cairo_stroke(cr);
    }
    set_font(cr, false, 11);
    int tick_decimals = scale ? 2 : ax_decimals_for(legend->palette.limit) - 1;
    for (int k = 0; k <= 4; ++k) {
        double value = range[0] + (range[1] - range[0]) * k / 4;
        ax_write_number(text[0], sizeof text[0], value, tick_decimals > 0 && k != 2 ? tick_decimals : scale ? 2 : 0);
        snprintf(both, sizeof both, "%s%s", !scale && value > 0 ? "+" : "", text[0]);
        write(cr, both, inner * k / 4, map + BAR + 21, k / 4.0);
    }
    for (int k = 0; k < 2 && legend->words[k]; ++k)
        write(cr, legend->words[k], k * inner, map + BAR + 39, k);
    cairo_restore(cr);
}

void ax_title_draw(cairo_t* cr, const char* title, const char* text, double unit)
{
    cairo_save(cr);
    cairo_scale(cr, unit, unit);
    set_font(cr, true, 13);
    set_colour(cr, text1, 1);
    double width = write(cr, title, MARGIN, 29, 0);
    set_font(cr, false, 12);
    set_colour(cr, text2, 1);
    write(cr, text, MARGIN + width + 10, 29, 0);
    cairo_restore(cr);
}

void ax_label_draw(cairo_t* cr, const char* text, double x, double y, double unit)
{
    cairo_text_extents_t extents;
    set_font(cr, true, 13 * unit);
    cairo_text_extents(cr, text, &extents);
    double width = extents.x_advance + 12 * unit, height = 22 * unit;
    rounded(cr, x - width / 2, y - height / 2, width, height, 6 * unit);
    set_colour(cr, 0xffffff, 0.92);
    cairo_fill(cr);
    set_colour(cr, text1, 1);
    write(cr, text, x, y + 4.6 * unit, 0.5);
}

ax_scale_bar ax_scale_bar_make(double unit_pixels, double longest)
{
    double length = ax_round_length(longest / unit_pixels);
    return (ax_scale_bar){length, length * unit_pixels};
}

static ax_rectangle scale_bar_place(const ax_scale_bar* bar, int width, int height, double unit)
{
    return (ax_rectangle){width - 24 * unit - bar->pixels, height - 48 * unit, bar->pixels, 24 * unit};
}

static void write_length(char* text, size_t size, double length, const char* unit_name)
{
    char number[32];
    double exponent = log10(length);
    ax_write_number(number, sizeof number, length, exponent < -1e-9 ? (int)ceil(-exponent - 1e-9) : 0);
    snprintf(text, size, "%s%s%s", number, *unit_name ? " " : "", unit_name);
}

void ax_scale_bar_draw(cairo_t* cr, const ax_scale_bar* bar, const char* unit_name, int width, int height, double unit)
{
    ax_rectangle at = scale_bar_place(bar, width, height, unit);
    char text[48];
    write_length(text, sizeof text, bar->length, unit_name);
    cairo_save(cr);
    set_font(cr, false, 12 * unit);
    set_colour(cr, text2, 1);
    write(cr, text, at.x + at.width / 2, at.y + 12 * unit, 0.5);
    cairo_set_line_width(cr, unit);
    double bottom = at.y + at.height - 0.5 * unit;
    cairo_move_to(cr, at.x, bottom - 5 * unit);
    cairo_line_to(cr, at.x, bottom);
    cairo_line_to(cr, at.x + at.width, bottom);
    cairo_line_to(cr, at.x + at.width, bottom - 5 * unit);
    cairo_stroke(cr);
    cairo_restore(cr);
}

void ax_grid_note_draw(cairo_t* cr, double distance, const char* unit_name, int width, int height, double unit)
{
    char length[48], text[64];
    write_length(length, sizeof length, distance, unit_name);
    snprintf(text, sizeof text, "Grid %s", length);
    set_font(cr, false, 12 * unit);
    set_colour(cr, text2, 1);
    write(cr, text, width - 24 * unit, height - 26 * unit, 1);
}
