// How far states are from what they are to be: edges from their lengths, neighbours from lying side by side.
#include "form/state.h"

#include "base/vec.h"

#include <math.h>
#include <string.h>

double ax_form_sides_mean(const ax_form* f)
{
    double sum = 0;
    for (int t = 0; t < f->lattice.linkage.triangle_count; ++t)
        sum += f->side[t][0] + f->side[t][1] + f->side[t][2];
    return sum / (3.0 * f->lattice.linkage.triangle_count);
}

double ax_form_flat_error(const ax_form* f)
{
    double most = 0;
    bool shares = ax_form_shares(f);
    for (int t = 0; t < f->lattice.linkage.triangle_count; ++t)
        for (int k = 0, a, b; k < 3; ++k) {
            ax_form_edge_ends(f, t, k, &a, &b);
            double is = ax_distance2(f->flat[a], f->flat[b]);
            double asked = shares ? 0.5 * (is + ax_distance3(f->deployed[a], f->deployed[b])) : ax_form_edge(f, t, k);
            most = fmax(most, fabs(is / asked - 1));
        }
    return most;
}

double ax_form_deployed_error(const ax_form* f)
{
    double most = 0;
    for (int t = 0; t < f->lattice.linkage.triangle_count; ++t)
        for (int k = 0, a, b; k < 3; ++k) {
            ax_form_edge_ends(f, t, k, &a, &b);
            double flat = ax_distance2(f->flat[a], f->flat[b]);
            most = fmax(most, fabs(ax_distance3(f->deployed[a], f->deployed[b]) / flat - 1));
        }
    return most;
}

double ax_form_simulated_error(const ax_form* f)
{
    double most = 0;
    for (int t = 0; t < f->lattice.linkage.triangle_count; ++t)
        for (int k = 0, a, b; k < 3; ++k) {
            ax_form_edge_ends(f, t, k, &a, &b);
            most = fmax(most, fabs(ax_distance3(f->simulated[a], f->simulated[b]) / f->side[t][k] - 1));
        }
    return most;
}

void ax_form_panel_normal(const ax_form* f, int t, const double (*x)[3], double normal[3])
{
    const int* h = f->lattice.linkage.triangles[t];
    double a[3], b[3];
    ax_sub3(x[h[1]], x[h[0]], a);
    ax_sub3(x[h[2]], x[h[0]], b);
    ax_cross(a, b, normal);
}

int ax_form_folds(const ax_form* f, const double (*x)[3], int first[2])
{
    int folds = 0;
    for (int h = 0; h < f->lattice.linkage.hinge_count; ++h) {
        if (f->holder[h][1] < 0)
            continue;
        double a[3], b[3];
        ax_form_panel_normal(f, f->holder[h][0], x, a);
        ax_form_panel_normal(f, f->holder[h][1], x, b);
        if (ax_dot3(a, b) < 0 && folds++ == 0 && first)
            memcpy(first, f->holder[h], sizeof f->holder[h]);
    }
    return folds;
}
