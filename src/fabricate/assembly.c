// The order of joining: rows of the lattice, or pieces, each joined to what is there already.
#include "ax/assembly.h"

#include "base/vec.h"
#include "linkage/lattice.h"

#include <stdlib.h>

void ax_assembly_free(ax_assembly* assembly)
{
    if (!assembly)
        return;
    ax_free(assembly->order);
    ax_free(assembly->step_of);
    ax_free(assembly->steps);
    *assembly = (ax_assembly){0};
}

// What is put on as a whole: panels list[start .. start + count) in order of their places.
typedef struct unit {
    int start, count, row;
    double left; // how far along the rows it begins
    bool placed, in_reach;
} unit;

typedef struct work {
    const ax_design* design;
    const ax_cut_plan* plan;
    int (*held)[2]; // triangles of each hinge, -1 on the rim
    int unit_count;
    unit* units;
    int *unit_of, *list;
    bool* joined; // per panel
} work;

// The panel beyond a corner, -1 on the rim.
static int neighbour(const work* w, int triangle, int corner)
{
    const int* pair = w->held[w->design->linkage.triangles[triangle][corner]];
    return pair[0] == triangle ? pair[1] : pair[0];
}

// Panels beside each other in a row that hang on a hinge make a unit; of a plan by pieces, the piece does.
static void find_units(work* w, bool by_pieces)
{
    int n = w->plan->panel_count, count = 0;
    int* stack = AX_NEW(int, n);
    for (int t = 0; t < n; ++t)
        w->unit_of[t] = by_pieces ? w->plan->panels[t].piece : -1;
    for (int t = 0; t < n; ++t) {
        if (by_pieces && w->unit_of[t] >= count)
            count = w->unit_of[t] + 1;
        if (w->unit_of[t] >= 0)
            continue;
        int top = 0;
        stack[top++] = t;
        w->unit_of[t] = count;
        while (top) {
            int a = stack[--top];
            for (int k = 0; k < 3; ++k) {
                int b = neighbour(w, a, k);
                if (b >= 0 && w->unit_of[b] < 0 && w->plan->panels[b].row == w->plan->panels[a].row) {
                    w->unit_of[b] = count;
                    stack[top++] = b;
                }
            }
        }
        ++count;
    }
    ax_free(stack);
    w->unit_count = count;
}

typedef struct placed_panel {
    int unit, row, place, panel;
} placed_panel;

static int by_place(const void* a, const void* b)
{
    const placed_panel *x = a, *y = b;
    if (x->unit != y->unit)
        return x->unit - y->unit;
    if (x->row != y->row)
        return x->row - y->row;
    return x->place != y->place ? (x->place > y->place) - (x->place < y->place) : x->panel - y->panel;
}

static double centre_along(const work* w, int t, const double along[2])
{
    const int* h = w->design->linkage.triangles[t];
    double sum = 0;
    for (int k = 0; k < 3; ++k)
        sum += along[0] * w->design->flat[h[k]][0] + along[1] * w->design->flat[h[k]][1];
    return sum / 3;
}

static void list_units(work* w, const double along[2])
{
    int n = w->plan->panel_count;
    placed_panel* sorted = AX_NEW(placed_panel, n);
    for (int t = 0; t < n; ++t) {
        const int* p = w->design->linkage.panels[t];
        sorted[t] = (placed_panel){w->unit_of[t], w->plan->panels[t].row, 2 * p[0] + p[2], t};
    }
    qsort(sorted, (size_t)n, sizeof *sorted, by_place);
    w->units = AX_NEW0(unit, w->unit_count);
    for (int i = 0; i < n; ++i) {
        unit* u = &w->units[sorted[i].unit];
        double at = centre_along(w, sorted[i].panel, along);
        w->list[i] = sorted[i].panel;
        if (u->count++ == 0)
            u->start = i, u->row = sorted[i].row, u->left = at;
        u->left = fmin(u->left, at);
    }
    ax_free(sorted);
}

// Mean of the steps from each up panel to the next of its row: rows may bend.
static void find_direction(const work* w, double along[2])
{
    const ax_linkage* l = &w->design->linkage;
    double sum[2] = {0, 0};
    for (int t = 0; t < l->triangle_count; ++t)
        for (int k = 0; k < 3; ++k) {
            int b = neighbour(w, t, k);
            if (b < 0 || l->panels[b][1] != l->panels[t][1] ||
                2 * l->panels[b][0] + l->panels[b][2] != 2 * l->panels[t][0] + l->panels[t][2] + 1)
                continue;
            for (int c = 0; c < 3; ++c)
                for (int d = 0; d < 2; ++d)
                    sum[d] += w->design->flat[l->triangles[b][c]][d] - w->design->flat[l->triangles[t][c]][d];
        }
    double length = hypot(sum[0], sum[1]);
    along[0] = length > 0 ? sum[0] / length : 1;
    along[1] = length > 0 ? sum[1] / length : 0;
}

