// From triangles in memory to a surface: what is mended, what is refused, and that nothing depends on how the input is
// arranged.
#include "base/clock.h"
#include "base/random.h"
#include "base/vec.h"
#include "mesh/geometry.h"
#include "mesh/topology.h"

#include "support/shapes.h"
#include "support/test.h"

#include <stdio.h>
#include <string.h>

static double wave(double x, double y)
{
    return 0.1 * sin(3 * x) - 0.2 * y * y;
}

static double monkey_saddle(double x, double y)
{
    return 0.2 * (x * x * x - 3 * x * y * y);
}

static void turn(int face[3])
{
    int corner = face[1];
    face[1] = face[2];
    face[2] = corner;
}

// Every corner a vertex of its own, displaced by up to `noise`, in shuffled order, faces turned at random.
static ax_mesh soup_of(const ax_mesh* mesh, double noise, ax_random* random)
{
    int n = 3 * mesh->face_count;
    ax_mesh soup = {.vertex_count = n, .face_count = mesh->face_count};
    soup.positions = ax_alloc((size_t)n, sizeof *soup.positions);
    soup.faces = ax_alloc((size_t)mesh->face_count, sizeof *soup.faces);
    int* place = AX_NEW(int, n);
    for (int i = 0; i < n; ++i)
        place[i] = i;
    for (int i = n - 1; i > 0; --i) {
        int j = (int)(ax_random_bits(random) % (uint64_t)(i + 1)), moved = place[i];
        place[i] = place[j];
        place[j] = moved;
    }
    for (int i = 0; i < n; ++i) {
        for (int d = 0; d < 3; ++d)
            soup.positions[place[i]][d] =
                mesh->positions[mesh->faces[i / 3][i % 3]][d] + ax_random_uniform(random, -noise, noise);
        soup.faces[i / 3][i % 3] = place[i];
    }
    for (int f = 0; f < soup.face_count; ++f)
        if (ax_random_bits(random) % 3 == 0)
            turn(soup.faces[f]);
    ax_free(place);
    return soup;
}

static void a_soup_becomes_the_surface_it_came_from(void** state)
{
    (void)state;
    ax_mesh meshes[] = {shape_cap(15, 1), shape_over_disk(11, wave), shape_paraboloid(1, 1)};
    ax_random random = {5};
    for (size_t m = 0; m < sizeof meshes / sizeof *meshes; ++m) {
        const ax_mesh* mesh = &meshes[m];
        ax_mesh soup = soup_of(mesh, 1e-8, &random);
        ax_mesh_repairs repairs;
        assert_int_equal(ax_mesh_make_surface(&soup, &repairs, NULL), AX_OK);
        assert_int_equal(soup.vertex_count, mesh->vertex_count);
        assert_int_equal(repairs.welded_vertices, 3 * mesh->face_count - mesh->vertex_count);
        assert_int_equal(repairs.degenerate_faces + repairs.duplicate_faces + repairs.unused_vertices, 0);
        assert_true(2 * repairs.flipped_faces <= mesh->face_count);
        for (int f = 0; f < mesh->face_count; ++f) {
            double a[3], b[3];
            ax_face_normal(mesh, f, a);
            ax_face_normal(&soup, f, b);
            assert_near(ax_dot3(a, b), 1, 1e-6);
        }
        // a second time there is nothing to mend
        ax_mesh once = ax_mesh_copy(&soup);
        ax_mesh_repairs nothing;
        assert_int_equal(ax_mesh_make_surface(&soup, &nothing, NULL), AX_OK);
        assert_memory_equal(&nothing, &(ax_mesh_repairs){0}, sizeof nothing);
        assert_memory_equal(soup.faces, once.faces, (size_t)once.face_count * sizeof *once.faces);
        assert_memory_equal(soup.positions, once.positions, (size_t)once.vertex_count * sizeof *once.positions);
        ax_mesh_free(&once);
        ax_mesh_free(&soup);
        ax_mesh_free(&meshes[m]);
    }
}

