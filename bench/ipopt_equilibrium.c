// IPOPT as a yardstick: the equilibrium of an exported design under its load, solved by a general interior-point code.
//
//   ipopt_equilibrium [--json FILE] [--seconds S] DESIGN.json
//
// Minimises -sum f x over the places of free hinges, every edge at its flat length, supports where the simulation holds them, by IPOPT with
// exact second derivatives. It starts from the designed state, so it is told the shape, where our simulation starts from the flat
// sheet. A program of its own that links nothing of the library: IPOPT's licence does not go with that of CHOLMOD's parts.
#include <coin/IpStdCInterface.h>
#include <jansson.h>
#include <math.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

typedef struct problem {
    int hinges, edges;
    int (*edge)[2]; // those with a free end
    double *length, *force, *place, *start, *tension;
    char* held;
    double load, energy_scale; // sum of |f|; document energy of one
} problem;

static void die(const char* what)
{
    fprintf(stderr, "ipopt_equilibrium: %s\n", what);
    exit(2);
}

static void* room(size_t count, size_t size)
{
    void* memory = calloc(count ? count : 1, size);
    if (!memory)
        die("out of memory");
    return memory;
}

// rows x columns numbers of the array `name`.
static double* numbers(json_t* in, const char* name, int columns, int* rows)
{
    json_t* array = json_object_get(in, name);
    *rows = (int)json_array_size(array);
    double* out = room((size_t)(*rows * columns), sizeof *out);
    for (int r = 0; r < *rows; ++r)
        for (int c = 0; c < columns; ++c)
            out[r * columns + c] = json_number_value(json_array_get(json_array_get(array, (size_t)r), (size_t)c));
    return out;
}

// Lengths in mean edges, forces over the load.
static problem read_problem(json_t* design)
{
    problem p = {0};
    int flat_rows, triangles, rows[4];
    double *flat = numbers(design, "flat", 2, &flat_rows), *corner = numbers(design, "triangles", 3, &triangles);
    p.hinges = flat_rows;
    p.start = numbers(design, "deployed", 3, rows);
    p.place = numbers(design, "simulated", 3, rows + 1);
    p.force = numbers(json_object_get(design, "load"), "forces", 3, rows + 2);
    double* axial = numbers(design, "edge_forces", 3, rows + 3);
    if (!flat_rows || rows[0] != flat_rows || rows[1] != flat_rows || rows[2] != flat_rows || rows[3] != triangles)
        die("not an exported design with an exact state under gravity");
    if (strcmp(json_string_value(json_object_get(json_object_get(design, "load"), "kind")), "gravity") != 0)
        die("not deployed by gravity: forces that follow the surface are not in this yardstick");
    p.held = room((size_t)p.hinges, 1);
    size_t at;
    json_t* support;
    json_array_foreach(json_object_get(design, "supports"), at, support) p.held[json_integer_value(support)] = 1;
    p.edge = room((size_t)(3 * triangles), sizeof *p.edge);
    p.length = room((size_t)(3 * triangles), sizeof *p.length);
    p.tension = room((size_t)(3 * triangles), sizeof *p.tension);
    double unit = 0;
    for (int h = 0; h < p.hinges; ++h)
        p.load += hypot(hypot(p.force[3 * h], p.force[3 * h + 1]), p.force[3 * h + 2]);
    for (int e = 0; e < 3 * triangles; ++e) {
        int i = (int)corner[e / 3 * 3 + (e + 1) % 3], j = (int)corner[e / 3 * 3 + (e + 2) % 3];
        double length = hypot(flat[2 * i] - flat[2 * j], flat[2 * i + 1] - flat[2 * j + 1]);
        unit += length / (3 * triangles);
        if (p.held[i] && p.held[j])
            continue;
        p.edge[p.edges][0] = i, p.edge[p.edges][1] = j;
        p.tension[p.edges] = axial[e] / p.load;
        p.length[p.edges++] = length;
    }
    for (int e = 0; e < p.edges; ++e)
        p.length[e] /= unit;
    for (int k = 0; k < 3 * p.hinges; ++k)
        p.start[k] /= unit, p.place[k] /= unit, p.force[k] /= p.load;
    p.energy_scale = p.load * unit;
    free(flat);
    free(corner);
    free(axial);
    return p;
}

