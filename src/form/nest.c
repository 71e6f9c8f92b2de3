// A coarser sheet of the same design, which a sheet of many panels keeps. What is left over between rims folds in more than one way, and which
// way is told by how the sheet opens and by every stroke since. A sheet that starts where a coarser one rests, and is drawn there
// where it would rest elsewhere, folds as that one does, so that shapes do not depend on the number of panels.
#include "form/map.h"

#include "base/vec.h"

#include <math.h>
#include <string.h>

enum { COARSEST = 600, LEVEL = 4, LEAST_NESTED = 900 }; // panels of the first sheet; times as many in the next

// The hinge of a sheet nearest to each of another; of its rim to those of the other's rim.
static int* nearest_hinges(const ax_form* from, const ax_sheet_map* to)
{
    const ax_linkage* linkage = &from->lattice.linkage;
    const double(*hinges)[2] = (const double(*)[2])to->form->lattice.hinges;
    int *nearest = AX_NEW(int, linkage->hinge_count), face = -1;
    for (int h = 0; h < linkage->hinge_count; ++h) {
        double at[3] = {from->lattice.hinges[h][0], from->lattice.hinges[h][1], 0}, least = INFINITY;
        if (linkage->on_rim[h]) {
            ax_polyline_point on = ax_polyline_find(to->rim, at);
            nearest[h] = to->rim_hinges[(on.segment + (on.parameter > 0.5)) % to->rim_count];
            continue;
        }
        face = ax_closest_find(to->tree, at, face).face;
        for (int k = 0; k < 3; ++k) {
            int v = to->cover.faces[face][k]; // or the middle of a hole
            if (v < to->form->lattice.linkage.hinge_count && ax_distance2(at, hinges[v]) < least)
                least = ax_distance2(at, hinges[v]), nearest[h] = v;
        }
    }
    return nearest;
}

// Without what rounding left: where there is more than one way to fold, it would choose.
static double whole(double value, double size)
{
    double step = 1e9 / size;
    return round(value * step) / step;
}

static void carry_factors(const ax_sheet_map* fine, ax_form* coarse)
{
    const ax_form* f = fine->form;
    int n = f->lattice.linkage.hinge_count, t = coarse->lattice.linkage.triangle_count;
    double(*at_hinge)[3] = ax_calloc((size_t)n, sizeof *at_hinge),
    (*at_panel)[3] = ax_alloc((size_t)t, sizeof *at_panel);
    for (int h = 0; h < n; ++h) {
        const int* holder = f->holder[h];
        at_hinge[h][0] = 0.5 * (f->prescribed[holder[0]] + f->prescribed[holder[holder[1] >= 0]]);
    }
    ax_sheet_map_carry(fine, (const double(*)[3])at_hinge, t, (const double(*)[2])coarse->centres, at_panel);
    for (int k = 0; k < t; ++k)
        coarse->prescribed[k] = ax_clamp(whole(at_panel[k][0], 1), 1, 2);
    ax_free(at_panel);
    ax_free(at_hinge);
}

// Where a coarse hinge is held: as far from its own place on the sheet as the fine ones are, in the mean, to which it is nearest; and where there
// are none, as far as the fine one that is nearest to it.
static void mean_places(const ax_form* f, const ax_form* coarse, int count, const int* hinges,
                        const double (*places)[3], const int* to_coarse, const int* to_fine, double (*mean)[3])
{
    int coarse_count = coarse->lattice.linkage.hinge_count, *members = AX_NEW0(int, coarse_count);
    double(*off)[3] = ax_calloc((size_t)f->lattice.linkage.hinge_count, sizeof *off);
    memset(mean, 0, (size_t)coarse_count * sizeof *mean);
    for (int i = 0; i < count; ++i) {
        int from = hinges[i], h = to_coarse[from];
        ++members[h];
        for (int c = 0; c < 3; ++c) {
            off[from][c] = places[i][c] - (c < 2 ? f->lattice.hinges[from][c] : 0);
            mean[h][c] += (off[from][c] - mean[h][c]) / members[h];
        }
    }
    for (int h = 0; h < coarse_count; ++h)
        for (int c = 0; c < 3; ++c)
            mean[h][c] = whole(members[h] ? mean[h][c] : off[to_fine[h]][c], coarse->radius) +
                         (c < 2 ? coarse->lattice.hinges[h][c] : 0);
    ax_free(off);
    ax_free(members);
}

