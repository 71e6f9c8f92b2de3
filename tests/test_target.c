// Which surfaces can deploy, and the nearest one that can.
#include "ax/target.h"
#include "base/vec.h"
#include "mesh/geometry.h"
#include "mesh/topology.h"

#include "base/random.h"
#include "support/shapes.h"
#include "support/test.h"

#include <string.h>

static double flat_sheet(double x, double y)
{
    (void)x, (void)y;
    return 0;
}
static double saddle(double x, double y)
{
    return 0.15 * (x * x - y * y);
}
static double shallow(double x, double y)
{
    return 0.03 * (1 - x * x - y * y); // a sag of 1.5 % of the span
}
static double two_bumps(double x, double y)
{
    double a = (x - 0.45) * (x - 0.45) + y * y, b = (x + 0.45) * (x + 0.45) + y * y;
    return (1 - x * x - y * y) * (0.15 + 0.35 * exp(-9 * a) + 0.3 * exp(-9 * b));
}
static double vault(double x, double y)
{
    (void)x;
    return sqrt(4 - y * y); // a cylinder of radius 2
}

static ax_screen screen(const ax_mesh* mesh, const ax_target_options* options)
{
    ax_error error = {0};
    ax_screen s;
    if (ax_target_screen(mesh, options, NULL, &s, &error) != AX_OK)
        fail_msg("%s", error.message);
    assert_int_equal(s.vertex_count, mesh->vertex_count);
    return s;
}

static void assert_says(const ax_screen* s, const char* words)
{
    if (!strstr(s->words, words))
        fail_msg("\"%s\" does not say \"%s\"", s->words, words);
}

static void mean_curvature_is_that_of_the_surface(void** state)
{
    (void)state;
    for (int rings = 10; rings <= 40; rings *= 2) {
        double second_order = 5.0 / (rings * rings);
        ax_mesh mesh = shape_paraboloid(rings, 0.4);
        ax_screen s = screen(&mesh, NULL);
        for (int v = 0; v < mesh.vertex_count; ++v) {
            double r = hypot(mesh.positions[v][0], mesh.positions[v][1]), w = sqrt(1 + 0.64 * r * r);
            if (r < 1 - 2.5 / rings) // the average over the one-ring is centred
                assert_near(s.curvature[v], 0.4 / (w * w * w) + 0.4 / w, second_order);
        }
        ax_screen_free(&s);
        ax_mesh_free(&mesh);

        mesh = shape_cap(rings, 1.2);
        s = screen(&mesh, NULL);
        assert_near(s.curvature_median, 1, second_order);
        assert_near(s.curvature_q01, 1, 3 * second_order);
        assert_near(s.area, 2 * AX_PI * (1 - cos(1.2)), second_order);
        assert_near(s.rim_length, 2 * AX_PI * sin(1.2), second_order);
        assert_near(s.curvature_nonpositive_share, 0, 0);
        ax_screen_free(&s);
        ax_mesh_free(&mesh);
    }
}

static void domes_deploy_by_inflation_and_hung_by_gravity(void** state)
{
    (void)state;
    ax_mesh domes[] = {shape_cap(20, 1), shape_paraboloid(20, 0.4), shape_over_disk(20, shallow),
                       shape_over_square(20, vault)};
    for (int k = 0; k < 4; ++k) {
        ax_screen s = screen(&domes[k], NULL);
        assert_int_equal(s.verdict, AX_DEPLOYABLE);
        assert_true(s.by_inflation && s.by_gravity && s.height_field && s.scale_fits);
        assert_near(s.gravity_direction, 1, 0);
        assert_near(sqrt(s.scale_lo * s.scale_hi), sqrt(1.02 * 1.9), 1e-12); // centred in the band
        assert_near(s.scale_hi / s.scale_lo, s.scale_ratio, 1e-12);
        for (int v = 0; v < s.vertex_count; ++v)
            assert_true(s.scale[v] >= s.scale_lo - 1e-12 && s.scale[v] <= s.scale_hi + 1e-12);
        assert_int_equal(s.projection.steps, 0);
        assert_says(&s, "Deployable by inflation, and by gravity towards +z");
        ax_screen_free(&s);
        ax_mesh_free(&domes[k]);
    }
}

