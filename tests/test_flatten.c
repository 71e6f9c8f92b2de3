// Conformal flattening against analytic maps and the identities that it must satisfy.
#include "ax/flatten.h"
#include "base/random.h"
#include "base/vec.h"
#include "conformal/rim.h"
#include "mesh/geometry.h"

#include "support/shapes.h"
#include "support/test.h"

#include <string.h>

static double zero(double x, double y)
{
    (void)x, (void)y;
    return 0;
}

static double waves(double x, double y)
{
    return 0.5 * (1 - x * x - y * y) + 0.05 * sin(4 * x) * cos(3 * y);
}

static double barrel(double x, double y)
{
    return 0.6 * (1 - 0.5 * x * x - 0.3 * y * y);
}

static ax_flattening flatten(const ax_mesh* mesh, const ax_flatten_options* options)
{
    ax_error error = {0};
    ax_flattening flat;
    if (ax_flatten(mesh, options, &flat, &error) != AX_OK)
        fail_msg("%s", error.message);
    assert_int_equal(flat.vertex_count, mesh->vertex_count);
    assert_int_equal(flat.flipped_faces, 0);
    return flat;
}

static double* rim_point(const ax_flattening* flat, int k)
{
    return flat->uv[flat->rim[(k + flat->rim_count) % flat->rim_count]];
}

// Turning angle of the flat rim at rim vertex k.
static double flat_turning(const ax_flattening* flat, int k)
{
    const double *a = rim_point(flat, k - 1), *b = rim_point(flat, k), *c = rim_point(flat, k + 1);
    double e[2] = {b[0] - a[0], b[1] - a[1]}, g[2] = {c[0] - b[0], c[1] - b[1]};
    return atan2(ax_cross2(e, g), e[0] * g[0] + e[1] * g[1]);
}

static void a_hemisphere_flattens_stereographically(void** state)
{
    (void)state;
    for (int rings = 10; rings <= 40; rings *= 2) {
        ax_mesh mesh = shape_cap(rings, AX_PI / 2);
        ax_flattening flat = flatten(&mesh, NULL);
        double second_order = 0.12 / (rings * rings);
        assert_near(flat.u_max - flat.u_min, log(2), second_order);
        for (int v = 0; v < mesh.vertex_count; ++v) {
            const double* x = mesh.positions[v];
            double rho = hypot(x[0], x[1]) / (1 + x[2]);
            assert_near(flat.u[v], -log(2 / (1 + rho * rho)), second_order);
            assert_near(hypot(flat.uv[v][0], flat.uv[v][1]), rho, second_order);
            assert_near(flat.uv[v][0] * x[1] - flat.uv[v][1] * x[0], 0, second_order); // turned as seen from above
        }
        ax_flattening_free(&flat);
        ax_mesh_free(&mesh);
    }
}

static void a_flat_sheet_flattens_to_itself(void** state)
{
    (void)state;
    ax_mesh mesh = shape_over_disk(12, zero);
    ax_random random = {7};
    for (int v = 0; v < mesh.vertex_count; ++v)
        for (int d = 0; d < 2; ++d)
            mesh.positions[v][d] += ax_random_uniform(&random, -0.02, 0.02);
    ax_mesh tilted = ax_mesh_copy(&mesh);
    shape_move(&tilted, 0.7, 500000, 5000000, 100);
    const ax_mesh* meshes[] = {&mesh, &tilted};
    for (int m = 0; m < 2; ++m) {
        ax_flattening flat = flatten(meshes[m], NULL);
        double shift[2] = {flat.uv[0][0] - mesh.positions[0][0], flat.uv[0][1] - mesh.positions[0][1]};
        double tolerance = m == 0 ? 1e-12 : 1e-8; // a micrometre grid is what doubles leave at five million metres
        assert_near(flat.u_min, 0, tolerance);
        assert_near(flat.u_max, 0, tolerance);
        assert_near(flat.quasi_conformal_max, 1, tolerance * 100);
        for (int v = 0; v < mesh.vertex_count; ++v)
            for (int d = 0; d < 2; ++d)
                assert_near(flat.uv[v][d] - mesh.positions[v][d], shift[d], tolerance);
        ax_flattening_free(&flat);
    }
    ax_mesh_free(&mesh);
    ax_mesh_free(&tilted);
}

