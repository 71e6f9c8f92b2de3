// One contract for all constraint types, then what each of them is meant to do, then the curves and axes they stand on.
#include "base/random.h"
#include "constraint/eigen3.h"
#include "constraint/place.h"

#include "support/test.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { MOST_LANES = 64, MOST_POINTS = 12, ROUNDS = 40 };

// A block of constraints of one type, its geometry and its rows.
typedef struct instance {
    const ax_constraint_type* type;
    int points, rows;
    ax_lane block[MOST_LANES];
    const ax_place* place;
} instance;

static ax_curve* shared_curve;
static ax_place shared_place;

static int make_curve(void** state)
{
    (void)state;
    const double points[5][3] = {{0, 0, 0}, {1, 0.2, 0.3}, {1.4, 1, -0.2}, {0.3, 1.5, 0.1}, {-0.4, 0.8, 0.5}};
    shared_curve = ax_curve_spline(points, 5, true);
    shared_place = ax_curve_place(shared_curve);
    return 0;
}

static int free_curve(void** state)
{
    (void)state;
    ax_curve_free(shared_curve);
    return 0;
}

static instance make(const ax_constraint_type* type, int points)
{
    instance made = {.type = type, .points = points, .rows = ax_row_count(type, points)};
    made.place = type->needs_place ? &shared_place : NULL;
    assert_in_range(type->lanes, 0, MOST_LANES);
    assert_in_range(points, 1, MOST_POINTS);
    ax_constraint_defaults(type, points, made.block);
    return made;
}

static instance make_named(const char* name, int points)
{
    const ax_constraint_type* type = ax_constraint_find(name);
    assert_non_null(type);
    return make(type, points);
}

// Sets a parameter in all lanes.
static void set(instance* made, const char* name, const double* value)
{
    const ax_parameter* parameter = ax_parameter_find(made->type, name);
    assert_non_null(parameter);
    for (int i = 0; i < parameter->lanes; ++i)
        for (int l = 0; l < AX_W; ++l)
            made->block[parameter->offset + i][l] = value[i];
    if (made->type->prepare)
        made->type->prepare(made->block, made->points);
}

static void set1(instance* made, const char* name, double value)
{
    set(made, name, &value);
}

static void project(const instance* made, const ax_lane3* y, ax_lane3* p)
{
    for (int k = 0; k < made->rows; ++k) // nothing of p may be read
        for (int i = 0; i < 3; ++i)
            for (int l = 0; l < AX_W; ++l)
                p[k][i][l] = NAN;
    made->type->project((const ax_lane*)made->block, made->place, made->points, y, p);
}

// y = A x
static void gather(const instance* made, const ax_lane3* x, ax_lane3* y)
{
    for (int r = 0; r < made->rows; ++r)
        for (int i = 0; i < 3; ++i)
            for (int l = 0; l < AX_W; ++l) {
                y[r][i][l] = 0;
                for (int k = 0; k < made->points; ++k)
                    y[r][i][l] += ax_row_coefficient(made->type, made->points, r, k) * x[k][i][l];
            }
}

// Projects the points p (one constraint, copied to all lanes) and returns its rows in `out`.
static void project_points(const instance* made, const double (*points)[3], double (*out)[3])
{
    ax_lane3 x[MOST_POINTS], y[MOST_POINTS], p[MOST_POINTS];
    for (int k = 0; k < made->points; ++k)
        for (int i = 0; i < 3; ++i)
            for (int l = 0; l < AX_W; ++l)
                x[k][i][l] = points[k][i];
    gather(made, x, y);
    project(made, y, p);
    for (int r = 0; r < made->rows; ++r)
        for (int i = 0; i < 3; ++i)
            out[r][i] = p[r][i][AX_W - 1];
}

static double square(const instance* made, const ax_lane3* a, const ax_lane3* b, int l)
{
    double sum = 0;
    for (int r = 0; r < made->rows; ++r)
        for (int i = 0; i < 3; ++i)
            sum += (a[r][i][l] - b[r][i][l]) * (a[r][i][l] - b[r][i][l]);
    return sum;
}

static double size_of(const instance* made, const ax_lane3* a, int l)
{
    double sum = 0;
    for (int r = 0; r < made->rows; ++r)
        for (int i = 0; i < 3; ++i)
            sum = fmax(sum, fabs(a[r][i][l]));
    return sum;
}

typedef enum input { ORDINARY, COINCIDENT, COLLINEAR, COPLANAR, HUGE_INPUT, TINY_INPUT, NEAR_ORIGIN, INPUTS } input;

static void draw_points(const instance* made, input kind, ax_random* random, ax_lane3* x)
{
    double scale = kind == HUGE_INPUT ? 0.25 * AX_HUGE : kind == TINY_INPUT ? 1e-170 : 1;
    for (int l = 0; l < AX_W; ++l) {
        double a[3], b[3], c[3];
        for (int i = 0; i < 3; ++i) {
            a[i] = ax_random_uniform(random, -1, 1);
            b[i] = ax_random_uniform(random, -1, 1);
            c[i] = ax_random_uniform(random, -1, 1);
        }
        if (kind == NEAR_ORIGIN)
            a[0] = a[1] = a[2] = 0;
        for (int k = 0; k < made->points; ++k) {
            double s = ax_random_uniform(random, -1, 1), t = ax_random_uniform(random, -1, 1);
            for (int i = 0; i < 3; ++i) {
                double value = ax_random_uniform(random, -1, 1);
                if (kind == COINCIDENT || kind == NEAR_ORIGIN)
                    value = a[i];
                else if (kind == COLLINEAR)
                    value = a[i] + s * b[i];
                else if (kind == COPLANAR)
                    value = a[i] + s * b[i] + t * c[i];
                x[k][i][l] = scale * value * !(made->type->flat && i == 2);
            }
        }
    }
}

static void draw_parameters(instance* made, ax_random* random)
{
    for (int k = 0; k < made->type->parameter_count; ++k) {
        const ax_parameter* parameter = &made->type->parameters[k];
        bool positive = !strcmp(parameter->unit, "length") || !strcmp(parameter->unit, "area");
        double least = positive ? 0.5 : fmax(parameter->least, -4), most = fmin(parameter->most, positive ? 2 : 4);
        for (int i = 0; i < parameter->lanes; ++i)
            for (int l = 0; l < AX_W; ++l)
                made->block[parameter->offset + i][l] = ax_random_uniform(random, least, most);
    }
    if (made->type->prepare)
        made->type->prepare(made->block, made->points);
}

// Every parameter at one end of its range.
static void draw_extremes(instance* made, ax_random* random)
{
    for (int k = 0; k < made->type->parameter_count; ++k) {
        const ax_parameter* parameter = &made->type->parameters[k];
        for (int i = 0; i < parameter->lanes; ++i)
            for (int l = 0; l < AX_W; ++l)
                made->block[parameter->offset + i][l] = ax_random_bits(random) % 2 ? parameter->least : parameter->most;
    }
    if (made->type->prepare)
        made->type->prepare(made->block, made->points);
}

// Runs `check` on every type with every number of points up to nine.
static void for_all(void (*check)(instance* made, ax_random* random))
{
    int count;
    const ax_constraint_type* const* types = ax_constraint_types(&count);
    for (int t = 0; t < count; ++t) {
        const ax_constraint_type* type = types[t];
        ax_random random = {(uint64_t)t + 1};
        for (int n = type->least_points; n <= type->most_points && n <= 9; ++n) {
            instance made = make(type, n);
            check(&made, &random);
        }
    }
}

#define REQUIRE(made, condition, ...)                                                                                  \
    do {                                                                                                               \
        if (!(condition)) {                                                                                            \
            print_error("%s on %d points: ", (made)->type->name, (made)->points);                                      \
            print_error(__VA_ARGS__);                                                                                  \
            print_error("\n");                                                                                         \
            fail();                                                                                                    \
        }                                                                                                              \
    } while (0)

static void every_type_describes_itself(void** state)
{
    (void)state;
    static const char* const units[] = {"1", "length", "area", "rad", "point", "direction"};
    int count;
    const ax_constraint_type* const* types = ax_constraint_types(&count);
    assert_true(count >= 19);
    for (int t = 0; t < count; ++t) {
        const ax_constraint_type* type = types[t];
        assert_ptr_equal(ax_constraint_find(type->name), type);
        assert_true(t == 0 || strcmp(types[t - 1]->name, type->name) < 0);
        assert_true(strlen(type->doc) > 10 && type->doc[strlen(type->doc) - 1] == '.');
        assert_true(strlen(type->reference) > 10);
        assert_true(1 <= type->least_points && type->least_points <= type->most_points);
        assert_true(type->most_points <= AX_MOST_POINTS);
        assert_non_null(type->project);
        assert_true((type->coefficient != NULL) == (type->pattern == AX_ROWS_SUM));
        if (type->pattern == AX_ROWS_EDGES)
            assert_true(type->least_points % 2 == 0 && type->least_points == type->most_points);
        bool owned[MOST_LANES] = {false};
        for (int k = 0; k < type->parameter_count; ++k) {
            const ax_parameter* parameter = &type->parameters[k];
            assert_ptr_equal(ax_parameter_find(type, parameter->name), parameter);
            assert_true(strlen(parameter->doc) > 5);
            int unit = 0;
            while (unit < 6 && strcmp(units[unit], parameter->unit))
                ++unit;
            assert_in_range(unit, 0, 5);
            if (unit >= 4)
                assert_int_equal(parameter->lanes, 3);
            assert_true(parameter->least <= parameter->standard && parameter->standard <= parameter->most);
            assert_true(parameter->lanes >= 1);
            for (int i = parameter->offset; i < parameter->offset + parameter->lanes; ++i) {
                assert_in_range(i, 0, type->lanes - 1);
                assert_false(owned[i]);
                owned[i] = true;
            }
        }
        // what no parameter owns is prepared
        for (int i = 0; i < type->lanes; ++i)
            assert_true(owned[i] || type->prepare);
    }
    assert_null(ax_constraint_find("no_such_type"));
    assert_null(ax_parameter_find(types[0], "no_such_parameter"));
}

