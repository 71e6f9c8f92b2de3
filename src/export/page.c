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

void ax_page_draw(cairo_t* cairo, const ax_cut_plan* plan, const ax_cut_sheet* sheet)
{
    double view[4]; // what a page of tiles shows is a small part
    cairo_clip_extents(cairo, &view[0], &view[1], &view[2], &view[3]);
    for (int i = sheet->first; i < sheet->first + sheet->count; ++i) {
        const ax_cut_item* item = plan->items + i;
        const ax_profile_pen* pen = plan->profile->pens + item->operation;
        if (!pen->used)
            continue;
        bool any = false;
        for (int k = item->first; k < item->first + item->count; ++k)
            if (shows(plan, plan->paths + k, view)) {
                trace(cairo, plan, plan->paths + k);
                any = true;
            }
        if (!any)
            continue;
        cairo_set_source_rgb(cairo, pen->rgb[0] / 255.0, pen->rgb[1] / 255.0, pen->rgb[2] / 255.0);
        cairo_set_line_width(cairo, pen->stroke);
        cairo_stroke(cairo);
    }
}
