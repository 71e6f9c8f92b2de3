// Where panels lie on sheets: in place if that fits, else pieces side by side, or loose panels packed row by row.
#include "fabricate/work.h"

#include "base/vec.h"

#include <stdlib.h>

static void place(ax_cut_panel* p, int sheet, const ax_motion* m, double x, double y)
{
    p->sheet = sheet;
    p->placement[0] = m->c, p->placement[1] = m->s;
    p->placement[2] = m->dx + x, p->placement[3] = m->dy + y;
}

static int add_sheet(ax_work* w, int* room, double width, double height)
{
    ax_cut_plan* plan = w->plan;
    if (plan->sheet_count == *room) {
        *room = *room ? 2 * *room : 16;
        plan->sheets = ax_realloc(plan->sheets, (size_t)*room, sizeof *plan->sheets);
    }
    plan->sheets[plan->sheet_count] = (ax_cut_sheet){.width = width, .height = height};
    return plan->sheet_count++;
}

// --- a sheet as large as need be, of whole millimetres, with the flat state as it is

static void lay_in_place(ax_work* w)
{
    ax_cut_plan* plan = w->plan;
    double lo[2] = {INFINITY, INFINITY}, hi[2] = {-INFINITY, -INFINITY}, margin = w->options->margin;
    double grow = 2.5 * plan->kerf / 2;
    for (int t = 0; t < plan->panel_count; ++t)
        ax_path_bounds(plan, &plan->paths[plan->panels[t].first], lo, hi);
    double width = fmax(hi[0] - lo[0] + 2 * grow, ax_notes_width());
    int room = 0;
    w->strip = ax_notes_strip(w, width);
    int sheet = add_sheet(w, &room, ceil(width + 2 * margin), ceil(hi[1] - lo[1] + 2 * grow + w->strip + 3 * margin));
    double x = margin + grow - lo[0], y = plan->sheets[sheet].height - margin - grow - hi[1];
    for (int t = 0; t < plan->panel_count; ++t)
        place(&plan->panels[t], sheet, &ax_stay, x, y);
    plan->in_place = true;
}

// --- shelves on stock sheets, from the top down

typedef struct stock {
    int room;             // for sheets
    double width, height; // of a sheet
    double usable[2];     // within margins and above the notes
    double top, tall;     // of the lowest shelf: its upper edge, its height
    int sheet;
} stock;

static void open_sheet(ax_work* w, stock* s)
{
    s->sheet = add_sheet(w, &s->room, s->width, s->height);
    s->top = s->usable[1], s->tall = 0;
}

// Begins a shelf of the given height, on a new sheet if there is no room below.
static void open_shelf(ax_work* w, stock* s, double tall)
{
    double top = s->top - s->tall - (s->tall > 0 ? w->options->spacing + w->plan->kerf : 0);
    if (s->sheet < 0 || top < tall)
        open_sheet(w, s);
    else
        s->top = top;
    s->tall = tall;
}

static stock stock_of(ax_work* w)
{
    double margin = w->options->margin;
    stock s = {.width = w->options->sheet[0], .height = w->options->sheet[1], .sheet = -1};
    s.usable[0] = s.width - 2 * margin;
    w->strip = ax_notes_strip(w, s.usable[0]);
    s.usable[1] = s.height - 3 * margin - w->strip;
    return s;
}

static double floor_of(const ax_work* w) // y of the usable part's lower edge
{
    return 2 * w->options->margin + w->strip;
}

static ax_status check_stock(const ax_work* w, const stock* s, ax_error* error)
{
    if (s->usable[0] >= ax_notes_width() && s->usable[1] > 0)
        return AX_OK;
    return ax_fail(
        error, AX_CANNOT_REALISE,
        "A sheet of %g x %g mm has no room for panels beside its margins of %g mm and the notes of %.0f x %.0f "
        "mm at its foot. Choose a larger sheet.",
        s->width, s->height, w->options->margin, ax_notes_width(), w->strip);
}

