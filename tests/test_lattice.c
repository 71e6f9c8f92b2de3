// The kagome linkage laid over outlines: connectivity, colouring, holes, and the uniform flat state against its formulas.
#include "linkage/lattice.h"

#include "analysis/measure.h"
#include "base/vec.h"
#include "support/test.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { CIRCLE = 200 };

// A closed curve around the unit circle; `waves` of height 0.3 make it concave.
static void outline(int waves, double (*points)[2])
{
    for (int k = 0; k < CIRCLE; ++k) {
        double t = 2 * AX_PI * k / CIRCLE, r = waves ? 1 + 0.3 * cos(waves * t) : 1;
        points[k][0] = r * cos(t), points[k][1] = r * sin(t);
    }
}

static ax_lattice lay(int waves, double spacing, double angle, bool inside)
{
    double points[CIRCLE][2];
    outline(waves, points);
    ax_outline line = {CIRCLE, (const double(*)[2])points};
    ax_lattice lattice;
    assert_int_equal(ax_lattice_lay(&line, spacing, angle, (double[]){0.013, -0.007}, inside, &lattice, NULL), AX_OK);
    return lattice;
}

static void every_hinge_joins_two_panels_of_opposite_turning_sense_or_lies_on_the_rim(void** state)
{
    (void)state;
    for (int waves = 0; waves <= 5; ++waves) {
        ax_lattice lattice = lay(waves, 0.07, 0.3 * waves, false);
        const ax_linkage* linkage = &lattice.linkage;
        int(*owner)[2] = ax_linkage_hinge_triangles(linkage), rim = 0;
        for (int h = 0; h < linkage->hinge_count; ++h) {
            assert_true(owner[h][0] >= 0);
            assert_int_equal(linkage->on_rim[h], owner[h][1] < 0);
            rim += owner[h][1] < 0;
            if (owner[h][1] >= 0)
                assert_int_equal(linkage->panels[owner[h][0]][2] + linkage->panels[owner[h][1]][2], 1);
        }
        assert_int_equal(3 * linkage->triangle_count, 2 * linkage->hinge_count - rim);
        // no ears: a panel hanging on one hinge would swing freely
        for (int t = 0; t < linkage->triangle_count; ++t) {
            const int* corner = linkage->triangles[t];
            assert_true(linkage->on_rim[corner[0]] + linkage->on_rim[corner[1]] + linkage->on_rim[corner[2]] <= 1);
        }
        ax_free(owner);
        ax_lattice_free(&lattice);
    }
}

static void holes_are_counter_clockwise_loops_of_six_and_openings_end_on_the_rim(void** state)
{
    (void)state;
    ax_lattice lattice = lay(3, 0.06, 0.2, false);
    const ax_linkage* linkage = &lattice.linkage;
    assert_true(linkage->hole_count > 100);
    for (int h = 0; h < linkage->hole_count; ++h) {
        const int* loop = linkage->hole_hinges + linkage->hole_start[h];
        assert_int_equal(linkage->hole_start[h + 1] - linkage->hole_start[h], 6);
        double area = 0;
        for (int k = 0; k < 6; ++k)
            area += ax_cross2(lattice.hinges[loop[k]], lattice.hinges[loop[(k + 1) % 6]]) / 2;
        // a regular hexagon of side spacing / 2
        assert_near(area, 1.5 * sqrt(3) * 0.03 * 0.03, 1e-12);
    }
    for (int h = 0; h < linkage->opening_count; ++h) {
        int first = linkage->opening_start[h], last = linkage->opening_start[h + 1] - 1;
        assert_true(last - first >= 2);
        assert_true(linkage->on_rim[linkage->opening_hinges[first]]);
        assert_true(linkage->on_rim[linkage->opening_hinges[last]]);
        for (int k = first + 1; k < last; ++k)
            assert_false(linkage->on_rim[linkage->opening_hinges[k]]);
    }
    ax_lattice_free(&lattice);
}

static void the_twisted_uniform_lattice_has_the_mouths_and_edges_of_its_scale_factor(void** state)
{
    (void)state;
    const double scales[] = {1, 1.25, 1.5, 1.8, 2};
    for (int k = 0; k < 5; ++k) {
        ax_lattice lattice = lay(0, 0.08, 0.1, false);
        const ax_linkage* linkage = &lattice.linkage;
        double* scale = AX_NEW(double, linkage->triangle_count);
        double(*flat)[2] = ax_alloc((size_t)linkage->hinge_count, sizeof *flat);
        for (int t = 0; t < linkage->triangle_count; ++t)
            scale[t] = scales[k];
        ax_lattice_twist(&lattice, scale, flat);
        ax_edge_measure edges = ax_measure_edges(linkage, (const double(*)[2])flat);
        assert_near(edges.min, scales[k] * 0.04, 1e-12); // L = lambda a / 2
        assert_near(edges.max, scales[k] * 0.04, 1e-12);
        int count;
        int(*mouth)[3] = ax_linkage_mouths(linkage, &count);
        double theta = acos(1 / scales[k]);
        for (int m = 0; m < count; ++m) {
            double beta = ax_mouth_angle(flat[mouth[m][0]], flat[mouth[m][1]], flat[mouth[m][2]]);
            assert_near(fmin(fabs(beta - (2 * AX_PI / 3 - 2 * theta)), fabs(beta - (2 * AX_PI / 3 + 2 * theta))), 0,
                        1e-6);
        }
        assert_near(ax_measure_mouths(linkage, (const double(*)[2])flat).min_deg, 120 - 2 * theta * 180 / AX_PI, 1e-6);
        ax_measure_scale(linkage, (const double(*)[2])flat, scale);
        for (int t = 0; t < linkage->triangle_count; ++t)
            assert_near(scale[t], scales[k], 1e-6);
        assert_int_equal(ax_measure_flipped(linkage, (const double(*)[2])flat, NULL), 0);
        ax_free(mouth);
        ax_free(flat);
        ax_free(scale);
        ax_lattice_free(&lattice);
    }
}

