// The sun against published places; shade against what geometry says it must be.
#include "ax/shade.h"

#include "support/test.h"

#include "base/vec.h"

#include <string.h>

static const double degree = AX_PI / 180;

static void the_sun_stands_where_others_have_it(void** state)
{
    (void)state;
    // Reda and Andreas, NREL/TP-560-34302, table A5.1, and further values of their algorithm: azimuth and elevation with refraction
    static const struct {
        double latitude, longitude;
        ax_instant t;
        double azimuth, zenith;
    } known[] = {
        {39.742476, -105.1786, {2003, 10, 17, 12 + 30.5 / 60 + 7}, 194.34024, 50.11162},
        {-3.107, -60.025, {2015, 6, 12, 9 + 34 / 60.0 + 11 / 3600.0 + 4}, 51.608, 44.1425},
        {-41, 0, {2012, 12, 22, 12}, 359.08592, 17.5658},
        {-3, 0, {2012, 12, 22, 12}, 180.790356, 20.4285},
    };
    for (int k = 0; k < 4; ++k) {
        ax_sun sun = ax_sun_at(known[k].latitude, known[k].longitude, known[k].t);
        print_message("azimuth off by %.4f, zenith by %.4f degrees\n", sun.azimuth / degree - known[k].azimuth,
                      90 - sun.elevation / degree - known[k].zenith);
        assert_near(sun.azimuth / degree, known[k].azimuth, 0.05);
        assert_near(90 - sun.elevation / degree, known[k].zenith, 0.05);
    }
    // sunset on 4 December 2004 at 35 degrees south, 19:02:02.5 UT (ibid.): the centre is 0.8333 degrees below the horizon then
    ax_sun set = ax_sun_at(-35, 0, (ax_instant){2004, 12, 4, 19 + 2 / 60.0 + 2.5 / 3600});
    assert_near(set.elevation / degree, -0.8333, 0.05);
    // hours run over into other days
    ax_sun a = ax_sun_at(50, 10, (ax_instant){2024, 3, 1, -3}), b = ax_sun_at(50, 10, (ax_instant){2024, 2, 29, 21});
    assert_near(a.azimuth, b.azimuth, 1e-9);
}

static void rays_point_to_the_sun_in_the_frame_of_the_document(void** state)
{
    (void)state;
    ax_ray east = ax_sun_ray((ax_sun){90 * degree, 30 * degree}, 0),
           turned = ax_sun_ray((ax_sun){90 * degree, 0.5}, 90 * degree);
    assert_near(east.to_sun[0], cos(30 * degree), 1e-12);
    assert_near(east.to_sun[2], 0.5, 1e-12);
    assert_near(turned.to_sun[1], cos(0.5), 1e-12); // y points to the east
    assert_true(ax_sun_ray((ax_sun){0, -0.1}, 0).weight == 0);
    ax_ray high = ax_sun_ray((ax_sun){0, 90 * degree}, 0);
    assert_near(high.weight, 0.7 * 1353, 0.5); // one air mass
    assert_true(east.weight < 0.5 * high.weight);
    ax_ray rays[24];
    assert_int_equal(ax_sun_day(0, 0, 0, (ax_instant){2024, 3, 20, 0}, 24, 24, rays), 12); // the equinox: half a day
    assert_int_equal(ax_sun_day(80, 0, 0, (ax_instant){2024, 12, 21, 0}, 24, 24, rays), 0);
}

// A level, fully open layer: panels of edge 1 in `cells` x `cells` cells about the origin at a height.

static ax_design open_sheet(int cells, double height)
{
    int n = 2 * cells * cells;
    ax_design d = {.unit = AX_METRE, .linkage = {.triangle_count = n, .hinge_count = 3 * n}};
    d.linkage.triangles = ax_alloc((size_t)n, sizeof *d.linkage.triangles);
    d.deployed = ax_alloc((size_t)(3 * n), sizeof *d.deployed);
    for (int t = 0; t < n; ++t) {
        int i = t / 2 % cells - cells / 2, j = t / 2 / cells - cells / 2;
        double side = t % 2 ? -1 : 1, half = sqrt(0.75), x = 2 * i + j, y = 2 * half * j;
        const double corner[3][2] = {{x, y}, {x + side, y}, {x + 0.5 * side, y + side * half}};
        for (int k = 0; k < 3; ++k) {
            d.linkage.triangles[t][k] = 3 * t + k;
            d.deployed[3 * t + k][0] = corner[k][0], d.deployed[3 * t + k][1] = corner[k][1];
            d.deployed[3 * t + k][2] = height;
        }
    }
    return d;
}

