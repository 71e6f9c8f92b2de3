#include "solver/internal.h"

#include "base/bucket.h"
#include "base/clock.h"
#include "linalg/order.h"

#include <assert.h>
#include <string.h>

enum { LEAST_TRIMMED = 200000 }; // points from which what an analysis held is worth giving back

ax_solver* ax_solver_make(int points, const double (*places)[3], ax_pool* pool)
{
    ax_solver* s = AX_NEW0(ax_solver, 1);
    size_t n = (size_t)points;
    s->n = points;
    s->pool = pool;
    s->load_factor = 1;
    s->start = ax_alloc(n, sizeof *s->start);
    s->stiffness = AX_NEW0(double, points);
    s->order = AX_NEW(int, points);
    s->position = AX_NEW(int, points);
    s->held = AX_NEW0(unsigned char, points);
    s->x = ax_alloc_aligned(n, sizeof *s->x);
    s->base = ax_alloc_aligned(n, sizeof *s->x);
    s->velocity = ax_calloc(n, sizeof *s->velocity);
    for (int v = 0; v < points; ++v) {
        s->order[v] = s->position[v] = v;
        for (int c = 0; c < 3; ++c)
            s->start[v][c] = (float)places[v][c];
    }
    s->pattern_changed = s->values_changed = true;
    ax_solver_set_places(s, places);
    return s;
}

static elements make_elements(const ax_solver* s, int points_each, int count, const int* points, int rows_each)
{
    elements e = {.points_each = points_each, .count = count, .rows_each = rows_each};
    e.blocks = (count + AX_W - 1) / AX_W;
    e.slot = AX_NEW(int, count);
    e.index = AX_NEW(int, (size_t)e.blocks*(size_t)points_each* AX_W);
    for (int slot = 0; slot < e.blocks * AX_W; ++slot) {
        int c = slot < count ? slot : count - 1;
        if (slot < count)
            e.slot[c] = slot;
        for (int k = 0; k < points_each; ++k)
            e.index[place_of(&e, slot, k)] = s->position[points[(size_t)c * (size_t)points_each + (size_t)k]];
    }
    return e;
}

static void free_elements(elements* e)
{
    ax_free(e->slot);
    ax_free(e->index);
}

void ax_solver_free(ax_solver* s)
{
    if (!s)
        return;
    for (int k = 0; k < s->group_count; ++k) {
        free_elements(&s->groups[k].e);
        ax_free(s->groups[k].parameter);
        ax_free(s->groups[k].dual);
    }
    for (int k = 0; k < s->load_count; ++k) {
        for (int c = 0; c < s->loads[k].class_count; ++c) {
            free_elements(&s->loads[k].classes[c].e);
            ax_free(s->loads[k].classes[c].area);
        }
        ax_free(s->loads[k].classes);
    }
    void* blocks[] = {s->groups,         s->parts,    s->loads,      s->start,  s->point_force,
                      s->stiffness,      s->order,    s->position,   s->held,   s->x,
                      s->base,           s->velocity, s->kept,       s->dead,   s->row,
                      s->incident_start, s->incident, s->step_start, s->tallies};
    for (size_t k = 0; k < sizeof blocks / sizeof *blocks; ++k)
        ax_free(blocks[k]);
    ax_sparse_free(&s->held_matrix);
    ax_panels_free(s->panels);
    ax_anderson_free(s->anderson);
    ax_free(s);
}

