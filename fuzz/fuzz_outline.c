// Drawings from bytes: an outline that keeps its promises, or a message that ends in a full stop.
#include "input/outline.h"

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

static void check(const ax_outline* outline)
{
    promise(outline->count > 0);
    int points = 0;
    for (int c = 0; c < outline->count; ++c) {
        const ax_outline_curve* curve = &outline->curves[c];
        promise(curve->count >= (curve->closed ? 3 : 2) && curve->line >= 1);
        promise(memchr(curve->name, '\0', sizeof curve->name) != NULL);
        points += curve->count;
        for (int k = 0; k < curve->count; ++k)
            promise(isfinite(curve->points[k][0]) && isfinite(curve->points[k][1]));
    }
    promise(points <= 1000000);
    int largest = ax_outline_find(outline, NULL, true), longest = ax_outline_find(outline, "", false);
    promise(largest >= 0 || longest >= 0);
}

int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size)
{
    if (size < 1)
        return 0;
    static const double tolerances[] = {0, 1e-6, 1e-3, 1};
    char* text = malloc(size);
    memcpy(text, data + 1, size - 1);
    text[size - 1] = '\0';
    ax_outline outline;
    ax_error error = {0};
    ax_status status = ax_outline_parse("a.svg", text, size - 1, 1e-3, tolerances[data[0] % 4], &outline, &error);
    if (status == AX_OK)
        check(&outline);
    else {
        promise(status == AX_BAD_INPUT && outline.count == 0 && !outline.curves);
        promise(strlen(error.message) > 20 && error.message[strlen(error.message) - 1] == '.');
    }
    ax_outline_free(&outline);
    free(text);
    return 0;
}
