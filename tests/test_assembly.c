// The order of joining and the frame, judged by what people need: whatever is added hangs on what is there, and a template has the
// supports' distances.
#include "ax/assembly.h"

#include "base/vec.h"
#include "linkage/lattice.h"
#include "support/sample.h"
#include "support/test.h"

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

static ax_cut_plan make(const char* joint, const char* sheet)
{
    ax_fabricate_options o = ax_fabricate_options_default();
    ax_cut_plan plan = {0};
    ax_error error;
    o.clearance = false;
    if (ax_fabricate_set_joint(&o, joint, &error) != AX_OK ||
        ax_fabricate_set_material(&o, "polypropylene-0.8", &error) != AX_OK ||
        (sheet && ax_fabricate_set_sheet(&o, sheet, &error) != AX_OK) ||
        ax_fabricate(&sample, &o, NULL, &plan, &error) != AX_OK)
        fail_msg("%s", error.message);
    return plan;
}

// Hinges between a panel and those marked.
static int hinges_to(const ax_cut_plan* plan, int panel, const bool* marked)
{
    int count = 0;
    for (int k = 0; k < plan->hinge_count; ++k)
        for (int s = 0; s < 2; ++s)
            count += plan->hinges[k].panels[s] == panel && marked[plan->hinges[k].panels[!s]];
    return count;
}

static void check_order(const ax_cut_plan* plan, const ax_assembly* a)
{
    bool* before = AX_NEW0(bool, plan->panel_count);  // of earlier steps
    bool* present = AX_NEW0(bool, plan->panel_count); // as well as of this one
    int place = 0, hinges = 0;
    assert_int_equal(a->panel_count, plan->panel_count);
    for (int s = 0; s < a->step_count; ++s) {
        const ax_assembly_step* step = &a->steps[s];
        int within = 0, joined = 0;
        assert_int_equal(step->first, place);
        assert_true(step->count > 0);
        for (int i = step->first; i < step->first + step->count; ++i, ++place) {
            int t = a->order[i], here = hinges_to(plan, t, present);
            assert_false(present[t]);
            assert_int_equal(a->step_of[t], s);
            if (!a->by_pieces) {
                assert_int_equal(plan->panels[t].row, step->row);
                assert_true(i == 0 || here > 0); // hangs on what is there
                within += here - hinges_to(plan, t, before);
            } else {
                assert_int_equal(plan->panels[t].piece, step->piece);
            }
            joined += hinges_to(plan, t, before);
            present[t] = true;
        }
        assert_int_equal(step->hinges_within, within);
        assert_int_equal(step->hinges_before, joined);
        assert_true(s == 0 || joined > 0);
        hinges += within + joined;
        memcpy(before, present, (size_t)plan->panel_count * sizeof *before);
    }
    assert_int_equal(place, plan->panel_count);
    assert_int_equal(hinges, a->by_pieces ? plan->seam_count : plan->hinge_count);
    ax_free(before);
    ax_free(present);
}

static void rows_are_joined_one_by_one(void** state)
{
    (void)state;
    ax_cut_plan plan = make("none", NULL);
    ax_assembly a = ax_assembly_make(&sample, &plan);
    check_order(&plan, &a);
    assert_false(a.by_pieces);
    for (int s = 1; s < a.step_count; ++s) // a cap has no row in two parts
        assert_int_equal(abs(a.steps[s].row - a.steps[s - 1].row), 1);
    int first = a.steps[0].count, last = a.steps[a.step_count - 1].count;
    assert_true(first >= last);
    // places count up along the rows
    for (int k = 0; k < plan.hinge_count; ++k) {
        const int* p[2];
        double x[2];
        for (int s = 0; s < 2; ++s) {
            int t = plan.hinges[k].panels[s];
            p[s] = sample.linkage.panels[t];
            x[s] = 0;
            for (int c = 0; c < 3; ++c)
                for (int d = 0; d < 2; ++d)
                    x[s] += a.along[d] * sample.flat[sample.linkage.triangles[t][c]][d];
        }
        if (p[0][1] == p[1][1])
            assert_true((2 * p[0][0] + p[0][2] < 2 * p[1][0] + p[1][2]) == (x[0] < x[1]));
    }
    ax_assembly_free(&a);
    ax_cut_plan_free(&plan);
}

