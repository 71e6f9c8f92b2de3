#include "support/zoo.h"

#include "support/shapes.h"
#include "support/test.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

static const double pi = 3.14159265358979323846;

enum { places = 64 };

// --- formats ---------------------------------------------------------------------------------------------------------

static void write_obj(FILE* f, const ax_mesh* mesh)
{
    for (int v = 0; v < mesh->vertex_count; ++v)
        fprintf(f, "v %.17g %.17g %.17g\n", mesh->positions[v][0], mesh->positions[v][1], mesh->positions[v][2]);
    for (int t = 0; t < mesh->face_count; ++t)
        fprintf(f, "f %d %d %d\n", mesh->faces[t][0] + 1, mesh->faces[t][1] + 1, mesh->faces[t][2] + 1);
}

static void write_rows(FILE* f, const ax_mesh* mesh)
{
    for (int v = 0; v < mesh->vertex_count; ++v)
        fprintf(f, "%.17g %.17g %.17g\n", mesh->positions[v][0], mesh->positions[v][1], mesh->positions[v][2]);
    for (int t = 0; t < mesh->face_count; ++t)
        fprintf(f, "3 %d %d %d\n", mesh->faces[t][0], mesh->faces[t][1], mesh->faces[t][2]);
}

static void write_off(FILE* f, const ax_mesh* mesh)
{
    fprintf(f, "OFF\n# a comment\n%d %d 0\n", mesh->vertex_count, mesh->face_count);
    write_rows(f, mesh);
}

static void write_ply_header(FILE* f, const ax_mesh* mesh, const char* format)
{
    fprintf(f,
            "ply\nformat %s 1.0\nelement vertex %d\nproperty float x\nproperty float y\nproperty float z\n"
            "element face %d\nproperty list uchar int vertex_indices\nend_header\n",
            format, mesh->vertex_count, mesh->face_count);
}

static void write_ply(FILE* f, const ax_mesh* mesh)
{
    write_ply_header(f, mesh, "ascii");
    write_rows(f, mesh);
}

static void write_point(FILE* f, const double x[3])
{
    float point[3] = {(float)x[0], (float)x[1], (float)x[2]};
    fwrite(point, sizeof point, 1, f);
}

static void write_ply_binary(FILE* f, const ax_mesh* mesh)
{
    write_ply_header(f, mesh, "binary_little_endian");
    for (int v = 0; v < mesh->vertex_count; ++v)
        write_point(f, mesh->positions[v]);
    for (int t = 0; t < mesh->face_count; ++t) {
        fputc(3, f);
        fwrite(mesh->faces[t], sizeof mesh->faces[t], 1, f);
    }
}

static void write_stl(FILE* f, const ax_mesh* mesh)
{
    fprintf(f, "solid with a vertex in its name\n");
    for (int t = 0; t < mesh->face_count; ++t) {
        fprintf(f, "facet normal 0 0 0\n outer loop\n");
        for (int k = 0; k < 3; ++k) {
            const double* x = mesh->positions[mesh->faces[t][k]];
            fprintf(f, "  vertex %.9g %.9g %.9g\n", x[0], x[1], x[2]);
        }
        fprintf(f, " endloop\nendfacet\n");
    }
    fprintf(f, "endsolid with a vertex in its name\n");
}

static void write_stl_binary(FILE* f, const ax_mesh* mesh)
{
    const char header[80] = "solid, says this header, and yet the file is binary";
    const double zero[3] = {0};
    fwrite(header, sizeof header, 1, f);
    fwrite(&mesh->face_count, sizeof mesh->face_count, 1, f);
    for (int t = 0; t < mesh->face_count; ++t) {
        write_point(f, zero);
        for (int k = 0; k < 3; ++k)
            write_point(f, mesh->positions[mesh->faces[t][k]]);
        fwrite("\0", 2, 1, f);
    }
}

void zoo_write(const char* path, const char* format, const ax_mesh* mesh)
{
    static const struct {
        const char* name;
        void (*write)(FILE* f, const ax_mesh* mesh);
    } formats[] = {{"obj", write_obj}, {"off", write_off},
                   {"ply", write_ply}, {"ply binary", write_ply_binary},
                   {"stl", write_stl}, {"stl binary", write_stl_binary}};
    size_t i = 0;
    while (strcmp(format, formats[i].name) != 0)
        assert_true(++i < sizeof formats / sizeof *formats);
    FILE* f = fopen(path, "wb");
    assert_non_null(f);
    formats[i].write(f, mesh);
    assert_int_equal(fclose(f), 0);
}

