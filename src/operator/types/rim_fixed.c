#include "operator/hold.h"
#include "operator/rim.h"

typedef struct arguments {
    const char* hinges;
    int at;
    ax_points points;
} arguments;

static void defaults(void* given)
{
    arguments* a = given;
    a->hinges = "rim";
}

static const ax_field fields[] = {
    AX_RIM_HINGES(arguments),
    AX_CHOICE(
        arguments, at, "At", ax_at_words,
        .doc = "Where they are now: where the sheet lies in the flat state, the turn of its panels left out, so that "
               "sides are straight; where they are deployed; where the sheet was laid; or at the points given."),
    AX_POINTS(arguments, points, "Places", 3, 1, .doc = "One place for each hinge, in order, for at = points."),
};

static const char* check(const void* given, int* field)
{
    const arguments* a = given;
    *field = 1;
    return (a->at == AX_AT_POINTS) == (a->points.count > 0) ? NULL : "\"points\" belongs to \"at\": \"points\".";
}

static ax_status apply(const ax_operator_context* context, const void* given, ax_error* error)
{
    const arguments* a = given;
    int *hinges, count;
    double(*places)[3];
    ax_status status = ax_rim_hinges(context, a->hinges, &hinges, &count, error);
    if (status != AX_OK)
        return status;
    status = ax_hold_places(context, a->at, &a->points, count, hinges, &places, error);
    if (status == AX_OK) {
        ax_rim rim = ax_rim_copy(*context->form);
        ax_rim_take_out(&rim, count, hinges);
        rim.parts[rim.count++] =
            (ax_rim_part){.kind = AX_RIM_FIXED, .count = count, .hinges = hinges, .places = (const double(*)[3])places};
        status = ax_form_set_rim(*context->form, rim.count, rim.parts, error);
        ax_rim_free(&rim);
    } else
        ax_free(hinges);
    return status;
}

const ax_operator_type ax_operator_rim_fixed = {
    .name = "rim_fixed",
    .title = "Fixed rim",
    .doc = "Holds hinges of the rim at places: where they are now in a state, or given ones.",
    .group = "boundary",
    .fields = fields,
    .field_count = AX_COUNT(fields),
    .size = sizeof(arguments),
    .defaults = defaults,
    .check = check,
    .settles = true,
    .apply = apply,
};
