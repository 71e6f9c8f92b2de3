// A symmetric matrix as CHOLMOD sees it, sharing its arrays. Without values it is a pattern.
#pragma once

#include "linalg/sparse.h"

#include <cholmod.h>

static inline cholmod_sparse ax_cholmod_view(const ax_sparse* matrix)
{
    return (cholmod_sparse){.nrow = (size_t)matrix->n,
                            .ncol = (size_t)matrix->n,
                            .nzmax = (size_t)matrix->start[matrix->n],
                            .p = matrix->start,
                            .i = matrix->row,
                            .x = matrix->value,
                            .stype = -1,
                            .itype = CHOLMOD_INT,
                            .xtype = matrix->value ? CHOLMOD_REAL : CHOLMOD_PATTERN,
                            .dtype = CHOLMOD_DOUBLE,
                            .sorted = 1,
                            .packed = 1};
}