// Rows of points that move together do not change or move along: the sum of a row is 0 or 1.
static double row_sum(const instance* made, int row)
{
    double sum = 0;
    for (int k = 0; k < made->points; ++k)
        sum += ax_row_coefficient(made->type, made->points, row, k);
    return sum;
}

static bool moves_along(const instance* made)
{
    return made->type->pattern == AX_ROWS_POINTS || (made->type->pattern == AX_ROWS_SUM && row_sum(made, 0) > 0.5);
}

static void check_rows(instance* made, ax_random* random)
{
    (void)random;
    bool along = moves_along(made);
    for (int r = 0; r < made->rows; ++r) {
        REQUIRE(made, fabs(row_sum(made, r) - along) < 1e-14, "row %d sums to %g", r, row_sum(made, r));
        for (int k = 0; k < made->points; ++k)
            REQUIRE(made, isfinite(ax_row_coefficient(made->type, made->points, r, k)), "coefficient");
    }
}

static void rows_are_points_or_differences(void** state)
{
    (void)state;
    for_all(check_rows);
}

static void check_finite(instance* made, ax_random* random)
{
    ax_lane3 x[MOST_POINTS], y[MOST_POINTS], p[MOST_POINTS];
    for (int round = 0; round < ROUNDS; ++round)
        for (int kind = 0; kind < INPUTS; ++kind) {
            if (round % 2)
                draw_extremes(made, random);
            else
                draw_parameters(made, random);
            draw_points(made, kind, random, x);
            gather(made, x, y);
            project(made, y, p);
            for (int r = 0; r < made->rows; ++r)
                for (int i = 0; i < 3; ++i)
                    for (int l = 0; l < AX_W; ++l)
                        REQUIRE(made, isfinite(p[r][i][l]), "input %d gives %g", kind, p[r][i][l]);
        }
}

static void finite_rows_for_every_finite_input(void** state)
{
    (void)state;
    for_all(check_finite);
}

static void check_idempotent(instance* made, ax_random* random)
{
    ax_lane3 x[MOST_POINTS], y[MOST_POINTS], p[MOST_POINTS], q[MOST_POINTS];
    for (int round = 0; round < ROUNDS; ++round)
        for (int kind = 0; kind < INPUTS; ++kind) {
            draw_parameters(made, random);
            draw_points(made, kind, random, x);
            gather(made, x, y);
            if (kind == COINCIDENT && made->type->pattern != AX_ROWS_POINTS)
                memset(y, 0, sizeof y); // not the rounding of differences that vanish
            project(made, y, p);
            project(made, p, q);
            for (int l = 0; l < AX_W; ++l) {
                double moved = sqrt(square(made, p, q, l)), size = fmax(size_of(made, p, l), size_of(made, y, l));
                if (kind == HUGE_INPUT) { // squares of differences overflow
                    moved = 0;
                    for (int r = 0; r < made->rows; ++r)
                        for (int i = 0; i < 3; ++i)
                            moved = fmax(moved, fabs(p[r][i][l] - q[r][i][l]));
                }
                REQUIRE(made, moved <= 1e-10 * size, "input %d: %g of %g", kind, moved, size);
            }
            for (int l = 0; l < AX_W && made->type->pattern == AX_ROWS_CENTRED; ++l) {
                double mean[2] = {0, 0}, size = fmax(size_of(made, p, l), size_of(made, y, l));
                for (int i = 0; i < 3; ++i) {
                    double sum[2] = {0, 0};
                    for (int r = 0; r < made->rows; ++r)
                        sum[0] += y[r][i][l] / made->rows, sum[1] += p[r][i][l] / made->rows;
                    mean[0] = fmax(mean[0], fabs(sum[0])), mean[1] = fmax(mean[1], fabs(sum[1]));
                }
                REQUIRE(made, mean[1] <= 1e-12 * size + 10 * mean[0], "mean %g of %g", mean[1], size);
            }
        }
}

static void what_is_admissible_stays(void** state)
{
    (void)state;
    for_all(check_idempotent);
}

// No other admissible rows are nearer. They are made by projecting from everywhere near and far. Types that are
// approximate are tried from a small distance, where they may lose a little.
static void check_nearest(instance* made, ax_random* random)
{
    ax_lane3 x[MOST_POINTS], y[MOST_POINTS], p[MOST_POINTS], z[MOST_POINTS], q[MOST_POINTS];
    bool approximate = made->type->approximate;
    double slack = approximate ? 1.02 : 1;
    for (int round = 0; round < ROUNDS; ++round) {
        draw_parameters(made, random);
        draw_points(made, round % 4 == 3 ? COPLANAR : ORDINARY, random, x);
        gather(made, x, y);
        if (approximate) {
            project(made, y, p);
            draw_points(made, ORDINARY, random, x);
            gather(made, x, z);
            for (int r = 0; r < made->rows; ++r)
                for (int i = 0; i < 3; ++i)
                    for (int l = 0; l < AX_W; ++l)
                        y[r][i][l] = p[r][i][l] + 1e-6 * z[r][i][l];
        }
        project(made, y, p);
        for (int trial = 0; trial < 60; ++trial) {
            draw_points(made, ORDINARY, random, x);
            gather(made, x, z);
            double far = pow(10, -(trial % 6));
            for (int r = 0; r < made->rows; ++r)
                for (int i = 0; i < 3; ++i)
                    for (int l = 0; l < AX_W; ++l)
                        z[r][i][l] = far * z[r][i][l] + (trial % 2 ? p[r][i][l] : trial % 3 ? y[r][i][l] : 0);
            project(made, z, q);
            for (int l = 0; l < AX_W; ++l) {
                double ours = sqrt(square(made, y, p, l)), other = sqrt(square(made, y, q, l));
                REQUIRE(made, ours <= slack * other + 1e-12 * (1 + ours), "%.15g away, %.15g is possible", ours, other);
            }
        }
    }
}

static void no_admissible_rows_are_nearer(void** state)
{
    (void)state;
    for_all(check_nearest);
}

// A motion of space: x -> scale R x + shift.
typedef struct motion {
    double r[3][3], scale, shift[3];
} motion;

static motion draw_motion(int symmetry, bool flat, ax_random* random)
{
    motion m = {.r = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}, .scale = 1};
    if (symmetry & AX_SYMMETRY_ROTATION) {
        double q[4], norm = 0;
        for (int k = 0; k < 4; ++k) {
            q[k] = flat && (k == 1 || k == 2) ? 0 : ax_random_uniform(random, -1, 1);
            norm += q[k] * q[k];
        }
        double w = q[0], x = q[1], y = q[2], z = q[3], s = 2 / norm;
        double r[3][3] = {{1 - s * (y * y + z * z), s * (x * y - z * w), s * (x * z + y * w)},
                          {s * (x * y + z * w), 1 - s * (x * x + z * z), s * (y * z - x * w)},
                          {s * (x * z - y * w), s * (y * z + x * w), 1 - s * (x * x + y * y)}};
        memcpy(m.r, r, sizeof r);
    }
    if (symmetry & AX_SYMMETRY_SCALE)
        m.scale = ax_random_uniform(random, 0.1, 10);
    if (symmetry & AX_SYMMETRY_TRANSLATION)
        for (int i = 0; i < 3; ++i)
            m.shift[i] = flat && i == 2 ? 0 : ax_random_uniform(random, -10, 10);
    return m;
}

// Moves lane l of a vector; `weight` of the shift.
static void move(const motion* m, ax_lane* x, int l, double scale, double weight)
{
    double y[3];
    for (int i = 0; i < 3; ++i)
        y[i] = scale * (m->r[i][0] * x[0][l] + m->r[i][1] * x[1][l] + m->r[i][2] * x[2][l]) + weight * m->shift[i];
    for (int i = 0; i < 3; ++i)
        x[i][l] = y[i];
}

static void move_parameters(instance* made, const motion* m)
{
    for (int k = 0; k < made->type->parameter_count; ++k) {
        const ax_parameter* parameter = &made->type->parameters[k];
        ax_lane* value = made->block + parameter->offset;
        for (int l = 0; l < AX_W; ++l) {
            if (!strcmp(parameter->unit, "point"))
                move(m, value, l, m->scale, 1);
            else if (!strcmp(parameter->unit, "direction"))
                move(m, value, l, 1, 0);
            else if (!strcmp(parameter->unit, "length") || !strcmp(parameter->unit, "area"))
                for (int i = 0; i < parameter->lanes; ++i)
                    value[i][l] *= parameter->unit[0] == 'a' ? m->scale * m->scale : m->scale;
        }
    }
    if (made->type->prepare)
        made->type->prepare(made->block, made->points);
}

