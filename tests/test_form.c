// The engine of form-finding: what the states must satisfy whatever is asked, and the stages of the paper's figure 4.
#include "support/test.h"

#include "ax/form.h"

#include "ax/linkage.h"
#include "base/vec.h"
#include "support/sample.h"

#include <math.h>
#include <string.h>

enum { SIDES = 96 };

static ax_form* polygon(int sides, int triangles, double scale)
{
    double outline[SIDES][2];
    for (int k = 0; k < sides; ++k)
        outline[k][0] = cos(2 * AX_PI * k / sides), outline[k][1] = sin(2 * AX_PI * k / sides);
    ax_form_start start = {.outline_count = sides,
                           .outline = (const double(*)[2])outline,
                           .triangles = triangles,
                           .scale = scale,
                           .unit = AX_METRE};
    ax_form* form;
    ax_error error;
    assert_int_equal(ax_form_make(&start, &form, &error), AX_OK);
    return form;
}

static ax_form* disk(int triangles, double scale)
{
    return polygon(SIDES, triangles, scale);
}

// Prescribes scale(r) of the distance from the middle.
static void paint(ax_form* form, double (*scale)(double r))
{
    ax_form_view view = ax_form_look(form);
    double* values = AX_NEW(double, view.linkage->triangle_count);
    for (int t = 0; t < view.linkage->triangle_count; ++t) {
        double middle[2] = {0, 0};
        for (int k = 0; k < 3; ++k)
            for (int c = 0; c < 2; ++c)
                middle[c] += view.sheet[view.linkage->triangles[t][k]][c] / 3;
        values[t] = scale(sqrt(middle[0] * middle[0] + middle[1] * middle[1]));
    }
    ax_form_prescribe(form, values);
    ax_free(values);
}

static double jump(double r)
{
    return r < 0.5 ? 1.9 : 1.2;
}

static double sphere(double r) // constant curvature
{
    return 1.7 / (1 + 0.35 * r * r);
}

static void settle(ax_form* form)
{
    ax_error error;
    assert_int_equal(ax_form_settle(form, 0, NULL, &error), AX_OK);
}

static ax_form_report measured(ax_form* form)
{
    ax_form_report report;
    ax_form_measure(form, &report);
    return report;
}

static void set_dynamics(ax_form* form, ax_dynamics_kind kind, double give)
{
    ax_form_dynamics dynamics = ax_form_dynamics_default();
    dynamics.kind = kind;
    dynamics.give = give;
    dynamics.adapt = give > 0 || kind == AX_DYNAMICS_EXPAND;
    dynamics.load.kind = kind == AX_DYNAMICS_GRAVITY     ? AX_LOAD_GRAVITY
                         : kind == AX_DYNAMICS_INFLATION ? AX_LOAD_INFLATION
                                                         : AX_LOAD_NONE;
    ax_form_set_dynamics(form, &dynamics);
}

static void slide_on_circle(ax_form* form, double radius)
{
    ax_form_view view = ax_form_look(form);
    int *rim = AX_NEW(int, view.linkage->hinge_count), count = 0;
    for (int h = 0; h < view.linkage->hinge_count; ++h)
        if (view.linkage->on_rim[h])
            rim[count++] = h;
    double circle[3][3] = {{0, 0, 0}, {0, 0, 1}, {radius, 0, 0}};
    ax_rim_part part = {
        .kind = AX_RIM_SLIDE,
        .count = count,
        .hinges = rim,
        .curve = {.kind = AX_CURVE_CIRCLE, .closed = true, .count = 3, .points = (const double(*)[3])circle}};
    ax_error error;
    assert_int_equal(ax_form_set_rim(form, 1, &part, &error), AX_OK);
    ax_free(rim);
}

static void uniform_sheets_open_flat_and_stop_at_lambda(void** state)
{
    (void)state;
    for (int k = 0; k < 3; ++k) {
        double lambda[3] = {1.1, 1.4, 1.8};
        ax_form* form = disk(300, lambda[k]);
        ax_form_report start = measured(form);
        assert_near(start.realised_min, lambda[k], 1e-12);
        assert_near(start.realised_max, lambda[k], 1e-12);
        assert_at_most(start.flat_error, 1e-12);
        // fully open every length has grown by lambda, in all directions alike
        ax_form_view view = ax_form_look(form);
        for (int h = 1; h < view.linkage->hinge_count; h += 17) {
            double flat = ax_distance2(view.sheet[h], view.sheet[0]);
            assert_near(ax_distance3(view.deployed[h], view.deployed[0]) / flat, lambda[k], 1e-12);
        }
        ax_form_report_free(&start);
        ax_form_free(form);
    }
}

