// The projective solver under loads: equilibria with known answers, and what it says when there is none.
#include "deploy/model.h"
#include "linkage/lattice.h"
#include "solver/solver.h"

#include "base/random.h"
#include "support/test.h"

#include <stdlib.h>
#include <string.h>

static const ax_constraint_type* type(const char* name)
{
    const ax_constraint_type* found = ax_constraint_find(name);
    assert_non_null(found);
    return found;
}

static int lane(const char* of, const char* parameter)
{
    return ax_parameter_find(type(of), parameter)->offset;
}

static int value(const char* of, const char* parameter)
{
    const ax_load_type* load = ax_load_find(of);
    for (int k = 0; k < load->parameter_count; ++k)
        if (strcmp(load->parameters[k].name, parameter) == 0)
            return load->parameters[k].offset;
    fail_msg("%s has no %s", of, parameter);
    return -1;
}

// A kagome patch over the unit disk, fully open, panels of edge spacing / 2.
static ax_lattice make_patch(double spacing)
{
    enum { CORNERS = 60 };
    double circle[CORNERS][2];
    for (int k = 0; k < CORNERS; ++k)
        circle[k][0] = cos(2 * AX_PI * k / CORNERS), circle[k][1] = sin(2 * AX_PI * k / CORNERS);
    ax_lattice lattice;
    assert_int_equal(ax_lattice_lay(&(ax_outline){CORNERS, (const double(*)[2])circle}, spacing, 0.1,
                                    (const double[2]){0.02, 0.01}, false, &lattice, NULL),
                     AX_OK);
    return lattice;
}

// Panels, holes and openings of a linkage in CSR.
typedef struct loops {
    int panels, count;
    int *start, *points;
} loops;

static loops collect(const ax_linkage* linkage)
{
    loops all = {.panels = linkage->triangle_count};
    int holes = linkage->hole_count, openings = linkage->opening_count;
    all.start = AX_NEW0(int, all.panels + holes + openings + 1);
    all.points = AX_NEW(int, 3 * all.panels + linkage->hole_start[holes] + linkage->opening_start[openings]);
    memcpy(all.points, linkage->triangles, 3 * (size_t)all.panels * sizeof *all.points);
    for (; all.count < all.panels; ++all.count)
        all.start[all.count + 1] = 3 * (all.count + 1);
    const int *starts[2] = {linkage->hole_start, linkage->opening_start},
              *hinges[2] = {linkage->hole_hinges, linkage->opening_hinges}, counts[2] = {holes, openings};
    for (int kind = 0; kind < 2; ++kind)
        for (int k = 0; k < counts[kind]; ++k) {
            int size = starts[kind][k + 1] - starts[kind][k], at = all.start[all.count++];
            memcpy(all.points + at, hinges[kind] + starts[kind][k], (size_t)size * sizeof *all.points);
            all.start[all.count] = at + size;
        }
    return all;
}

static void free_loops(loops* all)
{
    ax_free(all->start);
    ax_free(all->points);
}

static int* list_rim(const ax_linkage* linkage, int* count)
{
    int* rim = AX_NEW(int, linkage->hinge_count);
    *count = 0;
    for (int h = 0; h < linkage->hinge_count; ++h)
        if (linkage->on_rim[h])
            rim[(*count)++] = h;
    return rim;
}

// Both loads against the model of the exact stage, an implementation of its own, at places far from any equilibrium.
static void loads_are_those_of_the_exact_stage(void** state)
{
    (void)state;
    ax_lattice lattice = make_patch(0.3);
    const ax_linkage* linkage = &lattice.linkage;
    int n = linkage->hinge_count;
    loops all = collect(linkage);
    double(*x)[3] = ax_alloc((size_t)n, sizeof *x), (*gradient)[3] = ax_alloc((size_t)n, sizeof *x);
    double(*force)[3] = ax_alloc((size_t)n, sizeof *x);
    ax_random random = {5};
    for (int h = 0; h < n; ++h)
        for (int c = 0; c < 3; ++c)
            x[h][c] = (c < 2 ? lattice.hinges[h][c] : 0) + ax_random_uniform(&random, -0.2, 0.2);
    const double down[3] = {0.6, 0, -0.8};
    ax_hold* holds = ax_calloc((size_t)n, sizeof *holds);
    for (int h = 0; h < n; ++h)
        holds[h].kind = linkage->on_rim[h] ? AX_HOLD_FIXED : AX_HOLD_FREE;
    for (int inflated = 0; inflated < 2; ++inflated) {
        double unit;
        ax_deploy_model model = ax_deploy_model_make(linkage, (const double(*)[2])lattice.hinges, (const double(*)[3])x,
                                                     holds, inflated ? NULL : down, &unit);
        double energy = ax_deploy_energy(&model, (const double(*)[3])x, gradient);
        ax_solver* s = ax_solver_make(n, (const double(*)[3])x, NULL);
        int* points = AX_NEW(int, n);
        for (int h = 0; h < n; ++h)
            points[h] = h;
        ax_solver_add(s, type("closeness"), 1, n, points, 1, NULL); // at rest: no force
        int load;
        if (inflated) {
            load = ax_solver_add_load(s, ax_load_find("pressure"), all.count, all.start, all.points);
            ax_solver_set_load_value(s, load, value("pressure", "pressure"), model.pressure);
            for (int c = 0; c < 3; ++c)
                ax_solver_set_load_value(s, load, value("pressure", "origin") + c, 0);
        } else {
            load = ax_solver_add_load(s, ax_load_find("gravity"), all.panels, all.start, all.points);
            double area = 0, (*rest)[3] = ax_calloc((size_t)n, sizeof *rest);
            for (int h = 0; h < n; ++h)
                memcpy(rest[h], lattice.hinges[h], sizeof *lattice.hinges);
            for (int t = 0; t < all.panels; ++t) {
                const int* c = linkage->triangles[t];
                area += ax_orient2(lattice.hinges[c[0]], lattice.hinges[c[1]], lattice.hinges[c[2]]) / 2;
            }
            ax_solver_measure_load(s, load, (const double(*)[3])rest);
            ax_solver_set_load_value(s, load, value("gravity", "density"), 1 / (2 * area));
            ax_solver_set_load_value(s, load, value("gravity", "acceleration"), 2);
            for (int c = 0; c < 3; ++c)
                ax_solver_set_load_value(s, load, value("gravity", "direction") + c, 7 * down[c]);
            ax_free(rest);
        }
        ax_solver_get_forces(s, force);
        for (int h = 0; h < n; ++h)
            for (int c = 0; c < 3; ++c)
                assert_near(force[h][c], -gradient[h][c], 1e-14);
        assert_near(ax_solver_energy(s), 2 * energy, 1e-13);
        ax_solver_free(s);
        ax_free(points);
        ax_deploy_model_free(&model);
    }
    free_loops(&all);
    ax_free(holds);
    ax_free(x);
    ax_free(gradient);
    ax_free(force);
    ax_lattice_free(&lattice);
}

