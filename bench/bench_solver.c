// The projective solver against ShapeOp on the same problems: init, time per iteration, errors, memory, time to exactness.
//
//   bench_solver [--shapeop libShapeOp.so] [--json FILE] [--repeats R] [--iterations N] [--patience SECONDS] [PROBLEM ...]
//
// A problem is dyn:N or static:N (6 N^2 triangles) or a file. Plain local/global iterations in double precision, in turn with
// ShapeOp (the library of Bouaziz et al. and Deuss et al. 2015), loaded from a library built from its own sources with -O3
// -march=native and OpenMP, and left out without it. Acceleration and multipliers have rows of their own. Every measurement is a
// process of its own, so that memory is that of one job. Exactness is given up after --patience seconds (100), errors are followed
// for --iterations (1000), fewer on large problems.
#include "kagome.h"

#include "base/clock.h"
#include "base/vec.h"
#include "solver/solver.h"

#include <dlfcn.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

enum {
    CHUNK = 10, // iterations between two looks at the error: whole time steps
    MOST_REPEATS = 25,
    MOST_PROBLEMS = 32,
    MOST_CLASSES = 16,
    MARKS = 5,
    WINDOW = 5,             // of Anderson acceleration
    MOST_COMPARED = 310000, // triangles up to which ShapeOp is run
};
static const int marks[MARKS] = {10, 30, 100, 300, 1000};
static const double WORK = 1e8; // triangles x iterations that errors are followed for

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
        fprintf(stderr, "ShapeOp is left out: %s\n", dlerror());
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
            fprintf(stderr, "ShapeOp is left out: %s has no %s\n", path, name);
            return false;
        }
    }
    return true;
}

static void* make_shapeop(const shapeop* api, const kagome* k)
{
    void* solver = api->create();
    api->set_points(solver, k->regular[0], k->vertices); // constraints learn from the regular patch
    for (int e = 0; e < k->edges; ++e) {
        int id = api->add_constraint(solver, "EdgeStrain", k->edge[e], 2, k->stiffness[e] * k->rest[e] * k->rest[e]);
        api->edit_constraint(solver, "EdgeStrain", id, (double[]){k->rest[e], 1, 1}, 3);
    }
    for (int f = 0; f < k->fixed; ++f)
        api->add_constraint(solver, "Closeness", &k->fixed_vertex[f], 1, k->w_fixed);
    if (!k->dynamic)
        for (int h = 0; h < k->hexagons; ++h)
            api->add_constraint(solver, "Circle", k->hexagon[h], 6, k->w_circle);
    else
        api->add_gravity(solver, (double*)k->gravity);
    api->set_points(solver, k->start[0], k->vertices);
    return solver;
}

static void init_shapeop(const shapeop* api, void* solver, const kagome* k)
{
    if (k->dynamic)
        api->init_dynamic(solver, k->mass, k->damping, k->time_step);
    else
        api->init(solver);
}

static void die(const char* what)
{
    fprintf(stderr, "bench_solver: %s\n", what);
    exit(1);
}

static void add_edges(ax_solver* solver, const kagome* k)
{
    const ax_constraint_type* type = ax_constraint_find("edge_length");
    int length = ax_parameter_find(type, "length")->offset, *points = AX_NEW(int, 2 * k->edges), classes = 0;
    double stiffness[MOST_CLASSES], *rest = AX_NEW(double, k->edges);
    for (int e = 0; e < k->edges; ++e) { // groups have one weight each
        int c = 0;
        while (c < classes && stiffness[c] != k->stiffness[e])
            ++c;
        if (c == MOST_CLASSES)
            die("more than 16 different stiffnesses");
        if (c == classes)
            stiffness[classes++] = k->stiffness[e];
    }
    for (int c = 0; c < classes; ++c) {
        int count = 0;
        for (int e = 0; e < k->edges; ++e)
            if (k->stiffness[e] == stiffness[c]) {
                points[2 * count] = k->edge[e][0], points[2 * count + 1] = k->edge[e][1];
                rest[count++] = k->rest[e];
            }
        int group = ax_solver_add(solver, type, 2, count, points, stiffness[c], NULL);
        ax_solver_set_all(solver, group, length, 1, rest);
    }
    ax_free(points);
    ax_free(rest);
}

