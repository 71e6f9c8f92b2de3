// The projective solver against ShapeOp on the same problems, in one process, in turn.
//
//   bench_solver [--shapeop libShapeOp.so] [--json FILE] [--largest N] [--repeats R]
//
// Plain local/global iterations in double precision. ShapeOp (the library of Bouaziz et al. and Deuss et al. 2015) is loaded
// from the shared library given, built from its own sources with -O3 -march=native and OpenMP, and left out without it.
#include "kagome.h"

#include "base/clock.h"
#include "base/vec.h"
#include "solver/solver.h"

#include <dlfcn.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

enum { INNER = 10, MOST_REPEATS = 25, MARKS = 5 };
static const int marks[MARKS] = {10, 30, 100, 300, 1000};

// The part of ShapeOp's C interface that is needed.
typedef struct shapeop {
    void* (*create)(void);
    void (*delete)(void*);
    int (*init)(void*);
    int (*init_dynamic)(void*, double, double, double);
    int (*solve)(void*, unsigned);
    void (*set_points)(void*, double*, int);
    void (*get_points)(void*, double*, int);
    int (*add_constraint)(void*, const char*, int*, int, double);
    int (*edit_constraint)(void*, const char*, int, const double*, int);
    int (*add_gravity)(void*, double*);
} shapeop;

static bool load_shapeop(const char* path, shapeop* api)
{
    void* library = dlopen(path, RTLD_NOW | RTLD_LOCAL);
    if (!library) {
        printf("ShapeOp is left out: %s\n", dlerror());
        return false;
    }
    static const char* const names[] = {"create",    "delete",    "init",          "initDynamic",    "solve",
                                        "setPoints", "getPoints", "addConstraint", "editConstraint", "addGravityForce"};
    void** slots = (void**)api;
    for (size_t k = 0; k < sizeof names / sizeof *names; ++k) {
        char name[64];
        snprintf(name, sizeof name, "shapeop_%s", names[k]);
        slots[k] = dlsym(library, name);
        if (!slots[k]) {
            printf("ShapeOp is left out: %s has no %s\n", path, name);
            return false;
        }
    }
    return true;
}

static void* make_shapeop(const shapeop* api, const kagome* k, bool dynamic)
{
    void* solver = api->create();
    api->set_points(solver, k->regular[0], k->vertices); // constraints learn from the regular patch
    for (int e = 0; e < k->edges; ++e) {
        int id = api->add_constraint(solver, "EdgeStrain", k->edge[e], 2, 1);
        api->edit_constraint(solver, "EdgeStrain", id, (double[]){k->rest[e], 1, 1}, 3);
    }
    for (int f = 0; f < k->fixed; ++f)
        api->add_constraint(solver, "Closeness", &k->fixed_vertex[f], 1, 100);
    if (!dynamic)
        for (int h = 0; h < k->hexagons; ++h)
            api->add_constraint(solver, "Circle", k->hexagon[h], 6, 0.1);
    else
        api->add_gravity(solver, (double[]){0, 0, -0.02 / (2 * k->n)});
    api->set_points(solver, k->start[0], k->vertices);
    return solver;
}

