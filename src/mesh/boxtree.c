#include "mesh/boxtree.h"

#include <assert.h>

enum {
    leaf_size = 4,
    bin_count = 16,
    heuristic_depth = 32, // below this, halves: the depth stays within 32 + log2 of the largest count
};

typedef struct box {
    float lo[3], hi[3];
} box;

typedef struct item {
    box box;
    int index;
} item;

static const box empty = {{INFINITY, INFINITY, INFINITY}, {-INFINITY, -INFINITY, -INFINITY}};

static void include(box* a, const box* b)
{
    for (int d = 0; d < 3; ++d) {
        a->lo[d] = b->lo[d] < a->lo[d] ? b->lo[d] : a->lo[d];
        a->hi[d] = b->hi[d] > a->hi[d] ? b->hi[d] : a->hi[d];
    }
}

static float half_surface(const box* b)
{
    float x = b->hi[0] - b->lo[0], y = b->hi[1] - b->lo[1], z = b->hi[2] - b->lo[2];
    return x * y + y * z + z * x;
}

static float middle(const box* b, int axis)
{
    return b->lo[axis] + b->hi[axis]; // twice the middle: only compared
}

static int longest_axis(const item* items, int count, float* lo, float* hi)
{
    box middles = empty;
    for (int i = 0; i < count; ++i) {
        box m;
        for (int d = 0; d < 3; ++d)
            m.lo[d] = m.hi[d] = middle(&items[i].box, d);
        include(&middles, &m);
    }
    int axis = 0;
    for (int d = 1; d < 3; ++d)
        if (middles.hi[d] - middles.lo[d] > middles.hi[axis] - middles.lo[axis])
            axis = d;
    *lo = middles.lo[axis];
    *hi = middles.hi[axis];
    return axis;
}

static int bin_of(const item* it, int axis, float lo, float scale)
{
    int bin = (int)((middle(&it->box, axis) - lo) * scale);
    return bin < bin_count ? bin : bin_count - 1;
}

// The first bin of the right part, at the least sum of count x surface of both parts.
static int best_split(const box bins[bin_count], const int counts[bin_count])
{
    float right_cost[bin_count];
    box right = empty;
    int right_count = 0;
    for (int b = bin_count - 1; b > 0; --b) {
        include(&right, &bins[b]);
        right_count += counts[b];
        right_cost[b] = right_count ? (float)right_count * half_surface(&right) : INFINITY;
    }
    box left = empty;
    int left_count = 0, best = bin_count / 2;
    float least = INFINITY;
    for (int b = 1; b < bin_count; ++b) {
        include(&left, &bins[b - 1]);
        left_count += counts[b - 1];
        float cost = left_count ? (float)left_count * half_surface(&left) + right_cost[b] : INFINITY;
        if (cost < least) {
            least = cost;
            best = b;
        }
    }
    return best;
}

// Reorders the items; returns how many go left, at least one and not all.
static int divide(item* items, int count, int depth)
{
    float lo, hi;
    int axis = longest_axis(items, count, &lo, &hi);
    if (depth >= heuristic_depth || !(hi > lo))
        return count / 2;
    float scale = bin_count / (hi - lo);
    if (!(scale < INFINITY))
        return count / 2;

    box bins[bin_count];
    int counts[bin_count] = {0};
    for (int b = 0; b < bin_count; ++b)
        bins[b] = empty;
    for (int i = 0; i < count; ++i) {
        int b = bin_of(&items[i], axis, lo, scale);
        include(&bins[b], &items[i].box);
        ++counts[b];
    }
    int split = best_split(bins, counts);
    int left = 0, right = count;
    while (left < right) {
        if (bin_of(&items[left], axis, lo, scale) < split) {
            ++left;
        } else {
            item moved = items[left];
            items[left] = items[--right];
            items[right] = moved;
        }
    }
    assert(left > 0 && left < count); // the outer bins are never empty
    return left;
}

typedef struct builder {
    item* items;
    ax_box_node* nodes;
    int node_count;
} builder;

static ax_box_link build(builder* work, int first, int count, int depth)
{
    if (count <= leaf_size)
        return (ax_box_link){first, count};
    int node = work->node_count++;
    int left = divide(work->items + first, count, depth);
    int begin[3] = {first, first + left, first + count};
    for (int side = 0; side < 2; ++side) {
        box bounds = empty;
        for (int i = begin[side]; i < begin[side + 1]; ++i)
            include(&bounds, &work->items[i].box);
        for (int d = 0; d < 3; ++d) {
            work->nodes[node].lo[side][d] = bounds.lo[d];
            work->nodes[node].hi[side][d] = bounds.hi[d];
        }
        ax_box_link link = build(work, begin[side], begin[side + 1] - begin[side], depth + 1);
        work->nodes[node].link[side] = link;
    }
    return (ax_box_link){node, 0};
}

ax_box_tree ax_box_tree_make(int count, const double (*boxes)[2][3])
{
    assert(count > 0);
    double lo[3], hi[3];
    for (int d = 0; d < 3; ++d) {
        lo[d] = boxes[0][0][d];
        hi[d] = boxes[0][1][d];
    }
    for (int i = 1; i < count; ++i)
        for (int d = 0; d < 3; ++d) {
            lo[d] = fmin(lo[d], boxes[i][0][d]);
            hi[d] = fmax(hi[d], boxes[i][1][d]);
        }
    ax_box_tree tree = {.order = AX_NEW(int, count)};
    for (int d = 0; d < 3; ++d)
        tree.centre[d] = 0.5 * (lo[d] + hi[d]);

    // Rounding to float moves a corner by at most 2^-24 of half the diagonal.
    double pad = 1e-6 * ax_distance3(lo, hi);
    builder work = {.items = AX_NEW(item, count), .nodes = AX_NEW(ax_box_node, count)};
    for (int i = 0; i < count; ++i) {
        for (int d = 0; d < 3; ++d) {
            work.items[i].box.lo[d] = (float)(boxes[i][0][d] - tree.centre[d] - pad);
            work.items[i].box.hi[d] = (float)(boxes[i][1][d] - tree.centre[d] + pad);
        }
        work.items[i].index = i;
    }
    tree.root = build(&work, 0, count, 0);
    tree.nodes = ax_realloc(work.nodes, (size_t)work.node_count, sizeof *work.nodes);
    for (int i = 0; i < count; ++i)
        tree.order[i] = work.items[i].index;
    ax_free(work.items);
    return tree;
}

void ax_box_tree_free(ax_box_tree* tree)
{
    ax_free(tree->nodes);
    ax_free(tree->order);
    *tree = (ax_box_tree){0};
}