// Largest difference, over the lanes, of moving the projection and projecting what was moved.
static double asymmetry(const instance* before, const instance* after, const motion* m, ax_random* random)
{
    ax_lane3 x[MOST_POINTS], y[MOST_POINTS], p[MOST_POINTS], q[MOST_POINTS];
    draw_points(before, ORDINARY, random, x);
    gather(before, x, y);
    project(before, y, p);
    double worst = 0;
    for (int l = 0; l < AX_W; ++l) {
        for (int k = 0; k < before->points; ++k)
            move(m, x[k], l, m->scale, 1);
        for (int r = 0; r < before->rows; ++r)
            move(m, p[r], l, m->scale, moves_along(before));
    }
    gather(after, x, y);
    project(after, y, q);
    for (int l = 0; l < AX_W; ++l)
        worst = fmax(worst, sqrt(square(before, p, q, l)) / fmax(1, size_of(before, p, l)));
    return worst;
}

static void check_symmetry(instance* made, ax_random* random)
{
    for (int bit = AX_SYMMETRY_TRANSLATION; bit <= AX_SYMMETRY_SCALE; bit *= 2) {
        double worst = 0;
        for (int round = 0; round < ROUNDS; ++round) {
            draw_parameters(made, random);
            motion m = draw_motion(bit, made->type->flat, random);
            worst = fmax(worst, asymmetry(made, made, &m, random));
        }
        if (made->type->symmetry & bit)
            REQUIRE(made, worst < 1e-10, "symmetry %d holds to %g only", bit, worst);
        else if (!(bit == AX_SYMMETRY_TRANSLATION && !moves_along(made)))
            REQUIRE(made, worst > 1e-3, "symmetry %d holds and is not declared", bit);
    }
}

static void declared_symmetries_hold_and_no_others(void** state)
{
    (void)state;
    for_all(check_symmetry);
}

static void check_motion(instance* made, ax_random* random)
{
    if (made->type->needs_place)
        return; // its geometry would have to move too
    for (int round = 0; round < ROUNDS; ++round) {
        draw_parameters(made, random);
        instance after = *made;
        motion m = draw_motion(7, made->type->flat || made->type->partly_flat, random);
        move_parameters(&after, &m);
        double worst = asymmetry(made, &after, &m, random);
        REQUIRE(made, worst < 1e-10, "%g", worst);
    }
}

static void types_follow_motions_of_all_their_parameters(void** state)
{
    (void)state;
    for_all(check_motion);
}

// What a lane gets does not depend on what is in the others: bit for bit the same beside huge, coincident or other
// neighbours.
static void check_lanes(instance* made, ax_random* random)
{
    ax_lane3 x[MOST_POINTS], y[MOST_POINTS], p[MOST_POINTS], z[MOST_POINTS], q[MOST_POINTS];
    for (int round = 0; round < ROUNDS; ++round) {
        draw_parameters(made, random);
        draw_points(made, (input)(round % INPUTS), random, x);
        gather(made, x, y);
        project(made, y, p);
        for (int kind = 0; kind < INPUTS; ++kind) {
            int l = (round + kind) % AX_W;
            instance beside = *made;
            draw_extremes(&beside, random);
            draw_points(made, (input)kind, random, x);
            gather(made, x, z);
            for (int k = 0; k < made->type->lanes; ++k)
                beside.block[k][l] = made->block[k][l];
            for (int r = 0; r < made->rows; ++r)
                for (int i = 0; i < 3; ++i)
                    z[r][i][l] = y[r][i][l];
            project(&beside, z, q);
            for (int r = 0; r < made->rows; ++r)
                for (int i = 0; i < 3; ++i)
                    REQUIRE(made, !memcmp(&p[r][i][l], &q[r][i][l], sizeof(double)),
                            "lane %d: %.17g beside input %d: %.17g", l, p[r][i][l], kind, q[r][i][l]);
        }
    }
}

static void lanes_do_not_see_each_other(void** state)
{
    (void)state;
    for_all(check_lanes);
}

// One constraint alone in its block, in any lane, is what it was among seven others: wide is scalar.
static void check_alone(instance* made, ax_random* random)
{
    ax_lane3 x[MOST_POINTS], y[MOST_POINTS], p[MOST_POINTS], z[MOST_POINTS], q[MOST_POINTS];
    for (int round = 0; round < ROUNDS; ++round) {
        draw_parameters(made, random);
        draw_points(made, (input)(round % INPUTS), random, x);
        gather(made, x, y);
        project(made, y, p);
        for (int from = 0; from < AX_W; ++from) {
            int to = (from + round) % AX_W;
            instance alone = make(made->type, made->points);
            memset(z, 0, sizeof z);
            for (int k = 0; k < made->type->lanes; ++k)
                alone.block[k][to] = made->block[k][from];
            for (int r = 0; r < made->rows; ++r)
                for (int i = 0; i < 3; ++i)
                    z[r][i][to] = y[r][i][from];
            if (made->type->prepare)
                made->type->prepare(alone.block, made->points);
            project(&alone, z, q);
            for (int r = 0; r < made->rows; ++r)
                for (int i = 0; i < 3; ++i)
                    REQUIRE(made, !memcmp(&p[r][i][from], &q[r][i][to], sizeof(double)), "%.17g alone %.17g",
                            p[r][i][from], q[r][i][to]);
        }
    }
}

static void one_alone_is_one_of_eight(void** state)
{
    (void)state;
    for_all(check_alone);
}

// rest() writes parameters and nothing else, inside their ranges, and the defaults stand where it is silent.
static void check_rest(instance* made, ax_random* random)
{
    ax_lane3 x[MOST_POINTS];
    if (!made->type->rest)
        return;
    draw_points(made, ORDINARY, random, x);
    instance before = *made;
    made->type->rest(made->block, made->points, (const ax_lane3*)x);
    bool written = false;
    for (int i = 0; i < made->type->lanes; ++i) {
        const ax_parameter* owner = NULL;
        for (int k = 0; k < made->type->parameter_count; ++k) {
            const ax_parameter* parameter = &made->type->parameters[k];
            if (i >= parameter->offset && i < parameter->offset + parameter->lanes)
                owner = parameter;
        }
        bool changed = memcmp(before.block[i], made->block[i], sizeof(ax_lane)) != 0;
        written = written || changed;
        REQUIRE(made, !changed || owner, "prepared lane %d written", i);
        for (int l = 0; changed && l < AX_W; ++l)
            REQUIRE(made, made->block[i][l] >= owner->least && made->block[i][l] <= owner->most, "%s", owner->name);
    }
    REQUIRE(made, written, "nothing learned");
}

static void rest_shapes_fill_parameters_only(void** state)
{
    (void)state;
    for_all(check_rest);
}

static void every_type_is_in_the_documentation(void** state)
{
    (void)state;
    FILE* file = fopen(AX_SOURCE_DIR "/docs/constraints.md", "r");
    assert_non_null(file);
    static char text[1 << 16];
    size_t size = fread(text, 1, sizeof text - 1, file);
    fclose(file);
    assert_true(size < sizeof text - 1);
    int count;
    const ax_constraint_type* const* types = ax_constraint_types(&count);
    for (int t = 0; t < count; ++t) {
        char row[64];
        snprintf(row, sizeof row, "\n| `%s` |", types[t]->name);
        const char* start = strstr(text, row);
        if (!start)
            fail_msg("docs/constraints.md has no row for %s", types[t]->name);
        const char* end = strchr(start + 1, '\n');
        for (int k = 0; k < types[t]->parameter_count; ++k) {
            char quoted[64];
            snprintf(quoted, sizeof quoted, "`%s`", types[t]->parameters[k].name);
            const char* found = strstr(start, quoted);
            if (!found || found > end)
                fail_msg("docs/constraints.md: the row of %s does not name %s", types[t]->name, quoted);
        }
    }
}

// --- what each type is meant to do ---

static void edges_are_clamped_to_their_range(void** state)
{
    (void)state;
    instance made = make_named("edge_length", 2);
    set1(&made, "length", 2), set1(&made, "lo", 0.5), set1(&made, "hi", 1.5);
    double p[1][3];
    project_points(&made, (const double[2][3]){{1, 1, 1}, {1, 7, 9}}, p); // length 10
    assert_near(p[0][0], 0, 1e-15), assert_near(p[0][1], 1.8, 1e-15), assert_near(p[0][2], 2.4, 1e-15);
    project_points(&made, (const double[2][3]){{0, 0, 0}, {0, 0.3, 0.4}}, p);
    assert_near(p[0][1], 0.6, 1e-15), assert_near(p[0][2], 0.8, 1e-15);
    project_points(&made, (const double[2][3]){{0, 0, 0}, {0, 0, 2.5}}, p);
    assert_near(p[0][2], 2.5, 0);
}

static double distance_between(const double a[3], const double b[3])
{
    return ax_distance3(a, b);
}

