// Pieces of a one-piece sheet: all panels if they fit the stock, else bands between kagome lines, cut along lines of another family.
// What then still does not fit is halved until it does. Last, pieces that fit a sheet together are joined again, the smallest first, and
// a few panels that fit with none take some of their neighbour's.
//
// A kagome line runs straight along panels' edges, with panels of one kind above it and of the other below, joined at its hinges.
// There are three families of lines; the strip between two lines of one family holds pairs of panels that touch in its middle. Up
// panel (c, r) is joined to down panels (c, r), (c - 1, r) and (c, r - 1), one of which is in its strip, by family.
#include "fabricate/work.h"

#include "base/vec.h"

#include <stdlib.h>
#include <string.h>

static int strip_of(const ax_work* w, int family, int t)
{
    const int* p = w->linkage->panels[t];
    return family == 0 ? p[1] + p[2] : family == 1 ? p[0] + p[2] : p[0] + p[1];
}

static int by_place(const void* a, const void* b)
{
    const double *x = a, *y = b;
    return x[0] != y[0] ? (x[0] > y[0] ? 1 : -1) : (x[1] > y[1]) - (x[1] < y[1]);
}

// Convex hull, counter-clockwise, by Andrew's monotone chain; sorts `points`, writes to `hull` (twice as long) and returns its
// length.
static int convex_hull(int count, double (*points)[2], double (*hull)[2])
{
    qsort(points, (size_t)count, sizeof *points, by_place);
    int n = 0;
    for (int pass = 0; pass < 2; ++pass)
        for (int i = 0, low = n + 1; i < count; ++i) {
            const double* p = points[pass ? count - 1 - i : i];
            while (n > low && ax_orient2(hull[n - 2], hull[n - 1], p) <= 0)
                --n;
            memcpy(hull[n++], p, sizeof *hull);
            if (i == count - 1)
                --n; // where the other chain begins
        }
    return n;
}

// Size of the hull when turned by `angle`.
static void turned_bounds(int count, const double (*hull)[2], double angle, double lo[2], double hi[2])
{
    ax_motion turn = {cos(angle), sin(angle), 0, 0};
    lo[0] = lo[1] = INFINITY, hi[0] = hi[1] = -INFINITY;
    for (int i = 0; i < count; ++i) {
        double at[2];
        ax_move(&turn, hull[i][0], hull[i][1], at);
        for (int d = 0; d < 2; ++d)
            lo[d] = fmin(lo[d], at[d]), hi[d] = fmax(hi[d], at[d]);
    }
}

bool ax_turn_to_fit(const ax_work* w, int count, const int* panels, const double room[2], ax_motion* motion,
                    double size[2])
{
    double(*points)[2] = ax_alloc(3 * (size_t)count, sizeof *points),
    (*hull)[2] = ax_alloc(6 * (size_t)count + 2, sizeof *hull);
    for (int i = 0; i < 3 * count; ++i)
        memcpy(points[i], w->flat[w->linkage->triangles[panels[i / 3]][i % 3]], sizeof *points);
    int n = convex_hull(3 * count, points, hull);
    bool fits = false;
    double best = INFINITY, lo[2], hi[2], edge = ax_panel_reach(&w->rule, w->plan->kerf / 2);
    // as it is, if it fits; else by whole degrees, whichever leaves the lowest strip
    for (int degree = 0; degree < 180 && !(fits && degree == 1); ++degree) {
        double angle = degree * AX_PI / 180;
        turned_bounds(n, (const double(*)[2])hull, angle, lo, hi);
        double width = hi[0] - lo[0] + 2 * edge, height = hi[1] - lo[1] + 2 * edge;
        if (width > room[0] || height > room[1] || height >= best)
            continue;
        fits = true, best = height;
        *motion = (ax_motion){cos(angle), sin(angle), edge - lo[0], edge - lo[1]};
        size[0] = width, size[1] = height;
    }
    ax_free(points);
    ax_free(hull);
    return fits;
}

