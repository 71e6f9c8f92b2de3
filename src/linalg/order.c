// Recursive bisection: each part is cut along the direction, of a few, whose sweep between 40 and 60 % of its nodes meets the
// smallest separator: nodes before the cut with a neighbour behind it, eliminated after both sides. Sweeps count in bins much
// finer than a row of the mesh, so nothing is sorted. Where rows are not straight a bent cut is shorter: the least separator in the
// middle third is found as a flow. Parts of at most LEAF nodes are ordered by exact minimum degree.
#include "linalg/order.h"

#include "base/vec.h"
#include "linalg/cholmod_view.h"

#include <assert.h>
#include <stdatomic.h>
#include <stdint.h>
#include <string.h>

enum {
    LEAF = 128,     // nodes of a leaf, and at most as many of its neighbours
    WHOLE = 8192,   // parts up to this size are dissected to the end by one task
    DIRECTIONS = 6, // in the plane of the two largest extents: triangular lattices have cheap cuts every thirty degrees
};

typedef struct part {
    int from, to; // of `node`; separators below it lie behind its halves
} part;

typedef struct cut {
    double direction[3], low, scale; // bin of a node: (direction . place - low) * scale
    int bin, size;                   // nodes up to this bin lie before the cut; of the separator
    int wide[2], near[2];            // bins of the middle third of the nodes, and of some of them about the cut
} cut;

typedef struct dissection {
    const int *start, *neighbour; // full adjacency
    const double (*place)[3];
    double* reach;     // per node: distance to its farthest neighbour
    int* node;         // the order in the making
    int* part_of;      // per node: `from` of its part, -1 in a separator
    int* side;         // per node of a part that is being cut: its side, or its number in a band
    int* scratch;      // per place in the order
    atomic_bool dense; // some part cannot be cut, or places are not numbers
    const part* parts; // of the loop that runs: its parts, their directions and halves
    cut* cuts;
    part (*halves)[2];
} dissection;

static inline double along(const cut* c, const double* x)
{
    return (x[0] * c->direction[0] + x[1] * c->direction[1] + x[2] * c->direction[2] - c->low) * c->scale;
}

// The unit directions to try and the bins along them; none if all nodes lie in one place.
static void directions(const dissection* d, part p, int tried, cut* cuts)
{
    double lo[3] = {INFINITY, INFINITY, INFINITY}, hi[3] = {-INFINITY, -INFINITY, -INFINITY};
    for (int k = p.from; k < p.to; ++k)
        for (int c = 0; c < 3; ++c) {
            double x = d->place[d->node[k]][c];
            lo[c] = x < lo[c] ? x : lo[c], hi[c] = x > hi[c] ? x : hi[c];
        }
    int axis[3] = {0, 1, 2}; // by extent, largest first
    for (int a = 0; a < 2; ++a)
        for (int b = 2; b > a; --b)
            if (hi[axis[b]] - lo[axis[b]] > hi[axis[b - 1]] - lo[axis[b - 1]]) {
                int swap = axis[b];
                axis[b] = axis[b - 1], axis[b - 1] = swap;
            }
    memset(cuts, 0, (size_t)tried * sizeof *cuts);
    if (!(hi[axis[0]] - lo[axis[0]] > 0 && hi[axis[0]] - lo[axis[0]] < INFINITY))
        return;
    double bins = 16 + 8 * sqrt(p.to - p.from);
    for (int k = 0; k < tried; ++k) {
        double angle = k * AX_PI / tried, length = 0, *direction = cuts[k].direction;
        direction[axis[0]] = k * 2 == tried ? 0 : cos(angle), direction[axis[1]] = k == 0 ? 0 : sin(angle);
        for (int c = 0; c < 3; ++c) {
            cuts[k].low += direction[c] * (direction[c] > 0 ? lo[c] : hi[c]);
            length += fabs(direction[c]) * (hi[c] - lo[c]);
        }
        cuts[k].scale = length > 0 ? bins / length : 0;
    }
}

