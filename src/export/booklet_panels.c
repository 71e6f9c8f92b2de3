// Panels and their names in the assembly plan, and the scales at which they show.
#include "export/booklet.h"

#include "base/vec.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

// A line without length has round ends and a tenth of a circle's numbers.
void ax_booklet_dot(ax_booklet* b, const double at[2])
{
    cairo_move_to(b->cairo, at[0], at[1]);
    cairo_line_to(b->cairo, at[0], at[1]);
}

void ax_booklet_dots(ax_booklet* b, double radius)
{
    cairo_set_line_cap(b->cairo, CAIRO_LINE_CAP_ROUND);
    cairo_set_line_width(b->cairo, 2 * radius);
    cairo_stroke(b->cairo);
    cairo_set_line_cap(b->cairo, CAIRO_LINE_CAP_BUTT);
}

// Size of the letters with which a name of this length would fit a triangle; below AX_BOOKLET_LEGIBLE: too small.
static double name_size(const double corners[3][2], int letters)
{
    double around = 0, twice = fabs(ax_orient2(corners[0], corners[1], corners[2]));
    for (int k = 0; k < 3; ++k)
        around += ax_distance2(corners[k], corners[(k + 1) % 3]);
    double inscribed = around > 0 ? twice / around : 0;
    return inscribed / hypot(0.31 * letters, 0.36); // halves of a letter's advance and of its height, in sizes
}

void ax_booklet_panel(ax_booklet* b, int panel, const double corners[3][2], ax_panel_style style)
{
    static const double tints[][3] = {{0.80, 0.88, 0.95}, {0.98, 0.90, 0.76}, {0.85, 0.93, 0.82},
                                      {0.93, 0.84, 0.93}, {0.98, 0.96, 0.72}, {0.86, 0.86, 0.86}};
    enum { TINTS = sizeof tints / sizeof *tints };
    const ax_cut_panel* p = &b->plan->panels[panel];
    static const double red[] = {0.98, 0.55, 0.5};
    const double* tint =
        b->collides[panel] ? red
                           : tints[b->assembly.by_pieces ? b->assembly.step_of[panel] % TINTS : ((p->row % 3) + 3) % 3];
    bool faded = style == AX_PANEL_THERE || style == AX_PANEL_BACK;
    double shade = p->layer ? 0.86 : 1, pale = faded ? 0.6 : 0;
    if (b->panel_count == b->panel_room) {
        b->panel_room = 2 * b->panel_room + 256;
        b->panels = ax_realloc(b->panels, (size_t)b->panel_room, sizeof *b->panels);
    }
    ax_drawn_panel* drawn = &b->panels[b->panel_count];
    *drawn = (ax_drawn_panel){.line = faded ? 191 : 64, .order = b->panel_count++};
    memcpy(drawn->corners, corners, sizeof drawn->corners);
    for (int k = 0; k < 3; ++k)
        drawn->fill[k] = (unsigned char)lround(255 * (shade * tint[k] * (1 - pale) + pale));
    double size = name_size(corners, (int)strlen(p->name));
    if (style == AX_PANEL_ALWAYS_NAMED)
        size = fmax(size, AX_BOOKLET_LEGIBLE + 0.01);
    size = fmin(4, floor(10 * size) / 10); // a few sizes only: cairo makes a font of each
    if (style == AX_PANEL_PLAIN || style == AX_PANEL_BACK || size < AX_BOOKLET_LEGIBLE)
        return;
    if (b->name_count == b->name_room) {
        b->name_room = 2 * b->name_room + 256;
        b->names = ax_realloc(b->names, (size_t)b->name_room, sizeof *b->names);
    }
    ax_drawn_name* name = &b->names[b->name_count];
    *name = (ax_drawn_name){.text = p->name, .size = size, .grey = faded ? 128 : 0, .order = b->name_count++};
    // in the middle of the inscribed circle
    double weight[3], sum = 0;
    for (int k = 0; k < 3; ++k)
        sum += weight[k] = ax_distance2(corners[(k + 1) % 3], corners[(k + 2) % 3]);
    for (int k = 0; k < 3; ++k)
        for (int d = 0; d < 2; ++d)
            name->middle[d] += weight[k] / sum * corners[k][d];
}

static bool same_colours(const ax_drawn_panel* a, const ax_drawn_panel* b)
{
    return a->line == b->line && memcmp(a->fill, b->fill, sizeof a->fill) == 0;
}

static int by_colours(const void* a, const void* b)
{
    const ax_drawn_panel *x = a, *y = b;
    return x->line != y->line   ? y->line - x->line
           : same_colours(x, y) ? x->order - y->order
                                : memcmp(x->fill, y->fill, sizeof x->fill);
}

static bool same_ink(const ax_drawn_name* a, const ax_drawn_name* b)
{
    return a->size == b->size && a->grey == b->grey;
}

static int by_ink(const void* a, const void* b)
{
    const ax_drawn_name *x = a, *y = b;
    return x->size != y->size   ? (x->size > y->size) - (x->size < y->size)
           : x->grey != y->grey ? x->grey - y->grey
                                : x->order - y->order;
}