static void a_scaled_surface_flattens_to_the_scaled_sheet(void** state)
{
    (void)state;
    ax_mesh mesh = shape_over_disk(15, waves);
    ax_flattening flat = flatten(&mesh, NULL);
    for (int v = 0; v < mesh.vertex_count; ++v)
        for (int d = 0; d < 3; ++d)
            mesh.positions[v][d] *= 1e3;
    ax_flattening large = flatten(&mesh, NULL);
    for (int v = 0; v < mesh.vertex_count; ++v) {
        assert_near(large.u[v], flat.u[v], 1e-12);
        for (int d = 0; d < 2; ++d)
            assert_near(large.uv[v][d], 1e3 * flat.uv[v][d], 1e-9);
    }
    ax_flattening_free(&flat);
    ax_flattening_free(&large);
    ax_mesh_free(&mesh);
}

// The turning in the plane, k + (A u) on the rim, sums to 2 pi (Gauss and Bonnet) and is that of the curve which came
// out.
static void the_flat_rim_turns_by_what_the_scale_says(void** state)
{
    (void)state;
    ax_mesh mesh = shape_over_disk(20, waves);
    ax_flattening flat = flatten(&mesh, NULL);
    ax_sparse laplacian = ax_cotan_laplacian(&mesh);
    double *product = AX_NEW(double, mesh.vertex_count), *turning = AX_NEW0(double, mesh.vertex_count), sum = 0;
    double(*angle)[3] = ax_alloc((size_t)mesh.face_count, sizeof *angle);
    ax_sparse_multiply(&laplacian, flat.u, product, 1);
    ax_corner_angles(&mesh, angle);
    for (int f = 0; f < mesh.face_count; ++f)
        for (int k = 0; k < 3; ++k)
            turning[mesh.faces[f][k]] -= angle[f][k];
    for (int k = 0; k < flat.rim_count; ++k) {
        int v = flat.rim[k];
        assert_near(flat.u[v], 0, 0);
        double expected = AX_PI + turning[v] + product[v];
        sum += expected;
        assert_near(flat_turning(&flat, k), expected, 1e-9);
    }
    assert_near(sum, 2 * AX_PI, 1e-9);
    ax_free(product);
    ax_free(turning);
    ax_free(angle);
    ax_sparse_free(&laplacian);
    ax_flattening_free(&flat);
    ax_mesh_free(&mesh);
}

static void rim_lengths_are_kept_but_for_the_closing(void** state)
{
    (void)state;
    ax_mesh mesh = shape_over_disk(40, waves);
    ax_flattening flat = flatten(&mesh, NULL);
    for (int k = 0; k < flat.rim_count; ++k) {
        const double *a = mesh.positions[flat.rim[k]], *b = mesh.positions[flat.rim[(k + 1) % flat.rim_count]];
        assert_near(ax_distance2(rim_point(&flat, k), rim_point(&flat, k + 1)) / ax_distance3(a, b), 1, 1e-4);
    }
    ax_flattening_free(&flat);
    ax_mesh_free(&mesh);
}

static void distortion_vanishes_with_refinement(void** state)
{
    (void)state;
    for (int rings = 10; rings <= 80; rings *= 2) {
        ax_mesh mesh = shape_over_disk(rings, waves);
        ax_flattening flat = flatten(&mesh, NULL);
        assert_at_most(flat.quasi_conformal_mean - 1, 0.25 / rings);
        assert_at_most(flat.quasi_conformal_max - 1, 0.4 / rings);
        assert_true(flat.quasi_conformal_mean > 1 && flat.quasi_conformal_max > flat.quasi_conformal_mean);
        ax_flattening_free(&flat);
        ax_mesh_free(&mesh);
    }
}