static double height_of_normals(const ax_mesh* mesh)
{
    double sum = 0;
    for (int f = 0; f < mesh->face_count; ++f) {
        double n[3];
        ax_face_normal(mesh, f, n);
        sum += n[2] * ax_face_area(mesh, f);
    }
    return sum;
}

static void normals_point_to_the_side_of_the_bulge(void** state)
{
    (void)state;
    for (int hanging = 0; hanging < 2; ++hanging)
        for (int turned = 0; turned < 2; ++turned) {
            ax_mesh mesh = shape_cap(8, 1);
            for (int v = 0; hanging && v < mesh.vertex_count; ++v)
                mesh.positions[v][2] *= -1; // now the faces look inside
            for (int f = 0; turned && f < mesh.face_count; ++f)
                turn(mesh.faces[f]);
            ax_mesh_repairs repairs;
            assert_int_equal(ax_mesh_make_surface(&mesh, &repairs, NULL), AX_OK);
            assert_int_equal(repairs.turned_outward, hanging != turned);
            assert_true(hanging ? height_of_normals(&mesh) < 0 : height_of_normals(&mesh) > 0);
            ax_mesh_free(&mesh);
        }
    for (int turned = 0; turned < 2; ++turned) { // it bulges as much to one side as to the other
        ax_mesh mesh = shape_over_disk(10, monkey_saddle);
        for (int f = 0; turned && f < mesh.face_count; ++f)
            turn(mesh.faces[f]);
        assert_int_equal(ax_mesh_make_surface(&mesh, NULL, NULL), AX_OK);
        assert_true(height_of_normals(&mesh) > 0);
        ax_mesh_free(&mesh);
    }
}

static void the_place_of_a_fault_is_given_in_the_numbers_of_the_input(void** state)
{
    (void)state;
    ax_mesh dome = shape_cap(3, 1);
    int n = dome.vertex_count, count = dome.face_count;
    ax_mesh mesh = {.vertex_count = n + 2, .face_count = count + 2};
    mesh.positions = ax_calloc((size_t)n + 2, sizeof *mesh.positions); // vertex 0 is used by no face
    mesh.faces = ax_calloc((size_t)count + 2, sizeof *mesh.faces);
    memcpy(mesh.positions + 1, dome.positions, (size_t)n * sizeof *dome.positions);
    mesh.positions[n + 1][2] = 7;
    mesh.faces[0][0] = mesh.faces[0][1] = 1, mesh.faces[0][2] = 2; // no area
    for (int f = 0; f < count; ++f)
        for (int k = 0; k < 3; ++k)
            mesh.faces[f + 1][k] = dome.faces[f][k] + 1;
    mesh.faces[count + 1][0] = 1, mesh.faces[count + 1][1] = 2, mesh.faces[count + 1][2] = n + 1;
    ax_error error;
    assert_int_equal(ax_mesh_make_surface(&mesh, NULL, &error), AX_BAD_INPUT);
    char expected[64];
    snprintf(expected, sizeof expected, "from vertex 1 (0, 0, 1) to vertex 2 ");
    assert_non_null(strstr(error.message, expected));
    snprintf(expected, sizeof expected, ", %d (counted from 0)", count + 1);
    assert_non_null(strstr(error.message, expected));
    assert_int_equal(mesh.face_count, 0);
    assert_null(mesh.faces);
    ax_mesh_free(&dome);
}

static ax_status refuse(ax_mesh mesh, ax_error* error)
{
    ax_mesh copy = ax_mesh_copy(&mesh);
    ax_status status = ax_mesh_make_surface(&copy, NULL, error);
    ax_mesh_free(&copy);
    return status;
}

