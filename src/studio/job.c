#include "studio/job.h"

#include <string.h>

const job_type* job_find(const char* action)
{
    const job_type* const tables[] = {job_types_steps, job_types_dynamics, job_types_files, job_types_variants};
    for (size_t k = 0; k < sizeof tables / sizeof *tables; ++k)
        for (const job_type* type = tables[k]; type->name; ++type)
            if (strcmp(type->name, action) == 0)
                return type;
    return NULL;
}
