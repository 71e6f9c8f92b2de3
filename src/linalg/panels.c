#include "linalg/panels.h"

#include <assert.h>
#include <stdlib.h>
#include <string.h>

enum { WIDTH = 4, PARTS = 8, LEAST_PARALLEL = 20000 };

// Up to four columns of the factor: their triangle, then the rows below, row by row. Blocks of one supernode share its index list.
typedef struct panel {
    int first, width, rows; // columns first .. first + width - 1, rows below them
    int index;              // of the first row below, into `index`
    size_t value;           // of the triangle (column by column, diagonal as its reciprocal), then rows * width entries
} panel;

struct ax_panels {
    int n, panel_count;
    panel* panels;
    int* index; // rows within parts; top rows refer to the part's own buffer behind the n rows
    double* value;
    size_t index_count, value_count;
    int* order;
    int parts, top_count;
    int part_start[PARTS + 2]; // panels of each part, then of the top, in `sequence`
    int* sequence;
    int* top_row;  // top_count rows of the top, ascending
    ax_vec4* work; // n rows and parts x top_count buffers
};

typedef double v4 __attribute__((vector_size(32)));

static inline v4 load(const ax_vec4* x)
{
    return *(const v4*)x;
}

// One function per width: the columns' values stay in registers.
#define FORWARD(W)                                                                                                     \
    static void forward_##W(const panel* p, const double* restrict value, const int* restrict index, ax_vec4* x)       \
    {                                                                                                                  \
        v4 c[W];                                                                                                       \
        for (int j = 0; j < W; ++j)                                                                                    \
            c[j] = load(x + p->first + j);                                                                             \
        for (int j = 0; j < W; ++j) {                                                                                  \
            c[j] *= *value++;                                                                                          \
            for (int i = j + 1; i < W; ++i)                                                                            \
                c[i] -= *value++ * c[j];                                                                               \
        }                                                                                                              \
        for (int j = 0; j < W; ++j)                                                                                    \
            *(v4*)(x + p->first + j) = c[j];                                                                           \
        for (int r = 0; r < p->rows; ++r, value += W) {                                                                \
            v4* to = (v4*)(x + index[r]);                                                                              \
            v4 sum = value[0] * c[0];                                                                                  \
            for (int j = 1; j < W; ++j)                                                                                \
                sum += value[j] * c[j];                                                                                \
            *to -= sum;                                                                                                \
        }                                                                                                              \
    }
#define BACKWARD(W)                                                                                                    \
    static void backward_##W(const panel* p, const double* restrict value, const int* restrict index, ax_vec4* x)      \
    {                                                                                                                  \
        const double *triangle = value, *row = value + W * (W + 1) / 2;                                                \
        v4 c[W], odd[W];                                                                                               \
        for (int j = 0; j < W; ++j) {                                                                                  \
            c[j] = load(x + p->first + j);                                                                             \
            odd[j] = (v4){0, 0, 0, 0};                                                                                 \
        }                                                                                                              \
        int r = 0;                                                                                                     \
        for (; r + 1 < p->rows; r += 2, row += 2 * W) {                                                                \
            v4 y = load(x + index[r]), z = load(x + index[r + 1]);                                                     \
            for (int j = 0; j < W; ++j) {                                                                              \
                c[j] -= row[j] * y;                                                                                    \
                odd[j] -= row[W + j] * z;                                                                              \
            }                                                                                                          \
        }                                                                                                              \
        if (r < p->rows) {                                                                                             \
            v4 y = load(x + index[r]);                                                                                 \
            for (int j = 0; j < W; ++j)                                                                                \
                c[j] -= row[j] * y;                                                                                    \
        }                                                                                                              \
        for (int j = W - 1; j >= 0; --j) {                                                                             \
            const double* column = triangle + j * W - j * (j - 1) / 2;                                                 \
            c[j] += odd[j];                                                                                            \
            for (int i = j + 1; i < W; ++i)                                                                            \
                c[j] -= column[i - j] * c[i];                                                                          \
            c[j] *= column[0];                                                                                         \
            *(v4*)(x + p->first + j) = c[j];                                                                           \
        }                                                                                                              \
    }
// clang-format off
FORWARD(1) FORWARD(2) FORWARD(3) FORWARD(4)
BACKWARD(1) BACKWARD(2) BACKWARD(3) BACKWARD(4)
    // clang-format on

    static void forward(const ax_panels* s, const panel* p)
{
    static void (*const kernel[])(const panel*, const double*, const int*, ax_vec4*) = {NULL, forward_1, forward_2,
                                                                                        forward_3, forward_4};
    kernel[p->width](p, s->value + p->value, s->index + p->index, s->work);
}

