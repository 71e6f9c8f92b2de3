// No joint: bare triangles, for models, tape, fabric backing, or a joint of one's own.
#include "fabricate/joint_work.h"

enum { INSET, CORNER };

static const ax_joint_parameter parameters[] = {
    [INSET] = {"inset", "mm", "how far edges are moved inward of the linkage's", 0, 100, 0},
    [CORNER] = {"corner", "mm", "radius of the corners", 0, 1000, 0},
};

static ax_status rule(const ax_joint_job* job, ax_panel_rule* out, ax_error* error)
{
    (void)error;
    *out = (ax_panel_rule){
        .inset = job->value[INSET],
        .ear = 1e300, // the disc touches both edges
        .radius = job->value[CORNER],
    };
    return AX_OK;
}

const ax_joint_type ax_joint_none = {
    .name = "none",
    .doc = "Bare triangles, to be joined in a way of one's own.",
    .parameters = parameters,
    .parameter_count = sizeof parameters / sizeof *parameters,
    .work = &(const struct ax_joint_work){.rule = rule},
};
