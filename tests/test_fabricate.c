// Cut plans, measured by code that knows nothing of how they are made: outlines are cut in imagination, offset back by the kerf and
// hinged again.
#include "ax/fabricate.h"

#include "base/vec.h"
#include "fabricate/profile.h"
#include "fabricate/way.h"
#include "support/sample.h"
#include "support/test.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static ax_design sample;

static int set_up(void** state)
{
    (void)state;
    sample = sample_design();
    return 0;
}

static int tear_down(void** state)
{
    (void)state;
    ax_design_free(&sample);
    return 0;
}

static ax_fabricate_options choose(const char* joint, const char* material, const char* sheet, double kerf)
{
    ax_fabricate_options o = ax_fabricate_options_default();
    ax_error error;
    if (ax_fabricate_set_joint(&o, joint, &error) != AX_OK ||
        ax_fabricate_set_material(&o, material, &error) != AX_OK ||
        (sheet && ax_fabricate_set_sheet(&o, sheet, &error) != AX_OK))
        fail_msg("%s", error.message);
    o.kerf = kerf;
    return o;
}

static ax_cut_plan make(const ax_design* design, const ax_fabricate_options* options)
{
    ax_cut_plan plan;
    ax_error error;
    if (ax_fabricate(design, options, NULL, &plan, &error) != AX_OK)
        fail_msg("%s", error.message);
    return plan;
}

// --- paths as polygons

typedef struct segment {
    double a[2], b[2];
    int path, item;
} segment;

typedef struct segments {
    segment* list;
    int count, room;
} segments;

static void add_segment(segments* s, double ax, double ay, double bx, double by, int path, int item)
{
    if (s->count == s->room) {
        s->room = s->room ? 2 * s->room : 1024;
        s->list = realloc(s->list, (size_t)s->room * sizeof *s->list);
    }
    s->list[s->count++] = (segment){{ax, ay}, {bx, by}, path, item};
}

// Arcs by chords, from the definition of the bulge: the arc's middle lies bulge / 2 chords right of the chord's.
static void add_arc(segments* s, double ax, double ay, double bx, double by, double bulge, int depth, int path,
                    int item)
{
    if (bulge == 0 || depth == 0) {
        add_segment(s, ax, ay, bx, by, path, item);
        return;
    }
    double mx = (ax + bx) / 2 + bulge / 2 * (by - ay), my = (ay + by) / 2 - bulge / 2 * (bx - ax);
    double half = (sqrt(1 + bulge * bulge) - 1) / bulge; // tangent of half the angle
    add_arc(s, ax, ay, mx, my, half, depth - 1, path, item);
    add_arc(s, mx, my, bx, by, half, depth - 1, path, item);
}

static void add_path(segments* s, const ax_cut_plan* plan, int path, int item)
{
    const ax_cut_path* p = &plan->paths[path];
    for (int k = 0; k + !p->closed < p->count; ++k) {
        const ax_cut_point *a = &plan->points[p->first + k], *b = &plan->points[p->first + (k + 1) % p->count];
        add_arc(s, a->x, a->y, b->x, b->y, a->bulge, 4, path, item);
    }
}

static segments cut_lines(const ax_cut_plan* plan, const ax_cut_sheet* sheet)
{
    segments s = {0};
    for (int i = sheet->first; i < sheet->first + sheet->count; ++i)
        if (plan->items[i].operation >= AX_HOLE && plan->items[i].operation <= AX_CUT)
            for (int k = 0; k < plan->items[i].count; ++k)
                add_path(&s, plan, plan->items[i].first + k, i);
    return s;
}

static double segments_area(const segments* s, int first)
{
    double area = 0;
    for (int i = first; i < s->count; ++i)
        area += (s->list[i].a[0] * s->list[i].b[1] - s->list[i].b[0] * s->list[i].a[1]) / 2;
    return area;
}

static bool cross(const segment* s, const segment* t)
{
    double a = ax_orient2(s->a, s->b, t->a), b = ax_orient2(s->a, s->b, t->b);
    double c = ax_orient2(t->a, t->b, s->a), d = ax_orient2(t->a, t->b, s->b);
    double sure = 1e-6; // mm2: ends that touch do not cross
    return ((a > sure && b < -sure) || (a < -sure && b > sure)) && ((c > sure && d < -sure) || (c < -sure && d > sure));
}

static double to_segment(const double x[2], const segment* s)
{
    double d[2] = {s->b[0] - s->a[0], s->b[1] - s->a[1]}, square = d[0] * d[0] + d[1] * d[1];
    double at = square > 0 ? ax_clamp(((x[0] - s->a[0]) * d[0] + (x[1] - s->a[1]) * d[1]) / square, 0, 1) : 0;
    const double foot[2] = {s->a[0] + at * d[0], s->a[1] + at * d[1]};
    return ax_distance2(x, foot);
}

// --- what must hold of every plan

static void check_paths(const ax_cut_plan* plan, const ax_cut_sheet* sheet, const ax_cut_item* item)
{
    for (int k = item->first; k < item->first + item->count; ++k) {
        const ax_cut_path* path = &plan->paths[k];
        assert_true(path->count >= 2 && path->first + path->count <= plan->point_count);
        assert_true(path->closed || (item->operation != AX_HOLE && item->operation != AX_CUT));
        segments s = {0};
        add_path(&s, plan, k, 0);
        for (int i = 0; i < s.count; ++i)
            assert_true(s.list[i].a[0] > 1 && s.list[i].a[1] > 1 && s.list[i].a[0] < sheet->width - 1 &&
                        s.list[i].a[1] < sheet->height - 1);
        for (int v = path->first; v < path->first + path->count; ++v)
            assert_at_most(fabs(plan->points[v].bulge), 1);
        free(s.list);
    }
}

static int by_left_end(const void* a, const void* b)
{
    const segment *s = a, *t = b;
    double x = fmin(s->a[0], s->b[0]), y = fmin(t->a[0], t->b[0]);
    return (x > y) - (x < y);
}