// Joined panels of the set get one number; returns how many sets there are. `mark` holds -1 outside the set.
static int number_parts(const ax_work* w, int count, const int* panels, int* mark, int* stack)
{
    int parts = 0;
    for (int i = 0; i < count; ++i)
        mark[panels[i]] = -2;
    for (int i = 0; i < count; ++i) {
        if (mark[panels[i]] != -2)
            continue;
        int depth = 0;
        stack[depth++] = panels[i];
        mark[panels[i]] = parts;
        while (depth) {
            int t = stack[--depth];
            for (int k = 0; k < 3; ++k) {
                const int* held = w->held[w->linkage->triangles[t][k]];
                int other = held[held[0] == t];
                if (other >= 0 && mark[other] == -2)
                    mark[other] = parts, stack[depth++] = other;
            }
        }
        ++parts;
    }
    return parts;
}

typedef struct splitting {
    ax_work* w;
    double room[2], strip;
    int pieces;
    int *mark, *stack, *spare;
} splitting;

static void take_piece(splitting* s, int count, const int* panels)
{
    for (int i = 0; i < count; ++i)
        s->w->plan->panels[panels[i]].piece = s->pieces;
    ++s->pieces;
}

static bool fits(const splitting* s, int count, const int* panels)
{
    ax_motion motion;
    double size[2];
    return ax_turn_to_fit(s->w, count, panels, s->room, &motion, size);
}

static ax_status split(splitting* s, int count, int* panels, ax_error* error);

// Cuts the set by its strips of one family: panels of a strip up to `middle` come first. Returns how many these are.
static int cut(splitting* s, int family, int middle, int count, int* panels)
{
    int first = 0, second = 0;
    for (int i = 0; i < count; ++i)
        if (strip_of(s->w, family, panels[i]) <= middle)
            panels[first++] = panels[i];
        else
            s->spare[second++] = panels[i];
    memcpy(panels + first, s->spare, (size_t)second * sizeof *panels);
    return first;
}

enum { SMALL = 4 }; // pieces of fewer panels are hard to handle

// Moves parts of `panels` too small to be handled, a few panels in the corner of a cut, to its end; returns how many stay.
static int put_small_last(splitting* s, int count, int* panels)
{
    int parts = number_parts(s->w, count, panels, s->mark, s->stack), stay = 0, go = 0;
    int* size = AX_NEW0(int, parts);
    for (int i = 0; i < count; ++i)
        ++size[s->mark[panels[i]]];
    for (int i = 0; i < count; ++i) {
        bool small = parts > 1 && size[s->mark[panels[i]]] < SMALL;
        s->mark[panels[i]] = -1;
        if (small)
            s->spare[go++] = panels[i];
        else
            panels[stay++] = panels[i];
    }
    memcpy(panels + stay, s->spare, (size_t)go * sizeof *panels);
    ax_free(size);
    return stay;
}

static ax_status split_parts(splitting* s, int parts, int count, int* panels, ax_error* error)
{
    ax_status status = AX_OK;
    int* part = AX_NEW(int, count);
    for (int i = 0; i < count; ++i)
        part[i] = s->mark[panels[i]];
    int* start = AX_NEW0(int, parts + 2);
    for (int i = 0; i < count; ++i)
        ++start[part[i] + 2];
    for (int k = 2; k < parts + 2; ++k)
        start[k] += start[k - 1];
    int* sorted = AX_NEW(int, count);
    for (int i = 0; i < count; ++i)
        sorted[start[part[i] + 1]++] = panels[i];
    for (int i = 0; i < count; ++i)
        s->mark[panels[i]] = -1;
    for (int k = 0; k < parts && status == AX_OK; ++k)
        status = split(s, start[k + 1] - start[k], sorted + start[k], error);
    ax_free(part);
    ax_free(start);
    ax_free(sorted);
    return status;
}

// Distance between the middles of neighbouring strips: 1.5 times that of the middles of joined panels.
static double strip_width(const ax_work* w)
{
    double sum = 0;
    int count = 0;
    for (int h = 0; h < w->linkage->hinge_count; ++h) {
        if (w->held[h][1] < 0)
            continue;
        double middle[2][2] = {{0}};
        for (int side = 0; side < 2; ++side)
            for (int k = 0; k < 3; ++k)
                for (int d = 0; d < 2; ++d)
                    middle[side][d] += w->flat[w->linkage->triangles[w->held[h][side]][k]][d] / 3;
        sum += ax_distance2(middle[0], middle[1]);
        ++count;
    }
    return 1.5 * sum / count;
}

