// The deployment's model against finite differences, and its equilibria against statics.
#include "deploy/deploy.h"

#include "base/random.h"
#include "base/vec.h"
#include "linalg/sparse.h"
#include "linkage/lattice.h"
#include "support/test.h"

#include <string.h>

// A hexagonal sheet of scale factor `scale`, its rim held on a circle that the fully open linkage would reach times `reach`.
#define ROW 0.1 // angle of the lattice rows
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
    assert_int_equal(ax_lattice_lay(&outline, spacing, ROW, (double[]){0, 0}, false, &s.lattice, NULL), AX_OK);
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

// The rim held in one way.
static ax_deploy_model model_held(const sheet* s, bool gravity, ax_hold hold)
{
    const ax_linkage* linkage = &s->lattice.linkage;
    double unit_load, down[3] = {0, 0, -1};
    ax_hold* holds = AX_NEW0(ax_hold, linkage->hinge_count);
    for (int h = 0; h < linkage->hinge_count; ++h)
        if (linkage->on_rim[h])
            holds[h] = hold;
    ax_deploy_model m = ax_deploy_model_make(linkage, (const double(*)[2])s->flat, (const double(*)[3])s->held, holds,
                                             gravity ? down : NULL, &unit_load);
    ax_free(holds);
    return m;
}

// The rim fixed, and the row of hinges through the middle held as an arch in a plane that leans by `lean`.
static ax_deploy_model model_arch(const sheet* s, bool gravity, double lean)
{
    const ax_linkage* linkage = &s->lattice.linkage;
    double unit_load, down[3] = {0, 0, -1}, across[3] = {-sin(ROW), cos(ROW), lean}, length = ax_norm3(across);
    ax_hold* holds = AX_NEW0(ax_hold, linkage->hinge_count);
    for (int h = 0; h < linkage->hinge_count; ++h) {
        const double* at = s->lattice.hinges[h];
        if (linkage->on_rim[h])
            holds[h].kind = AX_HOLD_FIXED;
        else if (fabs(cos(ROW) * at[1] - sin(ROW) * at[0]) < 1e-9) {
            holds[h].kind = AX_HOLD_IN_PLANE;
            for (int c = 0; c < 3; ++c)
                holds[h].normal[c] = across[c] / length;
        }
    }
    ax_deploy_model m = ax_deploy_model_make(linkage, (const double(*)[2])s->flat, (const double(*)[3])s->held, holds,
                                             gravity ? down : NULL, &unit_load);
    assert_true(m.slide_count > 3);
    ax_free(holds);
    return m;
}

static ax_deploy_model model_of(const sheet* s, bool gravity)
{
    return model_held(s, gravity, (ax_hold){.kind = AX_HOLD_FIXED});
}

// What rims slide on in these tests, round the place where make_sheet holds them. Kind 0 is a circle, kind 4 does not slide.
enum { CURVES = 4 };
static ax_curve* make_curve(int kind, double radius)
{
    double centre[3] = {0, 0, 0}, up[3] = {0, 0, 1}, a[3] = {1.03 * radius, 0, 0}, b[3] = {0, 0.97 * radius, 0};
    double points[24][3];
    for (int k = 0; k < 24; ++k) {
        double angle = 2 * AX_PI * k / 24;
        points[k][0] = radius * cos(angle), points[k][1] = radius * sin(angle);
        points[k][2] = kind == 2 ? 0.1 * radius * cos(2 * angle) : 0;
    }
    switch (kind) {
    case 0:
        return ax_curve_circle(centre, up, radius);
    case 1:
        return ax_curve_ellipse(centre, a, b);
    case 2:
        return ax_curve_spline((const double(*)[3])points, 24, true);
    default:
        return ax_curve_polyline((const double(*)[3])points, 24, true);
    }
}

