// The brush: how far panels lie from a stroke, and how strongly it takes at a distance.
#pragma once

#include "operator/operator.h"

// A stroke with its copies: turned about `centre` `copies` times, and each also mirrored in the line through the centre at an angle.
typedef struct ax_stroke {
    ax_points points; // of width 2, on the sheet
    double centre[2];
    int copies; // 1: the stroke alone
    bool mirrored;
    double mirror_angle; // radians
} ax_stroke;

// Distance of every panel's centre from the stroke and its copies along the deployed surface, holes filled: first-order fast marching (Kimmel
// and Sethian 1998) from the hinges beside the stroke. Infinite beyond `radius`.
void ax_stroke_on_deployed(const ax_stroke* stroke, const ax_sheet* sheet, const ax_form_view* view, double radius,
                           double* distance);

typedef enum ax_falloff { AX_FALLOFF_SPHERE, AX_FALLOFF_FLAT, AX_FALLOFF_LINEAR, AX_FALLOFF_GAUSS } ax_falloff;
extern const char* const ax_falloff_names[4];

// Share of a change from `from` to `to` that ln lambda takes at x = distance / radius: 1 at 0, 0 from 1 on.
// Sphere: lambda = to / (1 + k x^2), k such that it meets `from` at x = 1: constant Gaussian curvature over the whole brush, where a
// Gaussian has a ring of negative curvature, in which holes go slack under load.
double ax_falloff_share(ax_falloff falloff, double x, double from, double to);

// What operators that take a stroke have in common.
typedef struct ax_brush {
    ax_points points;
    double radius;
    int falloff, along; // ax_falloff; 0 the sheet, 1 the deployed surface
    int copies;
    bool mirror;
    double mirror_angle, centre[2]; // degrees; NaN: the middle of the sheet
    const char* hinges;
} ax_brush;
ax_brush ax_brush_default(void); // sphere, on the sheet, everywhere
extern const char* const ax_brush_ways[2];

// Rows of the field table of arguments that have `ax_brush brush`.
#define AX_BRUSH_FIELDS(T)                                                                                             \
    {.name = "points",                                                                                                 \
     .title = "Stroke",                                                                                                \
     .unit = "length",                                                                                                 \
     .kind = AX_FIELD_POINTS,                                                                                          \
     .width = 2,                                                                                                       \
     .lo = 1,                                                                                                          \
     .required = true,                                                                                                 \
     .offset = offsetof(T, brush.points),                                                                              \
     .doc = "Points of the stroke on the sheet, in order; one "                                                        \
            "point is a dab."},                                                                                        \
        {.name = "radius",                                                                                             \
         .title = "Radius",                                                                                            \
         .unit = "length",                                                                                             \
         .kind = AX_FIELD_NUMBER,                                                                                      \
         .open = true,                                                                                                 \
         .hi = 1e9,                                                                                                    \
         .required = true,                                                                                             \
         .offset = offsetof(T, brush.radius),                                                                          \
         .doc = "Distance from the stroke at which it ends."},                                                         \
        {.name = "falloff",                                                                                            \
         .title = "Falloff",                                                                                           \
         .unit = "",                                                                                                   \
         .kind = AX_FIELD_CHOICE,                                                                                      \
         .choices = ax_falloff_names,                                                                                  \
         .choice_count = 4,                                                                                            \
         .offset = offsetof(T, brush.falloff),                                                                         \
         .doc = "How the stroke fades towards its radius: sphere "                                                     \
                "gives constant curvature, flat ends sharply, gauss leaves a ring of negative curvature."},            \
        {.name = "along",                                                                                              \
         .title = "Measured along",                                                                                    \
         .unit = "",                                                                                                   \
         .kind = AX_FIELD_CHOICE,                                                                                      \
         .choices = ax_brush_ways,                                                                                     \
         .choice_count = 2,                                                                                            \
         .offset = offsetof(T, brush.along),                                                                           \
         .doc = "Whether the radius is a length on the sheet or on "                                                   \
                "the deployed surface as it is now."},                                                                 \
        {.name = "copies",                                                                                             \
         .title = "Copies",                                                                                            \
         .unit = "",                                                                                                   \
         .kind = AX_FIELD_INTEGER,                                                                                     \
         .lo = 1,                                                                                                      \
         .hi = 360,                                                                                                    \
         .offset = offsetof(T, brush.copies),                                                                          \
         .doc = "The stroke is repeated so often around the centre, evenly turned."},                                  \
        {.name = "mirror",                                                                                             \
         .title = "Mirrored",                                                                                          \
         .unit = "",                                                                                                   \
         .kind = AX_FIELD_FLAG,                                                                                        \
         .offset = offsetof(T, brush.mirror),                                                                          \
         .doc = "The stroke and its copies are also mirrored in a line through the centre."},                          \
        {.name = "mirror_angle",                                                                                       \
         .title = "Mirror line",                                                                                       \
         .unit = "deg",                                                                                                \
         .kind = AX_FIELD_NUMBER,                                                                                      \
         .lo = -360,                                                                                                   \
         .hi = 360,                                                                                                    \
         .offset = offsetof(T, brush.mirror_angle),                                                                    \
         .doc = "Direction of that line against the x axis."},                                                         \
        {.name = "centre",                                                                                             \
         .title = "Centre",                                                                                            \
         .unit = "length",                                                                                             \
         .kind = AX_FIELD_VECTOR,                                                                                      \
         .width = 2,                                                                                                   \
         .offset = offsetof(T, brush.centre),                                                                          \
         .fallback = "the middle of the sheet",                                                                        \
         .doc = "Point of the sheet about which copies are turned and mirrored."},                                     \
    {                                                                                                                  \
        .name = "hinges", .title = "Region", .unit = "", .kind = AX_FIELD_TEXT, .offset = offsetof(T, brush.hinges),   \
        .doc = "Selection within which it paints: panels all of whose hinges are chosen."                              \
    }

// Takes the sheet and the distance of each panel from the stroke over the radius (infinite beyond 1), both owned by the caller.
ax_status ax_brush_take(const ax_operator_context* context, const ax_brush* brush, ax_sheet* sheet, double** distance,
                        ax_error* error);