// The panels of each piece, in the plan's order: start[k] .. start[k + 1] of the list.
static int* list_pieces(const ax_work* w, int count, int* start)
{
    for (int k = 0; k < count + 2; ++k)
        start[k] = 0;
    for (int t = 0; t < w->plan->panel_count; ++t)
        ++start[w->plan->panels[t].piece + 2];
    for (int k = 2; k < count + 2; ++k)
        start[k] += start[k - 1];
    int* list = AX_NEW(int, w->plan->panel_count);
    for (int t = 0; t < w->plan->panel_count; ++t)
        list[start[w->plan->panels[t].piece + 1]++] = t;
    return list;
}

typedef struct sized_piece {
    int piece;
    ax_motion motion;
    double size[2];
} sized_piece;

static int by_height(const void* a, const void* b)
{
    const sized_piece *x = a, *y = b;
    return x->size[1] != y->size[1] ? (x->size[1] < y->size[1] ? 1 : -1) : x->piece - y->piece;
}

// The highest pieces first, each on the first shelf that has room for it.
static void lay_pieces(ax_work* w, stock* s, int count)
{
    typedef struct shelf_end {
        int sheet;
        double x, top, tall;
    } shelf_end;
    int *start = AX_NEW(int, count + 2), *list = list_pieces(w, count, start), shelves = 0;
    sized_piece* pieces = AX_NEW0(sized_piece, count);
    shelf_end* shelf = AX_NEW(shelf_end, count);
    for (int k = 0; k < count; ++k) {
        pieces[k].piece = k; // fits, since it was cut to
        ax_turn_to_fit(w, start[k + 1] - start[k], list + start[k], s->usable, &pieces[k].motion, pieces[k].size);
    }
    qsort(pieces, (size_t)count, sizeof *pieces, by_height);
    for (int k = 0; k < count; ++k) {
        const sized_piece* p = &pieces[k];
        int at = 0;
        while (at < shelves && (shelf[at].x + p->size[0] > s->usable[0] || p->size[1] > shelf[at].tall))
            ++at;
        if (at == shelves) {
            open_shelf(w, s, p->size[1]);
            shelf[shelves++] = (shelf_end){s->sheet, 0, s->top, s->tall};
        }
        for (int i = start[p->piece]; i < start[p->piece + 1]; ++i)
            place(&w->plan->panels[list[i]], shelf[at].sheet, &p->motion, w->options->margin + shelf[at].x,
                  floor_of(w) + shelf[at].top - p->size[1]);
        shelf[at].x += p->size[0] + w->options->spacing + w->plan->kerf;
    }
    ax_free(start);
    ax_free(list);
    ax_free(pieces);
    ax_free(shelf);
}

// --- loose panels

// A panel turned so that one edge lies along the shelf's lower edge or, flipped, its upper one: the convex hull of three discs.
typedef struct loose {
    ax_motion motion;
    double disc[3][2], radius;
    double lo[2], hi[2];
} loose;

static loose turn_panel(const ax_work* w, int t, bool flipped)
{
    ax_panel_outline o = ax_work_outline(w, t, w->plan->kerf / 2);
    const int* corner = w->linkage->triangles[t];
    loose best = {0};
    double least = INFINITY;
    for (int k = 0; k < 3; ++k) { // the edge that needs the least turning, so that names stay as upright as can be
        const double *a = w->flat[corner[k]], *b = w->flat[corner[(k + 1) % 3]];
        double angle = remainder((flipped ? AX_PI : 0) - atan2(b[1] - a[1], b[0] - a[0]), 2 * AX_PI);
        if (fabs(angle) < least)
            least = fabs(angle), best.motion = (ax_motion){cos(angle), sin(angle), 0, 0};
    }
    best.radius = o.radius;
    best.lo[0] = best.lo[1] = INFINITY, best.hi[0] = best.hi[1] = -INFINITY;
    for (int k = 0; k < 3; ++k) {
        ax_move(&best.motion, o.corner[k].disc[0], o.corner[k].disc[1], best.disc[k]);
        for (int d = 0; d < 2; ++d) {
            best.lo[d] = fmin(best.lo[d], best.disc[k][d] - o.radius);
            best.hi[d] = fmax(best.hi[d], best.disc[k][d] + o.radius);
        }
    }
    return best;
}

