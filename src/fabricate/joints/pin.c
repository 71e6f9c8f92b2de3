// Pins or rivets through overlapping ears: up panels lie below, down panels above, and a pin at the hinge goes through both.
#include "fabricate/joint_work.h"
#include <stdio.h>

#include "base/vec.h"

enum { PIN, PLAY, EDGE, INSET };

static const ax_joint_parameter parameters[] = {
    [PIN] = {"pin", "mm", "diameter of the pin or rivet", 0.5, 100, 3},
    [PLAY] = {"play", "mm", "by which holes are wider than the pin", 0, 5, 0.1},
    [EDGE] = {"edge", "mm", "material round a hole", 0.2, 100, 2},
    [INSET] = {"inset", "mm", "how far edges between the ears are moved inward", 0, 100, 1},
};
static const double pin_strength = 60; // MPa in shear: aluminium rivets

static void suit(const ax_material* material, const bool* chosen, double* value)
{
    if (!chosen[EDGE])
        value[EDGE] = fmax(value[EDGE], material->feature);
}

static ax_status rule(const ax_joint_job* job, ax_panel_rule* out, ax_error* error)
{
    const double* v = job->value;
    if (v[EDGE] < job->material->feature)
        return ax_fail(error, AX_CANNOT_REALISE,
                       "Ears of %g mm round a hole tear in %s, of which nothing narrower than %g mm should be left. "
                       "Set edge=%g or more, or choose another material.",
                       v[EDGE], job->material->name, job->material->feature, job->material->feature);
    double hole = (v[PIN] + v[PLAY]) / 2, radius = hole + v[EDGE];
    if (v[INSET] > radius - v[EDGE] / 2)
        return ax_fail(error, AX_CANNOT_REALISE,
                       "Edges %g mm inward leave ears of %g mm hanging by too little. Set inset=%g or less.", v[INSET],
                       2 * radius, radius - v[EDGE] / 2);
    *out = (ax_panel_rule){.inset = v[INSET], .ear = 0, .radius = radius, .hole_offset = 0, .hole_radius = hole};
    return AX_OK;
}

// The weaker of the ear, which shears along two lines at 0.6 of the tensile strength, and the pin.
static double rated(const ax_joint_job* job)
{
    double ear = 2 * job->value[EDGE] * job->material->thickness * 0.6 * job->material->strength;
    return fmin(ear, AX_PI / 4 * job->value[PIN] * job->value[PIN] * pin_strength);
}

static void part(const ax_joint_job* job, int joints, ax_cut_part* out)
{
    snprintf(out->name, sizeof out->name, "pin or rivet, %g mm, grip %g mm", job->value[PIN],
             2 * job->material->thickness);
    out->count = joints;
}

const ax_joint_type ax_joint_pin = {
    .name = "pin",
    .doc = "Overlapping ears in two layers; a pin or rivet at each hinge.",
    .two_layers = true,
    .parameters = parameters,
    .parameter_count = sizeof parameters / sizeof *parameters,
    .work =
        &(const struct ax_joint_work){
            .suit = suit, .rule = rule, .rated = rated, .trial = {PLAY, false, {0, 0.05, 0.1, 0.2, 0.3}}, .part = part},
};
