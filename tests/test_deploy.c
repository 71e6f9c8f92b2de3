// The deployment's model against finite differences, and its equilibria against statics.
#include "deploy/deploy.h"

#include "base/random.h"
#include "base/vec.h"
#include "linalg/sparse.h"
#include "linkage/lattice.h"
#include "support/test.h"

#include <string.h>

// A hexagonal sheet of scale factor `scale`, its rim held on a circle that the fully open linkage would reach times `reach`.
typedef struct sheet {
    ax_lattice lattice;
    double (*flat)[2], (*held)[3];
} sheet;

static sheet make_sheet(double spacing, double scale, double reach)
{
    enum { N = 120 };
    double points[N][2];
    for (int k = 0; k < N; ++k)
        points[k][0] = cos(2 * AX_PI * k / N), points[k][1] = sin(2 * AX_PI * k / N);
    ax_outline outline = {N, (const double(*)[2])points};
    sheet s;
    assert_int_equal(ax_lattice_lay(&outline, spacing, 0.1, (double[]){0, 0}, false, &s.lattice, NULL), AX_OK);
    const ax_linkage* linkage = &s.lattice.linkage;
    double* scales = AX_NEW(double, linkage->triangle_count);
    for (int t = 0; t < linkage->triangle_count; ++t)
        scales[t] = scale;
    s.flat = ax_alloc((size_t)linkage->hinge_count, sizeof *s.flat);
    s.held = ax_calloc((size_t)linkage->hinge_count, sizeof *s.held);
    ax_lattice_twist(&s.lattice, scales, s.flat);
    for (int h = 0; h < linkage->hinge_count; ++h)
        for (int c = 0; c < 2; ++c)
            s.held[h][c] = s.lattice.hinges[h][c] * scale * reach;
    ax_free(scales);
    return s;
}

static void free_sheet(sheet* s)
{
    ax_lattice_free(&s->lattice);
    ax_free(s->flat);
    ax_free(s->held);
}

static ax_deploy_model model_of(const sheet* s, bool gravity)
{
    double unit_load, down[3] = {0, 0, -1};
    return ax_deploy_model_make(&s->lattice.linkage, (const double(*)[2])s->flat, (const double(*)[3])s->held,
                                s->lattice.linkage.on_rim, gravity ? down : NULL, &unit_load);
}

