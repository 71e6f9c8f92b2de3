// Numerical factorisation by fronts (Duff and Reid 1983): each supernode gathers its matrix entries and what its children left
// into a dense front, eliminates its columns, and leaves the rest for its parent. Parts are factorised side by side; in the top,
// where fronts are large, threads share the columns of one front.
#include "linalg/panels_layout.h"

#include <math.h>
#include <stdatomic.h>
#include <string.h>

// Columns eliminated before the rest of the front is updated, columns that one task updates, rows that are updated at once.
enum { BLOCK = 64, COLUMNS_PER_TASK = 16, LEAST_SHARED = 128, STRIP = AX_FRONT_STRIP };

typedef double v4 __attribute__((vector_size(32)));
typedef double loose4 __attribute__((vector_size(32), aligned(8)));

typedef struct factoring {
    ax_panels* panels;
    ax_pool* pool;
    // the matrix by columns in elimination order, diagonals apart
    const int *start, *row;
    const double *value, *diagonal;
    double** update; // per supernode: what it left
    double* stack[AX_PANEL_PARTS + 1];
    atomic_bool failed;
} factoring;

// A front: columns of `stride` doubles, its lower triangle in use, rows behind the last one zero.
typedef struct front {
    double* entry;
    size_t stride;
    int size, from, to; // rows; columns from .. to - 1 are to be subtracted
    int first, block;   // first column to update, columns a task
    double*
        packed; // rows from `first` on of the columns to subtract: strips of eight rows, in each column after column
} front;

// entry[:, j .. j + W) -= sum over k of entry[:, k] entry[j .. j + W, k]. Rows above the diagonal get values that nobody reads.
#define UPDATE(W)                                                                                                      \
    static void update_##W(const front* f, int j)                                                                      \
    {                                                                                                                  \
        int row = j / 4 * 4, rows = (f->size + 3) / 4 * 4;                                                             \
        double* column = f->entry + (size_t)j * f->stride;                                                             \
        for (; row + 8 <= rows; row += 8) {                                                                            \
            v4 a[W], b[W];                                                                                             \
            for (int c = 0; c < W; ++c) {                                                                              \
                a[c] = *(v4*)(column + (size_t)c * f->stride + row);                                                   \
                b[c] = *(v4*)(column + (size_t)c * f->stride + row + 4);                                               \
            }                                                                                                          \
            const double* at = f->entry + (size_t)f->from * f->stride;                                                 \
            for (int k = f->from; k < f->to; ++k, at += f->stride) {                                                   \
                v4 p = *(const v4*)(at + row), q = *(const v4*)(at + row + 4);                                         \
                for (int c = 0; c < W; ++c) {                                                                          \
                    a[c] -= p * at[j + c];                                                                             \
                    b[c] -= q * at[j + c];                                                                             \
                }                                                                                                      \
            }                                                                                                          \
            for (int c = 0; c < W; ++c) {                                                                              \
                *(v4*)(column + (size_t)c * f->stride + row) = a[c];                                                   \
                *(v4*)(column + (size_t)c * f->stride + row + 4) = b[c];                                               \
            }                                                                                                          \
        }                                                                                                              \
        if (row < rows) {                                                                                              \
            v4 a[W];                                                                                                   \
            for (int c = 0; c < W; ++c)                                                                                \
                a[c] = *(v4*)(column + (size_t)c * f->stride + row);                                                   \
            const double* at = f->entry + (size_t)f->from * f->stride;                                                 \
            for (int k = f->from; k < f->to; ++k, at += f->stride) {                                                   \
                v4 p = *(const v4*)(at + row);                                                                         \
                for (int c = 0; c < W; ++c)                                                                            \
                    a[c] -= p * at[j + c];                                                                             \
            }                                                                                                          \
            for (int c = 0; c < W; ++c)                                                                                \
                *(v4*)(column + (size_t)c * f->stride + row) = a[c];                                                   \
        }                                                                                                              \
    }
UPDATE(1)
UPDATE(2)
UPDATE(3)
UPDATE(4)

static void update_columns(const front* f, int from, int to)
{
    static void (*const kernel[])(const front*, int) = {NULL, update_1, update_2, update_3, update_4};
    for (int j = from; j < to; j += 4)
        kernel[to - j < 4 ? to - j : 4](f, j);
}

static int strip_count(const front* f)
{
    return (f->size - f->first + STRIP - 1) / STRIP;
}

static void pack_strip(void* context, int strip)
{
    const front* f = context;
    int row = f->first + strip * STRIP, rows = f->size - row < STRIP ? f->size - row : STRIP;
    double* to = f->packed + (size_t)strip * BLOCK * STRIP;
    for (int k = f->from; k < f->to; ++k, to += STRIP) {
        const double* from = f->entry + (size_t)k * f->stride + row;
        for (int r = 0; r < STRIP; ++r)
            to[r] = r < rows ? from[r] : 0;
    }
}

