// The projective solver: prices of changes, bits, energy, and small problems with known answers.
#include "solver/solver.h"

#include "base/random.h"
#include "constraint/place.h"
#include "linalg/order.h"
#include "solver/extrapolate.h"
#include "support/test.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

// A square grid of side x side points with its edges, corners held.
typedef struct grid {
    int side, points, edges;
    double (*place)[3];
    int (*edge)[2];
} grid;

static grid make_grid(int side)
{
    grid g = {.side = side, .points = side * side};
    g.place = ax_alloc((size_t)g.points, sizeof *g.place);
    g.edge = ax_alloc((size_t)(4 * g.points), sizeof *g.edge);
    ax_random random = {3};
    for (int v = 0; v < g.points; ++v) {
        g.place[v][0] = v % side, g.place[v][1] = v / side;
        g.place[v][2] = ax_random_uniform(&random, -0.1, 0.1);
        int next[3] = {v % side + 1 < side ? v + 1 : -1, v + side, v % side + 1 < side ? v + side + 1 : -1};
        for (int k = 0; k < 3; ++k)
            if (next[k] >= 0 && next[k] < g.points)
                g.edge[g.edges][0] = v, g.edge[g.edges][1] = next[k], ++g.edges;
    }
    return g;
}

static void free_grid(grid* g)
{
    ax_free(g->place);
    ax_free(g->edge);
}

static int length_lane(void)
{
    return ax_parameter_find(ax_constraint_find("edge_length"), "length")->offset;
}

// Edges 10 % longer than they are, corners held.
static ax_solver* grow(const grid* g, ax_pool* pool)
{
    ax_solver* s = ax_solver_make(g->points, (const double(*)[3])g->place, pool);
    int corners[4] = {0, g->side - 1, g->points - g->side, g->points - 1};
    int edges = ax_solver_add(s, ax_constraint_find("edge_length"), 2, g->edges, g->edge[0], 1, NULL);
    ax_solver_add(s, ax_constraint_find("closeness"), 1, 4, corners, 100, NULL);
    for (int e = 0; e < g->edges; ++e)
        ax_solver_set(s, edges, e, length_lane(), 1.1 * ax_solver_get(s, edges, e, length_lane()));
    return s;
}

static void each_change_costs_what_it_must(void** state)
{
    (void)state;
    grid g = make_grid(20);
    ax_solver* s = grow(&g, NULL);
    assert_true(ax_solver_iterate(s, 5));
    assert_int_equal(ax_solver_count(s).analyses, 1);
    assert_int_equal(ax_solver_count(s).factorisations, 1);
    double(*force)[3] = ax_calloc((size_t)g.points, sizeof *force);
    for (int e = 0; e < g.edges; ++e)
        ax_solver_set(s, 0, e, length_lane(), 1.3);
    force[g.points / 2][2] = 0.1;
    ax_solver_set_load(s, (const double(*)[3])force);
    assert_true(ax_solver_iterate(s, 5));
    assert_int_equal(ax_solver_count(s).factorisations, 1); // lengths and loads are free
    ax_solver_set_weight(s, 0, 2);
    assert_true(ax_solver_iterate(s, 5));
    assert_int_equal(ax_solver_count(s).factorisations, 2);
    assert_int_equal(ax_solver_count(s).analyses, 1); // a weight keeps the pattern
    ax_solver_add(s, ax_constraint_find("edge_length"), 2, 1, (int[]){0, g.points - 1}, 1, NULL);
    assert_true(ax_solver_iterate(s, 5));
    assert_int_equal(ax_solver_count(s).analyses, 2);
    ax_free(force);
    ax_solver_free(s);
    free_grid(&g);
}

static void the_steady_state_allocates_nothing(void** state)
{
    (void)state;
    grid g = make_grid(20);
    ax_solver* s = grow(&g, NULL);
    assert_true(ax_solver_iterate(s, 2));
    size_t before = ax_allocation_count();
    assert_true(ax_solver_iterate(s, 100));
    ax_solver_set(s, 0, 3, length_lane(), 1.5);
    assert_true(ax_solver_iterate(s, 10));
    assert_int_equal(ax_allocation_count(), before);
    ax_solver_free(s);
    free_grid(&g);
}

