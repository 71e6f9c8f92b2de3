// Reading mesh files: every format gives the same surface, every fault is named, and nothing that a file does stops the
// program.
#include "base/clock.h"
#include "mesh/geometry.h"

#include "support/shapes.h"
#include "support/test.h"
#include "support/zoo.h"

#include <dirent.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/wait.h>
#include <unistd.h>

static zoo animals;

static int open_zoo(void** state)
{
    (void)state;
    zoo_open(&animals);
    return 0;
}

static int close_zoo(void** state)
{
    (void)state;
    zoo_close(&animals);
    return 0;
}

static int open_files(void)
{
    int count = 0;
    DIR* folder = opendir("/proc/self/fd");
    while (readdir(folder))
        ++count;
    closedir(folder);
    return count;
}

static void every_animal_is_read_or_refused_in_words(void** state)
{
    (void)state;
    int files = open_files();
    for (int i = 0; i < animals.count; ++i) {
        const zoo_animal* animal = &animals.animals[i];
        ax_mesh mesh;
        ax_mesh_repairs repairs = {0};
        ax_error error = {0};
        ax_status status = ax_mesh_read(animal->path, NULL, &mesh, &repairs, &error);
        if (status != animal->expected || (animal->word && !strstr(error.message, animal->word)))
            fail_msg("%s gives %d, '%s', not %d, '%s'", animal->path, status, error.message, animal->expected,
                     animal->word ? animal->word : "");
        if (status != AX_OK) {
            assert_int_equal(error.status, status);
            assert_non_null(strstr(error.message, animal->path));
            assert_int_equal(error.message[strlen(error.message) - 1], '.');
            assert_null(mesh.positions);
            assert_null(mesh.faces);
        } else if (memcmp(&repairs, &animal->repairs, sizeof repairs) != 0) {
            fail_msg("%s: welded %d, degenerate %d, duplicate %d, unused %d, flipped %d, turned %d", animal->path,
                     repairs.welded_vertices, repairs.degenerate_faces, repairs.duplicate_faces,
                     repairs.unused_vertices, repairs.flipped_faces, repairs.turned_outward);
        }
        ax_mesh_free(&mesh);
    }
    assert_int_equal(open_files(), files);
    assert_int_equal(waitpid(-1, NULL, WNOHANG), -1); // no process is left either
}

static void all_formats_give_the_same_surface(void** state)
{
    (void)state;
    static const char* const formats[] = {"obj", "off", "ply", "ply binary", "stl", "stl binary"};
    char folder[] = "/tmp/auxshell-formats-XXXXXX", path[64];
    assert_non_null(mkdtemp(folder));
    ax_mesh dome = shape_paraboloid(7, 0.5);
    for (size_t i = 0; i < sizeof formats / sizeof *formats; ++i) {
        snprintf(path, sizeof path, "%s/dome.%.3s", folder, formats[i]);
        zoo_write(path, formats[i], &dome);
        ax_mesh mesh;
        assert_int_equal(ax_mesh_read(path, NULL, &mesh, NULL, NULL), AX_OK);
        unlink(path);
        assert_int_equal(mesh.vertex_count, dome.vertex_count);
        assert_int_equal(mesh.face_count, dome.face_count);
        for (int f = 0; f < mesh.face_count; ++f) // by corners, for the vertices may be numbered otherwise
            for (int k = 0; k < 3; ++k) {
                const double* x = mesh.positions[mesh.faces[f][k]];
                for (int d = 0; d < 3; ++d) // of single precision, which the importer rounds carelessly
                    assert_near(x[d], dome.positions[dome.faces[f][k]][d], 1.5e-7);
            }
        ax_mesh_free(&mesh);
    }
    ax_mesh_free(&dome);
    assert_int_equal(rmdir(folder), 0);
}

static void slivers_go_without_leaving_a_slit(void** state)
{
    (void)state;
    ax_mesh dome = shape_cap(4, 1), mesh;
    char path[96];
    snprintf(path, sizeof path, "%s/slivers.obj", animals.folder);
    assert_int_equal(ax_mesh_read(path, NULL, &mesh, NULL, NULL), AX_OK);
    assert_near(ax_mesh_area(&mesh), ax_mesh_area(&dome), 1e-6);
    assert_int_equal(mesh.vertex_count, dome.vertex_count + 1);
    ax_mesh_free(&mesh);
    ax_mesh_free(&dome);
}

