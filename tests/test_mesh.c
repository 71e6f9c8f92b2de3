// Connectivity, differential quantities and closest points, against analytic values, invariants and brute force.
#include "base/clock.h"
#include "base/random.h"
#include "base/vec.h"
#include "mesh/closest.h"
#include "mesh/geometry.h"
#include "mesh/topology.h"

#include "support/shapes.h"
#include "support/test.h"

#include <stdlib.h>
#include <string.h>

static double saddle(double x, double y)
{
    return 0.3 * (x * x - y * y) + 0.1 * x;
}

static double flat(double x, double y)
{
    (void)x, (void)y;
    return 0;
}

// One vertex joined to many: slivers whose pole is everybody's neighbour.
static ax_mesh fan(int count)
{
    ax_mesh mesh = {.vertex_count = count + 1, .face_count = count};
    mesh.positions = ax_calloc((size_t)count + 1, sizeof *mesh.positions);
    mesh.faces = ax_alloc((size_t)count, sizeof *mesh.faces);
    mesh.positions[0][2] = 0.5;
    for (int i = 0; i < count; ++i) {
        double t = 2 * AX_PI * i / count;
        mesh.positions[i + 1][0] = cos(t);
        mesh.positions[i + 1][1] = sin(t);
        mesh.faces[i][0] = 0, mesh.faces[i][1] = 1 + i, mesh.faces[i][2] = 1 + (i + 1) % count;
    }
    return mesh;
}

static void twins_are_symmetric_and_the_rim_is_one_loop(void** state)
{
    (void)state;
    enum { rings = 20 };
    ax_mesh mesh = shape_cap(rings, 1);
    ax_topology topology = ax_topology_make(&mesh);
    int open = 0;
    for (int h = 0; h < 3 * mesh.face_count; ++h) {
        int twin = topology.twin[h];
        if (twin < 0) {
            ++open;
            assert_true(topology.on_rim[ax_half_edge_from(&mesh, h)]);
            continue;
        }
        assert_int_equal(topology.twin[twin], h);
        assert_int_equal(ax_half_edge_from(&mesh, h), ax_half_edge_to(&mesh, twin));
        assert_int_equal(ax_half_edge_to(&mesh, h), ax_half_edge_from(&mesh, twin));
    }
    assert_int_equal(open, 6 * rings);
    assert_int_equal(topology.loop_count, 1);
    assert_int_equal(topology.loop_start[1] - topology.loop_start[0], 6 * rings);
    double area = 0; // counter-clockwise seen from above, like the faces
    for (int i = 0; i < 6 * rings; ++i) {
        const double* a = mesh.positions[topology.loop[i]];
        const double* b = mesh.positions[topology.loop[(i + 1) % (6 * rings)]];
        area += 0.5 * ax_cross2(a, b);
    }
    assert_near(area, AX_PI * sin(1) * sin(1), 5e-3);
    ax_topology_free(&topology);
    ax_mesh_free(&mesh);
}

static void an_annulus_has_two_loops_and_a_tetrahedron_none(void** state)
{
    (void)state;
    ax_mesh mesh = shape_cap(4, 1);
    for (int f = 0; f < mesh.face_count - 6; ++f) // the first six faces surround the pole
        memcpy(mesh.faces[f], mesh.faces[f + 6], sizeof mesh.faces[f]);
    mesh.face_count -= 6;
    ax_topology topology = ax_topology_make(&mesh);
    assert_int_equal(topology.loop_count, 2);
    assert_int_equal(topology.loop_start[2], 24 + 6);
    ax_topology_free(&topology);
    ax_mesh_free(&mesh);

    double corners[4][3] = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
    int sides[4][3] = {{0, 2, 1}, {0, 1, 3}, {1, 2, 3}, {2, 0, 3}};
    ax_mesh tetrahedron = {4, 4, corners, sides};
    topology = ax_topology_make(&tetrahedron);
    assert_int_equal(topology.loop_count, 0);
    ax_topology_free(&topology);
}

