// The elimination tree (Liu 1986), supernodes, and the cut of their tree into parts and a top.
#include "linalg/panels_layout.h"

#include <assert.h>
#include <stdlib.h>
#include <string.h>

enum {
    LEAST_PARALLEL = 20000, // entries of a factor worth cutting
    MOST_ZEROS = 4,         // merged supernodes hold at most one zero in so many entries
    BUSH = 512,             // columns of a subtree that is eliminated level by level
};

// Per column k of the given order, the earlier columns that the matrix ties to it.
static void list_earlier(const ax_sparse* matrix, const int* order, int* start, int* earlier)
{
    int n = matrix->n, *position = AX_NEW(int, n);
    for (int k = 0; k < n; ++k)
        position[order[k]] = k;
    memset(start, 0, (size_t)(n + 2) * sizeof *start);
    for (int pass = 0; pass < 2; ++pass) {
        for (int v = 0; v < n; ++v)
            for (int e = matrix->start[v]; e < matrix->start[v + 1]; ++e) {
                int a = position[v], b = position[matrix->row[e]];
                int late = a > b ? a : b;
                if (a == b)
                    continue;
                if (pass)
                    earlier[start[late + 1]++] = a > b ? b : a;
                else
                    ++start[late + 2];
            }
        for (int k = 0; k <= n && pass == 0; ++k)
            start[k + 1] += start[k];
    }
    ax_free(position);
}

// Parents in the elimination tree, -1 at roots; `mark` is scratch.
static void find_parents(int n, const int* start, const int* earlier, int* parent, int* mark)
{
    for (int k = 0; k < n; ++k) {
        parent[k] = mark[k] = -1;
        for (int e = start[k]; e < start[k + 1]; ++e)
            for (int i = earlier[e], next; i >= 0 && i < k; i = next) {
                next = mark[i];
                mark[i] = k; // paths are compressed
                if (next < 0)
                    parent[i] = k;
            }
    }
}

// Entries of each column of the factor, its diagonal included: row k of the factor is the subtree that hangs from its entries.
static void count_columns(int n, const int* start, const int* earlier, const int* parent, int* count, int* mark)
{
    memset(mark, -1, (size_t)n * sizeof *mark);
    for (int k = 0; k < n; ++k) {
        count[k] = 1;
        mark[k] = k;
        for (int e = start[k]; e < start[k + 1]; ++e)
            for (int i = earlier[e]; mark[i] != k; i = parent[i]) {
                mark[i] = k;
                ++count[i];
            }
    }
}

// post[k]: the column that a depth-first walk leaves k-th, smaller columns first.
static void postorder(int n, const int* parent, int* post)
{
    int *child = AX_NEW(int, n), *sibling = AX_NEW(int, n), *stack = AX_NEW(int, n), depth = 0, left = 0;
    memset(child, -1, (size_t)n * sizeof *child);
    for (int k = n - 1; k >= 0; --k)
        if (parent[k] >= 0)
            sibling[k] = child[parent[k]], child[parent[k]] = k;
    for (int root = 0; root < n; ++root) {
        if (parent[root] >= 0)
            continue;
        stack[depth++] = root;
        while (depth) {
            int k = stack[depth - 1], c = child[k];
            if (c >= 0) {
                child[k] = sibling[c];
                stack[depth++] = c;
            } else {
                post[left++] = k;
                --depth;
            }
        }
    }
    assert(left == n);
    ax_free(child);
    ax_free(sibling);
    ax_free(stack);
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
        if (below[s] <= total / AX_PANEL_PARTS || top + work[s] > total / 6 || first_child[s] < 0)
            break;
        top += work[s];
        owner[s] = AX_PANEL_PARTS;
        open[largest] = open[--opened];
        for (int c = first_child[s]; c >= 0; c = sibling[c])
            open[opened++] = c;
    }
    // subtrees to parts, each to the part with the least work so far
    double load_of[AX_PANEL_PARTS] = {0};
    int parts = opened < AX_PANEL_PARTS ? opened : AX_PANEL_PARTS;
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
    // dealt out so that halves and quarters of the parts, which threads begin with, are of a size
    static const int deal[AX_PANEL_PARTS] = {0, 4, 6, 2, 3, 7, 5, 1};
    int rank[AX_PANEL_PARTS] = {0};
    for (int a = 0; a < parts; ++a)
        for (int b = 0; b < parts; ++b)
            rank[a] += load_of[b] > load_of[a] || (load_of[b] == load_of[a] && b < a);
    for (int k = 0; k < opened && parts == AX_PANEL_PARTS; ++k)
        owner[open[k]] = deal[rank[owner[open[k]]]];
    for (int s = count - 1; s >= 0; --s) // parents precede children
        if (owner[s] == AX_PANEL_PARTS)
            owner[s] = parts;
        else if (owner[s] < 0)
            owner[s] = owner[parent[s]];
    ax_free(below);
    ax_free(first_child);
    ax_free(sibling);
    ax_free(open);
    return parts;
}

