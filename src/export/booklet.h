// The assembly plan: pages of A3 for the people who join the panels. Lengths on paper are millimetres, x right, y down from the
// upper left corner.
#pragma once

#include "ax/assembly.h"

#include <cairo.h>

// Panels and names that wait to be drawn, see ax_booklet_flush.
typedef struct ax_drawn_panel {
    double corners[3][2];
    unsigned char fill[3], line; // grey
    int order;
} ax_drawn_panel;

typedef struct ax_drawn_name {
    const char* text;
    double middle[2], size;
    unsigned char grey;
    int order;
} ax_drawn_name;

typedef struct ax_booklet {
    cairo_surface_t* surface;
    cairo_t* cairo;
    ax_drawn_panel* panels;
    ax_drawn_name* names;
    int panel_count, name_count, panel_room, name_room;
    const ax_design* design;
    const ax_cut_plan* plan;
    ax_assembly assembly;
    ax_support_frame frame;
    unsigned char* collides; // per panel
    double mm;               // of the design's unit
    int page;
} ax_booklet;

enum { AX_BOOKLET_WIDTH = 420, AX_BOOKLET_HEIGHT = 297, AX_BOOKLET_MARGIN = 15, AX_BOOKLET_TOP = 30 };

typedef struct ax_box {
    double x, y, width, height;
} ax_box;
// What is free below the heading and above the foot.
ax_box ax_booklet_body(void);

void ax_booklet_open(ax_booklet* b, const ax_design* design, const ax_cut_plan* plan, const char* path);
// Releases everything; AX_FAILED if the disk did not take the file.
ax_status ax_booklet_close(ax_booklet* b, const char* path, ax_error* error);

// Begins a page with a heading and a line of explanation below; `section` also names it in the outline, NULL: of the same section.
void ax_booklet_page(ax_booklet* b, const char* section, const char* heading, const char* line);
void ax_booklet_end_page(ax_booklet* b);

typedef enum ax_align { AX_LEFT, AX_CENTRE, AX_RIGHT } ax_align;
// One line with its base line at y; `size` is the font's, mm. Returns its width.
double ax_booklet_text(ax_booklet* b, double x, double y, double size, ax_align align, const char* text);
double ax_booklet_text_width(ax_booklet* b, double size, const char* text);
void ax_booklet_ink(ax_booklet* b, double grey); // 0 black, 1 white

// A table that goes on over columns and pages: cells are handed over row by row.
typedef struct ax_table {
    ax_booklet* b;
    const char *section, *heading, *line;
    ax_box box;
    int columns;
    const char* const* titles;
    const double* widths; // mm; cells but the first are set right
    double x, y;
    bool open;
} ax_table;
void ax_table_row(ax_table* table, const char* const* cells);

// A panel, drawn at the next flush: tinted by its row or its step's piece (the upper of two layers darker), red if it collides with
// another, its name inside if it is legible there. `corners` on paper.
typedef enum ax_panel_style {
    AX_PANEL_NAMED,
    AX_PANEL_ALWAYS_NAMED, // in letters of the least size if need be
    AX_PANEL_PLAIN,
    AX_PANEL_THERE, // pale, named
    AX_PANEL_BACK,  // pale
} ax_panel_style;
void ax_booklet_panel(ax_booklet* b, int panel, const double corners[3][2], ax_panel_style style);
// Draws the panels that wait, none of which may overlap another, all of a colour at once, then their names: what cairo takes is by
// the operation.
void ax_booklet_flush(ax_booklet* b);
// Dots, added to the path, and drawn.
void ax_booklet_dot(ax_booklet* b, const double at[2]);
void ax_booklet_dots(ax_booklet* b, double radius);
// Smaller letters are not written.
#define AX_BOOKLET_LEGIBLE 1.7 // mm, of the font: about 5 pt

// The scale at which all but a tenth of the names have letters of `size` in the flat state.
double ax_booklet_naming_scale(const ax_booklet* b, double size);
// Corner of a flat panel with the rows running to the right, on paper at a scale, y down.
void ax_booklet_flat(const ax_booklet* b, int hinge, double scale, double out[2]);

// Largest round scale 1 : n at which width x height mm fit the box; returns 1 / n and writes "1 : 20".
double ax_booklet_scale(const ax_box* box, double width, double height, char text[32]);

// The sections.
void ax_booklet_title(ax_booklet* b);
void ax_booklet_layout(ax_booklet* b);
void ax_booklet_order(ax_booklet* b);
void ax_booklet_frame(ax_booklet* b);
void ax_booklet_views(ax_booklet* b);
void ax_booklet_collisions(ax_booklet* b); // none if nothing collides
// The axonometric view alone; `names`: with panels' names.
typedef enum ax_booklet_view { AX_VIEW_PLAN, AX_VIEW_FRONT, AX_VIEW_SIDE, AX_VIEW_AXONOMETRIC } ax_booklet_view;
void ax_booklet_draw_view(ax_booklet* b, ax_booklet_view view, const ax_box* box, bool names, char scale[32]);
