// The local step: constraints project, loads act, points sum; and the same pass as a measurement.
#include "solver/internal.h"

#include <string.h>

typedef double v4 __attribute__((vector_size(32)));
typedef double lanes4 __attribute__((vector_size(32), aligned(8))); // half the lanes of a block

// Four points to four lanes of x, y and z.
static inline void spread(const v4 p[4], ax_lane3* x, int lane)
{
    v4 xz[2] = {__builtin_shufflevector(p[0], p[1], 0, 4, 2, 6), __builtin_shufflevector(p[2], p[3], 0, 4, 2, 6)};
    v4 yw[2] = {__builtin_shufflevector(p[0], p[1], 1, 5, 3, 7), __builtin_shufflevector(p[2], p[3], 1, 5, 3, 7)};
    *(lanes4*)((*x)[0] + lane) = __builtin_shufflevector(xz[0], xz[1], 0, 1, 4, 5);
    *(lanes4*)((*x)[1] + lane) = __builtin_shufflevector(yw[0], yw[1], 0, 1, 4, 5);
    *(lanes4*)((*x)[2] + lane) = __builtin_shufflevector(xz[0], xz[1], 2, 3, 6, 7);
}

// And back, with zeros as the fourth coordinate.
static inline void collect(const ax_lane3* x, int lane, double scale, v4 p[4])
{
    v4 zero = {0}, c[3];
    for (int k = 0; k < 3; ++k)
        c[k] = scale * *(const lanes4*)((*x)[k] + lane);
    v4 xy[2] = {__builtin_shufflevector(c[0], c[1], 0, 4, 2, 6), __builtin_shufflevector(c[0], c[1], 1, 5, 3, 7)};
    v4 zw[2] = {__builtin_shufflevector(c[2], zero, 0, 4, 2, 6), __builtin_shufflevector(c[2], zero, 1, 5, 3, 7)};
    for (int k = 0; k < 2; ++k) {
        p[k] = __builtin_shufflevector(xy[k], zw[k], 0, 1, 4, 5);
        p[k + 2] = __builtin_shufflevector(xy[k], zw[k], 2, 3, 6, 7);
    }
}

// Places of the points of a block, one lane each.
static void gather(const ax_solver* s, const elements* e, int block, ax_lane3* x)
{
    const int* index = e->index + (size_t)block * (size_t)e->points_each * AX_W;
    for (int k = 0; k < e->points_each; ++k, index += AX_W)
        for (int lane = 0; lane < AX_W; lane += 4) {
            v4 p[4];
            for (int l = 0; l < 4; ++l)
                p[l] = *(const v4*)s->x[index[lane + l]];
            spread(p, x + k, lane);
        }
}

// Rows y of a block of edges, without their ends in between.
static void gather_edges(const ax_solver* s, const elements* e, int block, ax_lane3* y)
{
    const int* index = e->index + (size_t)block * (size_t)e->points_each * AX_W;
    for (int r = 0; r < e->rows_each; ++r, index += 2 * AX_W)
        for (int lane = 0; lane < AX_W; lane += 4) {
            v4 p[4];
            for (int l = 0; l < 4; ++l)
                p[l] = *(const v4*)s->x[index[AX_W + lane + l]] - *(const v4*)s->x[index[lane + l]];
            spread(p, y + r, lane);
        }
}

// Rows y = A x of a block.
static void form_rows(const group* g, const ax_lane3* x, ax_lane3* y)
{
    int n = g->e.points_each;
    switch (g->type->pattern) {
    case AX_ROWS_POINTS:
        memcpy(y, x, (size_t)n * sizeof *y);
        return;
    case AX_ROWS_CENTRED:
        for (int c = 0; c < 3; ++c)
            for (int l = 0; l < AX_W; ++l) {
                double mean = 0;
                for (int k = 0; k < n; ++k)
                    mean += x[k][c][l];
                mean /= n;
                for (int k = 0; k < n; ++k)
                    y[k][c][l] = x[k][c][l] - mean;
            }
        return;
    case AX_ROWS_EDGES: // gathered as such
        return;
    case AX_ROWS_ARMS:
        for (int r = 0; r < n - 1; ++r)
            for (int c = 0; c < 3; ++c)
                for (int l = 0; l < AX_W; ++l)
                    y[r][c][l] = x[r + 1][c][l] - x[0][c][l];
        return;
    case AX_ROWS_SUM:
        memset(y, 0, sizeof *y);
        for (int k = 0; k < n; ++k) {
            double coefficient = g->type->coefficient(n, k);
            for (int c = 0; c < 3; ++c)
                for (int l = 0; l < AX_W; ++l)
                    y[0][c][l] += coefficient * x[k][c][l];
        }
    }
}

