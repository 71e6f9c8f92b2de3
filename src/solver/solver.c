#include "solver/solver.h"

#include "base/bucket.h"
#include "base/clock.h"
#include "linalg/order.h"

#include <assert.h>
#include <string.h>

enum { CHUNK = 64, POINTS_PER_TASK = 4096 }; // blocks of constraints and points that one task takes

// Constraints of one type and size, AX_W to a block. Their order within the group follows the points in elimination order, so that
// neighbours in memory work on neighbours in space.
typedef struct group {
    const ax_constraint_type* type;
    const ax_place* place;
    int points_each, count, blocks;
    double weight;
    bool soft;          // no multipliers
    int* points;        // count x points_each, as given
    int* slot;          // constraint -> slot; slot / AX_W is its block, slot % AX_W its lane
    int* index;         // per block: [point][lane], places in elimination order; spare lanes repeat the last constraint
    ax_lane* parameter; // per block: type->lanes
    ax_lane3* dual;     // per block: rows
    int first_row;      // of its contributions
    int rows;           // per constraint: rows of A; contributions: rows for edges, else one per point
    int contributions;
} group;

struct ax_solver {
    int n, group_count;
    group* groups;
    ax_pool* pool;
    double (*start)[3]; // rest places as given, for the elimination order
    // everything below in elimination order
    int *order, *position;
    ax_vec4 *x, *base, *momentum, *velocity, *load;
    ax_vec4* row; // contributions w A'p of all constraints
    int row_count;
    int *incident_start, *incident; // per point: contribution row << 1 | sign
    ax_panels* panels;
    ax_dynamics dynamics;
    bool dynamic, multipliers;
    bool pattern_changed, values_changed;
    int active_group;
    ax_solver_counters counters;
};

ax_solver* ax_solver_make(int points, const double (*places)[3], ax_pool* pool)
{
    ax_solver* s = AX_NEW0(ax_solver, 1);
    size_t n = (size_t)points;
    s->n = points;
    s->pool = pool;
    s->start = ax_copy(places, n, sizeof *s->start);
    s->order = AX_NEW(int, points);
    s->position = AX_NEW(int, points);
    s->x = ax_alloc_aligned(n, sizeof *s->x);
    s->base = ax_alloc_aligned(n, sizeof *s->x);
    s->momentum = ax_alloc_aligned(n, sizeof *s->x);
    s->velocity = ax_alloc_aligned(n, sizeof *s->x);
    s->load = ax_alloc_aligned(n, sizeof *s->x);
    memset(s->velocity, 0, n * sizeof *s->x);
    memset(s->load, 0, n * sizeof *s->x);
    for (int v = 0; v < points; ++v)
        s->order[v] = s->position[v] = v;
    s->pattern_changed = s->values_changed = true;
    ax_solver_set_places(s, places);
    return s;
}

static void free_group(group* g)
{
    void* blocks[] = {g->points, g->slot, g->index, g->parameter, g->dual};
    for (size_t k = 0; k < sizeof blocks / sizeof *blocks; ++k)
        ax_free(blocks[k]);
}

void ax_solver_free(ax_solver* s)
{
    if (!s)
        return;
    for (int k = 0; k < s->group_count; ++k)
        free_group(s->groups + k);
    void* blocks[] = {s->groups,   s->start, s->order, s->position,       s->x,       s->base, s->momentum,
                      s->velocity, s->load,  s->row,   s->incident_start, s->incident};
    for (size_t k = 0; k < sizeof blocks / sizeof *blocks; ++k)
        ax_free(blocks[k]);
    ax_panels_free(s->panels);
    ax_free(s);
}

// Places of the points of a block, one lane each.
static void gather(const ax_solver* s, const group* g, int block, ax_lane3* x)
{
    const int* index = g->index + (size_t)block * (size_t)g->points_each * AX_W;
    for (int k = 0; k < g->points_each; ++k)
        for (int l = 0; l < AX_W; ++l) {
            const double* at = s->x[index[k * AX_W + l]];
            x[k][0][l] = at[0], x[k][1][l] = at[1], x[k][2][l] = at[2];
        }
}