// --- cages -----------------------------------------------------------------------------------------------------------

static zoo_animal* house(zoo* all, const char* name, ax_status expected, const char* word)
{
    assert_true(all->count < places);
    zoo_animal* animal = &all->animals[all->count++];
    *animal = (zoo_animal){.expected = expected, .word = word};
    snprintf(animal->path, sizeof animal->path, "%s/%s", all->folder, name);
    return animal;
}

static zoo_animal* add(zoo* all, const char* name, ax_status expected, const char* word, ax_mesh mesh)
{
    zoo_animal* animal = house(all, name, expected, word);
    zoo_write(animal->path, "obj", &mesh);
    ax_mesh_free(&mesh);
    return animal;
}

static void add_text(zoo* all, const char* name, const char* word, const char* text)
{
    FILE* f = fopen(house(all, name, AX_BAD_INPUT, word)->path, "wb");
    assert_non_null(f);
    fputs(text, f);
    assert_int_equal(fclose(f), 0);
}

// A dome in the given format without its last bytes.
static void add_cut(zoo* all, const char* name, const char* format, int missing)
{
    ax_mesh dome = shape_cap(5, 1);
    zoo_animal* animal = house(all, name, AX_BAD_INPUT, "cut off");
    zoo_write(animal->path, format, &dome);
    ax_mesh_free(&dome);
    struct stat info;
    assert_int_equal(stat(animal->path, &info), 0);
    assert_int_equal(truncate(animal->path, info.st_size - missing), 0);
}

// --- meshes ----------------------------------------------------------------------------------------------------------

static ax_mesh empty_mesh(int vertices, int faces)
{
    ax_mesh mesh = {.vertex_count = vertices, .face_count = faces};
    mesh.positions = ax_calloc((size_t)vertices, sizeof *mesh.positions);
    mesh.faces = ax_calloc((size_t)faces, sizeof *mesh.faces);
    return mesh;
}

static void set_face(ax_mesh* mesh, int face, int a, int b, int c)
{
    mesh->faces[face][0] = a, mesh->faces[face][1] = b, mesh->faces[face][2] = c;
}

static void set_point(ax_mesh* mesh, int vertex, double x, double y, double z)
{
    mesh->positions[vertex][0] = x, mesh->positions[vertex][1] = y, mesh->positions[vertex][2] = z;
}

static ax_mesh one_triangle(void)
{
    ax_mesh mesh = empty_mesh(3, 1);
    set_point(&mesh, 1, 1, 0, 0);
    set_point(&mesh, 2, 0, 1, 0);
    set_face(&mesh, 0, 0, 1, 2);
    return mesh;
}

// A band round the z-axis; as a Moebius strip it is turned by half a turn on the way and joined upside down.
static ax_mesh band(int around, int across, bool moebius)
{
    ax_mesh mesh = empty_mesh(around * (across + 1), 2 * around * across);
    for (int i = 0; i < around; ++i)
        for (int j = 0; j <= across; ++j) {
            double t = 2 * pi * i / around, s = (double)j / across - 0.5, tilt = moebius ? t / 2 : pi / 2;
            double r = 2 + s * cos(tilt);
            set_point(&mesh, i * (across + 1) + j, r * cos(t), r * sin(t), s * sin(tilt));
        }
    int f = 0;
    for (int i = 0; i < around; ++i)
        for (int j = 0; j < across; ++j) {
            bool last = i + 1 == around;
            int here = i * (across + 1) + j, there = last ? j : here + across + 1, above = there + 1;
            if (last && moebius)
                there = across - j, above = there - 1;
            set_face(&mesh, f++, here, there, above);
            set_face(&mesh, f++, here, above, here + 1);
        }
    return mesh;
}

static ax_mesh octahedron(void)
{
    const int faces[8][3] = {{0, 2, 4}, {2, 1, 4}, {1, 3, 4}, {3, 0, 4}, {2, 0, 5}, {1, 2, 5}, {3, 1, 5}, {0, 3, 5}};
    ax_mesh mesh = empty_mesh(6, 8);
    for (int v = 0; v < 6; ++v)
        mesh.positions[v][v / 2] = v % 2 ? -1 : 1;
    memcpy(mesh.faces, faces, sizeof faces);
    return mesh;
}

