// Hinges that a Newton step holds back: the step that they take afterwards is that of the matrix without them.
#include "deploy/pins.h"

#include "base/random.h"
#include "support/test.h"

#include <string.h>

enum { SIDE = 12, NODES = SIDE * SIDE };

typedef struct grid {
    ax_blocks blocks;
    ax_block_factor* factor;
    ax_pins pins;
    double (*gradient)[3], (*d)[3], (*move)[3], (*product)[3];
} grid;

static grid make_grid(void)
{
    int count = 0, (*pairs)[2] = ax_alloc(2 * NODES, sizeof *pairs);
    double(*place)[3] = ax_calloc(NODES, sizeof *place);
    for (int v = 0; v < NODES; ++v) {
        place[v][0] = v % SIDE, place[v][1] = v / SIDE;
        if (v % SIDE + 1 < SIDE)
            pairs[count][0] = v, pairs[count++][1] = v + 1;
        if (v + SIDE < NODES)
            pairs[count][0] = v, pairs[count++][1] = v + SIDE;
    }
    grid g = {.blocks = ax_blocks_make(NODES, 3, count, (const int(*)[2])pairs), .pins = ax_pins_make(NODES)};
    ax_sparse* matrix = &g.blocks.matrix;
    ax_random random = {3};
    for (int u = 0; u < matrix->n; ++u)
        for (int e = matrix->start[u]; e < matrix->start[u + 1]; ++e)
            matrix->value[e] = matrix->row[e] == u ? 8 : ax_random_uniform(&random, -1, 1);
    g.factor = ax_block_factor_make(&g.blocks, (const double(*)[3])place, NULL);
    g.pins.spring = 50;
    double(**all[])[3] = {&g.gradient, &g.d, &g.move, &g.product};
    for (int k = 0; k < 4; ++k)
        *all[k] = ax_calloc(NODES, sizeof **all[k]);
    for (int v = 0; v < NODES; ++v)
        for (int c = 0; c < 3; ++c)
            g.gradient[v][c] = ax_random_uniform(&random, -1, 1);
    ax_free(pairs);
    ax_free(place);
    return g;
}

static void free_grid(grid* g)
{
    ax_blocks_free(&g->blocks);
    ax_block_factor_free(g->factor);
    ax_pins_free(&g->pins);
    void* arrays[] = {g->gradient, g->d, g->move, g->product};
    for (size_t k = 0; k < sizeof arrays / sizeof *arrays; ++k)
        ax_free(arrays[k]);
}

// Makes node v negative along y.
static void soften(grid* g, int v)
{
    g->blocks.matrix.value[g->blocks.matrix.start[3 * v + 1]] = -3;
}

// The step against the gradient with pins held and then moved; returns what pins gain.
static double step(grid* g, double reach)
{
    ax_sparse* matrix = &g->blocks.matrix;
    double* keep = ax_copy(matrix->value, (size_t)matrix->start[matrix->n], sizeof *keep);
    ax_pins_hold(&g->pins, &g->blocks);
    assert_true(ax_block_factor_run(g->factor, &g->blocks));
    memcpy(matrix->value, keep, (size_t)matrix->start[matrix->n] * sizeof *keep);
    ax_free(keep);
    for (int v = 0; v < NODES; ++v)
        for (int c = 0; c < 3; ++c)
            g->d[v][c] = -g->gradient[v][c];
    ax_block_factor_solve(g->factor, g->d[0], g->d[0], 1);
    ax_pins_follow(&g->pins, g->factor, 0, (const double(*)[3])g->d);
    return ax_pins_move(&g->pins, reach, g->move);
}

// Energy of the model at d, or with the pins' move.
static double energy(grid* g, bool moved)
{
    double sum = 0, (*at)[3] = ax_copy(g->d, NODES, sizeof *at);
    for (int v = 0; v < NODES && moved; ++v)
        for (int c = 0; c < 3; ++c)
            at[v][c] += g->move[v][c];
    ax_sparse_multiply(&g->blocks.matrix, at[0], g->product[0], 1);
    for (int v = 0; v < NODES; ++v)
        sum += ax_dot3(at[v], g->gradient[v]) + ax_dot3(at[v], g->product[v]) / 2;
    ax_free(at);
    return sum;
}

static void pins_that_need_not_be_take_the_step_of_all(void** state)
{
    (void)state;
    grid g = make_grid();
    assert_true(ax_pins_add(&g.pins, 40));
    assert_true(ax_pins_add(&g.pins, 41));
    assert_false(ax_pins_add(&g.pins, 40));
    step(&g, 1e3);
    assert_true(g.pins.definite);
    for (int v = 0; v < NODES; ++v)
        for (int c = 0; c < 3; ++c)
            g.d[v][c] += g.move[v][c];
    ax_sparse_multiply(&g.blocks.matrix, g.d[0], g.product[0], 1);
    for (int v = 0; v < NODES; ++v)
        for (int c = 0; c < 3; ++c)
            assert_near(g.product[v][c], -g.gradient[v][c], 1e-9);
    free_grid(&g);
}

static void negative_hinges_are_found_and_go_downhill_as_far_as_they_reach(void** state)
{
    (void)state;
    const double reach = 0.2;
    grid g = make_grid();
    soften(&g, 27);
    soften(&g, 100);
    ax_sparse* matrix = &g.blocks.matrix;
    double* keep = ax_copy(matrix->value, (size_t)matrix->start[matrix->n], sizeof *keep);
    while (!ax_block_factor_run(g.factor, &g.blocks)) {
        assert_true(ax_pins_find(&g.pins, g.factor, g.d));
        memcpy(matrix->value, keep, (size_t)matrix->start[matrix->n] * sizeof *keep);
        ax_pins_hold(&g.pins, &g.blocks);
    }
    memcpy(matrix->value, keep, (size_t)matrix->start[matrix->n] * sizeof *keep);
    ax_free(keep);
    assert_int_equal(g.pins.count, 2);
    assert_int_equal(g.pins.hinge[0] + g.pins.hinge[1], 127);
    double gain = step(&g, reach);
    assert_false(g.pins.definite);
    assert_true(gain > 0);
    assert_near(ax_pins_longest(&g.pins), reach, 0);
    assert_near(energy(&g, false) - energy(&g, true), gain, 1e-9);
    free_grid(&g);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(pins_that_need_not_be_take_the_step_of_all),
        cmocka_unit_test(negative_hinges_are_found_and_go_downhill_as_far_as_they_reach),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