static void check_lines(const ax_cut_plan* plan, const ax_cut_sheet* sheet, double apart)
{
    segments s = cut_lines(plan, sheet);
    qsort(s.list, (size_t)s.count, sizeof *s.list, by_left_end);
    for (int i = 0; i < s.count; ++i)
        for (int k = i + 1; k < s.count; ++k) {
            const segment *a = &s.list[i], *b = &s.list[k];
            if (fmin(b->a[0], b->b[0]) > fmax(a->a[0], a->b[0]) + apart)
                break;
            if (cross(a, b))
                fail_msg("%s and %s cross at %g, %g", plan->items[a->item].name, plan->items[b->item].name, a->a[0],
                         a->a[1]);
            bool same = (ax_distance2(a->a, b->a) < 1e-6 && ax_distance2(a->b, b->b) < 1e-6) ||
                        (ax_distance2(a->a, b->b) < 1e-6 && ax_distance2(a->b, b->a) < 1e-6);
            if (same)
                fail_msg("%s and %s repeat a line", plan->items[a->item].name, plan->items[b->item].name);
            if (plan->items[a->item].panel != plan->items[b->item].panel)
                assert_at_most(apart - 1e-3, fmin(to_segment(a->a, b), to_segment(b->a, a)));
        }
    free(s.list);
}

// `apart`: least distance of lines of different panels, mm.
static void check_plan(const ax_cut_plan* plan, double apart)
{
    assert_int_equal(plan->panel_count, sample.linkage.triangle_count);
    assert_true(plan->sheet_count > 0);
    int notes = 0, counts[AX_OPERATIONS] = {0};
    for (int s = 0; s < plan->sheet_count; ++s) {
        const ax_cut_sheet* sheet = &plan->sheets[s];
        assert_true(sheet->count > 0 && sheet->utilisation > 0 && sheet->utilisation < 1);
        for (int i = sheet->first; i < sheet->first + sheet->count; ++i) {
            const ax_cut_item* item = &plan->items[i];
            assert_true(item->count > 0 && item->first + item->count <= plan->path_count);
            assert_true(i == sheet->first || plan->items[i - 1].operation <= item->operation);
            assert_true(item->panel < 0 || plan->panels[item->panel].sheet == s || item->operation == AX_NOTE);
            check_paths(plan, sheet, item);
            ++counts[item->operation];
            if (strcmp(item->name, "check-bar") == 0) {
                const ax_cut_point* bar = &plan->points[plan->paths[item->first + 1].first];
                assert_near(bar[1].x - bar[0].x, 100, 1e-9);
                ++notes;
            }
        }
        check_lines(plan, sheet, apart);
    }
    assert_int_equal(notes, plan->sheet_count);
    if (!plan->joint->one_piece) {
        assert_int_equal(counts[AX_CUT], plan->panel_count);
        assert_true(counts[AX_HOLE] == 0 || counts[AX_HOLE] == 3 * plan->panel_count);
        assert_int_equal(counts[AX_SLIT], 0);
    }
    assert_int_equal(plan->overview.count > 0, plan->sheet_count > 1);
}

static int item_of(const ax_cut_plan* plan, const char* format, const char* name, int k)
{
    char wanted[40];
    snprintf(wanted, sizeof wanted, format, name, k);
    for (int s = 0; s < plan->sheet_count; ++s)
        for (int i = plan->sheets[s].first; i < plan->sheets[s].first + plan->sheets[s].count; ++i)
            if (strcmp(plan->items[i].name, wanted) == 0)
                return i;
    fail_msg("there is no %s", wanted);
    return -1;
}

static double edge_of(const ax_design* design, int t, int k)
{
    const int* corner = design->linkage.triangles[t];
    return 1000 * ax_distance2(design->flat[corner[k]], design->flat[corner[(k + 1) % 3]]);
}

// --- loose panels

// Edge lines moved inward by `back` meet in the corners of the bare triangle.
static void triangle_of_outline(const ax_cut_plan* plan, int item, double back, double corner[3][2])
{
    const ax_cut_point* p = &plan->points[plan->paths[plan->items[item].first].first];
    assert_int_equal(plan->paths[plan->items[item].first].count, 3);
    for (int k = 0; k < 3; ++k) {
        double in[2] = {p[k].x - p[(k + 2) % 3].x, p[k].y - p[(k + 2) % 3].y};
        double out[2] = {p[(k + 1) % 3].x - p[k].x, p[(k + 1) % 3].y - p[k].y};
        double li = hypot(in[0], in[1]), lo = hypot(out[0], out[1]), turn = ax_cross2(in, out) / (li * lo);
        for (int d = 0; d < 2; ++d)
            corner[k][d] = (d ? p[k].y : p[k].x) + back / turn * (out[d] / lo - in[d] / li);
    }
}

static void bare_triangles_have_the_linkages_edges(void** state)
{
    (void)state;
    static const double kerfs[] = {0, 0.25};
    static const char* const sheets[] = {NULL, "900x600"};
    for (int k = 0; k < 4; ++k) {
        ax_fabricate_options o = choose("none", "card-0.5", sheets[k / 2], kerfs[k % 2]);
        ax_cut_plan plan = make(&sample, &o);
        check_plan(&plan, plan.in_place ? 0 : o.spacing);
        assert_int_equal(plan.in_place, k == 0); // grown corners would cross in place
        for (int t = 0; t < plan.panel_count; ++t) {
            double corner[3][2];
            triangle_of_outline(&plan, item_of(&plan, "cut-%s", plan.panels[t].name, 0), o.kerf / 2, corner);
            for (int e = 0; e < 3; ++e)
                assert_near(ax_distance2(corner[e], corner[(e + 1) % 3]), edge_of(&sample, t, e), 0.001);
        }
        assert_near(plan.area, 1e6 * sample.report.panel_area, 1e-3);
        ax_cut_plan_free(&plan);
    }
}

// Hinges of a panel from its holes, `reach` mm outward of their middles.
static void hinges_of_holes(const ax_cut_plan* plan, int t, double ring, double corner[3][2])
{
    double hole[3][2], radius = 0, side[3], sum = 0, middle[2] = {0, 0};
    for (int k = 0; k < 3; ++k) {
        const ax_cut_item* item = &plan->items[item_of(plan, "hole-%s.%d", plan->panels[t].name, k)];
        assert_true(ax_cut_path_is_circle(plan, &plan->paths[item->first], hole[k], &radius));
    }
    for (int k = 0; k < 3; ++k)
        sum += side[k] = ax_distance2(hole[(k + 1) % 3], hole[(k + 2) % 3]);
    for (int k = 0; k < 3; ++k)
        for (int d = 0; d < 2; ++d)
            middle[d] += side[k] / sum * hole[k][d];
    double reach =
        ring > 0 ? ring / 2 + radius + plan->kerf / 2 : 0; // a taut ring's inside, from hole edge to hole edge
    for (int k = 0; k < 3; ++k)
        for (int d = 0; d < 2; ++d)
            corner[k][d] = hole[k][d] + reach * (hole[k][d] - middle[d]) / ax_distance2(hole[k], middle);
}