// A chain of equal links between two held points under equal weights. Statics alone: the horizontal force H is the same everywhere,
// the vertical one falls by a weight at every hinge, so link k points along (H, (links - 1) / 2 - k); H makes the span right.
static void a_hanging_chain_is_the_discrete_catenary(void** state)
{
    (void)state;
    enum { LINKS = 16 };
    const double span = 12;
    double lo = 0, hi = 1e3;
    for (int step = 0; step < 200; ++step) {
        double h = (lo + hi) / 2, sum = 0;
        for (int k = 0; k < LINKS; ++k)
            sum += h / sqrt(h * h + (k - (LINKS - 1) / 2.0) * (k - (LINKS - 1) / 2.0));
        *(sum < span ? &lo : &hi) = h;
    }
    double place[LINKS + 1][3], force[LINKS + 1][3] = {{0}}, x[LINKS + 1][3];
    int link[LINKS][2], held[2] = {0, LINKS};
    for (int k = 0; k <= LINKS; ++k) {
        place[k][0] = span * k / LINKS, place[k][1] = place[k][2] = 0;
        force[k][2] = -0.01;
        if (k < LINKS)
            link[k][0] = k, link[k][1] = k + 1;
    }
    ax_solver* s = ax_solver_make(LINKS + 1, (const double(*)[3])place, NULL);
    int edges = ax_solver_add(s, type("edge_length"), 2, LINKS, link[0], 1, NULL);
    ax_solver_add(s, type("fixed"), 1, 2, held, 0, NULL);
    for (int k = 0; k < LINKS; ++k)
        ax_solver_set(s, edges, k, lane("edge_length", "length"), 1);
    ax_solver_set_load(s, (const double(*)[3])force);
    ax_solver_use_multipliers(s, true);
    ax_settle settle = AX_SETTLE_STANDARD;
    settle.force = settle.primal = 1e-11, settle.iterations = 100000;
    ax_settled result = ax_solver_settle(s, &settle, NULL);
    assert_int_equal(result.end, AX_SETTLE_DONE);
    ax_solver_get_places(s, x);
    assert_int_equal(ax_solver_multiplier_count(s), 3 * (LINKS + 2));
    double at[2] = {0, 0}, u[LINKS + 2][3]; // the supports have rows too, without forces
    ax_solver_get_multipliers(s, u[0]);
    for (int k = 0; k < LINKS; ++k) {
        double v = k - (LINKS - 1) / 2.0, size = sqrt(lo * lo + v * v);
        assert_near(x[k][0], at[0], 1e-8);
        assert_near(x[k][2], at[1], 1e-8);
        at[0] += lo / size, at[1] += v / size;
        assert_near(ax_norm3(u[k]), 0.01 * size, 1e-9); // w u is the force in the link
    }
    ax_solver_free(s);
}