// Four columns from j on, in the rows of one strip: what the kernels above do, in the same order, but reading memory as it lies.
static void update_strip(const front* f, int strip, int j)
{
    int row = f->first + strip * STRIP, depth = f->to - f->from;
    const double* a = f->packed + (size_t)strip * BLOCK * STRIP;
    const double* b = f->packed + (size_t)((j - f->first) / STRIP) * BLOCK * STRIP + (j - f->first) % STRIP;
    double* column = f->entry + (size_t)j * f->stride + row;
    v4 lower[4], upper[4];
    for (int c = 0; c < 4; ++c) {
        lower[c] = *(loose4*)(column + (size_t)c * f->stride);
        upper[c] = *(loose4*)(column + (size_t)c * f->stride + 4);
    }
    for (int k = 0; k < depth; ++k, a += STRIP, b += STRIP) {
        v4 p = *(const v4*)a, q = *(const v4*)(a + 4);
        for (int c = 0; c < 4; ++c) {
            lower[c] -= p * b[c];
            upper[c] -= q * b[c];
        }
    }
    for (int c = 0; c < 4; ++c) {
        *(loose4*)(column + (size_t)c * f->stride) = lower[c];
        *(loose4*)(column + (size_t)c * f->stride + 4) = upper[c];
    }
}

static void update_task(void* context, int task)
{
    const front* f = context;
    int from = f->first + task * f->block, to = from + f->block < f->size ? from + f->block : f->size;
    int fours = from + (to - from) / 4 * 4;
    for (int strip = (from - f->first) / STRIP; strip < strip_count(f); ++strip)
        for (int j = from; j < fours; j += 4)
            update_strip(f, strip, j);
    update_columns(f, fours, to);
}

// Columns j .. j + width - 1, up to date with all columns before: their triangle, then the rows below. False: not positive.
static bool eliminate(front* f, int j, int width)
{
    double *column[4], *entry = f->entry + (size_t)j * f->stride;
    for (int c = 0; c < width; ++c, entry += f->stride)
        column[c] = entry;
    double scale[4];
    for (int c = 0; c < width; ++c) {
        for (int b = 0; b < c; ++b)
            for (int r = c; r < width; ++r)
                column[c][j + r] -= column[b][j + r] * column[b][j + c];
        if (!(column[c][j + c] > 0))
            return false;
        column[c][j + c] = sqrt(column[c][j + c]);
        scale[c] = 1 / column[c][j + c];
        for (int r = c + 1; r < width; ++r)
            column[c][j + r] *= scale[c];
    }
    int row = j + width;
    for (; row < f->size && row % 4; ++row)
        for (int c = 0; c < width; ++c) {
            for (int b = 0; b < c; ++b)
                column[c][row] -= column[b][row] * column[b][j + c];
            column[c][row] *= scale[c];
        }
    for (; row < f->size; row += 4)
        for (int c = 0; c < width; ++c) {
            v4 sum = *(v4*)(column[c] + row);
            for (int b = 0; b < c; ++b)
                sum -= *(v4*)(column[b] + row) * column[b][j + c];
            *(v4*)(column[c] + row) = sum * scale[c];
        }
    return true;
}

// Eliminates the first `width` columns and updates the rest.
static bool factor_front(front* f, int width, ax_pool* pool)
{
    for (int from = 0; from < width; from += BLOCK) {
        int to = from + BLOCK < width ? from + BLOCK : width;
        f->from = from;
        for (int j = from; j < to; j += 4) {
            int w = to - j < 4 ? to - j : 4;
            f->to = j;
            update_columns(f, j, j + w);
            if (!eliminate(f, j, w))
                return false;
        }
        f->to = f->first = to;
        f->block = COLUMNS_PER_TASK;
        if (f->size - to < LEAST_SHARED)
            update_columns(f, to, f->size);
        else {
            ax_pool_run(pool, pack_strip, f, strip_count(f));
            ax_pool_run(pool, update_task, f, (f->size - to + f->block - 1) / f->block);
        }
    }
    return true;
}

// Adds what child c left to the front. local: row -> place in the front.
static void add_child(const factoring* f, const front* to, int c, const int* local, const int* row, int* place)
{
    const ax_supernode* child = f->panels->nodes + c;
    const double* from = f->update[c];
    for (int r = 0; r < child->rows; ++r)
        place[r] = local[row[r]];
    for (int j = 0; j < child->rows; ++j) {
        double* column = to->entry + (size_t)place[j] * to->stride;
        for (int r = j; r < child->rows; ++r)
            column[place[r]] += *from++;
    }
}