// Rows of a block of elements, one vector per point (or edge), for the points to sum.
static void write_rows(ax_solver* s, const elements* e, int block, const ax_lane3* out, double scale)
{
    int rows = e->rows_each;
    ax_vec4* row = s->row + e->first_row + (size_t)block * AX_W * (size_t)rows;
    for (int r = 0; r < rows; ++r)
        for (int lane = 0; lane < AX_W; lane += 4) {
            v4 p[4];
            collect(out + r, lane, scale, p);
            for (int l = 0; l < 4; ++l)
                *(v4*)row[(lane + l) * rows + r] = p[l];
        }
}

// Contributions w A'z per point (per row for edges, whose points take it with opposite signs).
static void write_contributions(ax_solver* s, const group* g, int block, const ax_lane3* z)
{
    int n = g->e.points_each;
    ax_lane3 out[AX_MOST_POINTS];
    switch (g->type->pattern) {
    case AX_ROWS_POINTS:
    case AX_ROWS_EDGES:
    case AX_ROWS_CENTRED: // projections of centred rows are centred, so A'z = z
        write_rows(s, &g->e, block, z, g->weight);
        return;
    case AX_ROWS_ARMS:
        memset(out, 0, sizeof *out);
        for (int r = 0; r < n - 1; ++r)
            for (int c = 0; c < 3; ++c)
                for (int l = 0; l < AX_W; ++l) {
                    out[r + 1][c][l] = z[r][c][l];
                    out[0][c][l] -= z[r][c][l];
                }
        break;
    case AX_ROWS_SUM:
        for (int k = 0; k < n; ++k) {
            double coefficient = g->type->coefficient(n, k);
            for (int c = 0; c < 3; ++c)
                for (int l = 0; l < AX_W; ++l)
                    out[k][c][l] = coefficient * z[0][c][l];
        }
    }
    write_rows(s, &g->e, block, (const ax_lane3*)out, g->weight);
}

// Shortens multipliers longer than the bound, all rows of a constraint alike: centred rows stay centred, forces keep their
// direction.
static int cap_rows(int rows, double cap, int live, ax_lane3* u)
{
    int capped = 0;
    for (int l = 0; l < AX_W; ++l) {
        double most = 0;
        for (int r = 0; r < rows; ++r)
            most = fmax(most, u[r][0][l] * u[r][0][l] + u[r][1][l] * u[r][1][l] + u[r][2][l] * u[r][2][l]);
        if (most <= cap * cap)
            continue;
        double shrink = cap / sqrt(most);
        for (int r = 0; r < rows; ++r)
            for (int c = 0; c < 3; ++c)
                u[r][c][l] *= shrink;
        capped += l < live;
    }
    return capped;
}

// Square sum and largest square over the rows of the live lanes.
static void sum_rows(int rows, int live, const ax_lane3* a, double* sum, double* most)
{
    for (int l = 0; l < live; ++l)
        for (int r = 0; r < rows; ++r) {
            double square = a[r][0][l] * a[r][0][l] + a[r][1][l] * a[r][1][l] + a[r][2][l] * a[r][2][l];
            *sum += square;
            *most = fmax(*most, square);
        }
}

// One chunk of blocks of the active group. A step writes w A'(p - u) and keeps the new multipliers u; a measurement writes w A'u,
// with u = A x - p where there are no multipliers, and keeps nothing.
static void project_chunk(void* context, int chunk)
{
    ax_solver* s = context;
    group* g = s->groups + s->active_group;
    int end = (chunk + 1) * CHUNK < g->e.blocks ? (chunk + 1) * CHUNK : g->e.blocks, rows = g->rows;
    bool tallying = s->tallying, measuring = s->measuring, multipliers = is_hard(s, g);
    tally t = {0};
    ax_lane3 x[AX_MOST_POINTS], y[AX_MOST_POINTS], p[AX_MOST_POINTS], out[AX_MOST_POINTS];
    for (int b = chunk * CHUNK; b < end; ++b) {
        int live = live_lanes(&g->e, b);
        if (g->type->pattern == AX_ROWS_EDGES)
            gather_edges(s, &g->e, b, y);
        else {
            gather(s, &g->e, b, x);
            form_rows(g, (const ax_lane3*)x, y);
        }
        ax_lane3* dual = g->dual + (size_t)b * (size_t)rows;
        if (multipliers)
            for (int r = 0; r < rows; ++r)
                for (int c = 0; c < 3; ++c)
                    for (int l = 0; l < AX_W; ++l)
                        y[r][c][l] += dual[r][c][l];
        g->type->project((const ax_lane*)(g->parameter + (size_t)b * (size_t)g->type->lanes), g->place,
                         g->e.points_each, (const ax_lane3*)y, p);
        if (tallying) { // A x - p
            for (int r = 0; r < rows; ++r)
                for (int c = 0; c < 3; ++c)
                    for (int l = 0; l < AX_W; ++l)
                        out[r][c][l] = y[r][c][l] - p[r][c][l] - (multipliers ? dual[r][c][l] : 0);
            sum_rows(rows, live, (const ax_lane3*)out, &t.primal_square, &t.primal_most);
        }
        if (multipliers || measuring) {
            ax_lane3* u = measuring ? y : dual;
            for (int r = 0; r < rows; ++r)
                for (int c = 0; c < 3; ++c)
                    for (int l = 0; l < AX_W; ++l)
                        u[r][c][l] = y[r][c][l] - p[r][c][l];
            if (multipliers && s->cap > 0)
                t.capped += cap_rows(rows, s->cap, live, u);
            if (measuring) {
                sum_rows(rows, live, (const ax_lane3*)u, &t.dual_square, &t.dual_most);
                memcpy(p, u, (size_t)rows * sizeof *p);
            } else
                for (int r = 0; r < rows; ++r)
                    for (int c = 0; c < 3; ++c)
                        for (int l = 0; l < AX_W; ++l)
                            p[r][c][l] -= u[r][c][l];
        }
        write_contributions(s, g, b, (const ax_lane3*)p);
    }
    if (tallying) {
        t.energy = g->weight * t.primal_square;
        s->tallies[g->e.first_task + chunk] = t;
    }
}

