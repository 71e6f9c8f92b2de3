// Fields of ln lambda on the lattice: ln lambda is what a conformal map adds, so that heat flow and Poisson's equation keep their
// meaning for curvature, K = -exp(-2 u) Laplacian(u) with u = ln lambda.
//
// The Laplacian of the panels' dual graph, a honeycomb of neighbours at a distance of spacing / sqrt 3:
//   (L u)_t = 4 / spacing^2  sum over neighbours (u_t - u_j)  ~  -Laplacian(u)
#pragma once

#include "operator/operator.h"

// Blurs u: implicit heat flow that equals a Gaussian of standard deviation `length`, so that the result does not depend on the number of
// panels. Panels that are not chosen keep their values and hold those beside them; nothing flows over the rim.
void ax_field_smooth(const ax_linkage* linkage, double spacing, const unsigned char* chosen, double length, double* u);

// Adds to u the solution v of -Laplacian(v) = density * exp(2 (u + v)) (Liouville's equation: `density` is the Gaussian curvature that
// the deployed surface gains at each panel), v = 0 at the rim; u + v counts no further than ln 2. False where the curvature is too much
// for any solution to settle (u is then unchanged).
bool ax_field_bend(const ax_linkage* linkage, double spacing, const double* density, double* u);