static void store(const ax_panels* s, const ax_supernode* node, const front* f)
{
    const ax_panel* p = s->panels + node->panel;
    for (int c = 0; c < node->width; c += AX_PANEL_WIDTH, ++p) {
        double* to = s->value + p->value;
        const double* from = f->entry + (size_t)c * f->stride;
        for (int j = 0; j < p->width; ++j)
            for (int r = j; r < p->width; ++r) {
                double l = from[(size_t)j * f->stride + (size_t)(c + r)];
                *to++ = r == j ? 1 / l : l;
            }
        for (int r = c + p->width; r < f->size; ++r)
            for (int j = 0; j < p->width; ++j)
                *to++ = from[(size_t)j * f->stride + (size_t)r];
    }
}

// The row that an index of a part stands for.
static inline int row_of(const ax_panels* s, int part, int index)
{
    return index < s->n ? index : s->top_first + index - s->n - part * ax_panels_top(s);
}

static void factor_part(void* context, int part)
{
    factoring* f = context;
    ax_panels* s = f->panels;
    double* entry = ax_alloc_aligned(s->front_size[part], sizeof *entry);
    double* packed = ax_alloc_aligned(BLOCK * (s->longest[part] + STRIP), sizeof *packed);
    int *local = AX_NEW(int, s->n), *rows = AX_NEW(int, s->n), *place = AX_NEW(int, s->n);
    size_t held = 0;
    f->stack[part] = AX_NEW(double, s->stack_size[part]);
    for (int visit = s->part_node[part]; visit < s->part_node[part + 1] && !atomic_load(&f->failed); ++visit) {
        int k = s->depth_first[visit];
        const ax_supernode* node = s->nodes + k;
        front own = {
            .entry = entry, .stride = ax_front_stride(node), .size = node->width + node->rows, .packed = packed};
        memset(entry, 0, own.stride * (size_t)own.size * sizeof *entry);
        for (int r = 0; r < own.size; ++r)
            local[row_of(s, part, s->index[node->index + r])] = r;
        for (int c = 0; c < node->width; ++c) {
            int j = node->first + c;
            double* column = entry + (size_t)c * own.stride;
            column[c] = f->diagonal[j];
            for (int e = f->start[j]; e < f->start[j + 1]; ++e)
                column[local[f->row[e]]] += f->value[e];
        }
        for (int c = node->child; c >= 0; c = s->nodes[c].sibling) {
            const ax_supernode* child = s->nodes + c;
            int owner = part;
            if (c < s->part_node[part]) // the top: of which part is this child?
                for (owner = 0; c >= s->part_node[owner + 1];)
                    ++owner;
            else
                held -= ax_update_size(child);
            const int* index = s->index + child->index + child->width;
            for (int r = 0; r < child->rows; ++r)
                rows[r] = row_of(s, owner, index[r]);
            add_child(f, &own, c, local, rows, place);
        }
        if (!factor_front(&own, node->width, part == s->parts ? f->pool : NULL)) {
            atomic_store(&f->failed, true);
            break;
        }
        store(s, node, &own);
        double* to = f->update[k] = f->stack[part] + held;
        for (int j = node->width; j < own.size; ++j) {
            memcpy(to, entry + (size_t)j * own.stride + j, (size_t)(own.size - j) * sizeof *to);
            to += own.size - j;
        }
        held += ax_update_size(node);
    }
    ax_free(entry);
    ax_free(packed);
    ax_free(local);
    ax_free(rows);
    ax_free(place);
}

bool ax_panels_factor(ax_panels* s, const ax_sparse* matrix, ax_pool* pool)
{
    int n = s->n, *position = AX_NEW(int, n), *start = AX_NEW0(int, n + 2), *row = NULL;
    double *value = NULL, *diagonal = AX_NEW0(double, n);
    for (int k = 0; k < n; ++k)
        position[s->order[k]] = k;
    for (int pass = 0; pass < 2; ++pass) {
        for (int v = 0; v < n; ++v)
            for (int e = matrix->start[v]; e < matrix->start[v + 1]; ++e) {
                int a = position[v], b = position[matrix->row[e]], early = a < b ? a : b;
                if (a == b)
                    diagonal[a] = matrix->value[e];
                else if (pass) {
                    row[start[early + 1]] = a < b ? b : a;
                    value[start[early + 1]++] = matrix->value[e];
                } else
                    ++start[early + 2];
            }
        if (pass)
            break;
        for (int k = 0; k <= n; ++k)
            start[k + 1] += start[k];
        row = AX_NEW(int, start[n + 1]);
        value = AX_NEW(double, start[n + 1]);
    }
    factoring f = {.panels = s,
                   .pool = pool,
                   .start = start,
                   .row = row,
                   .value = value,
                   .diagonal = diagonal,
                   .update = AX_NEW(double*, s->node_count)};
    ax_pool_run(pool, factor_part, &f, s->parts);
    if (!f.failed)
        factor_part(&f, s->parts);
    for (int part = 0; part <= s->parts; ++part)
        ax_free(f.stack[part]);
    void* blocks[] = {position, start, row, value, diagonal, f.update};
    for (size_t k = 0; k < sizeof blocks / sizeof *blocks; ++k)
        ax_free(blocks[k]);
    return !f.failed;
}