static void panels_get_the_edges_of_their_template(void** state)
{
    (void)state;
    const double lengths[3] = {4, 3, 2}, one = 1;
    ax_random random = {3};
    for (int round = 0; round < ROUNDS; ++round) {
        instance made = make_named("rigid_triangle", 3), flat = make_named("flat_triangle", 3);
        set(&made, "lengths", lengths), set(&flat, "lengths", lengths), set(&made, "lo", &one);
        double x[3][3], p[3][3], q[3][3];
        for (int k = 0; k < 9; ++k)
            x[k / 3][k % 3] = ax_random_uniform(&random, -1, 1);
        project_points(&made, (const double(*)[3])x, p);
        project_points(&flat, (const double(*)[3])x, q);
        for (int k = 0; k < 3; ++k) {
            assert_near(distance_between(p[(k + 1) % 3], p[(k + 2) % 3]), lengths[k], 1e-14);
            assert_near(distance_between(q[(k + 1) % 3], q[(k + 2) % 3]), lengths[k], 1e-14);
            assert_true(q[k][2] == 0);
        }
        assert_true(ax_orient2(q[0], q[1], q[2]) > 0);
    }
}

static void panels_shrink_to_their_size_where_they_are(void** state)
{
    (void)state;
    // a right triangle 3, 4, 5 twice too large and turned over: only its size changes
    const double x[3][3] = {{1, 1, 5}, {1, 7, 5}, {9, 1, 5}}, lengths[3] = {5, 4, 3};
    double mean[3] = {11.0 / 3, 3, 5}, p[3][3];
    instance made = make_named("rigid_triangle", 3);
    set(&made, "lengths", lengths);
    project_points(&made, x, p);
    for (int k = 0; k < 3; ++k)
        for (int i = 0; i < 3; ++i)
            assert_near(p[k][i], 0.5 * (x[k][i] - mean[i]), 1e-14);
    set1(&made, "hi", 1.5); // similar up to that size
    project_points(&made, x, p);
    for (int k = 0; k < 3; ++k)
        for (int i = 0; i < 3; ++i)
            assert_near(p[k][i], 0.75 * (x[k][i] - mean[i]), 1e-14);
}

static void lengths_of_no_triangle_make_a_flat_one(void** state)
{
    (void)state;
    const double x[3][3] = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
    for (int k = 0; k < 3; ++k) { // edge k too long for the others
        double lengths[3] = {3, 3, 3}, p[3][3];
        lengths[k] = 10;
        instance made = make_named("rigid_triangle", 3);
        set(&made, "lengths", lengths);
        project_points(&made, x, p);
        assert_near(distance_between(p[0], p[1]), lengths[2], 1e-14);
        assert_near(distance_between(p[0], p[2]), lengths[1], 1e-14);
        assert_near(distance_between(p[1], p[2]), k == 0 ? 6 : 7, 1e-14);
    }
}

static void flat_panels_are_never_turned_over(void** state)
{
    (void)state;
    // clockwise: in space a panel seen from below, which may stay; in the plane it has to turn back
    const double x[3][3] = {{0, 0, 0}, {0, 1, 0}, {1, 0, 0}}, lengths[3] = {sqrt(2), 1, 1};
    double p[3][3];
    instance space = make_named("rigid_triangle", 3), plane = make_named("flat_triangle", 3);
    set(&space, "lengths", lengths), set(&plane, "lengths", lengths);
    project_points(&space, x, p);
    assert_near(ax_orient2(p[0], p[1], p[2]), -1, 1e-14);
    project_points(&plane, x, p);
    assert_near(ax_orient2(p[0], p[1], p[2]), 1, 1e-14);
}

static void templates_are_learned_from_the_rest_shape(void** state)
{
    (void)state;
    const char* const names[4] = {"rigid_triangle", "flat_triangle", "triangle_area", "edge_length"};
    ax_random random = {4};
    for (int t = 0; t < 4; ++t) {
        instance made = make_named(names[t], t == 3 ? 2 : 3);
        ax_lane3 x[3], y[3], p[3];
        for (int round = 0; round < ROUNDS; ++round) {
            draw_points(&made, ORDINARY, &random, x);
            for (int l = 0; l < AX_W && t == 1; ++l) { // counter-clockwise
                double a[2] = {x[0][0][l], x[0][1][l]}, b[2] = {x[1][0][l], x[1][1][l]},
                       c[2] = {x[2][0][l], x[2][1][l]};
                if (ax_orient2(a, b, c) < 0)
                    for (int k = 0; k < 3; ++k)
                        x[k][0][l] = -x[k][0][l];
            }
            made.type->rest(made.block, made.points, (const ax_lane3*)x);
            if (made.type->prepare)
                made.type->prepare(made.block, made.points);
            gather(&made, x, y);
            project(&made, y, p);
            for (int l = 0; l < AX_W; ++l)
                assert_at_most(sqrt(square(&made, y, p, l)), 1e-12);
        }
    }
}

static void the_equilateral_part_of_a_triangle_is_kept(void** state)
{
    (void)state;
    // alpha w^k + beta w^-k with alpha = 2, beta = 0.7 exp(0.4 i): alpha stays
    double x[3][3], p[3][3];
    for (int k = 0; k < 3; ++k) {
        double t = 2 * AX_PI * k / 3;
        x[k][0] = 5, x[k][1] = 2 * cos(t) + 0.7 * cos(0.4 - t), x[k][2] = 2 * sin(t) + 0.7 * sin(0.4 - t);
    }
    instance made = make_named("equilateral_triangle", 3);
    project_points(&made, (const double(*)[3])x, p);
    for (int k = 0; k < 3; ++k) {
        double t = 2 * AX_PI * k / 3;
        assert_near(p[k][0], 0, 1e-15), assert_near(p[k][1], 2 * cos(t), 2e-15),
            assert_near(p[k][2], 2 * sin(t), 2e-15);
    }
    set1(&made, "length", 1.5), set1(&made, "hi", 2);
    project_points(&made, (const double(*)[3])x, p);
    assert_near(distance_between(p[0], p[1]), 3, 1e-14);
}

static void flat_and_deployed_edge_meet_at_their_mean_length(void** state)
{
    (void)state;
    instance made = make_named("congruent_pair", 4);
    double p[2][3];
    project_points(&made, (const double[4][3]){{0, 0, 0}, {3, 4, 0}, {1, 1, 1}, {1, 1, 2}}, p);
    assert_near(p[0][0], 1.8, 1e-15), assert_near(p[0][1], 2.4, 1e-15), assert_near(p[1][2], 3, 1e-15);
}

static void closeness_is_its_target(void** state)
{
    (void)state;
    instance made = make_named("closeness", 1);
    double p[1][3];
    set(&made, "target", (const double[3]){1, 2, 3});
    project_points(&made, (const double[1][3]){{7, 8, 9}}, p);
    assert_near(p[0][0], 1, 0), assert_near(p[0][1], 2, 0), assert_near(p[0][2], 3, 0);
}

static void points_go_to_their_place(void** state)
{
    (void)state;
    ax_curve* circle = ax_curve_circle((const double[3]){1, 0, 2}, (const double[3]){0, 0, -3}, 2);
    ax_place place = ax_curve_place(circle);
    instance made = make_named("on_geometry", 1);
    made.place = &place;
    double p[1][3];
    project_points(&made, (const double[1][3]){{4, 4, 9}}, p);
    assert_near(p[0][0], 2.2, 1e-15), assert_near(p[0][1], 1.6, 1e-15), assert_near(p[0][2], 2, 1e-15);
    ax_curve_free(circle);
}

static void a_zigzag_hexagon_flattens_to_its_middle_plane(void** state)
{
    (void)state;
    double x[6][3], p[6][3];
    for (int k = 0; k < 6; ++k)
        x[k][0] = cos(AX_PI * k / 3), x[k][1] = sin(AX_PI * k / 3), x[k][2] = k % 2 ? 0.2 : -0.2;
    instance made = make_named("plane", 6);
    project_points(&made, (const double(*)[3])x, p);
    for (int k = 0; k < 6; ++k) {
        assert_near(p[k][0], x[k][0], 1e-15), assert_near(p[k][1], x[k][1], 1e-15), assert_near(p[k][2], 0, 1e-15);
    }
}

static void points_go_straight_to_the_line_of_least_squares(void** state)
{
    (void)state;
    // symmetric about the x axis
    const double x[4][3] = {{-2, 0.1, 0}, {-2, -0.1, 0}, {2, 0, 0.3}, {2, 0, -0.3}};
    double p[4][3];
    instance made = make_named("line", 4);
    project_points(&made, x, p);
    for (int k = 0; k < 4; ++k) {
        assert_near(p[k][0], x[k][0], 1e-15), assert_near(p[k][1], 0, 1e-15), assert_near(p[k][2], 0, 1e-15);
    }
}

// Eigenvalues, falling, and vectors of a symmetric matrix by Jacobi rotations: slow, sure, and nothing like the closed
// form.
static void jacobi(double a[3][3], double value[3], double vector[3][3])
{
    double v[3][3] = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
    for (int sweep = 0; sweep < 30; ++sweep)
        for (int p = 0; p < 2; ++p)
            for (int q = p + 1; q < 3; ++q) {
                if (a[p][q] == 0)
                    continue;
                double theta = 0.5 * atan2(2 * a[p][q], a[q][q] - a[p][p]), c = cos(theta), s = sin(theta);
                for (int k = 0; k < 3; ++k) {
                    double x = a[k][p], y = a[k][q];
                    a[k][p] = c * x - s * y, a[k][q] = s * x + c * y;
                }
                for (int k = 0; k < 3; ++k) {
                    double x = a[p][k], y = a[q][k];
                    a[p][k] = c * x - s * y, a[q][k] = s * x + c * y;
                    x = v[k][p], y = v[k][q];
                    v[k][p] = c * x - s * y, v[k][q] = s * x + c * y;
                }
            }
    for (int k = 0; k < 3; ++k) {
        int rank = 0;
        for (int j = 0; j < 3; ++j)
            rank += a[j][j] > a[k][k] || (a[j][j] == a[k][k] && j < k);
        value[rank] = a[k][k];
        for (int i = 0; i < 3; ++i)
            vector[rank][i] = v[i][k];
    }
}