// Both meshes in one, which takes them over, the second moved along x.
static ax_mesh joined(ax_mesh a, ax_mesh b, double shift)
{
    ax_mesh mesh = empty_mesh(a.vertex_count + b.vertex_count, a.face_count + b.face_count);
    memcpy(mesh.positions, a.positions, (size_t)a.vertex_count * sizeof *a.positions);
    memcpy(mesh.faces, a.faces, (size_t)a.face_count * sizeof *a.faces);
    for (int v = 0; v < b.vertex_count; ++v)
        set_point(&mesh, a.vertex_count + v, b.positions[v][0] + shift, b.positions[v][1], b.positions[v][2]);
    for (int f = 0; f < b.face_count; ++f)
        for (int k = 0; k < 3; ++k)
            mesh.faces[a.face_count + f][k] = b.faces[f][k] + a.vertex_count;
    ax_mesh_free(&a);
    ax_mesh_free(&b);
    return mesh;
}

// A dome with one more face, which stands on an inner edge or only on the pole.
static ax_mesh with_extra_face(bool on_edge)
{
    ax_mesh mesh = joined(shape_cap(3, 1), one_triangle(), 0);
    int n = mesh.vertex_count;
    for (int v = n - 3; v < n; ++v)
        mesh.positions[v][2] += 3;
    set_face(&mesh, mesh.face_count - 1, 0, on_edge ? 1 : n - 2, n - 1);
    return mesh;
}

static ax_mesh annulus(void)
{
    ax_mesh mesh = shape_cap(4, 1);
    const int pole_faces = 6; // they come first
    mesh.face_count -= pole_faces;
    memmove(mesh.faces, mesh.faces + pole_faces, (size_t)mesh.face_count * sizeof *mesh.faces);
    return mesh;
}

static ax_mesh torus_with_a_hole(void)
{
    enum { n = 12, m = 8 };
    ax_mesh mesh = empty_mesh(n * m, 2 * n * m);
    int f = 0;
    for (int i = 0; i < n; ++i)
        for (int j = 0; j < m; ++j) {
            double t = 2 * pi * i / n, s = 2 * pi * j / m, r = 2 + cos(s);
            set_point(&mesh, i * m + j, r * cos(t), r * sin(t), sin(s));
            int a = i * m + j, b = (i + 1) % n * m + j, c = (i + 1) % n * m + (j + 1) % m, d = i * m + (j + 1) % m;
            set_face(&mesh, f++, a, b, c);
            set_face(&mesh, f++, a, c, d);
        }
    --mesh.face_count;
    return mesh;
}

static void turn(ax_mesh* mesh, int face)
{
    set_face(mesh, face, mesh->faces[face][0], mesh->faces[face][2], mesh->faces[face][1]);
}

static ax_mesh inverted_part(int* turned)
{
    ax_mesh mesh = shape_cap(6, 1);
    *turned = 0;
    for (int f = 0; f < mesh.face_count; ++f)
        if (mesh.positions[mesh.faces[f][0]][0] > 0.1) {
            turn(&mesh, f);
            ++*turned;
        }
    assert_true(2 * *turned < mesh.face_count);
    return mesh;
}

// A vertex in the middle of an inner edge that only one of the faces there knows of, with the triangle without area
// that closes the slit, as some modellers write it; and a face with two equal corners.
static ax_mesh with_slivers(void)
{
    ax_mesh dome = shape_cap(4, 1), mesh = empty_mesh(dome.vertex_count + 1, dome.face_count + 3);
    memcpy(mesh.positions, dome.positions, (size_t)dome.vertex_count * sizeof *dome.positions);
    memcpy(mesh.faces, dome.faces, (size_t)dome.face_count * sizeof *dome.faces);
    int m = dome.vertex_count, f = dome.face_count, a = mesh.faces[0][0], b = mesh.faces[0][1], c = mesh.faces[0][2];
    for (int d = 0; d < 3; ++d)
        mesh.positions[m][d] = 0.5 * (mesh.positions[a][d] + mesh.positions[b][d]);
    set_face(&mesh, 0, a, m, c);
    set_face(&mesh, f, m, b, c);
    set_face(&mesh, f + 1, a, b, m);
    set_face(&mesh, f + 2, a, a, b);
    ax_mesh_free(&dome);
    return mesh;
}