static void gradient_and_hessian_agree_with_finite_differences(void** state)
{
    (void)state;
    sheet s = make_sheet(0.45, 1.5, 0.9);
    for (int gravity = 0; gravity < 2; ++gravity) {
        ax_deploy_model m = model_of(&s, gravity);
        double(*x)[3] = ax_alloc((size_t)m.hinges, sizeof *x), (*y)[3] = ax_alloc((size_t)m.hinges, sizeof *y);
        double(*g)[3] = ax_alloc((size_t)m.hinges, sizeof *g), (*plus)[3] = ax_alloc((size_t)m.hinges, sizeof *g);
        double(*minus)[3] = ax_alloc((size_t)m.hinges, sizeof *g), *force = AX_NEW(double, m.edge_count);
        double* c = AX_NEW(double, m.edge_count);
        ax_random random = {42};
        ax_deploy_start(&m, 0.2, x);
        for (int e = 0; e < m.edge_count; ++e)
            force[e] = ax_random_uniform(&random, -1, 1);

        // directional derivative of the energy
        double direction[3] = {0.3, -0.5, 0.8}, slope = 0, step = 1e-5;
        ax_deploy_energy(&m, (const double(*)[3])x, g);
        for (int h = 0; h < m.hinges; ++h)
            slope += ax_dot3(g[h], direction) * (h % 3 - 1);
        double value[2];
        for (int side = 0; side < 2; ++side) {
            for (int h = 0; h < m.hinges; ++h)
                for (int k = 0; k < 3; ++k)
                    y[h][k] = x[h][k] + (side ? step : -step) * direction[k] * (h % 3 - 1);
            value[side] = ax_deploy_energy(&m, (const double(*)[3])y, NULL);
        }
        assert_near(slope, (value[1] - value[0]) / (2 * step), 1e-8);

        // columns of the Hessian of energy + sum force c
        ax_deploy_hessian hessian = ax_deploy_hessian_make(&m);
        ax_deploy_hessian_fill(&hessian, &m, (const double(*)[3])x, force, 0, 0);
        double *unit = AX_NEW0(double, 3 * m.unknowns), *column = AX_NEW(double, 3 * m.unknowns);
        for (int u = 0; u < 3 * m.unknowns; u += 7) {
            for (int side = 0; side < 2; ++side) {
                double(*out)[3] = side ? plus : minus;
                memcpy(y, x, (size_t)m.hinges * sizeof *x);
                y[m.hinge[u / 3]][u % 3] += side ? step : -step;
                ax_deploy_energy(&m, (const double(*)[3])y, out);
                ax_deploy_add_edge_forces(&m, (const double(*)[3])y, force, out);
            }
            unit[u] = 1;
            ax_sparse_multiply(&hessian.blocks.matrix, unit, column, 1);
            unit[u] = 0;
            for (int v = 0; v < 3 * m.unknowns; ++v) {
                int h = m.hinge[v / 3];
                assert_near(column[v], (plus[h][v % 3] - minus[h][v % 3]) / (2 * step), 1e-7);
            }
        }
        void* blocks[] = {x, y, g, plus, minus, force, c, unit, column};
        for (size_t k = 0; k < sizeof blocks / sizeof *blocks; ++k)
            ax_free(blocks[k]);
        ax_deploy_hessian_free(&hessian);
        ax_deploy_model_free(&m);
    }
    free_sheet(&s);
}

static ax_deployment deploy(const ax_deploy_model* m, double (*x)[3], double* force)
{
    ax_deployment result;
    assert_true(ax_deploy(m, x, force, NULL, &result));
    return result;
}

// Reactions at the supports balance the whole load: for gravity it is 1 downwards, for pressure p times the plan area of the rim.
static void reactions_at_the_rim_balance_the_whole_load(void** state)
{
    (void)state;
    sheet s = make_sheet(0.14, 1.5, 0.93);
    for (int gravity = 0; gravity < 2; ++gravity) {
        ax_deploy_model m = model_of(&s, gravity);
        double(*x)[3] = ax_alloc((size_t)m.hinges, sizeof *x), (*g)[3] = ax_alloc((size_t)m.hinges, sizeof *g);
        double *force = AX_NEW0(double, m.edge_count), sum[3] = {0, 0, 0}, load[3] = {0, 0, 0};
        ax_deployment result = deploy(&m, x, force);
        assert_true(result.exact);
        assert_true(result.stable);
        assert_at_most(result.residuals.edge, 1e-10);
        assert_at_most(result.residuals.force, 1e-10);

        ax_deploy_energy(&m, (const double(*)[3])x, g);
        for (int h = 0; h < m.hinges; ++h)
            for (int k = 0; k < 3; ++k)
                load[k] -= g[h][k];
        memset(g, 0, (size_t)m.hinges * sizeof *g);
        ax_deploy_add_edge_forces(&m, (const double(*)[3])x, force, g); // what edges ask of the supports
        for (int h = 0; h < m.hinges; ++h)
            for (int k = 0; k < 3 && m.unknown[h] < 0; ++k)
                sum[k] += g[h][k];
        if (gravity) {
            assert_near(load[0], 0, 1e-12);
            assert_near(load[2], -1, 1e-12);
            // loads at the supports themselves do not pass through edges
            double direct = 0;
            for (int h = 0; h < m.hinges; ++h)
                direct += m.unknown[h] < 0 ? m.gravity[h][2] : 0;
            assert_near(sum[2], -(load[2] - direct), 1e-9);
        } else {
            // grad V over the free hinges balances the edges' pull on the rim
            double free_load = 0;
            ax_deploy_energy(&m, (const double(*)[3])x, g);
            for (int h = 0; h < m.hinges; ++h)
                free_load -= m.unknown[h] >= 0 ? g[h][2] : 0;
            assert_near(sum[2], -free_load, 1e-9);
            assert_true(free_load > 0.5); // most of the pressure lifts
        }
        ax_free(x);
        ax_free(g);
        ax_free(force);
        ax_deploy_model_free(&m);
    }
    free_sheet(&s);
}

