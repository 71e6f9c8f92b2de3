// Pages, words, tables and panels of the assembly plan, and its title page.
#include "export/booklet.h"

#include "base/vec.h"

#include <cairo-pdf.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static const double width = AX_BOOKLET_WIDTH, height = AX_BOOKLET_HEIGHT, margin = AX_BOOKLET_MARGIN;
static const double row_height = 4.6, table_size = 3; // mm
static const double point = 72 / 25.4;                // of PDF, a mm

void ax_booklet_open(ax_booklet* b, const ax_design* design, const ax_cut_plan* plan, const char* path)
{
    char date[40] = "2000-01-01T00:00:00Z"; // when the plan has none: cairo would take the time of writing
    *b = (ax_booklet){.design = design, .plan = plan, .mm = 1000 * ax_unit_in_metres(design->unit)};
    b->assembly = ax_assembly_make(design, plan);
    b->frame = ax_frame_of(design);
    b->collides = AX_NEW0(unsigned char, plan->panel_count);
    for (int i = 0; i < plan->clash_count; ++i)
        b->collides[plan->clashes[i].panels[0]] = b->collides[plan->clashes[i].panels[1]] = 1;
    b->surface = cairo_pdf_surface_create(path, point * width, point * height);
    if (strlen(plan->date) == 10)
        snprintf(date, sizeof date, "%.10sT00:00:00Z", plan->date);
    cairo_pdf_surface_set_metadata(b->surface, CAIRO_PDF_METADATA_CREATE_DATE, date);
    cairo_pdf_surface_set_metadata(b->surface, CAIRO_PDF_METADATA_CREATOR, "Auxshell");
    cairo_pdf_surface_set_metadata(b->surface, CAIRO_PDF_METADATA_TITLE, plan->title);
    b->cairo = cairo_create(b->surface);
    cairo_select_font_face(b->cairo, "Inter", CAIRO_FONT_SLANT_NORMAL, CAIRO_FONT_WEIGHT_NORMAL);
}

ax_status ax_booklet_close(ax_booklet* b, const char* path, ax_error* error)
{
    cairo_destroy(b->cairo);
    cairo_surface_finish(b->surface);
    cairo_status_t status = cairo_surface_status(b->surface);
    cairo_surface_destroy(b->surface);
    ax_assembly_free(&b->assembly);
    ax_frame_free(&b->frame);
    ax_free(b->collides);
    ax_free(b->panels);
    ax_free(b->names);
    return status == CAIRO_STATUS_SUCCESS
               ? AX_OK
               : ax_fail(error, AX_FAILED, "%s could not be written: %s.", path, cairo_status_to_string(status));
}

ax_box ax_booklet_body(void)
{
    return (ax_box){margin, AX_BOOKLET_TOP, width - 2 * margin, height - AX_BOOKLET_TOP - margin - 3};
}

void ax_booklet_ink(ax_booklet* b, double grey)
{
    cairo_set_source_rgb(b->cairo, grey, grey, grey);
}

double ax_booklet_text_width(ax_booklet* b, double size, const char* text)
{
    cairo_text_extents_t e;
    cairo_set_font_size(b->cairo, size);
    cairo_text_extents(b->cairo, text, &e);
    return e.x_advance;
}

double ax_booklet_text(ax_booklet* b, double x, double y, double size, ax_align align, const char* text)
{
    double wide = ax_booklet_text_width(b, size, text);
    cairo_move_to(b->cairo, x - (align == AX_CENTRE ? wide / 2 : align == AX_RIGHT ? wide : 0), y);
    cairo_show_text(b->cairo, text);
    return wide;
}

static void choose_font(ax_booklet* b, bool bold)
{
    cairo_select_font_face(b->cairo, "Inter", CAIRO_FONT_SLANT_NORMAL,
                           bold ? CAIRO_FONT_WEIGHT_BOLD : CAIRO_FONT_WEIGHT_NORMAL);
}

void ax_booklet_page(ax_booklet* b, const char* section, const char* heading, const char* line)
{
    char foot[64];
    cairo_save(b->cairo);
    cairo_scale(b->cairo, point, point);
    ++b->page;
    cairo_set_source_rgb(b->cairo, 1, 1, 1);
    cairo_paint(b->cairo); // cairo keeps the region that operations cover: now the page, whatever follows
    if (section)
        cairo_pdf_surface_add_outline(b->surface, CAIRO_PDF_OUTLINE_ROOT, section, "", CAIRO_PDF_OUTLINE_FLAG_OPEN);
    ax_booklet_ink(b, 0);
    choose_font(b, true);
    ax_booklet_text(b, margin, 19, 6, AX_LEFT, heading);
    choose_font(b, false);
    ax_booklet_ink(b, 0.3);
    ax_booklet_text(b, margin, 25.5, 3.2, AX_LEFT, line);
    snprintf(foot, sizeof foot, "page %d", b->page);
    ax_booklet_text(b, margin, height - 9, 2.8, AX_LEFT, b->plan->title);
    ax_booklet_text(b, width / 2, height - 9, 2.8, AX_CENTRE, b->plan->date);
    ax_booklet_text(b, width - margin, height - 9, 2.8, AX_RIGHT, foot);
    ax_booklet_ink(b, 0);
}

void ax_booklet_end_page(ax_booklet* b)
{
    cairo_restore(b->cairo);
    cairo_show_page(b->cairo);
}

// --- tables

static void put_cells(ax_table* t, const char* const* cells, bool bold)
{
    double x = t->x;
    choose_font(t->b, bold);
    for (int k = 0; k < t->columns; ++k) {
        if (k == 0)
            ax_booklet_text(t->b, x, t->y, table_size, AX_LEFT, cells[k]);
        x += t->widths[k];
        if (k > 0)
            ax_booklet_text(t->b, x - 2, t->y, table_size, AX_RIGHT, cells[k]);
    }
    choose_font(t->b, false);
    t->y += row_height;
}

void ax_table_row(ax_table* t, const char* const* cells)
{
    double wide = 0;
    for (int k = 0; k < t->columns; ++k)
        wide += t->widths[k];
    bool full = t->open && t->y > t->box.y + t->box.height;
    if (full) {
        t->x += wide + 6;
        t->y = t->box.y;
    }
    if (full && t->x + wide > t->box.x + t->box.width) {
        ax_booklet_end_page(t->b);
        ax_booklet_page(t->b, NULL, t->heading, t->line);
        t->box = ax_booklet_body();
    }
    if (!t->open || full) {
        if (!t->open || t->x + wide > t->box.x + t->box.width)
            t->x = t->box.x, t->y = t->box.y;
        t->open = true;
        t->y += table_size;
        put_cells(t, t->titles, true);
    }
    put_cells(t, cells, false);
}

// --- panels

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

// --- the title page

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
    ax_box box = {margin + 150, AX_BOOKLET_TOP, width - 2 * margin - 150, ax_booklet_body().height};
    ax_booklet_draw_view(b, AX_VIEW_AXONOMETRIC, &box, false, scale);
    ax_booklet_end_page(b);
}