// Parsing it takes longer and more than the limits in the tests below allow.
static void write_large(char path[64])
{
    snprintf(path, 64, "/tmp/auxshell-large-%d.obj", (int)getpid());
    ax_mesh mesh = shape_cap(300, 1);
    zoo_write(path, "obj", &mesh);
    ax_mesh_free(&mesh);
}

static void reading_stops_at_the_time_limit(void** state)
{
    (void)state;
    char path[64];
    write_large(path);
    ax_mesh mesh;
    ax_error error;
    double start = ax_seconds();
    ax_read_options options = {.seconds = 0.02, .bytes = (size_t)6 << 30};
    assert_int_equal(ax_mesh_read(path, &options, &mesh, NULL, &error), AX_BAD_INPUT);
    assert_non_null(strstr(error.message, "0.02 seconds"));
    assert_at_most(ax_seconds() - start, 5);
    assert_int_equal(waitpid(-1, NULL, WNOHANG), -1);
    unlink(path);
}

#ifndef AX_SANITIZED // sanitizers need more addresses than any limit worth testing
static void reading_stops_at_the_memory_limit(void** state)
{
    (void)state;
    char path[64];
    write_large(path);
    ax_mesh mesh;
    ax_error error;
    ax_read_options options = {.seconds = 60, .bytes = (size_t)128 << 20};
    assert_int_equal(ax_mesh_read(path, &options, &mesh, NULL, &error), AX_BAD_INPUT);
    assert_non_null(strstr(error.message, "memory"));
    unlink(path);
}
#endif

static void a_name_is_neither_option_nor_command(void** state)
{
    (void)state;
    static const char* const names[] = {"-v.obj", "a b;'$(id).obj", "\xc3\xbc.OBJ"};
    char folder[] = "/tmp/auxshell-names-XXXXXX";
    assert_non_null(mkdtemp(folder));
    assert_int_equal(chdir(folder), 0);
    ax_mesh dome = shape_cap(3, 1), mesh;
    for (size_t i = 0; i < sizeof names / sizeof *names; ++i) {
        zoo_write(names[i], "obj", &dome);
        assert_int_equal(ax_mesh_read(names[i], NULL, &mesh, NULL, NULL), AX_OK);
        ax_mesh_free(&mesh);
        unlink(names[i]);
    }
    ax_mesh_free(&dome);
    assert_int_equal(chdir("/"), 0);
    assert_int_equal(rmdir(folder), 0);
}

static void a_million_triangles_are_read_in_seconds(void** state)
{
    (void)state;
    char path[64];
    snprintf(path, sizeof path, "/tmp/auxshell-million-%d.obj", (int)getpid());
    ax_mesh dome = shape_cap(409, 1), mesh;
    zoo_write(path, "obj", &dome);
    double start = ax_seconds();
    assert_int_equal(ax_mesh_read(path, NULL, &mesh, NULL, NULL), AX_OK);
    double taken = ax_seconds() - start;
    print_message("%d triangles read in %.2f s\n", mesh.face_count, taken);
    assert_int_equal(mesh.face_count, dome.face_count);
    assert_int_equal(mesh.vertex_count, dome.vertex_count);
    assert_at_most(taken, 60); // slack for sanitizers and busy machines
    unlink(path);
    ax_mesh_free(&mesh);
    ax_mesh_free(&dome);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(every_animal_is_read_or_refused_in_words),
        cmocka_unit_test(all_formats_give_the_same_surface),
        cmocka_unit_test(slivers_go_without_leaving_a_slit),
        cmocka_unit_test(reading_stops_at_the_time_limit),
#ifndef AX_SANITIZED
        cmocka_unit_test(reading_stops_at_the_memory_limit),
#endif
        cmocka_unit_test(a_name_is_neither_option_nor_command),
        cmocka_unit_test(a_million_triangles_are_read_in_seconds),
    };
    return cmocka_run_group_tests_name("read", tests, open_zoo, close_zoo);
}
