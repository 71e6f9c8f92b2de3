#include "linalg/panels_layout.h"

#include <string.h>

typedef double v4 __attribute__((vector_size(32)));

static inline v4 load(const ax_vec4* x)
{
    return *(const v4*)x;
}

// Doubles that a backward pass asks for before it needs them: hardware foresees the forward pass, but not this one, which goes
// down from panel to panel.
enum { AHEAD = 256 };

// One function per width: the columns' values stay in registers.
#define FORWARD(W)                                                                                                     \
    static void forward_##W(const ax_panel* p, const double* restrict value, const int* restrict index, ax_vec4* x)    \
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
    static void backward_##W(const ax_panel* p, const double* restrict value, const int* restrict index, ax_vec4* x)   \
    {                                                                                                                  \
        const double *triangle = value, *row = value + W * (W + 1) / 2 + (size_t)p->rows * W;                          \
        v4 c[W], odd[W];                                                                                               \
        for (int j = 0; j < W; ++j) {                                                                                  \
            c[j] = load(x + p->first + j);                                                                             \
            odd[j] = (v4){0, 0, 0, 0};                                                                                 \
        }                                                                                                              \
        int r = p->rows;                                                                                               \
        for (; r >= 2; r -= 2) {                                                                                       \
            row -= 2 * W;                                                                                              \
            __builtin_prefetch(row - AHEAD);                                                                           \
            v4 y = load(x + index[r - 2]), z = load(x + index[r - 1]);                                                 \
            for (int j = 0; j < W; ++j) {                                                                              \
                c[j] -= row[j] * y;                                                                                    \
                odd[j] -= row[W + j] * z;                                                                              \
            }                                                                                                          \
        }                                                                                                              \
        if (r) {                                                                                                       \
            v4 y = load(x + index[0]);                                                                                 \
            for (int j = 0; j < W; ++j)                                                                                \
                c[j] -= row[j - W] * y;                                                                                \
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

    static void forward(const ax_panels* s, const ax_panel* p)
{
    static void (*const kernel[])(const ax_panel*, const double*, const int*, ax_vec4*) = {NULL, forward_1, forward_2,
                                                                                           forward_3, forward_4};
    kernel[p->width](p, s->value + p->value, s->index + p->index, s->work);
}

static void backward(const ax_panels* s, const ax_panel* p)
{
    static void (*const kernel[])(const ax_panel*, const double*, const int*, ax_vec4*) = {NULL, backward_1, backward_2,
                                                                                           backward_3, backward_4};
    kernel[p->width](p, s->value + p->value, s->index + p->index, s->work);
}

static ax_vec4* buffer(const ax_panels* s, int part)
{
    return s->work + s->n + (size_t)part * (size_t)ax_panels_top(s);
}

typedef struct pass {
    ax_panels* panels;
    ax_vec4* x;
} pass;

static void copy_columns(const ax_panels* s, int part, ax_vec4* to, const ax_vec4* from)
{
    int first = s->part_column[part];
    memcpy(to + first, from + first, (size_t)(s->part_column[part + 1] - first) * sizeof *to);
}

static void forward_part(void* context, int part)
{
    const pass* p = context;
    const ax_panels* s = p->panels;
    copy_columns(s, part, s->work, (const ax_vec4*)p->x);
    memset(buffer(s, part), 0, (size_t)ax_panels_top(s) * sizeof(ax_vec4));
    for (int k = s->part_panel[part]; k < s->part_panel[part + 1]; ++k)
        forward(s, s->panels + k);
}

static void backward_part(void* context, int part)
{
    const pass* p = context;
    const ax_panels* s = p->panels;
    memcpy(buffer(s, part), s->work + s->top_first, (size_t)ax_panels_top(s) * sizeof(ax_vec4));
    for (int k = s->part_panel[part + 1] - 1; k >= s->part_panel[part]; --k)
        backward(s, s->panels + k);
    copy_columns(s, part, p->x, (const ax_vec4*)s->work);
}

void ax_panels_solve(ax_panels* s, ax_pool* pool, ax_vec4* x)
{
    pass p = {s, x};
    ax_pool_run(pool, forward_part, &p, s->parts);
    copy_columns(s, s->parts, s->work, (const ax_vec4*)x);
    for (int part = 0; part < s->parts; ++part)
        for (int k = 0; k < ax_panels_top(s); ++k)
            *(v4*)(s->work + s->top_first + k) += load(buffer(s, part) + k);
    for (int k = s->part_panel[s->parts]; k < s->panel_count; ++k)
        forward(s, s->panels + k);
    for (int k = s->panel_count - 1; k >= s->part_panel[s->parts]; --k)
        backward(s, s->panels + k);
    ax_pool_run(pool, backward_part, &p, s->parts);
    copy_columns(s, s->parts, x, (const ax_vec4*)s->work);
}

void ax_panels_free(ax_panels* s)
{
    if (!s)
        return;
    void* blocks[] = {s->panels, s->nodes, s->index, s->value, s->order, s->work, s};
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