// Sweeps one direction for the smallest separator.
static void sweep(const dissection* d, part p, cut* c)
{
    c->size = INT32_MAX;
    if (!(c->scale > 0))
        return;
    int count = p.to - p.from, bins = (int)(16 + 8 * sqrt(count)) + 2;
    int *held = AX_NEW0(int, 2 * bins), *change = held + bins;
    for (int k = p.from; k < p.to; ++k)
        ++held[(int)along(c, d->place[d->node[k]])];
    int first = 0, last, before = held[0];
    for (; before < 0.4 * count; before += held[++first])
        c->wide[0] += before < count / 3;
    for (last = first; last + 1 < bins && before + held[last + 1] <= 0.6 * count;)
        before += held[++last];
    for (c->wide[1] = last; c->wide[1] + 1 < bins && before + held[c->wide[1] + 1] <= 2 * (count / 3);)
        before += held[++c->wide[1]];
    for (int k = p.from; k < p.to; ++k) {
        int v = d->node[k], farthest = 0;
        double key = along(c, d->place[v]);
        if (key >= last + 1 || key + d->reach[v] * c->scale < first)
            continue; // no cut of the window lies between this node and a neighbour
        for (int e = d->start[v]; e < d->start[v + 1]; ++e) {
            int w = d->neighbour[e];
            int bin = d->part_of[w] == p.from ? (int)along(c, d->place[w]) : 0;
            farthest = bin > farthest ? bin : farthest;
        }
        int own = key < first ? first : (int)key;
        if (farthest > own) { // in the separator of cuts own .. farthest - 1
            ++change[own];
            --change[farthest];
        }
    }
    for (int bin = first, size = 0; bin <= last; ++bin) {
        size += change[bin];
        if (size < c->size)
            c->size = size, c->bin = bin;
    }
    int enough = count / 20 > c->size ? count / 20 : c->size;
    for (int end = 0; end < 2; ++end) {
        c->near[end] = c->bin + end;
        for (int within = 0; c->near[end] > c->wide[0] && c->near[end] < c->wide[1] && within < enough;)
            within += held[c->near[end] += end ? 1 : -1];
    }
    ax_free(held);
}

// A band across a part, and paths across the band that share no node: a separator within it has at least one node of each, and
// the least has no more (Menger 1927). They are found as a flow, by shortest augmenting paths (Dinic 1970). Every node is entered and
// left, states 2 k and 2 k + 1; through a node that is on a path a search goes only backwards along it.
enum { BEFORE = -1, BEHIND = -2, BETWEEN = -3, NONE = -4 };

typedef struct band {
    const dissection* d;
    int part, count;
    int* node;   // per node of the band
    int* way[2]; // the nodes before and behind it on its path, BEFORE and BEHIND at the ends of one, NONE off all
    unsigned char* rim; // bit 0: has a neighbour before the band, bit 1: behind it
    int* distance;      // per state, -1: not reached
    int* tried;         // per state: ways out that were tried
    int* queue;         // room for all states
} band;

// Number in the band of neighbour e, negative if it lies elsewhere.
static inline int in_band(const band* b, int e)
{
    int w = b->d->neighbour[e];
    return b->d->part_of[w] == b->part ? b->d->side[w] : NONE;
}

static inline void visit(const band* b, int state, int distance, int* tail)
{
    if (b->distance[state] < 0)
        b->distance[state] = distance, b->queue[(*tail)++] = state;
}