// Edges as springs of stiffness w, rest length 1, pressure p: from the volume 5 (3 + sqrt 5) / 12 l^3 of the icosahedron,
// d/dl (30 w (l - 1)^2 / 2 - p V) = 0 gives 30 w (l - 1) = p 5 (3 + sqrt 5) / 4 l^2.
static void a_balloon_of_springs_grows_as_its_volume_says(void** state)
{
    (void)state;
    const double g = (1 + sqrt(5)) / 2, w = 3, p = 1;
    double place[12][3];
    for (int k = 0; k < 12; ++k) { // cyclic permutations of (0, +-1, +-g) / 2: edges of 1
        int axis = k / 4;
        place[k][axis] = 0.3; // off centre: the answer must not depend on where it is
        place[k][(axis + 1) % 3] = (k % 2 ? 0.5 : -0.5) + 0.3;
        place[k][(axis + 2) % 3] = (k / 2 % 2 ? g / 2 : -g / 2) + 0.3;
    }
    int edge[30][2], face[20][3], start[21], edges = 0, faces = 0;
    for (int i = 0; i < 12; ++i)
        for (int j = i + 1; j < 12; ++j) {
            if (ax_distance3(place[i], place[j]) > 1.01)
                continue;
            edge[edges][0] = i, edge[edges++][1] = j;
            for (int k = j + 1; k < 12; ++k)
                if (ax_distance3(place[i], place[k]) < 1.01 && ax_distance3(place[j], place[k]) < 1.01) {
                    double a[3], b[3], normal[3], out[3];
                    ax_sub3(place[j], place[i], a), ax_sub3(place[k], place[i], b);
                    ax_cross(a, b, normal);
                    ax_sub3(place[i], (const double[3]){0.3, 0.3, 0.3}, out);
                    bool outward = ax_dot3(normal, out) > 0;
                    face[faces][0] = i, face[faces][1] = outward ? j : k, face[faces++][2] = outward ? k : j;
                }
        }
    assert_int_equal(edges, 30);
    assert_int_equal(faces, 20);
    for (int k = 0; k <= 20; ++k)
        start[k] = 3 * k;
    ax_solver* s = ax_solver_make(12, (const double(*)[3])place, NULL);
    ax_solver_add(s, type("edge_length"), 2, 30, edge[0], w, NULL);
    ax_solver_add(s, type("fixed"), 1, 1, (int[]){0}, 0, NULL);
    int load = ax_solver_add_load(s, ax_load_find("pressure"), 20, start, face[0]);
    ax_solver_set_load_value(s, load, value("pressure", "pressure"), p);
    ax_settle settle = AX_SETTLE_STANDARD;
    settle.force = 1e-12;
    assert_int_equal(ax_solver_settle(s, &settle, NULL).end, AX_SETTLE_DONE);
    double a = p * 5 * (3 + sqrt(5)) / 4 / (30 * w), l = (1 - sqrt(1 - 4 * a)) / (2 * a), x[12][3];
    ax_solver_get_places(s, x);
    for (int e = 0; e < 30; ++e)
        assert_near(ax_distance3(x[edge[e][0]], x[edge[e][1]]), l, 1e-10);
    assert_near(x[0][0], place[0][0], 0); // held exactly
    ax_solver_free(s);
}

// A patch of rigid panels, rim held in a circle 3 % smaller than it would fill.
typedef struct sheet {
    ax_lattice lattice;
    loops all;
    int rim_count, *rim, panels, load;
    double (*place)[3];
    ax_solver* solver;
} sheet;

static sheet make_sheet(double spacing, bool inflated, ax_pool* pool)
{
    sheet k = {.lattice = make_patch(spacing)};
    const ax_linkage* linkage = &k.lattice.linkage;
    int n = linkage->hinge_count;
    k.all = collect(linkage);
    k.rim = list_rim(linkage, &k.rim_count);
    k.place = ax_calloc((size_t)n, sizeof *k.place);
    for (int h = 0; h < n; ++h)
        memcpy(k.place[h], k.lattice.hinges[h], sizeof *k.lattice.hinges);
    k.solver = ax_solver_make(n, (const double(*)[3])k.place, pool);
    k.panels = ax_solver_add(k.solver, type("rigid_triangle"), 3, k.all.panels, linkage->triangles[0], 1, NULL);
    int supports = ax_solver_add(k.solver, type("fixed"), 1, k.rim_count, k.rim, 0, NULL);
    k.load = ax_solver_add_load(k.solver, ax_load_find(inflated ? "pressure" : "gravity"),
                                inflated ? k.all.count : k.all.panels, k.all.start, k.all.points);
    for (int r = 0; r < k.rim_count; ++r)
        for (int c = 0; c < 2; ++c)
            ax_solver_set(k.solver, supports, r, lane("fixed", "target") + c, 0.97 * k.place[k.rim[r]][c]);
    ax_random random = {11};
    for (int h = 0; h < n; ++h)
        k.place[h][2] = ax_random_uniform(&random, 0, 0.01);
    ax_solver_set_places(k.solver, (const double(*)[3])k.place);
    return k;
}

static void free_sheet(sheet* k)
{
    ax_lattice_free(&k->lattice);
    free_loops(&k->all);
    ax_free(k->rim);
    ax_free(k->place);
    ax_solver_free(k->solver);
}

// Whatever the shape, the inside and its supports balance: supports carry the weight; under pressure p times the vector area of the
// surface, less what the membrane that closes it to the origin brings to the rim, two thirds of the same with the other sign.
static void supports_carry_the_whole_load(void** state)
{
    (void)state;
    for (int inflated = 0; inflated < 2; ++inflated) {
        sheet k = make_sheet(0.3, inflated, NULL);
        ax_solver* s = k.solver;
        int n = k.lattice.linkage.hinge_count;
        ax_solver_use_multipliers(s, true);
        double factor = 0.1 / ax_solver_load_ratio(s, k.panels);
        ax_solver_scale_loads(s, factor);
        assert_near(factor * ax_solver_load_ratio(s, k.panels), 0.1, 1e-12);
        ax_settle settle = AX_SETTLE_STANDARD;
        settle.iterations = 30000, settle.patience = 5000;
        ax_settled result = ax_solver_settle(s, &settle, NULL);
        assert_int_equal(result.end, AX_SETTLE_DONE);
        double(*force)[3] = ax_alloc((size_t)n, sizeof *force), reaction[3] = {0}, load[3] = {0}, size = 0;
        ax_solver_get_forces(s, force);
        ax_solver_get_places(s, k.place);
        for (int r = 0; r < k.rim_count; ++r)
            for (int c = 0; c < 3; ++c)
                reaction[c] -= force[k.rim[r]][c];
        // all loads together, from the shape alone: vector area of all loops, or the weight
        for (int p = 0; p < (inflated ? k.all.count : k.all.panels); ++p) {
            const int *loop = k.all.points + k.all.start[p], count = k.all.start[p + 1] - k.all.start[p];
            for (int i = 0; i < count; ++i) {
                double part[3];
                ax_cross(k.place[loop[i]], k.place[loop[(i + 1) % count]], part);
                for (int c = 0; c < 3; ++c)
                    load[c] += part[c] / 2 / 3;
            }
        }
        double edge = k.lattice.spacing / 2, area = k.all.panels * sqrt(3) / 4 * edge * edge;
        if (!inflated)
            load[0] = load[1] = 0, load[2] = 9.80665 * area;
        size = ax_norm3(load);
        assert_true(size > 0.1);
        for (int c = 0; c < 3; ++c)
            assert_near(reaction[c], -factor * load[c], 1e-5 * factor * size);
        ax_free(force);
        free_sheet(&k);
    }
}

