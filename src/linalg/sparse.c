#include "linalg/sparse.h"

#include "base/bucket.h"

#include <assert.h>
#include <stdint.h>
#include <string.h>

void ax_sparse_free(ax_sparse* matrix)
{
    ax_free(matrix->start);
    ax_free(matrix->row);
    ax_free(matrix->value);
    *matrix = (ax_sparse){0};
}

void ax_sparse_multiply(const ax_sparse* matrix, const double* x, double* y, int columns)
{
    int n = matrix->n;
    for (int c = 0; c < columns; ++c, x += n, y += n) {
        memset(y, 0, (size_t)n * sizeof *y);
        for (int j = 0; j < n; ++j) {
            double sum = 0, xj = x[j];
            for (int k = matrix->start[j]; k < matrix->start[j + 1]; ++k) {
                int i = matrix->row[k];
                double a = matrix->value[k];
                if (i == j)
                    sum += a * xj;
                else {
                    y[i] += a * xj;
                    sum += a * x[i];
                }
            }
            y[j] += sum;
        }
    }
}

ax_sparse ax_sparse_principal(const ax_sparse* matrix, const int* index)
{
    int count = 0, entries = 0;
    for (int j = 0; j < matrix->n; ++j)
        if (index[j] >= 0) {
            ++count;
            for (int k = matrix->start[j]; k < matrix->start[j + 1]; ++k)
                entries += index[matrix->row[k]] >= 0;
        }
    ax_sparse part = {
        .n = count, .start = AX_NEW(int, count + 1), .row = AX_NEW(int, entries), .value = AX_NEW(double, entries)};
    int used = 0, column = 0;
    for (int j = 0; j < matrix->n; ++j) {
        if (index[j] < 0)
            continue;
        assert(index[j] == column);
        part.start[column++] = used;
        for (int k = matrix->start[j]; k < matrix->start[j + 1]; ++k)
            if (index[matrix->row[k]] >= 0) {
                part.row[used] = index[matrix->row[k]];
                part.value[used++] = matrix->value[k];
            }
    }
    part.start[count] = used;
    return part;
}

void ax_entries_reserve(ax_entries* entries, size_t count)
{
    assert(count < INT32_MAX);
    entries->capacity = (int)count;
    entries->row = ax_realloc(entries->row, count, sizeof *entries->row);
    entries->column = ax_realloc(entries->column, count, sizeof *entries->column);
    entries->value = ax_realloc(entries->value, count, sizeof *entries->value);
}

void ax_entries_add(ax_entries* entries, int row, int column, double value)
{
    if (entries->count == entries->capacity)
        ax_entries_reserve(entries, entries->capacity ? 2 * (size_t)entries->capacity : 1024);
    int k = entries->count++;
    entries->row[k] = row > column ? row : column;
    entries->column[k] = row > column ? column : row;
    entries->value[k] = value;
}

ax_sparse ax_entries_sparse(ax_entries* entries, int n)
{
    int count = entries->count;
    int *by_row = AX_NEW(int, count), *sorted = AX_NEW(int, count), *start = AX_NEW(int, n + 1);
    ax_bucket_sort(count, n, entries->row, NULL, start, by_row); // two stable passes: by row, then by column
    ax_bucket_sort(count, n, entries->column, by_row, start, sorted);

    ax_sparse matrix = {.n = n, .start = AX_NEW(int, n + 1), .row = AX_NEW(int, count), .value = AX_NEW(double, count)};
    int used = 0;
    for (int j = 0; j < n; ++j) {
        matrix.start[j] = used;
        for (int k = start[j]; k < start[j + 1]; ++k) {
            int i = entries->row[sorted[k]];
            if (used > matrix.start[j] && matrix.row[used - 1] == i)
                matrix.value[used - 1] += entries->value[sorted[k]];
            else {
                matrix.row[used] = i;
                matrix.value[used++] = entries->value[sorted[k]];
            }
        }
    }
    matrix.start[n] = used;
    ax_free(by_row);
    ax_free(sorted);
    ax_free(start);
    ax_free(entries->row);
    ax_free(entries->column);
    ax_free(entries->value);
    *entries = (ax_entries){0};
    return matrix;
}

