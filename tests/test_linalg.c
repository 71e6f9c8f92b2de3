// Sparse matrices and their factors against dense arithmetic.
#include "base/random.h"
#include "linalg/block_factor.h"
#include "linalg/cholesky.h"
#include "linalg/order.h"
#include "linalg/panels.h"

#include "support/test.h"

#include <string.h>

enum { N = 60 };

// A random positive definite matrix with about five entries in a row, sparse and dense.
static ax_sparse make(double dense[N][N], uint64_t seed)
{
    ax_random random = {seed};
    ax_entries entries = {0};
    for (int i = 0; i < N; ++i)
        for (int j = 0; j < N; ++j)
            dense[i][j] = 0;
    for (int k = 0; k < 3 * N; ++k) {
        int i = (int)ax_random_uniform(&random, 0, N), j = (int)ax_random_uniform(&random, 0, N);
        double w = i == j ? 0.5 : ax_random_uniform(&random, 0.1, 1);
        ax_entries_add(&entries, i, j, i == j ? w : -w);
        ax_entries_add(&entries, i, i, w);
        ax_entries_add(&entries, j, j, w);
        dense[i][j] += i == j ? w : -w;
        dense[j][i] += i == j ? 0 : -w;
        dense[i][i] += w;
        dense[j][j] += w;
    }
    for (int i = 0; i < N; ++i) {
        ax_entries_add(&entries, i, i, 0.1);
        dense[i][i] += 0.1;
    }
    return ax_entries_sparse(&entries, N);
}

static void entries_fold_sum_and_multiply(void** state)
{
    (void)state;
    static double dense[N][N];
    ax_sparse matrix = make(dense, 1);
    for (int j = 0; j < N; ++j)
        for (int k = matrix.start[j]; k < matrix.start[j + 1]; ++k) {
            assert_true(matrix.row[k] >= j && (k == matrix.start[j] || matrix.row[k] > matrix.row[k - 1]));
            assert_near(matrix.value[k], dense[matrix.row[k]][j], 1e-14);
        }
    ax_random random = {2};
    double x[2 * N], y[2 * N];
    for (int i = 0; i < 2 * N; ++i)
        x[i] = ax_random_uniform(&random, -1, 1);
    ax_sparse_multiply(&matrix, x, y, 2);
    for (int i = 0; i < 2 * N; ++i) {
        double sum = 0;
        for (int j = 0; j < N; ++j)
            sum += dense[i % N][j] * x[i / N * N + j];
        assert_near(y[i], sum, 1e-12);
    }
    ax_sparse_free(&matrix);
}

static void a_principal_part_keeps_the_rows_that_have_a_number(void** state)
{
    (void)state;
    static double dense[N][N];
    ax_sparse matrix = make(dense, 3);
    int index[N], old[N], count = 0;
    for (int i = 0; i < N; ++i) {
        index[i] = i % 3 ? count : -1;
        if (index[i] >= 0)
            old[count++] = i;
    }
    ax_sparse part = ax_sparse_principal(&matrix, index);
    assert_int_equal(part.n, count);
    double unit[N] = {0}, column[N];
    for (int j = 0; j < count; ++j) {
        unit[j] = 1;
        ax_sparse_multiply(&part, unit, column, 1);
        unit[j] = 0;
        for (int i = 0; i < count; ++i)
            assert_near(column[i], dense[old[i]][old[j]], 1e-14);
    }
    ax_sparse_free(&part);
    ax_sparse_free(&matrix);
}

static void every_kind_of_factor_solves(void** state)
{
    (void)state;
    static double dense[N][N];
    ax_sparse matrix = make(dense, 4);
    ax_random random = {5};
    double x[3 * N], b[3 * N], back[3 * N];
    for (int i = 0; i < 3 * N; ++i)
        x[i] = ax_random_uniform(&random, -1, 1);
    ax_sparse_multiply(&matrix, x, b, 3);
    ax_cholesky* factor = ax_cholesky_analyse(&matrix);
    assert_true(ax_cholesky_factor(factor, &matrix));
    ax_cholesky_solve(factor, b, back, 3);
    for (int i = 0; i < 3 * N; ++i)
        assert_near(back[i], x[i], 1e-11);
    ax_cholesky* ordered = ax_cholesky_analyse_ordered(&matrix, ax_cholesky_order(factor));
    double* again = AX_NEW(double, 3 * (size_t)matrix.n);
    assert_true(ax_cholesky_factor(ordered, &matrix));
    ax_cholesky_solve(ordered, b, again, 3);
    assert_true(ax_cholesky_count(ordered).entries == ax_cholesky_count(factor).entries);
    for (int k = 0; k < 3 * matrix.n; ++k)
        assert_near(again[k], back[k], 1e-12 * fmax(1, fabs(back[k])));
    ax_cholesky_free(ordered);
    ax_free(again);
    ax_cholesky_counters counters = ax_cholesky_count(factor);
    assert_true(counters.analyses == 1 && counters.factorisations == 1 && counters.solves == 1);
    ax_cholesky_free(factor);
    ax_sparse_free(&matrix);
}

