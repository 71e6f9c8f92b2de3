#include "export/page.h"

#include "fabricate/plan.h"

#include <cairo-pdf.h>
#include <math.h>
#include <stdio.h>
#include <string.h>

cairo_surface_t* ax_page_open(const ax_cut_plan* plan, const char* path, double width, double height)
{
    cairo_surface_t* surface = cairo_pdf_surface_create(path, ax_page_points(width), ax_page_points(height));
    char date[40] = "2000-01-01T00:00:00Z"; // when the plan has none: cairo would take the time of writing
    if (strlen(plan->date) == 10)
        snprintf(date, sizeof date, "%.10sT00:00:00Z", plan->date);
    cairo_pdf_surface_set_metadata(surface, CAIRO_PDF_METADATA_CREATE_DATE, date);
    cairo_pdf_surface_set_metadata(surface, CAIRO_PDF_METADATA_CREATOR, "Auxshell");
    cairo_pdf_surface_set_metadata(surface, CAIRO_PDF_METADATA_TITLE, plan->title);
    return surface;
}

ax_status ax_page_close(cairo_surface_t* surface, const char* path, ax_error* error)
{
    cairo_surface_finish(surface);
    cairo_status_t status = cairo_surface_status(surface);
    cairo_surface_destroy(surface);
    return status == CAIRO_STATUS_SUCCESS
               ? AX_OK
               : ax_fail(error, AX_FAILED, "%s could not be written: %s.", path, cairo_status_to_string(status));
}

static void trace(cairo_t* cairo, const ax_cut_plan* plan, const ax_cut_path* path)
{
    const ax_cut_point* p = plan->points + path->first;
    cairo_new_sub_path(cairo);
    cairo_move_to(cairo, p[0].x, p[0].y);
    int pieces = path->closed ? path->count : path->count - 1;
    for (int k = 0; k < pieces; ++k) {
        const ax_cut_point *a = p + k, *b = p + (k + 1) % path->count;
        if (a->bulge == 0) {
            if (k + 1 < path->count)
                cairo_line_to(cairo, b->x, b->y);
            continue;
        }
        ax_cut_arc arc = ax_cut_arc_of(a, b);
        if (arc.sweep > 0)
            cairo_arc(cairo, arc.centre[0], arc.centre[1], arc.radius, arc.start, arc.start + arc.sweep);
        else
            cairo_arc_negative(cairo, arc.centre[0], arc.centre[1], arc.radius, arc.start, arc.start + arc.sweep);
    }
    if (path->closed)
        cairo_close_path(cairo);
}

// Whether anything of a path can show.
static bool shows(const ax_cut_plan* plan, const ax_cut_path* path, const double view[4])
{
    double lo[2] = {INFINITY, INFINITY}, hi[2] = {-INFINITY, -INFINITY};
    ax_path_bounds(plan, path, lo, hi);
    return lo[0] <= view[2] && hi[0] >= view[0] && lo[1] <= view[3] && hi[1] >= view[1];
}

enum { STROKE = 50 }; // paths

void ax_page_draw(cairo_t* cairo, const ax_cut_plan* plan, const ax_cut_sheet* sheet)
{
    double view[4]; // what a page of tiles shows is a small part
    cairo_clip_extents(cairo, &view[0], &view[1], &view[2], &view[3]);
    int held = 0; // paths that wait for their pen: a stroke of many costs cairo little more than one of one
    for (int i = sheet->first, end = sheet->first + sheet->count; i < end; ++i) {
        const ax_cut_item* item = plan->items + i;
        const ax_profile_pen* pen = plan->profile->pens + item->operation;
        for (int k = item->first; k < item->first + item->count && pen->used; ++k)
            if (shows(plan, plan->paths + k, view)) {
                trace(cairo, plan, plan->paths + k);
                ++held;
            }
        bool last = i + 1 == end || plan->items[i + 1].operation != item->operation;
        if (held == 0 || (!last && held < STROKE))
            continue;
        cairo_set_source_rgb(cairo, pen->rgb[0] / 255.0, pen->rgb[1] / 255.0, pen->rgb[2] / 255.0);
        cairo_set_line_width(cairo, pen->stroke);
        cairo_stroke(cairo);
        held = 0;
    }
}

