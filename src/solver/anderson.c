#include "solver/anderson.h"

#include "ax/base.h"

#include <assert.h>
#include <math.h>
#include <string.h>

enum { PIECE = 8192, MOST = AX_ANDERSON_MOST, SUMS = 2 * MOST };
// Share of a column across the others below which it tells nothing new.
static const double DEPENDENT = 1e-12;

struct ax_anderson {
    int window, past, newest; // columns kept, and the place of the last one
    bool begun;               // there is an image to take differences with
    ax_anderson_part* parts;
    int part_count, part_capacity, pieces, most_pieces;
    size_t size, capacity;
    // each `size` doubles, the parts one after the other
    double *from, *image, *residual; // v, the last G, its F
    double *image_step[MOST], *residual_step[MOST];
    double product[MOST][MOST], side[MOST]; // residual steps with each other and with F
    double combination[MOST];
    double (*sums)[SUMS]; // per piece
};

ax_anderson* ax_anderson_make(int window)
{
    assert(window >= 1 && window <= MOST);
    ax_anderson* a = AX_NEW0(ax_anderson, 1);
    a->window = window;
    return a;
}

static void free_arrays(ax_anderson* a)
{
    ax_free(a->from);
    ax_free(a->image);
    ax_free(a->residual);
    for (int k = 0; k < a->window; ++k) {
        ax_free(a->image_step[k]);
        ax_free(a->residual_step[k]);
    }
    ax_free(a->sums);
}

void ax_anderson_free(ax_anderson* a)
{
    if (!a)
        return;
    free_arrays(a);
    ax_free(a->parts);
    ax_free(a);
}

size_t ax_anderson_bytes(const ax_anderson* a)
{
    return (3 + 2 * (size_t)a->window) * a->capacity * sizeof(double);
}

static int piece_count(const ax_anderson_part* part)
{
    return (int)((part->count + PIECE - 1) / PIECE);
}

// A piece lies within one part: its values in the state, its place in the arrays, its length.
typedef struct stretch {
    double* state;
    size_t at, count;
} stretch;

static stretch find_piece(const ax_anderson* a, int piece)
{
    size_t before = 0;
    int p = 0;
    for (int pieces; piece >= (pieces = piece_count(a->parts + p)); ++p)
        piece -= pieces, before += a->parts[p].count;
    size_t first = (size_t)piece * PIECE, left = a->parts[p].count - first;
    return (stretch){a->parts[p].values + first, before + first, left < PIECE ? left : PIECE};
}

static void keep_from(void* context, int piece)
{
    ax_anderson* a = context;
    stretch s = find_piece(a, piece);
    memcpy(a->from + s.at, s.state, s.count * sizeof *s.state);
}

void ax_anderson_start(ax_anderson* a, int count, const ax_anderson_part* parts, ax_pool* pool)
{
    if (count > a->part_capacity) {
        a->parts = ax_realloc(a->parts, (size_t)count, sizeof *parts);
        a->part_capacity = count;
    }
    memcpy(a->parts, parts, (size_t)count * sizeof *parts);
    a->part_count = count;
    a->size = 0, a->pieces = 0;
    for (int p = 0; p < count; ++p) {
        a->size += parts[p].count;
        a->pieces += piece_count(parts + p);
    }
    if (a->size > a->capacity || a->pieces > a->most_pieces) {
        free_arrays(a);
        a->capacity = a->size, a->most_pieces = a->pieces;
        a->from = ax_alloc_aligned(a->size, sizeof(double));
        a->image = ax_alloc_aligned(a->size, sizeof(double));
        a->residual = ax_alloc_aligned(a->size, sizeof(double));
        for (int k = 0; k < a->window; ++k) {
            a->image_step[k] = ax_alloc_aligned(a->size, sizeof(double));
            a->residual_step[k] = ax_alloc_aligned(a->size, sizeof(double));
        }
        a->sums = ax_alloc((size_t)a->pieces, sizeof *a->sums);
    }
    ax_anderson_forget(a);
    a->begun = false;
    ax_pool_run(pool, keep_from, a, a->pieces);
}

static void combine(void* context, int piece)
{
    ax_anderson* a = context;
    stretch s = find_piece(a, piece);
    for (int k = 0; k < a->past; ++k) {
        const double *step = a->image_step[k] + s.at, share = a->combination[k];
        for (size_t i = 0; i < s.count; ++i)
            s.state[i] -= share * step[i];
    }
    memcpy(a->from + s.at, s.state, s.count * sizeof *s.state);
}

bool ax_anderson_jump(ax_anderson* a, ax_pool* pool)
{
    if (a->past == 0) {
        ax_pool_run(pool, keep_from, a, a->pieces);
        return false;
    }
    ax_pool_run(pool, combine, a, a->pieces);
    return true;
}