static void an_indefinite_matrix_is_reported_and_the_factor_stays_usable(void** state)
{
    (void)state;
    static double dense[N][N];
    ax_sparse matrix = make(dense, 6);
    ax_cholesky* factor = ax_cholesky_analyse(&matrix);
    double diagonal = matrix.value[matrix.start[7]];
    matrix.value[matrix.start[7]] = -1;
    assert_false(ax_cholesky_factor(factor, &matrix));
    matrix.value[matrix.start[7]] = diagonal;
    assert_true(ax_cholesky_factor(factor, &matrix));
    ax_cholesky_free(factor);
    ax_sparse_free(&matrix);
}

// Blocks of three unknowns on a grid whose nodes meet all eight neighbours: separators are wide enough that threads share fronts.
static ax_blocks grid_of_blocks(int side, double (*place)[3])
{
    int count = 0, (*pairs)[2] = ax_alloc((size_t)(4 * side * side), sizeof *pairs);
    static const int step[4][2] = {{1, 0}, {0, 1}, {1, 1}, {-1, 1}};
    for (int v = 0; v < side * side; ++v) {
        place[v][0] = v % side, place[v][1] = v / side, place[v][2] = 0;
        for (int k = 0; k < 4; ++k) {
            int column = v % side + step[k][0], row = v / side + step[k][1];
            if (column >= 0 && column < side && row < side)
                pairs[count][0] = v, pairs[count++][1] = row * side + column;
        }
    }
    ax_blocks blocks = ax_blocks_make(side * side, 3, count, (const int(*)[2])pairs);
    ax_random random = {11};
    for (int u = 0; u < blocks.matrix.n; ++u)
        for (int e = blocks.matrix.start[u]; e < blocks.matrix.start[u + 1]; ++e)
            blocks.matrix.value[e] = blocks.matrix.row[e] == u ? 30 : ax_random_uniform(&random, -1, 1);
    ax_free(pairs);
    return blocks;
}

static void four_right_hand_sides_are_solved_like_one(void** state)
{
    (void)state;
    enum { SIDE = 20, SIDES = 4 };
    double(*place)[3] = ax_alloc(SIDE * SIDE, sizeof *place);
    ax_blocks blocks = grid_of_blocks(SIDE, place);
    size_t n = (size_t)blocks.matrix.n;
    double *b = AX_NEW(double, SIDES*n), *one = AX_NEW(double, n);
    ax_random random = {5};
    for (size_t u = 0; u < SIDES * n; ++u)
        b[u] = ax_random_uniform(&random, -1, 1);
    ax_block_factor* factor = ax_block_factor_make(&blocks, (const double(*)[3])place, NULL);
    assert_true(ax_block_factor_run(factor, &blocks));
    ax_block_factor_solve(factor, b + 2 * n, one, 1);
    ax_block_factor_solve(factor, b, b, SIDES);
    assert_memory_equal(one, b + 2 * n, n * sizeof *one);
    ax_block_factor_free(factor);
    ax_blocks_free(&blocks);
    ax_free(place);
    ax_free(b);
    ax_free(one);
}

// Two nodes far apart whose own curvature is negative: moves of energy below zero, each largest at one of them.
static void where_blocks_are_negative_is_told_alike_by_any_number_of_threads(void** state)
{
    (void)state;
    enum { SIDE = 60 };
    double(*place)[3] = ax_alloc(SIDE * SIDE, sizeof *place);
    ax_blocks blocks = grid_of_blocks(SIDE, place);
    const int soft[] = {7 * SIDE + 9, 51 * SIDE + 40};
    for (int k = 0; k < 2; ++k)
        blocks.matrix.value[blocks.matrix.start[3 * soft[k] + 1]] = -20;
    size_t n = (size_t)blocks.matrix.n;
    double *x = AX_NEW(double, n), *ax = AX_NEW(double, n), *first = AX_NEW0(double, AX_PANELS_TREES*n);
    for (int threads = 1; threads <= 3; ++threads) {
        ax_pool* pool = ax_pool_make(threads);
        ax_block_factor* factor = ax_block_factor_make(&blocks, (const double(*)[3])place, pool);
        assert_false(ax_block_factor_run(factor, &blocks));
        bool met[2] = {false, false};
        for (size_t part = 0; part < AX_PANELS_TREES; ++part) {
            if (!ax_block_factor_negative(factor, (int)part, x))
                continue;
            double energy = 0, most = 0;
            int at = 0;
            ax_sparse_multiply(&blocks.matrix, x, ax, 1);
            for (size_t u = 0; u < n; ++u) {
                energy += x[u] * ax[u];
                if (fabs(x[u]) > most)
                    most = fabs(x[u]), at = (int)u;
            }
            assert_true(energy < 0);
            for (int k = 0; k < 2; ++k)
                met[k] = met[k] || at == 3 * soft[k] + 1;
            if (threads == 1)
                memcpy(first + part * n, x, n * sizeof *x);
            else
                assert_memory_equal(first + part * n, x, n * sizeof *x);
        }
        assert_true(met[0] || met[1]); // both, if they are not of one part
        ax_block_factor_free(factor);
        ax_pool_free(pool);
    }
    ax_blocks_free(&blocks);
    void* arrays[] = {place, x, ax, first};
    for (size_t k = 0; k < sizeof arrays / sizeof *arrays; ++k)
        ax_free(arrays[k]);
}