static const double border = 10, overlap = 10, mark = 5; // mm; printers leave a border white

// Crosses at the corners of what the page adds, and its name in the border.
static void mark_tile(cairo_t* cairo, const double page_size[2], int sheet, int column, int row, int columns, int rows)
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
    snprintf(name, sizeof name, "sheet %d, column %d of %d, row %d of %d; glue on the crosses, print at 100 %%",
             sheet + 1, column + 1, columns, row + 1, rows);
    cairo_select_font_face(cairo, "Inter", CAIRO_FONT_SLANT_NORMAL, CAIRO_FONT_WEIGHT_NORMAL);
    cairo_set_font_size(cairo, 3);
    cairo_save(cairo);
    cairo_translate(cairo, border + 2, border - 4);
    cairo_scale(cairo, 1, -1);
    cairo_move_to(cairo, 0, 0);
    cairo_show_text(cairo, name);
    cairo_restore(cairo);
}

// Whether the way from one point to the next can show; an arc stays within half its chord, times the bulge, of it.
static bool segment_shows(const ax_cut_point* a, const ax_cut_point* b, const double view[4])
{
    double reach = fabs(a->bulge) * hypot(b->x - a->x, b->y - a->y) / 2;
    return fmin(a->x, b->x) - reach <= view[2] && fmax(a->x, b->x) + reach >= view[0] &&
           fmin(a->y, b->y) - reach <= view[3] && fmax(a->y, b->y) + reach >= view[1];
}

static bool anything_shows(const ax_cut_plan* plan, const ax_cut_sheet* sheet, const double view[4])
{
    const ax_cut_item* items = plan->items + sheet->first;
    for (int i = 0; i < sheet->count; ++i)
        for (int k = items[i].first; k < items[i].first + items[i].count; ++k) {
            const ax_cut_path* path = plan->paths + k;
            const ax_cut_point* p = plan->points + path->first;
            for (int j = 0; shows(plan, path, view) && j < path->count - !path->closed; ++j)
                if (segment_shows(p + j, p + (j + 1) % path->count, view))
                    return true;
        }
    return false;
}

ax_status ax_page_tiles(const ax_cut_plan* plan, const double page_size[2], bool leave_out_empty, const char* path,
                        ax_error* error)
{
    cairo_surface_t* surface = ax_page_open(plan, path, page_size[0], page_size[1]);
    cairo_t* cairo = cairo_create(surface);
    double step[2], edge = border + overlap / 2;
    for (int c = 0; c < 2; ++c)
        step[c] = page_size[c] - 2 * border - overlap;
    for (int k = 0; k < plan->sheet_count; ++k) {
        const ax_cut_sheet* whole = plan->sheets + k;
        int columns = (int)ceil(whole->width / step[0]), rows = (int)ceil(whole->height / step[1]);
        for (int row = rows - 1; row >= 0; --row) // top left first, as one reads
            for (int column = 0; column < columns; ++column) {
                const double view[4] = {column * step[0], row * step[1], (column + 1) * step[0], (row + 1) * step[1]};
                if (leave_out_empty && !anything_shows(plan, whole, view))
                    continue;
                cairo_save(cairo);
                cairo_scale(cairo, ax_page_points(1), -ax_page_points(1));
                cairo_translate(cairo, 0, -page_size[1]);
                cairo_save(cairo);
                cairo_rectangle(cairo, border, border, page_size[0] - 2 * border, page_size[1] - 2 * border);
                cairo_clip(cairo);
                cairo_translate(cairo, edge - view[0], edge - view[1]);
                ax_page_draw(cairo, plan, whole);
                cairo_restore(cairo);
                mark_tile(cairo, page_size, k, column, rows - 1 - row, columns, rows);
                cairo_restore(cairo);
                cairo_show_page(cairo);
            }
    }
    cairo_destroy(cairo);
    return ax_page_close(surface, path, error);
}