// Two panels on a common edge, which is held, the other two corners free under gravity: each hangs straight down from the hinge.
static void a_single_hinge_hangs_down(void** state)
{
    (void)state;
    const double h = sqrt(3) / 2;
    double place[4][3] = {{0, 0, 0}, {1, 0, 0}, {0.5, h, 0}, {0.5, -h * cos(0.4), h * sin(0.4)}}, x[4][3];
    const int panel[2][3] = {{0, 1, 2}, {1, 0, 3}}, start[3] = {0, 3, 6};
    ax_solver* s = ax_solver_make(4, (const double(*)[3])place, NULL);
    int panels = ax_solver_add(s, type("rigid_triangle"), 3, 2, panel[0], 1, NULL);
    ax_solver_add(s, type("fixed"), 1, 2, (int[]){0, 1}, 0, NULL);
    int load = ax_solver_add_load(s, ax_load_find("gravity"), 2, start, panel[0]);
    ax_solver_set_load_value(s, load, value("gravity", "direction") + 2, -1);
    ax_solver_use_multipliers(s, true);
    ax_solver_scale_loads(s, 0.1 / ax_solver_load_ratio(s, panels));
    ax_settle settle = AX_SETTLE_STANDARD;
    settle.force = settle.primal = 1e-11;
    assert_int_equal(ax_solver_settle(s, &settle, NULL).end, AX_SETTLE_DONE);
    ax_solver_get_places(s, x);
    for (int k = 2; k < 4; ++k)
        assert_near(x[k][0], 0.5, 1e-9), assert_near(x[k][1], 0, 1e-9), assert_near(x[k][2], -h, 1e-9);
    ax_solver_free(s);
}

// Energy in plain iterations, and in accelerated ones, under each load that has a potential.
static void energy_never_rises_under_loads(void** state)
{
    (void)state;
    for (int run = 0; run < 4; ++run) {
        bool inflated = run & 1;
        sheet k = make_sheet(0.25, inflated, NULL);
        ax_solver* s = k.solver;
        ax_solver_add(s, type("plane"), 6, 1, k.all.points + k.all.start[k.all.panels], 0.3, NULL);
        ax_solver_scale_loads(s, 0.1 / ax_solver_load_ratio(s, k.panels));
        ax_solver_accelerate(s, run & 2 ? 5 : 0);
        assert_true(ax_solver_iterate(s, 1)); // the rim goes to its targets
        double before = ax_solver_energy(s), first = before;
        for (int i = 0; i < 150; ++i) {
            assert_true(ax_solver_iterate(s, 1));
            double now = ax_solver_energy(s);
            assert_at_most(now, before + 1e-13 * fabs(first));
            before = now;
        }
        assert_true(before < first - 1e-3 * fabs(first)); // it did move
        free_sheet(&k);
    }
}

// Accelerated or not, to the same shape: the unstressed sheet of springs has one.
static void acceleration_shortens_the_way_to_the_same_place(void** state)
{
    (void)state;
    int iterations[2];
    double place[2][3] = {{0}};
    for (int fast = 0; fast < 2; ++fast) {
        sheet k = make_sheet(0.3, true, NULL);
        ax_solver_scale_loads(k.solver, 0.1 / ax_solver_load_ratio(k.solver, k.panels));
        ax_solver_accelerate(k.solver, fast ? 5 : 0);
        ax_settle settle = AX_SETTLE_STANDARD;
        settle.force = 1e-9, settle.iterations = 100000, settle.patience = 20000;
        ax_settled result = ax_solver_settle(k.solver, &settle, NULL);
        assert_int_equal(result.end, AX_SETTLE_DONE);
        iterations[fast] = result.iterations;
        ax_solver_get_places(k.solver, k.place);
        memcpy(place[fast], k.place[k.lattice.linkage.hinge_count / 2], sizeof *place);
        free_sheet(&k);
    }
    assert_true(3 * iterations[1] < 2 * iterations[0]);
    for (int c = 0; c < 3; ++c)
        assert_near(place[0][c], place[1][c], 1e-6);
}

