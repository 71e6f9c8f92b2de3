#include "linalg/panels_layout.h"

#include <string.h>

typedef double v4 __attribute__((vector_size(32)));

static inline v4 load(const ax_vec4* x)
{
    return *(const v4*)x;
}

// Where a pass works: x, and behind its n rows, in the numbering of indices, the buffers.
typedef struct rows {
    ax_vec4 *x, *buffers;
    int n;
} rows;

static inline ax_vec4* at(const rows* to, int index)
{
    return index < to->n ? to->x + index : to->buffers + (index - to->n);
}

// Doubles that a backward pass asks for before it needs them: hardware foresees the forward pass, but not this one, which goes
// down from panel to panel.
enum { AHEAD = 256 };

// One function per width: the columns' values stay in registers.
#define FORWARD(W)                                                                                                     \
    static void forward_##W(const ax_panel* p, const double* restrict value, const int* restrict index,                \
                            const rows* on)                                                                            \
    {                                                                                                                  \
        v4 c[W];                                                                                                       \
        for (int j = 0; j < W; ++j)                                                                                    \
            c[j] = load(on->x + p->first + j);                                                                         \
        for (int j = 0; j < W; ++j) {                                                                                  \
            c[j] *= *value++;                                                                                          \
            for (int i = j + 1; i < W; ++i)                                                                            \
                c[i] -= *value++ * c[j];                                                                               \
        }                                                                                                              \
        for (int j = 0; j < W; ++j)                                                                                    \
            *(v4*)(on->x + p->first + j) = c[j];                                                                       \
        for (int r = 0; r < p->rows; ++r, value += W) {                                                                \
            v4* to = (v4*)at(on, index[r]);                                                                            \
            v4 sum = value[0] * c[0];                                                                                  \
            for (int j = 1; j < W; ++j)                                                                                \
                sum += value[j] * c[j];                                                                                \
            *to -= sum;                                                                                                \
        }                                                                                                              \
    }
#define BACKWARD(W)                                                                                                    \
    static void backward_##W(const ax_panel* p, const double* restrict value, const int* restrict index,               \
                             const rows* on)                                                                           \
    {                                                                                                                  \
        const double *triangle = value, *row = value + W * (W + 1) / 2 + (size_t)p->rows * W;                          \
        v4 c[W], odd[W];                                                                                               \
        for (int j = 0; j < W; ++j) {                                                                                  \
            c[j] = load(on->x + p->first + j);                                                                         \
            odd[j] = (v4){0, 0, 0, 0};                                                                                 \
        }                                                                                                              \
        int r = p->rows;                                                                                               \
        for (; r >= 2; r -= 2) {                                                                                       \
            row -= 2 * W;                                                                                              \
            __builtin_prefetch(row - AHEAD);                                                                           \
            v4 y = load(at(on, index[r - 2])), z = load(at(on, index[r - 1]));                                         \
            for (int j = 0; j < W; ++j) {                                                                              \
                c[j] -= row[j] * y;                                                                                    \
                odd[j] -= row[W + j] * z;                                                                              \
            }                                                                                                          \
        }                                                                                                              \
        if (r) {                                                                                                       \
            v4 y = load(at(on, index[0]));                                                                             \
            for (int j = 0; j < W; ++j)                                                                                \
                c[j] -= row[j - W] * y;                                                                                \
        }                                                                                                              \
        for (int j = W - 1; j >= 0; --j) {                                                                             \
            const double* column = triangle + j * W - j * (j - 1) / 2;                                                 \
            c[j] += odd[j];                                                                                            \
            for (int i = j + 1; i < W; ++i)                                                                            \
                c[j] -= column[i - j] * c[i];                                                                          \
            c[j] *= column[0];                                                                                         \
            *(v4*)(on->x + p->first + j) = c[j];                                                                       \
        }                                                                                                              \
    }
// clang-format off
FORWARD(1) FORWARD(2) FORWARD(3) FORWARD(4)
BACKWARD(1) BACKWARD(2) BACKWARD(3) BACKWARD(4)
    // clang-format on

    typedef struct pass {
    const ax_panels* panels;
    rows on;
} pass;

static void forward(const pass* p, int from, int to)
{
    static void (*const kernel[])(const ax_panel*, const double*, const int*,
                                  const rows*) = {NULL, forward_1, forward_2, forward_3, forward_4};
    const ax_panels* s = p->panels;
    for (const ax_panel* panel = s->panels + from; panel < s->panels + to; ++panel)
        kernel[panel->width](panel, s->value + panel->value, s->index + panel->index, &p->on);
}

static void backward(const pass* p, int from, int to)
{
    static void (*const kernel[])(const ax_panel*, const double*, const int*,
                                  const rows*) = {NULL, backward_1, backward_2, backward_3, backward_4};
    const ax_panels* s = p->panels;
    for (const ax_panel* panel = s->panels + to; panel-- > s->panels + from;)
        kernel[panel->width](panel, s->value + panel->value, s->index + panel->index, &p->on);
}

static ax_vec4* buffer(const ax_panels* s, int part)
{
    return s->buffers + (size_t)part * (size_t)ax_panels_top(s);
}

static void forward_part(void* context, int part)
{
    const pass* p = context;
    const ax_panels* s = p->panels;
    memset(buffer(s, part), 0, (size_t)ax_panels_top(s) * sizeof(ax_vec4));
    forward(p, s->part_panel[part], s->part_panel[part + 1]);
}

static void backward_part(void* context, int part)
{
    const pass* p = context;
    const ax_panels* s = p->panels;
    memcpy(buffer(s, part), p->on.x + s->top_first, (size_t)ax_panels_top(s) * sizeof(ax_vec4));
    backward(p, s->part_panel[part], s->part_panel[part + 1]);
}

void ax_panels_solve(ax_panels* s, ax_pool* pool, ax_vec4* x)
{
    pass p = {s, {x, s->buffers, s->n}};
    ax_pool_run(pool, forward_part, &p, s->parts);
    for (int part = 0; part < s->parts; ++part)
        for (int k = 0; k < ax_panels_top(s); ++k)
            *(v4*)(x + s->top_first + k) += load(buffer(s, part) + k);
    forward(&p, s->part_panel[s->parts], s->panel_count);
    backward(&p, s->part_panel[s->parts], s->panel_count);
    ax_pool_run(pool, backward_part, &p, s->parts);
}

void ax_panels_free(ax_panels* s)
{
    if (!s)
        return;
    void* blocks[] = {s->panels, s->nodes, s->index, s->value, s->order, s->buffers, s};
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
