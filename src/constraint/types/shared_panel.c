// shared_panel: keeps the flat and the deployed copy of one panel congruent, and equilateral, leaning or nearly so. In the complex
// numbers of its plane a triangle has edges a w^k + b w^-k, w a third of a turn: a its size and turn, b what it lacks to be
// equilateral. Each copy gives an a and a b; the common panel has their mean.
//
// With `give` the common size is drawn to `side` as well: panels then give way to what holds them, and no further.
#include "constraint/eigen3.h"

enum { SIDE, DRAW, SKEW, LO, HI, LEAN, LANES = LEAN + 2 };

static const ax_parameter parameters[] = {
    {.name = "side",
     .unit = "length",
     .doc = "edge of the panel that it is drawn to",
     .standard = 1,
     .least = 0,
     .most = 1e12,
     .offset = SIDE,
     .lanes = 1},
    {.name = "draw",
     .unit = "1",
     .doc = "how strongly its size is drawn to `side` against what the two states ask; 0: not at all",
     .standard = 0,
     .least = 0,
     .most = 1e12,
     .offset = DRAW,
     .lanes = 1},
    {.name = "skew",
     .unit = "1",
     .doc = "largest deviation from its shape, |b / a - lean|; 0: none",
     .standard = 0,
     .least = 0,
     .most = 1,
     .offset = SKEW,
     .lanes = 1},
    {.name = "lo",
     .unit = "1",
     .doc = "smallest size over `side`",
     .standard = 0,
     .least = 0,
     .most = 1e12,
     .offset = LO,
     .lanes = 1},
    {.name = "hi",
     .unit = "1",
     .doc = "largest size over `side`",
     .standard = 1e12,
     .least = 0,
     .most = 1e12,
     .offset = HI,
     .lanes = 1},
    {.name = "lean",
     .unit = "1",
     .doc = "b / a that it is drawn to, as a complex number, turned to edge 0-1; 0: equilateral",
     .standard = 0,
     .least = -0.5,
     .most = 0.5,
     .offset = LEAN,
     .lanes = 2},
};

static void rest(ax_lane* restrict block, int points, const ax_lane3* restrict x)
{
    for (int l = 0; l < AX_W; ++l) {
        double sum = 0;
        for (int k = 0; k < points / 2; ++k) {
            double e[3];
            for (int i = 0; i < 3; ++i)
                e[i] = x[2 * k + 1][i][l] - x[2 * k][i][l];
            sum += ax_norm3(e);
        }
        block[SIDE][l] = sum / (points / 2.0);
    }
}

// a and b of three edges given as complex numbers; and the turn and the size of the panel of this lean that is nearest to them: along
// a + b lean', as its edges are the turn times w^k + lean w^-k.
AX_INLINE void split(const double e[3][2], const double lean[2], double a[2], double b[2], double turn[2], double* size)
{
    const double h = 0.8660254037844386467637231707529362;
    // w^-1 = -1/2 - h i, w^-2 = -1/2 + h i
    double dx = e[1][0] - e[2][0], dy = e[1][1] - e[2][1];
    double sx = e[0][0] - 0.5 * (e[1][0] + e[2][0]), sy = e[0][1] - 0.5 * (e[1][1] + e[2][1]);
    a[0] = (sx + h * dy) / 3, a[1] = (sy - h * dx) / 3;
    b[0] = (sx - h * dy) / 3, b[1] = (sy + h * dx) / 3;
    double along[2] = {a[0] + b[0] * lean[0] + b[1] * lean[1], a[1] + b[1] * lean[0] - b[0] * lean[1]};
    double length = sqrt(along[0] * along[0] + along[1] * along[1]), inverse = 1 / (length > 0 ? length : 1);
    turn[0] = length > 0 ? along[0] * inverse : 1, turn[1] = along[1] * inverse;
    *size = length / (1 + lean[0] * lean[0] + lean[1] * lean[1]);
}