static void a_disk_boundary_is_a_circle(void** state)
{
    (void)state;
    const ax_flatten_options disk = {.boundary = AX_FLATTEN_DISK};
    ax_mesh mesh = shape_over_square(30, barrel);
    ax_flattening flat = flatten(&mesh, &disk);
    double radius = hypot(rim_point(&flat, 0)[0], rim_point(&flat, 0)[1]), mean = 0, perimeter = 0;
    for (int k = 0; k < flat.rim_count; ++k) {
        assert_near(hypot(rim_point(&flat, k)[0], rim_point(&flat, k)[1]), radius, 1e-13);
        assert_true(flat_turning(&flat, k) > 0);
        int v = flat.rim[k], w = flat.rim[(k + 1) % flat.rim_count];
        double length = ax_distance3(mesh.positions[v], mesh.positions[w]);
        mean += length * (flat.u[v] + flat.u[w]) / 2;
        perimeter += length;
    }
    assert_near(mean / perimeter, 0, 1e-12);
    // no triangle can stay itself where a corner of the plan is bent straight, so this falls with their share: 1.037 at
    // n = 60
    assert_at_most(flat.quasi_conformal_mean, 1.08);
    ax_flattening_free(&flat);
    ax_mesh_free(&mesh);

    // where the rim is a circle already, so is the free one: the two agree
    mesh = shape_cap(20, 1);
    flat = flatten(&mesh, &disk);
    ax_flattening free_rim = flatten(&mesh, NULL);
    for (int v = 0; v < mesh.vertex_count; ++v)
        assert_near(flat.u[v], free_rim.u[v], 1e-4);
    ax_flattening_free(&free_rim);
    ax_flattening_free(&flat);
    ax_mesh_free(&mesh);
}

// Corners at the plan's corners, straight between them. A rhombus may start at either angle: the plan prefers none.
static void a_square_plan_becomes_the_polygon_that_is_asked(void** state)
{
    (void)state;
    const double square[] = {90, 90, 90, 90}, rhombus[] = {60, 120, 60, 120};
    ax_mesh mesh = shape_over_square(24, barrel);
    for (int o = 0; o < 2; ++o) {
        const ax_flatten_options options = {AX_FLATTEN_POLYGON, 4, o ? rhombus : square};
        ax_flattening flat = flatten(&mesh, &options);
        int corners = 0;
        double turning[4];
        for (int k = 0; k < flat.rim_count; ++k) {
            const double* x = mesh.positions[flat.rim[k]];
            if (fabs(x[0]) + fabs(x[1]) == 2)
                turning[corners++] = flat_turning(&flat, k);
            else
                assert_near(flat_turning(&flat, k), 0, 1e-9);
        }
        assert_int_equal(corners, 4);
        assert_near(turning[0], turning[2], 1e-9);
        assert_near(turning[1], turning[3], 1e-9);
        assert_near(fmax(turning[0], turning[1]), (o ? 2.0 / 3 : 0.5) * AX_PI, 1e-9);
        ax_flattening_free(&flat);
    }
    ax_mesh_free(&mesh);
}

static void a_round_plan_gets_evenly_spaced_corners(void** state)
{
    (void)state;
    const double angles[] = {108, 108, 108, 108, 108};
    const ax_flatten_options options = {AX_FLATTEN_POLYGON, 5, angles};
    ax_mesh mesh = shape_cap(20, 1);
    ax_flattening flat = flatten(&mesh, &options);
    int last = -1, corners = 0;
    for (int k = 0; k < flat.rim_count; ++k)
        if (fabs(flat_turning(&flat, k)) > 1e-9) {
            assert_near(flat_turning(&flat, k), 0.4 * AX_PI, 1e-9);
            if (last >= 0)
                assert_int_equal(k - last, flat.rim_count / 5);
            last = k;
            ++corners;
        }
    assert_int_equal(corners, 5);
    ax_flattening_free(&flat);
    ax_mesh_free(&mesh);
}

static void corners_follow_the_rim_and_then_the_angles(void** state)
{
    (void)state;
    // a rectangle of 3 x 1 whose corners are rounded off over three vertices, and a nick that is too near to one of
    // them
    enum { N = 80 };
    double turning[N] = {0}, length[N];
    for (int k = 0; k < N; ++k)
        length[k] = 0.1;
    const int at[] = {0, 30, 40, 70};
    for (int c = 0; c < 4; ++c)
        for (int d = -1; d <= 1; ++d)
            turning[(at[c] + d + N) % N] = (d ? 1 : 2) * AX_PI / 8;
    turning[43] = 0.6;
    int corner[6];
    ax_rim_corners(N, turning, length, 4, (const double[]){90, 90, 90, 90}, corner);
    for (int c = 0; c < 4; ++c)
        assert_int_equal(corner[c], at[c]);
    // two more than the rim has: the long sides are halved, and the straight angles go there
    ax_rim_corners(N, turning, length, 6, (const double[]){180, 90, 90, 180, 90, 90}, corner);
    const int expected[] = {15, 30, 40, 55, 70, 0};
    for (int c = 0; c < 6; ++c)
        assert_int_equal(corner[c], expected[c]);
    // as many corners as vertices: every vertex is one
    int every[N];
    double straight[N];
    for (int k = 0; k < N; ++k)
        straight[k] = 180 * (N - 2.0) / N;
    ax_rim_corners(N, turning, length, N, straight, every);
    for (int k = 1; k < N; ++k)
        assert_int_equal(every[k], (every[0] + k) % N);
}