// --- the animals -----------------------------------------------------------------------------------------------------

// The same pyramid with the line ends of other systems, and with lines that go on in the next.
static void add_pyramid(zoo* all, const char* name, const char* end, const char* between)
{
    FILE* f = fopen(house(all, name, AX_OK, NULL)->path, "wb");
    assert_non_null(f);
    fprintf(f, "v 0 0%s1%sv 1 0 0%sv 0 1 0%sv -1 0 0%sv 0 -1 0%s", between, end, end, end, end, end);
    fprintf(f, "f 1 2%s3%sf 1 3 4%sf 1 4 5%sf 1 5 2%s", between, end, end, end, end);
    assert_int_equal(fclose(f), 0);
}

static void add_formats(zoo* all)
{
    ax_mesh dome = shape_cap(5, 1);
    zoo_write(house(all, "dome.obj", AX_OK, NULL)->path, "obj", &dome);
    zoo_write(house(all, "dome.off", AX_OK, NULL)->path, "off", &dome);
    zoo_write(house(all, "dome.ply", AX_OK, NULL)->path, "ply", &dome);
    zoo_write(house(all, "dome-binary.ply", AX_OK, NULL)->path, "ply binary", &dome);
    zoo_animal* text = house(all, "dome.stl", AX_OK, NULL);
    zoo_write(text->path, "stl", &dome);
    zoo_animal* binary = house(all, "dome-binary.stl", AX_OK, NULL);
    zoo_write(binary->path, "stl binary", &dome);
    text->repairs.welded_vertices = binary->repairs.welded_vertices = 3 * dome.face_count - dome.vertex_count;
    ax_mesh_free(&dome);
    add_pyramid(all, "dos.obj", "\r\n", " ");
    add_pyramid(all, "old-mac.obj", "\r", " ");
    add_pyramid(all, "continued.obj", "\n", " \\\n");

    FILE* f = fopen(house(all, "quads.obj", AX_OK, NULL)->path, "wb");
    assert_non_null(f);
    for (int i = 0; i < 5; ++i)
        for (int j = 0; j < 5; ++j)
            fprintf(f, "v %d %d %g\n", i, j, 1 - 0.1 * ((i - 2) * (i - 2) + (j - 2) * (j - 2)));
    fprintf(f, "l 1 2 3\np 7\n"); // no faces, so passed over
    for (int i = 0; i < 4; ++i)
        for (int j = 0; j < 4; ++j)
            fprintf(f, "f %d %d %d %d\n", 5 * i + j + 1, 5 * i + j + 6, 5 * i + j + 7, 5 * i + j + 2);
    assert_int_equal(fclose(f), 0);
}

static void add_mendable(zoo* all)
{
    ax_mesh inside_out = shape_cap(5, 1);
    for (int f = 0; f < inside_out.face_count; ++f)
        turn(&inside_out, f);
    add(all, "inside-out.obj", AX_OK, NULL, inside_out)->repairs.turned_outward = true;
    int turned;
    ax_mesh inverted = inverted_part(&turned);
    add(all, "inverted-half.obj", AX_OK, NULL, inverted)->repairs.flipped_faces = turned;
    add(all, "slivers.obj", AX_OK, NULL, with_slivers())->repairs.degenerate_faces = 2;
    ax_mesh dome = shape_cap(3, 1), back = shape_cap(3, 1);
    int duplicates = back.face_count;
    for (int f = 0; f < duplicates; ++f)
        turn(&back, f);
    add(all, "both-sides.obj", AX_OK, NULL, joined(dome, back, 0))->repairs.duplicate_faces = duplicates;
}

static void add_no_mesh(zoo* all)
{
    const char letter[] = "Dear Sir,\nthis is no mesh at all.\n";
    add_text(all, "empty.obj", "0 bytes", "");
    add_text(all, "letter.obj", "no faces", letter);
    add_text(all, "letter.stl", "no STL file", letter);
    add_text(all, "letter.ply", "no PLY file", letter);
    add_text(all, "letter.off", "no OFF file", letter);
    add_text(all, "letter.txt", "no format", letter);
    add_text(all, "letter", "no format", letter);
    house(all, "missing.obj", AX_BAD_INPUT, "No such file");
    assert_int_equal(mkdir(house(all, "folder.obj", AX_BAD_INPUT, "folder")->path, 0777), 0);
    assert_int_equal(mkfifo(house(all, "pipe.obj", AX_BAD_INPUT, "ordinary")->path, 0666), 0);
    if (geteuid() != 0) // the superuser may read anything
        assert_int_equal(chmod(add(all, "locked.obj", AX_BAD_INPUT, "right", one_triangle())->path, 0), 0);
    FILE* f = fopen(house(all, "a-million-lines.obj", AX_BAD_INPUT, "1000000 lines")->path, "wb");
    assert_non_null(f);
    for (int i = 0; i < 1000000; ++i)
        fputc('\n', f);
    assert_int_equal(fclose(f), 0);
}

