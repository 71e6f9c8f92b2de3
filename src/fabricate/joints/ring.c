// Rings through holes: each panel has a hole near every corner, and a ring joins two of them. Pulled taut, the ring's inside
// reaches from hole edge to hole edge with the hinge in its middle, so the holes lie half a ring and a hole's radius inward.
#include "fabricate/joint_work.h"
#include <math.h>
#include <stdio.h>

enum { RING, HOLE, EDGE, GAP };

static const ax_joint_parameter parameters[] = {
    [RING] = {"ring", "mm", "inner diameter of the ring", 2, 500, 16},
    [HOLE] = {"hole", "mm", "diameter of the holes, which the ring's wire must pass", 0.5, 100, 4},
    [EDGE] = {"edge", "mm", "material between a hole and the panel's outline", 0.2, 100, 2},
    [GAP] = {"gap", "mm", "least distance of neighbours", 0, 100, 1},
};

static double least_ring(const double* value)
{
    return value[HOLE] + 4 * value[EDGE] + 2 * value[GAP];
}

static void suit(const ax_material* material, const bool* chosen, double* value)
{
    if (!chosen[EDGE])
        value[EDGE] = fmax(value[EDGE], material->feature);
    if (!chosen[RING])
        value[RING] = fmax(value[RING], least_ring(value));
}

// The disc round a hole touches both edges of a corner of 60 degrees if its centre lies (radius + inset) / sin 30 degrees from the
// hinge, and the hole must not lie nearer to it.
static ax_status rule(const ax_joint_job* job, ax_panel_rule* out, ax_error* error)
{
    const double* v = job->value;
    if (v[EDGE] < job->material->feature)
        return ax_fail(
            error, AX_CANNOT_REALISE,
            "Holes %g mm from the outline tear out of %s, of which nothing narrower than %g mm should be left. "
            "Set edge=%g or more, or choose another material.",
            v[EDGE], job->material->name, job->material->feature, job->material->feature);
    double least = least_ring(v);
    if (v[RING] < least)
        return ax_fail(
            error, AX_CANNOT_REALISE,
            "Rings of %g mm are too small: holes of %g mm, %g mm from the outline, with neighbours %g mm apart, "
            "need rings of %g mm. Set ring=%g or more, or a smaller hole, edge or gap.",
            v[RING], v[HOLE], v[EDGE], v[GAP], least, least);
    *out = (ax_panel_rule){
        .inset = v[GAP] / 2,
        .ear = v[RING] / 2 + v[HOLE] / 2,
        .radius = v[HOLE] / 2 + v[EDGE],
        .hole_offset = v[RING] / 2 + v[HOLE] / 2,
        .hole_radius = v[HOLE] / 2,
        .play = v[GAP],
    };
    return AX_OK;
}

// The hole shears out of the panel along two lines, at 0.6 of the tensile strength.
static double rated(const ax_joint_job* job)
{
    return 2 * job->value[EDGE] * job->material->thickness * 0.6 * job->material->strength;
}

static void part(const ax_joint_job* job, int joints, ax_cut_part* out)
{
    snprintf(out->name, sizeof out->name, "ring, %g mm inside, wire under %g mm", job->value[RING], job->value[HOLE]);
    out->count = joints;
}

const ax_joint_type ax_joint_ring = {
    .name = "ring",
    .doc = "Holes near the corners; a ring joins two panels.",
    .parameters = parameters,
    .parameter_count = sizeof parameters / sizeof *parameters,
    .work =
        &(const struct ax_joint_work){
            .suit = suit, .rule = rule, .rated = rated, .trial = {EDGE, true, {0.5, 0.75, 1, 1.5, 2}}, .part = part},
};