static void impossible_angles_are_refused(void** state)
{
    (void)state;
    ax_mesh mesh = shape_cap(3, 1);
    const struct {
        int count;
        double angles[4];
        const char* says;
    } cases[] = {{2, {90, 90}, "at least 3"},
                 {4, {90, 90, 90, 80}, "sum to 360"},
                 {3, {0, 90, 90}, "between 0 and 360"},
                 {1000, {90}, "at most the 18"}};
    for (size_t c = 0; c < sizeof cases / sizeof *cases; ++c) {
        const ax_flatten_options options = {AX_FLATTEN_POLYGON, cases[c].count, cases[c].angles};
        ax_flattening flat;
        ax_error error = {0};
        assert_int_equal(ax_flatten(&mesh, &options, &flat, &error), AX_USAGE);
        assert_non_null(strstr(error.message, cases[c].says));
        assert_null(flat.uv);
    }
    ax_mesh_free(&mesh);
}

static void a_surface_with_two_rims_is_refused_by_name(void** state)
{
    (void)state;
    ax_mesh mesh = shape_cap(6, 1);
    memmove(mesh.faces, mesh.faces + 6, (size_t)(mesh.face_count - 6) * sizeof *mesh.faces); // without the middle
    mesh.face_count -= 6;
    mesh.vertex_count -= 1;
    memmove(mesh.positions, mesh.positions + 1, (size_t)mesh.vertex_count * sizeof *mesh.positions);
    for (int f = 0; f < mesh.face_count; ++f)
        for (int k = 0; k < 3; ++k)
            --mesh.faces[f][k];
    ax_flattening flat;
    ax_error error = {0};
    assert_int_equal(ax_flatten(&mesh, NULL, &flat, &error), AX_CANNOT_REALISE);
    assert_non_null(strstr(error.message, "2 boundary loops"));
    ax_mesh_free(&mesh);
}

static void one_triangle_flattens_to_its_own_shape(void** state)
{
    (void)state;
    double positions[3][3] = {{0, 0, 0}, {3, 0, 4}, {0, 2, 0}};
    int faces[1][3] = {{0, 1, 2}};
    const ax_mesh mesh = {3, 1, positions, faces};
    ax_flattening flat = flatten(&mesh, NULL);
    for (int k = 0; k < 3; ++k)
        assert_near(ax_distance2(flat.uv[k], flat.uv[(k + 1) % 3]), ax_distance3(positions[k], positions[(k + 1) % 3]),
                    1e-14);
    assert_near(flat.u_max - flat.u_min, 0, 0);
    ax_flattening_free(&flat);
}

static void needles_do_not_upset_the_map(void** state)
{
    (void)state;
    ax_mesh mesh = shape_over_disk(10, zero);
    int needles = 0;
    for (int f = 0; f < mesh.face_count;
         f += 31) { // an inner vertex is dragged onto a neighbour, if that folds nothing
        int v = mesh.faces[f][2], w = mesh.faces[f][0];
        double kept[2] = {mesh.positions[v][0], mesh.positions[v][1]};
        for (int d = 0; d < 2; ++d)
            mesh.positions[v][d] += (1 - 1e-7) * (mesh.positions[w][d] - kept[d]);
        bool folded = hypot(kept[0], kept[1]) > 0.95;
        for (int g = 0; g < mesh.face_count && !folded; ++g) {
            const int* c = mesh.faces[g];
            folded = ax_orient2(mesh.positions[c[0]], mesh.positions[c[1]], mesh.positions[c[2]]) <= 0;
        }
        needles += !folded;
        if (folded)
            memcpy(mesh.positions[v], kept, sizeof kept);
    }
    assert_true(needles > 5);
    ax_flattening flat;
    assert_int_equal(ax_flatten(&mesh, NULL, &flat, NULL), AX_OK);
    for (int v = 0; v < mesh.vertex_count; ++v)
        for (int d = 0; d < 2; ++d)
            assert_near(flat.uv[v][d] - flat.uv[0][d], mesh.positions[v][d] - mesh.positions[0][d], 1e-6);
    ax_flattening_free(&flat);
    ax_mesh_free(&mesh);
}

