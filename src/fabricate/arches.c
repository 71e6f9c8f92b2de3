#include "fabricate/arches.h"

#include "base/vec.h"

#include <stdlib.h>
#include <string.h>

static const double least_straight = 0.64; // cosine of 50 degrees: lines of hinges meet at 60

typedef struct finding {
    const ax_design* design;
    const int (*held)[2];
    unsigned char* walked; // per hinge and way from it
    ax_arches all;         // all lines of supports
    int hinge_room, room;
} finding;

// Every hinge has four ways to another, two in each panel. -1: it does not lead from support to support, or only along the rim.
static int way(const finding* f, int hinge, int k)
{
    const ax_linkage* l = &f->design->linkage;
    int panel = f->held[hinge][k / 2], corner = 0;
    if (panel < 0 || !f->design->supports[hinge])
        return -1;
    while (l->triangles[panel][corner] != hinge)
        ++corner;
    int to = l->triangles[panel][(corner + 1 + k % 2) % 3];
    return f->design->supports[to] && !(l->on_rim[hinge] && l->on_rim[to]) ? to : -1;
}

// Where the line from `last` to `at` goes on, -1: nowhere.
static int next_of(const finding* f, int last, int at)
{
    const double(*x)[3] = (const double(*)[3])f->design->deployed;
    int best = -1;
    double straightest = least_straight;
    for (int k = 0; k < 4; ++k) {
        int to = way(f, at, k);
        double u[3], v[3];
        if (to < 0 || to == last)
            continue;
        ax_sub3(x[at], x[last], u);
        ax_sub3(x[to], x[at], v);
        double straight = ax_dot3(u, v) / (ax_norm3(u) * ax_norm3(v));
        if (straight > straightest)
            straightest = straight, best = to;
    }
    return best;
}

// Marks both directions; false if they were marked.
static bool walk(finding* f, int from, int to)
{
    bool fresh = false;
    for (int side = 0; side < 2; ++side)
        for (int k = 0; k < 4; ++k)
            if (way(f, side ? to : from, k) == (side ? from : to)) {
                unsigned char* walked = &f->walked[4 * (side ? to : from) + k];
                fresh |= !*walked;
                *walked = 1;
            }
    return fresh;
}

static void append(finding* f, int hinge)
{
    ax_arches* a = &f->all;
    if (a->hinge_count == f->hinge_room) {
        f->hinge_room = 2 * f->hinge_room + 64;
        a->hinges = ax_realloc(a->hinges, (size_t)f->hinge_room, sizeof *a->hinges);
    }
    a->hinges[a->hinge_count++] = hinge;
}

static void end_line(finding* f, bool closed)
{
    ax_arches* a = &f->all;
    if (a->count == f->room) {
        f->room = 2 * f->room + 16;
        a->start = ax_realloc(a->start, (size_t)f->room + 1, sizeof *a->start);
        a->closed = ax_realloc(a->closed, (size_t)f->room, sizeof *a->closed);
    }
    a->closed[a->count++] = closed;
    a->start[a->count] = a->hinge_count;
}

// The whole line that goes from `a` to `b`.
static void follow(finding* f, int a, int b)
{
    int from = a, to = b;
    for (int before; (before = next_of(f, to, from)) >= 0; to = from, from = before)
        if (before == b && from == a) // round
            break;
    bool closed = next_of(f, to, from) >= 0;
    append(f, from);
    for (int last = from, at = to; at >= 0 && walk(f, last, at);) {
        int next = next_of(f, last, at);
        if (!closed || at != from)
            append(f, at);
        last = at, at = next;
    }
    end_line(f, closed);
}

typedef struct line {
    int count, index;
} line;

static int longest_first(const void* a, const void* b)
{
    const line *x = a, *y = b;
    return x->count != y->count ? y->count - x->count : x->index - y->index;
}

// Lines that bring a support inside which is on none before, the longest first: where two cross, panels also join their neighbours.
static ax_arches choose(const finding* f)
{
    const ax_arches* all = &f->all;
    const ax_design* d = f->design;
    int n = d->linkage.hinge_count, singles = 0;
    line* lines = AX_NEW(line, all->count);
    unsigned char* placed = AX_NEW0(unsigned char, n);
    for (int h = 0; h < n; ++h)
        singles += d->supports[h] && !d->linkage.on_rim[h];
    ax_arches out = {.start = AX_NEW0(int, all->count + singles + 1),
                     .hinges = AX_NEW(int, all->hinge_count + singles),
                     .closed = AX_NEW0(bool, all->count + singles)};
    for (int k = 0; k < all->count; ++k)
        lines[k] = (line){all->start[k + 1] - all->start[k], k};
    qsort(lines, (size_t)all->count, sizeof *lines, longest_first);
    for (int k = 0; k < all->count; ++k) {
        const int* hinges = all->hinges + all->start[lines[k].index];
        int inside = 0;
        bool fresh = false;
        for (int i = 0; i < lines[k].count; ++i)
            if (!d->linkage.on_rim[hinges[i]])
                ++inside, fresh |= !placed[hinges[i]];
        fresh &= inside > 1;
        for (int i = 0; i < lines[k].count && fresh; ++i) {
            placed[hinges[i]] = 1;
            out.hinges[out.hinge_count++] = hinges[i];
        }
        if (fresh) {
            out.closed[out.count] = all->closed[lines[k].index];
            out.start[++out.count] = out.hinge_count;
        }
    }
    for (int h = 0; h < n; ++h)
        if (d->supports[h] && !d->linkage.on_rim[h] && !placed[h]) {
            out.hinges[out.hinge_count++] = h;
            out.start[++out.count] = out.hinge_count;
        }
    ax_free(lines);
    ax_free(placed);
    return out;
}

ax_arches ax_arches_find(const ax_design* design, const int (*held)[2])
{
    int n = design->linkage.hinge_count;
    finding f = {.design = design, .held = held, .walked = AX_NEW0(unsigned char, 4 * n), .all.start = AX_NEW0(int, 1)};
    for (int h = 0; h < n; ++h)
        for (int k = 0; k < 4; ++k)
            if (!f.walked[4 * h + k] && way(&f, h, k) >= 0)
                follow(&f, h, way(&f, h, k));
    ax_arches found = choose(&f);
    ax_arches_free(&f.all);
    ax_free(f.walked);
    return found;
}

void ax_arches_free(ax_arches* arches)
{
    ax_free(arches->start);
    ax_free(arches->hinges);
    ax_free(arches->closed);
    *arches = (ax_arches){0};
}