// Cuts the set across its longest way into parts of which whole numbers fill sheets, e.g. one third and two thirds; returns how
// many panels come first.
static int halve(splitting* s, int count, int* panels)
{
    int family = 0, lowest = 0, strips = 0;
    for (int f = 0; f < 3; ++f) {
        int lo = strip_of(s->w, f, panels[0]), hi = lo;
        for (int i = 1; i < count; ++i) {
            int strip = strip_of(s->w, f, panels[i]);
            lo = strip < lo ? strip : lo, hi = strip > hi ? strip : hi;
        }
        if (hi - lo + 1 > strips)
            family = f, strips = hi - lo + 1, lowest = lo;
    }
    double length = strips * s->strip, longer = fmax(s->room[0], s->room[1]), shorter = fmin(s->room[0], s->room[1]);
    double sheets = fmax(2, ceil(length > longer ? length / longer : length / shorter));
    int low = (int)fmax(1, fmin(strips - 1, round(strips * floor(sheets / 2) / sheets)));
    int first = cut(s, family, lowest + low - 1, count, panels);
    int kept = put_small_last(s, first, panels);
    first = kept > 0 ? kept : first;
    kept = put_small_last(s, count - first, panels + first);
    if (kept == 0 || kept == count - first)
        return first;
    int small = count - first - kept;
    memcpy(s->spare, panels + first + kept, (size_t)small * sizeof *panels);
    memmove(panels + first + small, panels + first, (size_t)kept * sizeof *panels);
    memcpy(panels + first, s->spare, (size_t)small * sizeof *panels);
    return first + small;
}

static ax_status split(splitting* s, int count, int* panels, ax_error* error)
{
    int parts = number_parts(s->w, count, panels, s->mark, s->stack);
    if (parts > 1)
        return split_parts(s, parts, count, panels, error);
    for (int i = 0; i < count; ++i)
        s->mark[panels[i]] = -1;
    if (fits(s, count, panels)) {
        take_piece(s, count, panels);
        return AX_OK;
    }
    if (count == 1)
        return ax_fail(error, AX_CANNOT_REALISE,
                       "Panel %s is larger than what the sheet leaves free, %.0f x %.0f mm. Choose a larger sheet, or "
                       "design with more and smaller panels.",
                       s->w->plan->panels[panels[0]].name, s->room[0], s->room[1]);
    int first = halve(s, count, panels);
    ax_status status = split(s, first, panels, error);
    return status == AX_OK ? split(s, count - first, panels + first, error) : status;
}

// Takes from a band, strip by strip of another family, as many panels as fit a sheet, again and again.
static ax_status peel(splitting* s, int family, int count, int* panels, ax_error* error)
{
    while (count && !fits(s, count, panels)) {
        int lo = strip_of(s->w, family, panels[0]), hi = lo, best = 0;
        for (int i = 1; i < count; ++i) {
            int strip = strip_of(s->w, family, panels[i]);
            lo = strip < lo ? strip : lo, hi = strip > hi ? strip : hi;
        }
        for (int from = lo; from < hi;) { // the largest number of strips that fits, by halving
            int middle = from + (hi - from) / 2, first = cut(s, family, middle, count, panels);
            if (fits(s, first, panels))
                best = first, from = middle + 1;
            else
                hi = middle;
        }
        if (best == 0)
            break;
        cut(s, family, hi - 1, count, panels);
        int kept = put_small_last(s, best, panels);
        best = kept > 0 ? kept : best;
        ax_status status = split(s, best, panels, error);
        if (status != AX_OK)
            return status;
        panels += best, count -= best;
    }
    return count ? split(s, count, panels, error) : AX_OK;
}

// --- joining pieces again

typedef struct joining {
    splitting* s;
    int *head, *next, *count; // panels of each piece, as a list
    int* set;                 // room for all panels
    int *shared, *near;       // hinges that each piece shares with the one at hand; pieces that share any
} joining;

static int piece_of(const joining* j, int panel)
{
    return j->s->w->plan->panels[panel].piece;
}

// The panel on the other side of corner k, -1: none.
static int across(const splitting* s, int panel, int k)
{
    const int* held = s->w->held[s->w->linkage->triangles[panel][k]];
    return held[held[0] == panel];
}

