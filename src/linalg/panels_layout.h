// How a factor lies in memory: shared by its analysis, factorisation and solve.
#pragma once

#include "linalg/panels.h"

enum { AX_PANEL_WIDTH = 4, AX_PANEL_PARTS = AX_PANELS_TREES - 1, AX_FRONT_STRIP = 16, AX_FRONT_ROUND = 8 };

// Up to four columns of a supernode: their triangle (column by column, diagonal as its reciprocal), then the rows below, row by
// row. The panels of a supernode share its list of rows.
typedef struct ax_panel {
    int first, width, rows; // columns first .. first + width - 1, rows below them
    int index;              // of the first row below, into `index`
    size_t value;           // of the triangle; rows * width entries follow it
} ax_panel;

// Columns of equal pattern. Rows: its own columns after the first, then those below.
typedef struct ax_supernode {
    int first, width, rows; // rows below its own
    int index, panel;       // first of its own
    int parent, sibling;    // -1: none
    int child;              // the last one, from which siblings lead to earlier ones
} ax_supernode;

// Columns are numbered part by part, the top last.
struct ax_panels {
    int n, panel_count, node_count;
    ax_panel* panels;
    ax_supernode* nodes;
    int* depth_first; // the nodes of each part as a factorisation visits them
    int*
        index; // rows; those of the top are, in a part, of its own buffer for them, which lie part by part behind row n - 1
    double* value;
    size_t index_count, value_count;
    int* order;
    int parts, top_first;                                               // columns from top_first on are the top's
    int part_column[AX_PANEL_PARTS + 2], part_node[AX_PANEL_PARTS + 2]; // where each part begins, then the top
    int part_panel[AX_PANEL_PARTS + 2];
    size_t stack_size[AX_PANEL_PARTS + 1], front_size[AX_PANEL_PARTS + 1]; // doubles that factorising a part needs
    size_t longest[AX_PANEL_PARTS + 1];                                    // rows of its largest front
    int failed[AX_PANEL_PARTS + 1]; // per part: its first column whose pivot is not positive, -1: none
};

static inline int ax_panels_top(const ax_panels* s)
{
    return s->n - s->top_first;
}

// Rows of a front as stored: a whole number of vectors, and in large ones room for strips that begin anywhere.
static inline size_t ax_front_stride(const ax_supernode* node)
{
    size_t size = (size_t)(node->width + node->rows);
    return (size + (size > 64 ? AX_FRONT_STRIP : 0) + AX_FRONT_ROUND - 1) / AX_FRONT_ROUND * AX_FRONT_ROUND;
}

// Entries of what a front leaves for its parent: the lower triangle of its rows below.
static inline size_t ax_update_size(const ax_supernode* node)
{
    return (size_t)node->rows * ((size_t)node->rows + 1) / 2;
}