// Which part of the rim holds every coarse hinge, -1: none. That which holds the fine hinge nearest to it; and where it is nearest to one that is
// held, so that a part reaches as far as it does on the fine sheet, and single supports stay.
static void share_rim(const ax_form* f, const ax_form* coarse, const int* to_coarse, const int* to_fine, int* part_of)
{
    int* held_by = AX_NEW(int, f->lattice.linkage.hinge_count);
    for (int h = 0; h < f->lattice.linkage.hinge_count; ++h)
        held_by[h] = -1;
    for (int k = 0; k < f->rim_count; ++k)
        for (int i = 0; i < f->rim[k].count; ++i)
            held_by[f->rim[k].hinges[i]] = k;
    for (int h = 0; h < coarse->lattice.linkage.hinge_count; ++h)
        part_of[h] = coarse->lattice.linkage.on_rim[h] ? held_by[to_fine[h]] : -1;
    for (int h = 0; h < f->lattice.linkage.hinge_count; ++h)
        if (held_by[h] >= 0 && part_of[to_coarse[h]] < 0)
            part_of[to_coarse[h]] = held_by[h];
    ax_free(held_by);
}

static ax_status carry_rim(const ax_form* f, ax_form* coarse, const int* to_coarse, const int* to_fine, ax_error* error)
{
    int n = coarse->lattice.linkage.hinge_count, *part_of = AX_NEW(int, n);
    ax_rim_part* parts = AX_NEW0(ax_rim_part, f->rim_count + 1);
    double(*mean)[3] = ax_alloc((size_t)n, sizeof *mean);
    share_rim(f, coarse, to_coarse, to_fine, part_of);
    for (int k = 0; k < f->rim_count; ++k) {
        const ax_rim_part* from = f->rim + k;
        int *hinges = AX_NEW(int, n), count = 0;
        double(*places)[3] = ax_alloc((size_t)n, sizeof *places);
        if (from->kind == AX_RIM_FIXED)
            mean_places(f, coarse, from->count, from->hinges, from->places, to_coarse, to_fine, mean);
        for (int h = 0; h < n; ++h)
            if (part_of[h] == k) {
                if (from->kind == AX_RIM_FIXED)
                    memcpy(places[count], mean[h], sizeof *places);
                hinges[count++] = h;
            }
        parts[k] = (ax_rim_part){from->kind, count, hinges, (const double(*)[3])places, from->curve};
    }
    ax_status status = ax_form_set_rim(coarse, f->rim_count, parts, error);
    for (int k = 0; k < f->rim_count; ++k) {
        ax_free((void*)parts[k].hinges);
        ax_free((void*)parts[k].places);
    }
    ax_free(mean);
    ax_free(parts);
    ax_free(part_of);
    return status;
}

// Holds coarse hinges to which fine ones that are held are nearest, each once.
static ax_status carry_constraint(const ax_form* f, const ax_form_constraint* from, ax_form* coarse,
                                  const int* to_coarse, const int* to_fine, ax_error* error)
{
    int n = coarse->lattice.linkage.hinge_count, *hinges = AX_NEW(int, from->count);
    int each = from->kind == AX_HELD_MIRROR ? 2 : from->kind == AX_HELD_ROTATION ? from->order : 1;
    unsigned char* taken = AX_NEW0(unsigned char, n);
    double(*mean)[3] = ax_alloc((size_t)n, sizeof *mean), (*places)[3] = ax_alloc((size_t)from->count, sizeof *places);
    if (from->kind == AX_HELD_FIXED)
        mean_places(f, coarse, from->count, from->hinges, from->places, to_coarse, to_fine, mean);
    ax_form_constraint c = *from;
    c.hinges = hinges;
    c.places = (const double(*)[3])places;
    c.count = 0;
    for (int k = 0; k + each <= from->count; k += each) {
        bool fresh = true;
        for (int i = 0; i < each; ++i)
            fresh = fresh && !taken[to_coarse[from->hinges[k + i]]];
        for (int i = 0; i < each && fresh; ++i) {
            int h = to_coarse[from->hinges[k + i]];
            memcpy(places[c.count], mean[h], sizeof *places);
            taken[h] = 1;
            hinges[c.count++] = h;
        }
    }
    ax_status status = ax_form_put_constraint(coarse, &c, error);
    ax_free(places);
    ax_free(mean);
    ax_free(taken);
    ax_free(hinges);
    return status;
}