static void act_chunk(void* context, int chunk)
{
    ax_solver* s = context;
    const load* f = s->loads + s->active_load;
    const load_class* c = f->classes + s->active_class;
    int end = (chunk + 1) * CHUNK < c->e.blocks ? (chunk + 1) * CHUNK : c->e.blocks;
    ax_lane3 x[AX_MOST_POINTS], out[AX_MOST_POINTS];
    double energy = 0;
    for (int b = chunk * CHUNK; b < end; ++b) {
        ax_lane potential;
        gather(s, &c->e, b, x);
        f->type->act(f->value, c->area[b], c->e.points_each, (const ax_lane3*)x, out, potential);
        write_rows(s, &c->e, b, (const ax_lane3*)out, s->load_factor);
        for (int l = 0; l < live_lanes(&c->e, b); ++l)
            energy += potential[l];
    }
    if (s->tallying)
        s->tallies[c->e.first_task + chunk] = (tally){.energy = 2 * s->load_factor * energy};
}

static void run_elements(ax_solver* s)
{
    for (int k = 0; k < s->group_count; ++k)
        if (!s->groups[k].type->eliminated && (s->tallying || !is_silent(s->groups + k))) {
            s->active_group = k;
            ax_pool_run(s->pool, project_chunk, s, task_count(&s->groups[k].e));
        }
    for (int k = 0; k < s->load_count; ++k)
        for (int c = 0; s->loads[k].type->follows && c < s->loads[k].class_count; ++c) {
            s->active_load = k, s->active_class = c;
            ax_pool_run(s->pool, act_chunk, s, task_count(&s->loads[k].classes[c].e));
        }
}

// The vector of a row as a point sums it: edges stand with opposite signs at their ends. The sign is data, no branch: it is as good
// as random.
static inline v4 incident_row(const ax_solver* s, int incident)
{
    static const double sign[2] = {1, -1};
    return sign[incident & 1] * *(const v4*)s->row[incident >> 1];
}

// Energy of dead loads at a point and, in a time step, of its distance from where inertia would take it.
static double point_energy(const ax_solver* s, int v)
{
    double energy = s->dead ? -2 * s->load_factor * ax_dot3(s->dead[v], s->x[v]) : 0;
    double h = s->dynamics.time_step;
    for (int c = 0; s->dynamic && c < 3; ++c) {
        double way = s->x[v][c] - s->kept[v][c];
        energy += s->dynamics.mass / (h * h) * way * way;
    }
    return energy;
}

// Right-hand side of one range of points: base plus rows in their fixed order.
static void sum_points(void* context, int task)
{
    ax_solver* s = context;
    int end = (task + 1) * POINTS_PER_TASK < s->n ? (task + 1) * POINTS_PER_TASK : s->n;
    double energy = 0;
    for (int v = task * POINTS_PER_TASK; v < end; ++v) {
        if (s->held[v]) // its row of the matrix is x = x
            continue;
        if (s->tallying)
            energy += point_energy(s, v);
        v4 sum = *(const v4*)s->base[v];
        for (int k = s->step_start[v]; k < s->incident_start[v + 1]; ++k)
            sum += incident_row(s, s->incident[k]);
        *(v4*)s->x[v] = sum;
    }
    if (s->tallying)
        s->tallies[s->point_tallies + task] = (tally){.energy = energy};
}