static void every_number_of_threads_gives_the_same_bits(void** state)
{
    (void)state;
    grid g = make_grid(150);
    size_t bytes = (size_t)g.points * sizeof *g.place;
    double(*one)[3] = ax_alloc((size_t)g.points, sizeof *one), (*many)[3] = ax_alloc((size_t)g.points, sizeof *many);
    for (int threads = 1; threads <= 4; ++threads) {
        ax_pool* pool = ax_pool_make(threads);
        ax_solver* s = grow(&g, pool);
        assert_true(ax_solver_iterate(s, 20));
        ax_solver_get_places(s, threads == 1 ? one : many);
        if (threads > 1)
            assert_memory_equal(one, many, bytes);
        ax_solver_free(s);
        ax_pool_free(pool);
    }
    ax_free(one);
    ax_free(many);
    free_grid(&g);
}

static void energy_never_rises_in_plain_iterations(void** state)
{
    (void)state;
    grid g = make_grid(12);
    ax_solver* s = grow(&g, NULL);
    double before = ax_solver_energy(s);
    for (int k = 0; k < 200; ++k) {
        assert_true(ax_solver_iterate(s, 1));
        double now = ax_solver_energy(s);
        assert_at_most(now, before * (1 + 1e-12) + 1e-14);
        before = now;
    }
    ax_solver_free(s);
    free_grid(&g);
}

// One point on an edge of length 1 hung from a held point: w (|x| - 1)^2 - 2 f |x| is least at |x| = 1 + f / w.
static void a_loaded_edge_stretches_by_force_over_weight(void** state)
{
    (void)state;
    const double place[2][3] = {{0, 0, 0}, {0, 0, -1}}, force[2][3] = {{0, 0, 0}, {0, 0, -0.3}};
    ax_solver* s = ax_solver_make(2, place, NULL);
    ax_solver_add(s, ax_constraint_find("edge_length"), 2, 1, (int[]){0, 1}, 5, NULL);
    ax_solver_add(s, ax_constraint_find("closeness"), 1, 1, (int[]){0}, 1e9, NULL);
    ax_solver_set_load(s, force);
    assert_true(ax_solver_iterate(s, 2000));
    double x[2][3];
    ax_solver_get_places(s, x);
    assert_near(x[1][2], -(1 + 0.3 / 5), 1e-6);

    // with multipliers the edge is rigid
    ax_solver_use_multipliers(s, true);
    assert_true(ax_solver_iterate(s, 2000));
    ax_solver_get_places(s, x);
    assert_near(x[1][2] - x[0][2], -1, 1e-9);
    assert_at_most(ax_solver_residual(s, 0), 1e-9);
    ax_solver_free(s);
}

// Implicit Euler in free fall: after n steps x = a h^2 n (n + 1) / 2.
static void a_free_point_falls_as_implicit_euler_says(void** state)
{
    (void)state;
    const double place[1][3] = {{1, 2, 3}};
    ax_solver* s = ax_solver_make(1, place, NULL);
    ax_solver_set_dynamics(s, &(ax_dynamics){2, 0.1, 1, {0, 0, -10}});
    for (int k = 0; k < 25; ++k)
        assert_true(ax_solver_step(s, 3));
    double x[1][3];
    ax_solver_get_places(s, x);
    assert_near(x[0][0], 1, 1e-12);
    assert_near(x[0][2], 3 - 10 * 0.01 * 25 * 26 / 2, 1e-9);
    ax_solver_free(s);
}