// Amplitude of the waves, up to eight round a regular polygon of radius 1, of the rim's distance from it.
static double waves_about_polygon(ax_form* form, int sides)
{
    enum { WAVES = 9 };
    ax_form_view view = ax_form_look(form);
    int *rim = AX_NEW(int, view.linkage->hinge_count), count = ax_linkage_rim(view.linkage, rim);
    double wave[WAVES][2] = {{0}}, sum = 0;
    for (int k = 0; k < count; ++k) {
        const double *at = view.sheet[rim[k]], *before = view.sheet[rim[(k + count - 1) % count]],
                     *after = view.sheet[rim[(k + 1) % count]];
        double angle = atan2(at[1], at[0]), step = 2 * AX_PI / sides;
        double share = remainder(atan2(after[1], after[0]) - atan2(before[1], before[0]), 2 * AX_PI) / (4 * AX_PI);
        double within = angle - step * floor(angle / step) - step / 2; // of a side, from its middle
        double depth = cos(step / 2) / cos(within) - hypot(at[0], at[1]);
        for (int w = 0; w < WAVES; ++w) {
            wave[w][0] += (w ? 2 : 1) * share * depth * cos(w * angle);
            wave[w][1] += (w ? 2 : 1) * share * depth * sin(w * angle);
        }
    }
    for (int w = 0; w < WAVES; ++w)
        sum += wave[w][0] * wave[w][0] + wave[w][1] * wave[w][1];
    ax_free(rim);
    return sqrt(sum);
}

// Least and most mean edge of the panels of the sheet, over half its spacing.
static void sizes_of_panels(ax_form* form, double* least, double* most)
{
    ax_form_view view = ax_form_look(form);
    *least = INFINITY, *most = 0;
    for (int t = 0; t < view.linkage->triangle_count; ++t) {
        const int* h = view.linkage->triangles[t];
        double around = 0;
        for (int k = 0; k < 3; ++k)
            around += ax_distance2(view.sheet[h[k]], view.sheet[h[(k + 1) % 3]]);
        *least = fmin(*least, around / (1.5 * view.spacing)), *most = fmax(*most, around / (1.5 * view.spacing));
    }
}

static void sheets_keep_to_corners_and_round_ones_have_panels_of_one_size(void** state)
{
    (void)state;
    static const double left[9] = {
        [5] = 0.0135, [6] = 1e-3, [7] = 0.005, [8] = 0.015}; // 0.016, 0, 0.009, 0.017 by whole panels
    for (int sides = 5; sides <= 8; ++sides)
        for (int triangles = 600; triangles <= 2400; triangles *= 4) {
            ax_form* form = polygon(sides, triangles, 1.3);
            double least, most;
            sizes_of_panels(form, &least, &most);
            assert_at_most(most, 1.055); // 5 % by the border, a little by the proportions
            assert_at_most(0.945, least);
            if (sides == 6)
                assert_near(most / least, 1, 1e-9);
            assert_at_most(waves_about_polygon(form, sides), triangles == 600 ? left[sides] : 0.0035);
            ax_form_free(form);
        }
    ax_form* form = disk(600, 1.3);
    double least, most;
    sizes_of_panels(form, &least, &most);
    assert_near(most / least, 1, 1e-9);
    ax_form_free(form);

    // a corner that is given twice has a side of no length, and no normal
    const double twice[6][2] = {{-1, -0.7}, {1, -0.7}, {0.6, 0.7}, {0.6, 0.7}, {-0.6, 0.7}, {-0.6, 0.7}};
    ax_form_start start = {.outline_count = 6, .outline = twice, .triangles = 600, .scale = 1.3, .unit = AX_METRE};
    ax_error error;
    assert_int_equal(ax_form_make(&start, &form, &error), AX_OK);
    sizes_of_panels(form, &least, &most);
    assert_true(least > 0.9 && most < 1.1);
    ax_form_free(form);
}

static void painted_spheres_expand_to_spheres(void** state)
{
    (void)state;
    ax_form* form = disk(600, 1.2);
    paint(form, sphere);
    set_dynamics(form, AX_DYNAMICS_EXPAND, 0);
    settle(form);
    ax_form_report r = measured(form);
    assert_true(r.settled);
    assert_at_most(r.flat_error, 1e-3);
    assert_at_most(r.deployed_error, 1e-3);
    assert_int_equal(r.overlap_pairs + r.flipped, 0);
    assert_true(r.opening_min > 0.99);
    assert_at_most(r.overhang, 0);
    // lambda = l / (1 + k r^2) is a sphere of radius R = l / (2 sqrt k), and r its polar angle 2 atan(sqrt(k) r): the cap's height
    ax_form_view view = ax_form_look(form);
    double radius = 1.7 / (2 * sqrt(0.35)), lo = INFINITY, hi = -INFINITY, sheet = 0;
    for (int h = 0; h < view.linkage->hinge_count; ++h) {
        lo = fmin(lo, view.deployed[h][2]), hi = fmax(hi, view.deployed[h][2]);
        sheet = fmax(sheet, hypot(view.sheet[h][0], view.sheet[h][1]));
    }
    assert_near((hi - lo) / (radius * (1 - cos(2 * atan(sqrt(0.35) * sheet)))), 1, 0.03);
    ax_form_report_free(&r);
    ax_form_free(form);
}

