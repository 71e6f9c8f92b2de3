// How a joint is done: what it asks of a panel's corners. Joint types are pure rules; outlines, checks, labels and sheets are made
// from the rules in one place (outline.h).
#pragma once

#include "ax/fabricate.h"

// What a joint knows when it lays down its rule.
typedef struct ax_joint_job {
    const double* value; // of the joint's parameters
    const ax_material* material;
} ax_joint_job;

// The rule of all panels. A panel is its triangle with edges moved inward by `inset`, and round each hinge a disc with its centre
// `ear` inward of the hinge on the bisector of the corner, or less where the disc would come off the edges.
typedef struct ax_panel_rule {
    double inset;       // >= 0
    double ear, radius; // disc: distance of its centre from the hinge, and radius; radius 0: a plain corner
    double hole_offset; // holes lie on the bisector as well
    double hole_radius; // 0: none
    double play;        // neighbours must stay this far apart, besides the kerf
    double ligament;    // left at each hinge, in one piece with both panels; 0: panels are separate
} ax_panel_rule;

struct ax_joint_work {
    // Raises standards, given by parameter, to what the material asks for; `chosen` tells which were not left alone. NULL: none.
    void (*suit)(const ax_material* material, const bool* chosen, double* value);
    // Checks the parameters against each other and the material. AX_CANNOT_REALISE names the limit.
    ax_status (*rule)(const ax_joint_job* job, ax_panel_rule* rule, ax_error* error);
    // Force that one joint is taken to bear, N.
    double (*rated)(const ax_joint_job* job);
    // Says what speaks against the joint without forbidding it; `edge` is the shortest of all panels, mm. NULL: nothing does.
    void (*doubt)(const ax_joint_job* job, double edge, char* words, size_t size);
    // What a test coupon tries: five values of one parameter, or factors of the one chosen. All 0: there is nothing to try.
    struct {
        int parameter;
        bool factors;
        double value[5];
    } trial;
    // Loose parts for `joints` hinges where two panels meet. NULL: none.
    void (*part)(const ax_joint_job* job, int joints, ax_cut_part* part);
};