static void no_feasible_neighbour_has_less_energy(void** state)
{
    (void)state;
    sheet s = make_sheet(0.3, 1.4, 0.95);
    ax_deploy_model m = model_of(&s, true);
    double(*x)[3] = ax_alloc((size_t)m.hinges, sizeof *x), (*y)[3] = ax_alloc((size_t)m.hinges, sizeof *y);
    double *force = AX_NEW0(double, m.edge_count), *again = AX_NEW0(double, m.edge_count);
    ax_deployment result = deploy(&m, x, force);
    assert_true(result.exact);
    double least = ax_deploy_energy(&m, (const double(*)[3])x, NULL);
    assert_near(result.energy, least, 1e-9);
    // pushed away and solved again from there it returns to the same place
    ax_random random = {7};
    ax_newton* newton = ax_newton_make(&m);
    for (int trial = 0; trial < 5; ++trial) {
        memcpy(y, x, (size_t)m.hinges * sizeof *x);
        for (int u = 0; u < m.unknowns; ++u)
            for (int k = 0; k < 3; ++k)
                y[m.hinge[u]][k] += ax_random_uniform(&random, -0.05, 0.05);
        memcpy(again, force, (size_t)m.edge_count * sizeof *force);
        ax_newton_result r = ax_newton_run(newton, y, again, 100, NULL);
        assert_true(r.exact && r.stable);
        assert_true(r.energy >= least - 1e-10);
        for (int h = 0; h < m.hinges; ++h)
            assert_near(ax_distance3(x[h], y[h]), 0, 1e-6);
    }
    ax_newton_free(newton);
    ax_free(x);
    ax_free(y);
    ax_free(force);
    ax_free(again);
    ax_deploy_model_free(&m);
    free_sheet(&s);
}

static void supports_too_far_apart_are_not_called_exact(void** state)
{
    (void)state;
    sheet s = make_sheet(0.2, 1.5, 1.04);
    ax_deploy_model m = model_of(&s, false);
    double(*x)[3] = ax_alloc((size_t)m.hinges, sizeof *x), *force = AX_NEW0(double, m.edge_count);
    ax_deployment result = deploy(&m, x, force);
    assert_false(result.exact);
    assert_true(result.residuals.edge > 1e-3);
    assert_true(result.force_over_tension > 100);
    ax_free(x);
    ax_free(force);
    ax_deploy_model_free(&m);
    free_sheet(&s);
}

static bool stop_at_once(void* context, const char* stage, double fraction, double residual)
{
    (void)context, (void)stage, (void)fraction, (void)residual;
    return false;
}

static void it_can_be_cancelled(void** state)
{
    (void)state;
    sheet s = make_sheet(0.2, 1.5, 0.95);
    ax_deploy_model m = model_of(&s, false);
    double(*x)[3] = ax_alloc((size_t)m.hinges, sizeof *x), *force = AX_NEW0(double, m.edge_count);
    ax_progress progress = {stop_at_once, NULL};
    ax_deployment result;
    assert_false(ax_deploy(&m, x, force, &progress, &result));
    ax_free(x);
    ax_free(force);
    ax_deploy_model_free(&m);
    free_sheet(&s);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(gradient_and_hessian_agree_with_finite_differences),
        cmocka_unit_test(reactions_at_the_rim_balance_the_whole_load),
        cmocka_unit_test(no_feasible_neighbour_has_less_energy),
        cmocka_unit_test(supports_too_far_apart_are_not_called_exact),
        cmocka_unit_test(it_can_be_cancelled),
    };
    return cmocka_run_group_tests_name("deploy", tests, NULL, NULL);
}
