#include "operator/hold.h"

typedef struct arguments {
    ax_holding hold;
    double angle, centre[2];
} arguments;

static void defaults(void* given)
{
    arguments* a = given;
    a->hold.weight = 0.03;
    a->hold.hinges = "all";
    a->centre[0] = a->centre[1] = NAN;
}

static const ax_field fields[] = {
    AX_HOLD_NAME(arguments),
    AX_HOLD_HINGES(arguments),
    AX_NUMBER(arguments, angle, "Angle", "deg", -360, 360,
              .doc = "Direction of the mirror line on the sheet against the x axis."),
    AX_VECTOR(arguments, centre, "Centre", "length", 2, .fallback = "the middle of the sheet",
              .doc = "A point of the line."),
    AX_HOLD_WEIGHT(arguments),
};

static ax_status apply(const ax_operator_context* context, const void* given, ax_error* error)
{
    const arguments* a = given;
    ax_form_view view = ax_form_look(*context->form);
    int *hinges, count;
    ax_status status = ax_operator_hinges(context, a->hold.hinges, 2, &hinges, &count, error);
    if (status != AX_OK)
        return status;
    double centre[2], direction[2] = {cos(a->angle * AX_PI / 180), sin(a->angle * AX_PI / 180)};
    double c = direction[0] * direction[0] - direction[1] * direction[1], s = 2 * direction[0] * direction[1];
    const double matrix[2][2] = {{c, s}, {s, -c}};
    ax_hold_centre(&view, a->centre, centre);
    int *partner = AX_NEW(int, view.linkage->hinge_count), *pairs = AX_NEW(int, 2 * (size_t)count), n = 0;
    int found = ax_hold_match(&view, count, hinges, centre, matrix, partner);
    for (int k = 0; k < count; ++k)
        if (partner[hinges[k]] >= hinges[k]) { // each pair once; a hinge on the line is its own image
            pairs[n++] = hinges[k];
            pairs[n++] = partner[hinges[k]];
        }
    ax_form_constraint constraint = {
        .kind = AX_HELD_MIRROR, .point = {centre[0], centre[1], 0}, .direction = {-direction[1], direction[0], 0}};
    if (2 * found >= count)
        status = ax_hold_put_hinges(context, &a->hold, n, pairs, &constraint, error);
    else
        status =
            ax_fail(error, AX_BAD_INPUT,
                    "The lattice is not symmetric about this line: %d of %d hinges have an image. Lines along lattice "
                    "rows and at multiples of 30 degrees from them, through the middle of a sheet that is symmetric "
                    "itself, are mirrors.",
                    found, count);
    ax_free(partner);
    ax_free(pairs);
    ax_free(hinges);
    return status;
}

const ax_operator_type ax_operator_hold_mirror = {
    .name = "hold_mirror",
    .title = "Hold mirrored",
    .doc = "Holds hinges as mirror images of one another, in a vertical plane. The flat state turns panels one way and "
           "cannot be mirrored: the deployed states are.",
    .group = "constraint",
    .fields = fields,
    .field_count = AX_COUNT(fields),
    .size = sizeof(arguments),
    .defaults = defaults,
    .settles = true,
    .apply = apply,
};