static void rows_in_two_parts_wait_until_something_reaches_them(void** state)
{
    (void)state;
    // Rows beyond the third are one: below, a wall of panels is moved to a row of its own, so that rows 0 to 2 fall in two.
    ax_cut_plan plan = make("none", NULL);
    int lo = plan.panels[0].row, hi = lo, *middle = AX_NEW0(int, 1000), *count = AX_NEW0(int, 1000);
    for (int t = 0; t < plan.panel_count; ++t) {
        lo = plan.panels[t].row < lo ? plan.panels[t].row : lo;
        hi = plan.panels[t].row > hi ? plan.panels[t].row : hi;
    }
    for (int t = 0; t < plan.panel_count; ++t) {
        middle[plan.panels[t].row - lo] += 2 * sample.linkage.panels[t][0] + sample.linkage.panels[t][2];
        ++count[plan.panels[t].row - lo];
    }
    for (int t = 0; t < plan.panel_count; ++t) {
        int row = plan.panels[t].row - lo, place = 2 * sample.linkage.panels[t][0] + sample.linkage.panels[t][2];
        if (row < 3 && abs(place - middle[row] / count[row]) < 2)
            plan.panels[t].row = hi + 1;
    }
    ax_assembly a = ax_assembly_make(&sample, &plan);
    check_order(&plan, &a);
    int parts = 0;
    for (int s = 0; s < a.step_count; ++s)
        parts += a.steps[s].row < lo + 3;
    assert_true(parts >= 5);
    ax_assembly_free(&a);
    ax_cut_plan_free(&plan);
    ax_free(middle);
    ax_free(count);
}

static void pieces_are_joined_at_their_seams(void** state)
{
    (void)state;
    ax_cut_plan plan = make("living-hinge", "900x600");
    assert_true(plan.seam_count > 0);
    ax_assembly a = ax_assembly_make(&sample, &plan);
    assert_true(a.by_pieces && a.step_count > 1);
    check_order(&plan, &a);
    ax_assembly_free(&a);
    ax_cut_plan_free(&plan);
}

static void the_rim_of_a_cap_is_a_circle(void** state)
{
    (void)state;
    ax_support_frame f = ax_frame_of(&sample);
    assert_int_equal(f.curve_count, 1);
    const ax_frame_curve* c = &f.curves[0];
    double far = 0;
    for (int k = 0; k < sample.target.vertex_count; ++k)
        far = fmax(far, hypot(sample.target.positions[k][0], sample.target.positions[k][1]));
    assert_true(c->closed && c->planar && c->circle);
    // the rim is a polygon of the mesh's edges
    assert_near(c->radius, 1000 * far, 0.01 * c->radius);
    assert_near(fabs(c->axes[2][2]), 1, 1e-6);
    double sum = 0;
    for (int k = 0; k < c->count; ++k) {
        const ax_frame_point *p = &f.points[k], *q = &f.points[(k + 1) % c->count];
        double at[3], chord = 1000 * ax_distance3(sample.deployed[p->hinge], sample.deployed[q->hinge]);
        assert_near(p->chord, chord, 1e-9 * chord);
        assert_near(p->along, sum, 1e-6);
        assert_near(p->radius, c->radius, 0.05 * c->radius);
        assert_true(sample.supports[p->hinge]);
        sum += chord;
        // the smooth curve passes the supports, and bulges as the circle does
        ax_frame_at(&f, c, k, 0, at);
        assert_near(ax_distance3(at, p->place), 0, 1e-9);
        ax_frame_at(&f, c, k, 1, at);
        assert_near(ax_distance3(at, q->place), 0, 1e-9);
        ax_frame_at(&f, c, k, 0.5, at);
        assert_near(ax_distance3(at, c->centre), c->radius,
                    0.1 * (c->radius - sqrt(c->radius * c->radius - chord * chord / 4)) + 0.5);
    }
    assert_near(c->length, sum, 1e-6);
    ax_frame_free(&f);
}