static double energy(const problem* p, const double* x)
{
    double sum = 0;
    for (int k = 0; k < 3 * p->hinges; ++k)
        sum -= p->force[k] * x[k];
    return sum;
}

// Largest relative error of an edge, and what loads and edges leave at free hinges, over the load.
static void residuals(const problem* p, const double* x, const double* tension, double* edge, double* force)
{
    double* left = room((size_t)(3 * p->hinges), sizeof *left);
    for (int k = 0; k < 3 * p->hinges; ++k)
        left[k] = -p->force[k];
    *edge = *force = 0;
    for (int e = 0; e < p->edges; ++e) {
        const double *a = x + 3 * p->edge[e][0], *b = x + 3 * p->edge[e][1];
        double d[3] = {a[0] - b[0], a[1] - b[1], a[2] - b[2]};
        *edge = fmax(*edge, fabs(sqrt(d[0] * d[0] + d[1] * d[1] + d[2] * d[2]) / p->length[e] - 1));
        for (int c = 0; c < 3; ++c) {
            left[3 * p->edge[e][0] + c] += tension[e] * d[c] / p->length[e];
            left[3 * p->edge[e][1] + c] -= tension[e] * d[c] / p->length[e];
        }
    }
    for (int k = 0; k < 3 * p->hinges; ++k)
        *force += p->held[k / 3] ? 0 : left[k] * left[k];
    *force = sqrt(*force);
    free(left);
}

static Bool objective(Index n, Number* x, Bool fresh, Number* value, UserDataPtr data)
{
    (void)n, (void)fresh;
    *value = energy(data, x);
    return TRUE;
}

static Bool objective_gradient(Index n, Number* x, Bool fresh, Number* gradient, UserDataPtr data)
{
    const problem* p = data;
    (void)x, (void)fresh;
    for (int k = 0; k < n; ++k)
        gradient[k] = -p->force[k];
    return TRUE;
}

// (|d|^2 / l - l) / 2 per edge: a multiplier is the edge's force, tension positive.
static Bool constraints(Index n, Number* x, Bool fresh, Index m, Number* c, UserDataPtr data)
{
    const problem* p = data;
    (void)n, (void)fresh;
    for (int e = 0; e < m; ++e) {
        double square = 0;
        for (int k = 0; k < 3; ++k) {
            double d = x[3 * p->edge[e][0] + k] - x[3 * p->edge[e][1] + k];
            square += d * d;
        }
        c[e] = (square / p->length[e] - p->length[e]) / 2;
    }
    return TRUE;
}

static Bool jacobian(Index n, Number* x, Bool fresh, Index m, Index count, Index* row, Index* column, Number* values,
                     UserDataPtr data)
{
    const problem* p = data;
    (void)n, (void)fresh, (void)count;
    for (int e = 0, at = 0; e < m; ++e)
        for (int end = 0; end < 2; ++end)
            for (int k = 0; k < 3; ++k, ++at) {
                int own = 3 * p->edge[e][end] + k;
                if (values)
                    values[at] = (x[own] - x[3 * p->edge[e][1 - end] + k]) / p->length[e];
                else
                    row[at] = e, column[at] = own;
            }
    return TRUE;
}

static Bool hessian(Index n, Number* x, Bool fresh, Number factor, Index m, Number* multiplier, Bool fresh_multiplier,
                    Index count, Index* row, Index* column, Number* values, UserDataPtr data)
{
    const problem* p = data;
    (void)n, (void)x, (void)fresh, (void)factor, (void)fresh_multiplier, (void)count;
    for (int e = 0, at = 0; e < m; ++e)
        for (int k = 0; k < 3; ++k) {
            int i = 3 * p->edge[e][0] + k, j = 3 * p->edge[e][1] + k;
            int rows[3] = {i, j, i > j ? i : j}, columns[3] = {i, j, i > j ? j : i};
            for (int part = 0; part < 3; ++part, ++at)
                if (values)
                    values[at] = (part < 2 ? 1 : -1) * multiplier[e] / p->length[e];
                else
                    row[at] = rows[part], column[at] = columns[part];
        }
    return TRUE;
}

