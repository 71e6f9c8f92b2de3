// Fewer sizes of panel, against answers known in closed form and a search of all divisions.
#include "ax/cluster.h"

#include "base/vec.h"
#include "support/sample.h"
#include "support/test.h"

#include <stdlib.h>

static ax_design sample;

static int set_up(void** state)
{
    (void)state;
    sample = sample_design();
    return 0;
}

static int tear_down(void** state)
{
    (void)state;
    ax_design_free(&sample);
    return 0;
}

static int ascending(const void* a, const void* b)
{
    double x = *(const double*)a, y = *(const double*)b;
    return (x > y) - (x < y);
}

// Least largest half width of `count` intervals over sorted values, by dynamic programming over all divisions.
static double best_division(int n, const double* x, int count)
{
    double *least = AX_NEW(double, n + 1), *next = AX_NEW(double, n + 1);
    for (int i = 0; i <= n; ++i)
        least[i] = i ? INFINITY : 0;
    for (int k = 0; k < count; ++k) {
        for (int i = 0; i <= n; ++i) {
            next[i] = least[i];
            for (int j = 0; j < i; ++j)
                next[i] = fmin(next[i], fmax(least[j], (x[i - 1] - x[j]) / 2));
        }
        double* spare = least;
        least = next, next = spare;
    }
    double result = least[n];
    ax_free(least);
    ax_free(next);
    return result;
}

static double edge(int t, int k)
{
    const int* h = sample.linkage.triangles[t];
    return 1000 * ax_distance2(sample.flat[h[(k + 1) % 3]], sample.flat[h[(k + 2) % 3]]);
}

static void no_division_is_better(void** state)
{
    (void)state;
    int n = sample.linkage.triangle_count;
    double* means = AX_NEW(double, n);
    for (int t = 0; t < n; ++t)
        means[t] = (edge(t, 0) + edge(t, 1) + edge(t, 2)) / 3;
    qsort(means, (size_t)n, sizeof *means, ascending);
    for (int count = 1; count < 30; count += 4) {
        ax_clusters c = ax_cluster_panels(&sample, count);
        assert_true(c.size_count <= count && c.size_count >= 1);
        assert_near(c.edge_max, best_division(n, means, count),
                    2e-4 * means[n - 1]); // as far as panels are equilateral
        assert_true(count > 1 || c.size_count == 1);
        double worst = 0;
        int panels = 0;
        for (int s = 0; s < c.size_count; ++s)
            panels += c.sizes[s].count;
        for (int t = 0; t < n; ++t)
            for (int k = 0; k < 3; ++k)
                worst = fmax(worst, fabs(edge(t, (k + c.turn[t]) % 3) - c.sizes[c.size_of[t]].edges[k]));
        assert_int_equal(panels, n);
        assert_near(c.edge_max, worst, 1e-9);
        ax_clusters_free(&c);
    }
    ax_free(means);
}

static void every_panel_its_own_size_costs_nothing(void** state)
{
    (void)state;
    ax_clusters c = ax_cluster_panels(&sample, 1000000);
    assert_near(c.edge_max, 0, 1e-9);
    assert_near(c.gap_max, 0, 1e-9);
    assert_near(c.line_max, 0, 1e-9);
    ax_clusters_free(&c);
}

static void as_few_as_keep_the_tolerance(void** state)
{
    (void)state;
    for (double tolerance = 0.5; tolerance < 50; tolerance *= 3) {
        ax_clusters c = ax_cluster_within(&sample, tolerance);
        assert_at_most(c.edge_max, tolerance * (1 + 1e-9));
        if (c.size_count > 1) {
            ax_clusters fewer = ax_cluster_panels(&sample, c.size_count - 1);
            assert_true(fewer.edge_max > 0.9 * tolerance);
            ax_clusters_free(&fewer);
        }
        ax_clusters_free(&c);
    }
}