static void shift(loose* p, double x, double y)
{
    p->motion.dx += x, p->motion.dy += y;
    for (int k = 0; k < 3; ++k)
        p->disc[k][0] += x, p->disc[k][1] += y;
    p->lo[0] += x, p->hi[0] += x, p->lo[1] += y, p->hi[1] += y;
}

// Least (side -1) or largest (side 1) x at height y of all points within `reach` of the segment a b; false if there are none.
static bool capsule_side(const double a[2], const double b[2], double reach, double y, int side, double* x)
{
    double best = -INFINITY, length = ax_distance2(a, b);
    for (int end = 0; end < 2; ++end) {
        const double* p = end ? b : a;
        double square = reach * reach - (y - p[1]) * (y - p[1]);
        if (square >= 0)
            best = fmax(best, side * p[0] + sqrt(square));
    }
    if (a[1] != b[1]) {
        double sign = (b[1] > a[1]) == (side > 0) ? 1 : -1; // the normal that points to this side
        double nx = sign * (b[1] - a[1]) / length * reach, ny = -sign * (b[0] - a[0]) / length * reach;
        double s = (y - a[1] - ny) / (b[1] - a[1]);
        if (s >= 0 && s <= 1)
            best = fmax(best, side * (a[0] + nx + s * (b[0] - a[0])));
    }
    *x = side * best;
    return isfinite(best);
}

// How far `b` must move right so that it is `gap` from `a` and right of it: the last contact of a corner with an edge.
static double way_right(const loose* a, const loose* b, double gap)
{
    double reach = a->radius + b->radius + gap, way = -INFINITY, x;
    for (int i = 0; i < 3; ++i)
        for (int k = 0; k < 3; ++k) {
            if (capsule_side(a->disc[k], a->disc[(k + 1) % 3], reach, b->disc[i][1], 1, &x))
                way = fmax(way, x - b->disc[i][0]);
            if (capsule_side(b->disc[k], b->disc[(k + 1) % 3], reach, a->disc[i][1], -1, &x))
                way = fmax(way, a->disc[i][0] - x);
        }
    return way;
}

typedef struct in_row {
    int row, place, triangle;
} in_row;

static int by_row(const void* a, const void* b)
{
    const in_row *x = a, *y = b;
    return x->row != y->row ? (x->row > y->row) - (x->row < y->row) : (x->place > y->place) - (x->place < y->place);
}

static in_row* sort_rows(const ax_work* w)
{
    int n = w->plan->panel_count;
    in_row* order = AX_NEW(in_row, n);
    for (int t = 0; t < n; ++t) {
        const int* p = w->linkage->panels[t];
        order[t] = (in_row){p[1], 2 * p[0] + p[2], t};
    }
    qsort(order, (size_t)n, sizeof *order, by_row);
    return order;
}

static ax_status fail_too_large(const ax_work* w, int t, const loose* p, const stock* s, ax_error* error)
{
    return ax_fail(
        error, AX_CANNOT_REALISE,
        "Panel %s is %.0f x %.0f mm, more than the %.0f x %.0f mm that the sheet leaves free. Choose a larger "
        "sheet, or design with more and smaller panels.",
        w->plan->panels[t].name, p->hi[0] - p->lo[0], p->hi[1] - p->lo[1], s->usable[0], s->usable[1]);
}

// The panels of a shelf, standing on its lower edge.
typedef struct shelf {
    int count, room;
    int* triangles;
    loose* panels;
} shelf;

// Middle of the highest part of a panel.
static double top_of(const loose* p)
{
    double sum = 0;
    int count = 0;
    for (int k = 0; k < 3; ++k)
        if (p->disc[k][1] + p->radius > p->hi[1] - 1e-6)
            sum += p->disc[k][0], ++count;
    return sum / count;
}

