#include "form/regions.h"

#include "ax/base.h"

static int root(int* of, int k)
{
    while (of[k] != k)
        k = of[k] = of[of[k]];
    return k;
}

int ax_form_regions(int count, const int* start, const int* hinges, int hinge_count, const double* off, int most,
                    ax_region* regions)
{
    int *of = AX_NEW(int, count + 1), *last = AX_NEW(int, hinge_count + 1), found = 0, kept = 0;
    for (int h = 0; h < hinge_count; ++h)
        last[h] = -1;
    for (int k = 0; k < count; ++k) {
        of[k] = k;
        for (int i = start[k]; i < start[k + 1] && off[k] > 0; ++i) {
            int* before = last + hinges[i];
            if (*before >= 0)
                of[root(of, *before)] = root(of, k);
            *before = k;
        }
    }
    ax_region* all = AX_NEW0(ax_region, count + 1); // by their roots
    for (int k = 0; k < count; ++k) {
        if (!(off[k] > 0))
            continue;
        ax_region* r = all + root(of, k);
        found += r->count++ == 0;
        if (off[k] > r->value)
            r->value = off[k], r->worst = k;
    }
    for (int k = 0; k < count; ++k) {
        if (all[k].count == 0)
            continue;
        int at = kept < most ? kept++ : most;
        for (; at > 0 && all[k].value > regions[at - 1].value; --at)
            if (at < most)
                regions[at] = regions[at - 1];
        if (at < most)
            regions[at] = all[k];
    }
    ax_free(all);
    ax_free(of);
    ax_free(last);
    return found;
}
