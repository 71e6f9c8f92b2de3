// Editing what the rim is held by, one part at a time.
#pragma once

#include "operator/operator.h"

// A copy of the form's parts that may be changed; all of it owned.
typedef struct ax_rim {
    int count;
    ax_rim_part* parts;
} ax_rim;

ax_rim ax_rim_copy(const ax_form* form);
void ax_rim_free(ax_rim* rim);
// Hinges that come to belong to another part leave those they are in; parts that lose all are gone.
void ax_rim_take_out(ax_rim* rim, int count, const int* hinges);

// Hinges of the rim by words, in their order round it; AX_BAD_INPUT if one is not on the rim. Owned by the caller.
ax_status ax_rim_hinges(const ax_operator_context* context, const char* words, int** hinges, int* count,
                        ax_error* error);
// Lets the hinges that `words` choose slide on a curve, in place of what held them.
ax_status ax_rim_slide(const ax_operator_context* context, const char* words, const ax_curve_shape* curve,
                       ax_error* error);

#define AX_RIM_HINGES(T)                                                                                               \
    AX_TEXT(T, hinges, "Hinges", .doc = "Selection of rim hinges that it holds, in place of what held them.")

// Operators that let the rim slide on a curve through points.
typedef struct ax_rim_through {
    const char* hinges;
    ax_points points;
    bool closed;
    double fillet; // polylines
} ax_rim_through;
void ax_rim_through_defaults(void* through);
const char* ax_rim_through_check(const void* through, int* field); // its points are field 1
ax_status ax_rim_slide_through(const ax_operator_context* context, const ax_rim_through* through, ax_curve_kind kind,
                               ax_error* error);
#define AX_RIM_FILLET(T)                                                                                               \
    AX_NUMBER(T, fillet, "Fillet", "length", 0, 1e9,                                                                   \
              .doc = "Radius of the arcs that round the corners; a panel's size spares panels the corner. 0: sharp.")
#define AX_RIM_CLOSED AX_FLAG(ax_rim_through, closed, "Closed", .doc = "Whether the last is joined to the first.")

// Operators on one control point of the curve that a part slides on.
typedef struct ax_control {
    const char* hinges; // the first one chooses the part
    int point;
    double at[3];
} ax_control;
typedef enum ax_control_edit { AX_CONTROL_MOVE, AX_CONTROL_ADD, AX_CONTROL_REMOVE } ax_control_edit;
ax_status ax_rim_control(const ax_operator_context* context, const ax_control* control, ax_control_edit edit,
                         ax_error* error);
#define AX_CONTROL_PART(T)                                                                                             \
    AX_TEXT(T, hinges, "Part", .doc = "Selection whose first hinge belongs to the part of the rim that is meant.")
