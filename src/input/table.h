// Scale factors from CSV. The first line names the columns: `panel,lambda` for panels by name (ax_panel_name), or `x,y,lambda`
// for samples scattered over the sheet (sheet coordinates, document units); "scale" may stand for lambda, further columns are
// passed over. Columns are separated by comma, semicolon or tabulator, whichever the first line has; with semicolons or tabulators a decimal
// comma is read too. Values may be quoted ("" is a quote); empty lines and lines that begin with # are passed over.
#pragma once

#include "ax/linkage.h"

typedef struct ax_table {
    bool by_panel;
    int count;           // rows, at least one
    int* lines;          // of the file, per row
    double* scale;       // per row, > 0
    char (*panels)[16];  // by_panel
    double (*places)[2]; // else
} ax_table;

// At most a million rows. AX_BAD_INPUT names line and column.
ax_status ax_table_read(const char* path, ax_table* out, ax_error* error);
ax_status ax_table_parse(const char* path, const char* bytes, size_t size, ax_table* out, ax_error* error);
void ax_table_free(ax_table* table);

// Sets `scale` (one per triangle). By panel: those that the table names, the others keep theirs; AX_BAD_INPUT with the line if
// there is no such panel, or it is named twice (`path` is for messages). Scattered: all of them, at the centres of the triangles of the sheet (hinge
// places `sheet`), by a local linear fit that takes each sample's value at its place and never leaves the range of the samples
// around.
ax_status ax_table_apply(const ax_table* table, const char* path, const ax_linkage* linkage, const double (*sheet)[2],
                         double* scale, ax_error* error);