// Loads minus forces of constraints of one range of points.
static void balance_points(void* context, int task)
{
    ax_solver* s = context;
    int end = (task + 1) * POINTS_PER_TASK < s->n ? (task + 1) * POINTS_PER_TASK : s->n;
    tally t = {0};
    for (int v = task * POINTS_PER_TASK; v < end; ++v) {
        v4 acting, reacting = {0};
        for (int c = 0; c < 4; ++c)
            acting[c] = s->dead ? s->load_factor * s->dead[v][c] : 0;
        t.energy -= 2 * (acting[0] * s->x[v][0] + acting[1] * s->x[v][1] + acting[2] * s->x[v][2]);
        for (int k = s->incident_start[v]; k < s->incident_start[v + 1]; ++k) {
            v4 row = incident_row(s, s->incident[k]);
            if (s->incident[k] >> 1 < s->first_load_row)
                reacting += row;
            else
                acting += row;
        }
        v4 left = acting - reacting;
        *(v4*)s->kept[v] = left;
        if (s->held[v])
            continue;
        t.residual_square += left[0] * left[0] + left[1] * left[1] + left[2] * left[2];
        t.load_square += acting[0] * acting[0] + acting[1] * acting[1] + acting[2] * acting[2];
    }
    s->tallies[s->point_tallies + task] = t;
}

void ax_local_step(ax_solver* s)
{
    run_elements(s);
    ax_pool_run(s->pool, sum_points, s, point_task_count(s));
}

void ax_keep(ax_solver* s)
{
    if (!s->kept)
        s->kept = ax_alloc_aligned((size_t)s->n, sizeof *s->kept);
}

void ax_measure(ax_solver* s)
{
    ax_keep(s);
    ax_sum_dead_loads(s);
    s->measuring = s->tallying = true;
    run_elements(s);
    s->measuring = s->tallying = false;
    ax_pool_run(s->pool, balance_points, s, point_task_count(s));
}

tally ax_sum_tallies(const ax_solver* s, int first, int count)
{
    tally sum = {0};
    for (int k = first; k < first + count; ++k) {
        const tally* t = s->tallies + k;
        sum.energy += t->energy;
        sum.primal_square += t->primal_square, sum.primal_most = fmax(sum.primal_most, t->primal_most);
        sum.dual_square += t->dual_square, sum.dual_most = fmax(sum.dual_most, t->dual_most);
        sum.capped += t->capped;
        sum.residual_square += t->residual_square, sum.load_square += t->load_square;
    }
    return sum;
}

void ax_sum_dead_loads(ax_solver* s)
{
    if (!s->dead_changed)
        return;
    s->dead_changed = false;
    if (!s->dead)
        s->dead = ax_alloc_aligned((size_t)s->n, sizeof *s->dead);
    memset(s->dead, 0, (size_t)s->n * sizeof *s->dead);
    for (int v = 0; s->point_force && v < s->n; ++v)
        memcpy(s->dead[s->position[v]], s->point_force[v], sizeof *s->point_force);
    ax_lane3 x[AX_MOST_POINTS], out[AX_MOST_POINTS];
    for (int k = 0; k < s->load_count; ++k) {
        const load* f = s->loads + k;
        for (int c = 0; !f->type->follows && c < f->class_count; ++c) {
            const elements* e = &f->classes[c].e;
            for (int b = 0; b < e->blocks; ++b) {
                ax_lane potential;
                gather(s, e, b, x);
                f->type->act(f->value, f->classes[c].area[b], e->points_each, (const ax_lane3*)x, out, potential);
                for (int l = 0; l < live_lanes(e, b); ++l)
                    for (int p = 0; p < e->points_each; ++p) {
                        double* to = s->dead[e->index[(b * e->points_each + p) * AX_W + l]];
                        for (int d = 0; d < 3; ++d)
                            to[d] += out[p][d][l];
                    }
            }
        }
    }
}

void ax_pin(ax_solver* s)
{
    for (int k = 0; k < s->group_count; ++k) {
        const group* g = s->groups + k;
        for (int b = 0; g->type->eliminated && b < g->e.blocks; ++b) {
            ax_lane3 x, p;
            gather(s, &g->e, b, &x);
            g->type->project((const ax_lane*)(g->parameter + (size_t)b * (size_t)g->type->lanes), g->place, 1,
                             (const ax_lane3*)&x, &p);
            for (int l = 0; l < live_lanes(&g->e, b); ++l) {
                double* to = s->x[g->e.index[b * AX_W + l]];
                to[0] = p[0][l], to[1] = p[1][l], to[2] = p[2][l];
            }
        }
    }
}