static void add_damaged(zoo* all)
{
    add_cut(all, "cut.obj", "obj", 5);
    add_cut(all, "cut.off", "off", 5);
    add_cut(all, "cut.ply", "ply", 5);
    add_cut(all, "cut-binary.ply", "ply binary", 5);
    add_cut(all, "cut.stl", "stl", 70);
    add_cut(all, "cut-binary.stl", "stl binary", 70);
    add_text(all, "points.obj", "no faces", "v 0 0 0\nv 1 0 0\nv 0 1 0\n");
    add_text(all, "edges.obj", "no faces", "v 0 0 0\nv 1 0 0\nv 0 1 0\nl 1 2 3 1\n");
    add_text(all, "nan.obj", "Line 2", "v 0 0 0\nv nan 0 0\nv 0 1 0\nf 1 2 3\n");
    add_text(all, "overflow.obj", "no finite place", "v 0 0 0\nv 1e999 0 0\nv 0 1 0\nf 1 2 3\n");
    add_text(all, "word.obj", "'x' is not a number", "v 0 0 0\nv 1 x 0\nv 0 1 0\nf 1 2 3\n");
    add_text(all, "range.obj", "vertex 7", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 7\n");
    add_text(all, "range.off", "vertex 7", "OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 7\n");
    add_text(all, "range.ply", "vertex 7",
             "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty float z\nelement "
             "face 1\n"
             "property list uchar int vertex_indices\nend_header\n0 0 0\n1 0 0\n0 1 0\n3 0 1 7\n");
    add_text(all, "one-point.obj", "no size", "v 5 5 5\nv 5 5 5\nv 5 5 5\nf 1 2 3\n");
    add_text(all, "one-line.obj", "no area", "v 0 0 0\nv 1 0 0\nv 2 0 0\nf 1 2 3\n");
    ax_mesh far = shape_cap(5, 1);
    for (int v = 0; v < far.vertex_count; ++v)
        far.positions[v][0] += 500000;
    add(all, "far-from-origin.obj", AX_BAD_INPUT, "origin", far);
}

static void add_wrong_kind(zoo* all)
{
    add(all, "one-triangle.obj", AX_BAD_INPUT, "at least 3 triangles", one_triangle());
    add(all, "moebius.obj", AX_BAD_INPUT, "Moebius", band(24, 3, true));
    add(all, "closed.obj", AX_BAD_INPUT, "closed", octahedron());
    add(all, "two-parts.obj", AX_BAD_INPUT, "2 separate parts", joined(shape_cap(4, 1), shape_cap(3, 1), 5));
    add(all, "three-sheets.obj", AX_BAD_INPUT, "3 triangles meet", with_extra_face(true));
    add(all, "pinched.obj", AX_BAD_INPUT, "touches itself", with_extra_face(false));
    add(all, "band.obj", AX_CANNOT_REALISE, "2 boundary loops", band(24, 3, false));
    add(all, "annulus.obj", AX_CANNOT_REALISE, "2 boundary loops", annulus());
    add(all, "torus.obj", AX_CANNOT_REALISE, "1 handle", torus_with_a_hole());
}

void zoo_open(zoo* all)
{
    *all = (zoo){.folder = "/tmp/auxshell-zoo-XXXXXX", .animals = AX_NEW0(zoo_animal, places)};
    assert_non_null(mkdtemp(all->folder));
    add_formats(all);
    add_mendable(all);
    add_no_mesh(all);
    add_damaged(all);
    add_wrong_kind(all);
}

void zoo_close(zoo* all)
{
    for (int i = 0; i < all->count; ++i)
        remove(all->animals[i].path);
    ax_free(all->animals);
    assert_int_equal(rmdir(all->folder), 0);
}