static void stages_of_figure_4(void** state)
{
    (void)state;
    ax_form* form = disk(600, 1.3);
    paint(form, jump);
    ax_form_dynamics dynamics = ax_form_dynamics_default();
    dynamics.collisions = true;
    ax_form_set_dynamics(form, &dynamics);
    settle(form);
    ax_form_report r = measured(form);
    assert_true(r.growth > 1.05); // the sheet had to grow
    assert_int_equal(r.overlap_pairs, 0);
    assert_true(r.curvature_max > 2 * AX_PI);
    assert_true(r.scale_off_max > 0.1);
    ax_form_report_free(&r);

    set_dynamics(form, AX_DYNAMICS_EXPAND, 0);
    settle(form);
    r = measured(form);
    assert_true(r.overhang > 0.02); // a bulb
    ax_form_report_free(&r);

    paint(form, sphere);
    set_dynamics(form, AX_DYNAMICS_EXPAND, 3);
    settle(form);
    r = measured(form);
    assert_true(r.settled && r.overhang == 0); // a height field
    ax_form_report_free(&r);

    slide_on_circle(form, 1.2);
    set_dynamics(form, AX_DYNAMICS_GRAVITY, 3);
    settle(form);
    r = measured(form);
    assert_true(r.settled);
    assert_int_equal(r.held_count, 1);
    assert_at_most(r.held[0].residual, 1e-4);
    assert_at_most(r.simulated_rms, 0.3);
    ax_form_report_free(&r);

    // exact, and proven
    ax_design design;
    ax_finish finish;
    ax_error error;
    assert_int_equal(ax_form_finish(form, NULL, &design, &finish, &error), AX_OK);
    assert_true(finish.exact);
    assert_at_most(finish.deployed_moved_rms, 0.1);
    assert_at_most(design.report.congruence_max, 1e-9);
    assert_int_equal(design.report.overlap_pairs, 0);
    assert_at_most(design.report.force_residual, 1e-9);
    r = measured(form);
    assert_true(r.exact);
    assert_at_most(r.held[0].residual, 1e-10);
    ax_form_report_free(&r);
    ax_design_free(&design);
    ax_form_free(form);
}

static void stored_forms_go_on_with_the_same_bits(void** state)
{
    (void)state;
    ax_form* form = disk(200, 1.2);
    paint(form, sphere);
    slide_on_circle(form, 1.3);
    set_dynamics(form, AX_DYNAMICS_INFLATION, 3);
    ax_form_dynamics adopting = *ax_form_get_dynamics(form);
    adopting.adopt = true;
    ax_form_set_dynamics(form, &adopting);
    int some[3] = {3, 14, 15};
    ax_form_name_selection(form, "some", 3, some);
    ax_form_constraint plane = {.name = "arch", .kind = AX_HELD_PLANE, .count = 20, .weight = 1};
    int arch[20];
    for (int k = 0; k < 20; ++k)
        arch[k] = 5 * k;
    plane.hinges = arch;
    ax_error error;
    assert_int_equal(ax_form_put_constraint(form, &plane, &error), AX_OK);
    ax_form_iterate(form, 40);
    size_t size, again;
    void *bytes = ax_form_save(form, &size), *copy = NULL;
    ax_form* other;
    assert_int_equal(ax_form_load(bytes, size, &other, &error), AX_OK);
    copy = ax_form_save(other, &again);
    assert_int_equal(size, again);
    assert_memory_equal(bytes, copy, size);
    for (int threads = 3; threads > 0; threads -= 2) { // also where the number of threads changes on the way
        ax_form_use_threads(other, threads);
        ax_form_iterate(form, 30);
        ax_form_iterate(other, 30);
    }
    size_t n = (size_t)ax_form_look(form).linkage->hinge_count;
    assert_memory_equal(ax_form_look(form).simulated, ax_form_look(other).simulated, n * 3 * sizeof(double));
    assert_memory_equal(ax_form_look(form).flat, ax_form_look(other).flat, n * 2 * sizeof(double));
    int count;
    assert_memory_equal(ax_form_selection(other, "some", &count), some, sizeof some);
    assert_true(ax_form_get_dynamics(other)->adopt);

    // damage is noticed wherever it is
    for (size_t k = 0; k < size; k += size / 37) {
        ((unsigned char*)bytes)[k] ^= 0x10;
        ax_form* bad;
        assert_int_equal(ax_form_load(bytes, size, &bad, &error), AX_BAD_INPUT);
        assert_null(bad);
        ((unsigned char*)bytes)[k] ^= 0x10;
    }
    ax_free(bytes);
    ax_free(copy);
    ax_form_free(form);
    ax_form_free(other);
}

static bool stop(void* context, const char* stage, double fraction, double residual)
{
    (void)stage, (void)fraction, (void)residual;
    return --*(int*)context > 0;
}