static void areas_add_up_and_angles_obey_gauss_bonnet(void** state)
{
    (void)state;
    ax_mesh meshes[] = {shape_cap(30, AX_PI / 2), shape_over_disk(17, saddle), shape_paraboloid(25, 0.7), fan(500)};
    for (size_t m = 0; m < sizeof meshes / sizeof *meshes; ++m) {
        ax_mesh* mesh = &meshes[m];
        double* area = AX_NEW(double, mesh->vertex_count);
        double* angle = AX_NEW0(double, mesh->vertex_count);
        double(*corner)[3] = ax_alloc((size_t)mesh->face_count, sizeof *corner);
        ax_vertex_areas(mesh, area);
        ax_corner_angles(mesh, corner);
        double faces = 0, vertices = 0, curvature = 0;
        for (int f = 0; f < mesh->face_count; ++f) {
            faces += ax_face_area(mesh, f);
            assert_near(corner[f][0] + corner[f][1] + corner[f][2], AX_PI, 1e-12);
            for (int k = 0; k < 3; ++k)
                angle[mesh->faces[f][k]] += corner[f][k];
        }
        ax_topology topology = ax_topology_make(mesh);
        for (int v = 0; v < mesh->vertex_count; ++v) {
            vertices += area[v];
            curvature += (topology.on_rim[v] ? AX_PI : 2 * AX_PI) - angle[v];
        }
        assert_near(vertices, faces, 1e-12 * faces);
        assert_near(curvature, 2 * AX_PI, 1e-9);
        ax_topology_free(&topology);
        ax_free(corner);
        ax_free(angle);
        ax_free(area);
        ax_mesh_free(mesh);
    }
}

static void laplacian_annihilates_linear_functions_inside_a_flat_mesh(void** state)
{
    (void)state;
    ax_mesh mesh = shape_over_disk(15, flat);
    int n = mesh.vertex_count;
    ax_sparse laplacian = ax_cotan_laplacian(&mesh);
    assert_int_equal(laplacian.n, n);
    for (int c = 0; c < n; ++c) {
        assert_int_equal(laplacian.row[laplacian.start[c]], c);
        for (int k = laplacian.start[c] + 1; k < laplacian.start[c + 1]; ++k)
            assert_true(laplacian.row[k] > laplacian.row[k - 1]);
    }
    double *x = AX_NEW(double, 3 * n), *y = AX_NEW(double, 3 * n);
    for (int v = 0; v < n; ++v) {
        x[v] = 2 * mesh.positions[v][0] - 3 * mesh.positions[v][1] + 5;
        x[n + v] = 1;
        x[2 * n + v] = mesh.positions[v][0];
    }
    ax_sparse_multiply(&laplacian, x, y, 3);
    ax_topology topology = ax_topology_make(&mesh);
    double energy = 0, area = 0;
    for (int v = 0; v < n; ++v) {
        if (!topology.on_rim[v])
            assert_near(y[v], 0, 1e-12);
        assert_near(y[n + v], 0, 1e-13);
        energy += x[2 * n + v] * y[2 * n + v];
    }
    for (int f = 0; f < mesh.face_count; ++f)
        area += ax_face_area(&mesh, f);
    assert_near(energy, area, 1e-12); // Dirichlet energy of the function x: its gradient has length 1
    ax_free(x);
    ax_free(y);
    ax_topology_free(&topology);
    ax_sparse_free(&laplacian);
    ax_mesh_free(&mesh);
}

static void mean_curvature_of_a_sphere_is_one_over_its_radius(void** state)
{
    (void)state;
    const double radius = 3, far[3] = {1e5, -2e5, 3e4};
    ax_mesh mesh = shape_cap(40, 1);
    for (int v = 0; v < mesh.vertex_count; ++v)
        for (int d = 0; d < 3; ++d)
            mesh.positions[v][d] = far[d] + radius * mesh.positions[v][d];
    double* curvature = AX_NEW(double, mesh.vertex_count);
    ax_mean_curvature(&mesh, curvature);
    for (int v = 0; v < mesh.vertex_count; ++v)
        assert_near(curvature[v], 1 / radius, 0.06 / radius);
    assert_near(curvature[0], 1 / radius, 1e-3 / radius);
    ax_mesh_free(&mesh);

    mesh = shape_over_disk(10, flat);
    ax_mean_curvature(&mesh, curvature);
    for (int v = 0; v < mesh.vertex_count; ++v)
        assert_near(curvature[v], 0, 1e-12);
    ax_mesh_free(&mesh);

    mesh = fan(20); // nothing but the pole is inside, so the rim takes its value
    ax_mean_curvature(&mesh, curvature);
    assert_true(curvature[0] > 0);
    for (int v = 1; v < mesh.vertex_count; ++v)
        assert_near(curvature[v], curvature[0], 1e-14);
    ax_mesh_free(&mesh);
    ax_free(curvature);
}