static void a_developable_vault_needs_one_scale_factor(void** state)
{
    (void)state;
    ax_mesh mesh = shape_over_square(40, vault);
    ax_screen s = screen(&mesh, NULL);
    assert_near(s.scale_ratio, 1, 1e-3);
    assert_near(s.curvature_median, 0.25, 1e-3);
    ax_screen_free(&s);
    ax_mesh_free(&mesh);
}

static void a_bowl_deploys_downwards(void** state)
{
    (void)state;
    ax_mesh mesh = shape_cap(15, 1);
    for (int v = 0; v < mesh.vertex_count; ++v)
        mesh.positions[v][2] *= -1;
    shape_turn_over(&mesh);
    ax_screen s = screen(&mesh, NULL);
    assert_int_equal(s.verdict, AX_DEPLOYABLE);
    assert_near(s.gravity_direction, -1, 0);
    assert_says(&s, "by gravity towards -z");
    ax_screen_free(&s);
    ax_mesh_free(&mesh);
}

static void a_tilted_dome_deploys_by_inflation_only(void** state)
{
    (void)state;
    ax_mesh mesh = shape_cap(15, 1);
    shape_move(&mesh, 0.8, 0, 0, 0);
    ax_screen s = screen(&mesh, NULL);
    assert_int_equal(s.verdict, AX_DEPLOYABLE);
    assert_true(s.by_inflation && !s.by_gravity && !s.height_field);
    assert_says(&s, "no height field");
    ax_screen_free(&s);
    ax_mesh_free(&mesh);
}

// A ramp that winds over itself: every face looks up, and still the plan is covered twice.
static void a_surface_that_winds_over_itself_is_no_height_field(void** state)
{
    (void)state;
    enum { N = 60 };
    ax_mesh mesh = {.vertex_count = 3 * (N + 1), .face_count = 4 * N};
    mesh.positions = ax_alloc((size_t)mesh.vertex_count, sizeof *mesh.positions);
    mesh.faces = ax_alloc((size_t)mesh.face_count, sizeof *mesh.faces);
    for (int k = 0; k <= N; ++k)
        for (int j = 0; j < 3; ++j) {
            double t = 3 * AX_PI * k / N, r = 1 + 0.2 * j;
            double place[3] = {r * cos(t), r * sin(t), 0.3 * t + (j == 1 ? 0.05 : 0)};
            memcpy(mesh.positions[3 * k + j], place, sizeof place);
        }
    for (int k = 0, f = 0; k < N; ++k)
        for (int j = 0; j < 2; ++j) {
            int a = 3 * k + j, quad[2][3] = {{a, a + 1, a + 4}, {a, a + 4, a + 3}};
            memcpy(mesh.faces[f], quad, sizeof quad);
            f += 2;
        }
    ax_screen s = screen(&mesh, NULL);
    assert_false(s.height_field);
    ax_screen_free(&s);
    ax_mesh_free(&mesh);
}

static void a_hemisphere_needs_the_whole_band_and_is_told_so(void** state)
{
    (void)state;
    ax_mesh mesh = shape_cap(20, AX_PI / 2);
    ax_screen s = screen(&mesh, NULL);
    assert_int_equal(s.verdict, AX_NOT_DEPLOYABLE);
    assert_false(s.scale_fits || s.by_inflation || s.by_gravity);
    assert_near(s.scale_ratio, 2, 1e-3);
    assert_says(&s, "in a ratio of 2.00");
    assert_says(&s, "more than the 1.863 that the band 1.02 to 1.9 allows");
    assert_says(&s, "largest near (0.000, 0.000, 1.000)");
    assert_says(&s, "--scale 1,2");
    ax_screen_free(&s);

    ax_target_options widest = ax_target_options_default();
    widest.scale_lo = 1, widest.scale_hi = 2;
    s = screen(&mesh, &widest);
    assert_int_equal(s.verdict, AX_DEPLOYABLE);
    assert_near(s.scale_lo, 1, 1e-3);
    assert_near(s.scale_hi, 2, 1e-3);
    ax_screen_free(&s);
    ax_mesh_free(&mesh);

    mesh = shape_cap(20, 2); // ratio 1 / cos(1)^2
    s = screen(&mesh, &widest);
    assert_int_equal(s.verdict, AX_NOT_DEPLOYABLE);
    assert_near(s.scale_ratio, 3.4255, 0.02);
    assert_says(&s, "Even the widest band");
    ax_screen_free(&s);
    ax_mesh_free(&mesh);
}