static void sum_residual(void* context, int piece)
{
    ax_anderson* a = context;
    stretch s = find_piece(a, piece);
    const double* from = a->from + s.at;
    double sum = 0;
    for (size_t i = 0; i < s.count; ++i)
        sum += (s.state[i] - from[i]) * (s.state[i] - from[i]);
    a->sums[piece][0] = sum;
}

double ax_anderson_residual(ax_anderson* a, ax_pool* pool)
{
    ax_pool_run(pool, sum_residual, a, a->pieces);
    double sum = 0;
    for (int p = 0; p < a->pieces; ++p)
        sum += a->sums[p][0];
    return sum;
}

// Eight sums side by side, in the same order on every machine.
static double dot(const double* x, const double* y, size_t count)
{
    double sum[8] = {0};
    size_t i = 0;
    for (; i + 8 <= count; i += 8)
        for (int l = 0; l < 8; ++l)
            sum[l] += x[i + (size_t)l] * y[i + (size_t)l];
    for (; i < count; ++i)
        sum[0] += x[i] * y[i];
    return ((sum[0] + sum[1]) + (sum[2] + sum[3])) + ((sum[4] + sum[5]) + (sum[6] + sum[7]));
}

static void take_piece(void* context, int piece)
{
    ax_anderson* a = context;
    stretch s = find_piece(a, piece);
    double *image = a->image + s.at, *residual = a->residual + s.at, *from = a->from + s.at;
    if (!a->begun) {
        for (size_t i = 0; i < s.count; ++i)
            residual[i] = s.state[i] - from[i];
        memcpy(image, s.state, s.count * sizeof *s.state);
        return;
    }
    double *image_step = a->image_step[a->newest] + s.at, *residual_step = a->residual_step[a->newest] + s.at;
    for (size_t i = 0; i < s.count; ++i) {
        double f = s.state[i] - from[i];
        image_step[i] = s.state[i] - image[i], residual_step[i] = f - residual[i];
        residual[i] = f;
    }
    memcpy(image, s.state, s.count * sizeof *s.state);
    for (int k = 0; k < a->past; ++k) {
        a->sums[piece][k] = dot(residual_step, a->residual_step[k] + s.at, s.count);
        a->sums[piece][MOST + k] = dot(residual, a->residual_step[k] + s.at, s.count);
    }
}

// Least squares by the normal equations of columns of length one; those that depend on newer ones are left out.
static void solve(ax_anderson* a)
{
    double l[MOST][MOST], y[MOST], scale[MOST];
    int used[MOST], count = 0;
    memset(a->combination, 0, sizeof a->combination);
    for (int age = 0; age < a->past; ++age) {
        int k = (a->newest - age + a->window) % a->window;
        if (!(a->product[k][k] > 0))
            continue;
        scale[count] = 1 / sqrt(a->product[k][k]);
        double left = 1, side = scale[count] * a->side[k];
        for (int i = 0; i < count; ++i) {
            double sum = scale[count] * scale[i] * a->product[k][used[i]];
            for (int j = 0; j < i; ++j)
                sum -= l[count][j] * l[i][j];
            l[count][i] = sum / l[i][i];
            left -= l[count][i] * l[count][i];
            side -= l[count][i] * y[i];
        }
        if (!(left > DEPENDENT))
            continue;
        l[count][count] = sqrt(left);
        y[count] = side / l[count][count];
        used[count++] = k;
    }
    for (int i = count - 1; i >= 0; --i) {
        double sum = y[i];
        for (int j = i + 1; j < count; ++j)
            sum -= l[j][i] * y[j];
        y[i] = sum / l[i][i];
        a->combination[used[i]] = scale[i] * y[i];
    }
}

void ax_anderson_take(ax_anderson* a, ax_pool* pool)
{
    if (a->begun) {
        a->newest = (a->newest + 1) % a->window;
        a->past = a->past < a->window ? a->past + 1 : a->past;
    }
    ax_pool_run(pool, take_piece, a, a->pieces);
    if (a->begun) {
        for (int k = 0; k < a->past; ++k) {
            double product = 0, side = 0;
            for (int p = 0; p < a->pieces; ++p)
                product += a->sums[p][k], side += a->sums[p][MOST + k];
            a->product[k][a->newest] = a->product[a->newest][k] = product;
            a->side[k] = side;
        }
        solve(a);
    }
    a->begun = true;
}

static void restore(void* context, int piece)
{
    ax_anderson* a = context;
    stretch s = find_piece(a, piece);
    memcpy(s.state, a->image + s.at, s.count * sizeof *s.state);
    memcpy(a->from + s.at, a->image + s.at, s.count * sizeof *s.state);
}

void ax_anderson_revert(ax_anderson* a, ax_pool* pool)
{
    ax_pool_run(pool, restore, a, a->pieces);
}

void ax_anderson_forget(ax_anderson* a)
{
    a->past = 0, a->newest = a->window - 1;
}