static void check_holes(const char* joint, double ring, const char* sheet, double kerf)
{
    ax_fabricate_options o = choose(joint, "plywood-3", sheet, kerf);
    ax_cut_plan plan = make(&sample, &o);
    check_plan(&plan, plan.in_place ? 0.1 : o.spacing);
    for (int t = 0; t < plan.panel_count; ++t) {
        double corner[3][2];
        hinges_of_holes(&plan, t, ring, corner);
        for (int e = 0; e < 3; ++e)
            assert_near(ax_distance2(corner[e], corner[(e + 1) % 3]), edge_of(&sample, t, e), 0.01);
    }
    int joints = 0;
    for (int h = 0; h < sample.linkage.hinge_count; ++h)
        joints += !sample.linkage.on_rim[h];
    assert_int_equal(plan.part_count, 1);
    assert_int_equal(plan.parts[0].count, joints);
    assert_int_equal(plan.hinge_count, joints);
    ax_cut_plan_free(&plan);
}

static void rings_and_pins_hinge_panels_at_the_linkages_edges(void** state)
{
    (void)state;
    static const char* const sheets[] = {NULL, "900x600"};
    for (int k = 0; k < 4; ++k) {
        check_holes("ring", 16, sheets[k / 2], k % 2 * 0.2);
        check_holes("ring:ring=30,hole=5,edge=3,gap=2", 30, sheets[k / 2], k % 2 * 0.2);
        check_holes("pin", 0, sheets[k / 2], k % 2 * 0.2);
    }
}

static void holes_keep_their_edge_distance(void** state)
{
    (void)state;
    static const char* const joints[] = {"ring:edge=2.5", "pin:edge=2.5,inset=0", "pin:edge=2.5,inset=1.5"};
    for (int j = 0; j < 3; ++j) {
        ax_fabricate_options o = choose(joints[j], "plywood-3", NULL, 0);
        ax_cut_plan plan = make(&sample, &o);
        for (int t = 0; t < plan.panel_count; ++t) {
            const ax_cut_panel* p = &plan.panels[t];
            segments outline = {0};
            add_path(&outline, &plan, p->first, 0);
            assert_int_equal(p->count, 4);
            assert_true(segments_area(&outline, 0) > p->area);
            for (int k = 1; k < 4; ++k) {
                double centre[2], radius, least = INFINITY;
                assert_true(ax_cut_path_is_circle(&plan, &plan.paths[p->first + k], centre, &radius));
                for (int i = 0; i < outline.count; ++i)
                    least = fmin(least, to_segment(centre, &outline.list[i]));
                assert_near(least, radius + 2.5, 0.02); // chords lie within the arc
            }
            free(outline.list);
        }
        ax_cut_plan_free(&plan);
    }
}

// --- one piece

// Middles of the arcs, and ends of lines, of all openings: the points nearest to a hinge.
static int opening_tips(const ax_cut_plan* plan, double (*tips)[2], int* sheet)
{
    int count = 0;
    for (int s = 0; s < plan->sheet_count; ++s)
        for (int i = plan->sheets[s].first; i < plan->sheets[s].first + plan->sheets[s].count; ++i) {
            const ax_cut_item* item = &plan->items[i];
            for (int k = item->first;
                 k < item->first + item->count && (item->operation == AX_SLIT || item->operation == AX_CUT); ++k) {
                const ax_cut_path* path = &plan->paths[k];
                const ax_cut_point* p = &plan->points[path->first];
                if (!path->closed) {
                    sheet[count] = s;
                    tips[count][0] = p[1].x, tips[count++][1] = p[1].y;
                    continue;
                }
                for (int v = 0; v < path->count; ++v) {
                    const ax_cut_point *a = &p[v], *b = &p[(v + 1) % path->count];
                    double bulge = a->bulge;
                    if (bulge == 0)
                        continue;
                    sheet[count] = s;
                    // an arc of more than half a circle comes in two
                    if (fabs(p[(v + 1) % path->count].bulge - bulge) < 1e-12) {
                        tips[count][0] = b->x, tips[count++][1] = b->y;
                        ++v;
                        continue;
                    }
                    tips[count][0] = (a->x + b->x) / 2 + bulge / 2 * (b->y - a->y);
                    tips[count++][1] = (a->y + b->y) / 2 - bulge / 2 * (b->x - a->x);
                }
            }
        }
    return count;
}

static void check_ligaments(const ax_design* design, double ligament, const char* sheet, double kerf)
{
    char joint[40];
    snprintf(joint, sizeof joint, "living-hinge:ligament=%g", ligament);
    ax_fabricate_options o = choose(joint, "polypropylene-0.8", sheet, kerf);
    ax_cut_plan plan = make(design, &o);
    check_plan(&plan, 0);
    double(*tips)[2] = malloc((size_t)plan.point_count * sizeof *tips);
    int *sheets = malloc((size_t)plan.point_count * sizeof *sheets), count = opening_tips(&plan, tips, sheets),
        seams = 0;
    for (int i = 0; i < plan.hinge_count; ++i) {
        const ax_cut_hinge* h = &plan.hinges[i];
        const ax_cut_panel *a = &plan.panels[h->panels[0]], *b = &plan.panels[h->panels[1]];
        assert_int_equal(a->piece != b->piece, h->seam != 0);
        seams += h->seam != 0;
        if (h->seam)
            continue;
        const double *m = a->placement, x = 1000 * design->flat[h->hinge][0], y = 1000 * design->flat[h->hinge][1];
        const double hinge[2] = {m[0] * x - m[1] * y + m[2], m[1] * x + m[0] * y + m[3]};
        double nearest[2] = {INFINITY, INFINITY}, at[2][2] = {{0}};
        for (int k = 0; k < count; ++k) {
            if (sheets[k] != a->sheet)
                continue;
            double distance = ax_distance2(tips[k], hinge);
            int place = distance < nearest[0] ? 0 : distance < nearest[1] ? 1 : 2;
            if (place == 0)
                nearest[1] = nearest[0], memcpy(at[1], at[0], sizeof at[1]);
            if (place < 2)
                nearest[place] = distance, memcpy(at[place], tips[k], sizeof at[place]);
        }
        assert_near(ax_distance2(at[0], at[1]), ligament + kerf, 1e-6); // what the beam leaves is the ligament
        assert_near((at[0][0] + at[1][0]) / 2, hinge[0], 1e-4);         // with the hinge in its middle
        assert_near((at[0][1] + at[1][1]) / 2, hinge[1], 1e-4);
    }
    assert_int_equal(seams, plan.seam_count);
    if (kerf == 0) { // what is left of the sheet is what the panels are said to be
        double area = 0;
        for (int s = 0; s < plan.sheet_count; ++s) {
            segments lines = cut_lines(&plan, &plan.sheets[s]);
            area -= segments_area(&lines, 0);
            free(lines.list);
        }
        assert_near(area, plan.area, 1e-4 * plan.area);
    }
    free(tips);
    free(sheets);
    ax_cut_plan_free(&plan);
}

