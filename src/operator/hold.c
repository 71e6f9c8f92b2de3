#include "operator/hold.h"

#include "operator/selection.h"

#include <stdio.h>

const ax_field ax_hold_fields[AX_HOLD_FIELDS] = {
    AX_HOLD_NAME(ax_hold_arguments),
    AX_HOLD_HINGES(ax_hold_arguments, .required = true),
    AX_HOLD_WEIGHT(ax_hold_arguments),
    AX_HOLD_SUPPORT(ax_hold_arguments),
};

void ax_hold_defaults(void* arguments)
{
    ((ax_hold_arguments*)arguments)->hold.weight = 1;
}

const char* const ax_at_words[4] = {
    [AX_AT_FLAT] = "flat", [AX_AT_DEPLOYED] = "deployed", [AX_AT_SHEET] = "sheet", [AX_AT_POINTS] = "points"};

static bool is_taken(const ax_form* form, const char* name)
{
    const ax_form_constraint* constraints;
    int count = ax_form_constraints(form, &constraints);
    for (int k = 0; k < count; ++k)
        if (strcmp(constraints[k].name, name) == 0)
            return true;
    return false;
}

ax_status ax_hold_put_hinges(const ax_operator_context* context, const ax_holding* hold, int count, const int* hinges,
                             ax_form_constraint* constraint, ax_error* error)
{
    char name[64];
    if (hold->name && !ax_is_name(hold->name))
        return ax_fail(error, AX_BAD_INPUT, "\"%.60s\": %s", hold->name, ax_no_name);
    for (int k = 1; !hold->name; ++k) {
        snprintf(name, sizeof name, "%s-%d", ax_held_kind_name(constraint->kind), k);
        if (!is_taken(*context->form, name))
            break;
    }
    constraint->name = hold->name ? hold->name : name;
    constraint->count = count;
    constraint->hinges = hinges;
    constraint->weight = hold->weight;
    constraint->support = hold->support;
    return ax_form_put_constraint(*context->form, constraint, error);
}

ax_status ax_hold_put(const ax_operator_context* context, const ax_holding* hold, int fewest,
                      ax_form_constraint* constraint, ax_error* error)
{
    int *hinges, count;
    ax_status status = ax_operator_hinges(context, hold->hinges, fewest, &hinges, &count, error);
    if (status == AX_OK)
        status = ax_hold_put_hinges(context, hold, count, hinges, constraint, error);
    ax_free(hinges);
    return status;
}

// ---- symmetry of the lattice -------------------------------------------------------------------------------------------------

// Hinges by square cells of the sheet.
typedef struct grid {
    double lo[2], cell;
    int size[2], *start, *hinges;
} grid;

static int cell_of(const grid* g, const double x[2])
{
    int at[2];
    for (int d = 0; d < 2; ++d)
        at[d] = (int)ax_clamp(floor((x[d] - g->lo[d]) / g->cell), 0, g->size[d] - 1);
    return at[1] * g->size[0] + at[0];
}

static grid make_grid(const ax_form_view* view, int count, const int* hinges)
{
    grid g = {.lo = {INFINITY, INFINITY}, .cell = view->spacing};
    double hi[2] = {-INFINITY, -INFINITY};
    for (int k = 0; k < count; ++k)
        for (int d = 0; d < 2; ++d) {
            g.lo[d] = fmin(g.lo[d], view->sheet[hinges[k]][d]);
            hi[d] = fmax(hi[d], view->sheet[hinges[k]][d]);
        }
    for (int d = 0; d < 2; ++d)
        g.size[d] = (int)((hi[d] - g.lo[d]) / g.cell) + 1;
    int cells = g.size[0] * g.size[1];
    g.start = AX_NEW0(int, cells + 1);
    g.hinges = AX_NEW(int, count);
    for (int k = 0; k < count; ++k)
        ++g.start[cell_of(&g, view->sheet[hinges[k]]) + 1];
    for (int c = 0; c < cells; ++c)
        g.start[c + 1] += g.start[c];
    int* next = ax_copy(g.start, (size_t)cells, sizeof *next);
    for (int k = 0; k < count; ++k)
        g.hinges[next[cell_of(&g, view->sheet[hinges[k]])]++] = hinges[k];
    ax_free(next);
    return g;
}

void ax_hold_centre(const ax_form_view* view, const double given[2], double centre[2])
{
    if (isnan(given[0]))
        ax_sheet_middle(view, centre);
    else
        memcpy(centre, given, 2 * sizeof *centre);
}

static const double SAME = 0.1; // of the spacing; hinges lie half a spacing apart

static int find_at(const grid* g, const ax_form_view* view, const double x[2])
{
    double reach = SAME * view->spacing;
    for (int corner = 0; corner < 4; ++corner) { // a circle meets at most four cells
        double at[2] = {x[0] + (corner & 1 ? reach : -reach), x[1] + (corner & 2 ? reach : -reach)};
        int c = cell_of(g, at);
        for (int k = g->start[c]; k < g->start[c + 1]; ++k)
            if (ax_distance2(view->sheet[g->hinges[k]], x) < reach)
                return g->hinges[k];
    }
    return -1;
}

int ax_hold_match(const ax_form_view* view, int count, const int* hinges, const double centre[2],
                  const double matrix[2][2], int* partner)
{
    int found = 0;
    grid g = make_grid(view, count, hinges);
    memset(partner, -1, (size_t)view->linkage->hinge_count * sizeof *partner);
    for (int k = 0; k < count; ++k) {
        const double* x = view->sheet[hinges[k]];
        double d[2] = {x[0] - centre[0], x[1] - centre[1]}, image[2];
        for (int i = 0; i < 2; ++i)
            image[i] = centre[i] + matrix[i][0] * d[0] + matrix[i][1] * d[1];
        partner[hinges[k]] = find_at(&g, view, image);
        found += partner[hinges[k]] >= 0;
    }
    ax_free(g.start);
    ax_free(g.hinges);
    return found;
}

ax_status ax_hold_places(const ax_operator_context* context, int at, const ax_points* given, int count,
                         const int* hinges, double (**places)[3], ax_error* error)
{
    *places = NULL;
    if (at == AX_AT_POINTS && given->count != count)
        return ax_fail(error, AX_BAD_INPUT, "The selection has %d hinges, and \"points\" gives %d places.", count,
                       given->count);
    ax_form_view view = ax_form_look(*context->form);
    *places = ax_calloc((size_t)count, sizeof **places);
    double(*flat)[2] = ax_alloc((size_t)count + 1, sizeof *flat);
    if (at == AX_AT_FLAT)
        ax_form_flat_places(*context->form, count, hinges, flat);
    for (int k = 0; k < count; ++k) {
        int h = hinges[k], width = at == AX_AT_FLAT || at == AX_AT_SHEET ? 2 : 3;
        const double* from = at == AX_AT_FLAT       ? flat[k]
                             : at == AX_AT_SHEET    ? view.sheet[h]
                             : at == AX_AT_DEPLOYED ? view.deployed[h]
                                                    : given->values + 3 * (size_t)k;
        memcpy((*places)[k], from, (size_t)width * sizeof *from);
    }
    ax_free(flat);
    return AX_OK;
}