// The same sheet of about `panels` panels, as laid.
static ax_form* coarsen(const ax_form* f, int panels)
{
    ax_form_start start = {.outline_count = f->outline_count,
                           .outline = (const double(*)[2])f->outline,
                           .triangles = panels,
                           .scale = 1,
                           .angle = f->lattice.angle,
                           .unit = f->unit};
    ax_form* coarse;
    ax_error error;
    if (ax_form_make(&start, &coarse, &error) != AX_OK)
        return NULL;
    coarse->dynamics = f->dynamics;
    if (ax_form_bulge(f) < 0) // so much that it goes on to that side, and still is flat
        for (int h = 0; h < coarse->lattice.linkage.hinge_count; ++h)
            coarse->deployed[h][2] = coarse->lattice.linkage.on_rim[h] ? 1e-9 * coarse->radius : 0;
    return coarse;
}

// What holds the fine sheet.
static ax_status carry_holders(const ax_form* f, ax_form* coarse, const ax_sheet_map* from)
{
    ax_error error;
    ax_sheet_map* to = ax_sheet_map_make(coarse);
    int *to_coarse = nearest_hinges(f, to), *to_fine = nearest_hinges(coarse, from);
    while (coarse->held_count > 0)
        ax_form_drop_constraint(coarse, coarse->held[coarse->held_count - 1].name);
    ax_status status = carry_rim(f, coarse, to_coarse, to_fine, &error);
    for (int k = 0; k < f->held_count && status == AX_OK; ++k)
        status = carry_constraint(f, f->held + k, coarse, to_coarse, to_fine, &error);
    ax_free(to_fine);
    ax_free(to_coarse);
    ax_sheet_map_free(to);
    return status;
}

// All that is asked. Not where the coarse sheet holds too few hinges for what holds it.
static ax_status carry_asked(ax_form* f, ax_form* coarse)
{
    ax_status status = AX_OK;
    ax_sheet_map* from = ax_sheet_map_make(f);
    carry_factors(from, coarse);
    if (f->outdated) {
        status = carry_holders(f, coarse, from);
        ax_form_set_dynamics(coarse, &f->dynamics);
        if (coarse->mouth_min != f->mouth_min)
            ax_form_set_mouth_min(coarse, f->mouth_min);
        ax_form_release_border(coarse, f->released);
        f->outdated = false;
    }
    ax_sheet_map_free(from);
    return status;
}

// States of a sheet at the hinges of another of the same design.
static void carry_states(const ax_form* from, const ax_form* to, double (*deployed)[3], double (*simulated)[3])
{
    int n = to->lattice.linkage.hinge_count;
    const double(*hinges)[2] = (const double(*)[2])to->lattice.hinges;
    ax_sheet_map* map = ax_sheet_map_make(from);
    ax_sheet_map_carry(map, (const double(*)[3])from->deployed, n, hinges, deployed);
    ax_sheet_map_carry(map, (const double(*)[3])from->simulated, n, hinges, simulated);
    ax_sheet_map_free(map);
}

bool ax_form_nest(ax_form* f, const ax_progress* progress, bool* nested)
{
    size_t n = (size_t)f->lattice.linkage.hinge_count;
    int panels = COARSEST;
    *nested = false;
    if (f->outline_count == 0 || f->lattice.linkage.triangle_count < LEAST_NESTED)
        return true;
    while (2 * LEVEL * panels < f->lattice.linkage.triangle_count)
        panels *= LEVEL;
    if (!f->coarser) {
        f->coarser = coarsen(f, panels);
        f->outdated = true;
    }
    ax_error error;
    ax_status status = f->coarser ? carry_asked(f, f->coarser) : AX_CANNOT_REALISE;
    if (status == AX_OK)
        status = ax_form_settle(f->coarser, 0, progress, &error);
    if (status == AX_OK) {
        f->coarse.deployed = ax_alloc(n, sizeof *f->coarse.deployed);
        f->coarse.simulated = ax_alloc(n, sizeof *f->coarse.simulated);
        carry_states(f->coarser, f, f->coarse.deployed, f->coarse.simulated);
        *nested = true;
        return true;
    }
    ax_form_free(f->coarser);
    f->coarser = NULL;
    return status != AX_CANCELLED;
}