static double seconds(void)
{
    struct timespec now;
    clock_gettime(CLOCK_MONOTONIC, &now);
    return (double)now.tv_sec + 1e-9 * (double)now.tv_nsec;
}

int main(int argc, char** argv)
{
    const char* json = "/dev/null";
    double patience = 60;
    for (; argc > 3; argc -= 2, argv += 2)
        if (strcmp(argv[1], "--json") == 0)
            json = argv[2];
        else if (strcmp(argv[1], "--seconds") == 0)
            patience = atof(argv[2]);
    if (argc != 2)
        die("usage: ipopt_equilibrium [--json FILE] [--seconds S] DESIGN.json");
    json_error_t error;
    json_t* design = json_load_file(argv[1], 0, &error);
    if (!design)
        die(error.text);
    problem p = read_problem(design);
    int n = 3 * p.hinges;
    double *low = room((size_t)n, sizeof *low), *high = room((size_t)n, sizeof *high), *x = room((size_t)n, sizeof *x);
    double *zero = room((size_t)p.edges, sizeof *zero), *tension = room((size_t)p.edges, sizeof *tension);
    for (int k = 0; k < n; ++k) {
        bool held = p.held[k / 3];
        x[k] = held ? p.place[k] : p.start[k];
        low[k] = held ? p.place[k] : -2e19, high[k] = held ? p.place[k] : 2e19;
    }
    IpoptProblem ipopt = CreateIpoptProblem(n, low, high, p.edges, zero, zero, 6 * p.edges, 9 * p.edges, 0, objective,
                                            constraints, objective_gradient, jacobian, hessian);
    AddIpoptNumOption(ipopt, "tol", 1e-10);
    AddIpoptNumOption(ipopt, "max_cpu_time", patience);
    AddIpoptIntOption(ipopt, "print_level", 0);
    AddIpoptStrOption(ipopt, "sb", "yes");
    double start = seconds(), value = 0;
    enum ApplicationReturnStatus status = IpoptSolve(ipopt, x, NULL, &value, tension, NULL, NULL, &p);
    double spent = seconds() - start, edge[2], force[2];
    residuals(&p, p.place, p.tension, &edge[0], &force[0]);
    residuals(&p, x, tension, &edge[1], &force[1]);
    const double ours = energy(&p, p.place) * p.energy_scale, theirs = energy(&p, x) * p.energy_scale;
    double time = json_number_value(json_object_get(json_object_get(design, "report"), "seconds_deploy"));
    const char* ends = status == Solve_Succeeded            ? "converged"
                       : status == Maximum_CpuTime_Exceeded ? "out of time"
                                                            : "gave up";
    printf("%d edges        energy         edge error  force residual  seconds\n", p.edges);
    printf("  auxshell  %18.9g  %10.1e  %14.1e  %7.2f  from the flat sheet\n", ours, edge[0], force[0], time);
    printf("  IPOPT     %18.9g  %10.1e  %14.1e  %7.2f  from the designed state, %s\n", theirs, edge[1], force[1], spent,
           ends);
    FILE* file = fopen(json, "w");
    if (!file) {
        perror(json);
        return 1;
    }
    fprintf(
        file,
        "{\"edges\": %d, \"ours\": {\"energy\": %.12g, \"edge_error\": %.3g, \"force_residual\": %.3g, \"s\": %.6g}, "
        "\"ipopt\": {\"energy\": %.12g, \"edge_error\": %.3g, \"force_residual\": %.3g, \"s\": %.6g, \"ends\": "
        "\"%s\"}}\n",
        p.edges, ours, edge[0], force[0], time, theirs, edge[1], force[1], spent, ends);
    FreeIpoptProblem(ipopt);
    json_decref(design);
    void* blocks[] = {low, high, x, zero, tension, p.edge, p.length, p.force, p.place, p.start, p.tension, p.held};
    for (size_t k = 0; k < sizeof blocks / sizeof *blocks; ++k)
        free(blocks[k]);
    return fclose(file) ? 1 : 0;
}
