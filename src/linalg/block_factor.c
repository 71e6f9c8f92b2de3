#include "linalg/block_factor.h"

#include "linalg/order.h"
#include "linalg/panels.h"

#include <assert.h>

enum { LANES = sizeof(ax_vec4) / sizeof(double) };

struct ax_block_factor {
    ax_pool* pool;
    ax_panels* panels;
    ax_vec4* x; // in elimination order
    int unknowns;
};

ax_block_factor* ax_block_factor_make(const ax_blocks* blocks, const double (*place)[3], ax_pool* pool)
{
    ax_block_factor* f = AX_NEW0(ax_block_factor, 1);
    int size = blocks->size, *node = AX_NEW(int, blocks->n), *order = AX_NEW(int, blocks->matrix.n);
    ax_sparse graph = {.n = blocks->n, .start = blocks->start, .row = blocks->row};
    ax_order_by_place(&graph, place, pool, node);
    for (int u = 0; u < blocks->matrix.n; ++u)
        order[u] = node[u / size] * size + u % size;
    f->pool = pool;
    f->unknowns = blocks->matrix.n;
    f->panels = ax_panels_analyse(&blocks->matrix, order);
    f->x = ax_alloc_aligned(ax_panels_rows(f->panels), sizeof *f->x);
    ax_free(node);
    ax_free(order);
    return f;
}

void ax_block_factor_free(ax_block_factor* f)
{
    if (!f)
        return;
    ax_panels_free(f->panels);
    ax_free(f->x);
    ax_free(f);
}

bool ax_block_factor_run(ax_block_factor* f, const ax_blocks* blocks)
{
    return ax_panels_factor(f->panels, &blocks->matrix, f->pool);
}

void ax_block_factor_solve(ax_block_factor* f, const double* b, double* x, int columns)
{
    const int* order = ax_panels_order(f->panels);
    size_t n = (size_t)f->unknowns;
    assert(columns >= 1 && columns <= LANES);
    for (size_t k = 0; k < n; ++k)
        for (int c = 0; c < LANES; ++c)
            f->x[k][c] = c < columns ? b[(size_t)c * n + (size_t)order[k]] : 0;
    ax_panels_solve(f->panels, f->pool, f->x);
    for (size_t k = 0; k < n; ++k)
        for (int c = 0; c < columns; ++c)
            x[(size_t)c * n + (size_t)order[k]] = f->x[k][c];
}

bool ax_block_factor_negative(ax_block_factor* f, int part, double* x)
{
    const int* order = ax_panels_order(f->panels);
    if (!ax_panels_negative(f->panels, part, f->x))
        return false;
    for (int u = 0; u < f->unknowns; ++u)
        x[order[u]] = f->x[u][0];
    return true;
}
