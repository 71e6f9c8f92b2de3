// Conformal flattening: from arrays in memory to UV, and from an OBJ file to an OBJ file with UV, median of five.
//     bench_flatten [--json FILE] [PATH/TO/bff-command-line]
// With the path to the command line of boundary-first-flattening, that program does the second job in turn with ours.
#include "ax/flatten.h"
#include "base/clock.h"
#include "base/vec.h"

#include <spawn.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/wait.h>
#include <unistd.h>

enum { ROUNDS = 5 };

extern char** environ;

// A dome with waves over an ellipse: concentric rings, ring r of 6 r vertices, 6 rings^2 triangles.
static ax_mesh make_dome(int rings)
{
    ax_mesh mesh = {.vertex_count = 1 + 3 * rings * (rings + 1), .face_count = 6 * rings * rings};
    mesh.positions = ax_calloc((size_t)mesh.vertex_count, sizeof *mesh.positions);
    mesh.faces = ax_alloc((size_t)mesh.face_count, sizeof *mesh.faces);
    int v = 1, f = 0;
    for (int r = 1; r <= rings; ++r)
        for (int k = 0; k < 6 * r; ++k, ++v) {
            double t = 2 * AX_PI * k / (6 * r), s = (double)r / rings;
            mesh.positions[v][0] = s * cos(t);
            mesh.positions[v][1] = 0.6 * s * sin(t);
        }
    for (v = 0; v < mesh.vertex_count; ++v) {
        double *p = mesh.positions[v], x = p[0], y = p[1] / 0.6;
        p[2] = 0.4 * (1 - x * x - y * y) + 0.02 * sin(5 * x) * cos(4 * y);
    }
    for (int r = 1; r <= rings; ++r) {
        int outer = 1 + 3 * r * (r - 1), inner = r == 1 ? 0 : 1 + 3 * (r - 1) * (r - 2);
        int inner_count = r == 1 ? 1 : 6 * (r - 1);
        for (int side = 0; side < 6; ++side)
            for (int k = 0; k < r; ++k) {
                int a = outer + side * r + k, b = outer + (side * r + k + 1) % (6 * r);
                int c = inner + (side * (r - 1) + k) % inner_count, d = inner + (side * (r - 1) + k + 1) % inner_count;
                mesh.faces[f][0] = a, mesh.faces[f][1] = b, mesh.faces[f][2] = c, ++f;
                if (k < r - 1)
                    mesh.faces[f][0] = b, mesh.faces[f][1] = d, mesh.faces[f][2] = c, ++f;
            }
    }
    return mesh;
}

static void die(const char* what)
{
    fprintf(stderr, "bench_flatten: %s\n", what);
    exit(1);
}

static void write_obj(const char* path, const ax_mesh* mesh, const double (*uv)[2])
{
    FILE* file = fopen(path, "w");
    if (!file)
        die("cannot write the test file");
    for (int v = 0; v < mesh->vertex_count; ++v)
        fprintf(file, "v %.9g %.9g %.9g\n", mesh->positions[v][0], mesh->positions[v][1], mesh->positions[v][2]);
    for (int v = 0; uv && v < mesh->vertex_count; ++v)
        fprintf(file, "vt %.9g %.9g\n", uv[v][0], uv[v][1]);
    for (int f = 0; f < mesh->face_count; ++f) {
        int a = mesh->faces[f][0] + 1, b = mesh->faces[f][1] + 1, c = mesh->faces[f][2] + 1;
        if (uv)
            fprintf(file, "f %d/%d %d/%d %d/%d\n", a, a, b, b, c, c);
        else
            fprintf(file, "f %d %d %d\n", a, b, c);
    }
    if (fclose(file))
        die("cannot write the test file");
}