static double mean_of(int layer_count, const ax_layer* layers, int ray_count, const ax_ray* rays)
{
    // well within the shadows of the large sheets
    static double opacity[160 * 160];
    const ax_ground ground = {0, {-8, -8}, 0.1, 160, 160};
    double sum = 0;
    assert_int_equal(ax_shade_map(layer_count, layers, ray_count, rays, &ground, NULL, opacity, NULL), AX_OK);
    for (int k = 0; k < 160 * 160; ++k)
        sum += opacity[k] / (160 * 160);
    return sum;
}

static void a_full_layer_stops_a_quarter_from_everywhere(void** state)
{
    (void)state;
    ax_design sheet = open_sheet(40, 3);
    ax_layer layer = {.design = &sheet, .state = AX_STATE_DEPLOYED, .extent = INFINITY};
    for (int k = 0; k < 6; ++k) {
        ax_ray ray = ax_sun_ray((ax_sun){k, (90 - 12 * k) * degree}, 0.3);
        layer.turn = 0.7 * k;
        assert_near(mean_of(1, &layer, 1, &ray), 0.25,
                    0.006); // parallel light moves the shadow of a level sheet, no more
    }
    ax_design_free(&sheet);
}

// The mean opacity of k full layers that know nothing of one another is 1 - 0.75^k.
static void layers_turned_against_one_another_multiply(void** state)
{
    (void)state;
    ax_design sheet = open_sheet(40, 3);
    ax_layer layers[3];
    ax_ray ray = ax_sun_ray((ax_sun){0.4, 60 * degree}, 0);
    for (int k = 0; k < 3; ++k)
        layers[k] = (ax_layer){.design = &sheet,
                               .state = AX_STATE_DEPLOYED,
                               .turn = 19 * k * degree,
                               .move = {0.37 * k, 0.81 * k, 0.2 * k},
                               .extent = INFINITY};
    for (int k = 1; k <= 3; ++k)
        assert_near(mean_of(k, layers, 1, &ray), 1 - pow(0.75, k), 0.015);
    ax_design_free(&sheet);
}

// One leaning panel: its shadow has the area |n . s| / s_z.
static void a_leaning_panel_throws_its_projected_area(void** state)
{
    (void)state;
    double x[3][3] = {{0, 0, 1}, {1.3, 0.2, 1.8}, {0.3, 1.1, 2.2}}, normal[3], u[3], v[3];
    int triangle[1][3] = {{0, 1, 2}};
    ax_design design = {
        .unit = AX_METRE, .linkage = {.triangle_count = 1, .hinge_count = 3, .triangles = triangle}, .deployed = x};
    ax_layer layer = {.design = &design, .state = AX_STATE_DEPLOYED, .extent = INFINITY};
    ax_sub3(x[1], x[0], u);
    ax_sub3(x[2], x[0], v);
    ax_cross(u, v, normal);
    for (int k = 0; k < 8; ++k) {
        ax_ray ray = ax_sun_ray((ax_sun){0.8 * k, (25 + 8 * k) * degree}, 0);
        ax_ground ground;
        assert_int_equal(ax_shade_ground(1, &layer, 1, &ray, 0.5, 40000, &ground, NULL), AX_OK);
        double* opacity = AX_NEW(double, ground.columns* ground.rows);
        assert_int_equal(ax_shade_map(1, &layer, 1, &ray, &ground, NULL, opacity, NULL), AX_OK);
        double area = 0;
        for (int c = 0; c < ground.columns * ground.rows; ++c)
            area += opacity[c] * ground.cell * ground.cell;
        assert_near(area, 0.5 * fabs(ax_dot3(normal, ray.to_sun)) / ray.to_sun[2], 1e-3);
        ax_free(opacity);
    }
}

// Millimetres beside metres; a layer cut down; the weights of two rays.
static void units_extent_and_weights(void** state)
{
    (void)state;
    ax_design metres = open_sheet(6, 1), millimetres = open_sheet(6, 1);
    millimetres.unit = AX_MILLIMETRE;
    for (int h = 0; h < millimetres.linkage.hinge_count; ++h)
        for (int d = 0; d < 3; ++d)
            millimetres.deployed[h][d] *= 1000;
    ax_layer both[2] = {{.design = &metres, .state = AX_STATE_DEPLOYED, .extent = INFINITY},
                        {.design = &millimetres, .state = AX_STATE_DEPLOYED, .extent = INFINITY}};
    ax_ray ray[2] = {ax_sun_ray((ax_sun){0, 50 * degree}, 0), ax_sun_ray((ax_sun){2, 70 * degree}, 0)};
    assert_near(mean_of(2, both, 1, ray), mean_of(1, both, 1, ray), 1e-6); // one covers the other
    double first = mean_of(1, both, 1, ray), second = mean_of(1, both, 1, ray + 1);
    double w = ray[0].weight / (ray[0].weight + ray[1].weight);
    assert_near(mean_of(1, both, 2, ray), w * first + (1 - w) * second, 1e-12);
    both[0].extent = 2;
    assert_true(mean_of(1, both, 1, ray) < 0.5 * first && mean_of(1, both, 1, ray) > 0);
    ax_design_free(&metres);
    ax_design_free(&millimetres);
}