static void normals_of_a_sphere_point_outward(void** state)
{
    (void)state;
    ax_mesh mesh = shape_cap(30, 1);
    double(*normal)[3] = ax_alloc((size_t)mesh.vertex_count, sizeof *normal);
    ax_vertex_normals(&mesh, normal);
    for (int v = 0; v < mesh.vertex_count; ++v) {
        assert_near(ax_norm3(normal[v]), 1, 1e-14);
        assert_true(ax_dot3(normal[v], mesh.positions[v]) > 0.999);
    }
    double lo[3], hi[3];
    ax_bounds(&mesh, lo, hi);
    assert_near(hi[2], 1, 0);
    assert_near(lo[2], cos(1), 1e-15);
    assert_near(ax_diagonal(&mesh), sqrt(8 * sin(1) * sin(1) + (1 - cos(1)) * (1 - cos(1))), 1e-12);
    ax_free(normal);
    ax_mesh_free(&mesh);
}

static double segment_distance(const double x[3], const double a[3], const double b[3])
{
    double ab[3], ax[3], foot[3];
    ax_sub3(b, a, ab);
    ax_sub3(x, a, ax);
    double t = ax_clamp(ax_dot3(ab, ax) / ax_dot3(ab, ab), 0, 1);
    for (int d = 0; d < 3; ++d)
        foot[d] = a[d] + t * ab[d];
    return ax_distance3(x, foot);
}

// Another way than the tree's: the plane where the foot lies within all three sides, else the nearest side.
static double triangle_distance(const double x[3], const double p[3][3])
{
    double e[3][3], n[3], xp[3];
    for (int k = 0; k < 3; ++k)
        ax_sub3(p[(k + 1) % 3], p[k], e[k]);
    ax_cross(e[0], e[1], n);
    bool within = true;
    double least = INFINITY;
    for (int k = 0; k < 3; ++k) {
        double inward[3];
        ax_cross(n, e[k], inward);
        ax_sub3(x, p[k], xp);
        within = within && ax_dot3(inward, xp) >= 0;
        least = fmin(least, segment_distance(x, p[k], p[(k + 1) % 3]));
    }
    ax_sub3(x, p[0], xp);
    return within ? fabs(ax_dot3(n, xp)) / ax_norm3(n) : least;
}

static void check_closest(const ax_mesh* mesh, int queries, double reach)
{
    ax_closest* closest = ax_closest_make(mesh);
    ax_random random = {7};
    int hint = -1;
    for (int q = 0; q < queries; ++q) {
        double x[3], expected = INFINITY;
        for (int d = 0; d < 3; ++d)
            x[d] = mesh->positions[0][d] + ax_random_uniform(&random, -reach, reach);
        for (int f = 0; f < mesh->face_count; ++f) {
            double p[3][3];
            for (int k = 0; k < 3; ++k)
                memcpy(p[k], mesh->positions[mesh->faces[f][k]], sizeof p[k]);
            expected = fmin(expected, triangle_distance(x, (const double(*)[3])p));
        }
        ax_closest_point found = ax_closest_find(closest, x, -1);
        ax_closest_point hinted = ax_closest_find(closest, x, hint);
        assert_memory_equal(&found, &hinted, sizeof found);
        hint = found.face;
        assert_near(found.distance, expected, 1e-12);
        assert_near(ax_norm3(found.normal), 1, 1e-14);
        assert_near(ax_distance3(x, found.point), found.distance, 1e-14);
        double sum = 0, point[3] = {0};
        for (int k = 0; k < 3; ++k) {
            assert_true(found.weight[k] >= -1e-15);
            sum += found.weight[k];
            for (int d = 0; d < 3; ++d)
                point[d] += found.weight[k] * mesh->positions[mesh->faces[found.face][k]][d];
        }
        assert_near(sum, 1, 1e-15);
        assert_at_most(ax_distance3(point, found.point), 1e-14);
    }
    ax_closest_free(closest);
}

