// The joint solve without a target surface: what was asked holds to rounding, and everything else stays.
#include "joint/joint.h"

#include "analysis/measure.h"
#include "base/random.h"
#include "base/vec.h"
#include "linkage/lattice.h"
#include "support/test.h"

#include <string.h>

// A sheet over a disk and its stereographic lift to a cap, both some per cent from congruent.
typedef struct draft {
    ax_lattice lattice;
    int n;
    double edge; // mean, flat
    double (*flat)[2], (*deployed)[3];
    double (*start)[3]; // the deployed state before the solve
    ax_joint_place* places;
} draft;

static draft make_draft(double spacing, double noise)
{
    enum { N = 90 };
    double outline[N][2];
    for (int k = 0; k < N; ++k)
        outline[k][0] = 0.6 * cos(2 * AX_PI * k / N), outline[k][1] = 0.6 * sin(2 * AX_PI * k / N);
    draft d = {0};
    assert_int_equal(ax_lattice_lay(&(ax_outline){N, (const double(*)[2])outline}, spacing, 0, (double[]){0, 0}, false,
                                    &d.lattice, NULL),
                     AX_OK);
    const ax_linkage* linkage = &d.lattice.linkage;
    d.n = linkage->hinge_count;
    d.flat = ax_alloc((size_t)d.n, sizeof *d.flat);
    d.deployed = ax_alloc((size_t)d.n, sizeof *d.deployed);
    d.places = ax_calloc((size_t)d.n, sizeof *d.places);
    double* scale = AX_NEW0(double, linkage->triangle_count);
    for (int t = 0; t < linkage->triangle_count; ++t)
        for (int k = 0; k < 3; ++k) {
            const double* x = d.lattice.hinges[linkage->triangles[t][k]];
            scale[t] += 1.85 / (1 + x[0] * x[0] + x[1] * x[1]) / 3;
        }
    ax_lattice_twist(&d.lattice, scale, d.flat);
    d.edge = ax_measure_edges(linkage, (const double(*)[2])d.flat).mean;
    ax_random random = {5};
    for (int h = 0; h < d.n; ++h) {
        const double* x = d.lattice.hinges[h];
        double r2 = x[0] * x[0] + x[1] * x[1], to = 1.85 / (1 + r2), move = noise * d.edge;
        double q[3] = {to * x[0], to * x[1], to * (1 - r2) / 2};
        for (int c = 0; c < 3; ++c)
            d.deployed[h][c] = q[c] + ax_random_uniform(&random, -move, move);
        for (int c = 0; c < 2; ++c)
            d.flat[h][c] += ax_random_uniform(&random, -move, move);
    }
    d.start = ax_copy(d.deployed, (size_t)d.n, sizeof *d.start);
    ax_free(scale);
    return d;
}

static void free_draft(draft* d)
{
    ax_lattice_free(&d->lattice);
    void* blocks[] = {d->flat, d->deployed, d->start, d->places};
    for (size_t k = 0; k < sizeof blocks / sizeof *blocks; ++k)
        ax_free(blocks[k]);
}

static ax_joint_problem problem_of(const draft* d)
{
    return (ax_joint_problem){.linkage = &d->lattice.linkage, .places = d->places, .mouth_min = 0.02, .scale_max = 2};
}

// Solves, and checks with the measuring code what every solution must keep. Returns the largest move of a hinge, in edges.
static double solve(draft* d, const ax_joint_problem* problem, ax_joint_result* result)
{
    assert_int_equal(ax_joint_solve(problem, d->flat, d->deployed, NULL, result, NULL), AX_OK);
    assert_true(result->converged);
    assert_at_most(result->steps, 12);
    assert_at_most(
        ax_measure_congruence(&d->lattice.linkage, (const double(*)[2])d->flat, (const double(*)[3])d->deployed),
        1e-11);
    assert_at_most(result->off_place, 1e-10);
    assert_at_most(result->unequal, 1e-10);
    ax_edge_measure edges = ax_measure_edges(&d->lattice.linkage, (const double(*)[2])d->flat);
    assert_at_most(edges.equilateral_inner, 1e-10);
    if (problem->border_unequal == 0)
        assert_at_most(edges.equilateral_border, 1e-10);
    assert_true(ax_measure_mouths(&d->lattice.linkage, (const double(*)[2])d->flat).min_deg >=
                problem->mouth_min * 180 / AX_PI);
    double most = 0;
    for (int h = 0; h < d->n; ++h)
        most = fmax(most, ax_distance3(d->deployed[h], d->start[h]) / d->edge);
    return most;
}