// Every two types on the same points, which are also pulled elsewhere, so that all want different things. Where projections are
// the nearest (all but approximate types) the energy never rises; either way forces come to balance and each group says what it
// could not have.
static void every_two_types_in_conflict_find_a_balance(void** state)
{
    (void)state;
    enum { POINTS = 12, SEED = 29 };
    print_message("seed %d\n", SEED);
    ax_curve* curve = ax_curve_circle((const double[3]){0.2, 0, 1}, (const double[3]){0, 1, 1}, 2);
    ax_place place = ax_curve_place(curve);
    int count, points[POINTS];
    const ax_constraint_type* const* types = ax_constraint_types(&count);
    ax_random random = {SEED};
    for (int a = 0; a < count; ++a)
        for (int b = a; b < count; ++b) {
            const ax_constraint_type* pair[2] = {types[a], types[b]};
            double start[2][POINTS][3], x[POINTS][3];
            for (int v = 0; v < POINTS; ++v)
                for (int c = 0; c < 3; ++c) {
                    points[v] = v;
                    start[0][v][c] = ax_random_uniform(&random, -1, 1);
                    start[1][v][c] = start[0][v][c] + ax_random_uniform(&random, -0.5, 0.5);
                }
            ax_solver* s = ax_solver_make(POINTS, (const double(*)[3])start[0], NULL);
            bool exact = true;
            for (int k = 0; k < 2; ++k) {
                int most = pair[k]->most_points < 6 ? pair[k]->most_points : 6;
                int each = most > pair[k]->least_points ? most : pair[k]->least_points;
                if (pair[k]->pattern == AX_ROWS_EDGES && each % 2)
                    --each;
                ax_solver_add(s, pair[k], each, 1, points, k ? 0.7 : 1.3, pair[k]->needs_place ? &place : NULL);
                exact = exact && !pair[k]->approximate;
                for (int c = 0; c < 3 && pair[k]->eliminated; ++c)
                    ax_solver_set(s, k, 0, c, start[1][0][c]); // not where the other one has it
            }
            int pull = ax_solver_add(s, ax_constraint_find("closeness"), 1, POINTS, points, 0.5, NULL);
            for (int v = 0; v < POINTS; ++v)
                for (int c = 0; c < 3; ++c)
                    ax_solver_set(s, pull, v, c, start[1][v][c]);
            assert_true(ax_solver_iterate(s, 1));
            double before = ax_solver_energy(s), first = before;
            for (int i = 0; i < 60 && exact; ++i) {
                assert_true(ax_solver_iterate(s, 1));
                double now = ax_solver_energy(s);
                if (now > before + 1e-13 * first)
                    print_error("%s with %s: energy rises\n", pair[0]->name, pair[1]->name);
                assert_at_most(now, before + 1e-13 * first);
                before = now;
            }
            ax_settle settle = AX_SETTLE_STANDARD;
            settle.force = exact ? 1e-9 : 1e-6, settle.length = 1, settle.iterations = 20000;
            ax_settled result = ax_solver_settle(s, &settle, NULL);
            if (result.end != AX_SETTLE_DONE)
                print_error("%s with %s: ends %d, force %g\n", pair[0]->name, pair[1]->name, result.end, result.force);
            assert_int_equal(result.end, AX_SETTLE_DONE);
            ax_solver_get_places(s, x);
            for (int v = 0; v < POINTS; ++v)
                assert_true(isfinite(x[v][0] + x[v][1] + x[v][2]));
            for (int k = 0; k < 2; ++k) {
                double residual = ax_solver_report(s, k).residual;
                bool met = pair[k]->eliminated || strcmp(pair[k]->name, "mouth_angle") == 0; // a wide range
                if (!met && !(residual > 1e-4))
                    print_error("%s with %s: %s has residual %g\n", pair[0]->name, pair[1]->name, pair[k]->name,
                                residual);
                assert_true(met || residual > 1e-4);
                assert_true(!pair[k]->eliminated || residual == 0);
            }
            ax_solver_free(s);
        }
    ax_curve_free(curve);
}

// It takes another way to the same end, accelerated too, and holds what no row does.
static void a_proximal_term_changes_the_way_and_not_the_end(void** state)
{
    (void)state;
    grid g = make_grid(8);
    double(*end[3])[3], first[3];
    for (int way = 0; way < 3; ++way) { // none, with it, and accelerated
        ax_solver* s = grow(&g, NULL);
        for (int e = 0; e < g.edges; ++e) // taut: one end only
            ax_solver_set(s, 0, e, length_lane(), 0.8 * ax_solver_get(s, 0, e, length_lane()));
        ax_solver_set_proximal(s, way ? 0.3 : 0);
        ax_solver_accelerate(s, way == 2 ? 5 : 0);
        end[way] = ax_alloc((size_t)g.points, sizeof **end);
        assert_true(ax_solver_iterate(s, 1));
        ax_solver_get_places(s, end[way]);
        first[way] = ax_distance3(end[way][1], g.place[1]);
        assert_true(ax_solver_iterate(s, 8000));
        ax_solver_get_places(s, end[way]);
        ax_solver_free(s);
    }
    assert_true(first[1] < 0.95 * first[0]); // the first step is shorter
    for (int v = 0; v < g.points; ++v)
        for (int way = 1; way < 3; ++way)
            assert_at_most(ax_distance3(end[0][v], end[way][v]), 1e-6);
    for (int way = 0; way < 3; ++way)
        ax_free(end[way]);

    int corner = 0;
    ax_solver* loose = ax_solver_make(g.points, (const double(*)[3])g.place, NULL);
    ax_solver_add(loose, ax_constraint_find("closeness"), 1, 1, &corner, 1, NULL);
    assert_false(ax_solver_iterate(loose, 1));
    ax_solver_set_proximal(loose, 1e-3);
    assert_true(ax_solver_iterate(loose, 10));
    double(*x)[3] = ax_alloc((size_t)g.points, sizeof *x);
    ax_solver_get_places(loose, x);
    for (int v = 0; v < g.points; ++v)
        assert_at_most(ax_distance3(x[v], g.place[v]), 1e-9);
    ax_free(x);
    ax_solver_free(loose);
    free_grid(&g);
}

