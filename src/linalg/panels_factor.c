// Numerical factorisation by fronts (Duff and Reid 1983): each supernode gathers its matrix entries and what its children left
// into a dense front, eliminates its columns, and leaves the rest for its parent. Parts are factorised side by side; in the top,
// where fronts are large, threads share the columns of one front.
#include "linalg/panels_layout.h"

#include <math.h>
#include <string.h>

// Columns eliminated before the rest of the front is updated, columns that one task updates, rows that are updated at once.
enum {
    BLOCK = 64,
    COLUMNS_PER_TASK = 16,
    STRIPS_PER_TASK = 4,
    COLUMNS_MOVED = 64,
    LEAST_SHARED = 128,
    STRIP = AX_FRONT_STRIP,
    ROUND = AX_FRONT_ROUND
};

typedef struct factoring {
    ax_panels* panels;
    ax_pool* pool;
    // the matrix by columns in elimination order, diagonals apart
    const int *start, *row;
    const double *value, *diagonal;
    double** update; // per supernode: what it left
    double* stack[AX_PANEL_PARTS + 1];
    const struct kernels* kernels;
} factoring;

// A front: columns of `stride` doubles, its lower triangle in use, rows behind the last one zero.
typedef struct front {
    const struct kernels* kernels;
    double* entry;
    size_t stride;
    int size, from, to; // rows; columns from .. to - 1 are to be subtracted
    int first;          // first column to update
    int column;         // of the matrix, the first one
    int* failed;        // its part's
    int done;           // rows above have their columns from .. to - 1 eliminated
    double* packed;     // rows from `first` on of the columns to subtract: strips of rows, in each column after column
} front;

static int strip_count(const front* f)
{
    return (f->size - f->first + STRIP - 1) / STRIP;
}

static inline int rows_stored(const front* f)
{
    return (f->size + ROUND - 1) / ROUND * ROUND;
}

// What vectors of one width do.
typedef struct kernels {
    void (*update_columns)(const front*, int from, int to, int row, int end);
    void (*update_task)(void* front, int task);
    void (*eliminate_rows)(const front*, int j, int width, int row, int end);
} kernels;

#define NAME(x) x##_by_4
#define LANES   4
#define TARGET
#include "linalg/front_kernels.h"

// Three times as fast where there is such hardware, with the same bits.
#if defined(__x86_64__)
#define NAME(x) x##_by_8
#define LANES   8
#define TARGET  __attribute__((target("avx512f")))
#include "linalg/front_kernels.h"
#endif

static const kernels* best_kernels(void)
{
#if defined(__x86_64__)
    if (__builtin_cpu_supports("avx512f"))
        return &kernels_by_8;
#endif
    return &kernels_by_4;
}

static void pack_strip(const front* f, int strip)
{
    int row = f->first + strip * STRIP, rows = f->size - row < STRIP ? f->size - row : STRIP;
    double* to = f->packed + (size_t)strip * BLOCK * STRIP;
    for (int k = f->from; k < f->to; ++k, to += STRIP) {
        const double* from = f->entry + (size_t)k * f->stride + row;
        for (int r = 0; r < STRIP; ++r)
            to[r] = r < rows ? from[r] : 0;
    }
}

// The triangle of columns j .. j + width - 1, up to date with all columns before. What comes after the first pivot that is not positive
// stands for nothing.
static void eliminate_triangle(const front* f, int j, int width)
{
    double *column[4], scale;
    for (int c = 0; c < width; ++c) {
        column[c] = f->entry + (size_t)(j + c) * f->stride;
        for (int b = 0; b < c; ++b)
            for (int r = c; r < width; ++r)
                column[c][j + r] -= column[b][j + r] * column[b][j + c];
        if (!(column[c][j + c] > 0)) {
            if (*f->failed < 0)
                *f->failed = f->column + j + c;
            column[c][j + c] = 1;
        }
        column[c][j + c] = sqrt(column[c][j + c]);
        scale = 1 / column[c][j + c];
        for (int r = c + 1; r < width; ++r)
            column[c][j + r] *= scale;
    }
}