// The same energy: edges of rest length l weigh 1 / l^2, since ShapeOp's rows are relative and ours absolute.
static ax_solver* make_ours(const kagome* k, bool dynamic, ax_pool* pool)
{
    ax_solver* solver = ax_solver_make(k->vertices, (const double(*)[3])k->regular, pool);
    const ax_constraint_type* edge = ax_constraint_find("edge_length");
    int length = ax_parameter_find(edge, "length")->offset, *points = AX_NEW(int, 2 * k->edges),
        *which = AX_NEW(int, k->edges);
    for (int grown = 0; grown < 2; ++grown) {
        int count = 0;
        for (int e = 0; e < k->edges; ++e)
            if ((k->rest[e] > 1) == grown) {
                points[2 * count] = k->edge[e][0], points[2 * count + 1] = k->edge[e][1];
                which[count++] = e;
            }
        double l = k->rest[which[0]];
        int group = ax_solver_add(solver, edge, 2, count, points, 1 / (l * l), NULL);
        for (int c = 0; c < count; ++c)
            ax_solver_set(solver, group, c, length, k->rest[which[c]]);
    }
    const ax_constraint_type* close = ax_constraint_find("closeness");
    ax_solver_add(solver, close, 1, k->fixed, k->fixed_vertex, 100, NULL); // learns its target from the places
    if (dynamic)
        ax_solver_set_dynamics(solver, &(ax_dynamics){1, 1, 0.95, {0, 0, -0.02 / (2 * k->n)}});
    else
        ax_solver_add(solver, ax_constraint_find("circle"), 6, k->hexagons, k->hexagon[0], 0.1, NULL);
    ax_solver_set_places(solver, (const double(*)[3])k->start);
    ax_free(points);
    ax_free(which);
    return solver;
}

static void advance(ax_solver* solver, bool dynamic, int iterations)
{
    if (!dynamic)
        ax_solver_iterate(solver, iterations);
    else
        for (int step = 0; step < iterations / INNER; ++step)
            ax_solver_step(solver, INNER);
}

static void advance_shapeop(const shapeop* api, void* solver, bool dynamic, int iterations)
{
    if (!dynamic)
        api->solve(solver, (unsigned)iterations);
    else
        for (int step = 0; step < iterations / INNER; ++step)
            api->solve(solver, INNER);
}

static int ascending(const void* a, const void* b)
{
    double x = *(const double*)a, y = *(const double*)b;
    return (x > y) - (x < y);
}

static double median(double* values, int count)
{
    qsort(values, (size_t)count, sizeof *values, ascending);
    return values[count / 2];
}

// Bytes a second that this machine reads, from a sum over an array far larger than any cache, with `pool`.
typedef struct reading {
    const double* data;
    size_t count;
    double sums[64];
} reading;

static void read_part(void* context, int part)
{
    reading* r = context;
    size_t size = r->count / 64, from = (size_t)part * size;
    double sum[8] = {0};
    for (size_t k = from; k < from + size; k += 8)
        for (int l = 0; l < 8; ++l)
            sum[l] += r->data[k + (size_t)l];
    for (int l = 0; l < 8; ++l)
        r->sums[part] += sum[l];
}

static double read_bandwidth(ax_pool* pool)
{
    reading r = {.count = (size_t)1 << 25};
    double* data = AX_NEW(double, r.count);
    for (size_t k = 0; k < r.count; ++k)
        data[k] = (double)k;
    r.data = data;
    double best = 0;
    for (int repeat = 0; repeat < 5; ++repeat) {
        double start = ax_seconds();
        ax_pool_run(pool, read_part, &r, 64);
        best = fmax(best, (double)r.count * sizeof *data / (ax_seconds() - start));
    }
    ax_free(data);
    return best;
}

typedef struct row {
    const char* mode;
    int triangles, threads;
    double init, ms, local, global, bytes_per_triangle, entries, read_share;
    double shapeop_init, shapeop_ms;
    double max[MARKS], rms[MARKS], shapeop_max[MARKS], shapeop_rms[MARKS];
} row;

// Iterations that one timing holds: about a fifth of a second, whole time steps.
static int batch_for(int triangles)
{
    int batch = (int)(2e6 / triangles);
    batch = batch < INNER ? INNER : (batch > 200 ? 200 : batch);
    return batch / INNER * INNER;
}

