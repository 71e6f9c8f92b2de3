// Time of one projection of every constraint type, in nanoseconds: median over rounds of a sweep through blocks that
// fit the second-level cache, so that arithmetic is timed and not memory.
//     bench_constraint [TYPE]
#include "ax/base.h"
#include "base/clock.h"
#include "base/random.h"
#include "constraint/constraint_type.h"
#include "constraint/place.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { ROUNDS = 301, BLOCKS = 64, MOST_ROWS = 6 };

static int ascending(const void* a, const void* b)
{
    double x = *(const double*)a, y = *(const double*)b;
    return (x > y) - (x < y);
}

// Points of a regular polygon, or a triangle, with a tenth of noise: what a solver sees on its way.
static void fill(const ax_constraint_type* type, int points, ax_random* random, ax_lane3* y)
{
    int rows = ax_row_count(type, points);
    for (int l = 0; l < AX_W; ++l) {
        double mean[3] = {0, 0, 0};
        for (int r = 0; r < rows; ++r)
            for (int i = 0; i < 3; ++i) {
                double t = 2 * AX_PI * r / rows, regular = i == 0 ? cos(t) : i == 1 ? sin(t) : 0;
                y[r][i][l] = regular + ax_random_uniform(random, -0.1, 0.1) * !(type->flat && i == 2);
                mean[i] += y[r][i][l] / rows;
            }
        for (int r = 0; r < rows && type->pattern == AX_ROWS_CENTRED; ++r)
            for (int i = 0; i < 3; ++i)
                y[r][i][l] -= mean[i];
    }
}

static void bench(const ax_constraint_type* type, const ax_place* place)
{
    int points = type->most_points < 6 ? type->most_points : 6;
    ax_lane* parameters = AX_NEW0(ax_lane, BLOCKS * type->lanes + 1);
    ax_lane3(*y)[MOST_ROWS] = ax_alloc(BLOCKS, sizeof *y);
    ax_lane3(*p)[MOST_ROWS] = ax_alloc(BLOCKS, sizeof *p);
    ax_random random = {1};
    for (int b = 0; b < BLOCKS; ++b) {
        ax_constraint_defaults(type, points, parameters + b * type->lanes);
        fill(type, points, &random, y[b]);
    }
    double seconds[ROUNDS];
    for (int round = 0; round < ROUNDS; ++round) {
        double start = ax_seconds();
        for (int b = 0; b < BLOCKS; ++b)
            type->project((const ax_lane*)(parameters + b * type->lanes), type->needs_place ? place : NULL, points,
                          (const ax_lane3*)y[b], p[b]);
        seconds[round] = ax_seconds() - start;
    }
    qsort(seconds, ROUNDS, sizeof *seconds, ascending);
    printf("%-22s %4d %10.2f\n", type->name, points, 1e9 * seconds[ROUNDS / 2] / (BLOCKS * AX_W));
    ax_free(parameters);
    ax_free(y);
    ax_free(p);
}

int main(int argc, char** argv)
{
    double control[12][3];
    for (int k = 0; k < 12; ++k) {
        double t = 2 * AX_PI * k / 12;
        control[k][0] = 1.5 * cos(t), control[k][1] = sin(t), control[k][2] = 0.2 * cos(3 * t);
    }
    ax_curve* curve = ax_curve_spline((const double(*)[3])control, 12, true);
    ax_place place = ax_curve_place(curve);
    int count;
    const ax_constraint_type* const* types = ax_constraint_types(&count);
    printf("%-22s %4s %10s   (on_geometry: a closed spline of 12 points)\n", "type", "n", "ns each");
    for (int t = 0; t < count; ++t)
        if (argc < 2 || strcmp(argv[1], types[t]->name) == 0)
            bench(types[t], &place);
    ax_curve_free(curve);
    return 0;
}