// Columns from .. to - 1 in the rows to be done.
static void eliminate(const front* f)
{
    front before = *f; // columns before those in hand
    for (int j = f->from; j < f->to; j += 4) {
        int width = f->to - j < 4 ? f->to - j : 4;
        before.to = j;
        f->kernels->update_columns(&before, j, j + width, 0, f->done);
        eliminate_triangle(f, j, width);
        f->kernels->eliminate_rows(f, j, width, j + width, f->done);
    }
}

// The same columns in a few strips of rows below, if they are not done, while they are in the cache; then packs them.
static void eliminate_strips(void* context, int task)
{
    const front* f = context;
    int first = task * STRIPS_PER_TASK, last = first + STRIPS_PER_TASK;
    last = last < strip_count(f) ? last : strip_count(f);
    int row = f->first + first * STRIP, end = f->first + last * STRIP;
    front before = *f;
    for (int j = f->from; j < f->to && f->done <= row; j += 4) {
        int width = f->to - j < 4 ? f->to - j : 4;
        before.to = j;
        f->kernels->update_columns(&before, j, j + width, row, end);
        f->kernels->eliminate_rows(f, j, width, row, end);
    }
    for (int strip = first; strip < last; ++strip)
        pack_strip(f, strip);
}

// Eliminates the first `width` columns and updates the rest.
static void factor_front(front* f, int width, ax_pool* pool)
{
    for (f->from = 0; f->from < width; f->from = f->to) {
        f->to = f->first = width - f->from > BLOCK ? f->from + BLOCK : width;
        bool shared = f->size - f->to >= LEAST_SHARED;
        // vectors must end where the shared rows begin
        f->done = shared && f->to % ROUND == 0 ? f->to : rows_stored(f);
        eliminate(f);
        if (!shared)
            f->kernels->update_columns(f, f->to, f->size, 0, rows_stored(f));
        else {
            ax_pool_run(pool, eliminate_strips, f, (strip_count(f) + STRIPS_PER_TASK - 1) / STRIPS_PER_TASK);
            ax_pool_run(pool, f->kernels->update_task, f, (f->size - f->to + COLUMNS_PER_TASK - 1) / COLUMNS_PER_TASK);
        }
    }
}

// Where column j begins in a lower triangle of `rows` rows, column by column.
static inline size_t triangle_at(int rows, int j)
{
    return (size_t)j * (size_t)rows - (size_t)j * (size_t)(j - 1) / 2;
}

// A child's triangle on its way to its parent's front, or from the front to memory, in tasks of COLUMNS_MOVED columns.
typedef struct moving {
    const front* f;
    const ax_panels* panels;
    const ax_supernode* node;
    double* triangle;
    const int *place, *run; // of the child's rows: where they go, and the end of each run of neighbours
} moving;

static void add_columns(void* context, int task)
{
    const moving* m = context;
    int rows = m->node->rows, last = (task + 1) * COLUMNS_MOVED < rows ? (task + 1) * COLUMNS_MOVED : rows;
    const double* from = m->triangle + triangle_at(rows, task * COLUMNS_MOVED);
    for (int j = task * COLUMNS_MOVED; j < last; ++j) {
        double* column = m->f->entry + (size_t)m->place[j] * m->f->stride;
        for (int r = j, end; r < rows; r = end) {
            double* restrict to = column + m->place[r] - r;
            for (end = m->run[r]; r < end; ++r)
                to[r] += *from++;
        }
    }
}

static void leave_columns(void* context, int task)
{
    const moving* m = context;
    int rows = m->node->rows, last = (task + 1) * COLUMNS_MOVED < rows ? (task + 1) * COLUMNS_MOVED : rows;
    const double* from = m->f->entry + (size_t)m->node->width * (m->f->stride + 1);
    for (int j = task * COLUMNS_MOVED; j < last; ++j)
        memcpy(m->triangle + triangle_at(rows, j), from + (size_t)j * (m->f->stride + 1),
               (size_t)(rows - j) * sizeof *from);
}