// Searches from before the band (`end` 0) or from behind it (1, everything the other way round). True if it comes across.
static bool search(const band* b, int end)
{
    int head = 0, tail = 0;
    bool across = false;
    memset(b->distance, -1, 2 * (size_t)b->count * sizeof *b->distance);
    for (int k = 0; k < b->count; ++k)
        if (b->rim[k] >> end & 1)
            visit(b, 2 * k + end, 0, &tail);
    while (head < tail) {
        int state = b->queue[head++], k = state / 2, next = b->distance[state] + 1, v = b->node[k];
        if (state % 2 == end) {
            int to = b->way[end][k] == NONE ? k : b->way[end][k];
            if (to >= 0)
                visit(b, 2 * to + !end, next, &tail);
            continue;
        }
        across = across || (b->rim[k] >> !end & 1);
        if (b->way[end][k] != NONE)
            visit(b, 2 * k + end, next, &tail);
        for (int e = b->d->start[v]; e < b->d->start[v + 1]; ++e) {
            int to = in_band(b, e);
            if (to >= 0)
                visit(b, 2 * to + end, next, &tail);
        }
    }
    return across;
}

// A state one step farther than this one, each once; -1: none, BEHIND: the path is across.
static int advance(const band* b, int state)
{
    int k = state / 2, v = b->node[k], degree = b->d->start[v + 1] - b->d->start[v];
    if (state % 2 && b->rim[k] & 2)
        return BEHIND;
    while (b->tried[state] <= (state % 2 ? degree : 0)) {
        int way = b->tried[state]++, to;
        if (state % 2 == 0)
            to = b->way[0][k] == NONE ? 2 * k + 1 : 2 * b->way[0][k] + 1;
        else if (way < degree)
            to = 2 * in_band(b, b->d->start[v] + way);
        else
            to = b->way[0][k] == NONE ? -1 : 2 * k;
        if (to >= 0 && b->distance[to] == b->distance[state] + 1)
            return to;
    }
    return -1;
}

// Adds the path of these states to the flow.
static void augment(const band* b, int count, const int* path)
{
    int from = BEFORE; // the node that was left last
    for (int k = 0; k < count; ++k) {
        int node = path[k] / 2;
        if (path[k] % 2)
            from = node;
        else if (node == from) // no path comes through here any more
            b->way[0][node] = b->way[1][node] = NONE;
        else {
            b->way[0][node] = from;
            if (from >= 0)
                b->way[1][from] = node;
        }
    }
    b->way[1][from] = BEHIND;
}

// Finds as many paths as there are, or `enough`; returns how many.
static int find_paths(const band* b, int enough)
{
    int found = 0, *path = b->queue;
    while (found < enough && search(b, 0)) {
        memset(b->tried, 0, 2 * (size_t)b->count * sizeof *b->tried);
        for (int k = 0; k < b->count; ++k) {
            if (!(b->rim[k] & 1))
                continue;
            int length = 1;
            path[0] = 2 * k;
            while (length) {
                int to = advance(b, path[length - 1]);
                if (to >= 0)
                    path[length++] = to;
                else if (to == BEHIND) {
                    augment(b, length, path);
                    ++found;
                    while (length)
                        b->distance[path[--length]] = -1; // a state is on one path a round
                } else
                    b->distance[path[--length]] = -1;
            }
        }
    }
    return found;
}

// On which side of the separator next to an end of the band, which was searched from there, a node lies.
static int side_of(const band* b, int end, int k)
{
    if (b->distance[2 * k + !end] >= 0)
        return end ? BEHIND : BEFORE;
    return b->distance[2 * k + end] >= 0 ? BETWEEN : end ? BEFORE : BEHIND;
}