static void threads_change_no_bit_of_loads_and_acceleration(void** state)
{
    (void)state;
    ax_pool* pools[3] = {NULL, ax_pool_make(2), ax_pool_make(3)};
    for (int hard = 0; hard < 2; ++hard) {
        double(*first)[3] = NULL;
        ax_settled reference = {0};
        for (int p = 0; p < 3; ++p) {
            sheet k = make_sheet(0.02, true, pools[p]);
            size_t bytes = (size_t)k.lattice.linkage.hinge_count * sizeof *k.place;
            ax_solver_use_multipliers(k.solver, hard);
            ax_solver_scale_loads(k.solver, 0.1 / ax_solver_load_ratio(k.solver, k.panels));
            ax_solver_accelerate(k.solver, 5);
            ax_settle settle = AX_SETTLE_STANDARD;
            settle.iterations = 25;
            ax_settled result = ax_solver_settle(k.solver, &settle, NULL);
            assert_int_equal(result.end, AX_SETTLE_LIMIT);
            ax_solver_get_places(k.solver, k.place);
            if (p == 0)
                first = ax_copy(k.place, (size_t)k.lattice.linkage.hinge_count, sizeof *k.place), reference = result;
            assert_memory_equal(first, k.place, bytes);
            assert_memory_equal(&reference, &result, sizeof result);
            free_sheet(&k);
        }
        ax_free(first);
    }
    ax_pool_free(pools[1]);
    ax_pool_free(pools[2]);
}

static void nothing_is_allocated_under_loads_and_acceleration(void** state)
{
    (void)state;
    sheet k = make_sheet(0.2, true, NULL);
    ax_solver* s = k.solver;
    int weight = ax_solver_add_load(s, ax_load_find("gravity"), k.all.panels, k.all.start, k.all.points);
    ax_solver_scale_loads(s, 0.1 / ax_solver_load_ratio(s, k.panels));
    ax_solver_use_multipliers(s, true);
    ax_solver_cap_multipliers(s, 0.2);
    ax_solver_accelerate(s, 5);
    ax_settle settle = AX_SETTLE_STANDARD;
    settle.iterations = 30;
    ax_solver_settle(s, &settle, NULL);
    size_t before = ax_allocation_count();
    ax_solver_settle(s, &settle, NULL);
    ax_solver_set_load_value(s, k.load, value("pressure", "pressure"), 0.5);
    ax_solver_set_load_value(s, weight, value("gravity", "density"), 0.01);
    ax_solver_measure_load(s, weight, NULL);
    ax_solver_scale_loads(s, 0.1 / ax_solver_load_ratio(s, k.panels));
    ax_solver_set(s, 1, 0, lane("fixed", "target"), ax_solver_get(s, 1, 0, lane("fixed", "target")) + 0.001);
    ax_solver_settle(s, &settle, NULL);
    ax_solver_iterate(s, 50);
    assert_true(isfinite(ax_solver_energy(s)));
    assert_int_equal(ax_allocation_count(), before);
    assert_int_equal(ax_solver_count(s).factorisations, 1); // and none of these changes asked for a new factor
    assert_int_equal(ax_solver_count(s).analyses, 1);
    free_sheet(&k);
}

// Loops of several sizes side by side, in any order, act as each of them alone.
static void loops_side_by_side_act_as_alone(void** state)
{
    (void)state;
    ax_lattice lattice = make_patch(0.3);
    loops all = collect(&lattice.linkage);
    int n = lattice.linkage.hinge_count, *points = AX_NEW(int, n);
    double(*x)[3] = ax_alloc((size_t)n, sizeof *x), (*sum)[3] = ax_calloc((size_t)n, sizeof *x);
    double(*force)[3] = ax_alloc((size_t)n, sizeof *x);
    ax_random random = {17};
    for (int h = 0; h < n; ++h)
        for (int c = 0; c < 3; ++c)
            points[h] = h, x[h][c] = ax_random_uniform(&random, -1, 1);
    for (int t = 0; t <= all.count; ++t) { // one loop at a time, then all
        ax_solver* s = ax_solver_make(n, (const double(*)[3])x, NULL);
        ax_solver_add(s, type("closeness"), 1, n, points, 1, NULL);
        int count = t < all.count ? 1 : all.count, first = t < all.count ? t : 0;
        int load = ax_solver_add_load(s, ax_load_find("pressure"), count, all.start + first, all.points);
        for (int c = 0; c < 3; ++c)
            ax_solver_set_load_value(s, load, value("pressure", "origin") + c, 0.5);
        ax_solver_get_forces(s, force);
        for (int h = 0; h < n; ++h)
            for (int c = 0; c < 3; ++c)
                if (t < all.count)
                    sum[h][c] += force[h][c];
                else
                    assert_near(force[h][c], sum[h][c], 1e-15);
        ax_solver_free(s);
    }
    void* blocks[] = {points, x, sum, force};
    for (size_t b = 0; b < sizeof blocks / sizeof *blocks; ++b)
        ax_free(blocks[b]);
    free_loops(&all);
    ax_lattice_free(&lattice);
}

// ---- the plane: uniform kagome patches

typedef struct flat_patch {
    ax_lattice lattice;
    double (*from)[2], (*to)[2]; // the patch turned to expand by `lambda`, and after growing by `stretch`
    double (*place)[3];
    int rim_count, *rim, panels, holds;
    ax_solver* solver;
} flat_patch;

