// Cut plans as PDF. The lines are written directly: cairo took over ten times as long (docs/making.md, Tried and rejected).
#pragma once

#include "ax/export.h"

// The sheets at true size, a page each, the overview first.
ax_status ax_page_sheets(const ax_cut_plan* plan, const char* path, ax_error* error);

// The sheets at true size over pages that overlap, with marks for gluing; those on which nothing would show may be left out.
ax_status ax_page_tiles(const ax_cut_plan* plan, const double page_size[2], bool leave_out_empty, const char* path,
                        ax_error* error);