// Supernodes of a postordered tree: columns of one pattern, and small ones merged while their panel has room and few zeros come
// in. Fills nodes (first, width, rows, parent), node_of; returns how many.
static int find_supernodes(int n, const int* parent, const int* count, ax_supernode* nodes, int* node_of)
{
    int made = 0;
    for (int k = 0; k < n; ++k) {
        ax_supernode* last = nodes + made - 1;
        if (made && parent[k - 1] == k && count[k - 1] == count[k] + 1)
            ++last->width, last->rows = count[k] - 1;
        else
            nodes[made++] = (ax_supernode){.first = k, .width = 1, .rows = count[k] - 1};
    }
    int kept = 0;
    for (int s = 0; s < made; ++s) {
        ax_supernode node = nodes[s];
        while (kept) {
            const ax_supernode* before = nodes + kept - 1;
            int width = before->width + node.width, zeros = before->width * (node.width + node.rows - before->rows);
            if (parent[node.first - 1] != node.first || width > AX_PANEL_WIDTH ||
                zeros * MOST_ZEROS > width * node.rows)
                break;
            node.first = before->first, node.width = width;
            --kept;
        }
        nodes[kept++] = node;
    }
    for (int s = 0; s < kept; ++s)
        for (int k = 0; k < nodes[s].width; ++k)
            node_of[nodes[s].first + k] = s;
    for (int s = 0; s < kept; ++s) {
        int above = parent[nodes[s].first + nodes[s].width - 1];
        nodes[s].parent = above < 0 ? -1 : node_of[above];
    }
    return kept;
}

typedef struct leaf {
    int node, height, width, rows;
} leaf;

static int by_level(const void* a, const void* b)
{
    const leaf *p = a, *q = b;
    int by[] = {p->height - q->height, p->width - q->width, p->rows - q->rows, p->node - q->node};
    for (int k = 0; k < 3; ++k)
        if (by[k])
            return by[k];
    return by[3];
}

// The order in which postordered supernodes are to be solved. Most have one or two columns and a dozen rows: along a branch each
// waits for the one before, and no processor foresees how many rows the next one has. So small subtrees go level by level, equals
// side by side.
static void order_bushes(int count, const ax_supernode* nodes, int* order)
{
    int *size = AX_NEW0(int, count), *columns = AX_NEW0(int, count), *height = AX_NEW0(int, count);
    leaf* leaves = AX_NEW(leaf, count);
    for (int k = 0; k < count; ++k) {
        order[k] = k;
        ++size[k], columns[k] += nodes[k].width;
        int above = nodes[k].parent;
        if (above < 0)
            continue;
        size[above] += size[k], columns[above] += columns[k];
        height[above] = height[k] + 1 > height[above] ? height[k] + 1 : height[above];
    }
    for (int k = 0; k < count; ++k) {
        if (columns[k] > BUSH || (nodes[k].parent >= 0 && columns[nodes[k].parent] <= BUSH))
            continue;
        int first = k - size[k] + 1;
        for (int j = first; j <= k; ++j)
            leaves[j] = (leaf){j, height[j], nodes[j].width, nodes[j].rows};
        qsort(leaves + first, (size_t)size[k], sizeof *leaves, by_level);
        for (int j = first; j <= k; ++j)
            order[j] = leaves[j].node;
    }
    ax_free(size);
    ax_free(columns);
    ax_free(height);
    ax_free(leaves);
}

