// Places of a form where something is the matter: things that share hinges, taken together.
#pragma once

typedef struct ax_region {
    int count;    // of things
    int worst;    // the one that is furthest off
    double value; // how far
} ax_region;

// Parts the `count` things with off[k] > 0 into regions whose things share hinges, and writes the `most` worst of them, the worst first.
// Thing k has hinges[start[k]] to hinges[start[k + 1] - 1], below `hinge_count`. Returns how many there are in all.
int ax_form_regions(int count, const int* start, const int* hinges, int hinge_count, const double* off, int most,
                    ax_region* regions);
