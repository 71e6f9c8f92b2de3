// Fewer sizes of panel: panels that are nearly equal are cut alike, and what that costs.
#pragma once

#include "ax/design.h"

// A size in which panels are cut: the middle of its panels' edges, so that the largest error is least.
typedef struct ax_panel_size {
    double edges[3]; // mm, counter-clockwise, edge k opposite corner k
    int count;       // of panels
    double error;    // mm, largest of an edge
} ax_panel_size;

typedef struct ax_clusters {
    int size_count, panel_count;
    ax_panel_size* sizes; // from the smallest to the largest
    int* size_of;         // per panel
    int* turn;            // per panel: its corner that is the size's corner 0
    double edge_max, edge_rms;
    // Gaps that open (or overlap) at hinges and supports if every panel stays where it is deployed, moved as little as can be: what
    // joints have to take up.
    double gap_max, gap_rms;
    double line_max; // largest change in the length of a line of panels from rim to rim: what the frame has to take up
} ax_clusters;       // all in mm

void ax_clusters_free(ax_clusters* clusters); // also resets to an empty one; NULL allowed

// At most `count` (>= 1) sizes. Of equilateral panels the largest error is the least possible; of others it is at most about twice that
// (Gonzalez 1985), by panels that may be turned but not turned over. n log n + n count.
ax_clusters ax_cluster_panels(const ax_design* design, int count);

#define AX_CLUSTER_TOLERANCE 0.1 // mm, what a laser keeps on a good day

// As few sizes as keep every edge within `tolerance` mm (> 0): the fewest of equilateral panels, nearly so of others.
ax_clusters ax_cluster_within(const ax_design* design, double tolerance);