static void put_in(joining* j, int panel, int piece)
{
    j->s->w->plan->panels[panel].piece = piece;
    j->next[panel] = j->head[piece];
    j->head[piece] = panel;
    ++j->count[piece];
}

static int list_piece(const joining* j, int piece, int* set)
{
    int count = 0;
    for (int t = j->head[piece]; t >= 0; t = j->next[t])
        set[count++] = t;
    return count;
}

// Pieces that share hinges with this one, those that share most first; returns how many.
static int find_neighbours(joining* j, int piece)
{
    int count = 0;
    for (int t = j->head[piece]; t >= 0; t = j->next[t])
        for (int k = 0; k < 3; ++k) {
            int other = across(j->s, t, k);
            if (other >= 0 && piece_of(j, other) != piece && j->shared[piece_of(j, other)]++ == 0)
                j->near[count++] = piece_of(j, other);
        }
    for (int i = 1; i < count; ++i) // they are few
        for (int k = i; k > 0 && j->shared[j->near[k]] > j->shared[j->near[k - 1]]; --k) {
            int other = j->near[k];
            j->near[k] = j->near[k - 1], j->near[k - 1] = other;
        }
    for (int i = 0; i < count; ++i)
        j->shared[j->near[i]] = 0;
    return count;
}

static bool join(joining* j, int piece, int to)
{
    int count = list_piece(j, piece, j->set);
    count += list_piece(j, to, j->set + count);
    if (!fits(j->s, count, j->set))
        return false;
    for (int t = j->head[piece], next; t >= 0; t = next) {
        next = j->next[t];
        put_in(j, t, to);
    }
    j->head[piece] = -1, j->count[piece] = 0;
    return true;
}

// Whether a panel can go from its piece to another: that one fits a sheet with it, and its own stays in one.
static bool can_go(const joining* j, int panel, int to)
{
    int count = list_piece(j, to, j->set), rest = 0;
    j->set[count++] = panel;
    if (!fits(j->s, count, j->set))
        return false;
    for (int t = j->head[piece_of(j, panel)]; t >= 0; t = j->next[t])
        if (t != panel)
            j->set[rest++] = t;
    bool whole = number_parts(j->s->w, rest, j->set, j->s->mark, j->s->stack) == 1;
    for (int i = 0; i < rest; ++i)
        j->s->mark[j->set[i]] = -1;
    return whole;
}

// A panel of `from` that can go to the small piece beside it, -1: none.
static int find_panel(const joining* j, int piece, int from)
{
    for (int t = j->head[piece]; t >= 0; t = j->next[t])
        for (int k = 0; k < 3; ++k) {
            int panel = across(j->s, t, k);
            if (panel >= 0 && piece_of(j, panel) == from && can_go(j, panel, piece))
                return panel;
        }
    return -1;
}

static void take_some(joining* j, int piece, int from)
{
    for (int panel; j->count[piece] < SMALL && j->count[from] > SMALL && (panel = find_panel(j, piece, from)) >= 0;) {
        int* link = &j->head[from];
        while (*link != panel)
            link = &j->next[*link];
        *link = j->next[panel];
        --j->count[from];
        put_in(j, panel, piece);
    }
}

typedef struct sized {
    int count, piece;
} sized;

static int smallest_first(const void* a, const void* b)
{
    const sized *x = a, *y = b;
    return x->count != y->count ? x->count - y->count : x->piece - y->piece;
}

static bool join_all(joining* j, sized* order)
{
    bool any = false;
    for (int p = 0; p < j->s->pieces; ++p)
        order[p] = (sized){j->count[p], p};
    qsort(order, (size_t)j->s->pieces, sizeof *order, smallest_first);
    for (int i = 0; i < j->s->pieces; ++i) {
        bool joined = j->count[order[i].piece] == 0;
        for (int k = 0, near = joined ? 0 : find_neighbours(j, order[i].piece); k < near && !joined; ++k)
            any |= joined = join(j, order[i].piece, j->near[k]);
    }
    return any;
}