static void a_point_bound_by_nothing_is_reported(void** state)
{
    (void)state;
    const double place[3][3] = {{0, 0, 0}, {1, 0, 0}, {2, 0, 0}};
    ax_solver* s = ax_solver_make(3, place, NULL);
    ax_solver_add(s, ax_constraint_find("closeness"), 1, 2, (int[]){0, 1}, 1, NULL);
    assert_false(ax_solver_iterate(s, 1));
    ax_solver_free(s);
}

static ax_sparse grid_laplacian(const grid* g, double diagonal)
{
    ax_entries entries = {0};
    for (int v = 0; v < g->points; ++v)
        ax_entries_add(&entries, v, v, diagonal);
    for (int e = 0; e < g->edges; ++e)
        ax_entries_add(&entries, g->edge[e][0], g->edge[e][1], -1);
    return ax_entries_sparse(&entries, g->points);
}

// Orders, factorises and solves with `pool` from places `place`, and compares with the residual of the system. Returns the entries.
static double solve_by_panels(const grid* g, const double (*place)[3], ax_pool* pool, ax_vec4* x)
{
    ax_sparse matrix = grid_laplacian(g, 6.5);
    int *order = AX_NEW(int, g->points), *seen = AX_NEW0(int, g->points);
    ax_order_by_place(&matrix, place, pool, order);
    for (int v = 0; v < g->points; ++v)
        assert_int_equal(seen[order[v]]++, 0); // a permutation
    ax_panels* panels = ax_panels_analyse(&matrix, order);
    assert_true(ax_panels_factor(panels, &matrix, pool));
    ax_random random = {9};
    for (int v = 0; v < g->points; ++v)
        for (int c = 0; c < 4; ++c)
            x[v][c] = ax_random_uniform(&random, -1, 1);
    ax_vec4 *b = ax_copy(x, (size_t)g->points, sizeof *b), *y = ax_alloc_aligned(ax_panels_rows(panels), sizeof *y);
    memcpy(y, b, (size_t)g->points * sizeof *y);
    ax_panels_solve(panels, pool, y);
    memcpy(x, y, (size_t)g->points * sizeof *x);
    double *column = AX_NEW(double, g->points), *product = AX_NEW(double, g->points);
    for (int c = 0; c < 4; ++c) {
        for (int k = 0; k < g->points; ++k)
            column[ax_panels_order(panels)[k]] = x[k][c];
        ax_sparse_multiply(&matrix, column, product, 1);
        for (int k = 0; k < g->points; ++k)
            assert_near(product[ax_panels_order(panels)[k]], b[k][c], 1e-12);
    }
    double entries = ax_panels_entries(panels);
    void* blocks[] = {order, seen, b, y, column, product};
    for (size_t k = 0; k < sizeof blocks / sizeof *blocks; ++k)
        ax_free(blocks[k]);
    ax_panels_free(panels);
    ax_sparse_free(&matrix);
    return entries;
}

// With and without a parallel top and shared fronts; two threads give the bits of one.
static void panels_solve_what_was_factorised(void** state)
{
    (void)state;
    const int sides[] = {1, 2, 3, 7, 30, 200};
    ax_pool* pool = ax_pool_make(2);
    for (int t = 0; t < 6; ++t) {
        grid g = make_grid(sides[t]);
        ax_vec4 *x = ax_alloc_aligned((size_t)g.points, sizeof *x), *y = ax_alloc_aligned((size_t)g.points, sizeof *y);
        solve_by_panels(&g, (const double(*)[3])g.place, NULL, x);
        solve_by_panels(&g, (const double(*)[3])g.place, pool, y);
        assert_memory_equal(x, y, (size_t)g.points * sizeof *x);
        ax_free(x);
        ax_free(y);
        free_grid(&g);
    }
    ax_pool_free(pool);
}