static void blocks_are_solved_alike_by_any_number_of_threads(void** state)
{
    (void)state;
    enum { SIDE = 60 };
    double(*place)[3] = ax_alloc(SIDE * SIDE, sizeof *place);
    ax_blocks blocks = grid_of_blocks(SIDE, place);
    int n = blocks.matrix.n;
    double *x = AX_NEW(double, n), *b = AX_NEW(double, n), *first = AX_NEW(double, n), *back = AX_NEW(double, n);
    ax_random random = {12};
    for (int u = 0; u < n; ++u)
        x[u] = ax_random_uniform(&random, -1, 1);
    ax_sparse_multiply(&blocks.matrix, x, b, 1);
    for (int threads = 1; threads <= 3; ++threads) {
        ax_pool* pool = ax_pool_make(threads);
        ax_block_factor* factor = ax_block_factor_make(&blocks, (const double(*)[3])place, pool);
        double keep = blocks.matrix.value[blocks.matrix.start[n / 2]];
        blocks.matrix.value[blocks.matrix.start[n / 2]] = -1;
        assert_false(ax_block_factor_run(factor, &blocks)); // and the factor stays usable
        blocks.matrix.value[blocks.matrix.start[n / 2]] = keep;
        assert_true(ax_block_factor_run(factor, &blocks));
        ax_block_factor_solve(factor, b, back, 1);
        for (int u = 0; u < n; ++u)
            assert_near(back[u], x[u], 1e-12);
        if (threads == 1)
            memcpy(first, back, (size_t)n * sizeof *first);
        else
            assert_memory_equal(first, back, (size_t)n * sizeof *first);
        ax_block_factor_free(factor);
        ax_pool_free(pool);
    }
    ax_blocks_free(&blocks);
    void* arrays[] = {place, x, b, first, back};
    for (size_t k = 0; k < sizeof arrays / sizeof *arrays; ++k)
        ax_free(arrays[k]);
}

// Entries of the factor of a grid, one unknown a node, ordered by its nodes' places.
static double entries_by_place(const ax_blocks* blocks, const double (*place)[3])
{
    ax_sparse graph = {.n = blocks->n, .start = blocks->start, .row = blocks->row};
    int* order = AX_NEW(int, graph.n);
    ax_order_by_place(&graph, place, NULL, order);
    ax_panels* panels = ax_panels_analyse(&graph, order);
    double entries = ax_panels_entries(panels);
    ax_panels_free(panels);
    ax_free(order);
    return entries;
}

static void curved_rows_are_ordered_as_well_as_straight_ones(void** state)
{
    (void)state;
    enum { SIDE = 100 };
    double(*place)[3] = ax_alloc(SIDE * SIDE, sizeof *place);
    ax_blocks blocks = grid_of_blocks(SIDE, place);
    double straight = entries_by_place(&blocks, (const double(*)[3])place);
    for (int v = 0; v < SIDE * SIDE; ++v) { // a whirl: the farther out, the more it is turned
        double x = place[v][0] - SIDE / 2, y = place[v][1] - SIDE / 2, turn = 0.7 * hypot(x, y) / SIDE;
        place[v][0] = x * cos(turn) - y * sin(turn), place[v][1] = x * sin(turn) + y * cos(turn);
    }
    assert_at_most(entries_by_place(&blocks, (const double(*)[3])place) / straight, 1.05);
    ax_blocks_free(&blocks);
    ax_free(place);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(entries_fold_sum_and_multiply),
        cmocka_unit_test(a_principal_part_keeps_the_rows_that_have_a_number),
        cmocka_unit_test(every_kind_of_factor_solves),
        cmocka_unit_test(an_indefinite_matrix_is_reported_and_the_factor_stays_usable),
        cmocka_unit_test(blocks_are_solved_alike_by_any_number_of_threads),
        cmocka_unit_test(four_right_hand_sides_are_solved_like_one),
        cmocka_unit_test(where_blocks_are_negative_is_told_alike_by_any_number_of_threads),
        cmocka_unit_test(curved_rows_are_ordered_as_well_as_straight_ones),
    };
    return cmocka_run_group_tests_name("linalg", tests, NULL, NULL);
}
