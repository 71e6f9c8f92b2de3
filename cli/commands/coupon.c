// auxshell coupon: trial cuts for a machine and a material.
#include "fabricate.h"
#include "output.h"

#include "ax/export.h"

typedef struct arguments {
    ax_coupon kind;
    const char* out;
    fabricate_arguments fabricate;
} arguments;

static void defaults(void* given)
{
    fabricate_defaults(&((arguments*)given)->fabricate);
}

static const char* const kinds[] = {"kerf", "hinge"};

static const command_option options[] = {
    {.name = "--kind",
     .text = "what to find out: the width of the beam, or which hinge of --joint lasts",
     .kind = OPTION_CHOICE,
     .choices = kinds,
     .choice_count = 2,
     .first = AX_COUPON_KERF,
     .offset = offsetof(arguments, kind)},
    {.name = "-o",
     .value = "FILE",
     .text = "the cut file to write; its ending chooses the format",
     .kind = OPTION_TEXT,
     .required = true,
     .offset = offsetof(arguments, out)},
    FABRICATE_OPTIONS(arguments, fabricate),
};

static ax_status run(const void* given, ax_error* error)
{
    const arguments* a = given;
    fabricate_choice chosen;
    ax_cut_plan plan = {0};
    ax_status status = output_check(a->out, NULL, error);
    if (status == AX_OK)
        status = fabricate_choose(&a->fabricate, NULL, &chosen, error);
    if (status == AX_OK)
        status = ax_fabricate_coupon(a->kind, &chosen.options, &plan, error);
    if (status == AX_OK)
        status = ax_export_plan(&plan, a->out, error);
    if (status == AX_OK)
        printf("Wrote %s\n", a->out);
    ax_cut_plan_free(&plan);
    return status;
}

const command command_coupon = {
    .name = "coupon",
    .summary = "write trial cuts: for the kerf, or for hinges of a joint and a material",
    .text =
        "Writes a small sheet to cut before the real one. The kerf coupon is a row of ten pieces that tells the width "
        "of the beam once they are pushed together. The hinge coupon has five pairs of panels that differ in what "
        "matters most: the ligament, the edge distance, or the play.",
    .options = options,
    .option_count = sizeof options / sizeof *options,
    .size = sizeof(arguments),
    .defaults = defaults,
    .run = run,
};