int ax_solver_add(ax_solver* s, const ax_constraint_type* type, int points_each, int count, const int* points,
                  double weight, const ax_place* place)
{
    assert(points_each >= type->least_points && points_each <= type->most_points && points_each <= AX_MOST_POINTS);
    assert(count > 0 && (weight > 0 || type->eliminated));
    assert(!type->eliminated || points_each == 1);
    s->groups = ax_realloc(s->groups, (size_t)s->group_count + 1, sizeof *s->groups);
    s->parts = ax_realloc(s->parts, (size_t)s->group_count + 2, sizeof *s->parts);
    group* g = s->groups + s->group_count;
    *g = (group){.type = type, .place = place, .weight = weight, .rows = ax_row_count(type, points_each)};
    g->e = make_elements(s, points_each, count, points, type->pattern == AX_ROWS_EDGES ? g->rows : points_each);
    size_t blocks = (size_t)g->e.blocks, rows = (size_t)g->rows;
    g->parameter = ax_alloc_aligned(blocks * (size_t)(type->lanes ? type->lanes : 1), sizeof *g->parameter);
    g->dual = ax_calloc(blocks * rows, sizeof *g->dual); // the system gives such memory when it is first written
    for (int b = 0; b < g->e.blocks; ++b) {
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
    s->changed = true;
    assert(weight > 0);
    s->values_changed = s->values_changed || weight != s->groups[k].weight;
    s->groups[k].weight = weight;
}

void ax_solver_set(ax_solver* s, int k, int constraint, int lane, double value)
{
    s->changed = true;
    group* g = s->groups + k;
    assert(constraint < g->e.count && lane < g->type->lanes);
    int slot = g->e.slot[constraint], last = g->e.count - 1;
    ax_lane* block = g->parameter + (size_t)(slot / AX_W) * (size_t)g->type->lanes;
    block[lane][slot % AX_W] = value;
    for (int l = last % AX_W + 1; slot == last && l < AX_W; ++l)
        block[lane][l] = value; // spare lanes repeat the last constraint
    if (g->type->prepare)
        g->type->prepare(block, g->e.points_each);
}

void ax_solver_set_all(ax_solver* s, int k, int first, int lanes, const double* values)
{
    s->changed = true;
    group* g = s->groups + k;
    assert(first + lanes <= g->type->lanes);
    size_t each = (size_t)g->type->lanes;
    for (int c = 0; c < g->e.count; ++c) {
        int slot = g->e.slot[c];
        ax_lane* block = g->parameter + (size_t)(slot / AX_W) * each + (size_t)first;
        int end = slot == g->e.count - 1 ? AX_W : slot % AX_W + 1; // spare lanes repeat the last constraint
        for (int i = 0; i < lanes; ++i)
            for (int l = slot % AX_W; l < end; ++l)
                block[i][l] = values[(size_t)c * (size_t)lanes + (size_t)i];
    }
    for (int b = 0; b < g->e.blocks && g->type->prepare; ++b)
        g->type->prepare(g->parameter + (size_t)b * each, g->e.points_each);
}

double ax_solver_get(const ax_solver* s, int k, int constraint, int lane)
{
    const group* g = s->groups + k;
    int slot = g->e.slot[constraint];
    return g->parameter[(size_t)(slot / AX_W) * (size_t)g->type->lanes + (size_t)lane][slot % AX_W];
}

void ax_solver_set_places(ax_solver* s, const double (*places)[3])
{
    s->changed = true;
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

// Vector area of a polygon, halved.
static double loop_area(const ax_solver* s, const double (*places)[3], int count, const int* loop)
{
    double sum[3] = {0}, side[2][3], part[3];
    const double* from = places ? places[loop[0]] : s->x[s->position[loop[0]]];
    for (int k = 1; k + 1 < count; ++k) {
        for (int end = 0; end < 2; ++end)
            ax_sub3(places ? places[loop[k + end]] : s->x[s->position[loop[k + end]]], from, side[end]);
        ax_cross(side[0], side[1], part);
        for (int d = 0; d < 3; ++d)
            sum[d] += part[d] / 2;
    }
    return ax_norm3(sum);
}

void ax_solver_measure_load(ax_solver* s, int k, const double (*places)[3])
{
    s->changed = true;
    for (int c = 0; c < s->loads[k].class_count; ++c) {
        load_class* class = s->loads[k].classes + c;
        const elements* e = &class->e;
        for (int loop = 0; loop < e->count; ++loop) {
            int points[AX_MOST_POINTS];
            for (int p = 0; p < e->points_each; ++p)
                points[p] = point_of(s, e, loop, p);
            double area = loop_area(s, places, e->points_each, points);
            class->area[e->slot[loop] / AX_W][e->slot[loop] % AX_W] = area;
        }
        for (int l = live_lanes(e, e->blocks - 1); l < AX_W; ++l)
            class->area[e->blocks - 1][l] = 0;
    }
    s->dead_changed = s->dead_changed || !s->loads[k].type->follows;
}

int ax_solver_add_load(ax_solver* s, const ax_load_type* type, int loops, const int* start, const int* points)
{
    assert(loops > 0 && type->values <= AX_MOST_LOAD_VALUES);
    s->loads = ax_realloc(s->loads, (size_t)s->load_count + 1, sizeof *s->loads);
    load* f = s->loads + s->load_count;
    *f = (load){.type = type};
    for (int k = 0; k < type->parameter_count; ++k) {
        const ax_parameter* parameter = type->parameters + k;
        bool direction = strcmp(parameter->unit, "direction") == 0;
        for (int i = 0; i < parameter->lanes; ++i)
            f->value[parameter->offset + i] = direction ? i == 2 : parameter->standard;
    }
    double centre[3] = {0};
    int most = 0;
    for (int k = start[0]; k < start[loops]; ++k)
        for (int d = 0; d < 3; ++d)
            centre[d] += s->x[s->position[points[k]]][d] / (start[loops] - start[0]);
    if (type->rest)
        type->rest(f->value, centre);
    for (int k = 0; k < loops; ++k)
        most = start[k + 1] - start[k] > most ? start[k + 1] - start[k] : most;
    assert(most <= AX_MOST_POINTS);
    f->classes = ax_calloc((size_t)most, sizeof *f->classes);
    int* same = AX_NEW(int, start[loops] - start[0]);
    for (int size = 3; size <= most; ++size) {
        int count = 0;
        for (int k = 0; k < loops; ++k)
            if (start[k + 1] - start[k] == size)
                memcpy(same + size * count++, points + start[k], (size_t)size * sizeof *same);
        if (!count)
            continue;
        load_class* class = f->classes + f->class_count++;
        class->e = make_elements(s, size, count, same, size);
        class->area = ax_alloc_aligned((size_t) class->e.blocks, sizeof *class->area);
    }
    ax_free(same);
    s->rows_changed = true;
    ax_solver_measure_load(s, s->load_count, NULL);
    return s->load_count++;
}

void ax_solver_set_load_value(ax_solver* s, int k, int at, double value)
{
    s->changed = true;
    assert(at < s->loads[k].type->values);
    s->loads[k].value[at] = value;
    s->dead_changed = s->dead_changed || !s->loads[k].type->follows;
}

void ax_solver_set_load(ax_solver* s, const double (*force)[3])
{
    s->changed = true;
    if (!s->point_force)
        s->point_force = ax_alloc((size_t)s->n, sizeof *s->point_force);
    if (force)
        memcpy(s->point_force, force, (size_t)s->n * sizeof *force);
    else
        memset(s->point_force, 0, (size_t)s->n * sizeof *force);
    s->dead_changed = true;
}

void ax_solver_scale_loads(ax_solver* s, double factor)
{
    s->changed = true;
    s->load_factor = factor;
}

void ax_solver_set_dynamics(ax_solver* s, const ax_dynamics* dynamics)
{
    s->changed = true;
    double before = s->dynamic ? s->dynamics.mass / (s->dynamics.time_step * s->dynamics.time_step) : 0;
    s->dynamics = *dynamics;
    s->dynamic = dynamics->mass > 0;
    double after = s->dynamic ? dynamics->mass / (dynamics->time_step * dynamics->time_step) : 0;
    s->values_changed = s->values_changed || before != after;
}

void ax_solver_set_proximal(ax_solver* s, double stiffness)
{
    s->changed = true;
    s->values_changed = s->values_changed || s->proximal != stiffness;
    s->proximal = stiffness;
}

void ax_solver_use_multipliers(ax_solver* s, bool use)
{
    s->changed = true;
    s->multipliers = use;
    s->multiplied = s->multiplied || use;
}

void ax_solver_reset_multipliers(ax_solver* s)
{
    s->changed = true;
    for (int k = 0; k < s->group_count && s->multiplied; ++k) {
        group* g = s->groups + k;
        memset(g->dual, 0, (size_t)g->e.blocks * (size_t)g->rows * sizeof *g->dual);
    }
}

void ax_solver_cap_multipliers(ax_solver* s, double length)
{
    s->changed = true;
    s->cap = length;
}

void ax_solver_set_soft(ax_solver* s, int k, bool soft)
{
    s->changed = true;
    s->groups[k].soft = soft;
    s->rows_changed = true;
}

size_t ax_solver_multiplier_count(const ax_solver* s)
{
    size_t count = 0;
    for (int k = 0; k < s->group_count; ++k)
        count += 3 * (size_t)s->groups[k].e.count * (size_t)s->groups[k].rows;
    return count;
}

// Multiplier of one row of a constraint, coordinate c.
static double* multiplier(const group* g, int constraint, int row, int c)
{
    int slot = g->e.slot[constraint];
    return g->dual[(size_t)(slot / AX_W) * (size_t)g->rows + (size_t)row][c] + slot % AX_W;
}

void ax_solver_get_multipliers(const ax_solver* s, double* out)
{
    for (int k = 0; k < s->group_count; ++k)
        for (int c = 0; c < s->groups[k].e.count; ++c)
            for (int r = 0; r < s->groups[k].rows; ++r)
                for (int d = 0; d < 3; ++d)
                    *out++ = *multiplier(s->groups + k, c, r, d);
}

void ax_solver_set_multipliers(ax_solver* s, const double* from)
{
    s->multiplied = s->changed = true;
    for (int k = 0; k < s->group_count; ++k)
        for (int c = 0; c < s->groups[k].e.count; ++c)
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
    return s->dynamic ? s->dynamics.mass / (s->dynamics.time_step * s->dynamics.time_step) : s->proximal;
}

// The matrix, with the rows and columns of held points (as given) those of the identity; what they had goes to `held_matrix`.
static ax_sparse assemble(ax_solver* s, const unsigned char* held)
{
    ax_entries entries = {0}, apart = {0};
    size_t most = (size_t)s->n;
    for (int k = 0; k < s->group_count; ++k)
        most +=
            (size_t)s->groups[k].e.count * (size_t)(s->groups[k].e.points_each * (s->groups[k].e.points_each - 1) / 2);
    ax_entries_reserve(&entries, most);
    for (int v = 0; v < s->n; ++v) // most entries fall on the diagonal: summed here, they need no sorting
        s->stiffness[v] = held[v] ? 1 : mass_term(s);
    for (int k = 0; k < s->group_count; ++k) {
        const group* g = s->groups + k;
        if (g->type->eliminated)
            continue;
        int n = g->e.points_each;
        double* product = AX_NEW0(double, n* n); // A'A, the same for every constraint of the group
        for (int r = 0; r < g->rows; ++r)
            for (int a = 0; a < n; ++a) {
                double at_a = ax_row_coefficient(g->type, n, r, a);
                for (int b = 0; b <= a && at_a != 0; ++b)
                    product[a * n + b] += at_a * ax_row_coefficient(g->type, n, r, b);
            }
        for (int c = 0; c < g->e.count; ++c)
            for (int a = 0; a < n; ++a)
                for (int b = 0; b <= a; ++b)
                    if (product[a * n + b] != 0) {
                        int i = point_of(s, &g->e, c, a), j = point_of(s, &g->e, c, b);
                        double value = g->weight * product[a * n + b];
                        if (held[i] && held[j])
                            continue;
                        if (i != j)
                            ax_entries_add(held[i] || held[j] ? &apart : &entries, i, j, value);
                        else // a point that stands twice in a constraint meets itself: both halves fall on the diagonal
                            s->stiffness[i] += a == b ? value : 2 * value;
                    }
        ax_free(product);
    }
    ax_sparse_free(&s->held_matrix);
    s->held_matrix = ax_entries_sparse(&apart, s->n);
    for (int v = 0; v < s->n; ++v)
        ax_entries_add(&entries, v, v, s->stiffness[v]);
    return ax_entries_sparse(&entries, s->n);
}

static unsigned char* find_held(const ax_solver* s)
{
    unsigned char* held = AX_NEW0(unsigned char, s->n);
    for (int k = 0; k < s->group_count; ++k)
        for (int c = 0; s->groups[k].type->eliminated && c < s->groups[k].e.count; ++c)
            held[point_of(s, &s->groups[k].e, c, 0)] = 1;
    return held;
}

// All elements, constraints first: NULL after the last.
static elements* elements_at(ax_solver* s, int k)
{
    if (k < s->group_count)
        return &s->groups[k].e;
    k -= s->group_count;
    for (int f = 0; f < s->load_count; k -= s->loads[f++].class_count)
        if (k < s->loads[f].class_count)
            return &s->loads[f].classes[k].e;
    return NULL;
}

// Moves all per-point state to a new elimination order.
static void reorder(ax_solver* s, const int* order, const unsigned char* held)
{
    int* position = AX_NEW(int, s->n);
    for (int k = 0; k < s->n; ++k)
        position[order[k]] = k;
    ax_vec4* x = ax_alloc_aligned(ax_panels_rows(s->panels), sizeof *x);
    double(*velocity)[3] = ax_alloc((size_t)s->n, sizeof *velocity);
    for (int v = 0; v < s->n; ++v) {
        memcpy(x[position[v]], s->x[s->position[v]], sizeof *x);
        memcpy(velocity[position[v]], s->velocity[s->position[v]], sizeof *velocity);
        s->held[position[v]] = held[v];
    }
    ax_free(s->x);
    ax_free(s->velocity);
    s->x = x;
    s->velocity = velocity;
    elements* e;
    for (int k = 0; (e = elements_at(s, k)); ++k)
        for (size_t i = 0; i < (size_t)e->blocks * (size_t)e->points_each * AX_W; ++i)
            e->index[i] = position[s->order[e->index[i]]];
    memcpy(s->order, order, (size_t)s->n * sizeof *order);
    ax_free(s->position);
    s->position = position;
    s->dead_changed = s->dead_changed || s->dead;
}

// Sorts elements along the elimination order. Returns the old slot of what each new slot holds, spare ones repeating the last.
static int* sort_elements(const ax_solver* s, elements* e)
{
    int n = e->points_each, *first = AX_NEW(int, e->count), *start = AX_NEW(int, s->n + 1),
        *sorted = AX_NEW(int, e->count);
    for (int c = 0; c < e->count; ++c) {
        first[c] = s->n;
        for (int k = 0; k < n; ++k) {
            int at = e->index[place_of(e, e->slot[c], k)];
            first[c] = at < first[c] ? at : first[c];
        }
    }
    ax_bucket_sort(e->count, s->n, first, NULL, start, sorted);
    ax_free(first);
    ax_free(start);
    int *was = AX_NEW(int, e->blocks*AX_W), *index = AX_NEW(int, (size_t)e->blocks*(size_t)n*AX_W);
    for (int slot = 0; slot < e->blocks * AX_W; ++slot) {
        int c = sorted[slot < e->count ? slot : e->count - 1];
        was[slot] = e->slot[c];
        for (int k = 0; k < n; ++k)
            index[place_of(e, slot, k)] = e->index[place_of(e, e->slot[c], k)];
    }
    for (int slot = 0; slot < e->count; ++slot)
        e->slot[sorted[slot]] = slot;
    ax_free(sorted);
    ax_free(e->index);
    e->index = index;
    return was;
}

// Lanes of elements on their way to new slots.
typedef struct carrying {
    const elements* e;
    const int* was;
    const ax_lane* from;
    ax_lane* to;
    size_t each;
} carrying;

static void carry_task(void* context, int task)
{
    const carrying* o = context;
    int end = (task + 1) * CHUNK < o->e->blocks ? (task + 1) * CHUNK * AX_W : o->e->blocks * AX_W;
    for (int slot = task * CHUNK * AX_W; slot < end; ++slot) {
        size_t to = (size_t)slot / AX_W * o->each, from = (size_t)o->was[slot] / AX_W * o->each;
        for (size_t k = 0; k < o->each; ++k)
            o->to[to + k][slot % AX_W] = o->from[from + k][o->was[slot] % AX_W];
    }
}

// `each` lanes per block, moved as their elements have been. Frees `lanes`.
static ax_lane* carry(const ax_solver* s, const elements* e, const int* was, ax_lane* lanes, size_t each)
{
    carrying o = {e, was, (const ax_lane*)lanes, NULL, each};
    o.to = ax_alloc_aligned((size_t)e->blocks * (each ? each : 1), sizeof *o.to);
    ax_pool_run(s->pool, carry_task, &o, task_count(e));
    ax_free(lanes);
    return o.to;
}

static void sort_all(ax_solver* s)
{
    for (int k = 0; k < s->group_count; ++k) {
        group* g = s->groups + k;
        int* was = sort_elements(s, &g->e);
        g->parameter = carry(s, &g->e, was, g->parameter, (size_t)g->type->lanes);
        if (s->multiplied) // else they are zero
            g->dual = (ax_lane3*)carry(s, &g->e, was, (ax_lane*)g->dual, 3 * (size_t)g->rows);
        ax_free(was);
    }
    for (int k = 0; k < s->load_count; ++k)
        for (int c = 0; c < s->loads[k].class_count; ++c) {
            load_class* class = s->loads[k].classes + c;
            int* was = sort_elements(s, &class->e);
            class->area = carry(s, &class->e, was, class->area, 1);
            ax_free(was);
        }
}

// All elements that write rows: silent constraints, the others, loads; NULL after the last.
static elements* writer(ax_solver* s, int k, bool* edges)
{
    *edges = false;
    for (int silent = 1; silent >= 0; --silent)
        for (int g = 0; g < s->group_count; ++g)
            if (!s->groups[g].type->eliminated && is_silent(s->groups + g) == silent && k-- == 0) {
                *edges = s->groups[g].type->pattern == AX_ROWS_EDGES;
                return &s->groups[g].e;
            }
    for (int f = 0; f < s->load_count; ++f)
        for (int c = 0; s->loads[f].type->follows && c < s->loads[f].class_count; ++c)
            if (k-- == 0)
                return &s->loads[f].classes[c].e;
    return NULL;
}

// Which rows each point sums, in a fixed order: by writer, slot and row.
static void list_incidence(ax_solver* s)
{
    elements* e;
    bool edges;
    int tasks = 0, silent = 0, constraints = 0;
    for (int k = 0; k < s->group_count; ++k) {
        silent += !s->groups[k].type->eliminated && is_silent(s->groups + k);
        constraints += !s->groups[k].type->eliminated;
    }
    s->row_count = s->first_step_row = s->first_load_row = 0;
    for (int k = 0; (e = writer(s, k, &edges)); ++k) {
        e->first_row = s->row_count, e->first_task = tasks;
        s->row_count += e->blocks * AX_W * e->rows_each;
        tasks += task_count(e);
        if (k + 1 == silent)
            s->first_step_row = s->row_count;
        if (k + 1 == constraints)
            s->first_load_row = s->row_count;
    }
    s->point_tallies = tasks;
    ax_free(s->row);
    ax_free(s->tallies);
    ax_free(s->incident_start);
    ax_free(s->incident);
    ax_free(s->step_start);
    s->row = ax_alloc_aligned((size_t)s->row_count, sizeof *s->row);
    s->tallies = AX_NEW0(tally, tasks + point_task_count(s));
    s->incident_start = AX_NEW0(int, s->n + 2);
    for (int pass = 0; pass < 2; ++pass) {
        for (int k = 0; (e = writer(s, k, &edges)); ++k)
            for (int slot = 0; slot < e->count; ++slot)
                for (int p = 0; p < e->points_each; ++p) {
                    int at = e->index[place_of(e, slot, p)];
                    int row = e->first_row + slot * e->rows_each + (edges ? p / 2 : p);
                    if (pass)
                        s->incident[s->incident_start[at + 1]++] = row << 1 | (edges && p % 2 == 0);
                    else
                        ++s->incident_start[at + 2];
                }
        if (pass)
            break;
        for (int v = 0; v <= s->n; ++v)
            s->incident_start[v + 1] += s->incident_start[v];
        s->incident = AX_NEW(int, s->incident_start[s->n + 1]);
    }
    s->step_start = AX_NEW(int, s->n);
    for (int v = 0; v < s->n; ++v) {
        s->step_start[v] = s->incident_start[v];
        while (s->step_start[v] < s->incident_start[v + 1] && s->incident[s->step_start[v]] >> 1 < s->first_step_row)
            ++s->step_start[v];
    }
}

static void trim(const ax_solver* s)
{
    if (s->rows_changed && s->n >= LEAST_TRIMMED)
        ax_trim_memory();
}

// The order of elimination, and all that follows from it.
static void analyse(ax_solver* s, const ax_sparse* matrix, const unsigned char* held)
{
    int* order = AX_NEW(int, s->n);
    double(*place)[3] = ax_alloc((size_t)s->n, sizeof *place);
    for (int v = 0; v < s->n; ++v)
        for (int c = 0; c < 3; ++c)
            place[v][c] = s->start[v][c];
    ax_order_by_place(matrix, (const double(*)[3])place, s->pool, order);
    ax_free(place);
    ax_panels_free(s->panels);
    s->panels = ax_panels_analyse(matrix, order);
    ax_free(order);
    s->counters.factor_entries = ax_panels_entries(s->panels);
    s->counters.bytes_per_solve = ax_panels_bytes(s->panels);
    reorder(s, ax_panels_order(s->panels), held);
    s->rows_changed = true;
    s->pattern_changed = false;
    ++s->counters.analyses;
}

static bool factorise(ax_solver* s)
{
    unsigned char* held = find_held(s);
    ax_sparse matrix = assemble(s, held);
    if (s->pattern_changed)
        analyse(s, &matrix, held);
    ax_free(held);
    trim(s);
    double start = ax_seconds();
    bool sound = ax_panels_factor(s->panels, &matrix, s->pool);
    s->counters.seconds_factorise += ax_seconds() - start;
    ++s->counters.factorisations;
    s->values_changed = !sound;
    ax_sparse_free(&matrix);
    return sound;
}

bool ax_solver_prepare(ax_solver* s)
{
    if (!s->values_changed && !s->rows_changed)
        return true;
    double start = ax_seconds();
    bool sound = !s->values_changed || factorise(s);
    s->changed = true;
    if (s->rows_changed) {
        sort_all(s);
        list_incidence(s);
        trim(s);
        s->rows_changed = false;
    }
    s->counters.seconds_prepare += ax_seconds() - start;
    return sound;
}

static double energy_of_tallies(const ax_solver* s)
{
    return ax_sum_tallies(s, 0, s->point_tallies + point_task_count(s)).energy;
}

// Places and, where they are in use, multipliers: what an iteration maps to itself.
static void forget_past(ax_solver* s)
{
    ax_anderson_part* parts = s->parts;
    int count = 0;
    parts[count++] = (ax_anderson_part){*s->x, 4 * (size_t)s->n};
    for (int k = 0; k < s->group_count; ++k) {
        const group* g = s->groups + k;
        if (is_hard(s, g))
            parts[count++] = (ax_anderson_part){**g->dual, (size_t)g->e.blocks * (size_t)g->rows * 3 * AX_W};
    }
    ax_anderson_start(s->anderson, count, parts, s->pool);
    s->changed = false;
    s->merit = INFINITY;
}

// What is constant during iterations: dead loads, and held points where they pull on free ones.
static void add_to_base(ax_solver* s)
{
    ax_sum_dead_loads(s);
    for (int v = 0; s->dead && v < s->n; ++v)
        for (int c = 0; c < 4; ++c)
            s->base[v][c] += s->load_factor * s->dead[v][c];
    const ax_sparse* m = &s->held_matrix;
    for (int v = 0; v < s->n; ++v)
        for (int k = m->start[v]; k < m->start[v + 1]; ++k) {
            int i = s->position[v], j = s->position[m->row[k]], free = s->held[i] ? j : i, held = s->held[i] ? i : j;
            for (int c = 0; c < 3; ++c)
                s->base[free][c] -= m->value[k] * s->x[held][c];
        }
}

// The base of one iteration that is drawn to the present places.
static void draw_back(ax_solver* s)
{
    for (int v = 0; v < s->n; ++v) {
        for (int c = 0; c < 3; ++c)
            s->base[v][c] = s->proximal * s->x[v][c];
        s->base[v][3] = 0;
    }
    add_to_base(s);
}

// A local/global iteration descends the energy, so a jump that does not lower it is taken back before the global step (Peng et al.
// 2018). With multipliers nothing descends, and a proximal term has another energy each time. There the step must
// shorten (Zhang et al. 2019), which is known one global step later, and the next jump waits for a step shorter than all before: without that, accepted jumps and the steps that repair them went on in turn, far from any solution.
static void iterate(ax_solver* s)
{
    double start = ax_seconds();
    bool descends = s->proximal == 0 || s->dynamic, jumped = false;
    if (s->anderson) {
        for (int k = 0; k < s->group_count; ++k)
            descends = descends && !is_hard(s, s->groups + k);
        if (s->changed)
            forget_past(s);
        jumped = ax_anderson_jump(s->anderson, s->pool);
        s->tallying = descends;
    }
    if (s->proximal > 0 && !s->dynamic)
        draw_back(s);
    ax_local_step(s);
    if (s->tallying) {
        double energy = energy_of_tallies(s);
        if (jumped && !(energy <= s->merit)) {
            ax_anderson_revert(s->anderson, s->pool);
            ax_local_step(s);
            energy = energy_of_tallies(s);
            ++s->counters.jumps_refused;
        }
        s->merit = energy;
        s->tallying = false;
    }
    double middle = ax_seconds();
    ax_panels_solve(s->panels, s->pool, s->x);
    s->counters.seconds_local += middle - start;
    double end = ax_seconds();
    s->counters.seconds_global += end - middle;
    ++s->counters.iterations;
    if (!s->anderson)
        return;
    double step = descends ? 0 : ax_anderson_residual(s->anderson, s->pool);
    bool grows = !descends && !(step <= s->merit);
    if (jumped && grows) {
        ax_anderson_revert(s->anderson, s->pool);
        ax_anderson_forget(s->anderson);
        ++s->counters.jumps_refused;
    } else {
        ax_anderson_take(s->anderson, s->pool);
        if (grows)
            ax_anderson_forget(s->anderson);
        else if (!descends)
            s->merit = step;
    }
    s->counters.seconds_anderson += ax_seconds() - end;
}

void ax_solver_accelerate(ax_solver* s, int window)
{
    ax_anderson_free(s->anderson);
    s->anderson = window > 0 ? ax_anderson_make(window) : NULL;
    s->changed = true;
}

bool ax_solver_iterate(ax_solver* s, int iterations)
{
    if (!ax_solver_prepare(s))
        return false;
    assert(!s->dynamic);
    ax_pin(s);
    memset(s->base, 0, (size_t)s->n * sizeof *s->base);
    add_to_base(s);
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
    if (s->anderson)
        ax_keep(s);
    for (int v = 0; v < s->n; ++v) {
        for (int c = 0; c < 3; ++c) {
            double before = s->x[v][c];
            s->x[v][c] = before + h * s->velocity[v][c] + h * h * s->dynamics.acceleration[c];
            s->velocity[v][c] = before;
            s->base[v][c] = m * s->x[v][c];
        }
        s->base[v][3] = 0;
        if (s->anderson)
            memcpy(s->kept[v], s->x[v], sizeof *s->kept);
    }
    ax_pin(s);
    add_to_base(s);
    s->changed = true; // every step has an energy of its own
    for (int k = 0; k < iterations; ++k)
        iterate(s);
    for (int v = 0; v < s->n; ++v)
        for (int c = 0; c < 3; ++c)
            s->velocity[v][c] = s->dynamics.damping * (s->x[v][c] - s->velocity[v][c]) / h;
    return true;
}

static size_t element_bytes(const elements* e)
{
    return ((size_t)e->blocks * AX_W * (size_t)e->points_each + (size_t)e->count) * sizeof(int);
}

ax_solver_counters ax_solver_count(const ax_solver* s)
{
    ax_solver_counters counters = s->counters;
    counters.bytes =
        (size_t)s->n * (2 * sizeof(ax_vec4) + 4 * sizeof(double) + 3 * sizeof(float) + 3 * sizeof(int) + 1) +
        (size_t)s->row_count * sizeof *s->row;
    counters.bytes += s->kept ? (size_t)s->n * sizeof *s->kept : 0;
    counters.bytes += s->anderson ? ax_anderson_bytes(s->anderson) : 0;
    counters.bytes += s->dead ? (size_t)s->n * sizeof *s->dead : 0;
    counters.bytes += s->point_force ? (size_t)s->n * sizeof *s->point_force : 0;
    if (s->panels)
        counters.bytes += ax_panels_bytes(s->panels) / 2 + (size_t)s->n * sizeof(ax_vec4);
    if (s->incident_start)
        counters.bytes += (size_t)s->incident_start[s->n] * sizeof *s->incident;
    for (int k = 0; k < s->group_count; ++k) {
        const group* g = s->groups + k;
        counters.bytes +=
            (size_t)g->e.blocks * ((size_t)g->type->lanes * sizeof(ax_lane) + (size_t)g->rows * sizeof(ax_lane3));
        counters.bytes += element_bytes(&g->e);
    }
    for (int k = 0; k < s->load_count; ++k)
        for (int c = 0; c < s->loads[k].class_count; ++c)
            counters.bytes += element_bytes(&s->loads[k].classes[c].e);
    return counters;
}
