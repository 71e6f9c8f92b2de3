// From a form to the sections of a board.
#pragma once

#include "studio/board.h"

#include "ax/form.h"

// What never changes in a linkage: sections 1 to 9. `origin` is taken off places from now on.
typedef struct shape_frame {
    double origin[3], flat_origin[2];
} shape_frame;

// Measures that take time, made without the hub's lock.
typedef struct shape_measures {
    double* mouth;                    // per hinge
    double* residual;                 // per triangle
    double* curvature;                // per triangle
    const double *opening, *material; // the form's own
} shape_measures;
shape_measures shape_measure(ax_form* form, const ax_form_view* view);
void shape_measures_free(shape_measures* m);

shape_frame shape_new_linkage(board* b, const ax_form_view* view);
// `all`: also the deployed state where the simulated one is what is seen.
void shape_put_places(board* b, const ax_form_view* view, const shape_frame* frame, bool all);
void shape_put_rest(board* b, const ax_form_view* view, const shape_measures* measures);
// Supports; and of an exact design (NULL: it is not exact) edge forces and reactions.
void shape_put_exact(board* b, const ax_form_view* view, const ax_form* form, const ax_design* design);