static void gradient_and_hessian_agree_with_finite_differences(void** state)
{
    (void)state;
    sheet s = make_sheet(0.45, 1.5, 0.9);
    for (int gravity = 0; gravity < 2; ++gravity) {
        ax_deploy_model m = model_of(&s, gravity);
        const int rows[] = {0, 5, 9, 30, 12, 2, 30, 11}; // of four hinges, some of them held
        ax_deploy_model_keep_fair(&m, 2, 4, rows, (const double[]){1, -3, 3, -1}, 0.7 / m.unit);
        ax_deploy_model_keep_fair(&m, 2, 3, rows, (const double[]){1, -2, 1}, 0.2 / m.unit);
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
        ax_deploy_hessian_fill(&hessian, &m, (const double(*)[3])x, NULL, force, 0, 0);
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

// The same where the rim slides: derivatives along the curve or plane, curvature included.
static void hessian_agrees_with_differences_where_hinges_slide(void** state)
{
    (void)state;
    sheet s = make_sheet(0.45, 1.5, 0.9);
    for (int kind = 0; kind <= CURVES; ++kind) {
        ax_curve* curve = make_curve(kind, 1.5 * 0.9);
        ax_hold hold = {.kind = AX_HOLD_ON_CURVE, .curve = curve};
        ax_deploy_model m = kind == CURVES ? model_arch(&s, false, 0.3) : model_held(&s, kind % 2, hold);
        double(*x)[3] = ax_alloc((size_t)m.hinges, sizeof *x), (*y)[3] = ax_alloc((size_t)m.hinges, sizeof *y);
        double(*g)[3] = ax_alloc((size_t)m.hinges, sizeof *g), (*change)[3] = ax_alloc((size_t)m.hinges, sizeof *g);
        double *force = AX_NEW(double, m.edge_count), step = 1e-5;
        double *unit = AX_NEW0(double, 3 * m.unknowns), *column = AX_NEW(double, 3 * m.unknowns);
        ax_deploy_frame *frame = AX_NEW(ax_deploy_frame, m.slide_count),
                        *moved = AX_NEW(ax_deploy_frame, m.slide_count);
        ax_random random = {43};
        ax_deploy_start(&m, 0.2, x);
        for (int e = 0; e < m.edge_count; ++e)
            force[e] = ax_random_uniform(&random, -1, 1);
        ax_deploy_energy(&m, (const double(*)[3])x, g);
        ax_deploy_add_edge_forces(&m, (const double(*)[3])x, force, g);
        ax_deploy_frames(&m, (const double(*)[3])x, (const double(*)[3])g, frame);
        ax_deploy_hessian hessian = ax_deploy_hessian_make(&m);
        ax_deploy_hessian_fill(&hessian, &m, (const double(*)[3])x, frame, force, 0, 0);
        int checked = 0;
        for (int k = 0; k < m.slide_count; ++k)
            for (int c = 0; c < 3; ++c) {
                int h = m.slide[k], u = m.unknown[h];
                memset(change, 0, (size_t)m.hinges * sizeof *change);
                for (int side = -1; side <= 1; side += 2) {
                    memcpy(y, x, (size_t)m.hinges * sizeof *x);
                    for (int r = 0; r < 3; ++r)
                        y[h][r] += side * step * frame[k].allowed[r][c];
                    ax_deploy_return(&m, h, x[h], y[h]);
                    ax_deploy_energy(&m, (const double(*)[3])y, g);
                    ax_deploy_add_edge_forces(&m, (const double(*)[3])y, force, g);
                    ax_deploy_frames(&m, (const double(*)[3])y, (const double(*)[3])g, moved);
                    ax_deploy_allow(&m, moved, g);
                    for (int o = 0; o < m.hinges; ++o)
                        for (int r = 0; r < 3; ++r)
                            change[o][r] += side * g[o][r] / (2 * step);
                }
                ax_deploy_allow(&m, frame, change);
                for (int r = 0; r < 3; ++r)
                    unit[3 * u + r] = frame[k].allowed[r][c];
                ax_sparse_multiply(&hessian.blocks.matrix, unit, column, 1);
                memset(unit + 3 * u, 0, 3 * sizeof *unit);
                for (int v = 0; v < 3 * m.unknowns; ++v)
                    assert_near(column[v], change[m.hinge[v / 3]][v % 3], 1e-6);
                checked += frame[k].allowed[c][c] > 0.01;
            }
        assert_true(checked > m.slide_count / 2); // few stand at corners
        void* blocks[] = {x, y, g, change, force, unit, column, frame, moved};
        for (size_t k = 0; k < sizeof blocks / sizeof *blocks; ++k)
            ax_free(blocks[k]);
        ax_deploy_hessian_free(&hessian);
        ax_deploy_model_free(&m);
        ax_curve_free(curve);
    }
    free_sheet(&s);
}

static ax_deployment deploy(const ax_deploy_model* m, double (*x)[3], double* force)
{
    ax_deployment result;
    assert_true(ax_deploy(m, NULL, x, force, NULL, &result));
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
    ax_newton* newton = ax_newton_make(&m, NULL);
    for (int trial = 0; trial < 5; ++trial) {
        memcpy(y, x, (size_t)m.hinges * sizeof *x);
        for (int u = 0; u < m.unknowns; ++u)
            for (int k = 0; k < 3; ++k)
                y[m.hinge[u]][k] += ax_random_uniform(&random, -0.05, 0.05);
        memcpy(again, force, (size_t)m.edge_count * sizeof *force);
        ax_newton_result r = ax_newton_run(newton, y, again, AX_NEWTON_EXACT, 100, NULL);
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

// Solves with the rim on a curve, its hinges starting at equal gaps if `even`, and checks the answer by statics alone: hinges on
// the curve in their order, nothing pulls along it. Returns the energy, NaN if it is not exact.
static double slide(int kind, bool gravity, double reach, bool even, ax_deployment* result)
{
    sheet s = make_sheet(0.14, 1.5, reach);
    const ax_linkage* linkage = &s.lattice.linkage;
    ax_curve* curve = make_curve(kind, 1.5 * reach);
    if (even) { // in the order in which the nearest places have them
        int *rim = AX_NEW(int, linkage->hinge_count), n = 0;
        for (int h = 0; h < linkage->hinge_count; ++h)
            if (linkage->on_rim[h])
                rim[n++] = h;
        double* angle = AX_NEW(double, linkage->hinge_count);
        for (int k = 0; k < n; ++k)
            angle[k] = atan2(s.held[rim[k]][1], s.held[rim[k]][0]);
        for (int k = 0; k < n; ++k) {
            int rank = 0;
            for (int j = 0; j < n; ++j)
                rank += angle[j] < angle[k];
            double t = AX_PI * (2.0 * rank / n - 1);
            s.held[rim[k]][0] = 1.5 * reach * cos(t), s.held[rim[k]][1] = 1.5 * reach * sin(t);
        }
        ax_free(rim);
        ax_free(angle);
    }
    ax_deploy_model m = model_held(&s, gravity, (ax_hold){.kind = AX_HOLD_ON_CURVE, .curve = curve});
    double(*x)[3] = ax_alloc((size_t)m.hinges, sizeof *x), (*left)[3] = ax_alloc((size_t)m.hinges, sizeof *left);
    double *force = AX_NEW0(double, m.edge_count), unbalanced = 0, energy = NAN;
    *result = deploy(&m, x, force);
    if (result->exact) {
        assert_true(result->stable);
        assert_true(result->gap_least > 0);
        ax_deploy_energy(&m, (const double(*)[3])x, left);
        ax_deploy_add_edge_forces(&m, (const double(*)[3])x, force, left);
        for (int u = 0; u < m.unknowns; ++u) {
            int h = m.hinge[u];
            if (linkage->on_rim[h]) {
                double place[3], on[3], tangent[3], ignored[3];
                for (int c = 0; c < 3; ++c)
                    place[c] = x[h][c] * m.unit + m.centre[c];
                double t = ax_curve_nearest(curve, place, on);
                assert_at_most(ax_distance3(place, on), 1e-10 * m.unit);
                ax_curve_derivatives(curve, t, tangent, ignored);
                double pull = ax_dot3(tangent, left[h]) / ax_norm3(tangent);
                unbalanced += pull * pull;
            } else
                unbalanced += ax_dot3(left[h], left[h]);
        }
        assert_at_most(sqrt(unbalanced), 1.1e-10);
        energy = result->energy;
    }
    ax_free(x);
    ax_free(left);
    ax_free(force);
    ax_deploy_model_free(&m);
    ax_curve_free(curve);
    free_sheet(&s);
    return energy;
}

// A row of `links` triangles joined corner to corner, base edges of length 1 and apexes `depth` off the bases; its ends held
// `span` apart. Hinges 0 to links are the chain, the rest the apexes. One link hangs from both its base corners.
typedef struct strip {
    ax_linkage linkage;
    double (*flat)[2], (*held)[3];
    ax_hold* holds;
} strip;

static strip make_strip(int links, double depth, double span)
{
    int n = 2 * links + 1;
    strip s = {.linkage = {.triangle_count = links, .hinge_count = n}};
    s.linkage.triangles = ax_alloc((size_t)links, sizeof *s.linkage.triangles);
    s.linkage.hole_start = AX_NEW0(int, 1);
    s.linkage.opening_start = AX_NEW0(int, 1);
    s.linkage.on_rim = AX_NEW0(unsigned char, n);
    s.flat = ax_calloc((size_t)n, sizeof *s.flat);
    s.held = ax_calloc((size_t)n, sizeof *s.held);
    s.holds = AX_NEW0(ax_hold, n);
    for (int h = 0; h < n; ++h) {
        s.flat[h][0] = h <= links ? h : h - links - 0.5, s.flat[h][1] = h <= links ? 0 : depth;
        s.linkage.on_rim[h] = h == 0 || h >= links;
    }
    for (int t = 0; t < links; ++t)
        s.linkage.triangles[t][0] = t, s.linkage.triangles[t][1] = t + 1, s.linkage.triangles[t][2] = links + 1 + t;
    s.holds[0].kind = s.holds[links].kind = AX_HOLD_FIXED;
    s.held[links][0] = span;
    return s;
}

static void free_strip(strip* s)
{
    ax_linkage_free(&s->linkage);
    ax_free(s->flat);
    ax_free(s->held);
    ax_free(s->holds);
}

static void a_panel_hangs_straight_down_from_its_hinge(void** state)
{
    (void)state;
    strip s = make_strip(1, 0.7, 1);
    double unit_load, down[3] = {0, 0, -1}, x[3][3], force[3];
    ax_deploy_model m = ax_deploy_model_make(&s.linkage, (const double(*)[2])s.flat, (const double(*)[3])s.held,
                                             s.holds, down, &unit_load);
    assert_near(unit_load, 0.35, 1e-15);
    assert_int_equal(m.edge_count, 2);
    ax_deployment result = deploy(&m, x, force);
    assert_true(result.exact);
    assert_near(x[2][0] * m.unit, 0, 1e-9);
    assert_near(x[2][1] * m.unit, 0, 1e-9);
    assert_near(x[2][2] * m.unit, -0.7, 1e-9);
    // a third of the weight hangs in two legs
    double leg = hypot(0.5, 0.7);
    assert_near(force[0], 1.0 / 3 / 2 * leg / 0.7, 1e-9);
    assert_near(force[1], 1.0 / 3 / 2 * leg / 0.7, 1e-9);
    ax_deploy_model_free(&m);
    free_strip(&s);
}

// Every link is a rigid body in balance: moments about its left joint give one horizontal force for the whole chain. And with
// flat links its shape is the catenary.
static void a_strip_hangs_as_a_catenary(void** state)
{
    (void)state;
    enum { LINKS = 20 };
    const double depth = 0.08, span = 16;
    strip s = make_strip(LINKS, depth, span);
    double unit_load, down[3] = {0, 0, -1}, weight = 1.0 / LINKS, (*x)[3], *force, horizontal = 0;
    ax_deploy_model m = ax_deploy_model_make(&s.linkage, (const double(*)[2])s.flat, (const double(*)[3])s.held,
                                             s.holds, down, &unit_load);
    x = ax_alloc((size_t)m.hinges, sizeof *x), force = AX_NEW0(double, m.edge_count);
    ax_deployment result = deploy(&m, x, force);
    assert_true(result.exact && result.stable);
    double c = span; // of the catenary z = c cosh(x / c): its arc is as long as the chain
    for (int round = 0; round < 200; ++round)
        c += 0.5 * c * (2 * c * sinh(span / (2 * c)) - LINKS) / LINKS;
    for (int k = 0; k < LINKS; ++k) {
        const double *a = x[k], *b = x[k + 1], *apex = x[LINKS + 1 + k], right = 0.5 - (k + 1) * weight;
        double rise = b[2] - a[2];
        assert_near(a[1], 0, 1e-7); // in the plane of the ends and the load
        if (fabs(rise) < 0.1)
            continue;
        double pull = -((b[0] - a[0]) * (right + weight / 3) + (apex[0] - a[0]) * weight / 3) / rise;
        if (horizontal == 0)
            horizontal = pull;
        assert_near(pull, horizontal, 1e-8);
    }
    assert_near(horizontal, c / LINKS, 0.01 * c / LINKS);
    double sag = (x[0][2] - x[LINKS / 2][2]) * m.unit;
    assert_near(sag, c * (cosh(span / (2 * c)) - 1), 0.01 * sag);
    ax_free(x);
    ax_free(force);
    ax_deploy_model_free(&m);
    free_strip(&s);
}

static void rims_slide_to_one_state_from_even_starts(void** state)
{
    (void)state;
    for (int kind = 0; kind < CURVES; ++kind)
        for (int gravity = 0; gravity < 2; ++gravity) {
            ax_deployment a, b;
            double first = slide(kind, gravity, 0.93, false, &a), second = slide(kind, gravity, 0.93, true, &b);
            // the linkage has a side of its own to each part of an ellipse or a polygon, but none to a circle
            assert_near(first, second, kind == 0 ? 1e-9 : 0.01 * fabs(first));
        }
}

static void arches_stay_in_their_plane_and_push_across_it_alone(void** state)
{
    (void)state;
    sheet s = make_sheet(0.14, 1.5, 0.93);
    for (int gravity = 0; gravity < 2; ++gravity) {
        double energy[2];
        for (int leaning = 0; leaning < 2; ++leaning) {
            ax_deploy_model m = model_arch(&s, gravity, leaning ? 0.2 : 0);
            double(*x)[3] = ax_alloc((size_t)m.hinges, sizeof *x),
            (*left)[3] = ax_alloc((size_t)m.hinges, sizeof *left);
            double *force = AX_NEW0(double, m.edge_count), along = 0, across = 0;
            ax_deployment result = deploy(&m, x, force);
            assert_true(result.exact && result.stable);
            ax_deploy_energy(&m, (const double(*)[3])x, left);
            ax_deploy_add_edge_forces(&m, (const double(*)[3])x, force, left);
            for (int k = 0; k < m.slide_count; ++k) {
                int h = m.slide[k];
                double arm[3], n = ax_dot3(m.hold[h].normal, left[h]);
                ax_sub3(x[h], m.support[h], arm);
                assert_at_most(fabs(ax_dot3(arm, m.hold[h].normal)), 1e-12);
                across += n * n;
                for (int c = 0; c < 3; ++c)
                    left[h][c] -= n * m.hold[h].normal[c];
                along += ax_dot3(left[h], left[h]);
            }
            assert_at_most(sqrt(along), 1.1e-10);
            assert_true(!leaning || sqrt(across) > 1e-3); // an arch that leans must be held
            energy[leaning] = result.energy;
            ax_free(x);
            ax_free(left);
            ax_free(force);
            ax_deploy_model_free(&m);
        }
        assert_true(energy[0] < energy[1]);
    }
    free_sheet(&s);
}

static void a_rim_that_gathers_on_a_long_curve_is_told(void** state)
{
    (void)state;
    for (int kind = 0; kind < CURVES; ++kind)
        for (int gravity = 0; gravity < 2; ++gravity) {
            ax_deployment result;
            assert_true(isnan(slide(kind, gravity, 1.09, false, &result)));
            assert_true(result.gathered);
        }
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
    assert_false(ax_deploy(&m, NULL, x, force, &progress, &result));
    ax_free(x);
    ax_free(force);
    ax_deploy_model_free(&m);
    free_sheet(&s);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(gradient_and_hessian_agree_with_finite_differences),
        cmocka_unit_test(hessian_agrees_with_differences_where_hinges_slide),
        cmocka_unit_test(reactions_at_the_rim_balance_the_whole_load),
        cmocka_unit_test(no_feasible_neighbour_has_less_energy),
        cmocka_unit_test(a_panel_hangs_straight_down_from_its_hinge),
        cmocka_unit_test(a_strip_hangs_as_a_catenary),
        cmocka_unit_test(rims_slide_to_one_state_from_even_starts),
        cmocka_unit_test(arches_stay_in_their_plane_and_push_across_it_alone),
        cmocka_unit_test(a_rim_that_gathers_on_a_long_curve_is_told),
        cmocka_unit_test(supports_too_far_apart_are_not_called_exact),
        cmocka_unit_test(it_can_be_cancelled),
    };
    return cmocka_run_group_tests_name("deploy", tests, NULL, NULL);
}