// Names of small panels stand on the shelf's panels if they are far enough apart.
static void stand_names(ax_work* w, const shelf* f, double x, double y, double tall)
{
    double last = -INFINITY;
    for (int i = 0; i < f->count; ++i) {
        double middle = top_of(&f->panels[i]);
        if (ax_label_zone(w, f->triangles[i]) <= 0 || middle - last < ax_label_pitch())
            continue;
        double* at = w->outside[f->triangles[i]];
        at[0] = x + middle, at[1] = y + f->panels[i].hi[1], at[2] = y + tall;
        last = middle;
        --w->plan->labels_dropped, ++w->plan->labels_outside;
    }
}

static void close_shelf(ax_work* w, stock* s, shelf* f)
{
    double tall = 0, zone = 0;
    for (int i = 0; i < f->count; ++i) {
        tall = fmax(tall, f->panels[i].hi[1]);
        zone = fmax(zone, ax_label_zone(w, f->triangles[i]));
    }
    open_shelf(w, s, tall + zone);
    double x = w->options->margin, y = floor_of(w) + s->top - tall - zone;
    for (int i = 0; i < f->count; ++i)
        place(&w->plan->panels[f->triangles[i]], s->sheet, &f->panels[i].motion, x, y);
    stand_names(w, f, x, y, tall + 1.5);
    f->count = 0;
}

// Stands a panel right of those on the shelf; false if the shelf is full. Every second one is flipped, so that they lie edge to edge.
static bool stand(const ax_work* w, const stock* s, shelf* f, int t, loose* p)
{
    enum { NEAR = 4 }; // neighbours to keep clear of: a small panel may lie between two that all but touch
    *p = turn_panel(w, t, f->count % 2);
    shift(p, -p->lo[0], -p->lo[1]);
    double way = 0;
    for (int k = 1; k <= f->count && k <= NEAR; ++k)
        way = fmax(way, way_right(&f->panels[f->count - k], p, w->options->spacing));
    shift(p, way, 0);
    if (p->hi[0] > s->usable[0])
        return false;
    if (f->count == f->room) {
        f->room = f->room ? 2 * f->room : 64;
        f->triangles = ax_realloc(f->triangles, (size_t)f->room, sizeof *f->triangles);
        f->panels = ax_realloc(f->panels, (size_t)f->room, sizeof *f->panels);
    }
    f->triangles[f->count] = t;
    f->panels[f->count++] = *p;
    return true;
}

// Each row goes on where the one before ended.
static ax_status pack_rows(ax_work* w, stock* s, ax_error* error)
{
    int n = w->plan->panel_count;
    in_row* order = sort_rows(w);
    shelf f = {0};
    ax_status status = AX_OK;
    for (int i = 0; i < n && status == AX_OK; ++i) {
        int t = order[i].triangle;
        loose p;
        bool stands = stand(w, s, &f, t, &p);
        if (!stands && f.count) {
            close_shelf(w, s, &f);
            stands = stand(w, s, &f, t, &p);
        }
        if (!stands || p.hi[1] + ax_label_zone(w, t) > s->usable[1])
            status = fail_too_large(w, t, &p, s, error);
    }
    if (status == AX_OK)
        close_shelf(w, s, &f);
    ax_free(f.triangles);
    ax_free(f.panels);
    ax_free(order);
    return status;
}