static void what_is_nowhere_dome_like_is_refused(void** state)
{
    (void)state;
    const struct {
        ax_mesh mesh;
        const char* says;
    } cases[] = {{shape_over_disk(20, saddle), "No part of the surface is dome-like"},
                 {shape_over_disk(20, flat_sheet), "not positive on 100 %"},
                 {shape_paraboloid(20, 0.4), "Check which way its faces look"}};
    for (int k = 0; k < 3; ++k) {
        ax_mesh mesh = cases[k].mesh;
        if (k == 2)
            shape_turn_over(&mesh);
        ax_screen s = screen(&mesh, NULL);
        assert_int_equal(s.verdict, AX_NOT_DEPLOYABLE);
        assert_says(&s, cases[k].says);
        ax_screen_free(&s);

        ax_mesh before = ax_mesh_copy(&mesh);
        ax_projection report;
        ax_error error = {0};
        assert_int_equal(ax_target_project(&mesh, NULL, &report, &error), AX_CANNOT_REALISE);
        assert_non_null(strstr(error.message, "dome-like"));
        assert_memory_equal(mesh.positions, before.positions, (size_t)mesh.vertex_count * sizeof *mesh.positions);
        ax_mesh_free(&before);
        ax_mesh_free(&mesh);
    }
}

static void a_noisy_flat_sheet_far_from_the_origin_is_flat(void** state)
{
    (void)state;
    ax_mesh mesh = shape_over_square(30, flat_sheet);
    shape_move(&mesh, 0.3, 500000, 5000000, 300);
    ax_screen s = screen(&mesh, NULL);
    assert_int_equal(s.verdict, AX_NOT_DEPLOYABLE);
    assert_near(s.curvature_nonpositive_share, 1, 0);
    ax_screen_free(&s);
    ax_mesh_free(&mesh);
}

// The promises of a projection, on a surface that needs it.
static void check_projection(const ax_mesh* before, double tolerance)
{
    ax_mesh after = ax_mesh_copy(before);
    ax_projection report;
    ax_error error = {0};
    if (ax_target_project(&after, NULL, &report, &error) != AX_OK)
        fail_msg("%s", error.message);
    int n = after.vertex_count;
    assert_true(report.steps > 0 && report.largest_move > 0 && report.moved_area_share > 0);

    ax_topology topology = ax_topology_make(&after);
    double *curvature = AX_NEW(double, n), (*normal)[3] = ax_alloc((size_t)n, sizeof *normal), area = 0, largest = 0;
    ax_mean_curvature(&after, curvature);
    ax_vertex_normals(before, normal);
    for (int f = 0; f < before->face_count; ++f) {
        double was[3], is[3];
        area += ax_face_area(before, f);
        ax_face_normal(before, f, was);
        ax_face_normal(&after, f, is);
        assert_true(ax_dot3(was, is) > 0); // nothing turned over
    }
    for (int v = 0; v < n; ++v) {
        double move[3];
        ax_sub3(after.positions[v], before->positions[v], move);
        largest = fmax(largest, ax_norm3(move));
        assert_true(ax_dot3(move, normal[v]) >= 0); // outwards only
        if (topology.on_rim[v])
            assert_memory_equal(after.positions[v], before->positions[v], sizeof *after.positions);
        else
            assert_true(curvature[v] * sqrt(area) >= 0.3 * (1 - tolerance));
    }
    assert_near(report.largest_move, largest, 1e-12 * largest);
    assert_near(report.nonpositive_share, 0, 0);
    assert_at_most(0.25 / sqrt(area), report.curvature_min);

    // done twice it moves nothing more, and the same again gives the same bits
    ax_mesh again = ax_mesh_copy(&after);
    ax_projection second;
    assert_int_equal(ax_target_project(&again, NULL, &second, NULL), AX_OK);
    assert_int_equal(second.steps, 0);
    assert_memory_equal(again.positions, after.positions, (size_t)n * sizeof *again.positions);
    memcpy(again.positions, before->positions, (size_t)n * sizeof *again.positions);
    assert_int_equal(ax_target_project(&again, NULL, &second, NULL), AX_OK);
    assert_memory_equal(again.positions, after.positions, (size_t)n * sizeof *again.positions);

    ax_free(curvature);
    ax_free(normal);
    ax_topology_free(&topology);
    ax_mesh_free(&again);
    ax_mesh_free(&after);
}

