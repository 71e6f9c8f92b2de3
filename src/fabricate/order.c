// The order of work on a sheet: by operation, within one from each item to the nearest that is left, which is found in a grid.
#include "fabricate/work.h"

#include "base/vec.h"

#include <stdlib.h>
#include <string.h>

typedef struct grid {
    double lo[2], cell;
    int size[2];
    int *first, *next; // lists of items by cell
    int left;
} grid;

static const ax_cut_point* entry(const ax_cut_plan* plan, const ax_cut_item* item)
{
    return &plan->points[plan->paths[item->first].first];
}

static const ax_cut_point* leave(const ax_cut_plan* plan, const ax_cut_item* item)
{
    const ax_cut_path* path = &plan->paths[item->first + item->count - 1];
    return &plan->points[path->closed ? path->first : path->first + path->count - 1];
}

static int cell_along(const grid* g, int axis, double x)
{
    return (int)ax_clamp((x - g->lo[axis]) / g->cell, 0, g->size[axis] - 1);
}

static grid grid_make(const ax_cut_plan* plan, const ax_cut_item* items, int count)
{
    grid g = {.lo = {INFINITY, INFINITY}, .left = count};
    double hi[2] = {-INFINITY, -INFINITY};
    for (int i = 0; i < count; ++i) {
        const ax_cut_point* p = entry(plan, &items[i]);
        g.lo[0] = fmin(g.lo[0], p->x), hi[0] = fmax(hi[0], p->x);
        g.lo[1] = fmin(g.lo[1], p->y), hi[1] = fmax(hi[1], p->y);
    }
    double width = hi[0] - g.lo[0], height = hi[1] - g.lo[1];
    g.cell = fmax(sqrt(width * height / count), fmax(width, height) / count);
    g.cell = g.cell > 0 ? g.cell : 1;
    g.size[0] = (int)(width / g.cell) + 1, g.size[1] = (int)(height / g.cell) + 1;
    g.first = AX_NEW(int, g.size[0] * g.size[1]);
    g.next = AX_NEW(int, count);
    memset(g.first, -1, (size_t)g.size[0] * (size_t)g.size[1] * sizeof *g.first);
    for (int i = count - 1; i >= 0; --i) {
        const ax_cut_point* p = entry(plan, &items[i]);
        int* head = &g.first[cell_along(&g, 1, p->y) * g.size[0] + cell_along(&g, 0, p->x)];
        g.next[i] = *head;
        *head = i;
    }
    return g;
}

// Takes the item nearest to (x, y) out of the grid: rings of cells are searched until no nearer one can come.
static int grid_take_nearest(grid* g, const ax_cut_plan* plan, const ax_cut_item* items, double x, double y)
{
    int cx = cell_along(g, 0, x), cy = cell_along(g, 1, y), most = g->size[0] > g->size[1] ? g->size[0] : g->size[1];
    double best = INFINITY;
    int* link = NULL;
    for (int ring = 0; ring <= most && best > (ring - 1) * g->cell; ++ring)
        for (int j = cy - ring; j <= cy + ring; ++j) {
            if (j < 0 || j >= g->size[1])
                continue;
            int step = j == cy - ring || j == cy + ring || ring == 0 ? 1 : 2 * ring;
            for (int i = cx - ring; i <= cx + ring; i += step) {
                if (i < 0 || i >= g->size[0])
                    continue;
                for (int* at = &g->first[j * g->size[0] + i]; *at >= 0; at = &g->next[*at]) {
                    const ax_cut_point* p = entry(plan, &items[*at]);
                    double distance = hypot(p->x - x, p->y - y);
                    if (distance < best)
                        best = distance, link = at;
                }
            }
        }
    int found = *link;
    *link = g->next[found];
    --g->left;
    return found;
}

static int by_operation(const void* a, const void* b)
{
    const ax_cut_item *x = a, *y = b;
    return x->operation != y->operation ? (int)x->operation - (int)y->operation : x->first - y->first;
}

void ax_order_sheet(ax_cut_plan* plan, ax_cut_sheet* sheet)
{
    ax_cut_item* items = plan->items + sheet->first;
    qsort(items, (size_t)sheet->count, sizeof *items, by_operation);
    ax_cut_item* copy = ax_copy(items, (size_t)sheet->count, sizeof *items);
    double x = 0, y = 0;
    for (int first = 0, end; first < sheet->count; first = end) {
        for (end = first; end < sheet->count && items[end].operation == items[first].operation; ++end)
            ;
        if (items[first].operation == AX_NOTE)
            break;
        grid g = grid_make(plan, copy + first, end - first);
        for (int k = first; k < end; ++k) {
            items[k] = copy[first + grid_take_nearest(&g, plan, copy + first, x, y)];
            const ax_cut_point *in = entry(plan, &items[k]), *out = leave(plan, &items[k]);
            plan->travel += hypot(in->x - x, in->y - y);
            x = out->x, y = out->y;
        }
        ax_free(g.first);
        ax_free(g.next);
    }
    ax_free(copy);
}
