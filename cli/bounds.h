// Bounds that the figures of the examples keep: examples/gallery/bounds.json.
#pragma once

#include "ax/form.h"
#include "ax/space.h"

#include <jansson.h>

// {"format": "auxshell-bounds", "version": 1, "every": {FIGURE: [LO, HI], ...}, "examples": {NAME: {...}, ...}} where an end of a
// range may be null. An example has "load", the kind it is deployed by (default: any but none); "quick", true for those of the short
// run; "make", how it is cut (joint, material, sheet); and "bounds", more ranges of its own. Figures are those of the report, and
// triangles, supports, held_max_over_L (how far the worst constraint is missed), floor, volume and headroom_share, the part of the
// floor that has the example's "headroom" in metres, by default 2.1.
typedef struct bounds {
    json_t *root, *every, *examples;
} bounds;

// AX_BAD_INPUT names the file and what is wrong.
ax_status bounds_read(const char* path, bounds* out, ax_error* error);
void bounds_free(bounds* b);
// What is said of an example; NULL: nothing.
const json_t* bounds_of(const bounds* b, const char* example);

// The room under the shell with the headroom of its example; false if it covers nothing.
bool bounds_space(const json_t* example, const ax_design* design, ax_space* space);

// Every figure that is out of its range, or that breaks a limit of the report itself, as a sentence in an array of texts. An example
// without a load has no deployment to judge.
json_t* bounds_check(const bounds* b, const json_t* example, const ax_design* design, const ax_form_report* form);