static void store_panel(void* context, int panel)
{
    const moving* m = context;
    const front* f = m->f;
    const ax_panel* p = m->panels->panels + m->node->panel + panel;
    int c = panel * AX_PANEL_WIDTH;
    double* to = m->panels->value + p->value;
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

// The row that an index of a part stands for.
static inline int row_of(const ax_panels* s, int part, int index)
{
    return index < s->n ? index : s->top_first + index - s->n - part * ax_panels_top(s);
}

static int tasks_to_move(const ax_supernode* node)
{
    return (node->rows + COLUMNS_MOVED - 1) / COLUMNS_MOVED;
}

static void factor_part(void* context, int part)
{
    factoring* f = context;
    ax_panels* s = f->panels;
    double* entry = ax_alloc_aligned(s->front_size[part], sizeof *entry);
    double* packed = ax_alloc_aligned(BLOCK * (s->longest[part] + STRIP), sizeof *packed);
    int *local = AX_NEW(int, s->n), *place = AX_NEW(int, s->n), *run = AX_NEW(int, s->n);
    size_t held = 0;
    f->stack[part] = AX_NEW(double, s->stack_size[part]);
    for (int visit = s->part_node[part]; visit < s->part_node[part + 1] && s->failed[part] < 0; ++visit) {
        int k = s->depth_first[visit];
        const ax_supernode* node = s->nodes + k;
        front own = {.kernels = f->kernels,
                     .entry = entry,
                     .stride = ax_front_stride(node),
                     .size = node->width + node->rows,
                     .column = node->first,
                     .failed = s->failed + part,
                     .packed = packed};
        ax_pool* pool = part == s->parts && own.size >= LEAST_SHARED ? f->pool : NULL;
        for (int c = 0; c < own.size; ++c) { // the lower triangle, from a whole vector on
            size_t row = (size_t)(c / ROUND * ROUND);
            memset(entry + (size_t)c * own.stride + row, 0, (own.stride - row) * sizeof *entry);
        }
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
            for (int r = child->rows - 1; r >= 0; --r) {
                place[r] = local[row_of(s, owner, index[r])];
                run[r] = r + 1 < child->rows && place[r + 1] == place[r] + 1 ? run[r + 1] : r + 1;
            }
            ax_pool_run(pool, add_columns, &(moving){&own, s, child, f->update[c], place, run}, tasks_to_move(child));
        }
        factor_front(&own, node->width, pool);
        moving m = {&own, s, node, f->update[k] = f->stack[part] + held, NULL, NULL};
        ax_pool_run(pool, store_panel, &m, (node->width + AX_PANEL_WIDTH - 1) / AX_PANEL_WIDTH);
        ax_pool_run(pool, leave_columns, &m, tasks_to_move(node));
        held += ax_update_size(node);
    }
    ax_free(entry);
    ax_free(packed);
    ax_free(local);
    ax_free(place);
    ax_free(run);
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
                   .update = AX_NEW(double*, s->node_count),
                   .kernels = best_kernels()};
    bool sound = true;
    for (int part = 0; part <= s->parts; ++part)
        s->failed[part] = -1;
    ax_pool_run(pool, factor_part, &f,
                s->parts); // each up to its own failure, so that it is the same on every number of threads
    for (int part = 0; part < s->parts; ++part)
        sound = sound && s->failed[part] < 0;
    if (sound)
        factor_part(&f, s->parts);
    for (int part = 0; part <= s->parts; ++part)
        ax_free(f.stack[part]);
    void* blocks[] = {position, start, row, value, diagonal, f.update};
    for (size_t k = 0; k < sizeof blocks / sizeof *blocks; ++k)
        ax_free(blocks[k]);
    return sound && s->failed[s->parts] < 0;
}
