// ordered_on_curve: keeps points on a curve in their order along it, the hinges of a rim that slides. Nearest points alone let
// neighbours pass each other and gather; here their parameters are brought into order by isotonic regression (pool adjacent
// violators), on closed curves with a least gap, which also keeps them from running round.
#include "constraint/constraint_type.h"

static const double least_gap = 0.1; // of an even spread

// Difference of two parameters of a closed curve, the short way round.
static double short_way(double from, double to, double period)
{
    double d = to - from;
    return period > 0 ? d - period * floor(d / period + 0.5) : d;
}

// Nearest non-decreasing sequence (Ayer et al. 1955). `weight` is room for n numbers.
static void pool_violators(int n, double* z, int* weight)
{
    int blocks = 0;
    for (int i = 0; i < n; ++i) {
        z[blocks] = z[i], weight[blocks++] = 1;
        while (blocks > 1 && z[blocks - 2] > z[blocks - 1]) {
            int a = weight[blocks - 2], b = weight[blocks - 1];
            z[blocks - 2] = (a * z[blocks - 2] + b * z[blocks - 1]) / (a + b);
            weight[--blocks - 1] = a + b;
        }
    }
    for (int i = n, k = blocks; k-- > 0;) // from the back, so that nothing is overwritten unread
        for (int j = 0; j < weight[k]; ++j)
            z[--i] = z[k];
}

static void project_lane(const ax_place* place, int n, int l, const ax_lane3* restrict y, ax_lane3* restrict p)
{
    double z[AX_MOST_POINTS], out[3], sum = 0, period = place->period;
    int weight[AX_MOST_POINTS];
    z[0] = z[n - 1] = 0;
    for (int i = 0; i < n; ++i) {
        double x[3] = {y[i][0][l], y[i][1][l], y[i][2][l]};
        double t = place->parameter(place->geometry, x, out);
        for (int c = 0; c < 3; ++c)
            p[i][c][l] = out[c];
        z[i] = i ? z[i - 1] + short_way(z[i - 1], t, period) : t;
    }
    double sense = z[n - 1] >= z[0] ? 1 : -1, gap = period * least_gap / n, start = sense * z[0];
    double lo = start, hi = start;
    bool moved = false;
    for (int i = 0; i < n; ++i) {
        z[i] = sense * z[i] - i * gap;
        moved = moved || (i && z[i] < z[i - 1]);
        lo = z[i] < lo ? z[i] : lo, hi = z[i] > hi ? z[i] : hi, sum += z[i] / n;
    }
    double room = period - n * gap, range = hi - lo;
    if (period > 0 && range > room) {
        moved = true;
        for (int i = 0; i < n; ++i)
            z[i] = sum + (z[i] - sum) * (room / range);
    }
    if (!moved)
        return;
    pool_violators(n, z, weight);
    for (int i = 0; i < n; ++i) {
        place->point(place->geometry, sense * (z[i] + i * gap), out);
        for (int c = 0; c < 3; ++c)
            p[i][c][l] = out[c];
    }
}

// A rim is one constraint, and spare lanes repeat the last one: seven of eight lanes are then the same work.
static bool repeats(int points, int l, const ax_lane3* y)
{
    for (int k = 0; k < points; ++k)
        for (int c = 0; c < 3; ++c)
            if (y[k][c][l] != y[k][c][l - 1])
                return false;
    return true;
}

static void project(const ax_lane* restrict block, const ax_place* place, int points, const ax_lane3* restrict y,
                    ax_lane3* restrict p)
{
    (void)block;
    for (int l = 0; l < AX_W; ++l)
        if (l == 0 || !repeats(points, l, y))
            project_lane(place, points, l, y, p);
        else
            for (int k = 0; k < points; ++k)
                for (int c = 0; c < 3; ++c)
                    p[k][c][l] = p[k][c][l - 1];
}

const ax_constraint_type ax_constraint_ordered_on_curve = {
    .name = "ordered_on_curve",
    .doc = "Keeps points on a curve, in their order along it (nearest in the curve's parameter).",
    .reference =
        "Ayer et al. 1955, An Empirical Distribution Function for Sampling with Incomplete Information (pooling)",
    .pattern = AX_ROWS_POINTS,
    .least_points = 1,
    .most_points = AX_MOST_POINTS,
    .approximate = true,
    .needs_place = true,
    .project = project,
};
