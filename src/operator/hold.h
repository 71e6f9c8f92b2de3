// What operators share that hold hinges by a constraint.
#pragma once

#include "operator/operator.h"

typedef struct ax_holding {
    const char *name, *hinges;
    double weight;
    bool support;
} ax_holding;

// Rows of the field table of arguments that have `ax_holding hold`.
#define AX_HOLD_NAME(T)                                                                                                \
    {                                                                                                                  \
        .name = "name", .title = "Name", .unit = "", .kind = AX_FIELD_TEXT, .offset = offsetof(T, hold.name),          \
        .fallback = "its kind and a number, such as plane-1",                                                          \
        .doc = "Name by which the report and later operators call it; one of this name is replaced."                   \
    }
#define AX_HOLD_HINGES(T, ...)                                                                                         \
    {                                                                                                                  \
        .name = "hinges", .title = "Hinges", .unit = "", .kind = AX_FIELD_TEXT, .offset = offsetof(T, hold.hinges),    \
        .doc = "Selection of the hinges it holds.", __VA_ARGS__                                                        \
    }
#define AX_HOLD_WEIGHT(T)                                                                                              \
    {                                                                                                                  \
        .name = "weight", .title = "Weight", .unit = "", .kind = AX_FIELD_NUMBER, .open = true, .hi = 1000,            \
        .offset = offsetof(T, hold.weight), .doc = "How stiff it is while the form settles; a panel has 1."            \
    }
#define AX_HOLD_SUPPORT(T)                                                                                             \
    {                                                                                                                  \
        .name = "support", .title = "Support", .unit = "", .kind = AX_FIELD_FLAG, .offset = offsetof(T, hold.support), \
        .doc = "Holds also under the load, as a support."                                                              \
    }

// Arguments, fields and defaults of operators that ask for nothing else.
typedef struct ax_hold_arguments {
    ax_holding hold;
} ax_hold_arguments;
enum { AX_HOLD_FIELDS = 4 };
extern const ax_field ax_hold_fields[AX_HOLD_FIELDS];
void ax_hold_defaults(void* arguments);

// Resolves name and hinges (of which `fewest` are needed) and hands the constraint to the form. `constraint` has the rest.
ax_status ax_hold_put(const ax_operator_context* context, const ax_holding* hold, int fewest,
                      ax_form_constraint* constraint, ax_error* error);
// The same for hinges that are known already.
ax_status ax_hold_put_hinges(const ax_operator_context* context, const ax_holding* hold, int count, const int* hinges,
                             ax_form_constraint* constraint, ax_error* error);

// For every chosen hinge the one whose place on the sheet is its image under x -> centre + matrix (x - centre), or -1. Nothing but
// what the lattice maps onto itself is found. `partner` has hinge_count entries. Returns how many were found.
int ax_hold_match(const ax_form_view* view, int count, const int* hinges, const double centre[2],
                  const double matrix[2][2], int* partner);

// Of the sheet: as given, or the middle of the hinges' extents if given[0] is NaN.
void ax_hold_centre(const ax_form_view* view, const double given[2], double centre[2]);

// Where places are taken from.
enum { AX_AT_FLAT, AX_AT_DEPLOYED, AX_AT_SHEET, AX_AT_POINTS };
extern const char* const ax_at_words[4];
// Places of hinges: those of a state, or the points given, one for each hinge. Owned by the caller.
ax_status ax_hold_places(const ax_operator_context* context, int at, const ax_points* given, int count,
                         const int* hinges, double (**places)[3], ax_error* error);