// Against points of the triangle so dense that none of it is further than `spacing` from one.
static void check_closest_to_triangle(const ax_mesh* mesh, int queries, double reach, int* crossings)
{
    enum { PARTS = 48 };
    ax_closest* closest = ax_closest_make(mesh);
    ax_random random = {11};
    for (int q = 0; q < queries; ++q) {
        double corners[3][3], expected = INFINITY, spacing = 0;
        const double* about = mesh->positions[(int)ax_random_uniform(&random, 0, mesh->vertex_count - 1)];
        double away = ax_random_uniform(&random, 0, reach);
        for (int d = 0; d < 3; ++d)
            for (int k = 0; k < 3; ++k)
                corners[k][d] = about[d] + (d == 2 ? away : 0) + ax_random_uniform(&random, -0.2, 0.2);
        for (int k = 0; k < 3; ++k)
            spacing = fmax(spacing, ax_distance3(corners[k], corners[(k + 1) % 3]) / PARTS);
        for (int i = 0; i <= PARTS; ++i)
            for (int j = 0; i + j <= PARTS; ++j) {
                double x[3], u = (double)i / PARTS, v = (double)j / PARTS;
                for (int d = 0; d < 3; ++d)
                    x[d] = corners[0][d] + u * (corners[1][d] - corners[0][d]) + v * (corners[2][d] - corners[0][d]);
                expected = fmin(expected, ax_closest_find(closest, x, -1).distance);
            }
        double found = ax_closest_to_triangle(closest, (const double(*)[3])corners, INFINITY);
        assert_at_most(found, expected * (1 + 1e-12));
        assert_at_most(expected - spacing, found);
        *crossings += found == 0;
        assert_near(ax_closest_to_triangle(closest, (const double(*)[3])corners, 0.5 * found), 0.5 * found, 0);
        assert_near(ax_closest_to_triangle(closest, (const double(*)[3])corners, found + 1), found, 1e-12);
    }
    ax_closest_free(closest);
}

static void distances_of_triangles_agree_with_those_of_their_points(void** state)
{
    (void)state;
    int crossings = 0;
    ax_mesh meshes[] = {shape_cap(12, AX_PI / 2), shape_over_disk(9, saddle), fan(3), shape_over_disk(1, flat)};
    for (size_t m = 0; m < sizeof meshes / sizeof *meshes; ++m) {
        check_closest_to_triangle(&meshes[m], 40, 0, &crossings);
        check_closest_to_triangle(&meshes[m], 40, 1, &crossings);
        ax_mesh_free(&meshes[m]);
    }
    assert_in_range(crossings, 40, 280);
}

// Two edges pass each other, an edge goes through a face between its corners, and faces lie one above the other.
static void distances_of_triangles_are_exact(void** state)
{
    (void)state;
    double positions[3][3] = {{-1, 0, 0}, {1, 0, 0}, {0, -2, 0}};
    int faces[1][3] = {{0, 1, 2}};
    ax_mesh mesh = {.vertex_count = 3, .face_count = 1, .positions = positions, .faces = faces};
    ax_closest* closest = ax_closest_make(&mesh);
    const double beside[3][3] = {{0, 1, -1}, {0, 1, 1}, {0, 3, 0}},
                 over[3][3] = {{0, 0.5, 0.5}, {0, -0.5, 0.5}, {0, 0, 3}};
    const double through[3][3] = {{0, -0.5, -1}, {0, -0.5, 1}, {0, -9, 1}};
    const double above[3][3] = {{-9, 9, 0.25}, {9, 9, 0.25}, {0, -20, 0.25}};
    assert_near(ax_closest_to_triangle(closest, beside, INFINITY), 1, 1e-15);
    assert_near(ax_closest_to_triangle(closest, over, INFINITY), 0.5, 1e-15);
    assert_near(ax_closest_to_triangle(closest, through, INFINITY), 0, 0);
    assert_near(ax_closest_to_triangle(closest, above, INFINITY), 0.25, 1e-15);
    ax_closest_free(closest);
}

static void closest_points_agree_with_brute_force(void** state)
{
    (void)state;
    ax_mesh meshes[] = {shape_cap(12, AX_PI / 2), shape_over_disk(9, saddle), fan(1000), fan(3),
                        shape_over_disk(1, flat)};
    for (size_t m = 0; m < sizeof meshes / sizeof *meshes; ++m) {
        check_closest(&meshes[m], 300, 2);
        check_closest(&meshes[m], 300, 0.05);
        ax_mesh_free(&meshes[m]);
    }
}

