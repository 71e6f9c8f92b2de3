// Tables from bytes: rows that can be applied, or a message.
#include "input/table.h"

#include <math.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size);

static void promise(bool kept)
{
    if (!kept)
        abort();
}

static void apply(const ax_table* table)
{
    int triangles[2][3] = {{0, 1, 2}, {0, 2, 3}}, panels[2][3] = {{0, 0, 0}, {0, 0, 1}};
    ax_linkage linkage = {.triangle_count = 2, .hinge_count = 4, .triangles = triangles, .panels = panels};
    double sheet[4][2] = {{0, 0}, {1, 0}, {1, 1}, {0, 1}}, scale[2] = {1, 1};
    if (ax_table_apply(table, "a.csv", &linkage, (const double(*)[2])sheet, scale, NULL) == AX_OK)
        promise(scale[0] > 0 && isfinite(scale[0]) && scale[1] > 0 && isfinite(scale[1]));
    else
        promise(table->by_panel && scale[0] == 1 && scale[1] == 1);
}

int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size)
{
    char* text = malloc(size + 1);
    memcpy(text, data, size);
    text[size] = '\0';
    ax_table table;
    ax_error error = {0};
    if (ax_table_parse("a.csv", text, size, &table, &error) == AX_OK) {
        promise(table.count > 0 && (table.by_panel ? table.panels != NULL : table.places != NULL));
        apply(&table);
    } else
        promise(table.count == 0 && error.message[strlen(error.message) - 1] == '.');
    ax_table_free(&table);
    free(text);
    return 0;
}