static void numbers_that_are_none_are_refused_with_their_place(void** state)
{
    (void)state;
    double corners[5][3] = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {NAN, INFINITY, 0}, {1, 1, 1}};
    int faces[2][3] = {{0, 1, 2}, {1, 4, 2}};
    ax_mesh mesh = {5, 2, corners, faces};
    ax_error error;
    assert_int_equal(refuse(mesh, &error), AX_BAD_INPUT); // for having no inner vertex: what no face uses does no harm
    assert_non_null(strstr(error.message, "2 triangles and no vertex inside"));
    faces[1][1] = 3;
    assert_int_equal(refuse(mesh, &error), AX_BAD_INPUT);
    assert_non_null(strstr(error.message, "triangle 1 (counted from 0), vertex 3 (nan, inf, 0)"));
    faces[1][1] = 5;
    assert_int_equal(refuse(mesh, &error), AX_BAD_INPUT);
    assert_non_null(strstr(error.message, "vertex 5"));
    faces[1][1] = -1;
    assert_int_equal(refuse(mesh, &error), AX_BAD_INPUT);
    assert_non_null(strstr(error.message, "vertex -1"));
    faces[1][1] = 4;
    corners[4][2] = 1e200;
    assert_int_equal(refuse(mesh, &error), AX_BAD_INPUT);
    assert_non_null(strstr(error.message, "too large"));
    for (int v = 0; v < 5; ++v)
        for (int d = 0; d < 3; ++d)
            corners[v][d] = (v + 1) * (d == v % 3) * 1e-100;
    assert_int_equal(refuse(mesh, &error), AX_BAD_INPUT);
    assert_non_null(strstr(error.message, "too small"));
    assert_int_equal(refuse((ax_mesh){0}, &error), AX_BAD_INPUT);
    assert_non_null(strstr(error.message, "no faces"));
}

static void size_and_place_do_not_matter(void** state)
{
    (void)state;
    static const double scales[] = {1e-50, 1e-3, 1, 1e4, 1e50};
    ax_mesh dome = shape_cap(6, 1);
    for (size_t i = 0; i < sizeof scales / sizeof *scales; ++i) {
        ax_mesh mesh = ax_mesh_copy(&dome);
        for (int v = 0; v < mesh.vertex_count; ++v)
            for (int d = 0; d < 3; ++d)
                mesh.positions[v][d] = scales[i] * (mesh.positions[v][d] + 1000 * (d + 1));
        ax_mesh_repairs repairs;
        assert_int_equal(ax_mesh_make_surface(&mesh, &repairs, NULL), AX_OK);
        assert_memory_equal(&repairs, &(ax_mesh_repairs){0}, sizeof repairs);
        assert_memory_equal(mesh.faces, dome.faces, (size_t)dome.face_count * sizeof *dome.faces);
        ax_mesh_free(&mesh);
    }
    ax_mesh_free(&dome);
}

// A tent of four faces round vertex 0, `between` more vertices on edge 0-1 or on the rim edge 1-2, and as many
// triangles without area between the face that knows of them, or the outside, and the one that does not.
static ax_mesh tent(int between, bool on_rim)
{
    ax_mesh mesh = {.vertex_count = 5 + between, .face_count = 0};
    mesh.positions = ax_calloc((size_t)mesh.vertex_count, sizeof *mesh.positions);
    mesh.faces = ax_calloc((size_t)(5 + 2 * between), sizeof *mesh.faces);
    mesh.positions[0][2] = 0.5;
    for (int v = 1; v < 5; ++v)
        mesh.positions[v][0] = cos(v * AX_PI / 2), mesh.positions[v][1] = sin(v * AX_PI / 2);
    int start = on_rim ? 1 : 0, end = start + 1;
    for (int i = 0; i < between; ++i)
        for (int d = 0; d < 3; ++d)
            mesh.positions[5 + i][d] = mesh.positions[start][d] +
                                       (i + 1.0) / (between + 1) * (mesh.positions[end][d] - mesh.positions[start][d]);

    const int whole[4][3] = {{0, 1, 2}, {0, 2, 3}, {0, 3, 4}, {0, 4, 1}};
    for (int f = on_rim ? 0 : 1; f < 4; ++f)
        memcpy(mesh.faces[mesh.face_count++], whole[f], sizeof whole[f]);
    for (int i = 0; i <= between; ++i) {
        int from = i ? 4 + i : start, to = i < between ? 5 + i : end;
        int flat[3] = {start, to, from}, side[3] = {from, to, 2};
        if (on_rim)
            turn(flat);
        if (i)
            memcpy(mesh.faces[mesh.face_count++], flat, sizeof flat);
        if (!on_rim)
            memcpy(mesh.faces[mesh.face_count++], side, sizeof side);
    }
    return mesh;
}

