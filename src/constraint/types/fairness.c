// fairness: differences along a line of hinges. Fully open on a smooth surface the kagome lines run straight through each hinge with
// equal steps. Second differences (three points) want no curvature at all and flatten a dome; third ones (four points) want it not to
// change, and leave a sphere alone.
#include "constraint/constraint_type.h"

static double coefficient(int points, int point)
{
    static const double second[] = {1, -2, 1}, third[] = {1, -3, 3, -1};
    return points == 3 ? second[point] : third[point];
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
    .doc = "Pulls a hinge to the middle between its neighbours on a kagome line (three points), or four to even steps "
           "and curvature.",
    .reference = "Welch and Witkin 1994, Free-form shape design using triangulated surfaces; Moreton and Sequin 1992, "
                 "Functional optimization for fair surface design (variation of curvature)",
    .pattern = AX_ROWS_SUM,
    .least_points = 3,
    .most_points = 4,
    .symmetry = AX_SYMMETRY_TRANSLATION | AX_SYMMETRY_ROTATION | AX_SYMMETRY_SCALE,
    .coefficient = coefficient,
    .vanishes = true,
    .project = project,
};
