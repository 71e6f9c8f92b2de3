#include "constraint/triangle.h"

const ax_parameter ax_triangle_parameters[AX_TRIANGLE_PARAMETERS] = {
    {.name = "lo",
     .unit = "1",
     .doc = "smallest size / size of the template",
     .standard = 1,
     .least = 0,
     .most = 1,
     .offset = AX_TRIANGLE_LO,
     .lanes = 1},
    {.name = "hi",
     .unit = "1",
     .doc = "largest size / size of the template; 1e6 is as good as no bound",
     .standard = 1,
     .least = 1,
     .most = 1e6,
     .offset = AX_TRIANGLE_HI,
     .lanes = 1},
    {.name = "lengths",
     .unit = "length",
     .doc = "edges of the template, edge k opposite corner k",
     .standard = 1,
     .least = 0,
     .most = 1e12,
     .offset = AX_TRIANGLE_LENGTHS,
     .lanes = 3},
};

void ax_triangle_rest(ax_lane* restrict block, int points, const ax_lane3* restrict x)
{
    (void)points;
    for (int k = 0; k < 3; ++k)
        for (int l = 0; l < AX_W; ++l) {
            int i = (k + 1) % 3, j = (k + 2) % 3;
            double a[3] = {x[j][0][l] - x[i][0][l], x[j][1][l] - x[i][1][l], x[j][2][l] - x[i][2][l]};
            block[AX_TRIANGLE_LENGTHS + k][l] = ax_norm3(a);
        }
}

void ax_triangle_prepare(ax_lane* restrict block, int points)
{
    (void)points;
    for (int l = 0; l < AX_W; ++l) {
        double a = block[AX_TRIANGLE_LENGTHS][l], b = block[AX_TRIANGLE_LENGTHS + 1][l];
        double c = block[AX_TRIANGLE_LENGTHS + 2][l];

        // corners 0, c and x + iy; lengths that no triangle has give a flat one with b and c kept
        double x = c > 0 ? 0.5 * (c + (b - a) * ((b + a) / c)) : b, y2;
        x = ax_clamp(x, -b, b);
        y2 = (b - x) * (b + x);
        double y = y2 > 0 ? sqrt(y2) : 0, mx = (c + x) / 3, my = y / 3;
        double p = c - mx, q = -my, r = x - mx, t = y - my;
        double square = p * p + q * q + r * r + t * t + mx * mx + my * my;
        block[AX_TRIANGLE_W1][l] = p, block[AX_TRIANGLE_W1 + 1][l] = q;
        block[AX_TRIANGLE_W2][l] = r, block[AX_TRIANGLE_W2 + 1][l] = t;
        block[AX_TRIANGLE_INVERSE][l] = square > 0 ? 1 / square : 0;
    }
}