// Panels of a patch that can grow by `lambda` before it is fully open. Rim hinges are held on lines across x, where growing by
// `stretch` alone would take them; along those lines they are free, but for one that may not move.
static flat_patch make_flat(double spacing, double lambda, double stretch)
{
    flat_patch f = {.lattice = make_patch(spacing)};
    const ax_linkage* linkage = &f.lattice.linkage;
    int n = linkage->hinge_count;
    double* scale = AX_NEW(double, linkage->triangle_count);
    f.from = ax_alloc((size_t)n, sizeof *f.from), f.to = ax_alloc((size_t)n, sizeof *f.to);
    f.place = ax_calloc((size_t)n, sizeof *f.place);
    for (int after = 0; after < 2; ++after) { // the same panels, drawn at the spacing they have before or after
        for (int t = 0; t < linkage->triangle_count; ++t)
            scale[t] = after ? fmax(1, lambda / stretch) : lambda;
        ax_lattice_twist(&f.lattice, scale, after ? f.to : f.from);
        for (int h = 0; h < n; ++h)
            for (int c = 0; after && c < 2; ++c)
                f.to[h][c] *= stretch;
    }
    for (int h = 0; h < n; ++h)
        memcpy(f.place[h], f.from[h], sizeof *f.from);
    f.rim = list_rim(linkage, &f.rim_count);
    f.solver = ax_solver_make(n, (const double(*)[3])f.place, NULL);
    f.panels =
        ax_solver_add(f.solver, type("rigid_triangle"), 3, linkage->triangle_count, linkage->triangles[0], 1, NULL);
    f.holds = ax_solver_add(f.solver, type("plane_given"), 1, f.rim_count, f.rim, 1, NULL);
    for (int r = 0; r < f.rim_count; ++r) {
        ax_solver_set(f.solver, f.holds, r, lane("plane_given", "point"), f.to[f.rim[r]][0]);
        for (int c = 0; c < 3; ++c)
            ax_solver_set(f.solver, f.holds, r, lane("plane_given", "normal") + c, c == 0);
    }
    ax_solver_add(f.solver, type("plane_given"), 1, 1, f.rim, 1, NULL);
    ax_solver_set(f.solver, f.holds + 1, 0, lane("plane_given", "point") + 1, f.from[f.rim[0]][1]);
    for (int c = 0; c < 3; ++c)
        ax_solver_set(f.solver, f.holds + 1, 0, lane("plane_given", "normal") + c, c == 1);
    ax_solver_use_multipliers(f.solver, true);
    ax_free(scale);
    return f;
}

static void free_flat(flat_patch* f)
{
    ax_lattice_free(&f->lattice);
    void* blocks[] = {f->from, f->to, f->place, f->rim};
    for (size_t b = 0; b < sizeof blocks / sizeof *blocks; ++b)
        ax_free(blocks[b]);
    ax_solver_free(f->solver);
}

// The linear map that takes panel centres to where they are now, by least squares: the stretch of the patch.
static void mean_stretch(const flat_patch* f, double map[2][2])
{
    const ax_linkage* linkage = &f->lattice.linkage;
    double m[2][2] = {{0}}, r[2][2] = {{0}}, mean[2][2] = {{0}};
    for (int pass = 0; pass < 2; ++pass)
        for (int t = 0; t < linkage->triangle_count; ++t) {
            double from[2] = {0}, to[2] = {0};
            for (int k = 0; k < 3; ++k)
                for (int c = 0; c < 2; ++c) {
                    from[c] += f->from[linkage->triangles[t][k]][c] / 3 - (pass ? mean[0][c] : 0) / 3;
                    to[c] += f->place[linkage->triangles[t][k]][c] / 3 - (pass ? mean[1][c] : 0) / 3;
                }
            for (int a = 0; a < 2; ++a)
                if (!pass)
                    mean[0][a] += from[a] / linkage->triangle_count, mean[1][a] += to[a] / linkage->triangle_count;
                else
                    for (int b = 0; b < 2; ++b)
                        m[a][b] += from[a] * from[b], r[a][b] += to[a] * from[b];
        }
    double det = m[0][0] * m[1][1] - m[0][1] * m[1][0];
    for (int a = 0; a < 2; ++a) {
        map[a][0] = (r[a][0] * m[1][1] - r[a][1] * m[1][0]) / det;
        map[a][1] = (r[a][1] * m[0][0] - r[a][0] * m[0][1]) / det;
    }
}

// Pulled in x alone, it grows in y by as much.
static void a_uniform_patch_has_poisson_ratio_minus_one(void** state)
{
    (void)state;
    const double stretches[] = {1.02, 1.05, 1.1};
    for (int k = 0; k < 3; ++k) {
        flat_patch f = make_flat(0.25, 1.5, stretches[k]);
        ax_settle settle = AX_SETTLE_STANDARD;
        settle.force = settle.primal = 1e-10, settle.iterations = 100000, settle.patience = 20000;
        ax_solver_accelerate(f.solver, 5);
        ax_settled result = ax_solver_settle(f.solver, &settle, NULL);
        assert_int_equal(result.end, AX_SETTLE_DONE);
        ax_solver_get_places(f.solver, f.place);
        double map[2][2];
        mean_stretch(&f, map);
        assert_near(map[0][0], stretches[k], 1e-7);
        assert_near(-(map[1][1] - 1) / (map[0][0] - 1), -1, 1e-6);
        assert_near(map[0][1], 0, 1e-6);
        for (int h = 0; h < f.lattice.linkage.hinge_count; ++h)
            assert_near(f.place[h][2], 0, 0);
        free_flat(&f);
    }
}