static void two_bumps_are_joined_into_one_dome(void** state)
{
    (void)state;
    for (int rings = 12; rings <= 48; rings *= 2) {
        ax_mesh mesh = shape_over_disk(rings, two_bumps);
        check_projection(&mesh, 0.02);
        ax_mesh_free(&mesh);
    }
}

static void projection_does_not_depend_on_the_frame(void** state)
{
    (void)state;
    ax_mesh mesh = shape_over_disk(16, two_bumps), moved = ax_mesh_copy(&mesh);
    shape_move(&moved, 0, 500000, 5000000, 300);
    ax_projection here, there;
    assert_int_equal(ax_target_project(&mesh, NULL, &here, NULL), AX_OK);
    assert_int_equal(ax_target_project(&moved, NULL, &there, NULL), AX_OK);
    assert_near(here.largest_move, there.largest_move, 1e-6);
    assert_near(here.moved_area_share, there.moved_area_share, 1e-3);
    ax_mesh_free(&moved);

    // tilted, it is no height field over the plan but still one along its mean normal: the same shape comes out
    ax_mesh tilted = shape_over_disk(16, two_bumps);
    shape_move(&tilted, 1.2, 0, 0, 0);
    assert_int_equal(ax_target_project(&tilted, NULL, &there, NULL), AX_OK);
    assert_near(here.largest_move, there.largest_move, 1e-3 * here.largest_move);
    ax_mesh_free(&tilted);
    ax_mesh_free(&mesh);
}

// Steep walls over a plan with three bays: above a bay the nearest surface has to hang over the rim, which vertical
// moves cannot do.
static ax_mesh bays(int rings)
{
    ax_mesh mesh = shape_over_disk(rings, flat_sheet);
    for (int v = 0; v < mesh.vertex_count; ++v) {
        double *x = mesh.positions[v], s = hypot(x[0], x[1]), t = atan2(x[1], x[0]), r = 1 + 0.25 * cos(3 * t);
        x[2] = 0.8 * (1 - s * s * s * s);
        x[0] *= r, x[1] *= r;
    }
    return mesh;
}

static void steep_bays_are_projected_along_the_normals(void** state)
{
    (void)state;
    ax_mesh mesh = bays(24);
    ax_screen s = screen(&mesh, NULL);
    assert_int_equal(s.verdict, AX_DEPLOYABLE_PROJECTED);
    ax_screen_free(&s);
    check_projection(&mesh, 0.05);
    ax_mesh_free(&mesh);
}

// A scan with slivers that stand upright.
static void slivers_that_cannot_be_projected_are_told_with_their_place(void** state)
{
    (void)state;
    ax_random random = {3};
    ax_mesh mesh = shape_over_disk(24, two_bumps);
    for (int v = 0; v < mesh.vertex_count; ++v)
        for (int c = 0; c < 3; ++c)
            mesh.positions[v][c] += ax_random_uniform(&random, -0.05, 0.05);
    ax_projection report;
    ax_error error = {0};
    assert_int_equal(ax_target_project(&mesh, NULL, &report, &error), AX_BAD_INPUT);
    assert_non_null(strstr(error.message, "The thinnest, near ("));
    ax_mesh_free(&mesh);
}

static void a_dome_is_left_as_it_is(void** state)
{
    (void)state;
    ax_mesh domes[] = {shape_cap(20, 1.4), shape_over_disk(20, shallow)};
    for (int k = 0; k < 2; ++k) {
        ax_mesh before = ax_mesh_copy(&domes[k]);
        ax_projection report;
        assert_int_equal(ax_target_project(&domes[k], NULL, &report, NULL), AX_OK);
        assert_int_equal(report.steps, 0);
        assert_near(report.largest_move, 0, 0);
        assert_memory_equal(domes[k].positions, before.positions,
                            (size_t)before.vertex_count * sizeof *before.positions);
        ax_mesh_free(&before);
        ax_mesh_free(&domes[k]);
    }
}

