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

// One function per width, so that the columns' values stay in registers; each goes on while the width stays.
#define FORWARD(W)                                                                                                     \
    static const ax_panel* forward_##W(const ax_panels* s, const ax_panel* p, const ax_panel* end, ax_vec4* x)         \
    {                                                                                                                  \
        for (; p < end && p->width == W; ++p) {                                                                        \
            const double* restrict value = s->value + p->value;                                                        \
            const int* restrict index = s->index + p->index;                                                           \
            v4 c[W], *own = (v4*)(x + p->first);                                                                       \
            for (int j = 0; j < W; ++j)                                                                                \
                c[j] = own[j];                                                                                         \
            for (int j = 0; j < W; ++j) {                                                                              \
                c[j] *= *value++;                                                                                      \
                for (int i = j + 1; i < W; ++i)                                                                        \
                    c[i] -= *value++ * c[j];                                                                           \
            }                                                                                                          \
            for (int j = 0; j < W; ++j)                                                                                \
                own[j] = c[j];                                                                                         \
            for (int r = 0; r < p->rows; ++r, value += W) {                                                            \
                v4* to = (v4*)(x + index[r]);                                                                          \
                v4 sum = value[0] * c[0];                                                                              \
                for (int j = 1; j < W; ++j)                                                                            \
                    sum += value[j] * c[j];                                                                            \
                *to -= sum;                                                                                            \
            }                                                                                                          \
        }                                                                                                              \
        return p;                                                                                                      \
    }
// Panels from p - 1 down to `end`.
#define BACKWARD(W)                                                                                                    \
    static const ax_panel* backward_##W(const ax_panels* s, const ax_panel* p, const ax_panel* end, ax_vec4* x)        \
    {                                                                                                                  \
        for (; p > end && p[-1].width == W; --p) {                                                                     \
            const double* restrict triangle = s->value + p[-1].value;                                                  \
            const int* restrict index = s->index + p[-1].index;                                                        \
            int r = p[-1].rows;                                                                                        \
            const double* row = triangle + W * (W + 1) / 2 + (size_t)r * W;                                            \
            v4 c[W], odd[W], *own = (v4*)(x + p[-1].first);                                                            \
            for (int j = 0; j < W; ++j) {                                                                              \
                c[j] = own[j];                                                                                         \
                odd[j] = (v4){0, 0, 0, 0};                                                                             \
            }                                                                                                          \
            for (; r >= 2; r -= 2) {                                                                                   \
                row -= 2 * W;                                                                                          \
                __builtin_prefetch(row - AHEAD);                                                                       \
                v4 y = load(x + index[r - 2]), z = load(x + index[r - 1]);                                             \
                for (int j = 0; j < W; ++j) {                                                                          \
                    c[j] -= row[j] * y;                                                                                \
                    odd[j] -= row[W + j] * z;                                                                          \
                }                                                                                                      \
            }                                                                                                          \
            if (r) {                                                                                                   \
                v4 y = load(x + index[0]);                                                                             \
                for (int j = 0; j < W; ++j)                                                                            \
                    c[j] -= row[j - W] * y;                                                                            \
            }                                                                                                          \
            for (int j = W - 1; j >= 0; --j) {                                                                         \
                const double* column = triangle + j * W - j * (j - 1) / 2;                                             \
                c[j] += odd[j];                                                                                        \
                for (int i = j + 1; i < W; ++i)                                                                        \
                    c[j] -= column[i - j] * c[i];                                                                      \
                c[j] *= column[0];                                                                                     \
                own[j] = c[j];                                                                                         \
            }                                                                                                          \
        }                                                                                                              \
        return p;                                                                                                      \
    }
// clang-format off
FORWARD(1) FORWARD(2) FORWARD(3) FORWARD(4)
BACKWARD(1) BACKWARD(2) BACKWARD(3) BACKWARD(4)

typedef const ax_panel* kernel(const ax_panels*, const ax_panel*, const ax_panel*, ax_vec4*);
// clang-format on

typedef struct pass {
    const ax_panels* panels;
    ax_vec4* x;
} pass;

static void forward(const pass* p, int from, int to)
{
    static kernel* const of_width[] = {NULL, forward_1, forward_2, forward_3, forward_4};
    const ax_panel *panel = p->panels->panels + from, *end = p->panels->panels + to;
    while (panel < end)
        panel = of_width[panel->width](p->panels, panel, end, p->x);
}

static void backward(const pass* p, int from, int to)
{
    static kernel* const of_width[] = {NULL, backward_1, backward_2, backward_3, backward_4};
    const ax_panel *panel = p->panels->panels + to, *end = p->panels->panels + from;
    while (panel > end)
        panel = of_width[panel[-1].width](p->panels, panel, end, p->x);
}

// Where a part keeps the rows of the top that it works on.
static ax_vec4* buffer(const pass* p, int part)
{
    return p->x + p->panels->n + (size_t)part * (size_t)ax_panels_top(p->panels);
}

static void forward_part(void* context, int part)
{
    const pass* p = context;
    const ax_panels* s = p->panels;
    memset(buffer(p, part), 0, (size_t)ax_panels_top(s) * sizeof(ax_vec4));
    forward(p, s->part_panel[part], s->part_panel[part + 1]);
}

static void backward_part(void* context, int part)
{
    const pass* p = context;
    const ax_panels* s = p->panels;
    memcpy(buffer(p, part), p->x + s->top_first, (size_t)ax_panels_top(s) * sizeof(ax_vec4));
    backward(p, s->part_panel[part], s->part_panel[part + 1]);
}

void ax_panels_solve(const ax_panels* s, ax_pool* pool, ax_vec4* x)
{
    pass p = {s, x};
    ax_pool_run(pool, forward_part, &p, s->parts);
    for (int part = 0; part < s->parts; ++part)
        for (int k = 0; k < ax_panels_top(s); ++k)
            *(v4*)(x + s->top_first + k) += load(buffer(&p, part) + k);
    forward(&p, s->part_panel[s->parts], s->panel_count);
    backward(&p, s->part_panel[s->parts], s->panel_count);
    ax_pool_run(pool, backward_part, &p, s->parts);
}

bool ax_panels_negative(const ax_panels* s, int part, ax_vec4* x)
{
    int column = part <= s->parts ? s->failed[part] : -1, panel = s->part_panel[part];
    if (column < 0)
        return false;
    memset(x, 0, ax_panels_rows(s) * sizeof *x);
    while (column >= s->panels[panel].first + s->panels[panel].width)
        ++panel;
    x[column][0] = 1;
    pass p = {s, x};
    if (part == s->parts) {
        backward(&p, s->part_panel[s->parts], panel + 1);
        ax_pool_run(NULL, backward_part, &p, s->parts);
    } else
        backward(&p, s->part_panel[part], panel + 1);
    return true;
}

void ax_panels_free(ax_panels* s)
{
    if (!s)
        return;
    void* blocks[] = {s->panels, s->nodes, s->depth_first, s->index, s->value, s->order, s};
    for (size_t k = 0; k < sizeof blocks / sizeof *blocks; ++k)
        ax_free(blocks[k]);
}

const int* ax_panels_order(const ax_panels* s)
{
    return s->order;
}

size_t ax_panels_rows(const ax_panels* s)
{
    return (size_t)s->n + (size_t)s->parts * (size_t)ax_panels_top(s);
}

double ax_panels_entries(const ax_panels* s)
{
    return (double)s->value_count;
}

size_t ax_panels_bytes(const ax_panels* s)
{
    return 2 * (s->value_count * sizeof *s->value + s->index_count * sizeof *s->index);
}