static void inside_keeps_every_hinge_within_the_outline(void** state)
{
    (void)state;
    ax_lattice lattice = lay(4, 0.05, 0.4, true);
    for (int h = 0; h < lattice.linkage.hinge_count; ++h) {
        double x = lattice.hinges[h][0], y = lattice.hinges[h][1], t = atan2(y, x);
        assert_at_most(hypot(x, y), 1 + 0.3 * cos(4 * t) + 1e-3);
    }
    ax_lattice_free(&lattice);
}

static void panels_keep_their_identity_when_the_outline_changes(void** state)
{
    (void)state;
    ax_lattice a = lay(0, 0.1, 0, false), b = lay(3, 0.1, 0, false);
    int common = 0;
    for (int s = 0; s < a.linkage.triangle_count; ++s)
        for (int t = 0; t < b.linkage.triangle_count; ++t)
            if (memcmp(a.linkage.panels[s], b.linkage.panels[t], sizeof *a.linkage.panels) == 0) {
                ++common;
                for (int k = 0; k < 3; ++k)
                    assert_near(ax_distance2(a.hinges[a.linkage.triangles[s][k]], b.hinges[b.linkage.triangles[t][k]]),
                                0, 1e-12);
            }
    assert_true(common > 100);
    ax_lattice_free(&a);
    ax_lattice_free(&b);
}

static void an_outline_too_small_for_the_spacing_is_refused(void** state)
{
    (void)state;
    double points[CIRCLE][2];
    outline(0, points);
    ax_outline line = {CIRCLE, (const double(*)[2])points};
    ax_lattice lattice;
    ax_error error;
    assert_int_equal(ax_lattice_lay(&line, 1.5, 0, (double[]){0, 0}, false, &lattice, &error), AX_CANNOT_REALISE);
    assert_non_null(strstr(error.message, "more triangles"));
}

static void overlaps_and_flips_are_found_where_they_are_made(void** state)
{
    (void)state;
    ax_lattice lattice = lay(0, 0.1, 0, false);
    const ax_linkage* linkage = &lattice.linkage;
    int first[1][2] = {{-1, -1}}, n = linkage->hinge_count;
    double(*flat)[2] = ax_copy(lattice.hinges, (size_t)n, sizeof *flat);
    assert_int_equal(ax_measure_overlaps(linkage, (const double(*)[2])flat, 1e-9, 1, first), 0);
    assert_int_equal(first[0][0], -1);
    // push a hinge across its hole and through the far side: its panels run into the one behind
    const int* loop = linkage->hole_hinges + linkage->hole_start[linkage->hole_count / 2];
    for (int d = 0; d < 2; ++d) {
        double across = (flat[loop[2]][d] + flat[loop[3]][d]) / 2 - flat[loop[0]][d];
        flat[loop[0]][d] += 1.2 * across;
    }
    assert_true(ax_measure_overlaps(linkage, (const double(*)[2])flat, 1e-9, 1, first) > 0);
    assert_true(first[0][0] >= 0 && first[0][1] > first[0][0]);
    assert_true(ax_measure_overlaps(linkage, (const double(*)[2])flat, 0.05, 1, first) == 0);
    for (int h = 0; h < n; ++h)
        flat[h][0] = -lattice.hinges[h][0], flat[h][1] = lattice.hinges[h][1];
    assert_int_equal(ax_measure_flipped(linkage, (const double(*)[2])flat, NULL), linkage->triangle_count);
    ax_free(flat);
    ax_lattice_free(&lattice);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(every_hinge_joins_two_panels_of_opposite_turning_sense_or_lies_on_the_rim),
        cmocka_unit_test(holes_are_counter_clockwise_loops_of_six_and_openings_end_on_the_rim),
        cmocka_unit_test(the_twisted_uniform_lattice_has_the_mouths_and_edges_of_its_scale_factor),
        cmocka_unit_test(inside_keeps_every_hinge_within_the_outline),
        cmocka_unit_test(panels_keep_their_identity_when_the_outline_changes),
        cmocka_unit_test(an_outline_too_small_for_the_spacing_is_refused),
        cmocka_unit_test(overlaps_and_flips_are_found_where_they_are_made),
    };
    return cmocka_run_group_tests_name("lattice", tests, NULL, NULL);
}