static void ligaments_have_their_width_and_the_hinge_in_their_middle(void** state)
{
    (void)state;
    static const double ligaments[] = {1, 2, 4}, kerfs[] = {0, 0.2};
    for (int k = 0; k < 6; ++k) {
        check_ligaments(&sample, ligaments[k / 2], NULL, kerfs[k % 2]);
        check_ligaments(&sample, ligaments[k / 2], "900x600", kerfs[k % 2]);
    }
}

// No thin place: lines of the openings that meet at a hinge stay a ligament apart.
static void nothing_narrower_than_the_ligament_is_left_at_a_hinge(void** state)
{
    (void)state;
    ax_fabricate_options o = choose("living-hinge:ligament=3", "polypropylene-0.8", NULL, 0);
    ax_cut_plan plan = make(&sample, &o);
    segments s = cut_lines(&plan, &plan.sheets[0]);
    double least = INFINITY;
    for (int i = 0; i < s.count; ++i)
        for (int k = 0; k < s.count; ++k)
            if (s.list[i].path != s.list[k].path)
                least = fmin(least, to_segment(s.list[i].a, &s.list[k]));
    assert_near(least, 3, 0.02);
    free(s.list);
    ax_cut_plan_free(&plan);
}

static void a_ligament_that_would_break_or_is_wide_is_doubted(void** state)
{
    (void)state;
    const struct {
        const char *joint, *material, *word;
    } cases[] = {{"living-hinge", "plywood-3", "breaks"},
                 {"living-hinge:ligament=0.8", "polypropylene-0.8", ""},
                 {"living-hinge:ligament=30", "polypropylene-0.8", "twentieth"},
                 {"ring", "plywood-3", ""}};
    for (size_t k = 0; k < sizeof cases / sizeof *cases; ++k) {
        ax_fabricate_options o = choose(cases[k].joint, cases[k].material, NULL, 0);
        ax_cut_plan plan = make(&sample, &o);
        if (*cases[k].word)
            assert_non_null(strstr(plan.doubt, cases[k].word));
        else
            assert_string_equal(plan.doubt, "");
        ax_cut_plan_free(&plan);
    }
}

static void pieces_fit_their_sheets_and_hold_together(void** state)
{
    (void)state;
    ax_fabricate_options o = choose("living-hinge", "polypropylene-0.8", "900x600", 0.2);
    ax_cut_plan plan = make(&sample, &o);
    assert_true(plan.sheet_count > 1 && plan.seam_count > 0);
    // panels joined by hinges that are no seam form the pieces
    int* piece = malloc((size_t)plan.panel_count * sizeof *piece);
    for (int t = 0; t < plan.panel_count; ++t)
        piece[t] = t;
    for (bool changed = true; changed;) {
        changed = false;
        for (int i = 0; i < plan.hinge_count; ++i) {
            int *a = &piece[plan.hinges[i].panels[0]], *b = &piece[plan.hinges[i].panels[1]];
            if (!plan.hinges[i].seam && *a != *b)
                *a = *b = *a < *b ? *a : *b, changed = true;
        }
    }
    int rims = 0, outlines = 0, labels = 0, *size = calloc((size_t)plan.panel_count, sizeof *size);
    for (int t = 0; t < plan.panel_count; ++t)
        ++size[plan.panels[t].piece];
    for (int t = 0; t < plan.panel_count; ++t)
        assert_true(size[plan.panels[t].piece] >= 4); // fewer are hard to handle
    free(size);
    for (int t = 0; t < plan.panel_count; ++t) {
        rims += piece[t] == t;
        assert_int_equal(plan.panels[t].piece, plan.panels[piece[t]].piece);
        assert_memory_equal(plan.panels[t].placement, plan.panels[piece[t]].placement, sizeof plan.panels[t].placement);
    }
    for (int i = 0; i < plan.item_count; ++i) {
        outlines += plan.items[i].operation == AX_CUT;
        labels += strncmp(plan.items[i].name, "seam-", 5) == 0;
    }
    assert_int_equal(outlines, rims);
    assert_int_equal(labels + plan.labels_dropped, 2 * plan.seam_count); // a number on both sides
    free(piece);
    ax_cut_plan_free(&plan);
}

// --- clearance

// Least distance of two outlines while the second turns about a point, by trying.
static double try_turning(const ax_cut_plan* plan, const ax_cut_hinge* h, double opening)
{
    segments fixed = {0}, moved = {0};
    add_path(&fixed, plan, plan->panels[h->panels[0]].first, 0);
    add_path(&moved, plan, plan->panels[h->panels[1]].first, 0);
    double least = INFINITY, pivot[2] = {1000 * sample.flat[h->hinge][0], 1000 * sample.flat[h->hinge][1]};
    for (int step = 0; step <= 300; ++step) {
        double angle = opening * step / 300, c = cos(angle), s = sin(angle);
        for (int i = 0; i < moved.count; ++i) {
            segment turned = moved.list[i];
            for (int end = 0; end < 2; ++end) {
                double* x = end ? turned.b : turned.a;
                double dx = x[0] - pivot[0], dy = x[1] - pivot[1];
                x[0] = pivot[0] + c * dx - s * dy, x[1] = pivot[1] + s * dx + c * dy;
            }
            for (int k = 0; k < fixed.count; ++k)
                least = fmin(least, fmin(to_segment(turned.a, &fixed.list[k]), to_segment(fixed.list[k].a, &turned)));
        }
    }
    free(fixed.list);
    free(moved.list);
    return least;
}