static row measure(const kagome* k, bool dynamic, ax_pool* pool, const shapeop* api, int repeats, int deepest,
                   double bandwidth)
{
    row r = {.mode = dynamic ? "dyn" : "static", .triangles = k->triangles, .threads = ax_pool_threads(pool)};
    double ours[MOST_REPEATS], theirs[MOST_REPEATS];
    double(*x)[3] = ax_alloc((size_t)k->vertices, sizeof *x);
    int batch = batch_for(k->triangles), done = 0, mark = 0;

    ax_solver* solver = make_ours(k, dynamic, pool);
    double start = ax_seconds(); // analyse and factorise, as ShapeOp's init does
    if (!ax_solver_prepare(solver)) {
        fprintf(stderr, "the matrix is not positive definite\n");
        exit(1);
    }
    r.init = ax_seconds() - start;
    void* other = NULL;
    if (api) {
        other = make_shapeop(api, k, dynamic);
        start = ax_seconds();
        if (dynamic)
            api->init_dynamic(other, 1, 0.95, 1);
        else
            api->init(other);
        r.shapeop_init = ax_seconds() - start;
    }
    // the same iterations on both, in turn: errors at the marks, then timings
    for (; mark < MARKS && marks[mark] <= deepest; ++mark) {
        advance(solver, dynamic, marks[mark] - done);
        ax_solver_get_places(solver, x);
        kagome_error(k, (const double(*)[3])x, &r.max[mark], &r.rms[mark]);
        if (other) {
            advance_shapeop(api, other, dynamic, marks[mark] - done);
            api->get_points(other, x[0], k->vertices);
            kagome_error(k, (const double(*)[3])x, &r.shapeop_max[mark], &r.shapeop_rms[mark]);
        }
        done = marks[mark];
    }
    ax_solver_counters before = ax_solver_count(solver);
    for (int repeat = 0; repeat < repeats; ++repeat) {
        start = ax_seconds();
        advance(solver, dynamic, batch);
        ours[repeat] = (ax_seconds() - start) / batch * 1e3;
        if (other) {
            start = ax_seconds();
            advance_shapeop(api, other, dynamic, batch);
            theirs[repeat] = (ax_seconds() - start) / batch * 1e3;
        }
    }
    ax_solver_counters after = ax_solver_count(solver);
    int iterations = after.iterations - before.iterations;
    r.ms = median(ours, repeats);
    r.local = (after.seconds_local - before.seconds_local) / iterations * 1e3;
    r.global = (after.seconds_global - before.seconds_global) / iterations * 1e3;
    r.entries = after.factor_entries;
    r.bytes_per_triangle = (double)after.bytes / k->triangles;
    r.read_share = (double)after.bytes_per_solve / (r.global * 1e-3) / bandwidth;
    if (other) {
        r.shapeop_ms = median(theirs, repeats);
        api->delete (other);
    }
    ax_solver_free(solver);
    ax_free(x);
    return r;
}

static void print_row(const row* r)
{
    printf("%-6s %9d %d  %8.4f %8.3f %8.3f %8.3f %8.2fM %7.0f %5.0f %%", r->mode, r->triangles, r->threads, r->init,
           r->ms, r->local, r->global, r->entries / 1e6, r->bytes_per_triangle, 100 * r->read_share);
    if (r->shapeop_ms > 0)
        printf("  | %8.4f %8.3f  %5.1fx %5.1fx", r->shapeop_init, r->shapeop_ms, r->shapeop_ms / r->ms,
               r->shapeop_init / r->init);
    printf("\n");
    for (int m = 0; m < MARKS && r->rms[m] > 0; ++m) {
        printf("       after %4d: edge error max %.6e rms %.6e", marks[m], r->max[m], r->rms[m]);
        if (r->shapeop_ms > 0)
            printf(", ShapeOp differs by %.1e / %.1e", fabs(r->max[m] / r->shapeop_max[m] - 1),
                   fabs(r->rms[m] / r->shapeop_rms[m] - 1));
        printf("\n");
    }
    fflush(stdout);
}