void ax_form_start_at_nest(ax_form* f)
{
    size_t n = (size_t)f->lattice.linkage.hinge_count;
    memcpy(f->deployed, f->coarse.deployed, n * sizeof *f->deployed);
    memcpy(f->simulated, f->coarse.simulated, n * sizeof *f->simulated);
    ax_form_changed(f, false, true);
}

int ax_form_list_inner(const ax_form* f, double margin, int* hinges)
{
    int count = 0;
    ax_polyline* outline = ax_form_outline_line(f->outline_count, (const double(*)[2])f->outline);
    for (int h = 0; h < f->lattice.linkage.hinge_count; ++h) {
        const double* at = f->lattice.hinges[h];
        if (ax_polyline_find(outline, (const double[3]){at[0], at[1], 0}).distance > margin * f->radius)
            hinges[count++] = h;
    }
    ax_polyline_free(outline);
    return count;
}

// How far hinges are from where the coarser sheet has them, over the size of the sheet, at most; and which.
static double away(const ax_form* f, const double (*x)[3], const double (*coarse)[3], int* hinge)
{
    static const double margin = 0.1; // nearer to the rim they go by steps of panels
    int n = f->lattice.linkage.hinge_count, *inner = AX_NEW(int, n), count = ax_form_list_inner(f, margin, inner);
    double lo[3] = {INFINITY, INFINITY, INFINITY}, hi[3] = {-INFINITY, -INFINITY, -INFINITY}, size = 0, most = 0;
    for (int h = 0; h < n; ++h)
        for (int c = 0; c < 3; ++c)
            lo[c] = fmin(lo[c], x[h][c]), hi[c] = fmax(hi[c], x[h][c]);
    for (int c = 0; c < 3; ++c)
        size = fmax(size, hi[c] - lo[c]);
    for (int k = 0; k < count; ++k) {
        double distance = ax_distance3(x[inner[k]], coarse[inner[k]]);
        if (distance > most)
            most = distance, *hinge = inner[k];
    }
    ax_free(inner);
    return most / size;
}

// Where it is drawn to is nothing that a coarser sheet has to be told.
static void rebuild(ax_form* f)
{
    bool outdated = f->outdated;
    int folds = f->folds;
    ax_form_changed(f, true, true);
    f->outdated = outdated, f->folds = folds;
    ax_form_build(f);
}

bool ax_form_draw_to_nest(ax_form* f)
{
    static const double least = 0.01; // of the size
    size_t n = (size_t)f->lattice.linkage.hinge_count;
    int hinge;
    if (!f->coarse.deployed || f->drawn || !ax_form_may_fold(f) ||
        away(f, (const double(*)[3])f->deployed, (const double(*)[3])f->coarse.deployed, &hinge) < least)
        return false;
    f->drawn = ax_copy(f->coarse.deployed, n, sizeof *f->drawn);
    f->lightly = false;
    rebuild(f);
    ax_form_start_at_nest(f);
    return true;
}

bool ax_form_draw_lightly(ax_form* f)
{
    if (!f->drawn || f->lightly)
        return false;
    f->lightly = true;
    rebuild(f);
    ax_form_start_at_nest(f);
    return true;
}

void ax_form_follow_nest(ax_form* f)
{
    if (!f->coarse.deployed) {
        ax_form_let_go(f);
        return;
    }
    memcpy(f->drawn, f->coarse.deployed, (size_t)f->lattice.linkage.hinge_count * sizeof *f->drawn);
    ax_form_aim_drawn(f);
}

void ax_form_let_go(ax_form* f)
{
    if (!f->drawn)
        return;
    ax_free(f->drawn);
    f->drawn = NULL;
    rebuild(f);
}

void ax_form_leave_nest(ax_form* f)
{
    f->apart = 0;
    if (!f->coarse.deployed)
        return;
    bool hangs = ax_form_hangs(f);
    f->apart = away(f, (const double(*)[3])(hangs ? f->simulated : f->deployed),
                    (const double(*)[3])(hangs ? f->coarse.simulated : f->coarse.deployed), &f->apart_hinge);
    ax_free(f->coarse.deployed);
    ax_free(f->coarse.simulated);
    f->coarse = (ax_form_coarse){NULL, NULL};
}