static void a_cancelled_settle_changes_nothing(void** state)
{
    (void)state;
    for (int triangles = 200; triangles <= 1200; triangles += 1000) { // of 1,200 a coarser sheet settles first
        ax_form* form = disk(triangles, 1.2);
        paint(form, sphere);
        set_dynamics(form, AX_DYNAMICS_EXPAND, 3);
        ax_form_iterate(form, 10);
        size_t n = (size_t)ax_form_look(form).linkage->hinge_count;
        double(*before)[3] = ax_copy(ax_form_look(form).deployed, n, sizeof *before);
        int calls = 3;
        ax_progress progress = {stop, &calls};
        ax_error error;
        assert_int_equal(ax_form_settle(form, 0, &progress, &error), AX_CANCELLED);
        assert_memory_equal(ax_form_look(form).deployed, before, n * sizeof *before);
        ax_free(before);
        ax_form_free(form);
    }
}

// Every kind of constraint is missed before it is asked and kept after.
static double height_of(int count, const double (*places)[3])
{
    double lo = INFINITY, hi = -INFINITY;
    for (int h = 0; h < count; ++h)
        lo = fmin(lo, places[h][2]), hi = fmax(hi, places[h][2]);
    return hi - lo;
}

static void a_loaded_form_deploys_in_time(void** state)
{
    (void)state;
    ax_form* form = disk(600, 1.2);
    paint(form, sphere);
    slide_on_circle(form, 1.1);
    set_dynamics(form, AX_DYNAMICS_EXPAND, 3);
    assert_null(ax_form_motion_make(form));
    set_dynamics(form, AX_DYNAMICS_INFLATION, 3);
    settle(form);
    ax_form_view view = ax_form_look(form);
    int n = view.linkage->hinge_count;
    double whole = height_of(n, view.simulated), before = 0, furthest = 0;
    ax_form_motion* motion = ax_form_motion_make(form);
    for (int k = 0; k <= 48; ++k) {
        const double(*places)[3] = ax_form_motion_to(motion, k / 48.0, NULL);
        double height = height_of(n, places);
        if (k == 0) {
            double u[3], v[3], normal[3]; // in one plane, which leans no more than the state is off its rest
            ax_sub3(places[n / 3], places[0], u);
            ax_sub3(places[n - 1], places[0], v);
            ax_cross(u, v, normal);
            for (int h = 0; h < n; ++h) {
                ax_sub3(places[h], places[0], u);
                assert_at_most(fabs(ax_dot3(u, normal)) / ax_norm3(normal), 1e-9);
            }
            assert_at_most(height, 1e-7);
            for (int t = 0; t < view.linkage->triangle_count; ++t) { // the sheet as it lies flat
                const int* h = view.linkage->triangles[t];
                assert_near(ax_distance3(places[h[0]], places[h[1]]), ax_distance2(view.flat[h[0]], view.flat[h[1]]),
                            1e-9);
            }
        }
        assert_at_most(fabs(height - before), 0.1 * whole); // no jumps
        before = height;
        for (int h = 0; h < n && k == 48; ++h)
            furthest = fmax(furthest, ax_distance3(places[h], view.simulated[h]));
    }
    assert_at_most(furthest, 0.5 * view.spacing);
    ax_form_motion_free(motion);

    motion = ax_form_motion_make(form);
    int reports = 3;
    const ax_progress progress = {.report = stop, .context = &reports};
    assert_null(ax_form_motion_to(motion, 1, &progress));
    ax_form_motion_free(motion);
    ax_form_free(form);
}

// It rises iteration by iteration, whichever state opens, and comes to where it was.
static void a_form_opens_again_slowly(void** state)
{
    (void)state;
    for (int loaded = 0; loaded < 2; ++loaded) {
        ax_form* form = disk(600, 1.2);
        paint(form, sphere);
        slide_on_circle(form, 1.1);
        set_dynamics(form, loaded ? AX_DYNAMICS_INFLATION : AX_DYNAMICS_EXPAND, 3);
        settle(form);
        ax_form_view view = ax_form_look(form);
        int n = view.linkage->hinge_count;
        double whole = height_of(n, loaded ? view.simulated : view.deployed), last;
        ax_form_reopen(form, 0.02);
        view = ax_form_look(form);
        last = height_of(n, loaded ? view.simulated : view.deployed);
        assert_at_most(last, 0.2 * whole);
        for (int k = 0; k < 400; ++k) {
            ax_form_iterate(form, 1);
            double height = height_of(n, loaded ? ax_form_look(form).simulated : ax_form_look(form).deployed);
            assert_at_most(fabs(height - last), 0.1 * whole);
            last = height;
        }
        assert_near(last, whole, 0.01 * whole); // in a round rim it may have turned
        ax_form_free(form);
    }
}

