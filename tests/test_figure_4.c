// The paper's figure 4 as a recipe: each stage has the property that it shows.
#include "ax/recipe.h"

#include "base/vec.h"
#include "support/test.h"

#include <jansson.h>
#include <stdlib.h>
#include <string.h>

typedef struct run {
    const ax_recipe* recipe;
    int stages;
} run;

static const double (*places(const ax_form_view* v))[3]
{
    return v->simulated ? v->simulated : v->deployed;
}

static double depth(const ax_form_view* v)
{
    double lo = INFINITY, hi = -INFINITY;
    for (int h = 0; h < v->linkage->hinge_count; ++h) {
        lo = fmin(lo, places(v)[h][2]);
        hi = fmax(hi, places(v)[h][2]);
    }
    return hi - lo;
}

// Share of panels that look down.
static double turned_over(const ax_form_view* v)
{
    int down = 0;
    for (int t = 0; t < v->linkage->triangle_count; ++t) {
        const int* c = v->linkage->triangles[t];
        down += ax_orient2(places(v)[c[0]], places(v)[c[1]], places(v)[c[2]]) < 0;
    }
    return (double)down / v->linkage->triangle_count;
}

// Root mean square of what heights differ from a round bowl, over the depth: in each ring about the middle, from a line over radius.
static double unevenness(const ax_form_view* v)
{
    enum { RINGS = 12 };
    double sums[RINGS][5] = {{0}}, reach = 0, squares = 0; // of 1, r, r^2, z, r z
    int n = v->linkage->hinge_count;
    for (int h = 0; h < n; ++h)
        reach = fmax(reach, hypot(places(v)[h][0], places(v)[h][1]));
    for (int pass = 0; pass < 2; ++pass)
        for (int h = 0; h < n; ++h) {
            double r = hypot(places(v)[h][0], places(v)[h][1]) / reach, z = places(v)[h][2];
            double* s = sums[(int)fmin(RINGS * r, RINGS - 1)];
            const double terms[5] = {1, r, r * r, z, r * z};
            for (int k = 0; k < 5 && pass == 0; ++k)
                s[k] += terms[k];
            double slope = (s[0] * s[4] - s[1] * s[3]) / (s[0] * s[2] - s[1] * s[1]);
            double off = z - (s[3] + slope * (s[0] * r - s[1])) / s[0];
            squares += pass ? off * off / n : 0;
        }
    return sqrt(squares) / depth(v);
}

static void check_stage(int stage, ax_form* form)
{
    ax_form_view v = ax_form_look(form);
    ax_form_report r;
    ax_form_measure(form, &r);
    assert_true(r.settled);
    assert_int_equal(r.flipped, 0);
    assert_int_equal(r.overlap_pairs, 0);
    double down = turned_over(&v), deep = depth(&v);
    print_message("stage %d: depth %.3f, %.1f %% look down, smallest mouth %.1f degrees, growth %.3f\n", stage, deep,
                  100 * down, r.mouth_min * 180 / AX_PI, r.growth);
    switch (stage) {
    case 1: // expanded in the plane, so that nothing overlaps
        assert_true(r.growth > 1.03 && r.growth < 1.3);
        assert_at_most(r.flat_error, 1e-2);
        assert_true(r.mouth_min > 0);
        assert_near(deep, 0, 1e-9);
        assert_true(r.realised_max < 1.9); // resolving overlaps lowers the scale factors
        break;
    case 2: // it hangs from a rim that stays in place
        assert_true(deep > 0.6 && deep < 1.1);
        assert_int_equal(r.held_count, 1);
        assert_at_most(r.held[0].residual, 1e-9);
        assert_at_most(r.simulated_error, 1e-2);
        assert_at_most(down, 0.005);
        break;
    case 3: // fully open, and no height field
        assert_true(r.opening_mean > 0.98);
        assert_true(down > 0.05);
        assert_true(r.curvature_max > 2 * AX_PI);
        break;
    case 4: // a height field, still fully open
        assert_true(r.opening_min > 0.98);
        assert_true(down == 0);
        assert_true(r.curvature_max < 2 * AX_PI);
        assert_true(deep > 0.5 && deep < 0.9);
        break;
    case 5: // a smooth round bowl on the circle
        assert_true(down == 0);
        assert_true(r.opening_mean > 0.99);
        for (int h = 0; h < v.linkage->hinge_count; ++h)
            if (v.linkage->on_rim[h]) {
                assert_near(sqrt(v.simulated[h][0] * v.simulated[h][0] + v.simulated[h][1] * v.simulated[h][1]), 1.15,
                            1e-3);
                assert_near(v.simulated[h][2], 0, 1e-3);
            }
        assert_at_most(unevenness(&v), 0.02);
        break;
    default:
        fail_msg("there is no stage %d", stage);
    }
    ax_form_report_free(&r);
}

static bool after(void* context, int k, ax_form* form)
{
    run* now = context;
    json_t* operator= json_loads(ax_recipe_operator(now->recipe, k), 0, NULL);
    const char* note = json_string_value(json_object_get(operator, "note"));
    if (note && strncmp(note, "Stage ", 6) == 0) {
        assert_int_equal(atoi(note + 6), ++now->stages);
        check_stage(now->stages, form);
    }
    json_decref(operator);
    return true;
}

static void every_stage_shows_what_the_figure_shows(void** state)
{
    (void)state;
    ax_recipe* recipe;
    ax_form* form;
    ax_error error = {0};
    int done;
    if (ax_recipe_read(AX_SOURCE_DIR "/examples/figure-4.json", &recipe, &error) != AX_OK)
        fail_msg("%s", error.message);
    run now = {.recipe = recipe};
    int until = getenv("AX_QUICK") ? 3 : -1;
    assert_int_equal(ax_recipe_play(recipe, until, ".", NULL, after, &now, &form, &done, &error), AX_OK);
    assert_int_equal(now.stages, until < 0 ? 5 : 1);
    ax_form_free(form);
    ax_recipe_free(recipe);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(every_stage_shows_what_the_figure_shows),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