static void backward(const ax_panels* s, const panel* p)
{
    static void (*const kernel[])(const panel*, const double*, const int*, ax_vec4*) = {NULL, backward_1, backward_2,
                                                                                        backward_3, backward_4};
    kernel[p->width](p, s->value + p->value, s->index + p->index, s->work);
}

static ax_vec4* buffer(const ax_panels* s, int part)
{
    return s->work + s->n + (size_t)part * (size_t)s->top_count;
}

static void forward_part(void* context, int part)
{
    ax_panels* s = context;
    memset(buffer(s, part), 0, (size_t)s->top_count * sizeof(ax_vec4));
    for (int k = s->part_start[part]; k < s->part_start[part + 1]; ++k)
        forward(s, s->panels + s->sequence[k]);
}

static void backward_part(void* context, int part)
{
    ax_panels* s = context;
    ax_vec4* own = buffer(s, part);
    for (int k = 0; k < s->top_count; ++k)
        memcpy(own[k], s->work[s->top_row[k]], sizeof *own);
    for (int k = s->part_start[part + 1] - 1; k >= s->part_start[part]; --k)
        backward(s, s->panels + s->sequence[k]);
}

void ax_panels_solve(ax_panels* s, ax_pool* pool, ax_vec4* x)
{
    memcpy(s->work, x, (size_t)s->n * sizeof *x);
    ax_pool_run(pool, forward_part, s, s->parts);
    for (int part = 0; part < s->parts; ++part)
        for (int k = 0; k < s->top_count; ++k)
            *(v4*)(s->work + s->top_row[k]) += load(buffer(s, part) + k);
    for (int k = s->part_start[s->parts]; k < s->part_start[s->parts + 1]; ++k)
        forward(s, s->panels + s->sequence[k]);
    for (int k = s->part_start[s->parts + 1] - 1; k >= s->part_start[s->parts]; --k)
        backward(s, s->panels + s->sequence[k]);
    ax_pool_run(pool, backward_part, s, s->parts);
    memcpy(x, s->work, (size_t)s->n * sizeof *x);
}

// Cuts the tree of supernodes: owner[s] is the part of each, `parts` for the top. Roots are opened, largest first, until the
// largest subtree is an eighth of the work or the top would grow beyond a sixth.
static int cut_tree(int count, const int* parent, const double* work, int* owner)
{
    double *below = ax_copy(work, (size_t)count, sizeof *below), total = 0, top = 0;
    int *first_child = AX_NEW(int, count), *sibling = AX_NEW(int, count), *open = AX_NEW(int, count), opened = 0;
    memset(first_child, -1, (size_t)count * sizeof *first_child);
    for (int s = 0; s < count; ++s)
        total += work[s];
    for (int s = 0; s < count; ++s) // children precede parents
        if (parent[s] >= 0)
            below[parent[s]] += below[s];
    for (int s = count - 1; s >= 0; --s) {
        owner[s] = -1;
        if (parent[s] < 0)
            open[opened++] = s;
        else
            sibling[s] = first_child[parent[s]], first_child[parent[s]] = s;
    }
    while (total > LEAST_PARALLEL) {
        int largest = 0;
        for (int k = 1; k < opened; ++k)
            if (below[open[k]] > below[open[largest]])
                largest = k;
        int s = open[largest];
        if (below[s] <= total / PARTS || top + work[s] > total / 6 || first_child[s] < 0)
            break;
        top += work[s];
        owner[s] = PARTS;
        open[largest] = open[--opened];
        for (int c = first_child[s]; c >= 0; c = sibling[c])
            open[opened++] = c;
    }
    // subtrees to parts, each to the part with the least work so far
    double load_of[PARTS] = {0};
    int parts = opened < PARTS ? opened : PARTS;
    for (int a = 1; a < opened; ++a) // largest first, earlier tree first on ties
        for (int b = a; b > 0 && (below[open[b]] > below[open[b - 1]] ||
                                  (below[open[b]] == below[open[b - 1]] && open[b] < open[b - 1]));
             --b) {
            int swap = open[b];
            open[b] = open[b - 1], open[b - 1] = swap;
        }
    for (int k = 0; k < opened; ++k) {
        int part = 0;
        for (int p = 1; p < parts; ++p)
            if (load_of[p] < load_of[part])
                part = p;
        load_of[part] += below[open[k]];
        owner[open[k]] = part;
    }
    for (int s = count - 1; s >= 0; --s) // parents precede children
        if (owner[s] == PARTS)
            owner[s] = parts;
        else if (owner[s] < 0)
            owner[s] = owner[parent[s]];
    ax_free(below);
    ax_free(first_child);
    ax_free(sibling);
    ax_free(open);
    return parts;
}

