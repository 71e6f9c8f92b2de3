// PDF at true size, one page a sheet, the overview first.
#include "export/page.h"

#include <cairo-pdf.h>

static ax_status write_sheet(const ax_design* design, const ax_cut_plan* plan, int sheet, const char* path,
                             ax_error* error)
{
    (void)design, (void)sheet;
    cairo_surface_t* surface = ax_page_open(plan, path, 100, 100);
    cairo_t* cairo = cairo_create(surface);
    for (int k = plan->overview.count ? -1 : 0; k < plan->sheet_count; ++k) {
        const ax_cut_sheet* page = k < 0 ? &plan->overview : plan->sheets + k;
        cairo_pdf_surface_set_size(surface, ax_page_points(page->width), ax_page_points(page->height));
        cairo_save(cairo);
        cairo_scale(cairo, ax_page_points(1), -ax_page_points(1));
        cairo_translate(cairo, 0, -page->height);
        ax_page_draw(cairo, plan, page);
        cairo_restore(cairo);
        cairo_show_page(cairo);
    }
    cairo_destroy(cairo);
    return ax_page_close(surface, path, error);
}

const ax_export_type ax_export_pdf = {
    .ending = ".pdf",
    .name = "PDF drawing",
    .doc = "The sheets at true size, one to a page.",
    .default_state = AX_STATE_FLAT,
    .states = {[AX_STATE_DEFAULT] = true, [AX_STATE_FLAT] = true},
    .write_sheet = write_sheet,
    .all_sheets = true,
};