static void write_json(FILE* file, const row* rows, int count, double bandwidth[2])
{
    fprintf(file, "{\"read_bandwidth\": [%.4g, %.4g], \"rows\": [", bandwidth[0], bandwidth[1]);
    for (int k = 0; k < count; ++k) {
        const row* r = rows + k;
        fprintf(file,
                "%s\n  {\"mode\": \"%s\", \"triangles\": %d, \"threads\": %d, \"init_s\": %.6g, \"ms\": %.6g, "
                "\"local_ms\": %.6g, "
                "\"global_ms\": %.6g, \"factor_entries\": %.0f, \"bytes_per_triangle\": %.0f, \"read_share\": %.3g, "
                "\"shapeop_init_s\": %.6g, \"shapeop_ms\": %.6g, \"errors\": [",
                k ? "," : "", r->mode, r->triangles, r->threads, r->init, r->ms, r->local, r->global, r->entries,
                r->bytes_per_triangle, r->read_share, r->shapeop_init, r->shapeop_ms);
        for (int m = 0; m < MARKS && r->rms[m] > 0; ++m)
            fprintf(file, "%s[%d, %.9g, %.9g, %.9g, %.9g]", m ? ", " : "", marks[m], r->max[m], r->rms[m],
                    r->shapeop_max[m], r->shapeop_rms[m]);
        fprintf(file, "]}");
    }
    fprintf(file, "\n]}\n");
}

int main(int argc, char** argv)
{
    const char *library = NULL, *json = NULL;
    int largest = 224, repeats = 5;
    for (int k = 1; k < argc; k += 2) {
        if (k + 1 == argc) {
            fprintf(stderr, "%s wants a value\n", argv[k]);
            return 2;
        }
        if (strcmp(argv[k], "--shapeop") == 0)
            library = argv[k + 1];
        else if (strcmp(argv[k], "--json") == 0)
            json = argv[k + 1];
        else if (strcmp(argv[k], "--largest") == 0)
            largest = atoi(argv[k + 1]);
        else if (strcmp(argv[k], "--repeats") == 0)
            repeats = atoi(argv[k + 1]) < MOST_REPEATS ? atoi(argv[k + 1]) : MOST_REPEATS;
        else {
            fprintf(stderr,
                    "usage: bench_solver [--shapeop libShapeOp.so] [--json FILE] [--largest N] [--repeats R]\n");
            return 2;
        }
    }
    shapeop api;
    bool compare = library && load_shapeop(library, &api);
    if (!library)
        printf("ShapeOp is left out: give its shared library with --shapeop\n");
    ax_pool* pools[2] = {ax_pool_make(1), ax_pool_make(0)};
    double bandwidth[2] = {read_bandwidth(pools[0]), read_bandwidth(pools[1])};
    printf("%ld cores; reads %.1f GB/s on one thread, %.1f on %d\n", sysconf(_SC_NPROCESSORS_ONLN), bandwidth[0] / 1e9,
           bandwidth[1] / 1e9, ax_pool_threads(pools[1]));
    printf("mode   triangles threads init s ms/iter    local   global  entries  B/tri  read share | ShapeOp init, ms, "
           "speed, init\n");

    static const int sizes[] = {13, 41, 129, 224, 408};
    row rows[64];
    int count = 0;
    for (int mode = 0; mode < 2; ++mode)
        for (size_t s = 0; s < sizeof sizes / sizeof *sizes && sizes[s] <= largest; ++s) {
            if (mode == 1 && sizes[s] > 129)
                continue; // the static problem asks 100,000 triangles at most
            kagome k = kagome_make(sizes[s], mode == 1);
            for (int t = 0; t < 2; ++t) { // one thread alone; all of them beside ShapeOp, which takes all too
                rows[count] = measure(&k, mode == 0, pools[t], t && compare && sizes[s] <= 224 ? &api : NULL, repeats,
                                      k.triangles > 50000 ? 30 : 300, bandwidth[t]);
                print_row(&rows[count++]);
            }
            kagome_free(&k);
        }
    if (json) {
        FILE* file = fopen(json, "w");
        if (!file) {
            perror(json);
            return 1;
        }
        write_json(file, rows, count, bandwidth);
        fclose(file);
    }
    for (int t = 0; t < 2; ++t)
        ax_pool_free(pools[t]);
    return 0;
}