ax_panels* ax_panels_make(const ax_cholesky* factor)
{
    ax_supernodes f = ax_cholesky_supernodes(factor);
    ax_panels* s = AX_NEW0(ax_panels, 1);
    s->n = f.n;
    s->order = ax_copy(f.order, (size_t)f.n, sizeof *s->order);
    int *parent = AX_NEW(int, f.count), *owner = AX_NEW(int, f.count), *node_of = AX_NEW(int, f.n);
    double* work = AX_NEW(double, f.count);
    for (int k = 0; k < f.count; ++k)
        for (int j = f.column[k]; j < f.column[k + 1]; ++j)
            node_of[j] = k;
    for (int k = 0; k < f.count; ++k) {
        int width = f.column[k + 1] - f.column[k], rows = f.row_start[k + 1] - f.row_start[k];
        parent[k] = rows > width ? node_of[f.row[f.row_start[k] + width]] : -1;
        work[k] = (double)width * rows - width * (width - 1) / 2.0;
        s->panel_count += (width + WIDTH - 1) / WIDTH;
        s->value_count += (size_t)width * (size_t)rows; // bound: the upper triangles are not kept
    }
    s->parts = cut_tree(f.count, parent, work, owner);

    int* top_index = AX_NEW(int, f.n);
    s->top_row = AX_NEW(int, f.n);
    for (int j = 0; j < f.n; ++j) {
        top_index[j] = owner[node_of[j]] == s->parts ? s->top_count : -1;
        if (top_index[j] >= 0)
            s->top_row[s->top_count++] = j;
    }
    s->panels = AX_NEW(panel, s->panel_count);
    s->sequence = AX_NEW(int, s->panel_count);
    s->index = AX_NEW(int, f.row_start[f.count]);
    s->value = AX_NEW(double, s->value_count);
    size_t used = 0;
    int made = 0, listed = 0;
    for (int part = 0; part <= s->parts; ++part) {
        s->part_start[part] = listed;
        for (int k = 0; k < f.count; ++k) {
            if (owner[k] != part)
                continue;
            int first = f.column[k], width = f.column[k + 1] - first, from = f.row_start[k];
            int rows = f.row_start[k + 1] - from, index = (int)s->index_count;
            for (int r = 0; r < rows; ++r) {
                int row = f.row[from + r];
                bool above = part < s->parts && top_index[row] >= 0;
                s->index[s->index_count++] = above ? f.n + part * s->top_count + top_index[row] : row;
            }
            for (int c = 0; c < width; c += WIDTH) {
                int w = width - c < WIDTH ? width - c : WIDTH;
                const double* block = f.value + f.value_start[k] + (size_t)c * (size_t)rows;
                s->panels[made] = (panel){
                    .first = first + c, .width = w, .rows = rows - c - w, .index = index + c + w, .value = used};
                for (int j = 0; j < w; ++j)
                    for (int i = j; i < w; ++i) {
                        double l = block[(size_t)j * (size_t)rows + (size_t)(c + i)];
                        s->value[used++] = i == j ? 1 / l : l;
                    }
                for (int r = c + w; r < rows; ++r)
                    for (int j = 0; j < w; ++j)
                        s->value[used++] = block[(size_t)j * (size_t)rows + (size_t)r];
                s->sequence[listed++] = made++;
            }
        }
    }
    s->part_start[s->parts + 1] = listed;
    s->value_count = used;
    s->value = ax_realloc(s->value, used, sizeof *s->value);
    size_t rows = (size_t)s->n + (size_t)s->parts * (size_t)s->top_count;
    s->work = ax_alloc_aligned(rows, sizeof *s->work);
    ax_free(parent);
    ax_free(owner);
    ax_free(node_of);
    ax_free(work);
    ax_free(top_index);
    return s;
}

void ax_panels_free(ax_panels* s)
{
    if (!s)
        return;
    void* blocks[] = {s->panels, s->index, s->value, s->order, s->sequence, s->top_row, s->work, s};
    for (size_t k = 0; k < sizeof blocks / sizeof *blocks; ++k)
        ax_free(blocks[k]);
}

const int* ax_panels_order(const ax_panels* s)
{
    return s->order;
}

double ax_panels_entries(const ax_panels* s)
{
    return (double)s->value_count;
}

size_t ax_panels_bytes(const ax_panels* s)
{
    return 2 * (s->value_count * sizeof *s->value + s->index_count * sizeof *s->index);
}
