// fairness: second difference along a line of hinges. Fully open on a smooth surface the kagome lines run straight
// through each hinge with equal steps.
#include "constraint/constraint_type.h"

static double coefficient(int points, int point)
{
    (void)points;
    return point == 1 ? -2 : 1;
}

static void project(const ax_lane* restrict block, const ax_place* place, int points, const ax_lane3* restrict y,
                    ax_lane3* restrict p)
{
    (void)block, (void)place, (void)points, (void)y;
    for (int i = 0; i < 3; ++i)
        for (int l = 0; l < AX_W; ++l)
            p[0][i][l] = 0;
}

const ax_constraint_type ax_constraint_fairness = {
    .name = "fairness",
    .doc = "Pulls a hinge to the middle between its neighbours on a kagome line: the line runs straight and evenly.",
    .reference = "Welch and Witkin 1994, Free-form shape design using triangulated surfaces (second differences)",
    .pattern = AX_ROWS_SUM,
    .least_points = 3,
    .most_points = 3,
    .symmetry = AX_SYMMETRY_TRANSLATION | AX_SYMMETRY_ROTATION | AX_SYMMETRY_SCALE,
    .coefficient = coefficient,
    .project = project,
};