static void without_any_place_the_draft_hardly_moves(void** state)
{
    (void)state;
    draft d = make_draft(0.08, 0.02);
    ax_joint_problem problem = problem_of(&d);
    ax_joint_result result;
    problem.places = NULL;
    assert_at_most(solve(&d, &problem, &result), 0.15);
    // solved again it stays
    memcpy(d.start, d.deployed, (size_t)d.n * sizeof *d.start);
    assert_at_most(solve(&d, &problem, &result), 1e-9);
    assert_at_most(result.steps, 1);
    free_draft(&d);
}

static void rims_come_to_their_curve(void** state)
{
    (void)state;
    for (int kind = 0; kind < 4; ++kind) {
        draft d = make_draft(0.08, 0.02);
        double r2 = 0.36, radius = 1.85 / (1 + r2) * 0.6, height = 1.85 / (1 + r2) * (1 - r2) / 2, points[40][3];
        for (int k = 0; k < 40; ++k)
            points[k][0] = radius * cos(2 * AX_PI * k / 40), points[k][1] = radius * sin(2 * AX_PI * k / 40),
            points[k][2] = height + (kind == 2 ? 0.3 * d.edge * cos(4 * AX_PI * k / 40) : 0);
        const double centre[3] = {0, 0, height}, up[3] = {0, 0, 1}, a[3] = {radius * 1.02, 0, 0},
                     b[3] = {0, radius * 0.99, 0};
        ax_curve* curve = kind == 0   ? ax_curve_circle(centre, up, radius)
                          : kind == 1 ? ax_curve_ellipse(centre, a, b)
                          : kind == 2 ? ax_curve_spline((const double(*)[3])points, 40, true)
                                      : ax_curve_polyline((const double(*)[3])points, 40, true);
        for (int h = 0; h < d.n; ++h)
            if (d.lattice.linkage.on_rim[h])
                d.places[h] = (ax_joint_place){.kind = AX_JOINT_ON_CURVE, .curve = curve};
        ax_joint_problem problem = problem_of(&d);
        ax_joint_result result;
        solve(&d, &problem, &result);
        for (int h = 0; h < d.n; ++h)
            if (d.lattice.linkage.on_rim[h]) {
                double p[3];
                ax_curve_nearest(curve, d.deployed[h], p);
                assert_at_most(ax_distance3(p, d.deployed[h]), 1e-10 * d.edge);
            }
        ax_curve_free(curve);
        free_draft(&d);
    }
}

// The sheet draws a hinge outwards past a corner, from which both sides of its curve lead back.
static void what_is_drawn_past_a_corner_comes_to_lie_on_the_curve(void** state)
{
    (void)state;
    draft d = make_draft(0.08, 0);
    int out = 0;
    for (int h = 1; h < d.n; ++h)
        if (d.start[h][0] > d.start[out][0])
            out = h;
    double corner[3] = {d.start[out][0] - 0.3 * d.edge, d.start[out][1], d.start[out][2]}, points[3][3];
    for (int k = 0; k < 3; ++k) {
        memcpy(points[k], corner, sizeof corner);
        points[k][0] -= k == 1 ? 0 : 0.5;
        points[k][1] += 0.5 * (k - 1);
    }
    ax_curve* curve = ax_curve_polyline((const double(*)[3])points, 3, false);
    d.places[out] = (ax_joint_place){.kind = AX_JOINT_ON_CURVE, .curve = curve};
    ax_joint_problem problem = problem_of(&d);
    ax_joint_result result;
    solve(&d, &problem, &result);
    double on[3];
    ax_curve_nearest(curve, d.deployed[out], on);
    assert_at_most(ax_distance3(d.deployed[out], on), 1e-10 * d.edge);
    ax_curve_free(curve);
    free_draft(&d);
}

