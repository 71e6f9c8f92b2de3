// The figures of a report as data: tables for people, JSON and the document are all made from this one list.
#pragma once

#include "ax/design.h"

typedef enum ax_figure_kind { AX_FIGURE_NUMBER, AX_FIGURE_COUNT, AX_FIGURE_FLAG } ax_figure_kind; // double, int, bool

typedef enum ax_figure_group {
    AX_GROUP_GEOMETRY,
    AX_GROUP_FIT,
    AX_GROUP_FLAT,
    AX_GROUP_DEPLOYMENT,
    AX_GROUP_EFFORT,
} ax_figure_group;
const char* ax_figure_group_name(ax_figure_group group); // "Geometry"

typedef enum ax_relation { AX_SHOWN_ONLY, AX_AT_MOST, AX_AT_LEAST } ax_relation;

typedef struct ax_figure {
    const char* key;   // the field's name in ax_report, the key in JSON
    const char* label; // for people: "Congruence, flat to deployed"
    const char* unit;  // "", "L", "deg", "N", "s"; "length" and "area" are in the document's unit and its square
    ax_figure_group group;
    ax_figure_kind kind;
    int count;     // of values: 1, or the length of an array
    size_t offset; // in ax_report
    ax_relation relation;
    double limit; // what a sound design keeps; the mouth angle's limit is the design's own
} ax_figure;

// All figures, in the order in which they are shown.
const ax_figure* ax_report_figures(int* count);

// Value `k` of a figure as a number (flags are 0 or 1).
double ax_figure_value(const ax_figure* figure, const ax_report* report, int k);
// The same the other way, for reading a stored report.
void ax_figure_set(const ax_figure* figure, ax_report* report, int k, double value);
// The limit that this design must keep; NaN if the figure has none.
double ax_figure_limit(const ax_figure* figure, const ax_design* design);
// True if the figure has no limit or keeps it. A missing figure (NaN) of a state that does not exist keeps none.
bool ax_figure_holds(const ax_figure* figure, const ax_design* design);
