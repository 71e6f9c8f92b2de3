#include "operator/selection.h"

#include "base/vec.h"
#include "linkage/lattice.h"

#include <math.h>
#include <string.h>

ax_hinges ax_hinges_make(const ax_linkage* linkage)
{
    return (ax_hinges){.hinges = AX_NEW(int, linkage->hinge_count), .in = AX_NEW0(unsigned char, linkage->hinge_count)};
}

void ax_hinges_free(ax_hinges* set)
{
    ax_free(set->hinges);
    ax_free(set->in);
    *set = (ax_hinges){0};
}

void ax_hinges_add(ax_hinges* set, int hinge)
{
    if (!set->in[hinge])
        set->hinges[set->count++] = hinge;
    set->in[hinge] = 1;
}

void ax_sheet_middle(const ax_form_view* view, double middle[2])
{
    double lo[2] = {INFINITY, INFINITY}, hi[2] = {-INFINITY, -INFINITY};
    for (int h = 0; h < view->linkage->hinge_count; ++h)
        for (int d = 0; d < 2; ++d) {
            lo[d] = fmin(lo[d], view->sheet[h][d]);
            hi[d] = fmax(hi[d], view->sheet[h][d]);
        }
    for (int d = 0; d < 2; ++d)
        middle[d] = (lo[d] + hi[d]) / 2;
}

double ax_angle_about(const double middle[2], const double x[2])
{
    double angle = atan2(x[1] - middle[1], x[0] - middle[0]) * 180 / AX_PI;
    return angle < 0 ? angle + 360 : angle;
}

void ax_select_rim(const ax_form_view* view, ax_hinges* set)
{
    int *order = AX_NEW(int, view->linkage->hinge_count), count = ax_linkage_rim(view->linkage, order), first = 0;
    double middle[2], smallest = INFINITY, area = 0;
    ax_sheet_middle(view, middle);
    for (int k = 0; k < count; ++k) {
        double angle = ax_angle_about(middle, view->sheet[order[k]]);
        if (angle < smallest)
            smallest = angle, first = k;
        area += ax_orient2(middle, view->sheet[order[k]], view->sheet[order[(k + 1) % count]]);
    }
    for (int k = 0; k < count; ++k)
        ax_hinges_add(set, order[(first + (area > 0 ? k : count - k)) % count]);
    ax_free(order);
}

// The hinge that follows on the straight line which comes into `hinge` from a panel, in which it came from the next corner (or the
// previous); -1 at the rim. Panels meet at a hinge point to point, so the line goes on to the corner of the same kind.
static int step_on(const ax_linkage* linkage, const int (*held)[2], int hinge, bool from_next, int* panel)
{
    int other = held[hinge][0] == *panel ? held[hinge][1] : held[hinge][0];
    if (other < 0)
        return -1;
    *panel = other;
    const int* corner = linkage->triangles[other];
    int k = corner[0] == hinge ? 0 : corner[1] == hinge ? 1 : 2;
    return corner[(k + (from_next ? 1 : 2)) % 3];
}

// Follows the line that leaves hinge `a` in `panel` by its next (or previous) corner; `out` has room for all hinges. The count.
static int follow(const ax_linkage* linkage, const int (*held)[2], int a, int panel, bool next, int* out)
{
    const int* corner = linkage->triangles[panel];
    int k = corner[0] == a ? 0 : corner[1] == a ? 1 : 2, count = 0;
    int at = corner[(k + (next ? 1 : 2)) % 3];
    bool from_next = !next; // seen from the corner arrived at, `a` is the one before it
    while (at >= 0 && at != a && count < linkage->hinge_count) {
        out[count++] = at;
        int to = step_on(linkage, held, at, from_next, &panel);
        from_next = !from_next;
        at = to;
    }
    return count;
}