static void supports_that_leave_a_gap_make_an_open_curve(void** state)
{
    (void)state;
    int* rim = AX_NEW(int, sample.linkage.hinge_count);
    int around = ax_linkage_rim(&sample.linkage, rim);
    ax_design design = sample;
    design.supports = AX_NEW0(unsigned char, sample.linkage.hinge_count);
    // two arches: one across the start of the rim's order; and one hinge inside
    int inside = 0;
    while (sample.linkage.on_rim[inside])
        ++inside;
    design.supports[inside] = 1;
    for (int k = 0; k < 4; ++k)
        design.supports[rim[(around - 2 + k) % around]] = design.supports[rim[around / 2 + k]] = 1;
    ax_support_frame f = ax_frame_of(&design);
    assert_int_equal(f.curve_count, 3);
    assert_int_equal(f.point_count, 9);
    for (int k = 0; k < 2; ++k) {
        assert_int_equal(f.curves[k].count, 4);
        assert_false(f.curves[k].closed);
        assert_true(isnan(f.points[f.curves[k].first + 3].chord));
        assert_true(isnan(f.points[f.curves[k].first].radius));
        assert_false(isnan(f.points[f.curves[k].first + 1].radius));
    }
    assert_int_equal(f.curves[2].count, 1);
    assert_int_equal(f.points[8].hinge, inside);
    // alone it is no frame
    memset(design.supports, 0, (size_t)sample.linkage.hinge_count);
    design.supports[inside] = 1;
    ax_support_frame single = ax_frame_of(&design);
    ax_cut_plan plan;
    ax_error error;
    assert_int_equal(ax_frame_plan(&design, &single, NULL, &plan, &error), AX_BAD_INPUT);
    ax_frame_free(&single);
    ax_frame_free(&f);
    ax_free(design.supports);
    ax_free(rim);
}

// Whether a hinge lies on the kagome line between two strips of panels, in one of two directions.
static bool is_on_line(const int (*panels)[3], const int held[2], int direction, int strip)
{
    if (held[1] < 0)
        return false;
    const int *p = panels[held[0]], *q = panels[held[1]];
    int a = p[1 - direction] + p[2], b = q[1 - direction] + q[2];
    return a != b && (a < b ? a : b) == strip;
}

static void supports_across_the_shell_are_arches(void** state)
{
    (void)state;
    const ax_linkage* l = &sample.linkage;
    ax_design design = sample;
    int(*held)[2] = ax_linkage_hinge_triangles(l), strip[2], counts[2] = {0, 0}, supports = 0;
    design.supports = ax_copy(sample.supports, (size_t)l->hinge_count, 1);
    int top = 0; // two lines through the strips of the panel in the middle, which cross
    for (int h = 0; h < l->hinge_count; ++h)
        top = sample.deployed[h][2] > sample.deployed[top][2] ? h : top;
    for (int k = 0; k < 2; ++k)
        strip[k] = l->panels[held[top][0]][1 - k] + l->panels[held[top][0]][2];
    for (int h = 0; h < l->hinge_count; ++h) {
        for (int k = 0; k < 2; ++k)
            if (is_on_line((const int(*)[3])l->panels, held[h], k, strip[k]))
                design.supports[h] = 1, ++counts[k];
        supports += design.supports[h];
    }
    ax_support_frame f = ax_frame_of(&design);
    assert_int_equal(f.support_count, supports);
    assert_int_equal(f.curve_count, 3);
    assert_false(f.curves[0].arch);
    for (int k = 1; k < 3; ++k) {
        const ax_frame_curve* c = &f.curves[k];
        assert_true(c->arch && !c->closed);
        int direction = 0, inside = 0;
        const int* second = held[f.points[c->first + 1].hinge];
        if (!is_on_line((const int(*)[3])l->panels, second, 0, strip[0]))
            direction = 1;
        for (int i = 0; i < c->count; ++i) {
            int h = f.points[c->first + i].hinge;
            assert_true(l->on_rim[h] ? i == 0 || i + 1 == c->count
                                     : is_on_line((const int(*)[3])l->panels, held[h], direction, strip[direction]));
            inside += !l->on_rim[h];
        }
        assert_int_equal(inside, counts[direction]);
        assert_true(l->on_rim[f.points[c->first].hinge] && l->on_rim[f.points[c->first + c->count - 1].hinge]);
        if (c->planar) { // stands as it is drawn
            assert_near(c->axes[0][2], 0, 1e-12);
            assert_true(c->axes[1][2] > 0.7);
        }
    }
    ax_frame_free(&f);
    ax_free(design.supports);
    ax_free(held);
}