static void clearance_is_what_turning_the_panels_finds(void** state)
{
    (void)state;
    static const char* const joints[] = {"ring", "ring:ring=24,gap=0.5", "none:inset=1,corner=4", "none:inset=0.5"};
    for (int j = 0; j < 4; ++j) {
        ax_fabricate_options o = choose(joints[j], "plywood-3", NULL, 0);
        o.frames = 0;
        ax_cut_plan plan = make(&sample, &o);
        assert_int_equal(plan.clashes_found, 0);
        for (int i = 0; i < plan.hinge_count; i += 7) {
            const ax_cut_hinge* h = &plan.hinges[i];
            double tried = try_turning(&plan, h, 2 * AX_PI / 3 - h->mouth);
            assert_true(h->mouth > 0 && h->mouth < 2 * AX_PI / 3 + 0.2);
            assert_near(h->clearance, tried, 0.03); // chords, and steps of the angle
        }
        ax_cut_plan_free(&plan);
    }
}

// A rim panel that is turned over on the line of its two neighbours lies on both.
static void folded_neighbours_are_told(void** state)
{
    (void)state;
    const ax_linkage* linkage = &sample.linkage;
    double(*x)[3] = sample.simulated ? sample.simulated : sample.deployed;
    ax_fabricate_options o = choose("pin", "plywood-3", NULL, 0);
    o.frames = 0;
    ax_cut_plan plan = make(&sample, &o);
    assert_int_equal(plan.folds, 0);
    assert_int_equal(plan.fold[0], -1);
    ax_cut_plan_free(&plan);
    int panel = -1, corner = -1;
    for (int t = 0; t < linkage->triangle_count && panel < 0; ++t)
        for (int k = 0; k < 3; ++k) {
            const int* h = linkage->triangles[t];
            if (linkage->on_rim[h[k]] && !linkage->on_rim[h[(k + 1) % 3]] && !linkage->on_rim[h[(k + 2) % 3]])
                panel = t, corner = k;
        }
    assert_true(panel >= 0);
    const int* h = linkage->triangles[panel];
    double before[3], *tip = x[h[corner]];
    memcpy(before, tip, sizeof before);
    for (int c = 0; c < 3; ++c) // equilateral, or nearly so
        tip[c] = x[h[(corner + 1) % 3]][c] + x[h[(corner + 2) % 3]][c] - before[c];
    plan = make(&sample, &o);
    memcpy(tip, before, sizeof before);
    assert_int_equal(plan.folds, 2);
    assert_true(plan.fold[0] == panel || plan.fold[1] == panel);
    ax_cut_plan_free(&plan);
}

static void what_collides_is_named(void** state)
{
    (void)state;
    // ears so wide that those of one layer meet across the openings
    ax_fabricate_options o = choose("pin:edge=22", "plywood-3", NULL, 0);
    ax_cut_plan plan = make(&sample, &o);
    assert_true(plan.clashes_found > 0 && plan.clash_count <= AX_CLASHES);
    for (int i = 0; i < plan.clash_count; ++i) {
        const ax_cut_clash* c = &plan.clashes[i];
        assert_true(c->overlap > 0);
        if (c->frame != 0)
            continue;
        assert_int_equal(plan.panels[c->panels[0]].layer, plan.panels[c->panels[1]].layer);
        segments a = {0}, b = {0};
        add_path(&a, &plan, plan.panels[c->panels[0]].first, 0);
        add_path(&b, &plan, plan.panels[c->panels[1]].first, 0);
        bool met = false;
        for (int p = 0; p < a.count && !met; ++p)
            for (int q = 0; q < b.count && !met; ++q)
                met = cross(&a.list[p], &b.list[q]);
        assert_true(met);
        free(a.list);
        free(b.list);
    }
    ax_cut_plan_free(&plan);
    // thick panels that are close and tilted against each other meet at their faces when deployed
    ax_fabricate_options thick = choose("none:inset=0.05", "plywood-3:thickness=60", NULL, 0);
    plan = make(&sample, &thick);
    int deployed = 0;
    for (int i = 0; i < plan.clash_count; ++i)
        deployed += plan.clashes[i].frame > 0;
    assert_true(deployed > 0);
    ax_cut_plan_free(&plan);
    thick = choose("none:inset=3", "plywood-3", NULL, 0);
    plan = make(&sample, &thick);
    assert_int_equal(plan.clashes_found, 0);
    ax_cut_plan_free(&plan);
}

// --- between flat and open

static double largest_edge_error(const double (*places)[3])
{
    double most = 0;
    for (int t = 0; t < sample.linkage.triangle_count; ++t)
        for (int k = 0; k < 3; ++k) {
            int i = sample.linkage.triangles[t][k], j = sample.linkage.triangles[t][(k + 1) % 3];
            double length = ax_distance2(sample.flat[i], sample.flat[j]);
            most = fmax(most, fabs(ax_distance3(places[i], places[j]) / length - 1));
        }
    return most;
}

static double extent(const double (*places)[3])
{
    double sum = 0, middle[3] = {0};
    int n = sample.linkage.hinge_count;
    for (int h = 0; h < n; ++h)
        for (int c = 0; c < 3; ++c)
            middle[c] += places[h][c] / n;
    for (int h = 0; h < n; ++h)
        sum += ax_dot3(places[h], places[h]) - ax_dot3(middle, middle);
    return sqrt(sum / n);
}

// By one and by two threads; calls `each` with every tenth of the way.
static void go(const ax_design* design, void (*each)(void* context, int k, const ax_way_state* s), void* context)
{
    ax_pool *alone = ax_pool_make(1), *pair = ax_pool_make(2);
    ax_way *first = ax_way_make(design, alone), *second = ax_way_make(design, pair);
    for (int k = 1; k <= 10; ++k) {
        ax_way_state one, two;
        assert_true(ax_way_at(first, k / 10.0, NULL, &one));
        assert_near(one.error, largest_edge_error(one.places), 1e-12);
        assert_at_most(one.error, 1e-3);
        assert_true(ax_way_at(second, k / 10.0, NULL, &two));
        assert_memory_equal(one.places, two.places, (size_t)design->linkage.hinge_count * sizeof *one.places);
        each(context, k, &one);
    }
    ax_way_free(first);
    ax_way_free(second);
    ax_pool_free(alone);
    ax_pool_free(pair);
}

static void note_extent(void* context, int k, const ax_way_state* s)
{
    double* extents = context;
    assert_near(s->strain, 0, 0); // nothing is simulated
    extents[k] = extent(s->places);
}