// Rows y = A x of a block.
static void form_rows(const group* g, const ax_lane3* x, ax_lane3* y)
{
    int n = g->points_each;
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
    case AX_ROWS_EDGES:
        for (int r = 0; r < n / 2; ++r)
            for (int c = 0; c < 3; ++c)
                for (int l = 0; l < AX_W; ++l)
                    y[r][c][l] = x[2 * r + 1][c][l] - x[2 * r][c][l];
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

// Contributions w A'z per point (per row for edges, whose points take it with opposite signs).
static void form_contributions(const group* g, const ax_lane3* z, ax_lane3* out)
{
    int n = g->points_each;
    double w = g->weight;
    switch (g->type->pattern) {
    case AX_ROWS_POINTS:
    case AX_ROWS_EDGES:
        for (int r = 0; r < g->rows; ++r)
            for (int c = 0; c < 3; ++c)
                for (int l = 0; l < AX_W; ++l)
                    out[r][c][l] = w * z[r][c][l];
        return;
    case AX_ROWS_CENTRED: // projections of centred rows are centred, so A'z = z
        for (int k = 0; k < n; ++k)
            for (int c = 0; c < 3; ++c)
                for (int l = 0; l < AX_W; ++l)
                    out[k][c][l] = w * z[k][c][l];
        return;
    case AX_ROWS_ARMS:
        memset(out, 0, sizeof *out);
        for (int r = 0; r < n - 1; ++r)
            for (int c = 0; c < 3; ++c)
                for (int l = 0; l < AX_W; ++l) {
                    out[r + 1][c][l] = w * z[r][c][l];
                    out[0][c][l] -= w * z[r][c][l];
                }
        return;
    case AX_ROWS_SUM:
        for (int k = 0; k < n; ++k) {
            double coefficient = w * g->type->coefficient(n, k);
            for (int c = 0; c < 3; ++c)
                for (int l = 0; l < AX_W; ++l)
                    out[k][c][l] = coefficient * z[0][c][l];
        }
    }
}

int ax_solver_add(ax_solver* s, const ax_constraint_type* type, int points_each, int count, const int* points,
                  double weight, const ax_place* place)
{
    assert(points_each >= type->least_points && points_each <= type->most_points && points_each <= AX_MOST_POINTS);
    assert(count > 0 && weight > 0);
    s->groups = ax_realloc(s->groups, (size_t)s->group_count + 1, sizeof *s->groups);
    group* g = s->groups + s->group_count;
    *g = (group){.type = type, .place = place, .points_each = points_each, .count = count, .weight = weight};
    g->blocks = (count + AX_W - 1) / AX_W;
    g->rows = ax_row_count(type, points_each);
    g->contributions = type->pattern == AX_ROWS_EDGES ? g->rows : points_each;
    g->points = ax_copy(points, (size_t)count * (size_t)points_each, sizeof *points);
    g->slot = AX_NEW(int, count);
    g->index = AX_NEW(int, (size_t)g->blocks*(size_t)points_each* AX_W);
    g->parameter = ax_alloc_aligned((size_t)g->blocks * (size_t)(type->lanes ? type->lanes : 1), sizeof *g->parameter);
    g->dual = ax_alloc_aligned((size_t)g->blocks * (size_t)g->rows, sizeof *g->dual);
    memset(g->dual, 0, (size_t)g->blocks * (size_t)g->rows * sizeof *g->dual);
    for (int c = 0; c < count; ++c)
        g->slot[c] = c;
    for (int b = 0; b < g->blocks; ++b) {
        ax_lane3 x[AX_MOST_POINTS];
        ax_lane* block = g->parameter + (size_t)b * (size_t)type->lanes;
        for (int l = 0; l < AX_W; ++l) {
            int c = b * AX_W + l < count ? b * AX_W + l : count - 1;
            for (int k = 0; k < points_each; ++k) {
                const double* at = s->x[s->position[points[c * points_each + k]]];
                for (int d = 0; d < 3; ++d)
                    x[k][d][l] = at[d];
            }
        }
        ax_constraint_defaults(type, points_each, block);
        if (type->rest)
            type->rest(block, points_each, (const ax_lane3*)x);
        if (type->prepare)
            type->prepare(block, points_each);
    }
    s->pattern_changed = s->values_changed = true;
    return s->group_count++;
}

void ax_solver_set_weight(ax_solver* s, int k, double weight)
{
    assert(weight > 0);
    s->values_changed = s->values_changed || weight != s->groups[k].weight;
    s->groups[k].weight = weight;
}

void ax_solver_set(ax_solver* s, int k, int constraint, int lane, double value)
{
    group* g = s->groups + k;
    assert(constraint < g->count && lane < g->type->lanes);
    int slot = g->slot[constraint], last = g->count - 1;
    ax_lane* block = g->parameter + (size_t)(slot / AX_W) * (size_t)g->type->lanes;
    block[lane][slot % AX_W] = value;
    for (int l = last % AX_W + 1; slot == last && l < AX_W; ++l)
        block[lane][l] = value; // spare lanes repeat the last constraint
    if (g->type->prepare)
        g->type->prepare(block, g->points_each);
}

void ax_solver_set_all(ax_solver* s, int k, int first, int lanes, const double* values)
{
    group* g = s->groups + k;
    assert(first + lanes <= g->type->lanes);
    size_t each = (size_t)g->type->lanes;
    for (int c = 0; c < g->count; ++c) {
        int slot = g->slot[c];
        ax_lane* block = g->parameter + (size_t)(slot / AX_W) * each + (size_t)first;
        int end = slot == g->count - 1 ? AX_W : slot % AX_W + 1; // spare lanes repeat the last constraint
        for (int i = 0; i < lanes; ++i)
            for (int l = slot % AX_W; l < end; ++l)
                block[i][l] = values[(size_t)c * (size_t)lanes + (size_t)i];
    }
    for (int b = 0; b < g->blocks && g->type->prepare; ++b)
        g->type->prepare(g->parameter + (size_t)b * each, g->points_each);
}

double ax_solver_get(const ax_solver* s, int k, int constraint, int lane)
{
    const group* g = s->groups + k;
    int slot = g->slot[constraint];
    return g->parameter[(size_t)(slot / AX_W) * (size_t)g->type->lanes + (size_t)lane][slot % AX_W];
}

void ax_solver_set_places(ax_solver* s, const double (*places)[3])
{
    for (int v = 0; v < s->n; ++v) {
        double* x = s->x[s->position[v]];
        x[0] = places[v][0], x[1] = places[v][1], x[2] = places[v][2], x[3] = 0;
    }
}

void ax_solver_get_places(const ax_solver* s, double (*places)[3])
{
    for (int v = 0; v < s->n; ++v)
        memcpy(places[v], s->x[s->position[v]], sizeof *places);
}

void ax_solver_set_load(ax_solver* s, const double (*force)[3])
{
    for (int v = 0; v < s->n; ++v)
        for (int c = 0; c < 3; ++c)
            s->load[s->position[v]][c] = force ? force[v][c] : 0;
}

void ax_solver_set_dynamics(ax_solver* s, const ax_dynamics* dynamics)
{
    double before = s->dynamic ? s->dynamics.mass / (s->dynamics.time_step * s->dynamics.time_step) : 0;
    s->dynamics = *dynamics;
    s->dynamic = dynamics->mass > 0;
    double after = s->dynamic ? dynamics->mass / (dynamics->time_step * dynamics->time_step) : 0;
    s->values_changed = s->values_changed || before != after;
}

void ax_solver_use_multipliers(ax_solver* s, bool use)
{
    s->multipliers = use;
}

void ax_solver_reset_multipliers(ax_solver* s)
{
    for (int k = 0; k < s->group_count; ++k) {
        group* g = s->groups + k;
        memset(g->dual, 0, (size_t)g->blocks * (size_t)g->rows * sizeof *g->dual);
    }
}

void ax_solver_set_soft(ax_solver* s, int k, bool soft)
{
    s->groups[k].soft = soft;
}

size_t ax_solver_multiplier_count(const ax_solver* s)
{
    size_t count = 0;
    for (int k = 0; k < s->group_count; ++k)
        count += 3 * (size_t)s->groups[k].count * (size_t)s->groups[k].rows;
    return count;
}

// Multiplier of one row of a constraint, coordinate c.
static double* multiplier(const group* g, int constraint, int row, int c)
{
    int slot = g->slot[constraint];
    return g->dual[(size_t)(slot / AX_W) * (size_t)g->rows + (size_t)row][c] + slot % AX_W;
}

void ax_solver_get_multipliers(const ax_solver* s, double* out)
{
    for (int k = 0; k < s->group_count; ++k)
        for (int c = 0; c < s->groups[k].count; ++c)
            for (int r = 0; r < s->groups[k].rows; ++r)
                for (int d = 0; d < 3; ++d)
                    *out++ = *multiplier(s->groups + k, c, r, d);
}

void ax_solver_set_multipliers(ax_solver* s, const double* from)
{
    for (int k = 0; k < s->group_count; ++k)
        for (int c = 0; c < s->groups[k].count; ++c)
            for (int r = 0; r < s->groups[k].rows; ++r)
                for (int d = 0; d < 3; ++d)
                    *multiplier(s->groups + k, c, r, d) = *from++;
}

double ax_solver_multiplier(const ax_solver* s, int k, int constraint)
{
    double most = 0;
    for (int r = 0; r < s->groups[k].rows; ++r) {
        double u[3];
        for (int d = 0; d < 3; ++d)
            u[d] = *multiplier(s->groups + k, constraint, r, d);
        most = fmax(most, ax_norm3(u));
    }
    return most;
}

static double mass_term(const ax_solver* s)
{
    return s->dynamic ? s->dynamics.mass / (s->dynamics.time_step * s->dynamics.time_step) : 0;
}

static ax_sparse assemble(const ax_solver* s)
{
    ax_entries entries = {0};
    for (int v = 0; v < s->n; ++v)
        ax_entries_add(&entries, v, v, mass_term(s));
    for (int k = 0; k < s->group_count; ++k) {
        const group* g = s->groups + k;
        int n = g->points_each;
        double* product = AX_NEW0(double, n* n); // A'A, the same for every constraint of the group
        for (int r = 0; r < g->rows; ++r)
            for (int a = 0; a < n; ++a) {
                double at_a = ax_row_coefficient(g->type, n, r, a);
                for (int b = 0; b <= a && at_a != 0; ++b)
                    product[a * n + b] += at_a * ax_row_coefficient(g->type, n, r, b);
            }
        for (int c = 0; c < g->count; ++c)
            for (int a = 0; a < n; ++a)
                for (int b = 0; b <= a; ++b)
                    if (product[a * n + b] != 0) {
                        int i = g->points[c * n + a], j = g->points[c * n + b];
                        // a point that stands twice in a constraint meets itself: both halves fall on the diagonal
                        double twice = a != b && i == j ? 2 : 1;
                        ax_entries_add(&entries, i, j, twice * g->weight * product[a * n + b]);
                    }
        ax_free(product);
    }
    return ax_entries_sparse(&entries, s->n);
}

// Moves all per-point state to a new elimination order.
static void reorder(ax_solver* s, const int* order)
{
    int* position = AX_NEW(int, s->n);
    for (int k = 0; k < s->n; ++k)
        position[order[k]] = k;
    ax_vec4** states[] = {&s->x, &s->velocity, &s->load};
    for (int k = 0; k < 3; ++k) {
        ax_vec4 *from = *states[k], *to = ax_alloc_aligned((size_t)s->n, sizeof *to);
        for (int v = 0; v < s->n; ++v)
            memcpy(to[position[v]], from[s->position[v]], sizeof *to);
        ax_free(from);
        *states[k] = to;
    }
    memcpy(s->order, order, (size_t)s->n * sizeof *order);
    ax_free(s->position);
    s->position = position;
}

// Sorts the constraints of a group along the elimination order, and carries parameters and multipliers with them.
static void sort_group(ax_solver* s, group* g)
{
    int n = g->points_each;
    size_t lanes = (size_t)g->type->lanes, rows = (size_t)g->rows, blocks = (size_t)g->blocks;
    int *first = AX_NEW(int, g->count), *start = AX_NEW(int, s->n + 1), *sorted = AX_NEW(int, g->count);
    for (int c = 0; c < g->count; ++c) {
        first[c] = s->n;
        for (int k = 0; k < n; ++k) {
            int at = s->position[g->points[c * n + k]];
            first[c] = at < first[c] ? at : first[c];
        }
    }
    ax_bucket_sort(g->count, s->n, first, NULL, start, sorted);
    ax_lane* parameter = ax_alloc_aligned(blocks * (lanes ? lanes : 1), sizeof *parameter);
    ax_lane3* dual = ax_alloc_aligned(blocks * rows, sizeof *dual);
    for (int slot = 0; slot < g->blocks * AX_W; ++slot) {
        int c = sorted[slot < g->count ? slot : g->count - 1], old = g->slot[c];
        size_t b = (size_t)slot / AX_W, from = (size_t)old / AX_W;
        int l = slot % AX_W, was = old % AX_W;
        for (size_t k = 0; k < lanes; ++k)
            parameter[b * lanes + k][l] = g->parameter[from * lanes + k][was];
        for (size_t r = 0; r < rows; ++r)
            for (int d = 0; d < 3; ++d)
                dual[b * rows + r][d][l] = g->dual[from * rows + r][d][was];
        for (int k = 0; k < n; ++k)
            g->index[(b * (size_t)n + (size_t)k) * AX_W + (size_t)l] = s->position[g->points[c * n + k]];
    }
    for (int slot = 0; slot < g->count; ++slot)
        g->slot[sorted[slot]] = slot;
    ax_free(g->parameter);
    ax_free(g->dual);
    g->parameter = parameter;
    g->dual = dual;
    ax_free(first);
    ax_free(start);
    ax_free(sorted);
}

// Which contributions each point sums, in a fixed order: by group, slot and row.
static void list_incidence(ax_solver* s)
{
    s->row_count = 0;
    for (int k = 0; k < s->group_count; ++k) {
        group* g = s->groups + k;
        g->first_row = s->row_count;
        s->row_count += g->blocks * AX_W * g->contributions;
    }
    ax_free(s->row);
    ax_free(s->incident_start);
    ax_free(s->incident);
    s->row = ax_alloc_aligned((size_t)s->row_count, sizeof *s->row);
    s->incident_start = AX_NEW0(int, s->n + 2);
    for (int pass = 0; pass < 2; ++pass) {
        for (int k = 0; k < s->group_count; ++k) {
            const group* g = s->groups + k;
            bool edges = g->type->pattern == AX_ROWS_EDGES;
            for (int slot = 0; slot < g->count; ++slot)
                for (int p = 0; p < g->points_each; ++p) {
                    int at = g->index[(slot / AX_W * g->points_each + p) * AX_W + slot % AX_W];
                    int row = g->first_row + slot * g->contributions + (edges ? p / 2 : p);
                    if (pass)
                        s->incident[s->incident_start[at + 1]++] = row << 1 | (edges && p % 2 == 0);
                    else
                        ++s->incident_start[at + 2];
                }
        }
        if (pass)
            break;
        for (int v = 0; v <= s->n; ++v)
            s->incident_start[v + 1] += s->incident_start[v];
        s->incident = AX_NEW(int, s->incident_start[s->n + 1]);
    }
}

bool ax_solver_prepare(ax_solver* s)
{
    if (!s->values_changed)
        return true;
    double start = ax_seconds();
    ax_sparse matrix = assemble(s);
    if (s->pattern_changed) {
        int* order = AX_NEW(int, s->n);
        ax_order_by_place(&matrix, (const double(*)[3])s->start, s->pool, order);
        ax_panels_free(s->panels);
        s->panels = ax_panels_analyse(&matrix, order);
        s->counters.factor_entries = ax_panels_entries(s->panels);
        s->counters.bytes_per_solve = ax_panels_bytes(s->panels);
        reorder(s, ax_panels_order(s->panels));
        for (int k = 0; k < s->group_count; ++k)
            sort_group(s, s->groups + k);
        list_incidence(s);
        ++s->counters.analyses;
        s->pattern_changed = false;
        ax_free(order);
    }
    bool sound = ax_panels_factor(s->panels, &matrix, s->pool);
    ++s->counters.factorisations;
    s->values_changed = !sound;
    ax_sparse_free(&matrix);
    s->counters.seconds_prepare += ax_seconds() - start;
    return sound;
}

// Local step of one chunk of blocks of the active group.
static void project_chunk(void* context, int chunk)
{
    ax_solver* s = context;
    group* g = s->groups + s->active_group;
    int end = (chunk + 1) * CHUNK < g->blocks ? (chunk + 1) * CHUNK : g->blocks;
    ax_lane3 x[AX_MOST_POINTS], y[AX_MOST_POINTS], p[AX_MOST_POINTS], out[AX_MOST_POINTS];
    for (int b = chunk * CHUNK; b < end; ++b) {
        gather(s, g, b, x);
        form_rows(g, (const ax_lane3*)x, y);
        ax_lane3* dual = g->dual + (size_t)b * (size_t)g->rows;
        bool hard = s->multipliers && !g->soft;
        if (hard)
            for (int r = 0; r < g->rows; ++r)
                for (int c = 0; c < 3; ++c)
                    for (int l = 0; l < AX_W; ++l)
                        y[r][c][l] += dual[r][c][l];
        g->type->project((const ax_lane*)(g->parameter + (size_t)b * (size_t)g->type->lanes), g->place, g->points_each,
                         (const ax_lane3*)y, p);
        if (hard)
            for (int r = 0; r < g->rows; ++r)
                for (int c = 0; c < 3; ++c)
                    for (int l = 0; l < AX_W; ++l) {
                        dual[r][c][l] = y[r][c][l] - p[r][c][l];
                        p[r][c][l] -= dual[r][c][l];
                    }
        form_contributions(g, (const ax_lane3*)p, out);
        ax_vec4* row = s->row + g->first_row + (size_t)b * AX_W * (size_t)g->contributions;
        for (int l = 0; l < AX_W; ++l)
            for (int r = 0; r < g->contributions; ++r) {
                double* to = row[l * g->contributions + r];
                to[0] = out[r][0][l], to[1] = out[r][1][l], to[2] = out[r][2][l], to[3] = 0;
            }
    }
}

// Right-hand side of one range of points: base plus contributions in their fixed order.
static void sum_points(void* context, int task)
{
    ax_solver* s = context;
    typedef double v4 __attribute__((vector_size(32)));
    int end = (task + 1) * POINTS_PER_TASK < s->n ? (task + 1) * POINTS_PER_TASK : s->n;
    for (int v = task * POINTS_PER_TASK; v < end; ++v) {
        v4 sum = *(const v4*)s->base[v];
        for (int k = s->incident_start[v]; k < s->incident_start[v + 1]; ++k) {
            v4 row = *(const v4*)s->row[s->incident[k] >> 1];
            sum += s->incident[k] & 1 ? -row : row;
        }
        *(v4*)s->x[v] = sum;
    }
}

static void iterate(ax_solver* s)
{
    double start = ax_seconds();
    for (int k = 0; k < s->group_count; ++k) {
        s->active_group = k;
        ax_pool_run(s->pool, project_chunk, s, (s->groups[k].blocks + CHUNK - 1) / CHUNK);
    }
    ax_pool_run(s->pool, sum_points, s, (s->n + POINTS_PER_TASK - 1) / POINTS_PER_TASK);
    double middle = ax_seconds();
    ax_panels_solve(s->panels, s->pool, s->x);
    s->counters.seconds_local += middle - start;
    s->counters.seconds_global += ax_seconds() - middle;
    ++s->counters.iterations;
}

bool ax_solver_iterate(ax_solver* s, int iterations)
{
    if (!ax_solver_prepare(s))
        return false;
    assert(!s->dynamic);
    memcpy(s->base, s->load, (size_t)s->n * sizeof *s->base);
    for (int k = 0; k < iterations; ++k)
        iterate(s);
    return true;
}

bool ax_solver_step(ax_solver* s, int iterations)
{
    if (!ax_solver_prepare(s))
        return false;
    assert(s->dynamic);
    double h = s->dynamics.time_step, m = mass_term(s);
    for (int v = 0; v < s->n; ++v)
        for (int c = 0; c < 4; ++c) {
            double a = c < 3 ? s->dynamics.acceleration[c] : 0;
            s->momentum[v][c] = s->x[v][c]; // the place before the step, needed for the velocity
            s->x[v][c] = s->x[v][c] + h * s->velocity[v][c] + h * h * a;
            s->base[v][c] = m * s->x[v][c] + s->load[v][c];
        }
    for (int k = 0; k < iterations; ++k)
        iterate(s);
    for (int v = 0; v < s->n; ++v)
        for (int c = 0; c < 4; ++c)
            s->velocity[v][c] = s->dynamics.damping * (s->x[v][c] - s->momentum[v][c]) / h;
    return true;
}

// Sum of |A x - p|^2 over the rows of a group, spare lanes left out.
static double group_error(ax_solver* s, const group* g)
{
    double sum = 0;
    ax_lane3 x[AX_MOST_POINTS], y[AX_MOST_POINTS], p[AX_MOST_POINTS];
    for (int b = 0; b < g->blocks; ++b) {
        gather(s, g, b, x);
        form_rows(g, (const ax_lane3*)x, y);
        g->type->project((const ax_lane*)(g->parameter + (size_t)b * (size_t)g->type->lanes), g->place, g->points_each,
                         (const ax_lane3*)y, p);
        for (int l = 0; l < AX_W && b * AX_W + l < g->count; ++l)
            for (int r = 0; r < g->rows; ++r)
                for (int c = 0; c < 3; ++c)
                    sum += (y[r][c][l] - p[r][c][l]) * (y[r][c][l] - p[r][c][l]);
    }
    return sum;
}

double ax_solver_energy(ax_solver* s)
{
    ax_solver_prepare(s);
    double energy = 0;
    for (int k = 0; k < s->group_count; ++k)
        energy += s->groups[k].weight * group_error(s, s->groups + k);
    for (int v = 0; v < s->n; ++v)
        energy -= 2 * ax_dot3(s->load[v], s->x[v]);
    return energy;
}

double ax_solver_residual(ax_solver* s, int k)
{
    ax_solver_prepare(s);
    const group* g = s->groups + k;
    return sqrt(group_error(s, g) / ((double)g->count * g->rows));
}

ax_solver_counters ax_solver_count(const ax_solver* s)
{
    ax_solver_counters counters = s->counters;
    counters.bytes = (size_t)s->n * (5 * sizeof(ax_vec4) + 3 * sizeof(double) + 3 * sizeof(int)) +
                     (size_t)s->row_count * sizeof *s->row;
    if (s->panels)
        counters.bytes += ax_panels_bytes(s->panels) / 2 + (size_t)s->n * sizeof(ax_vec4);
    if (s->incident_start)
        counters.bytes += (size_t)s->incident_start[s->n] * sizeof *s->incident;
    for (int k = 0; k < s->group_count; ++k) {
        const group* g = s->groups + k;
        size_t each = (size_t)g->points_each * sizeof(int) * AX_W + (size_t)g->type->lanes * sizeof(ax_lane) +
                      (size_t)g->rows * sizeof(ax_lane3);
        counters.bytes += (size_t)g->blocks * each + (size_t)g->count * ((size_t)g->points_each + 1) * sizeof(int);
    }
    return counters;
}
