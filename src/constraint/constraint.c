#include "constraint/constraint_type.h"

#include <string.h>

const ax_constraint_type* ax_constraint_find(const char* name)
{
    int count;
    const ax_constraint_type* const* types = ax_constraint_types(&count);
    for (int k = 0; k < count; ++k)
        if (strcmp(types[k]->name, name) == 0)
            return types[k];
    return NULL;
}

const ax_parameter* ax_parameter_find(const ax_constraint_type* type, const char* name)
{
    for (int k = 0; k < type->parameter_count; ++k)
        if (strcmp(type->parameters[k].name, name) == 0)
            return &type->parameters[k];
    return NULL;
}

void ax_constraint_defaults(const ax_constraint_type* type, int points, ax_lane* block)
{
    for (int k = 0; k < type->parameter_count; ++k) {
        const ax_parameter* parameter = &type->parameters[k];
        bool direction = strcmp(parameter->unit, "direction") == 0;
        for (int i = 0; i < parameter->lanes; ++i)
            for (int l = 0; l < AX_W; ++l)
                block[parameter->offset + i][l] = direction ? i == 2 : parameter->standard;
    }
    if (type->prepare)
        type->prepare(block, points);
}
