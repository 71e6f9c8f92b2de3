// The list of figures is the report, no more and no less.
#include "ax/report.h"

#include "support/test.h"

#include <stdlib.h>
#include <string.h>

static size_t value_size(const ax_figure* figure)
{
    switch (figure->kind) {
    case AX_FIGURE_NUMBER:
        return sizeof(double);
    case AX_FIGURE_COUNT:
        return sizeof(int);
    case AX_FIGURE_FLAG:
        return sizeof(bool);
    }
    return 0;
}

static int by_offset(const void* a, const void* b)
{
    const ax_figure *x = a, *y = b;
    return (x->offset > y->offset) - (x->offset < y->offset);
}

static void every_field_of_the_report_is_a_figure(void** state)
{
    (void)state;
    int count;
    const ax_figure* figures = ax_report_figures(&count);
    ax_figure* sorted = ax_copy(figures, (size_t)count, sizeof *figures);
    qsort(sorted, (size_t)count, sizeof *sorted, by_offset);
    size_t end = 0;
    for (int k = 0; k < count; ++k) {
        size_t size = value_size(&sorted[k]);
        assert_true(sorted[k].offset >= end);       // no two share a place
        assert_true(sorted[k].offset - end < size); // padding at most, or a field is not listed before this one
        end = sorted[k].offset + size * (size_t)sorted[k].count;
    }
    assert_true(sizeof(ax_report) - end < sizeof(double));
    ax_free(sorted);
}

static void figures_are_set_and_read_back(void** state)
{
    (void)state;
    int count;
    const ax_figure* figures = ax_report_figures(&count);
    ax_report report;
    memset(&report, 0, sizeof report);
    for (int k = 0; k < count; ++k)
        for (int i = 0; i < figures[k].count; ++i)
            ax_figure_set(&figures[k], &report, i, figures[k].kind == AX_FIGURE_FLAG ? 1 : 10 * k + i);
    for (int k = 0; k < count; ++k)
        for (int i = 0; i < figures[k].count; ++i)
            assert_near(ax_figure_value(&figures[k], &report, i), figures[k].kind == AX_FIGURE_FLAG ? 1 : 10 * k + i,
                        0);
    assert_true(report.stable);
    assert_near(report.deployed_bounds[1] - report.deployed_bounds[0], 1, 0);
}

static const ax_figure* find(const char* key)
{
    int count;
    const ax_figure* figures = ax_report_figures(&count);
    for (int k = 0; k < count; ++k)
        if (strcmp(figures[k].key, key) == 0)
            return &figures[k];
    fail_msg("no figure is called %s", key);
    return NULL;
}

static void limits_are_judged(void** state)
{
    (void)state;
    ax_design design = {.mouth_min = 2, .border = AX_BORDER_EQUILATERAL, .target.face_count = 1};
    design.report.congruence_max = 1e-12, design.report.mouth_min_deg = 1.9, design.report.force_residual = NAN;
    design.report.rim_max_over_L = 1;
    assert_true(ax_figure_holds(find("congruence_max"), &design));
    assert_false(ax_figure_holds(find("mouth_min_deg"), &design));  // its limit is the design's own
    assert_false(ax_figure_holds(find("force_residual"), &design)); // missing
    assert_false(ax_figure_holds(find("stable"), &design));
    assert_true(ax_figure_holds(find("edge_mean"), &design)); // has no limit
    assert_false(ax_figure_holds(find("rim_max_over_L"), &design));
    design.target.face_count = 0; // found without a target
    assert_true(ax_figure_holds(find("rim_max_over_L"), &design));
    design.target.face_count = 1;
    design.border = AX_BORDER_INSIDE; // whole triangles inside do not reach the boundary
    assert_true(ax_figure_holds(find("rim_max_over_L"), &design));
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(every_field_of_the_report_is_a_figure),
        cmocka_unit_test(figures_are_set_and_read_back),
        cmocka_unit_test(limits_are_judged),
    };
    return cmocka_run_group_tests_name("figures", tests, NULL, NULL);
}
