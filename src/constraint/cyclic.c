#include "constraint/cyclic.h"

#include "base/vec.h"

#include <stdbool.h>

// Half the angle under which the longest of n sides is seen from the centre, in (0, pi); beyond pi / 2 the centre is
// outside the polygon. Root of F(t) = t + sum over the others of asin(s_k / s_longest sin t) - pi; pi itself, where all
// sides are on a line, is a second root.
static double half_angle(int n, const double* ratio, int longest)
{
    double right = 0, total = 0;
    for (int k = 0; k < n; ++k)
        right += asin(ratio[k]), total += ratio[k];
    double lo = right >= AX_PI ? 0 : AX_PI / 2, hi = right >= AX_PI ? AX_PI / 2 : AX_PI, t = 0.5 * (lo + hi);
    if (right >= AX_PI && AX_PI / total < hi)
        t = AX_PI / total; // exact for equal sides
    for (int step = 0; step < 60; ++step) {
        double f = t - AX_PI, slope = 1, sine = sin(t), cosine = cos(t);
        for (int k = 0; k < n; ++k)
            if (k != longest) {
                double s = ratio[k] * sine, c = sqrt((1 - s) * (1 + s));
                f += asin(s), slope += c > 0 ? ratio[k] * cosine / c : 0;
            }
        if (f < 0)
            lo = t;
        else
            hi = t;
        double next = t - f / slope;
        if (!(next > lo && next < hi)) // or no number, where F has its maximum
            next = 0.5 * (lo + hi);
        if (fabs(next - t) <= 4e-16 * t)
            break;
        t = next;
    }
    return t;
}

void ax_cyclic_inscribe(int n, const double* side, double (*corner)[2])
{
    int longest = 0;
    double sum = 0, ratio[AX_CYCLIC_MOST], mean[2] = {0, 0}, angle = 0, x = 0, y = 0;
    for (int k = 0; k < n; ++k) {
        longest = side[k] > side[longest] ? k : longest;
        sum += side[k];
    }
    for (int k = 0; k < n; ++k)
        ratio[k] = side[longest] > 0 ? side[k] / side[longest] : 1;
    bool line = sum - side[longest] <= side[longest];
    double half = line ? 0 : half_angle(n, ratio, longest), sine = sin(half);

    // round the polygon from the end of the longest side: each chord turns by half its angle and half the next one's
    for (int i = 0, k = (longest + 1) % n; i < n; ++i, k = (k + 1) % n) {
        corner[k][0] = x, corner[k][1] = y;
        mean[0] += x / n, mean[1] += y / n;
        double turn = line ? 0 : (k == longest ? half : asin(ratio[k] * sine));
        x += side[k] * cos(angle + turn), y += side[k] * sin(angle + turn);
        angle += 2 * turn;
    }
    for (int k = 0; k < n; ++k)
        corner[k][0] -= mean[0], corner[k][1] -= mean[1];
}