static void project(const ax_lane* restrict block, const ax_place* place, int points, const ax_lane3* restrict y,
                    ax_lane3* restrict p)
{
    (void)place, (void)points;
    const double h = 0.8660254037844386467637231707529362;
    for (int l = 0; l < AX_W; ++l) {
        double flat[3][2], open[3][2], first[3], second[3], u[3], v[3], r[3];
        for (int k = 0; k < 3; ++k)
            flat[k][0] = y[k][0][l], flat[k][1] = y[k][1][l];
        for (int i = 0; i < 3; ++i) { // edges that do not close lose their mean
            double mean = (y[3][i][l] + y[4][i][l] + y[5][i][l]) / 3;
            first[i] = y[3][i][l] - mean, second[i] = y[4][i][l] - mean;
        }
        ax_frame(first, second, u, v, r); // the third corner is on the side of v: counter-clockwise
        open[0][0] = r[0], open[0][1] = 0, open[1][0] = r[1], open[1][1] = r[2];
        open[2][0] = -r[0] - r[1], open[2][1] = -r[2];

        double a[2], b[2], turn[2], size, a3[2], b3[2], turn3[2], size3, lean[2] = {block[LEAN][l], block[LEAN + 1][l]};
        split((const double(*)[2])flat, lean, a, b, turn, &size);
        split((const double(*)[2])open, lean, a3, b3, turn3, &size3);
        double draw = block[DRAW][l], side = block[SIDE][l];
        double common = (size + size3 + 2 * draw * side) / (2 + 2 * draw);
        double lo = block[LO][l] * side, hi = block[HI][l] * side;
        common = common < lo ? lo : (common > hi ? hi : common);

        // b turned back to its panel, without its lean, drawn to none as the size is to `side`, and bounded
        double share = 1 / (2 + 2 * draw);
        double leans = size + size3;
        double bx = share * (b[0] * turn[0] + b[1] * turn[1] + b3[0] * turn3[0] + b3[1] * turn3[1] - leans * lean[0]);
        double by = share * (b[1] * turn[0] - b[0] * turn[1] + b3[1] * turn3[0] - b3[0] * turn3[1] - leans * lean[1]);
        double most = block[SKEW][l] * common, length = sqrt(bx * bx + by * by);
        double s = length > most ? most / length : 1;
        bx = s * bx + common * lean[0], by = s * by + common * lean[1];

        // edges of the common panel: common w^k + (bx + i by) w^-k
        double edge[3][2] = {{common + bx, by},
                             {-0.5 * common - 0.5 * bx + h * by, h * common - 0.5 * by - h * bx},
                             {-0.5 * common - 0.5 * bx - h * by, -h * common - 0.5 * by + h * bx}};
        for (int k = 0; k < 3; ++k) {
            p[k][0][l] = turn[0] * edge[k][0] - turn[1] * edge[k][1];
            p[k][1][l] = turn[0] * edge[k][1] + turn[1] * edge[k][0];
            p[k][2][l] = 0;
            double x = turn3[0] * edge[k][0] - turn3[1] * edge[k][1];
            double z = turn3[0] * edge[k][1] + turn3[1] * edge[k][0];
            for (int i = 0; i < 3; ++i)
                p[3 + k][i][l] = x * u[i] + z * v[i];
        }
    }
}

const ax_constraint_type ax_constraint_shared_panel = {
    .name = "shared_panel",
    .doc = "Keeps the flat and the deployed copy of a panel congruent and equilateral, leaning or nearly so: edges "
           "0-1, 2-3, "
           "4-5 are the flat copy in the plane, counter-clockwise, 6-7, 8-9, 10-11 the same edges deployed (nearest if "
           "equilateral; with skew the turns are those of the nearest equilateral panel).",
    .reference = "Bouaziz et al. 2012, Shape-Up (similar); Konakovic-Lukovic et al. 2018, section 5 (shared lengths)",
    .pattern = AX_ROWS_EDGES,
    .least_points = 12,
    .most_points = 12,
    .symmetry = AX_SYMMETRY_TRANSLATION | AX_SYMMETRY_SCALE,
    .partly_flat = true,
    .approximate = true,
    .lanes = LANES,
    .parameters = parameters,
    .parameter_count = sizeof parameters / sizeof *parameters,
    .rest = rest,
    .project = project,
};
