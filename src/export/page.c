#include "export/page.h"

#include "base/pool.h"
#include "base/vec.h"
#include "export/pdf.h"
#include "fabricate/plan.h"
#include "fabricate/stroke_font.h"

#include <math.h>
#include <stdio.h>

// A page shows a sheet's items: all, or those of the tile that begins at `lo` on the sheet.
typedef struct page {
    double size[2], scale;
    const int* items;
    int item_count;
    bool tile;
    double lo[2];
    int number, place[2], of[2]; // sheet; column and row from the top
} page;

// --- lines

static void put_point(ax_writer* w, double x, double y, const char* command)
{
    ax_put_mm(w, x);
    ax_put_words(w, " ");
    ax_put_mm(w, y);
    ax_put_words(w, command);
}

// Cubic curves of equal angles, as few as stay within a micrometre: one of angle a is off by 2/27 r sin(a/4)^6 / cos(a/4)^2 (Goldapp
// 1991).
static void put_arc(ax_writer* w, const ax_cut_point* a, const ax_cut_point* b)
{
    static const double tolerance = 1e-3;
    const ax_cut_arc arc = ax_cut_arc_of(a, b);
    int pieces = (int)fmax(1, ceil(fabs(arc.sweep) / (AX_PI / 2) - 1e-9));
    for (; pieces < 1000; ++pieces) {
        double quarter = arc.sweep / pieces / 4;
        if (2.0 / 27 * arc.radius * pow(sin(quarter), 6) / (cos(quarter) * cos(quarter)) < tolerance)
            break;
    }
    double step = arc.sweep / pieces, reach = 4.0 / 3 * tan(step / 4), c = cos(step), s = sin(step);
    double from[2] = {a->x - arc.centre[0], a->y - arc.centre[1]};
    for (int k = 1; k <= pieces; ++k) {
        const double to[2] = {k < pieces ? c * from[0] - s * from[1] : b->x - arc.centre[0],
                              k < pieces ? s * from[0] + c * from[1] : b->y - arc.centre[1]};
        put_point(w, arc.centre[0] + from[0] - reach * from[1], arc.centre[1] + from[1] + reach * from[0], " ");
        put_point(w, arc.centre[0] + to[0] + reach * to[1], arc.centre[1] + to[1] - reach * to[0], " ");
        put_point(w, arc.centre[0] + to[0], arc.centre[1] + to[1], " c\n");
        from[0] = to[0], from[1] = to[1];
    }
}

// Whether the way from one point to the next can show; an arc stays within half its chord, times the bulge, of it.
static bool segment_shows(const ax_cut_point* a, const ax_cut_point* b, const double view[4])
{
    double reach = a->bulge == 0 ? 0 : fabs(a->bulge) * hypot(b->x - a->x, b->y - a->y) / 2;
    return fmin(a->x, b->x) - reach <= view[2] && fmax(a->x, b->x) + reach >= view[0] &&
           fmin(a->y, b->y) - reach <= view[3] && fmax(a->y, b->y) + reach >= view[1];
}

// What of a path can show in `view` (NULL: all of it).
static void put_path(ax_writer* w, const ax_cut_plan* plan, const ax_cut_path* path, const double* view)
{
    const ax_cut_point* p = plan->points + path->first;
    bool down = false, whole = true;
    for (int k = 0, ways = path->count - !path->closed; k < ways; ++k) {
        const ax_cut_point *a = p + k, *b = p + (k + 1) % path->count;
        if (view && !segment_shows(a, b, view)) {
            down = whole = false;
            continue;
        }
        if (!down)
            put_point(w, a->x, a->y, " m\n");
        down = true;
        if (a->bulge != 0)
            put_arc(w, a, b);
        else if (k + 1 < path->count || !whole)
            put_point(w, b->x, b->y, " l\n");
    }
    if (path->closed && whole)
        ax_put_words(w, "h\n");
}