// Two sheets that cover one another stop a quarter; side by side, a half: the search must find the way.
static void layers_are_arranged_for_the_shade_wanted(void** state)
{
    (void)state;
    ax_design sheet = open_sheet(20, 3);
    ax_ray ray = ax_sun_ray((ax_sun){0.4, 70 * degree}, 0);
    const ax_ground ground = {0, {-5, -6}, 0.1, 100, 100};
    static const double wanted[] = {0.3, 0.45, 0.5};
    for (int k = 0; k < 3; ++k) {
        ax_layer layers[2] = {{.design = &sheet, .state = AX_STATE_DEPLOYED, .extent = INFINITY},
                              {.design = &sheet, .state = AX_STATE_DEPLOYED, .extent = INFINITY}};
        const ax_shade_wish wish = {{0, -1}, 3.5, wanted[k]};
        const ax_shade_search search = {1, &wish, 1, 0, false, 8};
        ax_shade_found found;
        assert_int_equal(ax_shade_arrange(2, layers, 1, &ray, &ground, &search, NULL, &found, NULL), AX_OK);
        print_message("wanted %.2f: missed by %.3f, then %.4f after %d placements\n", wanted[k], found.before,
                      found.after, found.tried);
        assert_near(found.before, wanted[k] - 0.25, 0.01);
        assert_at_most(found.after, 0.01);
        assert_true(fabs(layers[1].move[0]) <= 1 && fabs(layers[1].move[1]) <= 1 && layers[1].turn == 0);
        assert_true(layers[0].move[0] == 0);
    }
    ax_design_free(&sheet);
}

static void what_cannot_be_is_refused(void** state)
{
    (void)state;
    ax_design sheet = open_sheet(2, 1);
    ax_layer layer = {.design = &sheet, .state = AX_STATE_SIMULATED, .extent = INFINITY};
    ax_ray ray = ax_sun_ray((ax_sun){0, 1}, 0), night = ax_sun_ray((ax_sun){0, -1}, 0);
    ax_ground ground = {0, {0, 0}, 1, 4, 4}, none = {0, {0, 0}, 1, 0, 4}, huge = {0, {0, 0}, 1e-3, 40000, 40000};
    double opacity[16];
    ax_shade_found found;
    assert_int_equal(ax_shade_map(1, &layer, 1, &ray, &ground, NULL, opacity, NULL), AX_BAD_INPUT);
    layer.state = AX_STATE_DEPLOYED;
    assert_int_equal(ax_shade_map(1, &layer, 0, &ray, &ground, NULL, opacity, NULL), AX_USAGE);
    assert_int_equal(ax_shade_map(1, &layer, 1, &night, &ground, NULL, opacity, NULL), AX_USAGE);
    assert_int_equal(ax_shade_map(1, &layer, 1, &ray, &none, NULL, opacity, NULL), AX_USAGE);
    assert_int_equal(ax_shade_map(1, &layer, 1, &ray, &huge, NULL, opacity, NULL), AX_USAGE);
    const ax_shade_wish off = {{99, 99}, 1, 0.5};
    const ax_shade_search search = {1, &off, 1, 0, false, 3};
    assert_int_equal(ax_shade_arrange(1, &layer, 1, &ray, &ground, &search, NULL, &found, NULL), AX_USAGE);
    ax_design_free(&sheet);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(the_sun_stands_where_others_have_it),
        cmocka_unit_test(rays_point_to_the_sun_in_the_frame_of_the_document),
        cmocka_unit_test(a_full_layer_stops_a_quarter_from_everywhere),
        cmocka_unit_test(layers_turned_against_one_another_multiply),
        cmocka_unit_test(a_leaning_panel_throws_its_projected_area),
        cmocka_unit_test(units_extent_and_weights),
        cmocka_unit_test(layers_are_arranged_for_the_shade_wanted),
        cmocka_unit_test(what_cannot_be_is_refused),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
