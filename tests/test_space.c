// Floor, volume and headroom against those of a spherical cap, and of walls that overhang.
#include "ax/space.h"

#include "support/shapes.h"
#include "support/test.h"

#include "base/vec.h"

#include <string.h>

static const double half_angle = 1.1; // of the cap

// What comes out differs from the cap's by that of the facets: with the square of their size.
static void cap_of(int triangles, ax_design* design)
{
    ax_mesh cap = shape_cap(60, half_angle);
    ax_design_options options = ax_design_options_default();
    ax_error error;
    options.triangles = triangles;
    options.load.kind = AX_LOAD_NONE;
    assert_int_equal(ax_design_from_target(&cap, &options, NULL, design, &error), AX_OK);
    ax_mesh_free(&cap);
}

static void a_cap_encloses_what_the_sphere_does(void** state)
{
    (void)state;
    double errors[2][3];
    for (int k = 0; k < 2; ++k) {
        ax_design design;
        ax_space s;
        cap_of(k ? 1600 : 400, &design);
        double ground = cos(half_angle), h = 0.3, height = 1 - ground;
        assert_int_equal(ax_space_measure(&design, AX_STATE_DEPLOYED, NAN, h, &s, NULL), AX_OK);
        assert_near(s.ground, ground, 1e-3);
        assert_near(s.height, height, 5e-3);
        double floor = AX_PI * (1 - ground * ground), volume = AX_PI * height * height * (3 - height) / 3;
        double level = s.ground + h;
        errors[k][0] = fabs(s.floor / floor - 1);
        errors[k][1] = fabs(s.volume / volume - 1);
        errors[k][2] = fabs(s.headroom_area / (AX_PI * (1 - level * level)) - 1);
        print_message("%d panels: floor off by %.2e, volume by %.2e, section by %.2e\n", design.linkage.triangle_count,
                      errors[k][0], errors[k][1], errors[k][2]);
        ax_design_free(&design);
    }
    for (int i = 0; i < 3; ++i) {
        assert_at_most(errors[0][i], 0.03);
        assert_at_most(errors[1][i], 0.4 * errors[0][i]);
    }
}

// One panel leaning out over its foot: it looks down, and a roof over both. Volumes by hand.
static void walls_that_overhang_count_against_the_roof(void** state)
{
    (void)state;
    // a pyramid upside down: roof (0, 0)-(2, 0)-(1, 2) at height 1, foot at (1, 0.7, 0); its three sides look down
    double x[4][3] = {{0, 0, 1}, {2, 0, 1}, {1, 2, 1}, {1, 0.7, 0}};
    int triangles[4][3] = {{0, 1, 2}, {1, 0, 3}, {2, 1, 3}, {0, 2, 3}};
    int no_holes[1] = {0};
    unsigned char supports[4] = {0, 0, 0, 1};
    ax_design design = {.linkage = {.triangle_count = 4,
                                    .hinge_count = 4,
                                    .triangles = triangles,
                                    .hole_start = no_holes,
                                    .opening_start = no_holes},
                        .deployed = x,
                        .supports = supports};
    ax_space s;
    assert_int_equal(ax_space_measure(&design, AX_STATE_DEPLOYED, NAN, 0.5, &s, NULL), AX_OK);
    assert_near(s.volume, 2.0 / 3, 1e-12); // a third of the roof, 2, times its height
    assert_near(s.headroom_area, 2 * 0.25, 1e-12);
    assert_near(s.floor, 0, 1e-12);
    assert_int_equal(ax_space_measure(&design, AX_STATE_DEPLOYED, 5, 0.5, &s, NULL), AX_BAD_INPUT);
    assert_int_equal(ax_space_measure(&design, AX_STATE_SIMULATED, 0, 0.5, &s, NULL), AX_BAD_INPUT);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_cap_encloses_what_the_sphere_does),
        cmocka_unit_test(walls_that_overhang_count_against_the_roof),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
