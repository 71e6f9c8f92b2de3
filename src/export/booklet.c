// Pages, words and tables of the assembly plan.
#include "export/booklet.h"

#include "base/vec.h"

#include <cairo-pdf.h>
#include <stdio.h>
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
