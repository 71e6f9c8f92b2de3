#include "solver/load.h"

#include <string.h>

const ax_load_type* ax_load_find(const char* name)
{
    int count;
    const ax_load_type* const* types = ax_load_types(&count);
    for (int k = 0; k < count; ++k)
        if (strcmp(types[k]->name, name) == 0)
            return types[k];
    return NULL;
}
