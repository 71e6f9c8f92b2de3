#include "operator/hold.h"

typedef struct arguments {
    ax_holding hold;
    int at;
    ax_points points;
} arguments;

static void defaults(void* given)
{
    arguments* a = given;
    a->hold.weight = 1;
    a->at = AX_AT_DEPLOYED;
    a->hold.support = true;
}

static const ax_field fields[] = {
    AX_HOLD_NAME(arguments),
    AX_HOLD_HINGES(arguments, .required = true),
    AX_CHOICE(
        arguments, at, "At", ax_at_words,
        .doc = "Where they are now: where the sheet lies in the flat state, the turn of its panels left out, so that "
               "sides are straight; where they are deployed; where the sheet was laid; or at the points given."),
    AX_POINTS(arguments, points, "Places", 3, 1, .doc = "One place for each hinge, in order, for at = points."),
    AX_HOLD_WEIGHT(arguments),
    AX_HOLD_SUPPORT(arguments),
};

static const char* check(const void* given, int* field)
{
    const arguments* a = given;
    *field = 2;
    return (a->at == AX_AT_POINTS) == (a->points.count > 0) ? NULL : "\"points\" belongs to \"at\": \"points\".";
}

static ax_status apply(const ax_operator_context* context, const void* given, ax_error* error)
{
    const arguments* a = given;
    ax_form_constraint constraint = {.kind = AX_HELD_FIXED};
    int *hinges, count;
    double(*places)[3];
    ax_status status = ax_operator_hinges(context, a->hold.hinges, 1, &hinges, &count, error);
    if (status != AX_OK)
        return status;
    status = ax_hold_places(context, a->at, &a->points, count, hinges, &places, error);
    constraint.places = (const double(*)[3])places;
    if (status == AX_OK)
        status = ax_hold_put_hinges(context, &a->hold, count, hinges, &constraint, error);
    ax_free(places);
    ax_free(hinges);
    return status;
}

const ax_operator_type ax_operator_hold_fixed = {
    .name = "hold_fixed",
    .title = "Hold fixed",
    .doc = "Holds hinges at places: where they are now in a state, or given ones.",
    .group = "constraint",
    .fields = fields,
    .field_count = AX_COUNT(fields),
    .size = sizeof(arguments),
    .defaults = defaults,
    .check = check,
    .settles = true,
    .apply = apply,
};