static void join_pieces(splitting* s)
{
    int n = s->w->linkage->triangle_count, left = 0;
    joining j = {.s = s,
                 .head = AX_NEW(int, s->pieces),
                 .next = AX_NEW(int, n),
                 .count = AX_NEW0(int, s->pieces),
                 .set = AX_NEW(int, n),
                 .shared = AX_NEW0(int, s->pieces),
                 .near = AX_NEW(int, s->pieces)};
    sized* order = AX_NEW(sized, s->pieces);
    memset(j.head, -1, (size_t)s->pieces * sizeof *j.head);
    for (int t = 0; t < n; ++t)
        put_in(&j, t, piece_of(&j, t));
    while (join_all(&j, order))
        continue;
    for (int p = 0; p < s->pieces; ++p)
        if (j.count[p] > 0 && j.count[p] < SMALL)
            for (int k = 0, near = find_neighbours(&j, p); k < near; ++k)
                take_some(&j, p, j.near[k]);
    for (int p = 0; p < s->pieces; ++p)
        if (j.count[p] > 0) {
            for (int t = j.head[p]; t >= 0; t = j.next[t])
                s->w->plan->panels[t].piece = left;
            ++left;
        }
    s->pieces = left;
    ax_free(j.head);
    ax_free(j.next);
    ax_free(j.count);
    ax_free(j.set);
    ax_free(j.shared);
    ax_free(j.near);
    ax_free(order);
}

// Cuts all panels into bands of equally many strips, and these into pieces.
static ax_status cut_bands(splitting* s, int family, int bands, int count, int* panels, ax_error* error)
{
    int lo = strip_of(s->w, family, panels[0]), hi = lo;
    for (int i = 1; i < count; ++i) {
        int strip = strip_of(s->w, family, panels[i]);
        lo = strip < lo ? strip : lo, hi = strip > hi ? strip : hi;
    }
    s->pieces = 0;
    ax_status status = AX_OK;
    for (int band = 1; band <= bands && status == AX_OK; ++band) {
        int first = cut(s, family, lo + band * (hi - lo + 1) / bands - 1, count, panels);
        if (band < bands) {
            int kept = put_small_last(s, first, panels);
            first = kept > 0 ? kept : first;
        }
        status = first ? peel(s, (family + 1) % 3, first, panels, error) : AX_OK;
        panels += first, count -= first;
    }
    if (status == AX_OK)
        join_pieces(s);
    return status;
}

static int strip_count(const ax_work* w, int family)
{
    int lo = strip_of(w, family, 0), hi = lo;
    for (int t = 1; t < w->linkage->triangle_count; ++t) {
        int strip = strip_of(w, family, t);
        lo = strip < lo ? strip : lo, hi = strip > hi ? strip : hi;
    }
    return hi - lo + 1;
}

// Bands a little under the sheet's shorter side leave the longer one to the pieces; of a few ways the one with the fewest pieces is
// taken.
static ax_status find_cuts(splitting* s, int count, int* panels, ax_error* error)
{
    double shorter = fmin(s->room[0], s->room[1]);
    int best_family = 0, best_bands = 0, fewest = 0;
    for (int family = 0; family < 3; ++family) {
        int strips = strip_count(s->w, family), most = (int)fmax(1, floor(shorter / s->strip));
        for (int wide = most; wide > 0 && wide > most - 2; --wide) {
            int bands = (strips + wide - 1) / wide;
            ax_status status = cut_bands(s, family, bands, count, panels, error);
            if (status != AX_OK)
                return status;
            if (!best_bands || s->pieces < fewest)
                best_family = family, best_bands = bands, fewest = s->pieces;
        }
    }
    return cut_bands(s, best_family, best_bands, count, panels, error);
}

ax_status ax_cut_pieces(ax_work* w, const double room[2], int* count, ax_error* error)
{
    int n = w->linkage->triangle_count;
    splitting s = {.w = w, .room = {room[0], room[1]}, .strip = strip_width(w)};
    s.mark = AX_NEW(int, n), s.stack = AX_NEW(int, n), s.spare = AX_NEW(int, n);
    int* panels = AX_NEW(int, n);
    for (int t = 0; t < n; ++t)
        panels[t] = t, s.mark[t] = -1;
    ax_status status = AX_OK;
    if (fits(&s, n, panels))
        take_piece(&s, n, panels);
    else
        status = find_cuts(&s, n, panels, error);
    *count = s.pieces;
    ax_free(s.mark);
    ax_free(s.stack);
    ax_free(s.spare);
    ax_free(panels);
    return status;
}