// Nodes in one place or on one line cannot be dissected by place; the factor must not fill up for all that.
static void places_that_tell_nothing_apart_still_order(void** state)
{
    (void)state;
    grid g = make_grid(60);
    ax_vec4* x = ax_alloc_aligned((size_t)g.points, sizeof *x);
    double(*place)[3] = ax_calloc((size_t)g.points, sizeof *place);
    double apart = solve_by_panels(&g, (const double(*)[3])g.place, NULL, x);
    assert_at_most(solve_by_panels(&g, (const double(*)[3])place, NULL, x), 1.5 * apart);
    for (int v = 0; v < g.points; ++v)
        place[v][1] = g.place[v][1];
    assert_at_most(solve_by_panels(&g, (const double(*)[3])place, NULL, x), 4 * apart);
    place[7][0] = NAN;
    assert_at_most(solve_by_panels(&g, (const double(*)[3])place, NULL, x), 1.5 * apart);
    ax_free(x);
    ax_free(place);
    free_grid(&g);
}

static void panels_report_an_indefinite_matrix_and_stay_usable(void** state)
{
    (void)state;
    grid g = make_grid(50);
    int* order = AX_NEW(int, g.points);
    ax_sparse sound = grid_laplacian(&g, 6.5), singular = grid_laplacian(&g, 0.5);
    ax_order_by_place(&sound, (const double(*)[3])g.place, NULL, order);
    ax_panels* panels = ax_panels_analyse(&sound, order);
    assert_true(ax_panels_factor(panels, &sound, NULL));
    assert_false(ax_panels_factor(panels, &singular, NULL));
    assert_true(ax_panels_factor(panels, &sound, NULL));
    ax_panels_free(panels);
    ax_sparse_free(&sound);
    ax_sparse_free(&singular);
    ax_free(order);
    free_grid(&g);
}

// z -> limit + M (z - limit) with three modes: five states tell the limit, from which the slowest still is four fifths away.
static void the_limit_of_slow_modes_is_found(void** state)
{
    (void)state;
    enum { SIZE = 500, STATES = 5, MODES = 3 };
    static const double rate[MODES] = {0.95, 0.8, -0.5};
    ax_random random = {11};
    double *limit = AX_NEW(double, SIZE), *mode[MODES];
    for (int k = 0; k < SIZE; ++k)
        limit[k] = ax_random_uniform(&random, -1, 1);
    for (int m = 0; m < MODES; ++m) {
        mode[m] = AX_NEW(double, SIZE);
        for (int k = 0; k < SIZE; ++k)
            mode[m][k] = ax_random_uniform(&random, -1, 1);
    }
    ax_extrapolation* e = ax_extrapolation_make(SIZE, STATES);
    for (int turn = 0; turn < 2; ++turn) { // the second time, the first state drops the five
        for (int i = 0; i < STATES; ++i) {
            double* z = ax_extrapolation_next(e);
            for (int k = 0; k < SIZE; ++k) {
                z[k] = limit[k];
                for (int m = 0; m < MODES; ++m)
                    z[k] += pow(rate[m], turn * STATES + i) * mode[m][k];
            }
            assert_ptr_equal(ax_extrapolation_last(e), z);
            assert_int_equal(ax_extrapolation_limit(e) != NULL, i == STATES - 1);
        }
        const double* found = ax_extrapolation_limit(e);
        assert_non_null(found);
        for (int k = 0; k < SIZE; ++k)
            assert_near(found[k], limit[k], 5e-3);
    }
    for (int i = 0; i < STATES; ++i) // what stands still shows no limit
        memcpy(ax_extrapolation_next(e), limit, SIZE * sizeof *limit);
    assert_null(ax_extrapolation_limit(e));
    ax_extrapolation_free(e);
    for (int m = 0; m < MODES; ++m)
        ax_free(mode[m]);
    ax_free(limit);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(each_change_costs_what_it_must),
        cmocka_unit_test(the_steady_state_allocates_nothing),
        cmocka_unit_test(every_number_of_threads_gives_the_same_bits),
        cmocka_unit_test(energy_never_rises_in_plain_iterations),
        cmocka_unit_test(a_loaded_edge_stretches_by_force_over_weight),
        cmocka_unit_test(a_free_point_falls_as_implicit_euler_says),
        cmocka_unit_test(every_two_types_in_conflict_find_a_balance),
        cmocka_unit_test(a_proximal_term_changes_the_way_and_not_the_end),
        cmocka_unit_test(a_point_bound_by_nothing_is_reported),
        cmocka_unit_test(panels_solve_what_was_factorised),
        cmocka_unit_test(places_that_tell_nothing_apart_still_order),
        cmocka_unit_test(panels_report_an_indefinite_matrix_and_stay_usable),
        cmocka_unit_test(the_limit_of_slow_modes_is_found),
    };
    return cmocka_run_group_tests_name("solver", tests, NULL, NULL);
}