static void principal_frame(int n, const double (*x)[3], double value[3], double vector[3][3])
{
    double a[3][3] = {{0}};
    for (int k = 0; k < n; ++k)
        for (int i = 0; i < 3; ++i)
            for (int j = 0; j < 3; ++j)
                a[i][j] += x[k][i] * x[k][j];
    jacobi(a, value, vector);
}

// ShapeOp's circle projection as published, step by step.
static void published_circle(int n, const double (*x)[3], double (*out)[3])
{
    double value[3], e[3][3], suu = 0, suv = 0, svv = 0, suuu = 0, svvv = 0, suvv = 0, svuu = 0;
    principal_frame(n, x, value, e);
    for (int k = 0; k < n; ++k) {
        double u = ax_dot3(x[k], e[0]), v = ax_dot3(x[k], e[1]);
        suu += u * u, suv += u * v, svv += v * v;
        suuu += u * u * u, svvv += v * v * v, suvv += u * v * v, svuu += v * u * u;
    }
    double det = suu * svv - suv * suv, e1 = 0.5 * (suuu + suvv), e2 = 0.5 * (svvv + svuu);
    double cu = (svv * e1 - suv * e2) / det, cv = (suu * e2 - suv * e1) / det,
           r = sqrt(cu * cu + cv * cv + (suu + svv) / n);
    for (int k = 0; k < n; ++k) {
        double u = ax_dot3(x[k], e[0]) - cu, v = ax_dot3(x[k], e[1]) - cv, s = r / sqrt(u * u + v * v);
        for (int i = 0; i < 3; ++i)
            out[k][i] = (cu + s * u) * e[0][i] + (cv + s * v) * e[1][i];
    }
}

static void centre(int n, double (*x)[3])
{
    for (int i = 0; i < 3; ++i) {
        double mean = 0;
        for (int k = 0; k < n; ++k)
            mean += x[k][i] / n;
        for (int k = 0; k < n; ++k)
            x[k][i] -= mean;
    }
}

static void holes_go_to_the_published_circle(void** state)
{
    (void)state;
    ax_random random = {5};
    for (int round = 0; round < 200; ++round) {
        int n = 4 + round % 5;
        double x[MOST_POINTS][3], p[MOST_POINTS][3], q[MOST_POINTS][3], noise = round % 3 ? 0.3 : 1e-6;
        for (int k = 0; k < n; ++k) {
            double t = 2 * AX_PI * k / n;
            x[k][0] = cos(t), x[k][1] = sin(t), x[k][2] = 0;
            for (int i = 0; i < 3; ++i)
                x[k][i] += ax_random_uniform(&random, -noise, noise);
        }
        centre(n, x);
        instance made = make_named("circle", n);
        project_points(&made, (const double(*)[3])x, p);
        published_circle(n, (const double(*)[3])x, q);
        centre(n, q);
        for (int k = 0; k < n; ++k)
            assert_at_most(distance_between(p[k], q[k]), 1e-13);
    }
}

static void points_almost_on_a_line_get_no_circle(void** state)
{
    (void)state;
    // a parabola of height h over a base of 2: a circle from about 1/1000 on, its plane only below
    double x[6][3], p[6][3];
    for (int steep = 0; steep < 2; ++steep) {
        for (int k = 0; k < 6; ++k) {
            double t = -1 + 0.4 * k;
            x[k][0] = t, x[k][1] = (steep ? 1e-2 : 1e-4) * t * t * t, x[k][2] = 0;
        }
        centre(6, x);
        instance made = make_named("circle", 6);
        project_points(&made, (const double(*)[3])x, p);
        double moved = 0;
        for (int k = 0; k < 6; ++k)
            moved += distance_between(x[k], p[k]);
        if (steep)
            assert_true(moved > 1e-3);
        else
            assert_at_most(moved, 1e-14);
    }
}

static void points_round_a_sphere_go_to_its_radius(void** state)
{
    (void)state;
    // pairs at +-r along the axes: the centre is theirs, the radius squared the mean of the squares
    const double x[6][3] = {{1, 0, 0}, {-1, 0, 0}, {0, 1.1, 0}, {0, -1.1, 0}, {0, 0, 1.2}, {0, 0, -1.2}};
    double p[6][3], radius = sqrt((1 + 1.1 * 1.1 + 1.2 * 1.2) / 3);
    instance made = make_named("sphere", 6);
    project_points(&made, x, p);
    for (int k = 0; k < 6; ++k)
        assert_near(ax_norm3(p[k]), radius, 1e-14), assert_near(ax_dot3(p[k], x[k]), radius * ax_norm3(x[k]), 1e-14);
    // points of one circle, and of a shallow cap, are on spheres
    double cap[7][3];
    for (double height = 0; height < 0.1; height += 0.03) {
        for (int k = 0; k < 7; ++k) {
            cap[k][0] = k < 6 ? cos(k) : 0.1, cap[k][1] = k < 6 ? sin(k) : 0;
            cap[k][2] = k < 6 || height == 0 ? 0 : height;
        }
        int n = height > 0 ? 7 : 6;
        centre(n, cap);
        made = make_named("sphere", n);
        double q[7][3];
        project_points(&made, (const double(*)[3])cap, q);
        for (int k = 0; k < n; ++k)
            assert_at_most(distance_between(q[k], cap[k]), 1e-11);
    }
}

// Radius of the circle through three points.
static double circumradius(const double a[3], const double b[3], const double c[3])
{
    double p[3], q[3], n[3];
    ax_sub3(b, a, p), ax_sub3(c, a, q), ax_cross(p, q, n);
    return distance_between(a, b) * distance_between(b, c) * distance_between(c, a) / (2 * ax_norm3(n));
}

static void open_holes_have_their_sides_and_one_circle(void** state)
{
    (void)state;
    const double sides[6][8] = {{1, 1, 1, 1, 1, 1},      {5, 4, 3}, {1, 2, 3, 1.5, 0.7, 2.2, 1.1, 0.4},
                                {3, 1.05, 1.05, 1.05},   // centre outside
                                {1, 1.9999, 1.1, 0.901}, // nearly on a line
                                {1, 0, 1, 1, 0}};
    const int count[6] = {6, 3, 8, 4, 4, 5};
    ax_random random = {6};
    for (int t = 0; t < 6; ++t)
        for (int round = 0; round < ROUNDS; ++round) {
            int n = count[t];
            double x[8][3], p[8][3];
            instance made = make_named("cyclic_polygon", n);
            set(&made, "sides", sides[t]);
            for (int k = 0; k < 3 * n; ++k)
                x[k / 3][k % 3] = ax_random_uniform(&random, -1, 1);
            project_points(&made, (const double(*)[3])x, p);
            int longest = 0;
            for (int k = 0; k < n; ++k) {
                assert_near(distance_between(p[k], p[(k + 1) % n]), sides[t][k], 1e-13);
                longest = sides[t][k] > sides[t][longest] ? k : longest;
            }
            // corners are on the circle through the longest side and one more corner
            const double *a = p[longest], *b = p[(longest + 1) % n];
            double radius = 0;
            for (int k = 0; k < n; ++k)
                if (distance_between(a, p[k]) > 1e-9 && distance_between(b, p[k]) > 1e-9) {
                    double next = circumradius(a, b, p[k]);
                    assert_near(next, radius > 0 ? radius : next, 1e-9 * next);
                    radius = next;
                }
            assert_true(radius > 0);
        }
    // the hexagon is the regular one, its corners in order
    instance made = make_named("cyclic_polygon", 6);
    double x[6][3], p[6][3];
    for (int k = 0; k < 6; ++k)
        x[k][0] = 2 * cos(AX_PI * k / 3), x[k][1] = 2 * sin(AX_PI * k / 3), x[k][2] = 0;
    project_points(&made, (const double(*)[3])x, p);
    for (int k = 0; k < 6; ++k)
        for (int i = 0; i < 3; ++i)
            assert_near(p[k][i], 0.5 * x[k][i], 1e-14);
    // a side too long for the others: they line up along it
    made = make_named("cyclic_polygon", 3);
    set(&made, "sides", (const double[8]){5, 1, 2});
    project_points(&made, (const double(*)[3])x, p);
    assert_near(distance_between(p[1], p[2]), 1, 1e-14), assert_near(distance_between(p[2], p[0]), 2, 1e-14);
    assert_near(distance_between(p[0], p[1]), 3, 1e-14);
}