// Looks for a separator smaller than the cut's in a band of bins, and gives every node of the part its side. False if there is
// none, or if the band does not part the two sides.
static bool bend(const dissection* d, part p, const cut* c, const int bins[2])
{
    band b = {.d = d, .part = p.from, .node = d->scratch + p.from};
    int before = 0, behind = 0;
    for (int k = p.from; k < p.to; ++k) {
        int v = d->node[k];
        double key = along(c, d->place[v]);
        d->side[v] = (int)key < bins[0] ? BEFORE : (int)key > bins[1] ? BEHIND : b.count;
        if (d->side[v] >= 0)
            b.node[b.count++] = v;
        before += d->side[v] == BEFORE, behind += d->side[v] == BEHIND;
        if (d->side[v] == BEFORE && key + d->reach[v] * c->scale > bins[1] + 1)
            for (int e = d->start[v]; e < d->start[v + 1]; ++e)
                if (d->part_of[d->neighbour[e]] == p.from && (int)along(c, d->place[d->neighbour[e]]) > bins[1])
                    return false;
    }
    int* room = AX_NEW(int, 8 * (size_t)b.count);
    b.way[0] = room, b.way[1] = room + b.count;
    b.distance = room + 2 * (size_t)b.count, b.tried = room + 4 * (size_t)b.count, b.queue = room + 6 * (size_t)b.count;
    b.rim = AX_NEW0(unsigned char, b.count);
    for (int k = 0; k < b.count; ++k) {
        b.way[0][k] = b.way[1][k] = NONE;
        for (int e = d->start[b.node[k]]; e < d->start[b.node[k] + 1]; ++e) {
            int to = in_band(&b, e);
            b.rim[k] |= to == BEFORE ? 1 : to == BEHIND ? 2 : 0;
        }
    }
    bool smaller = find_paths(&b, c->size) < c->size;
    int larger[2];
    for (int end = 0; end < 2 && smaller;
         ++end) { // both ends have one: that which leaves the sides more alike is taken
        int size[] = {before, behind};
        search(&b, end);
        for (int k = 0; k < b.count; ++k)
            if (side_of(&b, end, k) != BETWEEN)
                ++size[side_of(&b, end, k) == BEHIND];
        larger[end] = size[0] > size[1] ? size[0] : size[1];
    }
    int end = smaller && larger[1] < larger[0];
    if (smaller && !end)
        search(&b, end);
    for (int k = 0; k < b.count && smaller; ++k)
        d->side[b.node[k]] = side_of(&b, end, k);
    ax_free(room);
    ax_free(b.rim);
    return smaller;
}

// Sides of a straight cut.
static void cut_straight(const dissection* d, part p, const cut* c)
{
    for (int k = p.from; k < p.to; ++k) {
        int v = d->node[k];
        double key = along(c, d->place[v]);
        d->side[v] = (int)key > c->bin ? BEHIND : BEFORE;
        if (d->side[v] == BEFORE && key + d->reach[v] * c->scale > c->bin)
            for (int e = d->start[v]; e < d->start[v + 1] && d->side[v] == BEFORE; ++e) {
                int w = d->neighbour[e];
                if (d->part_of[w] == p.from && (int)along(c, d->place[w]) > c->bin)
                    d->side[v] = BETWEEN;
            }
    }
}

// Puts the nodes before the cut first, then those behind it, then the separator. False if either side would be empty.
static bool split(dissection* d, part p, const cut* c, part halves[2])
{
    if (c->size == INT32_MAX)
        return false;
    // where nothing is gained near the cut, as on straight rows, no more is looked at
    if (!bend(d, p, c, c->near) || !bend(d, p, c, c->wide))
        cut_straight(d, p, c);
    int low = p.from, high = p.from, separator = p.to;
    for (int k = p.from; k < p.to; ++k) {
        int v = d->node[k];
        if (d->side[v] == BEHIND)
            d->scratch[high++] = v;
        else if (d->side[v] == BETWEEN)
            d->scratch[--separator] = v;
        else
            d->node[low++] = v;
    }
    halves[0] = (part){p.from, low};
    halves[1] = (part){low, low + high - p.from};
    memcpy(d->node + low, d->scratch + p.from, (size_t)(high - p.from) * sizeof *d->node);
    for (int k = 0; k < p.to - separator; ++k)
        d->node[halves[1].to + k] = d->scratch[p.to - 1 - k];
    if (low == p.from || high == p.from)
        return false;
    for (int k = halves[1].from; k < halves[1].to; ++k)
        d->part_of[d->node[k]] = halves[1].from;
    for (int k = halves[1].to; k < p.to; ++k)
        d->part_of[d->node[k]] = -1;
    return true;
}