static void a_frame_in_space_is_unrolled(void** state)
{
    (void)state;
    ax_design design = sample;
    size_t n = (size_t)sample.linkage.hinge_count;
    design.deployed = ax_copy(sample.deployed, n, sizeof *sample.deployed);
    for (size_t h = 0; h < n; ++h)
        design.deployed[h][2] += 0.1 * design.deployed[h][0] * design.deployed[h][1];
    ax_support_frame f = ax_frame_of(&design);
    ax_cut_plan plan;
    ax_error error;
    assert_false(f.curves[0].planar);
    assert_true(f.curves[0].off_plane > 10);
    assert_int_equal(ax_frame_plan(&design, &f, "sample", &plan, &error), AX_OK);
    int curves = 0;
    for (int i = 0; i < plan.item_count; ++i) {
        if (plan.items[i].operation != AX_CUT)
            continue;
        const ax_cut_path* path = &plan.paths[plan.items[i].first];
        const ax_cut_point* p = plan.points + path->first;
        assert_int_equal(path->closed, curves == 0);
        if (curves++ == 1) { // unrolled: as long as it is seen from above, as high as the hinges
            double lo = INFINITY, hi = -INFINITY, low = INFINITY, high = -INFINITY;
            for (int k = 0; k < path->count; ++k)
                lo = fmin(lo, p[k].y), hi = fmax(hi, p[k].y);
            for (int k = 0; k < f.point_count; ++k)
                low = fmin(low, f.points[k].place[2]), high = fmax(high, f.points[k].place[2]);
            assert_near(p[path->count - 1].x - p[0].x, f.curves[0].plan, 1e-6 * f.curves[0].plan);
            assert_near(hi - lo, high - low, 0.05 * (high - low));
        }
    }
    assert_int_equal(curves, 2);
    for (int k = 0; k < plan.point_count; ++k) { // all within the sheet
        assert_true(plan.points[k].x >= 0 && plan.points[k].x <= plan.sheets[0].width);
        assert_true(plan.points[k].y >= 0 && plan.points[k].y <= plan.sheets[0].height);
    }
    ax_cut_plan_free(&plan);
    ax_frame_free(&f);
    ax_free(design.deployed);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(rows_are_joined_one_by_one),
        cmocka_unit_test(rows_in_two_parts_wait_until_something_reaches_them),
        cmocka_unit_test(pieces_are_joined_at_their_seams),
        cmocka_unit_test(the_rim_of_a_cap_is_a_circle),
        cmocka_unit_test(supports_that_leave_a_gap_make_an_open_curve),
        cmocka_unit_test(supports_across_the_shell_are_arches),
        cmocka_unit_test(a_frame_in_space_is_unrolled),
    };
    return cmocka_run_group_tests(tests, set_up, tear_down);
}
