// Measures of states against surfaces whose figures are known.
#include "analysis/measure.h"
#include "base/vec.h"
#include "linkage/lattice.h"
#include "support/test.h"

#include <math.h>
#include <string.h>

// Hinges of a uniform sheet over a disk of radius 1, lifted by z = height(r); turned over with `side` -1.
typedef struct lifted {
    ax_lattice lattice;
    double (*places)[3], *curvature;
} lifted;

static lifted lift(double spacing, double side, double (*height)(double r))
{
    enum { N = 90 };
    double points[N][2];
    for (int k = 0; k < N; ++k)
        points[k][0] = cos(2 * AX_PI * k / N), points[k][1] = sin(2 * AX_PI * k / N);
    ax_outline outline = {N, (const double(*)[2])points};
    lifted s;
    assert_int_equal(ax_lattice_lay(&outline, spacing, 0.2, (double[]){0, 0}, false, &s.lattice, NULL), AX_OK);
    const ax_linkage* linkage = &s.lattice.linkage;
    s.places = ax_alloc((size_t)linkage->hinge_count, sizeof *s.places);
    for (int h = 0; h < linkage->hinge_count; ++h) {
        const double* at = s.lattice.hinges[h];
        s.places[h][0] = at[0], s.places[h][1] = at[1];
        s.places[h][2] = side * height(hypot(at[0], at[1]));
    }
    s.curvature = AX_NEW(double, linkage->triangle_count);
    ax_measure_mean_curvature(linkage, (const double(*)[3])s.places, s.curvature);
    return s;
}

static void free_lifted(lifted* s)
{
    ax_lattice_free(&s->lattice);
    ax_free(s->places);
    ax_free(s->curvature);
}

static double radius_of(const lifted* s, int t)
{
    double centre[2] = {0, 0};
    for (int k = 0; k < 3; ++k)
        for (int c = 0; c < 2; ++c)
            centre[c] += s->lattice.hinges[s->lattice.linkage.triangles[t][k]][c] / 3;
    return hypot(centre[0], centre[1]);
}

static double sphere(double r)
{
    return sqrt(1.3 * 1.3 - r * r);
}

static void a_sphere_bulges_everywhere_and_evenly(void** state)
{
    (void)state;
    for (double side = -1; side <= 1; side += 2) {
        lifted s = lift(0.12, side, sphere);
        for (int t = 0; t < s.lattice.linkage.triangle_count; ++t)
            assert_near(s.curvature[t] * 1.3, 1, 0.06); // at the rim too, where hinges are on one side only
        free_lifted(&s);
    }
}

// A bell whose foot flares: z = (1 - r^2 / b^2)^2 with b = 1.05.
static const double foot = 1.05;

static double bell(double r)
{
    double q = 1 - r * r / (foot * foot);
    return q * q;
}

static double bell_curvature(double r)
{
    double b2 = foot * foot, q = 1 - r * r / b2, slope = -4 * r / b2 * q;
    double bend = -4 / b2 * q + 8 * r * r / (b2 * b2), speed = sqrt(1 + slope * slope);
    return -(bend / (speed * speed * speed) + slope / r / speed) / 2;
}

static void a_foot_that_flares_dips_up_to_the_border(void** state)
{
    (void)state;
    lifted s = lift(0.08, 1, bell);
    int border = 0;
    for (int t = 0; t < s.lattice.linkage.triangle_count; ++t) {
        const int* corner = s.lattice.linkage.triangles[t];
        double r = radius_of(&s, t), exact = bell_curvature(r);
        bool rim = false;
        for (int k = 0; k < 3; ++k)
            rim |= s.lattice.linkage.on_rim[corner[k]];
        if (!rim && r < 0.8)
            assert_near(s.curvature[t], exact, 0.12);
        if (rim) { // on one side only, and the surface bends more and more: too little, but never the other way
            assert_true(exact < -0.3);
            assert_at_most(s.curvature[t], 0.5 * exact);
            ++border;
        }
    }
    assert_true(border > 30);
    free_lifted(&s);
}

static double plane(double r)
{
    return 0 * r;
}

static void a_plane_has_no_curvature(void** state)
{
    (void)state;
    lifted s = lift(0.15, 1, plane);
    for (int t = 0; t < s.lattice.linkage.triangle_count; ++t)
        assert_near(s.curvature[t], 0, 1e-9);
    free_lifted(&s);
}

static void a_turn_is_no_move_and_a_lift_is(void** state)
{
    (void)state;
    enum { COUNT = 40 };
    double from[COUNT][3], to[COUNT][3];
    for (int h = 0; h < COUNT; ++h) {
        double x = cos(h) * (1 + 0.1 * h), y = sin(h) * (2 + 0.1 * h);
        memcpy(from[h], (double[3]){5 + x, 3 + y, 0.2 * h}, sizeof *from);
    }
    double middle[2] = {0, 0};
    for (int h = 0; h < COUNT; ++h)
        middle[0] += from[h][0] / COUNT, middle[1] += from[h][1] / COUNT;
    for (int h = 0; h < COUNT; ++h) {
        double x = from[h][0] - middle[0], y = from[h][1] - middle[1];
        const double turned[3] = {middle[0] + 0.8 * x - 0.6 * y, middle[1] + 0.6 * x + 0.8 * y, from[h][2]};
        memcpy(to[h], turned, sizeof *to);
    }
    assert_near(ax_measure_move(COUNT, (const double(*)[3])from, (const double(*)[3])to), 0, 1e-12);
    double turned[COUNT][3];
    ax_measure_turned(COUNT, (const double(*)[3])from,
                      ax_measure_turn(COUNT, (const double(*)[3])from, (const double(*)[3])to), turned);
    for (int h = 0; h < COUNT; ++h)
        assert_near(ax_distance3(turned[h], to[h]), 0, 1e-12);
    to[7][2] += 0.25;
    assert_near(ax_measure_move(COUNT, (const double(*)[3])from, (const double(*)[3])to), 0.25, 1e-12);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_sphere_bulges_everywhere_and_evenly),
        cmocka_unit_test(a_foot_that_flares_dips_up_to_the_border),
        cmocka_unit_test(a_plane_has_no_curvature),
        cmocka_unit_test(a_turn_is_no_move_and_a_lift_is),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