static void constraints_hold(void** state)
{
    (void)state;
    for (int kind = AX_HELD_PLANE; kind <= AX_HELD_FAIR; ++kind) {
        if (kind == AX_HELD_SURFACE || kind == AX_HELD_MIRROR || kind == AX_HELD_ROTATION)
            continue; // by the operators' tests, which know the partners
        ax_form* form = disk(300, 1.2);
        paint(form, sphere);
        set_dynamics(form, AX_DYNAMICS_EXPAND, 3);
        settle(form);
        ax_form_view view = ax_form_look(form);
        int chosen[6], count = 0, wanted = kind == AX_HELD_LINE ? 3 : 6; // hinges across the dome
        double places[6][3];
        for (int h = 0; h < view.linkage->hinge_count && count < wanted; ++h)
            if (fabs(view.sheet[h][1] - 0.3) < 1.2 * view.spacing &&
                (count == 0 || view.sheet[h][0] > view.sheet[chosen[count - 1]][0]))
                chosen[count++] = h;
        for (int k = 0; k < count; ++k) {
            memcpy(places[k], view.deployed[chosen[k]], sizeof places[k]);
            places[k][2] += 0.05;
        }
        ax_form_constraint c = {
            .name = "held",
            .kind = (ax_held_kind)kind,
            .count = count,
            .hinges = chosen,
            .weight = 1,
            .point = {0, places[0][1] + 0.02, 0},
            .direction = {0, 1, 0},
            .places = (const double(*)[3])places,
            .curve = {.kind = AX_CURVE_SPLINE, .count = count, .points = (const double(*)[3])places}};
        ax_error error;
        assert_int_equal(ax_form_put_constraint(form, &c, &error), AX_OK);
        ax_form_report before = measured(form);
        settle(form);
        ax_form_report after = measured(form);
        assert_int_equal(after.held_count, 1);
        if (!(before.held[0].residual > 1e-4) ||
            !(after.held[0].residual < 0.3 * before.held[0].residual || kind == AX_HELD_FAIR))
            fail_msg("%s: %g before, %g after", ax_held_kind_name((ax_held_kind)kind), before.held[0].residual,
                     after.held[0].residual);
        assert_true(after.held[0].residual < before.held[0].residual);
        assert_true(ax_form_drop_constraint(form, "held"));
        assert_false(ax_form_drop_constraint(form, "held"));
        ax_form_report_free(&before);
        ax_form_report_free(&after);
        ax_form_free(form);
    }
}

static double cubed(double r)
{
    return 1.6 - 0.3 * r * r * r;
}

// Depth of the middle below the ring at radius 0.8 of the sheet, and the ring's own radius.
static void profile(int triangles, double out[2])
{
    ax_form* form = disk(triangles, 1.2);
    paint(form, cubed);
    slide_on_circle(form, 1.3);
    set_dynamics(form, AX_DYNAMICS_GRAVITY, 3);
    settle(form);
    ax_form_view view = ax_form_look(form);
    double sum[3] = {0, 0, 0};
    int count[2] = {0, 0};
    for (int h = 0; h < view.linkage->hinge_count; ++h) {
        double r = hypot(view.sheet[h][0], view.sheet[h][1]);
        if (r < 0.15)
            sum[0] += view.simulated[h][2], ++count[0];
        if (fabs(r - 0.8) < 0.06)
            sum[1] += view.simulated[h][2], sum[2] += hypot(view.simulated[h][0], view.simulated[h][1]) * 0.8 / r,
                ++count[1];
    }
    out[0] = sum[1] / count[1] - sum[0] / count[0];
    out[1] = sum[2] / count[1];
    ax_form_free(form);
}

static void shapes_do_not_depend_on_resolution(void** state)
{
    (void)state;
    double coarse[2], fine[2];
    profile(600, coarse);
    profile(2500, fine);
    assert_near(coarse[0], fine[0], 0.02 * 2.6); // 2 % of the size
    assert_near(coarse[1], fine[1], 0.02 * 2.6);
}

// Domes of the same sheet, restarted to heights that are known, and sheets of other panels.
static void shapes_apart_are_measured(void** state)
{
    (void)state;
    ax_form *low = disk(600, 1), *high = disk(600, 1), *fine = disk(2400, 1), *other = polygon(5, 600, 1);
    ax_form_restart(low, 0.2);
    ax_form_restart(high, 0.25);
    ax_form_restart(fine, 0.2);
    ax_form_restart(other, 0.2);
    ax_form_apart apart;
    ax_form_measure_apart(low, low, false, AX_FORM_APART_MARGIN, &apart);
    assert_near(apart.size, 2, 0.1);
    assert_true(apart.points_max == 0 && apart.surfaces_max == 0);
    ax_form_measure_apart(low, high, false, AX_FORM_APART_MARGIN, &apart); // most in the middle, upright
    assert_near(apart.points_max * apart.size, 0.05, 0.003);
    assert_near(apart.surfaces_max * apart.size, 0.05, 0.003);
    assert_true(apart.surfaces_rms < apart.points_rms && apart.points_rms < apart.points_max);
    assert_at_most(hypot(ax_form_look(low).sheet[apart.hinge][0], ax_form_look(low).sheet[apart.hinge][1]), 0.15);
    double rms = apart.points_rms;
    ax_form_measure_apart(low, high, false, 0.3, &apart); // further in they lie further apart
    assert_true(apart.points_rms > 1.2 * rms);
    ax_form_measure_apart(low, fine, false, AX_FORM_APART_MARGIN, &apart);
    assert_at_most(apart.points_max, 0.01);
    assert_at_most(apart.surfaces_max, 0.01);
    ax_form_measure_apart(low, other, false, AX_FORM_APART_MARGIN, &apart); // of another outline
    assert_true(isnan(apart.points_max) && apart.hinge == -1);
    assert_true(apart.surfaces_max > 0 && apart.surfaces_max < 0.1);
    ax_form_free(low);
    ax_form_free(high);
    ax_form_free(fine);
    ax_form_free(other);
}