// Brings supernodes part by part, the top last, and numbers their columns anew: order becomes that of elimination.
static void arrange(ax_panels* s, const ax_supernode* from, const int* owner, const int* order)
{
    int *place = AX_NEW(int, s->node_count), *visit = AX_NEW(int, s->node_count), nodes = 0, columns = 0, panels = 0,
        index = 0;
    size_t value = 0;
    order_bushes(s->node_count, from, visit);
    for (int part = 0; part <= s->parts; ++part) {
        s->part_node[part] = nodes, s->part_column[part] = columns, s->part_panel[part] = panels;
        for (int v = 0; v < s->node_count; ++v) {
            int k = visit[v];
            if (owner[k] != part)
                continue;
            ax_supernode* node = s->nodes + nodes;
            *node = from[k];
            node->first = columns, node->index = index, node->panel = panels;
            node->child = node->sibling = -1;
            memcpy(s->order + columns, order + from[k].first, (size_t)node->width * sizeof *order);
            place[k] = nodes++;
            columns += node->width;
            index += node->width + node->rows;
            for (int c = 0; c < node->width; c += AX_PANEL_WIDTH) {
                int w = node->width - c < AX_PANEL_WIDTH ? node->width - c : AX_PANEL_WIDTH;
                int rows = node->width - c - w + node->rows;
                s->panels[panels++] = (ax_panel){node->first + c, w, rows, node->index + c + w, value};
                value += (size_t)(w * (w + 1) / 2) + (size_t)w * (size_t)rows;
            }
        }
    }
    s->part_node[s->parts + 1] = nodes, s->part_column[s->parts + 1] = columns, s->part_panel[s->parts + 1] = panels;
    s->top_first = s->part_column[s->parts];
    s->panel_count = panels;
    s->index_count = (size_t)index;
    s->value_count = value;
    for (int k = 0; k < s->node_count; ++k) { // children precede parents still
        ax_supernode* node = s->nodes + place[k];
        node->parent = from[k].parent < 0 ? -1 : place[from[k].parent];
        if (node->parent >= 0) {
            node->sibling = s->nodes[node->parent].child;
            s->nodes[node->parent].child = place[k];
        }
    }
    for (int part = 0, at = 0; part <= s->parts; ++part)
        for (int k = 0; k < s->node_count; ++k)
            if (owner[k] == part)
                s->depth_first[at++] = place[k];
    ax_free(place);
    ax_free(visit);
}

// The rows of every supernode, ascending: row k goes to the supernodes on the paths from its entries up to its own.
static void list_rows(ax_panels* s, const int* start, const int* earlier)
{
    int *node_of = AX_NEW(int, s->n), *mark = AX_NEW(int, s->node_count), *used = AX_NEW(int, s->node_count);
    for (int part = 0; part <= s->parts; ++part)
        for (int k = s->part_node[part]; k < s->part_node[part + 1]; ++k) {
            const ax_supernode* node = s->nodes + k;
            mark[k] = -1;
            used[k] = node->index + node->width;
            for (int c = 0; c < node->width; ++c) {
                s->index[node->index + c] = node->first + c;
                node_of[node->first + c] = k;
            }
        }
    for (int row = 0; row < s->n; ++row) {
        mark[node_of[row]] = row;
        for (int e = start[row]; e < start[row + 1]; ++e)
            for (int k = node_of[earlier[e]]; mark[k] != row; k = s->nodes[k].parent) {
                mark[k] = row;
                s->index[used[k]++] = row;
            }
    }
    for (int part = 0; part < s->parts; ++part) // rows of the top, seen from a part
        for (int k = s->part_node[part]; k < s->part_node[part + 1]; ++k) {
            const ax_supernode* node = s->nodes + k;
            assert(used[k] == node->index + node->width + node->rows);
            for (int r = used[k] - 1; r >= node->index && s->index[r] >= s->top_first; --r)
                s->index[r] += s->n - s->top_first + part * ax_panels_top(s);
        }
    ax_free(node_of);
    ax_free(mark);
    ax_free(used);
}

