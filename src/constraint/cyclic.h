// Polygons with given sides that are inscribed in a circle: of all polygons with these sides they have the largest area, so they
// are what a fully open hole looks like (Niven 1981, Maxima and Minima without Calculus).
#pragma once

enum { AX_CYCLIC_MOST = 8 };

// Corners, mean 0, side k from corner k to the next one, counter-clockwise; 3 <= n <= AX_CYCLIC_MOST. A side as long as all others
// together leaves them on a line.
void ax_cyclic_inscribe(int n, const double* side, double (*corner)[2]);