static double in_memory(const ax_mesh* mesh)
{
    ax_error error;
    ax_flattening flat;
    double start = ax_seconds();
    if (ax_flatten(mesh, NULL, &flat, &error) != AX_OK)
        die(error.message);
    double seconds = ax_seconds() - start;
    ax_flattening_free(&flat);
    return seconds;
}

// Seconds for all of it, and for reading alone.
static double file_to_file(const char* input, const char* output, double* reading)
{
    ax_error error;
    ax_mesh mesh;
    ax_flattening flat;
    double start = ax_seconds();
    if (ax_mesh_read(input, NULL, &mesh, NULL, &error) != AX_OK)
        die(error.message);
    *reading = ax_seconds() - start;
    if (ax_flatten(&mesh, NULL, &flat, &error) != AX_OK)
        die(error.message);
    write_obj(output, &mesh, (const double(*)[2])flat.uv);
    double seconds = ax_seconds() - start;
    ax_flattening_free(&flat);
    ax_mesh_free(&mesh);
    return seconds;
}

static double other_program(char* program, char* input, char* output)
{
    char* arguments[] = {program, input, output, NULL};
    pid_t child;
    int status;
    double start = ax_seconds();
    if (posix_spawn(&child, program, NULL, NULL, arguments, environ) || waitpid(child, &status, 0) != child || status)
        die("the other program failed");
    return ax_seconds() - start;
}

static int ascending(const void* a, const void* b)
{
    double x = *(const double*)a, y = *(const double*)b;
    return (x > y) - (x < y);
}

static double median(double* seconds)
{
    qsort(seconds, ROUNDS, sizeof *seconds, ascending);
    return seconds[ROUNDS / 2];
}

static void bench(int rings, char* program, FILE* json)
{
    char folder[] = "/tmp/bench-flatten-XXXXXX", input[64], output[64];
    if (!mkdtemp(folder))
        die("cannot make a folder in /tmp");
    snprintf(input, sizeof input, "%s/dome.obj", folder);
    snprintf(output, sizeof output, "%s/flat.obj", folder);
    ax_mesh mesh = make_dome(rings);
    write_obj(input, &mesh, NULL);
    double memory[ROUNDS], file[ROUNDS], reading[ROUNDS], other[ROUNDS];
    for (int k = 0; k < ROUNDS; ++k) {
        memory[k] = in_memory(&mesh);
        file[k] = file_to_file(input, output, &reading[k]);
        if (program)
            other[k] = other_program(program, input, output);
    }
    double ours = median(file), in = median(memory);
    printf("%9d triangles: memory to UV %6.3f s, file to UV %6.3f s (reading %.3f)", mesh.face_count, in, ours,
           median(reading));
    fprintf(json, "{\"triangles\": %d, \"memory_to_uv_s\": %.6g, \"file_to_uv_s\": %.6g, \"reading_s\": %.6g",
            mesh.face_count, in, ours, median(reading));
    if (program) {
        double theirs = median(other);
        printf("; boundary-first-flattening %6.3f s, %.1f times as long", theirs, theirs / ours);
        fprintf(json, ", \"boundary_first_flattening_s\": %.6g", theirs);
    }
    fprintf(json, "}");
    printf("\n");
    unlink(input);
    unlink(output);
    rmdir(folder);
    ax_mesh_free(&mesh);
}

int main(int argc, char** argv)
{
    const char* json = "/dev/null";
    if (argc > 2 && strcmp(argv[1], "--json") == 0)
        json = argv[2], argc -= 2, argv += 2;
    char* program = argc > 1 ? argv[1] : NULL;
    if (!program || access(program, X_OK))
        printf("No path to an executable bff-command-line was given: timing ours alone.\n"), program = NULL;
    FILE* file = fopen(json, "w");
    if (!file)
        die("cannot write the JSON file");
    fprintf(file, "[");
    bench(129, program, file);
    fprintf(file, ",\n");
    bench(408, program, file);
    fprintf(file, "]\n");
    if (fclose(file))
        die("cannot write the JSON file");
    return 0;
}
