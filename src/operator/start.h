// What operators share that start a design on an outline.
#pragma once

#include "operator/operator.h"

typedef struct ax_start {
    int triangles;
    double edge, scale, angle; // degrees
    bool inside;
    int unit;
    double fillet; // of outlines with corners
} ax_start;

ax_start ax_start_default(void);
extern const char* const ax_unit_words[3];

// Rows of the field table of arguments that have `ax_start start`.
#define AX_START_FIELDS(T)                                                                                             \
    {.name = "triangles",                                                                                              \
     .title = "Triangles",                                                                                             \
     .unit = "",                                                                                                       \
     .kind = AX_FIELD_INTEGER,                                                                                         \
     .lo = 12,                                                                                                         \
     .hi = 2000000,                                                                                                    \
     .offset = offsetof(T, start.triangles),                                                                           \
     .doc = "Wanted number of panels, unless their edge is given; whole rows may take up to a quarter more or fewer. " \
            "The sheet is stretched "                                                                                  \
            "to its outline, so that edges differ by up to 2 % from their mean until it is finished."},                \
        {.name = "edge",                                                                                               \
         .title = "Panel edge",                                                                                        \
         .unit = "length",                                                                                             \
         .kind = AX_FIELD_NUMBER,                                                                                      \
         .open = true,                                                                                                 \
         .hi = 1e9,                                                                                                    \
         .offset = offsetof(T, start.edge),                                                                            \
         .fallback = "by the number of triangles",                                                                     \
         .doc = "Edge of a panel of scale factor 1: half the spacing of the lattice."},                                \
        {.name = "scale",                                                                                              \
         .title = "Scale factor",                                                                                      \
         .unit = "",                                                                                                   \
         .kind = AX_FIELD_NUMBER,                                                                                      \
         .lo = 1,                                                                                                      \
         .hi = 2,                                                                                                      \
         .offset = offsetof(T, start.scale),                                                                           \
         .doc = "Scale factor prescribed everywhere to begin with."},                                                  \
        {.name = "angle",                                                                                              \
         .title = "Lattice angle",                                                                                     \
         .unit = "deg",                                                                                                \
         .kind = AX_FIELD_NUMBER,                                                                                      \
         .lo = -360,                                                                                                   \
         .hi = 360,                                                                                                    \
         .offset = offsetof(T, start.angle),                                                                           \
         .doc = "Direction of the lattice rows against the x axis."},                                                  \
        {.name = "inside",                                                                                             \
         .title = "Whole panels only",                                                                                 \
         .unit = "",                                                                                                   \
         .kind = AX_FIELD_FLAG,                                                                                        \
         .offset = offsetof(T, start.inside),                                                                          \
         .doc = "Keep only panels that lie wholly within the outline."},                                               \
    {                                                                                                                  \
        .name = "unit", .title = "Unit", .unit = "", .kind = AX_FIELD_CHOICE, .choices = ax_unit_words,                \
        .choice_count = 3, .offset = offsetof(T, start.unit), .doc = "Unit of every length in the recipe."             \
    }

#define AX_START_FILLET(T)                                                                                             \
    {                                                                                                                  \
        .name = "fillet", .title = "Fillet", .unit = "length", .kind = AX_FIELD_NUMBER, .hi = 1e9,                     \
        .offset = offsetof(T, start.fillet), .doc = "Radius of the arcs that round the corners; 0: sharp."             \
    }

// Lays the linkage over a closed outline, which replaces the form of the context.
ax_status ax_start_form(const ax_operator_context* context, const ax_start* start, int count,
                        const double (*outline)[2], ax_error* error);
