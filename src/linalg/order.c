// Recursive bisection at the median along the direction that leaves the smallest separator: nodes on one side with a neighbour
// on the other, eliminated after both. Below LEAF nodes, and within separators, a constrained minimum degree order fills in.
#include "linalg/order.h"

#include "base/vec.h"
#include "linalg/cholmod_view.h"

#include <assert.h>
#include <stdlib.h>

enum { LEAF = 100 };

typedef struct dissection {
    const int *start, *neighbour; // full adjacency
    const double (*place)[3];
    int *node, *side, *ahead, *set, sets; // ahead: neighbours behind the cut
    double* key;
} dissection;

// Directions in which a part may be cut, in the plane of its two largest extents. Triangular lattices have cheap cuts every
// thirty degrees.
enum { DIRECTIONS = 6 };

static bool before(const dissection* d, int a, int b)
{
    return d->key[a] < d->key[b] || (d->key[a] == d->key[b] && a < b); // ties by number: the order is unique
}

// Partial sort of the nodes [from, to): those with smaller keys come before `middle`.
static void select_median(dissection* d, int from, int to, int middle)
{
    int* node = d->node;
    while (to - from > 1) {
        int a = node[from], b = node[from + (to - from - 1) / 2], c = node[to - 1];
        int value = before(d, a, b) ? (before(d, b, c) ? b : (before(d, a, c) ? c : a))
                                    : (before(d, a, c) ? a : (before(d, b, c) ? c : b));
        int i = from - 1, j = to;
        while (true) { // Hoare's partition
            while (before(d, node[++i], value))
                ;
            while (before(d, value, node[--j]))
                ;
            if (i >= j)
                break;
            int swap = node[i];
            node[i] = node[j], node[j] = swap;
        }
        if (j >= middle)
            to = j + 1;
        else
            from = j + 1;
    }
}

static int by_key(const void* a, const void* b, void* context)
{
    int x = *(const int*)a, y = *(const int*)b;
    return before(context, x, y) ? -1 : x != y;
}

// Sorts [from, to) along `direction` and finds the cut between 40 and 60 % with the smallest separator, by sweeping: nodes before
// the cut with neighbours behind it. Returns its size, sets *middle. Places that rounding or noise has moved off
// their row would make the very median a ragged cut.
static int cut_along(dissection* d, int from, int to, const double direction[3], int* middle)
{
    int count = to - from, lo = from + (int)(0.4 * count), hi = from + (int)(0.6 * count);
    for (int k = from; k < to; ++k) {
        const double* x = d->place[d->node[k]];
        d->key[d->node[k]] = x[0] * direction[0] + x[1] * direction[1] + x[2] * direction[2];
    }
    select_median(d, from, to, lo);
    select_median(d, lo, to, hi);
    qsort_r(d->node + lo, (size_t)(hi - lo), sizeof *d->node, by_key, d);
    for (int k = from; k < to; ++k) {
        d->side[d->node[k]] = k < lo ? 1 : 2;
        d->ahead[d->node[k]] = 0;
    }
    int size = 0, least = count + 1;
    for (int k = lo; k < to; ++k)
        for (int e = d->start[d->node[k]]; e < d->start[d->node[k] + 1]; ++e)
            size += d->side[d->neighbour[e]] == 1 && d->ahead[d->neighbour[e]]++ == 0;
    for (int k = lo; k < hi; ++k) { // move node k before the cut
        int v = d->node[k], ahead = 0;
        d->side[v] = 1;
        for (int e = d->start[v]; e < d->start[v + 1]; ++e) {
            int w = d->neighbour[e];
            ahead += d->side[w] == 2;
            if (d->side[w] == 1 && w != v && --d->ahead[w] == 0)
                --size;
        }
        d->ahead[v] = ahead;
        size += ahead > 0;
        if (size < least)
            least = size, *middle = k + 1;
    }
    for (int k = from; k < to; ++k)
        d->side[d->node[k]] = k < *middle ? 1 : 2;
    return least;
}

