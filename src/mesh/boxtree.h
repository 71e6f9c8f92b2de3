// Bounding volume tree over boxes, in flat arrays: binned surface-area heuristic, leaves of up to four. The boxes are
// stored in single precision around a centre and padded by more than that costs, so pruning never loses a candidate:
// what a search finds does not depend on the order in which it visits.
#pragma once

#include "ax/base.h"
#include "base/vec.h"

// What a link leads to: `count` items from order[first] on, or, if count is 0, the node `first`.
typedef struct ax_box_link {
    int first, count;
} ax_box_link;

typedef struct ax_box_node { // one cache line
    float lo[2][3], hi[2][3];
    ax_box_link link[2];
} ax_box_node;

typedef struct ax_box_tree {
    double centre[3];
    ax_box_link root;
    ax_box_node* nodes;
    int* order; // items, grouped by leaf
} ax_box_tree;

// boxes[i] = {lowest, highest corner} of item i, finite; count > 0.
ax_box_tree ax_box_tree_make(int count, const double (*boxes)[2][3]);
void ax_box_tree_free(ax_box_tree* tree);

enum { ax_box_tree_depth = 64 }; // no path has more nodes

static inline double ax_box_distance_squared(const ax_box_node* node, int side, const double lo[3], const double hi[3])
{
    double sum = 0;
    for (int d = 0; d < 3; ++d) {
        double below = node->lo[side][d] - hi[d], above = lo[d] - node->hi[side][d];
        double outside = below > above ? below : above;
        outside = outside > 0 ? outside : 0;
        sum += outside * outside;
    }
    return sum;
}

// Calls visit(context, place) for the place in `order` of every item whose box may lie within *limit (a squared distance, which
// `visit` may lower) of the box from lo to hi, or the point if they are the same; nearest boxes first. Inlined so that the calls
// are direct.
static inline __attribute__((always_inline)) void ax_box_tree_nearest(const ax_box_tree* tree, const double lo[3],
                                                                      const double hi[3], const double* limit,
                                                                      void (*visit)(void* context, int place),
                                                                      void* context)
{
    struct {
        ax_box_link link;
        double distance;
    } stack[ax_box_tree_depth];
    double from[3], to[3];
    ax_sub3(lo, tree->centre, from);
    ax_sub3(hi, tree->centre, to);
    int depth = 0;
    ax_box_link at = tree->root;
    for (;;) {
        if (at.count) {
            for (int i = 0; i < at.count; ++i)
                visit(context, at.first + i);
        } else {
            const ax_box_node* node = tree->nodes + at.first;
            double distance[2] = {ax_box_distance_squared(node, 0, from, to),
                                  ax_box_distance_squared(node, 1, from, to)};
            int near = distance[1] < distance[0];
            if (distance[near] <= *limit) {
                if (distance[!near] <= *limit) {
                    stack[depth].link = node->link[!near];
                    stack[depth++].distance = distance[!near];
                }
                at = node->link[near];
                continue;
            }
        }
        do {
            if (depth == 0)
                return;
            --depth;
        } while (stack[depth].distance > *limit);
        at = stack[depth].link;
    }
}