// Exact minimum degree on bit sets: the nodes of the leaf, then their neighbours outside, which are eliminated later.
typedef uint64_t bits __attribute__((vector_size(32)));
enum { WORDS = 4, SET = 64 * WORDS };

static inline int size_of(bits set)
{
    int size = 0;
    for (int k = 0; k < WORDS; ++k)
        size += __builtin_popcountll(set[k]);
    return size;
}

static void order_leaf(dissection* d, part p)
{
    int count = p.to - p.from, outside[SET - LEAF], outsiders = 0, degree[LEAF], order[LEAF];
    bits adjacent[LEAF];
    for (int k = 0; k < count; ++k)
        d->part_of[d->node[p.from + k]] = p.from + k;
    for (int k = 0; k < count; ++k) {
        int v = d->node[p.from + k];
        adjacent[k] = (bits){0};
        for (int e = d->start[v]; e < d->start[v + 1]; ++e) {
            int w = d->neighbour[e], at;
            if (d->part_of[w] >= p.from && d->part_of[w] < p.to)
                at = d->part_of[w] - p.from;
            else {
                for (at = 0; at < outsiders && outside[at] != w; ++at)
                    ;
                if (at == outsiders && outsiders < SET - LEAF)
                    outside[outsiders++] = w;
                if (at == SET - LEAF)
                    continue; // more than a set holds: degrees are then a little too small
                at += LEAF;
            }
            adjacent[k][at / 64] |= (uint64_t)1 << at % 64;
        }
        degree[k] = size_of(adjacent[k]);
    }
    for (int k = 0; k < count; ++k) {
        int least = 0;
        for (int v = 1; v < count; ++v)
            least = degree[v] < degree[least] ? v : least;
        order[k] = d->node[p.from + least];
        degree[least] = INT32_MAX;
        for (int word = 0; word < LEAF / 64; ++word)
            for (uint64_t rest = adjacent[least][word]; rest; rest &= rest - 1) {
                int u = 64 * word + __builtin_ctzll(rest);
                adjacent[u] |= adjacent[least];
                adjacent[u][least / 64] &= ~((uint64_t)1 << least % 64);
                adjacent[u][u / 64] &= ~((uint64_t)1 << u % 64);
                degree[u] = size_of(adjacent[u]);
            }
    }
    memcpy(d->node + p.from, order, (size_t)count * sizeof *order);
}

static const cut* best_of(const cut* cuts, int tried)
{
    const cut* best = cuts;
    for (int k = 1; k < tried; ++k)
        best = cuts[k].size < best->size ? cuts + k : best;
    return best;
}

static void dissect(dissection* d, part p)
{
    if (p.to - p.from <= LEAF) {
        order_leaf(d, p);
        return;
    }
    cut cuts[2];
    part halves[2];
    directions(d, p, 2, cuts);
    for (int k = 0; k < 2; ++k)
        sweep(d, p, cuts + k);
    if (!split(d, p, best_of(cuts, 2), halves)) {
        atomic_store(&d->dense, true);
        return;
    }
    dissect(d, halves[0]);
    dissect(d, halves[1]);
}

static void dissect_one(void* context, int k)
{
    dissection* d = context;
    dissect(d, d->parts[k]);
}

static void aim_one(void* context, int k)
{
    dissection* d = context;
    directions(d, d->parts[k], DIRECTIONS, d->cuts + k * DIRECTIONS);
}

static void sweep_one(void* context, int k)
{
    dissection* d = context;
    sweep(d, d->parts[k / DIRECTIONS], d->cuts + k);
}

static void split_one(void* context, int k)
{
    dissection* d = context;
    if (!split(d, d->parts[k], best_of(d->cuts + k * DIRECTIONS, DIRECTIONS), d->halves[k])) {
        memset(d->halves[k], 0, sizeof d->halves[k]);
        atomic_store(&d->dense, true);
    }
}