static void differences_vanish_on_even_lines(void** state)
{
    (void)state;
    instance fairness = make_named("fairness", 3), laplacian = make_named("laplacian", 5);
    ax_lane3 x[5] = {{{0}}}, y[1], p[1];
    for (int k = 0; k < 3; ++k)
        for (int l = 0; l < AX_W; ++l)
            x[k][0][l] = 1 + k * l, x[k][2][l] = k == 1;
    gather(&fairness, x, y);
    project(&fairness, y, p);
    for (int l = 0; l < AX_W; ++l) {
        assert_near(y[0][0][l], 0, 1e-14), assert_near(y[0][2][l], -2, 0);
        assert_near(p[0][2][l], 0, 0);
    }
    for (int k = 0; k < 5; ++k)
        for (int l = 0; l < AX_W; ++l)
            x[k][0][l] = k == 0 ? 3 : k * k, x[k][2][l] = 0;
    gather(&laplacian, x, y); // 3 - (1 + 4 + 9 + 16) / 4
    assert_near(y[0][0][3], -4.5, 1e-15);
}

static void mirrored_points_meet_halfway(void** state)
{
    (void)state;
    // plane x = 1
    instance made = make_named("mirror", 2);
    set(&made, "point", (const double[3]){1, 5, 5}), set(&made, "normal", (const double[3]){-2, 0, 0});
    double p[2][3];
    project_points(&made, (const double[2][3]){{3, 1, 0}, {0, 2, 4}}, p); // images: (-1, 1, 0) and (2, 2, 4)
    assert_near(p[0][0], 2.5, 1e-15), assert_near(p[0][1], 1.5, 1e-15), assert_near(p[0][2], 2, 1e-15);
    assert_near(p[1][0], -0.5, 1e-15), assert_near(p[1][1], 1.5, 1e-15), assert_near(p[1][2], 2, 1e-15);
    instance plane = make_named("plane_given", 1);
    set(&plane, "point", (const double[3]){1, 5, 5}), set(&plane, "normal", (const double[3]){-2, 0, 0});
    project_points(&plane, (const double[1][3]){{3, 1, 0}}, p);
    assert_near(p[0][0], 1, 1e-15), assert_near(p[0][1], 1, 1e-15), assert_near(p[0][2], 0, 1e-15);
}

static void symmetric_points_follow_each_other_round_the_axis(void** state)
{
    (void)state;
    for (int n = 2; n <= 12; ++n) {
        instance made = make_named("rotation_symmetry", n);
        set(&made, "point", (const double[3]){1, 2, 3});
        double x[12][3], p[12][3];
        for (int k = 0; k < n; ++k) { // about +z through (1, 2), with a step in height
            double t = 0.3 + 2 * AX_PI * k / n;
            x[k][0] = 1 + 2 * cos(t), x[k][1] = 2 + 2 * sin(t), x[k][2] = k == 0 ? n : 0;
        }
        project_points(&made, (const double(*)[3])x, p);
        for (int k = 0; k < n; ++k) {
            assert_near(p[k][0], x[k][0], 1e-14), assert_near(p[k][1], x[k][1], 1e-14), assert_near(p[k][2], 1, 1e-14);
        }
    }
}

static double angle_between(const double a[3], const double b[3])
{
    return atan2(ax_cross2(a, b), a[0] * b[0] + a[1] * b[1]);
}

static void arms_of_an_overlapping_mouth_turn_apart(void** state)
{
    (void)state;
    const double degree = AX_PI / 180;
    instance made = make_named("mouth_angle", 3);
    set1(&made, "lo", 3 * degree);
    double x[3][3] = {{7, 8, 0}}, p[2][3];
    // equal arms at -10 degrees: 6.5 degrees each
    for (int k = 1; k < 3; ++k) {
        double t = (k == 1 ? 30 : 20) * degree;
        x[k][0] = x[0][0] + 2 * cos(t), x[k][1] = x[0][1] + 2 * sin(t);
    }
    project_points(&made, (const double(*)[3])x, p);
    assert_near(atan2(p[0][1], p[0][0]), 23.5 * degree, 1e-14),
        assert_near(atan2(p[1][1], p[1][0]), 26.5 * degree, 1e-14);
    assert_near(ax_norm3(p[0]), 2, 1e-14), assert_near(ax_norm3(p[1]), 2, 1e-14);
    // open too far
    for (int k = 1; k < 3; ++k) {
        double t = (k == 1 ? 0 : 130) * degree;
        x[k][0] = x[0][0] + 2 * cos(t), x[k][1] = x[0][1] + 2 * sin(t);
    }
    project_points(&made, (const double(*)[3])x, p);
    assert_near(atan2(p[0][1], p[0][0]), 5 * degree, 1e-14), assert_near(atan2(p[1][1], p[1][0]), 125 * degree, 1e-14);
}

static void arms_opposite_to_their_only_angle_turn_there(void** state)
{
    (void)state;
    // both senses are as near: one of them, not none, and not an arm of no length
    instance made = make_named("mouth_angle", 3);
    set1(&made, "hi", 0);
    double p[2][3];
    project_points(&made, (const double[3][3]){{0, 0, 0}, {2, 0, 0}, {-2, 0, 0}}, p);
    assert_near(ax_norm3(p[0]), 2, 1e-15), assert_near(ax_norm3(p[1]), 2, 1e-15);
    assert_near(ax_distance3(p[0], p[1]), 0, 1e-15);
}

// Unequal arms, all bounds: in range, lengths kept, and no other way of turning them there is nearer.
static void arms_turn_by_the_least_that_is_needed(void** state)
{
    (void)state;
    ax_random random = {7};
    for (int round = 0; round < 500; ++round) {
        instance made = make_named("mouth_angle", 3);
        double lo = ax_random_uniform(&random, -AX_PI, AX_PI),
               hi = ax_random_uniform(&random, lo, fmin(2 * AX_PI, lo + 7));
        set1(&made, "lo", lo), set1(&made, "hi", hi);
        double x[3][3] = {{0}}, p[2][3];
        for (int k = 1; k < 3; ++k)
            x[k][0] = ax_random_uniform(&random, -1, 1), x[k][1] = ax_random_uniform(&random, -1, 1);
        project_points(&made, (const double(*)[3])x, p);
        double angle = angle_between(p[0], p[1]), ours = 0, least = INFINITY;
        while (angle < lo - 1e-9)
            angle += 2 * AX_PI;
        assert_at_most(angle, hi + 1e-9);
        for (int k = 0; k < 2; ++k) {
            assert_near(ax_norm3(p[k]), ax_norm3(x[k + 1]), 1e-14);
            ours += pow(ax_distance2(p[k], x[k + 1]), 2);
        }
        angle = angle_between(x[1], x[2]);
        while (angle < lo)
            angle += 2 * AX_PI;
        if (angle <= hi) {
            assert_near(ours, 0, 0);
            continue;
        }
        double a = ax_norm3(x[1]), b = ax_norm3(x[2]);
        for (int side = 0; side < 2; ++side) { // shares of the violation, on a grid
            double violation = side ? angle - hi : lo + 2 * AX_PI - angle;
            for (int k = 0; k <= 100; ++k) {
                double s = violation * k / 100, t = violation - s;
                least = fmin(least, a * a * (2 - 2 * cos(s)) + b * b * (2 - 2 * cos(t)));
            }
        }
        assert_at_most(ours, least + 1e-12);
    }
}

static double area_of(const double (*p)[3])
{
    double a[3], b[3], n[3];
    ax_sub3(p[1], p[0], a), ax_sub3(p[2], p[0], b), ax_cross(a, b, n);
    return 0.5 * ax_norm3(n);
}

static void triangles_get_their_area(void** state)
{
    (void)state;
    ax_random random = {8};
    for (int round = 0; round < 2000; ++round) {
        instance made = make_named("triangle_area", 3);
        double x[3][3], p[3][3], area = pow(10, ax_random_uniform(&random, -6, 6));
        for (int k = 0; k < 9; ++k)
            x[k / 3][k % 3] = ax_random_uniform(&random, -1, 1);
        if (round % 3 == 0) // equilateral but for rounding, or a little more
            for (int k = 0; k < 3; ++k)
                for (int i = 0; i < 3; ++i)
                    x[k][i] = (k == i) + pow(10, -18 + round % 18) * x[k][i];
        set1(&made, "area", area);
        project_points(&made, (const double(*)[3])x, p);
        assert_near(area_of((const double(*)[3])p), area, 1e-13 * fmax(area, 1));
    }
    // an equilateral triangle of area 1 grows alike; below a quarter it is nearer to flatten than to shrink
    const double side = 2 / pow(3, 0.25), x[3][3] = {{0, 0, 0}, {side, 0, 0}, {side / 2, 1 / (side / 2), 0}};
    double p[3][3];
    instance made = make_named("triangle_area", 3);
    set1(&made, "area", 2.25);
    project_points(&made, x, p);
    for (int k = 0; k < 3; ++k)
        assert_near(distance_between(p[k], p[(k + 1) % 3]), 1.5 * side, 1e-14);
    set1(&made, "area", 0.3);
    project_points(&made, x, p);
    for (int k = 0; k < 3; ++k)
        assert_near(distance_between(p[k], p[(k + 1) % 3]), sqrt(0.3) * side, 1e-14);
    set1(&made, "area", 0.1);
    project_points(&made, x, p);
    double moved = 0, sum = 0, part = 0.5, rest = sqrt(0.25 - 0.1); // moduli of alpha and beta in units of alpha before
    for (int k = 0; k < 3; ++k)
        sum += pow(distance_between(p[k], p[(k + 1) % 3]), 2) / 3, moved += ax_dot3(p[k], p[k]);
    assert_near(sum, (part * part + rest * rest) * side * side, 1e-13);
    set1(&made, "lo", 0); // a range: in it nothing moves
    set1(&made, "area", 1.1);
    project_points(&made, x, p);
    for (int k = 0; k < 3; ++k)
        assert_near(distance_between(p[k], p[(k + 1) % 3]), side, 1e-14);
}