// The same energy as ShapeOp's, or the edges and the rim alone, to be met exactly.
static ax_solver* make_ours(const kagome* k, ax_pool* pool, bool exact)
{
    const double(*places)[3] = (const double(*)[3])(k->regular ? k->regular : k->start);
    ax_solver* solver = ax_solver_make(k->vertices, places, pool);
    ax_solver_set_places(solver, (const double(*)[3])k->start);
    add_edges(solver, k);
    ax_solver_add(solver, ax_constraint_find("closeness"), 1, k->fixed, k->fixed_vertex, k->w_fixed, NULL);
    if (exact)
        ax_solver_use_multipliers(solver, true);
    else if (k->dynamic) {
        const double* g = k->gravity;
        ax_solver_set_dynamics(solver, &(ax_dynamics){k->mass, k->time_step, k->damping, {g[0], g[1], g[2]}});
    } else
        ax_solver_add(solver, ax_constraint_find("circle"), 6, k->hexagons, k->hexagon[0], k->w_circle, NULL);
    return solver;
}

static void advance(ax_solver* solver, const kagome* k, int iterations)
{
    if (!k->dynamic)
        ax_solver_iterate(solver, iterations);
    else
        for (int step = 0; step < iterations / k->inner; ++step)
            ax_solver_step(solver, k->inner);
}