static void fixed_hinges_do_not_move(void** state)
{
    (void)state;
    draft d = make_draft(0.08, 0.01);
    for (int h = 0; h < d.n; ++h)
        if (d.lattice.linkage.on_rim[h])
            d.places[h].kind = AX_JOINT_FIXED;
    ax_joint_problem problem = problem_of(&d);
    ax_joint_result result;
    problem.border_unequal = 0.3; // a jagged rim that stays cannot take equal edges and full opening
    solve(&d, &problem, &result);
    for (int h = 0; h < d.n; ++h)
        if (d.lattice.linkage.on_rim[h])
            assert_at_most(ax_distance3(d.start[h], d.deployed[h]), 1e-10 * d.edge);
    free_draft(&d);
}

// Hinges of the lattice on the line through the origin at a multiple of 60 degrees; owned by the caller.
static int* line_through_the_middle(const draft* d, double angle, int* count)
{
    int* hinges = AX_NEW(int, d->n);
    *count = 0;
    for (int h = 0; h < d->n; ++h)
        if (fabs(sin(angle) * d->lattice.hinges[h][0] - cos(angle) * d->lattice.hinges[h][1]) < 1e-9)
            hinges[(*count)++] = h;
    assert_true(*count > 6);
    return hinges;
}

static double flatness(const draft* d, int count, const int* hinges, const double point[3], const double normal[3])
{
    double worst = 0;
    for (int k = 0; k < count; ++k) {
        double arm[3];
        ax_sub3(d->deployed[hinges[k]], point, arm);
        worst = fmax(worst, fabs(ax_dot3(arm, normal)));
    }
    return worst / d->edge;
}

static void arches_become_plane(void** state)
{
    (void)state;
    draft d = make_draft(0.08, 0.02);
    ax_joint_plane planes[3] = {0};
    int* hinges[3];
    for (int k = 0; k < 3; ++k)
        planes[k].hinges = hinges[k] = line_through_the_middle(&d, k * AX_PI / 3, &planes[k].count);
    planes[0].given = true;
    planes[0].normal[1] = 7;
    // the ends of the second arch are held: its plane goes through them
    int ends[2] = {hinges[1][0], hinges[1][0]};
    for (int k = 0; k < planes[1].count; ++k) {
        int h = hinges[1][k];
        if (d.lattice.hinges[h][1] < d.lattice.hinges[ends[0]][1])
            ends[0] = h;
        if (d.lattice.hinges[h][1] > d.lattice.hinges[ends[1]][1])
            ends[1] = h;
    }
    d.places[ends[0]].kind = d.places[ends[1]].kind = AX_JOINT_FIXED;
    ax_joint_problem problem = problem_of(&d);
    problem.plane_count = 3, problem.planes = planes;
    ax_joint_result result;
    assert_at_most(solve(&d, &problem, &result), 0.3);
    for (int k = 0; k < 2; ++k)
        assert_at_most(ax_distance3(d.start[ends[k]], d.deployed[ends[k]]), 1e-10 * d.edge);
    assert_at_most(flatness(&d, planes[0].count, hinges[0], (double[]){0, 0, 0}, (double[]){0, 1, 0}), 1e-10);
    for (int k = 1; k < 3; ++k) { // the plane of three of them holds all
        const double *a = d.deployed[hinges[k][0]], *b = d.deployed[hinges[k][planes[k].count / 2]],
                     *c = d.deployed[hinges[k][planes[k].count - 1]];
        double u[3], v[3], normal[3];
        ax_sub3(b, a, u), ax_sub3(c, a, v), ax_cross(u, v, normal);
        double length = ax_norm3(normal);
        for (int i = 0; i < 3; ++i)
            normal[i] /= length;
        assert_at_most(flatness(&d, planes[k].count, hinges[k], a, normal), 1e-9);
    }
    for (int k = 0; k < 3; ++k)
        ax_free(hinges[k]);
    free_draft(&d);
}

static void released_border_triangles_stay_within_their_bound(void** state)
{
    (void)state;
    double found[2];
    for (int bounded = 0; bounded < 2; ++bounded) {
        draft d = make_draft(0.08, 0.02);
        double r2 = 0.36, scale = 1.85 / (1 + r2);
        ax_curve* circle = ax_curve_circle((double[]){0, 0, scale * (1 - r2) / 2}, (double[]){0, 0, 1}, scale * 0.6);
        for (int h = 0; h < d.n; ++h)
            if (d.lattice.linkage.on_rim[h])
                d.places[h] = (ax_joint_place){.kind = AX_JOINT_ON_CURVE, .curve = circle};
        ax_joint_problem problem = problem_of(&d);
        problem.border_unequal = bounded ? 0.1 : INFINITY;
        ax_joint_result result;
        solve(&d, &problem, &result);
        found[bounded] = ax_measure_edges(&d.lattice.linkage, (const double(*)[2])d.flat).equilateral_border;
        ax_curve_free(circle);
        free_draft(&d);
    }
    assert_true(found[0] > 0.12);
    assert_at_most(found[1], 0.1);
    assert_true(found[1] > 0.04); // the bound binds
}