// --- axes ---

static void axes_are_perpendicular_and_sorted(void** state)
{
    (void)state;
    ax_random random = {9};
    // extents along the axes: general, planar, linear, equal in pairs, all equal, a point
    const double extent[9][3] = {{3, 2, 1}, {2, 1, 0}, {1, 0, 0},       {1, 1, 0},           {1, 1, 0.5},
                                 {2, 1, 1}, {1, 1, 1}, {1, 1e-8, 1e-9}, {1, 1 - 1e-12, 1e-7}};
    for (int round = 0; round < 200; ++round) {
        ax_lane3 y[6], axis[3];
        double x[AX_W][6][3];
        for (int l = 0; l < AX_W; ++l) { // six points at +- the extents, turned
            motion m = draw_motion(AX_SYMMETRY_ROTATION, false, &random);
            for (int k = 0; k < 6; ++k)
                for (int i = 0; i < 3; ++i)
                    y[k][i][l] = x[l][k][i] = (k % 2 ? 1 : -1) * extent[(round + l) % 9][k / 2] * m.r[i][k / 2];
        }
        ax_principal_axes(6, (const ax_lane3*)y, axis);
        for (int l = 0; l < AX_W; ++l) {
            double value[3], vector[3][3];
            principal_frame(6, (const double(*)[3])x[l], value, vector);
            for (int i = 0; i < 3; ++i) {
                double a[3] = {axis[i][0][l], axis[i][1][l], axis[i][2][l]}, sum = 0;
                int j = (i + 1) % 3;
                assert_near(ax_norm3(a), 1, 1e-15);
                assert_near(a[0] * axis[j][0][l] + a[1] * axis[j][1][l] + a[2] * axis[j][2][l], 0, 1e-15);
                for (int k = 0; k < 6; ++k)
                    sum += pow(ax_dot3(a, x[l][k]), 2);
                // the coordinate along an axis is right to rounding of the largest, not only its square
                assert_near(sqrt(sum), sqrt(fmax(value[i], 0)), i == 0 ? 1e-14 : 3e-8);
                double expected = sqrt(2) * extent[(round + l) % 9][i];
                assert_near(sqrt(sum), expected, 2e-15);
            }
        }
    }
}

static void frames_are_orthonormal_to_rounding(void** state)
{
    (void)state;
    ax_random random = {10};
    for (int round = 0; round < 4000; ++round) {
        double a[3], b[3], u[3], v[3], r[3], tilt = pow(10, -(round % 20));
        for (int i = 0; i < 3; ++i)
            a[i] = ax_random_uniform(&random, -1, 1), b[i] = ax_random_uniform(&random, -1, 1);
        for (int i = 0; i < 3 && round % 2; ++i) // nearly parallel, exactly so from 1e-17 on
            b[i] = 3 * a[i] + tilt * b[i];
        if (round % 50 == 0)
            a[0] = a[1] = a[2] = 0;
        if (round % 70 == 0)
            b[0] = b[1] = b[2] = 0;
        ax_frame(a, b, u, v, r);
        assert_near(ax_norm3(u), 1, 1e-15), assert_near(ax_norm3(v), 1, 1e-15), assert_near(ax_dot3(u, v), 0, 1e-15);
        assert_true(r[0] >= 0 && r[2] >= 0);
        for (int i = 0; i < 3; ++i)
            assert_near(r[0] * u[i], a[i], 4e-16), assert_near(r[1] * u[i] + r[2] * v[i], b[i], 1e-14);
    }
}

// --- curves ---

// No point of the curve is nearer than the one found, among many; and its parameter is right.
static void check_curve(const ax_curve* curve, double end, double size, uint64_t seed)
{
    ax_random random = {seed};
    for (int round = 0; round < 100; ++round) {
        double x[3], p[3], q[3], scale = round % 3 ? size : round % 2 ? 0.01 * size : 10 * size;
        for (int i = 0; i < 3; ++i)
            x[i] = ax_random_uniform(&random, -scale, scale);
        double t = ax_curve_nearest(curve, x, p), ours = ax_distance3(x, p), least = INFINITY;
        ax_curve_point(curve, t, q);
        assert_at_most(ax_distance3(p, q), 1e-12 * size);
        assert_true(t >= 0 && t <= end);
        for (int k = 0; k <= 2000; ++k) {
            ax_curve_point(curve, end * k / 2000, q);
            least = fmin(least, ax_distance3(x, q));
        }
        assert_at_most(ours, least + 1e-13 * scale);
        assert_at_most(least - ours, 0.03 * size);
        ax_curve_nearest(curve, p, q); // and it is on the curve
        assert_at_most(ax_distance3(p, q), 1e-13 * size);
        // derivatives by differences, away from the ends of pieces
        double first[3], second[3], other[3], step = 1e-4 * end, before[3], after[3];
        t = end * (round + 0.31) / 100;
        if (floor(t - step) != floor(t + step) && end > 1)
            continue;
        ax_curve_derivatives(curve, t, first, second);
        ax_curve_point(curve, t - step, before), ax_curve_point(curve, t, other),
            ax_curve_point(curve, t + step, after);
        for (int i = 0; i < 3; ++i) {
            assert_near(first[i], (after[i] - before[i]) / (2 * step), 1e-4 * size);
            assert_near(second[i], (after[i] - 2 * other[i] + before[i]) / (step * step), 1e-3 * size);
        }
    }
}

static void nearest_points_on_ellipses_are_nearest(void** state)
{
    (void)state;
    const double centre_[3] = {0.2, -0.1, 0.3}, a[3] = {2, 1, 0};
    const double b[6][3] = {{-0.5, 1, 0}, {-1, 2, 0}, {0, 0, 5}, {0, 0, 1e-3}, {0, 0, 0}, {-1, 2, 1e-9}};
    for (int k = 0; k < 6; ++k) {
        ax_curve* curve = ax_curve_ellipse(centre_, a, b[k]);
        check_curve(curve, 1, 5, 11);
        ax_curve_free(curve);
    }
    // on the axes, the evolute and the centre of x^2 / 4 + y^2 = 1
    ax_curve* curve = ax_curve_ellipse((const double[3]){0}, (const double[3]){2, 0, 0}, (const double[3]){0, 1, 0});
    const double on[7][5] = {{0, 0, 0, 1, 0.25},    {1, 0, 4.0 / 3, sqrt(5) / 3, 0}, {1.5, 0, 2, 0, 0},
                             {3, 0, 2, 0, 0},       {-3, 1e-300, -2, 0, 0.5},        {0, -4, 0, -1, 0.75},
                             {0, 1e-20, 0, 1, 0.25}};
    for (int k = 0; k < 7; ++k) {
        double p[3], t = ax_curve_nearest(curve, (const double[3]){on[k][0], on[k][1], 7}, p);
        assert_near(p[0], on[k][2], 1e-15), assert_near(p[1], on[k][3], 1e-15), assert_near(p[2], 0, 0);
        if (k != 1)
            assert_near(t, on[k][4], 1e-15);
    }
    ax_curve_free(curve);
    curve = ax_curve_circle(centre_, a, 3);
    check_curve(curve, 1, 3, 12);
    double p[3], d[3];
    ax_curve_nearest(curve, centre_, p); // all are equally near
    ax_sub3(p, centre_, d);
    assert_near(ax_norm3(d), 3, 1e-15), assert_near(ax_dot3(d, a), 0, 1e-15);
    ax_curve_free(curve);
}

static void nearest_points_on_lines_and_polylines_are_nearest(void** state)
{
    (void)state;
    ax_curve* curve = ax_curve_line((const double[3]){1, 1, 0}, (const double[3]){0, 0, 2});
    double p[3];
    assert_near(ax_curve_nearest(curve, (const double[3]){5, 5, 5}, p), 5, 0);
    assert_near(p[0], 1, 0), assert_near(p[1], 1, 0), assert_near(p[2], 5, 0);
    ax_curve_free(curve);
    ax_random random = {13};
    for (int n = 1; n < 40; n += 1 + n / 2)
        for (int closed = 0; closed < 2; ++closed) {
            double x[40][3];
            for (int k = 0; k < n; ++k)
                for (int i = 0; i < 3; ++i)
                    x[k][i] = ax_random_uniform(&random, -1, 1);
            curve = ax_curve_polyline((const double(*)[3])x, n, closed);
            check_curve(curve, n == 1 ? 1 : n - !closed, 1, 14);
            for (int k = 0; k < n; ++k) {
                ax_curve_point(curve, k, p);
                assert_at_most(ax_distance3(p, x[k]), 0);
            }
            ax_curve_free(curve);
        }
}