// Pulled beyond lambda it yields no further: panels and rim cannot both have their way, and the solver says so.
static void a_uniform_patch_is_blocked_at_its_lambda(void** state)
{
    (void)state;
    const double lambda = 1.3;
    flat_patch f = make_flat(0.25, lambda, 1.02 * lambda);
    ax_settle settle = AX_SETTLE_STANDARD;
    settle.iterations = 20000, settle.patience = 2000;
    ax_solver_cap_multipliers(f.solver, 2 * lambda * f.lattice.spacing / 2);
    ax_settled result = ax_solver_settle(f.solver, &settle, NULL);
    assert_int_equal(result.end, AX_SETTLE_STAGNATED);
    assert_true(result.primal > 1e-3);
    assert_true(result.capped > 0);
    assert_true(result.multiplier_most > 1.5);

    // without multipliers both yield, and the forces balance
    ax_solver_use_multipliers(f.solver, false);
    settle.force = 1e-9, settle.patience = 20000;
    assert_int_equal(ax_solver_settle(f.solver, &settle, NULL).end, AX_SETTLE_DONE);
    assert_true(ax_solver_residual(f.solver, f.panels) > 1e-4);
    assert_true(ax_solver_residual(f.solver, f.holds) > 1e-4);
    free_flat(&f);

    // an even pull of any size, along the edges that end on the rim, opens it to lambda and not beyond
    for (int strong = 0; strong < 2; ++strong) {
        f = make_flat(0.25, lambda, 1);
        const ax_linkage* linkage = &f.lattice.linkage;
        const double(*open)[2] = (const double(*)[2])f.lattice.hinges;
        ax_solver* s = ax_solver_make(linkage->hinge_count, (const double(*)[3])f.place, NULL);
        ax_solver_add(s, type("rigid_triangle"), 3, linkage->triangle_count, linkage->triangles[0], 1, NULL);
        ax_solver_add(s, type("fixed"), 1, 1, f.rim, 0, NULL);
        ax_solver_use_multipliers(s, true);
        ax_solver_accelerate(s, 5);
        double(*force)[3] = ax_calloc((size_t)linkage->hinge_count, sizeof *force);
        for (int t = 0; t < 9 * linkage->triangle_count; ++t) {
            int h = linkage->triangles[t / 9][t % 3], from = linkage->triangles[t / 9][t / 3 % 3];
            for (int c = 0; c < 2 && h != from && linkage->on_rim[h]; ++c)
                force[h][c] += (strong ? 0.02 : 0.01) * (open[h][c] - open[from][c]);
        }
        ax_solver_set_load(s, (const double(*)[3])force);
        settle.force = settle.primal = 1e-9, settle.iterations = 100000, settle.patience = 20000;
        assert_int_equal(ax_solver_settle(s, &settle, NULL).end, AX_SETTLE_DONE);
        ax_solver_get_places(s, f.place);
        double map[2][2];
        mean_stretch(&f, map);
        assert_near(sqrt(map[0][0] * map[1][1] - map[0][1] * map[1][0]), lambda, 1e-7);
        ax_free(force);
        ax_solver_free(s);
        free_flat(&f);
    }
}

// ---- a dome from many starts

// A cap of the unit sphere by stereographic projection of the open lattice: panels have the edges they have there, the rim is held
// there.
static ax_solver* make_dome(const ax_lattice* lattice, const ax_load_type* load, const loops* all, double (*dome)[3])
{
    const ax_linkage* linkage = &lattice->linkage;
    int n = linkage->hinge_count, count, *rim = list_rim(linkage, &count);
    for (int h = 0; h < n; ++h) {
        double x = 0.6 * lattice->hinges[h][0], y = 0.6 * lattice->hinges[h][1], s = 2 / (1 + x * x + y * y);
        dome[h][0] = s * x, dome[h][1] = s * y, dome[h][2] = s - 1;
    }
    ax_solver* s = ax_solver_make(n, (const double(*)[3])dome, NULL);
    int panels = ax_solver_add(s, type("rigid_triangle"), 3, linkage->triangle_count, linkage->triangles[0], 1, NULL);
    ax_solver_add(s, type("fixed"), 1, count, rim, 0, NULL);
    ax_free(rim);
    ax_solver_add_load(s, load, load->follows ? all->count : all->panels, all->start, all->points);
    ax_solver_use_multipliers(s, true);
    ax_solver_scale_loads(s, 0.1 / ax_solver_load_ratio(s, panels));
    return s;
}

// Twenty random starts about the flat sheet, for which nothing but the rim's places is known, find one shape under either load, the
// sphere nearly.
static void random_starts_find_one_dome(void** state)
{
    (void)state;
    enum { STARTS = 20, SEED = 41 };
    ax_lattice lattice = make_patch(0.2);
    int n = lattice.linkage.hinge_count;
    loops all = collect(&lattice.linkage);
    double(*dome)[3] = ax_alloc((size_t)n, sizeof *dome), (*x)[3] = ax_alloc((size_t)n, sizeof *x);
    double(*first)[3] = ax_alloc((size_t)n, sizeof *x);
    print_message("seed %d\n", SEED);
    for (int inflated = 0; inflated < 2; ++inflated) {
        double apart = 0, off = 0;
        for (int start = 0; start < STARTS; ++start) {
            ax_solver* s = make_dome(&lattice, ax_load_find(inflated ? "pressure" : "gravity"), &all, dome);
            ax_random random = {SEED + (uint64_t)start};
            for (int h = 0; h < n; ++h)
                for (int c = 0; c < 3; ++c) {
                    double flat = c < 2 ? 0.88 * lattice.hinges[h][c] : 0.47;
                    x[h][c] = flat + ax_random_uniform(&random, c < 2 ? -0.05 : 0, 0.05);
                }
            ax_solver_set_places(s, (const double(*)[3])x);
            ax_solver_accelerate(s, 5);
            ax_settle settle = AX_SETTLE_STANDARD;
            settle.force = settle.primal = 1e-7;
            assert_int_equal(ax_solver_settle(s, &settle, NULL).end, AX_SETTLE_DONE);
            ax_solver_get_places(s, x);
            if (start == 0)
                memcpy(first, x, (size_t)n * sizeof *x);
            for (int h = 0; h < n; ++h) {
                apart = fmax(apart, ax_distance3(x[h], first[h]));
                off = fmax(off, ax_distance3(x[h], dome[h]));
            }
            ax_solver_free(s);
        }
        assert_at_most(apart, 1e-6);
        assert_at_most(off, 0.1 * lattice.spacing);
    }
    free_loops(&all);
    ax_free(dome);
    ax_free(x);
    ax_free(first);
    ax_lattice_free(&lattice);
}