static void put_pen(ax_writer* w, const ax_profile_pen* pen)
{
    for (int k = 0; k < 3; ++k) {
        ax_put_fixed(w, pen->rgb[k] / 255.0, 4);
        ax_put_words(w, " ");
    }
    ax_put_words(w, "RG ");
    ax_put_mm(w, pen->stroke);
    ax_put_words(w, " w\n");
}

static void put_items(ax_writer* w, const ax_cut_plan* plan, int count, const int* items, const double* view)
{
    const ax_profile_pen* held = NULL;
    for (int i = 0; i < count; ++i) {
        const ax_cut_item* item = plan->items + items[i];
        const ax_profile_pen* pen = plan->profile->pens + item->operation;
        if (!pen->used)
            continue;
        if (pen != held)
            put_pen(w, pen);
        held = pen;
        for (int k = item->first; k < item->first + item->count; ++k)
            put_path(w, plan, plan->paths + k, view);
        ax_put_words(w, "S\n");
    }
}

// --- tiles

static const double border = 10, overlap = 10, mark = 5; // mm; printers leave a border white

typedef struct lettering {
    ax_writer* w;
    double x, y, height;
} lettering;

static void put_letter(void* context, bool down, double x, double y)
{
    const lettering* l = context;
    put_point(l->w, l->x + l->height * x, l->y + l->height * y, down ? " l\n" : " m\n");
}

// Crosses at the corners of what the page adds, and its name in the border; then only what lies within the border shows, moved.
static void begin_tile(ax_writer* w, const page* p)
{
    char name[128];
    const double edge = border + overlap / 2;
    put_pen(w, &(ax_profile_pen){.rgb = {96, 96, 96}, .stroke = 0.15});
    for (int k = 0; k < 4; ++k) {
        double x = k & 1 ? p->size[0] - edge : edge, y = k & 2 ? p->size[1] - edge : edge;
        put_point(w, x - mark, y, " m\n");
        put_point(w, x + mark, y, " l\n");
        put_point(w, x, y - mark, " m\n");
        put_point(w, x, y + mark, " l\n");
    }
    snprintf(name, sizeof name, "sheet %d, column %d of %d, row %d of %d; glue on the crosses, print at 100 %%",
             p->number + 1, p->place[0] + 1, p->of[0], p->place[1] + 1, p->of[1]);
    ax_stroke_text(name, put_letter, &(lettering){w, border + 2, border - 5, 2});
    ax_put_words(w, "S\n");
    put_point(w, border, border, " ");
    put_point(w, p->size[0] - 2 * border, p->size[1] - 2 * border, " re W n 1 0 0 1 ");
    put_point(w, edge - p->lo[0], edge - p->lo[1], " cm\n");
}

// What a tile adds to its neighbours, and what it shows with its overlaps.
static void tile_view(const page* p, double beyond, double view[4])
{
    for (int d = 0; d < 2; ++d) {
        view[d] = p->lo[d] - beyond;
        view[2 + d] = p->lo[d] + p->size[d] - 2 * border - overlap + beyond;
    }
}

// --- the file

// Content is made in parts, by threads, and written in order.
typedef struct part {
    int page, first, count;
} part;

enum { PART = 4096, BATCH = 32 }; // items a part, parts at a time

typedef struct making {
    const ax_cut_plan* plan;
    const page* pages;
    const part* parts;
    ax_pdf_stream* streams;
} making;

static void make_part(void* context, int k)
{
    const making* m = context;
    const page* p = m->pages + m->parts[k].page;
    ax_writer w = {0};
    double view[4];
    if (m->parts[k].first == 0) {
        const double point = p->scale * 72 / 25.4;
        ax_put_fixed(&w, point, 9);
        ax_put_words(&w, " 0 0 ");
        ax_put_fixed(&w, point, 9);
        ax_put_words(&w, " 0 0 cm\n");
        if (p->tile)
            begin_tile(&w, p);
    }
    tile_view(p, overlap / 2, view);
    put_items(&w, m->plan, m->parts[k].count, p->items + m->parts[k].first, p->tile ? view : NULL);
    m->streams[k] = ax_pdf_deflate(&w);
}