// What factorising each part holds at most: one front, and a stack of what finished fronts left for their parents.
static void measure_stacks(ax_panels* s)
{
    for (int part = 0; part <= s->parts; ++part) {
        size_t held = 0;
        for (int k = s->part_node[part]; k < s->part_node[part + 1]; ++k) {
            const ax_supernode* node = s->nodes + s->depth_first[k];
            size_t rows = (size_t)(node->width + node->rows), front = ax_front_stride(node) * rows;
            s->longest[part] = rows > s->longest[part] ? rows : s->longest[part];
            s->front_size[part] = front > s->front_size[part] ? front : s->front_size[part];
            for (int c = node->child; c >= s->part_node[part]; c = s->nodes[c].sibling)
                held -= ax_update_size(s->nodes + c);
            held += ax_update_size(node);
            s->stack_size[part] = held > s->stack_size[part] ? held : s->stack_size[part];
        }
    }
}

ax_panels* ax_panels_analyse(const ax_sparse* matrix, const int* order)
{
    int n = matrix->n;
    int *start = AX_NEW(int, n + 2), *earlier = AX_NEW(int, matrix->start[n]), *mark = AX_NEW(int, n);
    int *parent = AX_NEW(int, n), *count = AX_NEW(int, n), *post = AX_NEW(int, n), *by_post = AX_NEW(int, n);
    list_earlier(matrix, order, start, earlier);
    find_parents(n, start, earlier, parent, mark);
    count_columns(n, start, earlier, parent, count, mark);
    postorder(n, parent, post);
    int *new_parent = AX_NEW(int, n), *new_count = AX_NEW(int, n);
    for (int k = 0; k < n; ++k)
        mark[post[k]] = k;
    for (int k = 0; k < n; ++k) {
        by_post[k] = order[post[k]];
        new_parent[k] = parent[post[k]] < 0 ? -1 : mark[parent[post[k]]];
        new_count[k] = count[post[k]];
    }

    ax_panels* s = AX_NEW0(ax_panels, 1);
    s->n = n;
    s->order = AX_NEW(int, n);
    ax_supernode* nodes = AX_NEW(ax_supernode, n);
    s->node_count = find_supernodes(n, new_parent, new_count, nodes, mark);
    double* work = AX_NEW(double, s->node_count);
    int *owner = AX_NEW(int, s->node_count), *node_parent = AX_NEW(int, s->node_count), panels = 0;
    for (int k = 0; k < s->node_count; ++k) {
        double width = nodes[k].width;
        work[k] = width * (width + 1) / 2 + width * nodes[k].rows;
        node_parent[k] = nodes[k].parent;
        panels += (nodes[k].width + AX_PANEL_WIDTH - 1) / AX_PANEL_WIDTH;
    }
    s->parts = cut_tree(s->node_count, node_parent, work, owner);
    s->nodes = AX_NEW(ax_supernode, s->node_count);
    s->depth_first = AX_NEW(int, s->node_count);
    s->panels = AX_NEW(ax_panel, panels);
    arrange(s, nodes, owner, by_post);
    list_earlier(matrix, s->order, start, earlier);
    s->index = AX_NEW(int, s->index_count);
    list_rows(s, start, earlier);
    measure_stacks(s);
    s->value = ax_alloc_aligned(s->value_count, sizeof *s->value);
    void* blocks[] = {start,      earlier,   mark,  parent, count, post,       by_post,
                      new_parent, new_count, nodes, work,   owner, node_parent};
    for (size_t k = 0; k < sizeof blocks / sizeof *blocks; ++k)
        ax_free(blocks[k]);
    return s;
}
