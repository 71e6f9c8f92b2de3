// Symmetric sparse matrices: lower triangle, compressed columns, rows sorted within each column.
#pragma once

#include "ax/base.h"

typedef struct ax_sparse {
    int n;
    int* start;    // n + 1
    int* row;      // start[n]
    double* value; // start[n]
} ax_sparse;

void ax_sparse_free(ax_sparse* matrix);
// y = A x, for `columns` vectors stored one after the other.
void ax_sparse_multiply(const ax_sparse* matrix, const double* x, double* y, int columns);

// The rows and columns i with index[i] >= 0, renumbered to index[i]. `index` grows with i over those and has n entries.
ax_sparse ax_sparse_principal(const ax_sparse* matrix, const int* index);

// Assembly by entries: entries of either triangle are folded into the lower one, equal places are summed, in the order
// in which they were added. Off-diagonal entries stand for both (i, j) and (j, i): add each symmetric pair once.
typedef struct ax_entries {
    int count, capacity;
    int *row, *column;
    double* value;
} ax_entries;

void ax_entries_reserve(ax_entries* entries, size_t count); // room for `count` of them
void ax_entries_add(ax_entries* entries, int row, int column, double value);
ax_sparse ax_entries_sparse(ax_entries* entries, int n); // consumes the entries

// Symmetric matrices of dense square blocks of one size, for several unknowns per node. The pattern comes from a list of
// node pairs; values are added block by block in constant time.
typedef struct ax_blocks {
    int n, size;      // nodes, unknowns per node
    int* start;       // per node: its off-diagonal blocks (i, j), i > j, in column j
    int* row;         // node index of each, sorted
    ax_sparse matrix; // n * size unknowns
} ax_blocks;

// `pairs` may hold duplicates, either order, and diagonal pairs; the diagonal is always present.
ax_blocks ax_blocks_make(int n, int size, int pair_count, const int (*pairs)[2]);
void ax_blocks_free(ax_blocks* blocks);
void ax_blocks_clear(ax_blocks* blocks);
// Index of the off-diagonal block of nodes i and j (either order), or -1 if it is not in the pattern.
int ax_blocks_find(const ax_blocks* blocks, int i, int j);
// Adds a symmetric size x size block (row-major) on the diagonal; only its lower triangle is read.
void ax_blocks_add_diagonal(ax_blocks* blocks, int node, const double* block);
// Adds block k, whose rows belong to the larger node and columns to the smaller one (row-major).
void ax_blocks_add(ax_blocks* blocks, int k, int smaller, const double* block);