ax_blocks ax_blocks_make(int n, int size, int pair_count, const int (*pairs)[2])
{
    int *low = AX_NEW(int, pair_count), *high = AX_NEW(int, pair_count), count = 0;
    for (int k = 0; k < pair_count; ++k)
        if (pairs[k][0] != pairs[k][1]) {
            low[count] = pairs[k][0] < pairs[k][1] ? pairs[k][0] : pairs[k][1];
            high[count++] = pairs[k][0] < pairs[k][1] ? pairs[k][1] : pairs[k][0];
        }
    int *by_row = AX_NEW(int, count), *sorted = AX_NEW(int, count), *bounds = AX_NEW(int, n + 1);
    ax_bucket_sort(count, n, high, NULL, bounds, by_row);
    ax_bucket_sort(count, n, low, by_row, bounds, sorted);

    ax_blocks blocks = {.n = n, .size = size, .start = AX_NEW(int, n + 1), .row = AX_NEW(int, count)};
    int used = 0;
    for (int j = 0; j < n; ++j) {
        blocks.start[j] = used;
        for (int k = bounds[j]; k < bounds[j + 1]; ++k) {
            int i = high[sorted[k]];
            if (used == blocks.start[j] || blocks.row[used - 1] != i)
                blocks.row[used++] = i;
        }
    }
    blocks.start[n] = used;
    ax_free(low);
    ax_free(high);
    ax_free(by_row);
    ax_free(sorted);
    ax_free(bounds);

    int s = size, entries = n * s * (s + 1) / 2 + used * s * s;
    ax_sparse* matrix = &blocks.matrix;
    *matrix = (ax_sparse){
        .n = n * s, .start = AX_NEW(int, n* s + 1), .row = AX_NEW(int, entries), .value = AX_NEW0(double, entries)};
    int at = 0;
    for (int j = 0; j < n; ++j)
        for (int c = 0; c < s; ++c) {
            matrix->start[j * s + c] = at;
            for (int r = c; r < s; ++r)
                matrix->row[at++] = j * s + r;
            for (int k = blocks.start[j]; k < blocks.start[j + 1]; ++k)
                for (int r = 0; r < s; ++r)
                    matrix->row[at++] = blocks.row[k] * s + r;
        }
    matrix->start[n * s] = at;
    return blocks;
}

void ax_blocks_free(ax_blocks* blocks)
{
    ax_free(blocks->start);
    ax_free(blocks->row);
    ax_sparse_free(&blocks->matrix);
    *blocks = (ax_blocks){0};
}

void ax_blocks_clear(ax_blocks* blocks)
{
    memset(blocks->matrix.value, 0, (size_t)blocks->matrix.start[blocks->matrix.n] * sizeof(double));
}

int ax_blocks_find(const ax_blocks* blocks, int i, int j)
{
    int low = i < j ? i : j, high = i < j ? j : i;
    int a = blocks->start[low], b = blocks->start[low + 1];
    while (a < b) {
        int middle = a + (b - a) / 2;
        if (blocks->row[middle] < high)
            a = middle + 1;
        else
            b = middle;
    }
    return a < blocks->start[low + 1] && blocks->row[a] == high ? a : -1;
}

void ax_blocks_add_diagonal(ax_blocks* blocks, int node, const double* block)
{
    int s = blocks->size;
    for (int c = 0; c < s; ++c) {
        double* column = blocks->matrix.value + blocks->matrix.start[node * s + c] - c;
        for (int r = c; r < s; ++r)
            column[r] += block[r * s + c];
    }
}

void ax_blocks_add(ax_blocks* blocks, int k, int smaller, const double* block)
{
    int s = blocks->size;
    assert(k >= blocks->start[smaller] && k < blocks->start[smaller + 1]);
    for (int c = 0; c < s; ++c) {
        double* column =
            blocks->matrix.value + blocks->matrix.start[smaller * s + c] + (s - c) + (k - blocks->start[smaller]) * s;
        for (int r = 0; r < s; ++r)
            column[r] += block[r * s + c];
    }
}