// The unit within reach whose row comes first, counted in the direction of work; of the same row the left one.
static int choose_next(const work* w, int direction)
{
    int best = -1;
    for (int u = 0; u < w->unit_count; ++u) {
        const unit *a = &w->units[u], *b = best < 0 ? NULL : &w->units[best];
        if (!a->placed && a->in_reach &&
            (!b || direction * a->row < direction * b->row || (a->row == b->row && a->left < b->left)))
            best = u;
    }
    return best;
}

static bool touches(const work* w, int t)
{
    for (int k = 0; k < 3; ++k) {
        int b = neighbour(w, t, k);
        if (b >= 0 && w->joined[b])
            return true;
    }
    return false;
}

// How many panels from one end of the unit one must go to meet one that touches what is there.
static int reach_from(const work* w, const unit* u, bool right)
{
    for (int i = 0; i < u->count; ++i)
        if (touches(w, w->list[right ? u->start + u->count - 1 - i : u->start + i]))
            return i;
    return 0;
}

// There and back along the row, taking every panel that meets what is there, until all are taken.
static void join_row(work* w, const unit* u, bool from_right, bool first, int* order)
{
    int taken = 0;
    for (bool right = from_right; taken < u->count; right = !right)
        for (int i = 0; i < u->count; ++i) {
            int t = w->list[right ? u->start + u->count - 1 - i : u->start + i];
            if (!w->joined[t] && (touches(w, t) || (first && taken == 0))) {
                w->joined[t] = true;
                order[taken++] = t;
            }
        }
}

static void count_hinges(const work* w, const unit* u, ax_assembly_step* step, const int* step_of, int this_step)
{
    for (int i = u->start; i < u->start + u->count; ++i)
        for (int k = 0; k < 3; ++k) {
            int t = w->list[i], b = neighbour(w, t, k);
            if (b < 0)
                continue;
            if (w->unit_of[b] == w->unit_of[t])
                step->hinges_within += t < b && step->piece < 0;
            else
                step->hinges_before += step_of[b] >= 0 && step_of[b] < this_step;
        }
}

ax_assembly ax_assembly_make(const ax_design* design, const ax_cut_plan* plan)
{
    int n = plan->panel_count, placed = 0;
    ax_assembly a = {
        .panel_count = n, .by_pieces = plan->joint->one_piece, .order = AX_NEW(int, n), .step_of = AX_NEW(int, n)};
    work w = {.design = design,
              .plan = plan,
              .held = ax_linkage_hinge_triangles(&design->linkage),
              .unit_of = AX_NEW(int, n),
              .list = AX_NEW(int, n),
              .joined = AX_NEW0(bool, n)};
    find_units(&w, a.by_pieces);
    find_direction(&w, a.along);
    list_units(&w, a.along);
    a.steps = AX_NEW0(ax_assembly_step, w.unit_count);
    int low = 0, high = 0;
    for (int u = 0; u < w.unit_count; ++u) {
        const unit *x = &w.units[u], *l = &w.units[low], *h = &w.units[high];
        low = x->row < l->row || (x->row == l->row && x->count > l->count) ? u : low;
        high = x->row > h->row || (x->row == h->row && x->count > h->count) ? u : high;
    }
    // pieces are numbered from below as a rule, and are as large at either end
    int direction = a.by_pieces || w.units[low].count >= w.units[high].count ? 1 : -1;
    for (int t = 0; t < n; ++t)
        a.step_of[t] = -1;
    for (int u = direction > 0 ? low : high; u >= 0; u = choose_next(&w, direction)) {
        unit* at = &w.units[u];
        ax_assembly_step* step = &a.steps[a.step_count];
        *step = (ax_assembly_step){.first = placed, .count = at->count, .row = at->row, .piece = a.by_pieces ? u : -1};
        step->from_right = placed && reach_from(&w, at, true) < reach_from(&w, at, false);
        at->placed = true;
        if (a.by_pieces)
            for (int i = 0; i < at->count; ++i)
                a.order[placed + i] = w.list[at->start + i];
        else
            join_row(&w, at, step->from_right, placed == 0, a.order + placed);
        for (int i = at->start; i < at->start + at->count; ++i) {
            w.joined[w.list[i]] = true;
            a.step_of[w.list[i]] = a.step_count;
            for (int k = 0; k < 3; ++k) {
                int b = neighbour(&w, w.list[i], k);
                if (b >= 0)
                    w.units[w.unit_of[b]].in_reach = true;
            }
        }
        count_hinges(&w, at, step, a.step_of, a.step_count++);
        placed += at->count;
    }
    ax_free(w.held);
    ax_free(w.unit_of);
    ax_free(w.list);
    ax_free(w.joined);
    ax_free(w.units);
    return a;
}