static void dissect(dissection* d, int from, int to)
{
    int count = to - from;
    if (count <= LEAF) {
        for (int k = from; k < to; ++k)
            d->set[d->node[k]] = d->sets;
        ++d->sets;
        return;
    }
    double lo[3], hi[3];
    for (int c = 0; c < 3; ++c)
        lo[c] = INFINITY, hi[c] = -INFINITY;
    for (int k = from; k < to; ++k)
        for (int c = 0; c < 3; ++c)
            lo[c] = fmin(lo[c], d->place[d->node[k]][c]), hi[c] = fmax(hi[c], d->place[d->node[k]][c]);
    int axis[3] = {0, 1, 2}; // by extent, largest first
    for (int a = 0; a < 2; ++a)
        for (int b = 2; b > a; --b)
            if (hi[axis[b]] - lo[axis[b]] > hi[axis[b - 1]] - lo[axis[b - 1]]) {
                int swap = axis[b];
                axis[b] = axis[b - 1], axis[b - 1] = swap;
            }
    int middle = from, best = -1, least = count + 1;
    double directions[DIRECTIONS][3] = {{0}};
    int tried = count > 5000 ? DIRECTIONS : 2, stride = DIRECTIONS / tried;
    for (int k = 0; k < DIRECTIONS; k += stride) {
        directions[k][axis[0]] = cos(k * AX_PI / DIRECTIONS);
        directions[k][axis[1]] = sin(k * AX_PI / DIRECTIONS);
        int size = cut_along(d, from, to, directions[k], &middle);
        if (size < least)
            least = size, best = k;
    }
    if (best != DIRECTIONS - stride)
        cut_along(d, from, to, directions[best], &middle);
    // separator: first-half nodes that touch the second half, moved to the end of the first half
    int cut = middle;
    for (int k = from; k < cut;) {
        int v = d->node[k];
        bool touches = false;
        for (int e = d->start[v]; e < d->start[v + 1] && !touches; ++e)
            touches = d->side[d->neighbour[e]] == 2;
        if (touches) {
            --cut;
            d->node[k] = d->node[cut], d->node[cut] = v;
        } else
            ++k;
    }
    for (int k = from; k < to; ++k)
        d->side[d->node[k]] = 0;
    if (cut == from) { // no part is left to dissect: a dense cluster
        for (int k = from; k < to; ++k)
            d->set[d->node[k]] = d->sets;
        ++d->sets;
        return;
    }
    dissect(d, from, cut);
    dissect(d, middle, to);
    for (int k = cut; k < middle; ++k)
        d->set[d->node[k]] = d->sets;
    ++d->sets;
}

void ax_order_by_place(const ax_sparse* matrix, const double (*place)[3], int* order)
{
    int n = matrix->n;
    int *start = AX_NEW0(int, n + 2), *neighbour = AX_NEW(int, 2 * (size_t)matrix->start[n]);
    for (int j = 0; j < n; ++j)
        for (int k = matrix->start[j]; k < matrix->start[j + 1]; ++k)
            if (matrix->row[k] != j)
                ++start[j + 2], ++start[matrix->row[k] + 2];
    for (int j = 0; j <= n; ++j)
        start[j + 1] += start[j];
    for (int j = 0; j < n; ++j)
        for (int k = matrix->start[j]; k < matrix->start[j + 1]; ++k)
            if (matrix->row[k] != j) {
                neighbour[start[j + 1]++] = matrix->row[k];
                neighbour[start[matrix->row[k] + 1]++] = j;
            }
    dissection d = {.start = start,
                    .neighbour = neighbour,
                    .place = place,
                    .node = AX_NEW(int, n),
                    .side = AX_NEW0(int, n),
                    .ahead = AX_NEW(int, n),
                    .set = AX_NEW(int, n),
                    .key = AX_NEW(double, n)};
    for (int v = 0; v < n; ++v)
        d.node[v] = v;
    dissect(&d, 0, n);

    cholmod_common common;
    cholmod_start(&common);
    common.print = 0;
    cholmod_sparse a = ax_cholmod_view(matrix);
    int sound = cholmod_camd(&a, NULL, 0, d.set, order, &common);
    cholmod_finish(&common);
    assert(sound);
    (void)sound;
    ax_free(start);
    ax_free(neighbour);
    ax_free(d.node);
    ax_free(d.side);
    ax_free(d.set);
    ax_free(d.ahead);
    ax_free(d.key);
}