// All neighbours of every node.
static void list_neighbours(const ax_sparse* matrix, int* start, int* neighbour)
{
    int n = matrix->n;
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
}

static void measure_reach(void* context, int task)
{
    dissection* d = context;
    for (int v = d->parts[task].from; v < d->parts[task].to; ++v) {
        double reach = 0;
        for (int e = d->start[v]; e < d->start[v + 1]; ++e) {
            double length = ax_distance3(d->place[v], d->place[d->neighbour[e]]);
            reach = length > reach ? length : reach;
        }
        d->reach[v] = 1.000001 * reach; // bins of both ends are rounded
        if (!isfinite(d->place[v][0] + d->place[v][1] + d->place[v][2]))
            atomic_store(&d->dense, true);
    }
}

// Without places that tell its nodes apart a matrix is ordered by its graph alone.
static void order_by_degree(const ax_sparse* matrix, int* order)
{
    cholmod_common common;
    cholmod_start(&common);
    common.print = 0;
    cholmod_sparse a = ax_cholmod_view(matrix);
    int sound = cholmod_amd(&a, NULL, 0, order, &common);
    cholmod_finish(&common);
    assert(sound);
    (void)sound;
}

typedef struct part_list {
    int count, capacity;
    part* parts;
} part_list;

static void append(part_list* list, part p)
{
    if (list->count == list->capacity) {
        list->capacity = 2 * list->capacity + 64;
        list->parts = ax_realloc(list->parts, (size_t)list->capacity, sizeof *list->parts);
    }
    list->parts[list->count++] = p;
}

void ax_order_by_place(const ax_sparse* matrix, const double (*place)[3], ax_pool* pool, int* order)
{
    int n = matrix->n, *start = AX_NEW0(int, n + 2), *neighbour = AX_NEW(int, 2 * (size_t)matrix->start[n]);
    list_neighbours(matrix, start, neighbour);
    dissection d = {.start = start,
                    .neighbour = neighbour,
                    .place = place,
                    .reach = AX_NEW(double, n),
                    .node = order,
                    .part_of = AX_NEW0(int, n),
                    .side = AX_NEW(int, n),
                    .scratch = AX_NEW(int, n)};
    part_list large = {0}, whole = {0};
    for (int v = 0; v < n; ++v)
        order[v] = v;
    for (int from = 0; from < n; from += WHOLE)
        append(&whole, (part){from, from + WHOLE < n ? from + WHOLE : n});
    d.parts = whole.parts;
    ax_pool_run(pool, measure_reach, &d, whole.count);
    whole.count = 0;

    // level by level while parts are large, so that all threads have work: every direction of every part is a task
    append(n > WHOLE ? &large : &whole, (part){0, n});
    while (large.count && !d.dense) {
        d.parts = large.parts;
        d.cuts = AX_NEW(cut, large.count * DIRECTIONS);
        d.halves = ax_alloc((size_t)large.count, sizeof *d.halves);
        ax_pool_run(pool, aim_one, &d, large.count);
        ax_pool_run(pool, sweep_one, &d, large.count * DIRECTIONS);
        ax_pool_run(pool, split_one, &d, large.count);
        part_list halved = {0};
        for (int k = 0; k < 2 * large.count; ++k) {
            part half = d.halves[k / 2][k % 2];
            append(half.to - half.from > WHOLE ? &halved : &whole, half);
        }
        ax_free(large.parts);
        ax_free(d.cuts);
        ax_free(d.halves);
        large = halved;
    }
    d.parts = whole.parts;
    if (!d.dense)
        ax_pool_run(pool, dissect_one, &d, whole.count);
    if (d.dense)
        order_by_degree(matrix, order);
    void* blocks[] = {start, neighbour, d.reach, d.part_of, d.side, d.scratch, large.parts, whole.parts};
    for (size_t k = 0; k < sizeof blocks / sizeof *blocks; ++k)
        ax_free(blocks[k]);
}