static void advance_shapeop(const shapeop* api, void* solver, const kagome* k, int iterations)
{
    if (!k->dynamic)
        api->solve(solver, (unsigned)iterations);
    else
        for (int step = 0; step < iterations / k->inner; ++step)
            api->solve(solver, (unsigned)k->inner);
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

// What one measurement sends to the process that asked. Zero: not measured.
typedef struct row {
    int threads;
    double init, factorise, ms, local, global, entries, bytes_per_solve, bandwidth;
    double shapeop_init, shapeop_ms;
    double max[MARKS], rms[MARKS], shapeop_max[MARKS], shapeop_rms[MARKS];
    double to_milli;                        // seconds of plain iterations, init included, to edge error 1e-3
    double exact_milli, exact, exact_error; // the same with multipliers, to 1e-3 and 1e-10; the last error
    int exact_iterations;
    double peak, shapeop_peak, before; // bytes: largest resident set, and that of the problem alone
} row;

typedef struct job {
    const kagome* k;
    const shapeop* api; // NULL: ours alone
    int threads, repeats, deepest;
    int window;      // of Anderson acceleration, 0: plain iterations
    double patience; // seconds after which exactness is given up
} job;

// Iterations that one timing holds: about a tenth of a second, whole time steps.
static int batch_for(const kagome* k)
{
    int batch = (int)(2e6 / k->triangles);
    batch = batch < k->inner ? k->inner : (batch > 200 ? 200 : batch);
    return batch / k->inner * k->inner;
}

static ax_solver* prepared(const kagome* k, ax_pool* pool, bool exact)
{
    ax_solver* solver = make_ours(k, pool, exact);
    if (!ax_solver_prepare(solver))
        die("the matrix is not positive definite");
    return solver;
}

static void time_init(const job* j, ax_pool* pool, row* r)
{
    double ours[MOST_REPEATS], factorise[MOST_REPEATS], theirs[MOST_REPEATS];
    for (int repeat = 0; repeat < j->repeats; ++repeat) {
        ax_solver* solver = prepared(j->k, pool, false);
        ours[repeat] = ax_solver_count(solver).seconds_prepare;
        factorise[repeat] = ax_solver_count(solver).seconds_factorise;
        ax_solver_free(solver);
        if (j->api) {
            void* other = make_shapeop(j->api, j->k);
            double start = ax_seconds();
            init_shapeop(j->api, other, j->k);
            theirs[repeat] = ax_seconds() - start;
            j->api->delete (other);
        }
    }
    r->init = median(ours, j->repeats);
    r->factorise = median(factorise, j->repeats);
    if (j->api)
        r->shapeop_init = median(theirs, j->repeats);
}

// Init, the same iterations on both in turn with their errors, then timings in turn.
static row run_plain(const job* j)
{
    const kagome* k = j->k;
    ax_pool* pool = ax_pool_make(j->threads);
    row r = {.threads = ax_pool_threads(pool), .bandwidth = read_bandwidth(pool)};
    time_init(j, pool, &r);
    double(*x)[3] = ax_alloc((size_t)k->vertices, sizeof *x), ours[MOST_REPEATS], theirs[MOST_REPEATS];
    ax_solver* solver = prepared(k, pool, false);
    ax_solver_accelerate(solver, j->window);
    void* other = j->api ? make_shapeop(j->api, k) : NULL;
    if (other)
        init_shapeop(j->api, other, k);
    double spent = r.init, start;
    int at = 0;
    for (int done = 0; done < j->deepest;) {
        start = ax_seconds();
        advance(solver, k, CHUNK);
        spent += ax_seconds() - start;
        done += CHUNK;
        if (done > marks[at])
            ++at;
        double max, rms;
        ax_solver_get_places(solver, x);
        kagome_error(k, (const double(*)[3])x, &max, &rms);
        if (max <= 1e-3 && r.to_milli == 0)
            r.to_milli = spent;
        if (done == marks[at]) {
            r.max[at] = max, r.rms[at] = rms;
            if (other) {
                advance_shapeop(j->api, other, k, marks[at] - (at ? marks[at - 1] : 0));
                j->api->get_points(other, x[0], k->vertices);
                kagome_error(k, (const double(*)[3])x, &r.shapeop_max[at], &r.shapeop_rms[at]);
            }
        }
    }
    ax_solver_counters before = ax_solver_count(solver);
    int batch = batch_for(k);
    for (int repeat = 0; repeat < j->repeats; ++repeat) {
        start = ax_seconds();
        advance(solver, k, batch);
        ours[repeat] = (ax_seconds() - start) / batch * 1e3;
        if (other) {
            start = ax_seconds();
            advance_shapeop(j->api, other, k, batch);
            theirs[repeat] = (ax_seconds() - start) / batch * 1e3;
        }
    }
    ax_solver_counters after = ax_solver_count(solver);
    int iterations = after.iterations - before.iterations;
    r.ms = median(ours, j->repeats);
    r.local = (after.seconds_local - before.seconds_local) / iterations * 1e3;
    r.global = (after.seconds_global - before.seconds_global) / iterations * 1e3;
    r.entries = after.factor_entries;
    r.bytes_per_solve = (double)after.bytes_per_solve;
    if (other)
        r.shapeop_ms = median(theirs, j->repeats);
    return r;
}

// Edges and rim by multipliers, from the start of the problem, until all edges are right to 1e-10.
static row run_exact(const job* j)
{
    const kagome* k = j->k;
    ax_pool* pool = ax_pool_make(j->threads);
    row r = {.threads = ax_pool_threads(pool), .exact_error = INFINITY};
    double(*x)[3] = ax_alloc((size_t)k->vertices, sizeof *x), rms;
    ax_solver* solver = prepared(k, pool, true);
    ax_solver_accelerate(solver, j->window);
    double spent = ax_solver_count(solver).seconds_prepare;
    while (r.exact_error > 1e-10 && spent < j->patience) {
        double start = ax_seconds();
        ax_solver_iterate(solver, CHUNK);
        spent += ax_seconds() - start;
        r.exact_iterations += CHUNK;
        ax_solver_get_places(solver, x);
        kagome_error(k, (const double(*)[3])x, &r.exact_error, &rms);
        if (r.exact_error <= 1e-3 && r.exact_milli == 0)
            r.exact_milli = spent;
    }
    if (r.exact_error <= 1e-10)
        r.exact = spent;
    return r;
}

static double resident_peak(void)
{
    struct rusage usage;
    getrusage(RUSAGE_SELF, &usage);
    return (double)usage.ru_maxrss * 1024;
}

static row run_memory(const job* j)
{
    row r = {.before = resident_peak()};
    ax_pool* pool = ax_pool_make(0);
    advance(prepared(j->k, pool, false), j->k, j->k->inner);
    r.peak = resident_peak();
    return r;
}

static row run_shapeop_memory(const job* j)
{
    void* solver = make_shapeop(j->api, j->k);
    init_shapeop(j->api, solver, j->k);
    advance_shapeop(j->api, solver, j->k, j->k->inner);
    return (row){.shapeop_peak = resident_peak()};
}

// Runs a job in a child that ends with it.
static row in_child(row (*run)(const job*), const job* j)
{
    int ends[2], status;
    row r;
    fflush(NULL);
    if (pipe(ends))
        die("no pipe");
    pid_t child = fork();
    if (child < 0)
        die("no process");
    if (child == 0) {
        r = run(j);
        _exit(write(ends[1], &r, sizeof r) != sizeof r);
    }
    close(ends[1]);
    bool sound = read(ends[0], &r, sizeof r) == sizeof r;
    close(ends[0]);
    if (waitpid(child, &status, 0) != child || status || !sound)
        die("a measurement failed");
    return r;
}

typedef struct result {
    char name[64];
    int triangles;
    bool dynamic;
    row one, all, exact, memory, fast, fast_exact; // fast: with Anderson acceleration
} result;

static result measure(const char* name, const kagome* k, const shapeop* api, int repeats, int iterations,
                      double patience)
{
    int deepest = (int)fmin(iterations, WORK / k->triangles) / CHUNK * CHUNK;
    if (k->triangles > MOST_COMPARED || !k->regular)
        api = NULL;
    job alone = {k, NULL, 1, repeats, CHUNK, 0, 0},
        side = {k, api, 0, repeats, deepest < CHUNK ? CHUNK : deepest, 0, patience};
    job fast = {k, NULL, 0, repeats, side.deepest, WINDOW, patience};
    result r = {.triangles = k->triangles, .dynamic = k->dynamic};
    const char* base = strrchr(name, '/');
    snprintf(r.name, sizeof r.name, "%s", base ? base + 1 : name);
    r.memory = in_child(run_memory, &side);
    if (api)
        r.memory.shapeop_peak = in_child(run_shapeop_memory, &side).shapeop_peak;
    r.one = in_child(run_plain, &alone);
    r.all = in_child(run_plain, &side);
    r.exact = in_child(run_exact, &side);
    r.fast = in_child(run_plain, &fast);
    r.fast_exact = in_child(run_exact, &fast);
    return r;
}

static void print_errors(const char* kind, const row* a)
{
    for (int m = 0; m < MARKS && a->rms[m] > 0; ++m) {
        printf("  %s, after %4d: edge error max %.4e rms %.4e", kind, marks[m], a->max[m], a->rms[m]);
        if (a->shapeop_rms[m] > 0)
            printf(", ShapeOp's differ by %.0e / %.0e", fabs(a->max[m] / a->shapeop_max[m] - 1),
                   fabs(a->rms[m] / a->shapeop_rms[m] - 1));
        printf("\n");
    }
    if (a->to_milli > 0)
        printf("  %s, edge error 1e-3: %.3f s\n", kind, a->to_milli);
}

static void print_exact(const char* kind, const row* a)
{
    if (a->exact_iterations == 0)
        return;
    printf("  %s, with multipliers, edges and rim alone: ", kind);
    if (a->exact_milli > 0)
        printf("1e-3 in %.3f s, ", a->exact_milli);
    if (a->exact > 0)
        printf("1e-10 in %.3f s (%d iterations)\n", a->exact, a->exact_iterations);
    else
        printf("%.1e after %d iterations\n", a->exact_error, a->exact_iterations);
}

static void print_result(const result* r)
{
    const row* rows[] = {&r->one, &r->all};
    printf("%s, %d triangles: peak %.0f MB, %.0f bytes a triangle beside the problem", r->name, r->triangles,
           r->memory.peak / 1e6, (r->memory.peak - r->memory.before) / r->triangles);
    if (r->memory.shapeop_peak > 0)
        printf("; ShapeOp %.0f MB", r->memory.shapeop_peak / 1e6);
    printf("\n");
    for (int t = 0; t < 2; ++t) {
        const row* a = rows[t];
        printf("  %d thread%s  init %.4f s (analyse %.4f, factorise %.4f), %.3f ms an iteration (local %.3f, global "
               "%.3f at "
               "%.1f GB/s, %.0f %% of %.1f)\n",
               a->threads, a->threads == 1 ? " " : "s", a->init, a->init - a->factorise, a->factorise, a->ms, a->local,
               a->global, a->bytes_per_solve / a->global / 1e6, a->bytes_per_solve / a->global * 1e5 / a->bandwidth,
               a->bandwidth / 1e9);
        if (a->shapeop_ms > 0)
            printf(
                "             ShapeOp: init %.4f s, %.3f ms: ours %.2f of its init, %.1f times faster an iteration\n",
                a->shapeop_init, a->shapeop_ms, a->init / a->shapeop_init, a->shapeop_ms / a->ms);
    }
    print_errors("plain", &r->all);
    print_errors("accelerated", &r->fast);
    printf("  accelerated: %.3f ms an iteration\n", r->fast.ms);
    print_exact("plain", &r->exact);
    print_exact("accelerated", &r->fast_exact);
    fflush(stdout);
}

static void print_growth(const result* results, int count, FILE* json)
{
    const char* separator = "";
    fprintf(json, "], \"growth\": [");
    for (int a = 0; a < count; ++a)
        for (int b = a + 1; b < count; ++b) {
            const result *x = results + a, *y = results + b;
            if (x->dynamic != y->dynamic || y->triangles <= 2 * x->triangles)
                continue;
            double exponent = log(y->all.ms / x->all.ms) / log((double)y->triangles / x->triangles);
            printf("growth of ms per iteration, %s to %s: exponent %.2f\n", x->name, y->name, exponent);
            fprintf(json, "%s\n  {\"from\": \"%s\", \"to\": \"%s\", \"ms_exponent\": %.3f}", separator, x->name,
                    y->name, exponent);
            separator = ",";
        }
}

static void write_row(FILE* file, const char* name, const row* r)
{
    fprintf(
        file,
        ",\n   \"%s\": {\"threads\": %d, \"init_s\": %.6g, \"analyse_s\": %.6g, \"factorise_s\": %.6g, \"ms\": %.6g, "
        "\"local_ms\": %.6g, \"global_ms\": %.6g, \"factor_entries\": %.0f, \"bytes_per_solve\": %.0f, "
        "\"read_bandwidth\": %.4g, \"read_share\": %.3g",
        name, r->threads, r->init, r->init - r->factorise, r->factorise, r->ms, r->local, r->global, r->entries,
        r->bytes_per_solve, r->bandwidth, r->bytes_per_solve / r->global * 1e3 / r->bandwidth);
    if (r->shapeop_ms > 0)
        fprintf(file, ", \"shapeop_init_s\": %.6g, \"shapeop_ms\": %.6g", r->shapeop_init, r->shapeop_ms);
    if (r->to_milli > 0)
        fprintf(file, ", \"to_1e-3_s\": %.6g", r->to_milli);
    fprintf(file, ", \"errors\": [");
    for (int m = 0; m < MARKS && r->rms[m] > 0; ++m) {
        fprintf(file, "%s{\"iterations\": %d, \"max\": %.9g, \"rms\": %.9g", m ? ", " : "", marks[m], r->max[m],
                r->rms[m]);
        if (r->shapeop_rms[m] > 0)
            fprintf(file, ", \"shapeop_max\": %.9g, \"shapeop_rms\": %.9g", r->shapeop_max[m], r->shapeop_rms[m]);
        fprintf(file, "}");
    }
    fprintf(file, "]}");
}

static void write_exact(FILE* file, const char* name, const row* r)
{
    if (r->exact_iterations == 0)
        return;
    fprintf(file, ",\n   \"%s\": {\"iterations\": %d, \"edge_error\": %.3g", name, r->exact_iterations, r->exact_error);
    if (r->exact_milli > 0)
        fprintf(file, ", \"to_1e-3_s\": %.6g", r->exact_milli);
    if (r->exact > 0)
        fprintf(file, ", \"to_1e-10_s\": %.6g", r->exact);
    fprintf(file, "}");
}

static void write_result(FILE* file, const result* r, bool first)
{
    fprintf(file,
            "%s\n  {\"problem\": \"%s\", \"mode\": \"%s\", \"triangles\": %d, \"peak_bytes\": %.0f, \"problem_bytes\": "
            "%.0f",
            first ? "" : ",", r->name, r->dynamic ? "dyn" : "static", r->triangles, r->memory.peak, r->memory.before);
    if (r->memory.shapeop_peak > 0)
        fprintf(file, ", \"shapeop_peak_bytes\": %.0f", r->memory.shapeop_peak);
    write_row(file, "one_thread", &r->one);
    write_row(file, "all_threads", &r->all);
    write_row(file, "accelerated", &r->fast);
    write_exact(file, "multipliers", &r->exact);
    write_exact(file, "accelerated_multipliers", &r->fast_exact);
    fprintf(file, "}");
}

static bool open_problem(const char* name, kagome* k)
{
    int n, used;
    char mode[8];
    if (sscanf(name, "%7[a-z]:%d%n", mode, &n, &used) == 2 && !name[used] && n >= 2 && n <= 500) {
        *k = kagome_make(n, strcmp(mode, "dyn") == 0);
        return true;
    }
    return kagome_read(name, k);
}

int main(int argc, char** argv)
{
    static const char* const usual[] = {"dyn:13",    "dyn:41",    "dyn:129",    "dyn:224",   "dyn:408",
                                        "static:13", "static:41", "static:129", "static:408"};
    const char *library = NULL, *json = "/dev/null", *names[MOST_PROBLEMS];
    int repeats = 5, iterations = 1000, count = 0;
    double patience = 100;
    for (int k = 1; k < argc; ++k) {
        const char* value = k + 1 < argc ? argv[k + 1] : NULL;
        if (argv[k][0] != '-' && count < MOST_PROBLEMS) {
            names[count++] = argv[k];
            continue;
        }
        if (value && strcmp(argv[k], "--shapeop") == 0)
            library = value;
        else if (value && strcmp(argv[k], "--json") == 0)
            json = value;
        else if (value && strcmp(argv[k], "--repeats") == 0 && atoi(value) > 0 && atoi(value) <= MOST_REPEATS)
            repeats = atoi(value);
        else if (value && strcmp(argv[k], "--iterations") == 0 && atoi(value) > 0)
            iterations = atoi(value);
        else if (value && strcmp(argv[k], "--patience") == 0)
            patience = atof(value);
        else {
            fprintf(stderr,
                    "usage: bench_solver [--shapeop libShapeOp.so] [--json FILE] [--repeats R (1-%d)] "
                    "[--iterations N] [--patience SECONDS] [dyn:N | static:N | FILE ...]\n",
                    MOST_REPEATS);
            return 2;
        }
        ++k;
    }
    if (!count)
        for (; (size_t)count < sizeof usual / sizeof *usual; ++count)
            names[count] = usual[count];
    shapeop api;
    bool compare = library && load_shapeop(library, &api);
    if (!library)
        fprintf(stderr, "ShapeOp is left out: give its shared library with --shapeop\n");
    FILE* file = fopen(json, "w");
    if (!file) {
        perror(json);
        return 1;
    }
    result results[MOST_PROBLEMS];
    fprintf(file, "{\"problems\": [");
    for (int p = 0; p < count; ++p) {
        kagome k;
        if (!open_problem(names[p], &k))
            return 3;
        results[p] = measure(names[p], &k, compare ? &api : NULL, repeats, iterations, patience);
        print_result(results + p);
        write_result(file, results + p, p == 0);
        kagome_free(&k);
    }
    print_growth(results, count, file);
    fprintf(file, "\n]}\n");
    if (fclose(file)) {
        perror(json);
        return 1;
    }
    return 0;
}
