// The arguments of an operator, read from its JSON object by the operator's fields.
#pragma once

#include "ax/recipe.h"
#include "recipe/place.h"

#include <jansson.h>

typedef struct ax_arguments {
    const ax_operator_type* type;
    void* values;  // type->size bytes
    json_t* texts; // owns what texts point to
    double** lists;
    int list_count; // owned blocks behind points
} ax_arguments;

// Checks every member against the fields of the operator that "op" names, and the fields among one another. AX_BAD_INPUT: the
// message lacks the place, which is *at, relative to the object.
ax_status ax_arguments_read(json_t* object, ax_arguments* out, ax_json_path* at, ax_error* error);
void ax_arguments_free(ax_arguments* arguments);