static void draw_panels(ax_booklet* b)
{
    cairo_t* c = b->cairo;
    cairo_set_line_width(c, 0.1);
    cairo_set_line_join(c, CAIRO_LINE_JOIN_ROUND);
    cairo_new_path(c);
    for (int i = 0; i < b->panel_count; ++i) {
        const ax_drawn_panel* p = &b->panels[i];
        for (int k = 0; k < 3; ++k)
            (k ? cairo_line_to : cairo_move_to)(c, p->corners[k][0], p->corners[k][1]);
        cairo_close_path(c);
        if (i + 1 < b->panel_count && same_colours(p, p + 1))
            continue;
        cairo_set_source_rgb(c, p->fill[0] / 255.0, p->fill[1] / 255.0, p->fill[2] / 255.0);
        cairo_fill_preserve(c);
        ax_booklet_ink(b, p->line / 255.0);
        cairo_stroke(c);
    }
    b->panel_count = 0;
}

typedef struct glyphs {
    cairo_glyph_t* list;
    int count, room;
} glyphs;

// Adds a name with its middle where it shall be.
static void add_glyphs(cairo_scaled_font_t* font, const ax_drawn_name* name, glyphs* g)
{
    cairo_glyph_t* set = NULL;
    cairo_text_extents_t e;
    int more = 0;
    if (cairo_scaled_font_text_to_glyphs(font, name->middle[0], name->middle[1] + 0.36 * name->size, name->text, -1,
                                         &set, &more, NULL, NULL, NULL) != CAIRO_STATUS_SUCCESS)
        return;
    cairo_scaled_font_glyph_extents(font, set, more, &e);
    if (g->count + more > g->room) {
        g->room = 2 * g->room + more + 256;
        g->list = ax_realloc(g->list, (size_t)g->room, sizeof *g->list);
    }
    for (int k = 0; k < more; ++k) {
        set[k].x -= e.x_advance / 2;
        g->list[g->count++] = set[k];
    }
    cairo_glyph_free(set);
}

static void draw_names(ax_booklet* b)
{
    glyphs g = {0};
    for (int i = 0; i < b->name_count; ++i) {
        const ax_drawn_name* n = &b->names[i];
        if (g.count == 0)
            cairo_set_font_size(b->cairo, n->size);
        add_glyphs(cairo_get_scaled_font(b->cairo), n, &g);
        if (i + 1 < b->name_count && same_ink(n, n + 1))
            continue;
        ax_booklet_ink(b, n->grey / 255.0);
        cairo_show_glyphs(b->cairo, g.list, g.count);
        g.count = 0;
    }
    ax_booklet_ink(b, 0);
    ax_free(g.list);
    b->name_count = 0;
}

void ax_booklet_flush(ax_booklet* b)
{
    if (b->panel_count)
        qsort(b->panels, (size_t)b->panel_count, sizeof *b->panels, by_colours);
    if (b->name_count)
        qsort(b->names, (size_t)b->name_count, sizeof *b->names, by_ink);
    draw_panels(b);
    draw_names(b);
}

static int ascending(const void* a, const void* b)
{
    double x = *(const double*)a, y = *(const double*)b;
    return (x > y) - (x < y);
}

void ax_booklet_flat(const ax_booklet* b, int hinge, double scale, double out[2])
{
    const double *p = b->design->flat[hinge], *u = b->assembly.along, s = scale * b->mm;
    out[0] = s * (u[0] * p[0] + u[1] * p[1]);
    out[1] = -s * (u[0] * p[1] - u[1] * p[0]);
}

double ax_booklet_naming_scale(const ax_booklet* b, double size)
{
    int n = b->plan->panel_count;
    double* sizes = AX_NEW(double, n);
    for (int t = 0; t < n; ++t) {
        double corners[3][2];
        for (int k = 0; k < 3; ++k)
            ax_booklet_flat(b, b->design->linkage.triangles[t][k], 1, corners[k]);
        sizes[t] = name_size((const double(*)[2])corners, (int)strlen(b->plan->panels[t].name));
    }
    qsort(sizes, (size_t)n, sizeof *sizes, ascending);
    double tenth = sizes[n / 10];
    ax_free(sizes);
    return size / tenth;
}

double ax_booklet_scale(const ax_box* box, double wide, double high, char text[32])
{
    static const double steps[] = {1, 1.5, 2, 2.5, 3, 4, 5, 6, 7.5};
    enum { STEPS = sizeof steps / sizeof *steps };
    double needed = fmax(fmax(wide / box->width, high / box->height), 1e-3);
    double decade = pow(10, floor(log10(needed)));
    double n = 10 * decade;
    for (int k = STEPS - 1; k >= 0; --k)
        if (steps[k] * decade >= needed * (1 - 1e-12))
            n = steps[k] * decade;
    if (n >= 1)
        snprintf(text, 32, "1 : %g", n);
    else
        snprintf(text, 32, "%g : 1", 1 / n);
    return 1 / n;
}