static void without_a_load_the_way_is_straight(void** state)
{
    (void)state;
    ax_design bare = sample;
    bare.simulated = NULL;
    double(*flat)[3] = calloc((size_t)sample.linkage.hinge_count, sizeof *flat), extents[11];
    for (int h = 0; h < sample.linkage.hinge_count; ++h)
        memcpy(flat[h], sample.flat[h], sizeof *sample.flat);
    extents[0] = extent((const double(*)[3])flat);
    go(&bare, note_extent, extents);
    for (int k = 1; k <= 10; ++k)
        assert_true(extents[k] > extents[k - 1]);
    assert_near(extents[10], extent((const double(*)[3])sample.deployed), 5e-3 * extents[10]);
    assert_near((extents[5] - extents[0]) / (extents[10] - extents[0]), 0.5, 0.1);
    free(flat);
}

static double farthest(const double (*a)[3], const double (*b)[3])
{
    double most = 0;
    for (int h = 0; h < sample.linkage.hinge_count; ++h)
        most = fmax(most, ax_distance3(a[h], b[h]));
    return most / sample.report.edge_mean;
}

static void note_distance(void* context, int k, const ax_way_state* s)
{
    double* to_end = context;
    to_end[k] = farthest(s->places, (const double(*)[3])sample.simulated);
    assert_true(s->strain > 0 && s->strain < 0.1);
    assert_true(s->moved > 0 && s->moved < 0.3 * sample.report.edge_mean);
    for (int h = 0; h < sample.linkage.hinge_count && k >= 8; ++h) // supports have arrived
        if (sample.supports[h])
            assert_at_most(ax_distance3(s->places[h], sample.simulated[h]), 0.1 * sample.report.edge_mean);
}

static void the_simulated_way_ends_in_the_equilibrium(void** state)
{
    (void)state;
    double to_end[11];
    go(&sample, note_distance, to_end);
    assert_at_most(to_end[10], 0.05);
    for (int k = 2; k <= 8; ++k)
        assert_true(to_end[k] < to_end[k - 1]);
}

// Whether a point of panel `a`, `inset` mm within its edges and anywhere in its thickness, lies as deep within panel `b`; mm.
static bool points_meet(const double (*places)[3], int a, int b, double inset, double thickness)
{
    enum { GRID = 240 };
    const int *p = sample.linkage.triangles[a], *q = sample.linkage.triangles[b];
    double n[2][3], e[2][3];
    for (int side = 0; side < 2; ++side) {
        const int* t = side ? q : p;
        ax_sub3(places[t[1]], places[t[0]], e[0]);
        ax_sub3(places[t[2]], places[t[0]], e[1]);
        ax_cross(e[0], e[1], n[side]);
        double length = ax_norm3(n[side]);
        for (int c = 0; c < 3; ++c)
            n[side][c] /= length;
    }
    for (int i = 0; i <= GRID; ++i)
        for (int j = 0; j <= GRID - i; ++j)
            for (int up = -12; up <= 12; ++up) {
                double x[3];
                for (int c = 0; c < 3; ++c)
                    x[c] =
                        1000 * (i * places[p[0]][c] + j * places[p[1]][c] + (GRID - i - j) * places[p[2]][c]) / GRID +
                        up * thickness / 24 * n[0][c];
                bool inside[2] = {true, true};
                for (int side = 0; side < 2; ++side) {
                    const int* t = side ? q : p;
                    for (int k = 0; k < 3; ++k) {
                        double edge[3], from[3], in[3], corner[3];
                        ax_sub3(places[t[(k + 1) % 3]], places[t[k]], edge);
                        ax_cross(n[side], edge, in);
                        for (int c = 0; c < 3; ++c)
                            corner[c] = 1000 * places[t[k]][c];
                        ax_sub3(x, corner, from);
                        inside[side] = inside[side] && ax_dot3(from, in) / ax_norm3(in) > inset;
                        inside[side] = inside[side] && (side == 0 || fabs(ax_dot3(from, n[1])) < thickness / 2);
                    }
                }
                if (inside[0] && inside[1])
                    return true;
            }
    return false;
}

static void thick_panels_that_collide_on_the_way_are_named(void** state)
{
    (void)state;
    ax_fabricate_options o = choose("none:inset=3", "plywood-3:thickness=40", NULL, 0);
    ax_cut_plan plan = make(&sample, &o);
    assert_int_equal(plan.frames_checked, 7);
    assert_true(plan.clashes_found > 0 && plan.frame_error > 0 && plan.frame_error < 0.5);
    ax_way_state s;
    int tried = 0, met = 0, counted = 0;
    ax_way* way = ax_way_make(&sample, NULL);
    for (int k = 1; k <= 7; ++k) {
        assert_true(ax_way_at(way, k / 8.0, NULL, &s));
        const ax_cut_frame* frame = &plan.frames[k - 1];
        assert_near(frame->opening, k / 8.0, 0);
        assert_near(frame->error, s.error, 0);
        assert_near(frame->strain, s.strain, 0);
        assert_near(frame->moved, 1000 * s.moved, 1e-9 * frame->moved);
        assert_true(frame->checked);
        counted += frame->clashes;
        for (int i = 0; i < plan.clash_count; ++i) {
            const ax_cut_clash* c = &plan.clashes[i];
            assert_int_equal(c->frame, 3); // open, they are apart: nothing but the way tells
            for (int j = 0; j < i; ++j)
                assert_memory_not_equal(plan.clashes[j].panels, c->panels, sizeof c->panels);
            if (c->opening != k / 8.0 || c->overlap < 2)
                continue;
            ++tried;
            met += points_meet(s.places, c->panels[0], c->panels[1], 3, 40) ||
                   points_meet(s.places, c->panels[1], c->panels[0], 3, 40);
        }
    }
    assert_true(tried > 0);
    assert_int_equal(met, tried);
    assert_true(plan.simulated_way && counted >= plan.clashes_found);
    ax_way_free(way);
    ax_cut_plan_free(&plan);
    o.frames = 0;
    plan = make(&sample, &o);
    assert_int_equal(plan.frames_checked, 0);
    assert_int_equal(plan.clashes_found, 0);
    ax_cut_plan_free(&plan);
}

static void hinge_forces_stand_beside_what_the_joint_bears(void** state)
{
    (void)state;
    ax_fabricate_options o = choose("ring", "plywood-3", NULL, 0);
    ax_cut_plan plan = make(&sample, &o);
    double most = 0;
    for (int i = 0; i < plan.hinge_count; ++i) {
        most = fmax(most, plan.hinges[i].force);
        assert_near(plan.hinges[i].rated, 2 * 2 * 3 * 0.6 * 30,
                    1e-9); // two shear lines of 2 mm in 3 mm at 0.6 x 30 MPa
    }
    assert_true(most > 0 && most <= sample.report.hinge_force_max * (1 + 1e-9));
    ax_cut_plan_free(&plan);
    ax_design bare = sample;
    bare.simulated = NULL, bare.edge_forces = NULL;
    plan = make(&bare, &o);
    assert_true(isnan(plan.hinges[0].force));
    ax_cut_plan_free(&plan);
}