// A sheet that has just the room to lie flat in its rim hardly bulges, though its load leans on it: were that not to fade, it would stand 0.4 m high.
static void a_sheet_without_slack_hardly_bulges(void** state)
{
    (void)state;
    ax_form* form = disk(300, 1.5);
    slide_on_circle(form, 1.5);
    set_dynamics(form, AX_DYNAMICS_INFLATION, 3);
    settle(form);
    ax_form_view view = ax_form_look(form);
    assert_at_most(height_of(view.linkage->hinge_count, view.deployed), 0.2);
    double mean = 0;
    for (int t = 0; t < view.linkage->triangle_count; ++t)
        mean += view.realised[t] / view.linkage->triangle_count;
    assert_near(mean, 1.5, 0.02);
    ax_form_free(form);
}

// Border panels change size and shape to reach the rim: that is not off what was painted. What gives way further in is.
static void scale_factors_are_judged_away_from_the_rim(void** state)
{
    (void)state;
    ax_form* form = disk(600, 1.4);
    slide_on_circle(form, 1.3);
    set_dynamics(form, AX_DYNAMICS_INFLATION, 3);
    settle(form);
    ax_form_report r = measured(form);
    ax_form_view view = ax_form_look(form);
    double border = 0;
    int beside = 0;
    for (int t = 0; t < view.linkage->triangle_count; ++t) {
        bool rim = false;
        for (int k = 0; k < 3; ++k)
            rim |= view.linkage->on_rim[view.linkage->triangles[t][k]];
        border = rim ? fmax(border, fabs(view.realised[t] - 1.4)) : border;
        beside += rim;
    }
    assert_true(border > 0.1);
    assert_at_most(r.scale_off_max, 0.1);
    assert_true(r.scale_judged > 300 && r.scale_judged < view.linkage->triangle_count - beside);
    for (int k = 0; k < r.finding_count; ++k)
        assert_string_not_equal(r.findings[k].kind, "scale");
    ax_form_report_free(&r);
    ax_form_free(form);

    // a design from a surface asks for the sizes that it has, however uneven its sheet
    ax_design design = sample_design();
    ax_error error;
    assert_int_equal(ax_form_from_design(&design, &form, &error), AX_OK);
    r = measured(form);
    assert_true(r.scale_judged > 0);
    assert_at_most(r.scale_off_max, 1e-12);
    ax_form_report_free(&r);
    ax_form_free(form);
    ax_design_free(&design);
}

// At the rim of a design panels are of other sizes than their factors tell; they keep them, and nothing is bent there.
static void a_design_of_uneven_panels_settles_where_it_lies(void** state)
{
    (void)state;
    ax_design design = sample_design();
    for (int give = 0; give <= 3; give += 3) { // sizes as they are, and sizes that may give way
        ax_error error;
        ax_form* form;
        assert_int_equal(ax_form_from_design(&design, &form, &error), AX_OK);
        set_dynamics(form, AX_DYNAMICS_INFLATION, give);
        settle(form);
        ax_form_report r = measured(form);
        assert_true(r.settled);
        ax_form_view view = ax_form_look(form);
        double smallest = INFINITY, off = 0;
        for (int t = 0; t < view.linkage->triangle_count; ++t) {
            const int* h = view.linkage->triangles[t];
            double was = ax_distance2(design.flat[h[0]], design.flat[h[1]]);
            smallest = fmin(smallest, was / r.edge);
            off = fmax(off, fabs(ax_distance2(view.flat[h[0]], view.flat[h[1]]) / was - 1));
        }
        assert_true(smallest < 0.8); // uneven indeed
        assert_at_most(off, give ? 0.2 : 1e-3);
        for (int h = 0; h < view.linkage->hinge_count; ++h)
            assert_at_most(ax_distance3(view.simulated[h], design.deployed[h]), 0.3 * r.edge);
        ax_form_report_free(&r);
        ax_form_free(form);
    }
    ax_design_free(&design);
}