static void a_mesh_is_a_place_for_constraints(void** state)
{
    (void)state;
    ax_mesh mesh = shape_cap(20, 1);
    ax_closest* tree = ax_closest_make(&mesh);
    ax_place place = ax_closest_place(tree);
    ax_random random = {7};
    for (int k = 0; k < 100; ++k) {
        double x[3], p[3];
        for (int c = 0; c < 3; ++c)
            x[c] = ax_random_uniform(&random, -2, 2);
        place.nearest(place.geometry, x, p);
        ax_closest_point found = ax_closest_find(tree, x, -1);
        assert_memory_equal(p, found.point, sizeof p);
    }
    // what is beyond all numbers stays, so that a solver that diverges is seen to
    double far[3] = {1e200, 0, NAN}, p[3];
    place.nearest(place.geometry, far, p);
    assert_memory_equal(p, far, sizeof p);
    ax_closest_free(tree);
    ax_mesh_free(&mesh);
}

static void ties_go_to_the_lowest_face(void** state)
{
    (void)state;
    ax_mesh mesh = fan(64);
    ax_closest* closest = ax_closest_make(&mesh);
    double above[3] = {0, 0, 3};
    for (int hint = -1; hint < 64; ++hint)
        assert_int_equal(ax_closest_find(closest, above, hint).face, 0);
    ax_closest_free(closest);
    ax_mesh_free(&mesh);
}

static void a_million_faces_are_searchable_in_seconds(void** state)
{
    (void)state;
    ax_mesh mesh = shape_cap(409, 1);
    assert_true(mesh.face_count > 1000000);
    double start = ax_seconds();
    ax_closest* closest = ax_closest_make(&mesh);
    double built = ax_seconds();
    enum { queries = 100000 };
    ax_random random = {3};
    double worst = 0;
    for (int q = 0; q < queries; ++q) {
        double t = ax_random_uniform(&random, 0, 0.9), u = ax_random_uniform(&random, 0, 2 * AX_PI);
        double x[3] = {1.01 * sin(t) * cos(u), 1.01 * sin(t) * sin(u), 1.01 * cos(t)};
        worst = fmax(worst, fabs(ax_closest_find(closest, x, -1).distance - 0.01));
    }
    double searched = ax_seconds();
    print_message("%d faces: built in %.2f s, %.2f us per query\n", mesh.face_count, built - start,
                  1e6 * (searched - built) / queries);
    assert_at_most(worst, 3e-6);       // the facets' sagitta, half the square of an edge
    assert_at_most(built - start, 30); // slack for sanitizers and busy machines; a quadratic build takes hours
    assert_at_most(searched - built, 30);
    ax_closest_free(closest);
    ax_mesh_free(&mesh);
}

static void star(int count, double (*points)[3])
{
    for (int i = 0; i < count; ++i) {
        double t = 2 * AX_PI * i / count, r = 1 + 0.5 * sin(7 * t);
        points[i][0] = r * cos(t);
        points[i][1] = r * sin(t);
        points[i][2] = 0.2 * cos(3 * t);
    }
}

static void polyline_agrees_with_brute_force(void** state)
{
    (void)state;
    enum { count = 257 };
    double points[count][3];
    star(count, points);
    ax_polyline* line = ax_polyline_make(count, (const double(*)[3])points);
    ax_random random = {11};
    for (int q = 0; q < 2000; ++q) {
        double x[3], expected = INFINITY;
        for (int d = 0; d < 3; ++d)
            x[d] = ax_random_uniform(&random, -2, 2);
        for (int i = 0; i < count; ++i) {
            const double *a = points[i], *b = points[(i + 1) % count];
            expected = fmin(expected, segment_distance(x, a, b));
        }
        ax_polyline_point found = ax_polyline_find(line, x);
        assert_near(found.distance, expected, 1e-12);
        assert_near(ax_norm3(found.tangent), 1, 1e-14);
        assert_near(ax_distance3(x, found.point), found.distance, 1e-14);
    }
    ax_polyline_free(line);
}

static void tangents_turn_smoothly_round_a_circle(void** state)
{
    (void)state;
    enum { count = 100 };
    double points[count][3] = {{0}};
    for (int i = 0; i < count; ++i) {
        points[i][0] = cos(2 * AX_PI * i / count);
        points[i][1] = sin(2 * AX_PI * i / count);
    }
    ax_polyline* line = ax_polyline_make(count, (const double(*)[3])points);
    for (int q = 0; q < 1000; ++q) {
        double t = 2 * AX_PI * q / 1000, x[3] = {cos(t), sin(t), 0};
        ax_polyline_point found = ax_polyline_find(line, x);
        double expected[3] = {-sin(t), cos(t), 0};
        assert_at_most(ax_distance3(found.tangent, expected), 0.001); // the segments' own directions differ by 0.03
    }
    ax_polyline_free(line);
}