// All panels of edge a but one of edge b, in one size of edge (a + b) / 2: e = |b - a| / 2 too long or too short each. A corner moves
// by e / sqrt 3 from its panel's middle; where panels face each other at a hinge the gaps of two add up.
static void the_misfit_of_equilateral_panels_is_known(void** state)
{
    (void)state;
    ax_design flat = sample;
    int n = sample.linkage.triangle_count;
    ax_linkage* l = &flat.linkage;
    // each panel apart: two hinges of two panels cannot have two lengths, so hinges are made to belong to one panel each
    l->triangle_count = 4, l->hinge_count = 12;
    int(*own)[3] = ax_alloc(4, sizeof *own), (*kept)[3] = l->triangles;
    double(*places)[2] = ax_alloc(12, sizeof *places), (*space)[3] = ax_calloc(12, sizeof *space);
    unsigned char* rim = AX_NEW(unsigned char, 12);
    const double a = 0.1, b = 0.104;
    for (int t = 0; t < 4; ++t)
        for (int k = 0; k < 3; ++k) {
            double side = t == 2 ? b : a, angle = 2 * AX_PI * k / 3;
            int h = 3 * t + k;
            own[t][k] = h, rim[h] = 1;
            places[h][0] = space[h][0] = t + side / sqrt(3) * cos(angle);
            places[h][1] = space[h][1] = side / sqrt(3) * sin(angle);
        }
    unsigned char* on_rim = l->on_rim;
    l->triangles = own, l->on_rim = rim;
    flat.flat = places, flat.deployed = space;
    ax_clusters c = ax_cluster_panels(&flat, 1);
    assert_near(c.edge_max, 2, 1e-6);
    assert_near(c.edge_rms, 2, 1e-6);
    assert_near(c.sizes[0].edges[0], 102, 1e-6);
    assert_near(c.gap_max, 2 / sqrt(3), 1e-6);
    assert_near(c.gap_rms, 2 / sqrt(3), 1e-6);
    assert_near(c.line_max, 2, 1e-6); // a line of one panel
    ax_clusters_free(&c);
    l->triangles = kept, l->on_rim = on_rim;
    l->triangle_count = n;
    ax_free(own);
    ax_free(places);
    ax_free(space);
    ax_free(rim);
}

// All panels lambda times as large: every line grows by the sum of its edges, every gap closes by both panels' growth.
static void lines_add_up(void** state)
{
    (void)state;
    ax_clusters c = ax_cluster_panels(&sample, 1);
    // by hand: walk every line of the deployed state as straight on as possible
    int n = sample.linkage.triangle_count;
    double longest = 0;
    for (int t = 0; t < n; ++t)
        for (int k = 0; k < 3; ++k)
            for (int s = 1; s < 3; ++s) {
                int at = t, from = k, to = (k + s) % 3;
                if (!sample.linkage.on_rim[sample.linkage.triangles[t][k]])
                    continue;
                double sum = 0;
                for (bool more = true; more;) {
                    int here = sample.linkage.triangles[at][to], last = sample.linkage.triangles[at][from], best = -1;
                    double straight = -2;
                    sum += c.sizes[0].edges[0] - edge(at, 3 - from - to);
                    more = false;
                    for (int u = 0; u < n; ++u)
                        for (int i = 0; i < 3 && u != at; ++i)
                            for (int d = 1; d < 3 && sample.linkage.triangles[u][i] == here; ++d) {
                                double x[3], y[3];
                                ax_sub3(sample.deployed[here], sample.deployed[last], x);
                                ax_sub3(sample.deployed[sample.linkage.triangles[u][(i + d) % 3]],
                                        sample.deployed[here], y);
                                double turn = ax_dot3(x, y) / (ax_norm3(x) * ax_norm3(y));
                                if (turn > straight)
                                    straight = turn, best = u, from = i, to = (i + d) % 3;
                            }
                    if (best >= 0)
                        at = best, more = true;
                }
                longest = fmax(longest, fabs(sum));
            }
    assert_near(c.line_max, longest, 0.01 * longest); // border panels are not quite equilateral
    assert_true(longest > c.edge_max);
    ax_clusters_free(&c);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(no_division_is_better),
        cmocka_unit_test(every_panel_its_own_size_costs_nothing),
        cmocka_unit_test(as_few_as_keep_the_tolerance),
        cmocka_unit_test(the_misfit_of_equilateral_panels_is_known),
        cmocka_unit_test(lines_add_up),
    };
    return cmocka_run_group_tests(tests, set_up, tear_down);
}
