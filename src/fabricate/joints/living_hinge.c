// Living hinges: the whole sheet is one piece, and at each hinge a ligament is left between the two openings that meet there. The
// hinge lies in the middle of the ligament.
#include "fabricate/joint_work.h"

#include <math.h>
#include <stdio.h>

enum { LIGAMENT };

static const ax_joint_parameter parameters[] = {
    [LIGAMENT] = {"ligament", "mm", "width of the material left at each hinge", 0.2, 100, 2},
};

static void suit(const ax_material* material, const bool* chosen, double* value)
{
    if (!chosen[LIGAMENT])
        value[LIGAMENT] = fmax(value[LIGAMENT], material->feature);
}

static ax_status rule(const ax_joint_job* job, ax_panel_rule* out, ax_error* error)
{
    double ligament = job->value[LIGAMENT];
    if (ligament < job->material->feature)
        return ax_fail(error, AX_CANNOT_REALISE,
                       "Ligaments of %g mm break in %s, of which nothing narrower than %g mm should be left. "
                       "Set ligament=%g or more, or choose another material.",
                       ligament, job->material->name, job->material->feature, job->material->feature);
    *out = (ax_panel_rule){.ligament = ligament};
    return AX_OK;
}

static void doubt(const ax_joint_job* job, double edge, char* words, size_t size)
{
    double ligament = job->value[LIGAMENT];
    if (!job->material->bends)
        snprintf(
            words, size,
            "%s breaks where a ligament bends by a hundred degrees, as it does when the sheet opens. Take a material "
            "that bends, such as polypropylene, or join loose panels by rings or pins.",
            job->material->name);
    else if (ligament > edge / 20)
        snprintf(words, size,
                 "Ligaments of %g mm are more than a twentieth of the shortest edge, %.3g mm: they turn about their "
                 "middle only nearly. Make a model first, or design with larger panels.",
                 ligament, edge);
}

// The ligament in tension.
static double rated(const ax_joint_job* job)
{
    return job->value[LIGAMENT] * job->material->thickness * job->material->strength;
}

const ax_joint_type ax_joint_living_hinge = {
    .name = "living-hinge",
    .doc = "One sheet with slits that leave a ligament at each hinge; for material that bends.",
    .one_piece = true,
    .parameters = parameters,
    .parameter_count = sizeof parameters / sizeof *parameters,
    .work = &(const struct ax_joint_work){.suit = suit,
                                          .rule = rule,
                                          .rated = rated,
                                          .doubt = doubt,
                                          .trial = {LIGAMENT, true, {0.5, 0.75, 1, 1.5, 2}}},
};
