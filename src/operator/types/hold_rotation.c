#include "operator/hold.h"

typedef struct arguments {
    ax_holding hold;
    int order;
    double centre[2];
} arguments;

static void defaults(void* given)
{
    arguments* a = given;
    a->hold.weight = 0.03;
    a->hold.hinges = "all";
    a->order = 3;
    a->centre[0] = a->centre[1] = NAN;
}

static const ax_field fields[] = {
    AX_HOLD_NAME(arguments),
    AX_HOLD_HINGES(arguments),
    AX_INTEGER(arguments, order, "Order", 2, 6, .doc = "So many turns make a full one; a lattice has 2, 3 and 6."),
    AX_VECTOR(arguments, centre, "Centre", "length", 2, .fallback = "the middle of the sheet",
              .doc = "Where the axis meets the sheet."),
    AX_HOLD_WEIGHT(arguments),
};

// The hinges that turn into one another, from `first`, which must be the smallest of them; 0 unless there are `order` different ones.
static int take_orbit(const int* partner, int first, int order, int* orbit)
{
    int n = 0;
    for (int h = first; h >= 0 && n < order; h = partner[h]) {
        if (h < first || (n && h == first))
            return 0;
        orbit[n++] = h;
    }
    return n == order && partner[orbit[n - 1]] == first ? n : 0;
}

static ax_status apply(const ax_operator_context* context, const void* given, ax_error* error)
{
    const arguments* a = given;
    ax_form_view view = ax_form_look(*context->form);
    int *hinges, count;
    ax_status status = ax_operator_hinges(context, a->hold.hinges, 2, &hinges, &count, error);
    if (status != AX_OK)
        return status;
    double centre[2], c = cos(2 * AX_PI / a->order), s = sin(2 * AX_PI / a->order);
    const double matrix[2][2] = {{c, -s}, {s, c}};
    ax_hold_centre(&view, a->centre, centre);
    int *partner = AX_NEW(int, view.linkage->hinge_count), *orbits = AX_NEW(int, count + a->order),
        n = 0; // the last may begin in vain
    int found = ax_hold_match(&view, count, hinges, centre, matrix, partner);
    for (int k = 0; k < count; ++k)
        n += take_orbit(partner, hinges[k], a->order, orbits + n);
    ax_form_constraint constraint = {
        .kind = AX_HELD_ROTATION, .point = {centre[0], centre[1], 0}, .direction = {0, 0, 1}, .order = a->order};
    if (2 * n >= count)
        status = ax_hold_put_hinges(context, &a->hold, n, orbits, &constraint, error);
    else
        status =
            ax_fail(error, AX_BAD_INPUT,
                    "The lattice is not %d-fold about this point: %d of %d hinges have an image. A lattice is 3- and "
                    "6-fold about the middle of a hole, 2-fold about a hinge.",
                    a->order, found, count);
    ax_free(partner);
    ax_free(orbits);
    ax_free(hinges);
    return status;
}

const ax_operator_type ax_operator_hold_rotation = {
    .name = "hold_rotation",
    .title = "Hold n-fold",
    .doc = "Holds hinges in n-fold symmetry about a vertical axis.",
    .group = "constraint",
    .fields = fields,
    .field_count = AX_COUNT(fields),
    .size = sizeof(arguments),
    .defaults = defaults,
    .settles = true,
    .apply = apply,
};