// --- refusals and words

static void refuse(const char* joint, const char* material, const char* sheet, const char* named)
{
    ax_fabricate_options o = choose(joint, material, sheet, 0);
    ax_cut_plan plan;
    ax_error error = {0};
    assert_int_equal(ax_fabricate(&sample, &o, NULL, &plan, &error), AX_CANNOT_REALISE);
    if (!strstr(error.message, named))
        fail_msg("\"%s\" does not name \"%s\"", error.message, named);
    assert_null(plan.panels);
}

static void what_does_not_fit_is_refused_by_name(void** state)
{
    (void)state;
    refuse("ring:edge=1", "plywood-3", NULL, "edge=2");
    refuse("ring:ring=10", "plywood-3", NULL, "ring=14");
    refuse("ring:ring=200", "plywood-3", NULL, "Panel ");
    refuse("pin:edge=80", "plywood-3", NULL, "Panel ");
    refuse("pin:inset=9", "plywood-3", NULL, "inset=");
    refuse("living-hinge:ligament=0.5", "plywood-3", NULL, "ligament=2");
    refuse("living-hinge:ligament=90", "plywood-3", NULL, "Panel ");
    refuse("ring", "plywood-3", "150x150", "Panel ");
    refuse("living-hinge", "plywood-3", "150x150", "Panel ");
    refuse("none", "plywood-3", "90x90", "larger sheet");
}

static void words_choose_or_are_refused(void** state)
{
    (void)state;
    ax_fabricate_options o = ax_fabricate_options_default();
    ax_error error;
    assert_int_equal(ax_fabricate_set_joint(&o, "ring:hole=5,gap=0", &error), AX_OK);
    assert_string_equal(o.joint->name, "ring");
    assert_true(o.joint_values[1] == 5 && o.joint_values[3] == 0 && isnan(o.joint_values[0]));
    assert_int_equal(ax_fabricate_set_material(&o, "mdf-3:thickness=3.2", &error), AX_OK);
    assert_near(o.material.thickness, 3.2, 0);
    assert_near(o.material.density, 780, 0);
    assert_int_equal(ax_fabricate_set_sheet(&o, "A4", &error), AX_OK);
    assert_near(o.sheet[0], 297, 0);
    assert_int_equal(ax_fabricate_set_sheet(&o, "610.5x305", &error), AX_OK);
    assert_near(o.sheet[0], 610.5, 0);
    static const char* const joints[] = {"",
                                         "rings",
                                         "ring:",
                                         "ring:hole",
                                         "ring:hole=",
                                         "ring:hole=x",
                                         "ring:hole=-1",
                                         "ring:hole=5;gap=0",
                                         "ring:holes=5",
                                         "none:ring=3",
                                         "ring:hole=nan"};
    for (size_t k = 0; k < sizeof joints / sizeof *joints; ++k)
        assert_int_equal(ax_fabricate_set_joint(&o, joints[k], &error), k == 2 ? AX_OK : AX_USAGE);
    static const char* const sheets[] = {"",          "A5",     "600", "600x",    "x400",
                                         "600x400mm", "600x-1", "1x1", "infxinf", "600X400"};
    for (size_t k = 0; k < sizeof sheets / sizeof *sheets; ++k)
        assert_int_equal(ax_fabricate_set_sheet(&o, sheets[k], &error), AX_USAGE);
    assert_int_equal(ax_fabricate_set_material(&o, "cheese", &error), AX_USAGE);
    assert_non_null(strstr(error.message, "plywood-3"));
    assert_near(o.sheet[0], 610.5, 0); // what is refused changes nothing
}

static void profiles_come_from_json(void** state)
{
    (void)state;
    static const char text[] = "{\"base\": \"lightburn\", \"name\": \"lab\", \"travel_speed\": 500,"
                               " \"operations\": {\"CUT\": {\"layer\": \"cut it\", \"rgb\": [1, 2, 3], \"speed\": 8},"
                               " \"SCORE\": {\"used\": false}}}";
    ax_profile p;
    ax_error error;
    assert_int_equal(ax_profile_parse(text, sizeof text - 1, &p, &error), AX_OK);
    assert_string_equal(p.name, "lab");
    assert_string_equal(p.pens[AX_CUT].layer, "cut it");
    assert_true(p.pens[AX_CUT].rgb[2] == 3 && p.pens[AX_CUT].speed == 8 && !p.pens[AX_SCORE].used);
    assert_string_equal(p.pens[AX_SLIT].layer, "C04 SLIT");
    static const char* const wrong[][2] = {{"[1]", "object"},
                                           {"{\"nam\": \"x\"}", "nam"},
                                           {"{\"base\": \"x\"}", "base"},
                                           {"{\"name\": \"<x>\"}", "name"},
                                           {"{\"operations\": {\"BURN\": {}}}", "BURN"},
                                           {"{\"operations\": {\"CUT\": {\"rgb\": [1, 2]}}}", "CUT"},
                                           {"{\"operations\": {\"CUT\": {\"rgb\": [1, 2, 256]}}}", "rgb"},
                                           {"{\"operations\": {\"CUT\": {\"speed\": 0}}}", "speed"},
                                           {"{\"name\": \"x\", \"name\": \"y\"}", "line 1"},
                                           {"{", "line 1"}};
    for (size_t k = 0; k < sizeof wrong / sizeof *wrong; ++k) {
        assert_int_equal(ax_profile_parse(wrong[k][0], strlen(wrong[k][0]), &p, &error), AX_BAD_INPUT);
        assert_non_null(strstr(error.message, wrong[k][1]));
    }
    int count;
    const ax_profile* all = ax_profiles(&count);
    for (int k = 0; k < count; ++k)
        assert_int_equal(ax_profile_find(all[k].name, &p, &error), AX_OK);
    assert_int_equal(ax_profile_find("nothing", &p, &error), AX_USAGE);
    assert_non_null(strstr(error.message, "lightburn"));
    assert_int_equal(ax_profile_find("/nowhere/p.json", &p, &error), AX_BAD_INPUT);
}

// --- the rest