// ---- how settling ends

static bool stop_at_once(void* context, const char* stage, double fraction, double residual)
{
    (void)stage, (void)fraction, (void)residual;
    return --*(int*)context > 0;
}

static void settling_says_how_it_ended(void** state)
{
    (void)state;
    // a point that is to be in two places 1.5 apart
    const double place[2][3] = {{0, 0, 0}, {1, 0, 0}};
    ax_settle settle = AX_SETTLE_STANDARD;
    settle.patience = 100, settle.length = 1;
    ax_solver* s = ax_solver_make(1, place, NULL);
    for (int k = 0; k < 2; ++k) {
        ax_solver_add(s, type("closeness"), 1, 1, (int[]){0}, 1, NULL);
        ax_solver_set(s, k, 0, lane("closeness", "target") + 1, 1.5 * k);
    }
    ax_solver_use_multipliers(s, true);
    ax_settled run = ax_solver_settle(s, &settle, NULL);
    assert_int_equal(run.end, AX_SETTLE_STAGNATED);
    assert_near(run.primal, 0.75, 1e-9);
    assert_true(run.multiplier_most > 70); // grows by 0.75 in every iteration
    ax_solver_reset_multipliers(s);
    ax_solver_cap_multipliers(s, 2);
    run = ax_solver_settle(s, &settle, NULL);
    assert_int_equal(run.end, AX_SETTLE_STAGNATED);
    assert_int_equal(run.capped, 2);
    assert_near(run.multiplier_most, 2, 1e-12);
    ax_solver_use_multipliers(s, false); // now they balance
    assert_int_equal(ax_solver_settle(s, &settle, NULL).end, AX_SETTLE_DONE);
    assert_near(ax_solver_report(s, 0).residual_most, 0.75, 1e-12);
    assert_near(ax_solver_report(s, 1).multiplier, 0.75, 1e-12);
    ax_solver_free(s);

    s = ax_solver_make(2, place, NULL); // the second point belongs to nothing
    ax_solver_add(s, type("closeness"), 1, 1, (int[]){0}, 1, NULL);
    assert_int_equal(ax_solver_settle(s, &settle, NULL).end, AX_SETTLE_UNBOUND);
    ax_solver_free(s);

    sheet k = make_sheet(0.3, true, NULL);
    ax_solver_scale_loads(k.solver, 0.1 / ax_solver_load_ratio(k.solver, k.panels));
    settle.iterations = 20, settle.force = 1e-12;
    ax_settled limited = ax_solver_settle(k.solver, &settle, NULL);
    assert_int_equal(limited.end, AX_SETTLE_LIMIT);
    assert_int_equal(limited.iterations, 20);
    int reports = 2;
    ax_progress progress = {stop_at_once, &reports};
    assert_int_equal(ax_solver_settle(k.solver, &settle, &progress).end, AX_SETTLE_CANCELLED);
    // springs against a pressure far beyond their stiffness: a balloon that bursts
    ax_solver_scale_loads(k.solver, 100 / ax_solver_load_ratio(k.solver, k.panels));
    settle.iterations = 100000;
    ax_settled burst = ax_solver_settle(k.solver, &settle, NULL);
    assert_int_equal(burst.end, AX_SETTLE_DIVERGED);
    free_sheet(&k);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(loads_are_those_of_the_exact_stage),
        cmocka_unit_test(a_hanging_chain_is_the_discrete_catenary),
        cmocka_unit_test(a_balloon_of_springs_grows_as_its_volume_says),
        cmocka_unit_test(supports_carry_the_whole_load),
        cmocka_unit_test(a_single_hinge_hangs_down),
        cmocka_unit_test(energy_never_rises_under_loads),
        cmocka_unit_test(acceleration_shortens_the_way_to_the_same_place),
        cmocka_unit_test(threads_change_no_bit_of_loads_and_acceleration),
        cmocka_unit_test(nothing_is_allocated_under_loads_and_acceleration),
        cmocka_unit_test(loops_side_by_side_act_as_alone),
        cmocka_unit_test(a_uniform_patch_has_poisson_ratio_minus_one),
        cmocka_unit_test(a_uniform_patch_is_blocked_at_its_lambda),
        cmocka_unit_test(random_starts_find_one_dome),
        cmocka_unit_test(settling_says_how_it_ended),
    };
    return cmocka_run_group_tests_name("equilibrium", tests, NULL, NULL);
}