static void painted_curvature_is_summed_before_any_solve(void** state)
{
    (void)state;
    // over a disc of radius r the metric l / (1 + k r^2) has curvature 4 pi k r^2 / (1 + k r^2); rings end at eighths of the radius, and
    // the border has no neighbours to measure against
    ax_form* form = disk(2500, 1.2);
    paint(form, sphere);
    ax_form_report r = measured(form);
    double least = 4 * AX_PI * 0.35 * 0.8 * 0.8 / (1 + 0.35 * 0.8 * 0.8), most = 4 * AX_PI * 0.35 / 1.35;
    assert_true(r.curvature_max > least && r.curvature_max < most);
    ax_form_report_free(&r);

    // a sharp dab beside the middle turns over as one in the middle does
    ax_form_view view = ax_form_look(form);
    double* values = AX_NEW(double, view.linkage->triangle_count);
    for (int t = 0; t < view.linkage->triangle_count; ++t) {
        double x = view.sheet[view.linkage->triangles[t][0]][0] - 0.5, y = view.sheet[view.linkage->triangles[t][0]][1];
        values[t] = x * x + y * y < 0.09 ? 1.8 : 1.1;
    }
    ax_form_prescribe(form, values);
    ax_free(values);
    r = measured(form);
    assert_true(r.curvature_max > 2 * AX_PI);
    ax_form_report_free(&r);
    ax_form_free(form);
}

// A few hinges bear it all: panels beside them are pulled hardest. The place is named, and a form that was stored says the same.
static void material_is_told_where_it_lacks(void** state)
{
    (void)state;
    ax_form* form = disk(600, 1.3);
    paint(form, sphere);
    set_dynamics(form, AX_DYNAMICS_EXPAND, 3);
    settle(form);
    ax_form_view view = ax_form_look(form);
    int n = view.linkage->hinge_count, *hinges = AX_NEW(int, n), count = 0;
    double(*places)[3] = ax_alloc((size_t)n, sizeof *places);
    for (int h = 0; h < n; ++h)
        if (view.linkage->on_rim[h] && fmin(fabs(view.sheet[h][0]), fabs(view.sheet[h][1])) < 0.17) {
            memcpy(places[count], view.deployed[h], sizeof *places);
            hinges[count++] = h;
        }
    ax_form_constraint corners = {.name = "corners",
                                  .kind = AX_HELD_FIXED,
                                  .count = count,
                                  .hinges = hinges,
                                  .weight = 1,
                                  .support = true,
                                  .places = (const double(*)[3])places};
    ax_error refused;
    assert_int_equal(ax_form_put_constraint(form, &corners, &refused), AX_OK);
    set_dynamics(form, AX_DYNAMICS_GRAVITY, 3);
    settle(form);
    size_t size;
    void* bytes = ax_form_save(form, &size);
    for (int stored = 0; stored < 2; ++stored) {
        ax_error error;
        if (stored) {
            ax_form_free(form);
            assert_int_equal(ax_form_load(bytes, size, &form, &error), AX_OK);
        }
        ax_form_report r = measured(form);
        const ax_finding* tight = NULL;
        for (int k = 0; k < r.finding_count && !tight; ++k)
            tight = strcmp(r.findings[k].kind, "tight") == 0 ? r.findings + k : NULL;
        assert_non_null(tight);
        const double* at = ax_form_look(form).sheet[tight->hinge];
        double nearest = INFINITY;
        for (int k = 0; k < count; ++k)
            nearest = fmin(nearest, ax_distance2(at, ax_form_look(form).sheet[hinges[k]]));
        assert_at_most(nearest, 0.1);
        assert_non_null(strstr(tight->text, "Too little material at panel"));
        assert_non_null(strstr(tight->text, "Paint larger scale factors there"));
        ax_form_report_free(&r);
    }
    ax_free(hinges);
    ax_free(places);
    ax_free(bytes);
    ax_form_free(form);
}

static void too_little_material_is_told(void** state)
{
    (void)state;
    ax_form* form = disk(300, 1.2);
    slide_on_circle(form, 1.6); // a third beyond what it reaches
    set_dynamics(form, AX_DYNAMICS_GRAVITY, 0);
    settle(form);
    ax_form_report r = measured(form);
    assert_false(r.settled);
    bool told = false;
    for (int k = 0; k < r.finding_count; ++k)
        told = told || strcmp(r.findings[k].kind, "tight") == 0;
    assert_true(told);
    ax_form_report_free(&r);
    ax_form_free(form);
}

static void unusable_requests_are_refused(void** state)
{
    (void)state;
    double line[3][2] = {{0, 0}, {1, 1}, {2, 2}}, square[4][2] = {{0, 0}, {1, 0}, {1, 1}, {0, 1}};
    ax_form* form;
    ax_error error;
    ax_form_start start = {.outline_count = 3, .outline = (const double(*)[2])line, .triangles = 100, .scale = 1.2};
    assert_int_equal(ax_form_make(&start, &form, &error), AX_USAGE);
    start.outline = (const double(*)[2])square, start.outline_count = 4, start.scale = 2.5;
    assert_int_equal(ax_form_make(&start, &form, &error), AX_USAGE);
    start.scale = 1.2, start.triangles = 3;
    assert_int_not_equal(ax_form_make(&start, &form, &error), AX_OK);
    assert_null(form);
    form = disk(200, 1.2);
    int twice[2] = {4, 4}, beyond[1] = {1000000};
    ax_rim_part part = {.kind = AX_RIM_FREE, .count = 2, .hinges = twice};
    assert_int_equal(ax_form_set_rim(form, 1, &part, &error), AX_USAGE);
    part.count = 1, part.hinges = beyond;
    assert_int_equal(ax_form_set_rim(form, 1, &part, &error), AX_USAGE);
    double circle[3][3] = {{0, 0, 0}, {0, 0, 1}, {-1, 0, 0}};
    part.kind = AX_RIM_SLIDE, part.hinges = twice;
    part.curve =
        (ax_curve_shape){.kind = AX_CURVE_CIRCLE, .closed = true, .count = 3, .points = (const double(*)[3])circle};
    assert_int_equal(ax_form_set_rim(form, 1, &part, &error), AX_USAGE);
    assert_non_null(strstr(error.message, "radius"));
    ax_form_constraint c = {.name = "", .kind = AX_HELD_PLANE, .count = 2, .hinges = twice, .weight = 1};
    assert_int_equal(ax_form_put_constraint(form, &c, &error), AX_USAGE);
    c.name = "two";
    assert_int_equal(ax_form_put_constraint(form, &c, &error), AX_USAGE);
    ax_design design;
    ax_finish finish;
    assert_int_equal(ax_form_finish(form, NULL, &design, &finish, &error), AX_CANNOT_REALISE); // nothing deployed
    ax_form_free(form);
}