bool ax_select_line(const ax_linkage* linkage, int a, int b, ax_hinges* set)
{
    int(*held)[2] = ax_linkage_hinge_triangles(linkage), *ways[2], counts[2];
    bool found = false;
    for (int s = 0; s < 2; ++s)
        ways[s] = AX_NEW(int, linkage->hinge_count);
    for (int next = 0; next < 2 && !found; ++next) {
        for (int s = 0; s < 2; ++s)
            counts[s] = held[a][s] >= 0 ? follow(linkage, (const int(*)[2])held, a, held[a][s], next, ways[s]) : 0;
        for (int s = 0; s < 2; ++s)
            for (int k = 0; k < counts[s]; ++k)
                found |= ways[s][k] == b;
    }
    for (int k = counts[0] - 1; found && k >= 0; --k)
        ax_hinges_add(set, ways[0][k]);
    if (found)
        ax_hinges_add(set, a);
    for (int k = 0; found && k < counts[1]; ++k)
        ax_hinges_add(set, ways[1][k]);
    for (int s = 0; s < 2; ++s)
        ax_free(ways[s]);
    ax_free(held);
    return found;
}

// Edges on the sheet are all equally long, so breadth first would do; but many ways are then the shortest, and the one wanted is that
// along the straight line. Label correcting in order of hinges converges in few sweeps and is free of ties by address.
void ax_select_curve(const ax_form_view* view, int a, int b, ax_hinges* set)
{
    const ax_linkage* l = view->linkage;
    int n = l->hinge_count, *from = AX_NEW(int, n), *queue = AX_NEW(int, n), head = 0, waiting = 0;
    double* cost = AX_NEW(double, n);
    unsigned char* queued = AX_NEW0(unsigned char, n);
    int(*held)[2] = ax_linkage_hinge_triangles(l);
    for (int h = 0; h < n; ++h)
        cost[h] = INFINITY, from[h] = -1;
    cost[b] = 0;
    queue[waiting++] = b;
    while (waiting) { // backwards from b, so that the way reads from a
        int h = queue[head];
        head = (head + 1) % n, --waiting;
        queued[h] = 0;
        for (int s = 0; s < 2; ++s)
            for (int k = 0; k < 3 && held[h][s] >= 0; ++k) {
                int to = l->triangles[held[h][s]][k];
                double aside = ax_segment_distance2(view->sheet[to], view->sheet[a], view->sheet[b]);
                double c = cost[h] + ax_distance2(view->sheet[h], view->sheet[to]) * (1 + 0.1 * aside / view->spacing);
                if (to == h || !(c < cost[to] - 1e-9 * view->spacing))
                    continue;
                cost[to] = c;
                from[to] = h;
                if (!queued[to])
                    queue[(head + waiting++) % n] = to;
                queued[to] = 1;
            }
    }
    for (int h = a; h >= 0; h = from[h])
        ax_hinges_add(set, h);
    ax_free(from);
    ax_free(queue);
    ax_free(cost);
    ax_free(queued);
    ax_free(held);
}

void ax_select_box(const ax_form_view* view, const double lo[2], const double hi[2], ax_hinges* set)
{
    for (int h = 0; h < view->linkage->hinge_count; ++h) {
        const double* x = view->sheet[h];
        if (x[0] >= lo[0] && x[0] <= hi[0] && x[1] >= lo[1] && x[1] <= hi[1])
            ax_hinges_add(set, h);
    }
}

void ax_select_near(const ax_form_view* view, int count, const double (*points)[2], bool closed, double distance,
                    ax_hinges* set)
{
    for (int h = 0; h < view->linkage->hinge_count; ++h)
        for (int k = 0; k < count; ++k) {
            bool last = k + 1 == count;
            const double* to = points[last ? (closed ? 0 : k) : k + 1];
            if (ax_segment_distance2(view->sheet[h], points[k], to) <= distance) {
                ax_hinges_add(set, h);
                break;
            }
        }
}

void ax_select_nearest(const ax_form_view* view, const ax_hinges* among, const double at[2], double distance,
                       ax_hinges* set)
{
    static const double as_near = 1e-6; // spacings: on the axes of symmetric sheets there are two
    double nearest = INFINITY;
    for (int k = 0; k < among->count; ++k)
        nearest = fmin(nearest, ax_distance2(view->sheet[among->hinges[k]], at));
    for (int k = 0; k < among->count; ++k)
        if (ax_distance2(view->sheet[among->hinges[k]], at) <= fmax(distance, nearest + as_near * view->spacing))
            ax_hinges_add(set, among->hinges[k]);
}
