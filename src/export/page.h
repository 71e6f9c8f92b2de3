// Cut plans drawn with cairo, for PDF.
#pragma once

#include "ax/export.h"

#include <cairo.h>

// Millimetres to the points of PDF.
static inline double ax_page_points(double mm)
{
    return mm * 72 / 25.4;
}

// A PDF surface whose bytes depend on the plan alone: no time of writing in it.
cairo_surface_t* ax_page_open(const ax_cut_plan* plan, const char* path, double width, double height);
// Finishes and destroys; AX_FAILED if the disk did not take it.
ax_status ax_page_close(cairo_surface_t* surface, const char* path, ax_error* error);

// Draws the lines of a sheet in the colours of the plan's profile; the user space is millimetres, y up.
void ax_page_draw(cairo_t* cairo, const ax_cut_plan* plan, const ax_cut_sheet* sheet);

// The sheets at true size over pages that overlap, with marks for gluing; those on which nothing would show may be left out.
ax_status ax_page_tiles(const ax_cut_plan* plan, const double page_size[2], bool leave_out_empty, const char* path,
                        ax_error* error);
