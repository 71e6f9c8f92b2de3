// Cut plans, measured by code that knows nothing of how they are made.
#include "ax/fabricate.h"

#include "base/vec.h"
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

static ax_cut_plan make(const ax_design* design, const ax_fabricate_options* options)
{
    ax_cut_plan plan;
    ax_error error;
    if (ax_fabricate(design, options, NULL, &plan, &error) != AX_OK)
        fail_msg("%s", error.message);
    return plan;
}

// All that must hold of every plan.
static void check_plan(const ax_cut_plan* plan)
{
    assert_int_equal(plan->panel_count, sample.linkage.triangle_count);
    assert_true(plan->sheet_count > 0);
    for (int s = 0; s < plan->sheet_count; ++s) {
        const ax_cut_sheet* sheet = &plan->sheets[s];
        assert_true(sheet->count > 0 && sheet->utilisation > 0 && sheet->utilisation < 1);
        for (int i = sheet->first; i < sheet->first + sheet->count; ++i) {
            const ax_cut_item* item = &plan->items[i];
            assert_true(item->count > 0 && item->first + item->count <= plan->path_count);
            assert_true(i == sheet->first || plan->items[i - 1].operation <= item->operation);
            for (int k = item->first; k < item->first + item->count; ++k) {
                const ax_cut_path* path = &plan->paths[k];
                assert_true(path->count >= 2 && path->first + path->count <= plan->point_count);
                for (int v = path->first; v < path->first + path->count; ++v) {
                    const ax_cut_point* p = &plan->points[v];
                    assert_true(p->x > 0 && p->y > 0 && p->x < sheet->width && p->y < sheet->height);
                    assert_at_most(fabs(p->bulge), 1);
                }
            }
        }
    }
}

static void bare_triangles_lie_in_place_at_true_size(void** state)
{
    (void)state;
    ax_cut_plan plan = make(&sample, NULL);
    check_plan(&plan);
    assert_int_equal(plan.sheet_count, 1);
    assert_true(plan.in_place);
    int cuts = 0;
    for (int i = 0; i < plan.item_count; ++i) {
        const ax_cut_item* item = &plan.items[i];
        if (item->operation != AX_CUT)
            continue;
        const ax_cut_point* p = &plan.points[plan.paths[item->first].first];
        const ax_cut_panel* panel = &plan.panels[item->panel];
        assert_int_equal(plan.paths[item->first].count, 3);
        for (int k = 0; k < 3; ++k) {
            const double* at = sample.flat[sample.linkage.triangles[item->panel][k]];
            assert_near(p[k].x, 1000 * at[0] + panel->placement[2], 1e-9);
            assert_near(p[k].y, 1000 * at[1] + panel->placement[3], 1e-9);
        }
        ++cuts;
    }
    assert_int_equal(cuts, sample.linkage.triangle_count);
    assert_near(plan.area, 1e6 * sample.report.panel_area, 1e-3);
    ax_cut_plan_free(&plan);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(bare_triangles_lie_in_place_at_true_size),
    };
    return cmocka_run_group_tests(tests, set_up, tear_down);
}
