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