static void mouths_are_kept_as_wide_as_asked(void** state)
{
    (void)state;
    draft d = make_draft(0.08, 0.02);
    ax_joint_problem problem = problem_of(&d);
    double before = ax_measure_mouths(&d.lattice.linkage, (const double(*)[2])d.flat).min_deg;
    problem.mouth_min = (before + 4) * AX_PI / 180;
    ax_joint_result result;
    solve(&d, &problem, &result);
    free_draft(&d);
}

static void contradictions_are_reported(void** state)
{
    (void)state;
    draft d = make_draft(0.12, 0.01);
    ax_joint_plane planes[2] = {0};
    int* hinges = line_through_the_middle(&d, 0, &planes[0].count);
    planes[0].hinges = planes[1].hinges = hinges;
    planes[1].count = planes[0].count;
    planes[0].given = planes[1].given = true;
    planes[0].normal[1] = planes[1].normal[1] = 1;
    planes[1].point[1] = 0.5 * d.edge;
    ax_joint_problem problem = problem_of(&d);
    problem.plane_count = 2, problem.planes = planes;
    ax_joint_result result;
    assert_int_equal(ax_joint_solve(&problem, d.flat, d.deployed, NULL, &result, NULL), AX_OK);
    assert_true(result.off_place > 0.2 && result.off_place < 0.4);
    ax_free(hinges);
    free_draft(&d);
}

// Held ten edges apart, a hinge and all that lies two panels away cannot be part of one sheet.
static void where_a_solve_stalls_is_told(void** state)
{
    (void)state;
    draft d = make_draft(0.1, 0);
    const ax_linkage* linkage = &d.lattice.linkage;
    int middle = 0;
    for (int h = 1; h < d.n; ++h)
        if (ax_distance2(d.lattice.hinges[h], (double[]){0, 0}) <
            ax_distance2(d.lattice.hinges[middle], (double[]){0, 0}))
            middle = h;
    for (int h = 0; h < d.n; ++h)
        if (h == middle || ax_distance2(d.lattice.hinges[h], d.lattice.hinges[middle]) > 0.15)
            d.places[h].kind = AX_JOINT_FIXED;
    d.deployed[middle][2] += 10 * d.edge;
    ax_joint_problem problem = problem_of(&d);
    ax_joint_result result;
    assert_int_equal(ax_joint_solve(&problem, d.flat, d.deployed, NULL, &result, NULL), AX_OK);
    assert_false(result.converged);
    assert_near(ax_measure_congruence(linkage, (const double(*)[2])d.flat, (const double(*)[3])d.deployed),
                result.congruence, 1e-9 * result.congruence);
    const ax_linkage there = {
        .hinge_count = d.n, .triangle_count = 1, .triangles = linkage->triangles + result.congruence_at};
    assert_near(ax_measure_congruence(&there, (const double(*)[2])d.flat, (const double(*)[3])d.deployed),
                result.congruence, 1e-9 * result.congruence);
    assert_at_most(ax_distance2(d.lattice.hinges[there.triangles[0][0]], d.lattice.hinges[middle]), 0.3);
    free_draft(&d);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(without_any_place_the_draft_hardly_moves),
        cmocka_unit_test(rims_come_to_their_curve),
        cmocka_unit_test(what_is_drawn_past_a_corner_comes_to_lie_on_the_curve),
        cmocka_unit_test(fixed_hinges_do_not_move),
        cmocka_unit_test(arches_become_plane),
        cmocka_unit_test(released_border_triangles_stay_within_their_bound),
        cmocka_unit_test(mouths_are_kept_as_wide_as_asked),
        cmocka_unit_test(contradictions_are_reported),
        cmocka_unit_test(where_a_solve_stalls_is_told),
    };
    return cmocka_run_group_tests_name("joint", tests, NULL, NULL);
}