static void the_same_surface_gives_the_same_bits(void** state)
{
    (void)state;
    ax_mesh mesh = shape_over_disk(40, waves);
    for (int boundary = AX_FLATTEN_FREE; boundary <= AX_FLATTEN_DISK; ++boundary) {
        const ax_flatten_options options = {.boundary = boundary};
        ax_flattening a = flatten(&mesh, &options), b = flatten(&mesh, &options);
        assert_memory_equal(a.uv, b.uv, (size_t)mesh.vertex_count * sizeof *a.uv);
        assert_memory_equal(a.u, b.u, (size_t)mesh.vertex_count * sizeof *a.u);
        ax_flattening_free(&a);
        ax_flattening_free(&b);
    }
    ax_mesh_free(&mesh);
}

static bool simple_by_brute_force(int count, const double (*p)[2])
{
    for (int i = 0; i < count; ++i)
        for (int j = i + 1; j < count; ++j) {
            const double *a = p[i], *b = p[(i + 1) % count], *c = p[j], *d = p[(j + 1) % count];
            if (ax_orient2(a, b, c) * ax_orient2(a, b, d) < 0 && ax_orient2(c, d, a) * ax_orient2(c, d, b) < 0)
                return false;
        }
    return true;
}

static void crossing_rims_are_found(void** state)
{
    (void)state;
    const double square[][2] = {{0, 0}, {1, 0}, {1, 1}, {0, 1}}, bow[][2] = {{0, 0}, {1, 0}, {0, 1}, {1, 1}};
    assert_true(ax_rim_is_simple(4, square));
    assert_false(ax_rim_is_simple(4, bow));
    ax_random random = {11};
    int crossing = 0;
    for (int round = 0; round < 400; ++round) {
        double p[60][2];
        int count = 20 + round % 41;
        for (int k = 0; k < count; ++k) { // a wobbly circle, stretched to many proportions
            double t = 2 * AX_PI * k / count, r = 1 + ax_random_uniform(&random, -0.2, 0.2) * (round % 10);
            p[k][0] = r * cos(t) * (1 + round % 7 * 20), p[k][1] = r * sin(t);
        }
        bool simple = simple_by_brute_force(count, (const double(*)[2])p);
        assert_int_equal(ax_rim_is_simple(count, (const double(*)[2])p), simple);
        crossing += !simple;
    }
    assert_in_range(crossing, 50, 350);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_hemisphere_flattens_stereographically),
        cmocka_unit_test(a_flat_sheet_flattens_to_itself),
        cmocka_unit_test(a_scaled_surface_flattens_to_the_scaled_sheet),
        cmocka_unit_test(the_flat_rim_turns_by_what_the_scale_says),
        cmocka_unit_test(rim_lengths_are_kept_but_for_the_closing),
        cmocka_unit_test(distortion_vanishes_with_refinement),
        cmocka_unit_test(a_disk_boundary_is_a_circle),
        cmocka_unit_test(a_square_plan_becomes_the_polygon_that_is_asked),
        cmocka_unit_test(a_round_plan_gets_evenly_spaced_corners),
        cmocka_unit_test(corners_follow_the_rim_and_then_the_angles),
        cmocka_unit_test(impossible_angles_are_refused),
        cmocka_unit_test(a_surface_with_two_rims_is_refused_by_name),
        cmocka_unit_test(one_triangle_flattens_to_its_own_shape),
        cmocka_unit_test(needles_do_not_upset_the_map),
        cmocka_unit_test(the_same_surface_gives_the_same_bits),
        cmocka_unit_test(crossing_rims_are_found),
    };
    return cmocka_run_group_tests_name("flatten", tests, NULL, NULL);
}