static void plans_repeat_to_the_last_bit(void** state)
{
    (void)state;
    static const char* const joints[] = {"none", "ring", "pin", "living-hinge"};
    for (int j = 0; j < 4; ++j) {
        ax_fabricate_options o = choose(joints[j], "card-0.5", "900x600", 0.1);
        ax_cut_plan a = make(&sample, &o), b = make(&sample, &o);
        assert_int_equal(a.point_count, b.point_count);
        assert_memory_equal(a.points, b.points, (size_t)a.point_count * sizeof *a.points);
        assert_int_equal(a.item_count, b.item_count);
        for (int i = 0; i < a.item_count; ++i)
            assert_string_equal(a.items[i].name, b.items[i].name);
        ax_cut_plan_free(&a);
        ax_cut_plan_free(&b);
    }
}

static void names_stay_inside_their_panels_or_stand_beside(void** state)
{
    (void)state;
    ax_design small = sample;
    size_t n = (size_t)sample.linkage.hinge_count;
    small.unit = AX_MILLIMETRE;
    small.flat = ax_copy(sample.flat, n, sizeof *sample.flat);
    for (size_t h = 0; h < n; ++h)
        small.flat[h][0] *= 95, small.flat[h][1] *= 95; // edges of 8 to 14 mm
    ax_fabricate_options o = choose("none", "card-0.5", "A4", 0.1);
    o.clearance = false; // the deployed state is not scaled with it
    ax_cut_plan plan = make(&small, &o);
    int inside = 0, beside = 0;
    for (int t = 0; t < plan.panel_count; ++t) {
        inside += plan.panels[t].label_height > 0;
        const ax_cut_item* label = &plan.items[item_of(&plan, "label-%s", plan.panels[t].name, 0)];
        const ax_cut_item* cut = &plan.items[item_of(&plan, "cut-%s", plan.panels[t].name, 0)];
        const ax_cut_point* c = &plan.points[plan.paths[cut->first].first];
        const double corner[3][2] = {{c[0].x, c[0].y}, {c[1].x, c[1].y}, {c[2].x, c[2].y}};
        bool out = false;
        for (int k = label->first; k < label->first + label->count; ++k)
            for (int v = 0; v < plan.paths[k].count; ++v) {
                const ax_cut_point* p = &plan.points[plan.paths[k].first + v];
                const double at[2] = {p->x, p->y};
                for (int e = 0; e < 3; ++e)
                    out = out || ax_orient2(corner[e], corner[(e + 1) % 3], at) < 0;
            }
        beside += out;
        assert_int_equal(out, plan.panels[t].label_height == 0);
    }
    assert_true(inside > 10 && beside > 10);
    assert_int_equal(beside, plan.labels_outside);
    assert_int_equal(plan.labels_dropped, 0);
    ax_cut_plan_free(&plan);
    ax_free(small.flat);
}

static bool stop(void* context, const char* stage, double fraction, double residual)
{
    (void)context, (void)stage, (void)fraction, (void)residual;
    return false;
}

static void it_can_be_cancelled(void** state)
{
    (void)state;
    ax_cut_plan plan;
    ax_error error;
    assert_int_equal(ax_fabricate(&sample, NULL, &(ax_progress){stop, NULL}, &plan, &error), AX_CANCELLED);
    assert_null(plan.points);
}

static void coupons_tell_the_kerf_and_try_hinges(void** state)
{
    (void)state;
    ax_cut_plan plan;
    ax_error error;
    assert_int_equal(ax_fabricate_coupon(AX_COUPON_KERF, NULL, &plan, &error), AX_OK);
    int slits = 0;
    for (int i = 0; i < plan.item_count; ++i)
        slits += plan.items[i].operation == AX_SLIT;
    assert_int_equal(slits, 9);
    const ax_cut_point* p = &plan.points[plan.paths[plan.items[item_of(&plan, "cut", "", 0)].first].first];
    assert_near(p[1].x - p[0].x, 100, 1e-12);
    ax_cut_plan_free(&plan);
    static const char* const joints[] = {"living-hinge", "pin", "ring"};
    for (int j = 0; j < 3; ++j) {
        ax_fabricate_options o = choose(joints[j], "plywood-3", NULL, 0.2);
        if (ax_fabricate_coupon(AX_COUPON_HINGE, &o, &plan, &error) != AX_OK)
            fail_msg("%s", error.message);
        int cuts = 0, labels = 0;
        for (int i = 0; i < plan.item_count; ++i) {
            cuts += plan.items[i].operation == AX_CUT;
            labels += plan.items[i].operation == AX_LABEL;
            check_paths(&plan, &plan.sheets[0], &plan.items[i]);
        }
        assert_int_equal(cuts, j ? 10 : 5);
        assert_int_equal(labels, 5);
        check_lines(&plan, &plan.sheets[0], 0);
        ax_cut_plan_free(&plan);
    }
    ax_fabricate_options none = ax_fabricate_options_default();
    assert_int_equal(ax_fabricate_coupon(AX_COUPON_HINGE, &none, &plan, &error), AX_USAGE);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(bare_triangles_have_the_linkages_edges),
        cmocka_unit_test(rings_and_pins_hinge_panels_at_the_linkages_edges),
        cmocka_unit_test(holes_keep_their_edge_distance),
        cmocka_unit_test(ligaments_have_their_width_and_the_hinge_in_their_middle),
        cmocka_unit_test(nothing_narrower_than_the_ligament_is_left_at_a_hinge),
        cmocka_unit_test(a_ligament_that_would_break_or_is_wide_is_doubted),
        cmocka_unit_test(pieces_fit_their_sheets_and_hold_together),
        cmocka_unit_test(clearance_is_what_turning_the_panels_finds),
        cmocka_unit_test(folded_neighbours_are_told),
        cmocka_unit_test(what_collides_is_named),
        cmocka_unit_test(without_a_load_the_way_is_straight),
        cmocka_unit_test(the_simulated_way_ends_in_the_equilibrium),
        cmocka_unit_test(thick_panels_that_collide_on_the_way_are_named),
        cmocka_unit_test(hinge_forces_stand_beside_what_the_joint_bears),
        cmocka_unit_test(what_does_not_fit_is_refused_by_name),
        cmocka_unit_test(words_choose_or_are_refused),
        cmocka_unit_test(profiles_come_from_json),
        cmocka_unit_test(plans_repeat_to_the_last_bit),
        cmocka_unit_test(names_stay_inside_their_panels_or_stand_beside),
        cmocka_unit_test(it_can_be_cancelled),
        cmocka_unit_test(coupons_tell_the_kerf_and_try_hinges),
    };
    return cmocka_run_group_tests(tests, set_up, tear_down);
}