static ax_status write_pages(const ax_cut_plan* plan, int page_count, const page* pages, const char* path,
                             ax_error* error)
{
    ax_pdf pdf;
    ax_status status = ax_pdf_open(&pdf, path, error);
    if (status != AX_OK)
        return status;
    ax_pool* pool = ax_pool_make(0);
    part parts[BATCH];
    ax_pdf_stream streams[BATCH];
    for (int p = 0, first = 0; p < page_count;) {
        int count = 0;
        for (; p < page_count && count < BATCH; ++count) {
            int left = pages[p].item_count - first;
            parts[count] = (part){p, first, left < PART ? left : PART};
            first += PART;
            if (left <= PART)
                ++p, first = 0;
        }
        ax_pool_run(pool, make_part, &(making){plan, pages, parts, streams}, count);
        for (int k = 0; k < count; ++k) {
            const page* of = pages + parts[k].page;
            if (parts[k].first == 0)
                ax_pdf_page(&pdf, of->size[0], of->size[1], of->item_count ? (of->item_count + PART - 1) / PART : 1);
            ax_pdf_add(&pdf, &streams[k]);
        }
    }
    ax_pool_free(pool);
    return ax_pdf_close(&pdf, plan->title, plan->date, path, error);
}

// mm: 14,400 units, beyond which Acrobat shows nothing. Larger units are allowed since PDF 1.6, but not known to all programs, which then
// show the page at another size.
static const double longest_page = 14400 * 25.4 / 72;

static ax_status check_sizes(const ax_cut_plan* plan, ax_error* error)
{
    for (int k = 0; k < plan->sheet_count; ++k) {
        const ax_cut_sheet* s = &plan->sheets[k];
        if (fmax(s->width, s->height) > longest_page)
            return ax_fail(
                error, AX_CANNOT_REALISE,
                "Sheet %d of %d is %.0f x %.0f mm; a PDF page is %.0f mm long at most, larger ones are not "
                "shown by all programs. Choose smaller sheets, or write .a4.pdf (pages to be glued), .dxf or "
                ".svg.",
                k + 1, plan->sheet_count, s->width, s->height, longest_page);
    }
    return AX_OK;
}

ax_status ax_page_sheets(const ax_cut_plan* plan, const char* path, ax_error* error)
{
    ax_status status = check_sizes(plan, error);
    if (status != AX_OK)
        return status;
    int count = 0, *items = AX_NEW(int, plan->item_count);
    page* pages = AX_NEW0(page, plan->sheet_count + 1);
    for (int i = 0; i < plan->item_count; ++i)
        items[i] = i;
    for (int k = plan->overview.count ? -1 : 0; k < plan->sheet_count; ++k) {
        const ax_cut_sheet* s = k < 0 ? &plan->overview : plan->sheets + k;
        // the overview is not to be cut, and may shrink
        double scale = k < 0 ? fmin(1, longest_page / fmax(s->width, s->height)) : 1;
        pages[count++] = (page){.size = {scale * s->width, scale * s->height},
                                .scale = scale,
                                .items = items + s->first,
                                .item_count = s->count};
    }
    status = write_pages(plan, count, pages, path, error);
    ax_free(pages);
    ax_free(items);
    return status;
}

// Tiles of a sheet that an item may show on: columns lo[0] to hi[0] and rows lo[1] to hi[1].
static void tiles_of(const ax_cut_plan* plan, const ax_cut_item* item, const double step[2], const int of[2], int lo[2],
                     int hi[2])
{
    double least[2] = {INFINITY, INFINITY}, most[2] = {-INFINITY, -INFINITY};
    for (int k = item->first; k < item->first + item->count; ++k)
        ax_path_bounds(plan, plan->paths + k, least, most);
    for (int d = 0; d < 2; ++d) {
        lo[d] = (int)ax_clamp(floor((least[d] - overlap / 2) / step[d]), 0, of[d]);
        hi[d] = (int)ax_clamp(floor((most[d] + overlap / 2) / step[d]), -1, of[d] - 1);
    }
}