static void heaps_of_faces_without_area_dissolve(void** state)
{
    (void)state;
    for (int on_rim = 0; on_rim < 2; ++on_rim)
        for (int between = 0; between < 20; ++between) {
            ax_mesh mesh = tent(between, on_rim);
            double expected = ax_mesh_area(&mesh);
            ax_mesh_repairs repairs;
            ax_error error = {0};
            if (ax_mesh_make_surface(&mesh, &repairs, &error) != AX_OK)
                fail_msg("%d between: %s", between, error.message);
            assert_near(ax_mesh_area(&mesh), expected, 1e-12);
            assert_int_equal(mesh.vertex_count, 5 + between);
            assert_true(repairs.degenerate_faces >= between);
            for (int f = 0; f < mesh.face_count; ++f)
                assert_true(ax_face_area(&mesh, f) > 1e-3);
            ax_topology topology = ax_topology_make(&mesh);
            assert_int_equal(topology.loop_count, 1);
            assert_int_equal(topology.loop_start[1], on_rim ? 4 + between : 4);
            ax_topology_free(&topology);
            ax_mesh_free(&mesh);
        }
}

// Everything meets in one vertex, everything lies in one plane, everything is there three times: no step may be
// quadratic.
static void a_million_slivers_round_one_vertex_take_seconds(void** state)
{
    (void)state;
    enum { count = 400000, copies = 3 };
    ax_mesh mesh = {.vertex_count = copies * (count + 1), .face_count = copies * count};
    mesh.positions = ax_calloc((size_t)mesh.vertex_count, sizeof *mesh.positions);
    mesh.faces = ax_alloc((size_t)mesh.face_count, sizeof *mesh.faces);
    for (int c = 0, f = 0; c < copies; ++c)
        for (int i = 0; i < count; ++i, ++f) {
            int pole = c * (count + 1);
            double t = 2 * AX_PI * i / count;
            mesh.positions[pole + 1 + i][0] = cos(t);
            mesh.positions[pole + 1 + i][1] = sin(t);
            mesh.faces[f][0] = pole, mesh.faces[f][1] = pole + 1 + i, mesh.faces[f][2] = pole + 1 + (i + 1) % count;
        }
    ax_mesh_repairs repairs;
    double start = ax_seconds();
    assert_int_equal(ax_mesh_make_surface(&mesh, &repairs, NULL), AX_OK);
    double taken = ax_seconds() - start;
    print_message("%d slivers in %.2f s\n", copies * count, taken);
    assert_int_equal(mesh.face_count, count);
    assert_int_equal(repairs.duplicate_faces, (copies - 1) * count);
    assert_at_most(taken, 30);
    ax_mesh_free(&mesh);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_soup_becomes_the_surface_it_came_from),
        cmocka_unit_test(normals_point_to_the_side_of_the_bulge),
        cmocka_unit_test(the_place_of_a_fault_is_given_in_the_numbers_of_the_input),
        cmocka_unit_test(numbers_that_are_none_are_refused_with_their_place),
        cmocka_unit_test(size_and_place_do_not_matter),
        cmocka_unit_test(heaps_of_faces_without_area_dissolve),
        cmocka_unit_test(a_million_slivers_round_one_vertex_take_seconds),
    };
    return cmocka_run_group_tests_name("surface", tests, NULL, NULL);
}
