// Where in a JSON text something stands, for messages: jansson tells it of syntax alone.
#pragma once

#include "ax/base.h"

// From the outermost value inwards: the number of the member of an object, or of the element of an array.
typedef struct ax_json_path {
    int depth, steps[4];
    bool key; // of the last step the key, not the value
} ax_json_path;

typedef struct ax_json_place {
    int line, column; // from 1; columns count characters
} ax_json_place;

// The place at which the value or key begins. The text must be valid JSON that has it.
ax_json_place ax_json_find(const char* text, const ax_json_path* path);