// Largest angle between the normals of neighbouring faces.
static double sharpest(const ax_mesh* mesh)
{
    ax_topology t = ax_topology_make(mesh);
    double least = 1;
    for (int h = 0; h < 3 * mesh->face_count; ++h)
        if (t.twin[h] > h) {
            double a[3], b[3];
            ax_face_normal(mesh, h / 3, a);
            ax_face_normal(mesh, t.twin[h] / 3, b);
            least = fmin(least, ax_dot3(a, b));
        }
    ax_topology_free(&t);
    return acos(least);
}

static void a_flat_square_keeps_its_corners_and_its_area(void** state)
{
    (void)state;
    ax_mesh square = shape_over_square(3, flat);
    int vertices = square.vertex_count;
    ax_refinement done = ax_mesh_refine(&square, 0.2);
    assert_int_equal(done.rounds, 2);
    assert_int_equal(square.face_count, 2 * 3 * 3 * 16);
    assert_true(square.vertex_count > vertices);
    assert_near(ax_mesh_area(&square), 4, 1e-12);
    for (int k = 0; k < square.vertex_count; ++k)
        assert_near(square.positions[k][2], 0, 0);
    assert_int_equal(ax_mesh_refine(&square, 0.2).rounds, 0); // fine enough
    ax_mesh_free(&square);
}

// The limit is smooth: bends halve with every round; and near: within the square of the mesh's width.
static void refining_rounds_a_dome_and_moves_it_little(void** state)
{
    (void)state;
    double move[2];
    for (int k = 0; k < 2; ++k) {
        ax_mesh dome = shape_cap(k ? 8 : 4, 1);
        double bend = sharpest(&dome), width = 1.0 / (k ? 8 : 4);
        move[k] = 0;
        for (int round = 0; round < 3; ++round) {
            double facet = ax_mean_facet(&dome);
            ax_refinement done = ax_mesh_refine(&dome, 0.99 * facet);
            assert_int_equal(done.rounds, 1);
            move[k] += done.largest_move;
            double next = sharpest(&dome);
            assert_at_most(next, 0.7 * bend);
            bend = next;
        }
        for (int v = 0; v < dome.vertex_count; ++v) {
            assert_at_most(fabs(ax_norm3(dome.positions[v]) - 1), 0.35 * width * width);
            assert_true(dome.positions[v][2] >= cos(1) - 1e-9); // the rim stays in its plane
        }
        ax_mesh_repairs repairs;
        assert_int_equal(ax_mesh_make_surface(&dome, &repairs, NULL), AX_OK);
        assert_int_equal(repairs.welded_vertices + repairs.degenerate_faces + repairs.flipped_faces, 0);
        ax_mesh_free(&dome);
    }
    assert_at_most(move[1], 0.35 * move[0]);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(twins_are_symmetric_and_the_rim_is_one_loop),
        cmocka_unit_test(an_annulus_has_two_loops_and_a_tetrahedron_none),
        cmocka_unit_test(areas_add_up_and_angles_obey_gauss_bonnet),
        cmocka_unit_test(laplacian_annihilates_linear_functions_inside_a_flat_mesh),
        cmocka_unit_test(mean_curvature_of_a_sphere_is_one_over_its_radius),
        cmocka_unit_test(normals_of_a_sphere_point_outward),
        cmocka_unit_test(closest_points_agree_with_brute_force),
        cmocka_unit_test(distances_of_triangles_agree_with_those_of_their_points),
        cmocka_unit_test(distances_of_triangles_are_exact),
        cmocka_unit_test(a_mesh_is_a_place_for_constraints),
        cmocka_unit_test(ties_go_to_the_lowest_face),
        cmocka_unit_test(a_million_faces_are_searchable_in_seconds),
        cmocka_unit_test(polyline_agrees_with_brute_force),
        cmocka_unit_test(a_flat_square_keeps_its_corners_and_its_area),
        cmocka_unit_test(refining_rounds_a_dome_and_moves_it_little),
        cmocka_unit_test(tangents_turn_smoothly_round_a_circle),
    };
    return cmocka_run_group_tests_name("mesh", tests, NULL, NULL);
}