static bool anything_shows(const ax_cut_plan* plan, const page* p)
{
    double view[4];
    tile_view(p, 0, view);
    for (int i = 0; i < p->item_count; ++i) {
        const ax_cut_item* item = plan->items + p->items[i];
        for (int k = item->first; k < item->first + item->count; ++k) {
            const ax_cut_path* path = plan->paths + k;
            const ax_cut_point* at = plan->points + path->first;
            for (int j = 0; j < path->count - !path->closed; ++j)
                if (segment_shows(at + j, at + (j + 1) % path->count, view))
                    return true;
        }
    }
    return false;
}

// The pages of one sheet, top left first, as one reads, and the items of each; all owned by the caller.
static page* tile_sheet(const ax_cut_plan* plan, int number, const double page_size[2], int* count, int** items)
{
    const ax_cut_sheet* s = plan->sheets + number;
    const double size[2] = {s->width, s->height};
    double step[2];
    int of[2], lo[2], hi[2];
    for (int d = 0; d < 2; ++d) {
        step[d] = page_size[d] - 2 * border - overlap;
        of[d] = (int)ceil(size[d] / step[d]);
    }
    *count = of[0] * of[1];
    int* start = AX_NEW0(int, *count + 2);
    page* pages = AX_NEW0(page, *count);
    *items = NULL;
    for (int pass = 0; pass < 2; ++pass) { // counted, then filled
        for (int i = s->first; i < s->first + s->count; ++i) {
            tiles_of(plan, plan->items + i, step, of, lo, hi);
            for (int row = lo[1]; row <= hi[1]; ++row)
                for (int column = lo[0]; column <= hi[0]; ++column) {
                    int* at = &start[(of[1] - 1 - row) * of[0] + column + (pass ? 1 : 2)];
                    if (pass)
                        (*items)[*at] = i;
                    ++*at;
                }
        }
        for (int k = 2; k < *count + 2 && !pass; ++k)
            start[k] += start[k - 1];
        if (!pass)
            *items = AX_NEW(int, start[*count + 1] + 1);
    }
    for (int k = 0; k < *count; ++k) {
        int column = k % of[0], row = k / of[0];
        pages[k] = (page){.size = {page_size[0], page_size[1]},
                          .scale = 1,
                          .items = *items + start[k],
                          .item_count = start[k + 1] - start[k],
                          .tile = true,
                          .lo = {column * step[0], (of[1] - 1 - row) * step[1]},
                          .number = number,
                          .place = {column, row},
                          .of = {of[0], of[1]}};
    }
    ax_free(start);
    return pages;
}

ax_status ax_page_tiles(const ax_cut_plan* plan, const double page_size[2], bool leave_out_empty, const char* path,
                        ax_error* error)
{
    page* pages = NULL;
    int count = 0, **items = AX_NEW(int*, plan->sheet_count);
    for (int k = 0; k < plan->sheet_count; ++k) {
        int more;
        page* tiles = tile_sheet(plan, k, page_size, &more, &items[k]);
        pages = ax_realloc(pages, (size_t)(count + more), sizeof *pages);
        for (int t = 0; t < more; ++t)
            if (!leave_out_empty || anything_shows(plan, &tiles[t]))
                pages[count++] = tiles[t];
        ax_free(tiles);
    }
    ax_status status = write_pages(plan, count, pages, path, error);
    for (int k = 0; k < plan->sheet_count; ++k)
        ax_free(items[k]);
    ax_free(items);
    ax_free(pages);
    return status;
}