static void nearest_points_on_splines_are_nearest(void** state)
{
    (void)state;
    ax_random random = {15};
    for (int n = 1; n < 40; n += 1 + n / 2)
        for (int closed = 0; closed < 2; ++closed) {
            double x[40][3], p[3];
            for (int k = 0; k < n; ++k)
                for (int i = 0; i < 3; ++i)
                    x[k][i] = i == 2 && n % 2 ? 0 : ax_random_uniform(&random, -1, 1);
            ax_curve* curve = ax_curve_spline((const double(*)[3])x, n, closed);
            check_curve(curve, n == 1 ? 1 : n - !closed, 1.5, 16);
            for (int k = 0; k < n; ++k) { // through its control points, in order
                double t = ax_curve_nearest(curve, x[k], p);
                assert_at_most(ax_distance3(p, x[k]), 0);
                assert_near(t, k, 1e-12);
            }
            ax_curve_free(curve);
        }
    // the centre of a round spline: many nearly equal minima
    double x[12][3], p[3];
    for (int k = 0; k < 12; ++k)
        x[k][0] = cos(AX_PI * k / 6), x[k][1] = sin(AX_PI * k / 6), x[k][2] = 0;
    ax_curve* curve = ax_curve_spline((const double(*)[3])x, 12, true);
    check_curve(curve, 12, 1, 17);
    ax_curve_nearest(curve, (const double[3]){0}, p);
    assert_near(ax_norm3(p), 1, 2e-3);
    ax_curve_free(curve);
}

static void splines_are_smooth_and_straight_where_their_points_are(void** state)
{
    (void)state;
    // uneven steps along a line stay on it in order; elsewhere the direction turns without a jump
    const double line[5][3] = {{0, 0, 0}, {0.1, 0.1, 0}, {1, 1, 0}, {1.2, 1.2, 0}, {3, 3, 0}};
    ax_curve* curve = ax_curve_spline(line, 5, false);
    double before = -1, p[3], q[3];
    for (int k = 0; k <= 400; ++k) {
        ax_curve_point(curve, 0.01 * k, p);
        assert_near(p[0], p[1], 1e-15);
        assert_true(p[0] > before);
        before = p[0];
    }
    ax_curve_free(curve);
    const double bent[5][3] = {{0, 0, 0}, {1, 0, 0}, {1, 0.1, 1}, {4, 1, 2}, {0, 3, 1}};
    curve = ax_curve_spline(bent, 5, true);
    for (int k = 0; k < 5; ++k) {
        double left[3], right[3], h = 1e-6;
        ax_curve_point(curve, k, p);
        ax_curve_point(curve, k + 5 - h, q), ax_sub3(p, q, left);
        ax_curve_point(curve, k + h, q), ax_sub3(q, p, right);
        assert_near(ax_dot3(left, right) / (ax_norm3(left) * ax_norm3(right)), 1, 1e-9);
    }
    ax_curve_free(curve);
}

static void rounded_corners_are_arcs(void** state)
{
    (void)state;
    const double square[5][3] = {{0, 0, 1}, {4, 0, 1}, {4, 4, 1}, {4, 4, 1}, {0, 4, 1}};
    for (int closed = 0; closed < 2; ++closed)
        for (int k = 0; k < 3; ++k) {
            double radius = (double[]){0.5, 2, 9}[k], fits = fmin(radius, 2), p[3]; // half a side has room for 2
            ax_curve* curve = ax_curve_rounded(square, 5, closed, radius);
            ax_curve_range range = ax_curve_extent(curve);
            assert_true(range.smooth);
            double corners = closed ? 4 : 2, sides = closed ? 16 : 12;
            assert_near(ax_curve_length(curve, range.to), sides - corners * fits * (2 - AX_PI / 2), 4e-3 * corners);
            for (int i = 0; i <= 200; ++i) { // about the centre of the corner at (4, 0)
                ax_curve_point(curve, range.to * i / 200, p);
                assert_near(p[2], 1, 1e-12);
                if (p[0] > 4 - fits && p[1] < fits)
                    assert_near(hypot(p[0] - 4 + fits, p[1] - fits), fits, 1e-5 * fits);
            }
            check_curve(curve, range.to, 6, 18);
            ax_curve_free(curve);
        }
    // nothing to round
    ax_curve* curve = ax_curve_rounded(square, 2, false, 1);
    assert_near(ax_curve_length(curve, 1), 4, 0);
    ax_curve_free(curve);
}

static void lengths_along_curves_and_back(void** state)
{
    (void)state;
    const double bent[5][3] = {{0, 0, 0}, {0.01, 0, 0}, {0.02, 0.01, 1}, {4, 1, 2}, {0, 3, 1}}, zero[3] = {0, 0, 0};
    const double a[3] = {5, 0, 0}, b[3] = {0, 1, 0};
    ax_curve* curves[] = {ax_curve_polyline(bent, 5, false),     ax_curve_polyline(bent, 5, true),
                          ax_curve_spline(bent, 5, false),       ax_curve_spline(bent, 5, true),
                          ax_curve_rounded(bent, 5, true, 0.01), ax_curve_circle(zero, b, 3),
                          ax_curve_ellipse(zero, a, b),          ax_curve_line(zero, a)};
    for (size_t c = 0; c < sizeof curves / sizeof *curves; ++c) {
        ax_curve_range range = ax_curve_extent(curves[c]);
        double end = isfinite(range.to) ? range.to : 7, whole = ax_curve_length(curves[c], end), walked = 0, p[3], q[3];
        enum { STEPS = 20000 };
        ax_curve_point(curves[c], 0, p);
        for (int k = 0; k < STEPS; ++k) {
            double t = end * k / STEPS;
            assert_near(ax_curve_at_length(curves[c], ax_curve_length(curves[c], t)), t, 1e-9 * end);
            ax_curve_point(curves[c], end * (k + 1) / STEPS, q);
            walked += ax_distance3(p, q);
            memcpy(p, q, sizeof p);
        }
        assert_near(whole, walked, 2e-3 * walked);
        if (range.closed)
            assert_near(ax_curve_at_length(curves[c], 0.3 * whole - whole), ax_curve_at_length(curves[c], 0.3 * whole),
                        1e-9 * end);
        ax_curve_free(curves[c]);
    }
}

static void coincident_control_points_count_once(void** state)
{
    (void)state;
    const double x[6][3] = {{0, 0, 0}, {0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {1, 1, 0}, {0, 0, 0}};
    for (int closed = 0; closed < 2; ++closed) {
        ax_curve* curve = ax_curve_spline(x, 6, closed);
        double p[3], t = ax_curve_nearest(curve, (const double[3]){1, 1, 0}, p);
        assert_near(t, 2, 1e-12), assert_near(p[1], 1, 1e-15);
        ax_curve_point(curve, 3, p); // the end, which is the start
        assert_at_most(ax_norm3(p), 0);
        ax_curve_free(curve);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(every_type_describes_itself),
        cmocka_unit_test(rows_are_points_or_differences),
        cmocka_unit_test(finite_rows_for_every_finite_input),
        cmocka_unit_test(what_is_admissible_stays),
        cmocka_unit_test(no_admissible_rows_are_nearer),
        cmocka_unit_test(declared_symmetries_hold_and_no_others),
        cmocka_unit_test(types_follow_motions_of_all_their_parameters),
        cmocka_unit_test(lanes_do_not_see_each_other),
        cmocka_unit_test(one_alone_is_one_of_eight),
        cmocka_unit_test(rest_shapes_fill_parameters_only),
        cmocka_unit_test(every_type_is_in_the_documentation),
        cmocka_unit_test(edges_are_clamped_to_their_range),
        cmocka_unit_test(panels_get_the_edges_of_their_template),
        cmocka_unit_test(panels_shrink_to_their_size_where_they_are),
        cmocka_unit_test(lengths_of_no_triangle_make_a_flat_one),
        cmocka_unit_test(flat_panels_are_never_turned_over),
        cmocka_unit_test(templates_are_learned_from_the_rest_shape),
        cmocka_unit_test(the_equilateral_part_of_a_triangle_is_kept),
        cmocka_unit_test(flat_and_deployed_edge_meet_at_their_mean_length),
        cmocka_unit_test(closeness_is_its_target),
        cmocka_unit_test(points_go_to_their_place),
        cmocka_unit_test(a_zigzag_hexagon_flattens_to_its_middle_plane),
        cmocka_unit_test(points_go_straight_to_the_line_of_least_squares),
        cmocka_unit_test(holes_go_to_the_published_circle),
        cmocka_unit_test(points_almost_on_a_line_get_no_circle),
        cmocka_unit_test(points_round_a_sphere_go_to_its_radius),
        cmocka_unit_test(open_holes_have_their_sides_and_one_circle),
        cmocka_unit_test(differences_vanish_on_even_lines),
        cmocka_unit_test(mirrored_points_meet_halfway),
        cmocka_unit_test(symmetric_points_follow_each_other_round_the_axis),
        cmocka_unit_test(arms_of_an_overlapping_mouth_turn_apart),
        cmocka_unit_test(arms_opposite_to_their_only_angle_turn_there),
        cmocka_unit_test(arms_turn_by_the_least_that_is_needed),
        cmocka_unit_test(triangles_get_their_area),
        cmocka_unit_test(axes_are_perpendicular_and_sorted),
        cmocka_unit_test(frames_are_orthonormal_to_rounding),
        cmocka_unit_test(nearest_points_on_ellipses_are_nearest),
        cmocka_unit_test(nearest_points_on_lines_and_polylines_are_nearest),
        cmocka_unit_test(nearest_points_on_splines_are_nearest),
        cmocka_unit_test(splines_are_smooth_and_straight_where_their_points_are),
        cmocka_unit_test(rounded_corners_are_arcs),
        cmocka_unit_test(lengths_along_curves_and_back),
        cmocka_unit_test(coincident_control_points_count_once),
    };
    return cmocka_run_group_tests(tests, make_curve, free_curve);
}
