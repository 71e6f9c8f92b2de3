// Formulas from bytes: a value, the same twice, or a message with a column within the text.
#include "input/formula.h"

#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size);

static void promise(bool kept)
{
    if (!kept)
        abort();
}

int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size)
{
    static const char* const names[] = {"x", "y", "r", "lambda"};
    static const double values[][4] = {{0, 0, 0, 1}, {0.3, -0.4, 0.5, 1.9}, {1e300, -1e300, 1e300, 2}};
    char* text = malloc(size + 1);
    memcpy(text, data, size);
    text[size] = '\0';
    ax_formula* formula;
    ax_error error = {0};
    if (ax_formula_parse(text, 4, names, &formula, &error) == AX_OK) {
        size_t before = ax_allocation_count();
        for (size_t k = 0; k < sizeof values / sizeof *values; ++k) {
            double a = ax_formula_value(formula, values[k]), b = ax_formula_value(formula, values[k]);
            promise(memcmp(&a, &b, sizeof a) == 0);
        }
        promise(ax_allocation_count() == before);
    } else {
        int column;
        promise(!formula && error.message[strlen(error.message) - 1] == '.');
        if (sscanf(error.message, "The formula is wrong at column %d", &column) == 1)
            promise(column >= 1 && (size_t)column <= strlen(text) + 1);
    }
    ax_formula_free(formula);
    free(text);
    return 0;
}
