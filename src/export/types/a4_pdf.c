// PDF at true size on A4, to be printed on an office printer and glued: pages overlap, marks show where.
#include "export/page.h"

#include <cairo-pdf.h>
#include <math.h>
#include <stdio.h>

static const double page_size[2] = {210, 297}, border = 10, overlap = 10, mark = 5; // mm; printers leave a border white

// Crosses at the corners of what the page adds, and its name in the border.
static void mark_tile(cairo_t* cairo, int sheet, int column, int row, int columns, int rows)
{
    char name[192];
    double lo[2] = {border + overlap / 2, border + overlap / 2};
    double hi[2] = {page_size[0] - lo[0], page_size[1] - lo[1]};
    cairo_set_source_rgb(cairo, 0.5, 0.5, 0.5);
    cairo_set_line_width(cairo, 0.1);
    for (int k = 0; k < 4; ++k) {
        double x = k & 1 ? hi[0] : lo[0], y = k & 2 ? hi[1] : lo[1];
        cairo_move_to(cairo, x - mark, y);
        cairo_line_to(cairo, x + mark, y);
        cairo_move_to(cairo, x, y - mark);
        cairo_line_to(cairo, x, y + mark);
    }
    cairo_stroke(cairo);
    snprintf(name, sizeof name, "sheet %d, column %d of %d, row %d of %d; glue on the crosses, print at 100 %%", sheet + 1,
             column + 1, columns, row + 1, rows);
    cairo_select_font_face(cairo, "Inter", CAIRO_FONT_SLANT_NORMAL, CAIRO_FONT_WEIGHT_NORMAL);
    cairo_set_font_size(cairo, 3);
    cairo_save(cairo);
    cairo_translate(cairo, border + 2, border - 4);
    cairo_scale(cairo, 1, -1);
    cairo_move_to(cairo, 0, 0);
    cairo_show_text(cairo, name);
    cairo_restore(cairo);
}

static ax_status write_sheet(const ax_design* design, const ax_cut_plan* plan, int sheet, const char* path, ax_error* error)
{
    (void)design, (void)sheet;
    cairo_surface_t* surface = ax_page_open(plan, path, page_size[0], page_size[1]);
    cairo_t* cairo = cairo_create(surface);
    double step[2];
    for (int c = 0; c < 2; ++c)
        step[c] = page_size[c] - 2 * border - overlap;
    for (int k = 0; k < plan->sheet_count; ++k) {
        const ax_cut_sheet* whole = plan->sheets + k;
        int columns = (int)ceil(whole->width / step[0]), rows = (int)ceil(whole->height / step[1]);
        for (int row = rows - 1; row >= 0; --row) // top left first, as one reads
            for (int column = 0; column < columns; ++column) {
                cairo_save(cairo);
                cairo_scale(cairo, ax_page_points(1), -ax_page_points(1));
                cairo_translate(cairo, 0, -page_size[1]);
                cairo_save(cairo);
                cairo_rectangle(cairo, border, border, page_size[0] - 2 * border, page_size[1] - 2 * border);
                cairo_clip(cairo);
                double edge = border + overlap / 2;
                cairo_translate(cairo, edge - column * step[0], edge - row * step[1]);
                ax_page_draw(cairo, plan, whole);
                cairo_restore(cairo);
                mark_tile(cairo, k, column, rows - 1 - row, columns, rows);
                cairo_restore(cairo);
                cairo_show_page(cairo);
            }
    }
    cairo_destroy(cairo);
    return ax_page_close(surface, path, error);
}

const ax_export_type ax_export_a4_pdf = {
    .ending = ".a4.pdf",
    .name = "PDF tiles",
    .doc = "The sheets at true size over pages of A4 that overlap, with marks for gluing.",
    .default_state = AX_STATE_FLAT,
    .states = {[AX_STATE_DEFAULT] = true, [AX_STATE_FLAT] = true},
    .write_sheet = write_sheet,
    .all_sheets = true,
};