static void a_surface_that_needs_projection_is_told_what_it_costs(void** state)
{
    (void)state;
    ax_mesh mesh = shape_over_disk(20, two_bumps);
    ax_screen s = screen(&mesh, NULL);
    assert_int_equal(s.verdict, AX_DEPLOYABLE_PROJECTED);
    assert_true(s.by_inflation && s.by_gravity);
    assert_true(s.curvature_nonpositive_share > 0.3);
    assert_says(&s, "dips inwards");
    assert_says(&s, "It deploys by inflation");
    ax_projection report;
    assert_int_equal(ax_target_project(&mesh, NULL, &report, NULL), AX_OK);
    assert_memory_equal(&report, &s.projection, sizeof report); // the screen has tried the very same
    ax_screen after = screen(&mesh, NULL);
    assert_int_equal(after.verdict, AX_DEPLOYABLE);
    ax_screen_free(&after);
    ax_screen_free(&s);
    ax_mesh_free(&mesh);
}

static void an_impossible_band_is_refused(void** state)
{
    (void)state;
    ax_mesh mesh = shape_cap(4, 1);
    const double bands[][2] = {{0.9, 1.5}, {1, 2.1}, {1.5, 1.5}, {NAN, 1.5}};
    for (int k = 0; k < 4; ++k) {
        ax_target_options options = ax_target_options_default();
        options.scale_lo = bands[k][0], options.scale_hi = bands[k][1];
        ax_screen s;
        ax_error error = {0};
        assert_int_equal(ax_target_screen(&mesh, &options, NULL, &s, &error), AX_USAGE);
        assert_non_null(strstr(error.message, "1 <= LO < HI <= 2"));
        assert_null(s.curvature);
    }
    ax_mesh_free(&mesh);
}

static bool stop_after(void* context, const char* stage, double fraction, double residual)
{
    (void)residual;
    assert_non_null(stage);
    assert_true(fraction >= 0 && fraction <= 1);
    return --*(int*)context > 0;
}

static void cancelling_leaves_everything_as_it_was(void** state)
{
    (void)state;
    ax_mesh mesh = shape_over_disk(12, two_bumps), before = ax_mesh_copy(&mesh);
    for (int calls = 1; calls < 5; ++calls) {
        int left = calls;
        ax_progress progress = {stop_after, &left};
        ax_projection report;
        assert_int_equal(ax_target_project(&mesh, &progress, &report, NULL), AX_CANCELLED);
        assert_memory_equal(mesh.positions, before.positions, (size_t)mesh.vertex_count * sizeof *mesh.positions);
        left = calls;
        ax_screen s;
        assert_int_equal(ax_target_screen(&mesh, NULL, &progress, &s, NULL), AX_CANCELLED);
        assert_null(s.curvature);
    }
    ax_mesh_free(&before);
    ax_mesh_free(&mesh);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(mean_curvature_is_that_of_the_surface),
        cmocka_unit_test(domes_deploy_by_inflation_and_hung_by_gravity),
        cmocka_unit_test(a_developable_vault_needs_one_scale_factor),
        cmocka_unit_test(a_bowl_deploys_downwards),
        cmocka_unit_test(a_tilted_dome_deploys_by_inflation_only),
        cmocka_unit_test(a_surface_that_winds_over_itself_is_no_height_field),
        cmocka_unit_test(a_hemisphere_needs_the_whole_band_and_is_told_so),
        cmocka_unit_test(what_is_nowhere_dome_like_is_refused),
        cmocka_unit_test(a_noisy_flat_sheet_far_from_the_origin_is_flat),
        cmocka_unit_test(two_bumps_are_joined_into_one_dome),
        cmocka_unit_test(projection_does_not_depend_on_the_frame),
        cmocka_unit_test(steep_bays_are_projected_along_the_normals),
        cmocka_unit_test(slivers_that_cannot_be_projected_are_told_with_their_place),
        cmocka_unit_test(a_dome_is_left_as_it_is),
        cmocka_unit_test(a_surface_that_needs_projection_is_told_what_it_costs),
        cmocka_unit_test(an_impossible_band_is_refused),
        cmocka_unit_test(cancelling_leaves_everything_as_it_was),
    };
    return cmocka_run_group_tests_name("target", tests, NULL, NULL);
}