// Settled under load is at rest: settling again, from there, does not move the form, with room for it and without. Projective steps
// alone do not either where there is room; where not, a slack part has several places to rest.
static void a_loaded_form_rests(void** state)
{
    (void)state;
    for (int slack = 0; slack < 2; ++slack) {
        ax_form* form = disk(600, 1.25);
        paint(form, sphere);
        slide_on_circle(form, slack ? 1.05 : 1.3);
        set_dynamics(form, AX_DYNAMICS_INFLATION, 3);
        settle(form);
        ax_form_view view = ax_form_look(form);
        int n = view.linkage->hinge_count;
        double(*before)[3] = ax_copy(view.simulated, (size_t)n, sizeof *before), most = 0, edge = 0;
        for (int t = 0; t < view.linkage->triangle_count; ++t)
            edge += view.prescribed[t] * view.spacing / 2 / view.linkage->triangle_count;
        for (int again = 0; again < 2 - slack; ++again) {
            if (again > 0)
                assert_int_equal(ax_form_settle(form, 3000, NULL, NULL), AX_OK);
            settle(form);
            view = ax_form_look(form);
            for (int h = 0; h < n; ++h)
                most = fmax(most, ax_distance3(before[h], view.simulated[h]));
            assert_at_most(most, 0.01 * edge);
        }
        ax_free(before);
        ax_form_free(form);
    }
}

// Free to slide in a plane and held by nothing else, a form has no place that its supports tell.
static void a_form_on_a_plane_alone_settles(void** state)
{
    (void)state;
    ax_form* form = disk(200, 1.3);
    paint(form, sphere);
    ax_form_view view = ax_form_look(form);
    int n = view.linkage->hinge_count, *rim = AX_NEW(int, n);
    ax_form_constraint ground = {.name = "ground",
                                 .kind = AX_HELD_PLANE_GIVEN,
                                 .count = ax_linkage_rim(view.linkage, rim),
                                 .hinges = rim,
                                 .weight = 1,
                                 .support = true,
                                 .direction = {0, 0, 1}};
    ax_error error;
    assert_int_equal(ax_form_put_constraint(form, &ground, &error), AX_OK);
    ax_free(rim);
    set_dynamics(form, AX_DYNAMICS_GRAVITY, 3);
    settle(form);
    view = ax_form_look(form);
    for (int h = 0; h < n; ++h)
        for (int c = 0; c < 3; ++c)
            assert_at_most(fabs(view.simulated[h][c]), 10);
    ax_form_free(form);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(uniform_sheets_open_flat_and_stop_at_lambda),
        cmocka_unit_test(sheets_keep_to_corners_and_round_ones_have_panels_of_one_size),
        cmocka_unit_test(painted_spheres_expand_to_spheres),
        cmocka_unit_test(stages_of_figure_4),
        cmocka_unit_test(stored_forms_go_on_with_the_same_bits),
        cmocka_unit_test(a_cancelled_settle_changes_nothing),
        cmocka_unit_test(a_loaded_form_deploys_in_time),
        cmocka_unit_test(a_form_opens_again_slowly),
        cmocka_unit_test(a_loaded_form_rests),
        cmocka_unit_test(a_form_on_a_plane_alone_settles),
        cmocka_unit_test(constraints_hold),
        cmocka_unit_test(shapes_do_not_depend_on_resolution),
        cmocka_unit_test(shapes_apart_are_measured),
        cmocka_unit_test(a_sheet_without_slack_hardly_bulges),
        cmocka_unit_test(scale_factors_are_judged_away_from_the_rim),
        cmocka_unit_test(a_design_of_uneven_panels_settles_where_it_lies),
        cmocka_unit_test(painted_curvature_is_summed_before_any_solve),
        cmocka_unit_test(material_is_told_where_it_lacks),
        cmocka_unit_test(too_little_material_is_told),
        cmocka_unit_test(unusable_requests_are_refused),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