// A sheet about as wide as high for panels that cannot lie in place, cut to what is used.
static ax_status pack_on_one(ax_work* w, ax_error* error)
{
    ax_cut_plan* plan = w->plan;
    double area = 0, widest = 0;
    for (int t = 0; t < plan->panel_count; ++t) {
        loose p = turn_panel(w, t, false);
        area += (p.hi[0] - p.lo[0] + w->options->spacing) * (p.hi[1] - p.lo[1] + w->options->spacing);
        widest = fmax(widest, p.hi[0] - p.lo[0]);
    }
    stock s = {.sheet = -1};
    s.usable[0] = ceil(fmax(fmax(sqrt(area / 2), 1.5 * widest), ax_notes_width()));
    s.usable[1] = 1e9;
    s.width = s.usable[0] + 2 * w->options->margin;
    w->strip = ax_notes_strip(w, s.usable[0]);
    ax_status status = pack_rows(w, &s, error);
    if (status != AX_OK)
        return status;
    double unused = floor(s.top - s.tall);
    for (int t = 0; t < plan->panel_count; ++t) {
        plan->panels[t].placement[3] -= unused;
        w->outside[t][1] -= unused, w->outside[t][2] -= unused;
    }
    plan->sheets[0].height = ceil(1e9 - unused + 3 * w->options->margin + w->strip);
    return AX_OK;
}

static void list_sheets(ax_work* w)
{
    const ax_cut_plan* plan = w->plan;
    int* start = w->sheet_start = AX_NEW0(int, plan->sheet_count + 2);
    w->sheet_panels = AX_NEW(int, plan->panel_count);
    for (int t = 0; t < plan->panel_count; ++t)
        ++start[plan->panels[t].sheet + 2];
    for (int s = 2; s < plan->sheet_count + 2; ++s)
        start[s] += start[s - 1];
    for (int t = 0; t < plan->panel_count; ++t)
        w->sheet_panels[start[plan->panels[t].sheet + 1]++] = t;
}

ax_status ax_find_pieces(ax_work* w, int* count, ax_error* error)
{
    ax_cut_plan* plan = w->plan;
    if (!plan->joint->one_piece) {
        for (int t = 0; t < plan->panel_count; ++t)
            plan->panels[t].piece = t;
        *count = plan->panel_count;
        return AX_OK;
    }
    double room[2] = {INFINITY, INFINITY};
    if (w->options->sheet[0] > 0) {
        stock s = stock_of(w);
        ax_status status = check_stock(w, &s, error);
        if (status != AX_OK)
            return status;
        room[0] = s.usable[0], room[1] = s.usable[1];
    }
    return ax_cut_pieces(w, room, count, error);
}

ax_status ax_lay_out(ax_work* w, int pieces, ax_error* error)
{
    ax_cut_plan* plan = w->plan;
    w->outside = ax_alloc((size_t)plan->panel_count, sizeof *w->outside);
    for (int t = 0; t < plan->panel_count; ++t)
        w->outside[t][0] = w->outside[t][1] = w->outside[t][2] = NAN;
    bool stocked = w->options->sheet[0] > 0, loose_panels = !plan->joint->one_piece;
    // outlines must not meet in place once they have grown by the kerf; bare triangles without kerf may touch at their corners
    bool clear = !loose_panels || (!plan->joint->two_layers && ax_flat_clearance(w, plan->kerf) >= plan->kerf - 1e-9);
    ax_status status = AX_OK;
    if (!stocked && clear)
        lay_in_place(w);
    else if (!stocked)
        status = pack_on_one(w, error);
    else {
        stock s = stock_of(w);
        status = check_stock(w, &s, error);
        int *all = AX_NEW(int, plan->panel_count), count = plan->panel_count;
        for (int t = 0; t < count; ++t)
            all[t] = t;
        ax_motion motion;
        double size[2];
        if (status != AX_OK)
            ;
        else if (clear && (loose_panels || pieces == 1) && ax_turn_to_fit(w, count, all, s.usable, &motion, size)) {
            open_sheet(w, &s);
            for (int t = 0; t < count; ++t)
                place(&plan->panels[t], 0, &motion, w->options->margin, floor_of(w) + s.usable[1] - size[1]);
            plan->in_place = true;
        } else if (loose_panels)
            status = pack_rows(w, &s, error);
        else
            lay_pieces(w, &s, pieces);
        ax_free(all);
    }
    if (status == AX_OK)
        list_sheets(w);
    return status;
}
