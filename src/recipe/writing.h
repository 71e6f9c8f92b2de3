// Recipes as text.
#pragma once

#include "ax/base.h"

#include <jansson.h>

typedef struct ax_text {
    char* bytes; // zero-terminated, owned
    size_t size, capacity;
} ax_text;

void ax_text_say(ax_text* text, const char* words);
// A value on one line, numbers in the fewest digits that read back to the same bits.
void ax_text_add_json(ax_text* text, const json_t* value);
