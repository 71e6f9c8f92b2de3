#include "studio/shape.h"

#include "analysis/measure.h"
#include "base/vec.h"

#include <string.h>

// ---- measures -----------------------------------------------------------------------------------------------------------------

// Largest relative difference between an edge in space and in the flat state, per triangle.
static double* edge_residuals(const ax_form_view* v, const double (*places)[3])
{
    double* residual = AX_NEW0(double, v->linkage->triangle_count);
    for (int t = 0; t < v->linkage->triangle_count; ++t)
        for (int k = 0; k < 3; ++k) {
            int a = v->linkage->triangles[t][k], b = v->linkage->triangles[t][(k + 1) % 3];
            double flat = ax_distance2(v->flat[a], v->flat[b]);
            residual[t] = fmax(residual[t], fabs(ax_distance3(places[a], places[b]) / flat - 1));
        }
    return residual;
}

shape_measures shape_measure(ax_form* form, const ax_form_view* v)
{
    shape_measures m = {.mouth = ax_measure_mouth_angles(v->linkage, v->flat),
                        .residual = edge_residuals(v, v->simulated ? v->simulated : v->deployed),
                        .curvature = AX_NEW(double, v->linkage->triangle_count),
                        .opening = ax_form_opening(form),
                        .material = ax_form_material(form)};
    ax_measure_mean_curvature(v->linkage, v->deployed, m.curvature);
    for (int h = 0; h < v->linkage->hinge_count; ++h)
        if (!isfinite(m.mouth[h]))
            m.mouth[h] = NAN;
    return m;
}

void shape_measures_free(shape_measures* m)
{
    ax_free(m->mouth);
    ax_free(m->residual);
    ax_free(m->curvature);
    *m = (shape_measures){0};
}

// ---- sections -----------------------------------------------------------------------------------------------------------------

static void put_names(board* b, const ax_linkage* l)
{
    size_t used = 0;
    char* names = AX_NEW(char, 17 * l->triangle_count);
    for (int t = 0; t < l->triangle_count; ++t) {
        ax_panel_name(l, t, names + used);
        used += strlen(names + used);
        names[used++] = '\n';
    }
    board_put_bytes(b, SECTION_NAMES, (int)used, (const unsigned char*)names);
    ax_free(names);
}

shape_frame shape_new_linkage(board* b, const ax_form_view* v)
{
    const ax_linkage* l = v->linkage;
    shape_frame frame = {0};
    for (int h = 0; h < l->hinge_count; ++h) {
        for (int c = 0; c < 3; ++c)
            frame.origin[c] += v->deployed[h][c] / l->hinge_count;
        for (int c = 0; c < 2; ++c)
            frame.flat_origin[c] += v->flat[h][c] / l->hinge_count;
    }
    ++b->topology;
    board_put_ints(b, SECTION_TRIANGLES, 3 * l->triangle_count, *l->triangles);
    board_put_ints(b, SECTION_HOLE_START, l->hole_count + 1, l->hole_start);
    board_put_ints(b, SECTION_HOLE_HINGES, l->hole_start[l->hole_count], l->hole_hinges);
    board_put_ints(b, SECTION_OPENING_START, l->opening_count + 1, l->opening_start);
    board_put_ints(b, SECTION_OPENING_HINGES, l->opening_start[l->opening_count], l->opening_hinges);
    board_put_bytes(b, SECTION_ON_RIM, l->hinge_count, l->on_rim);
    board_put_ints(b, SECTION_PANELS, 3 * l->triangle_count, *l->panels);
    put_names(b, l);
    board_put_numbers(b, SECTION_SHEET, 2 * l->hinge_count, *v->sheet, 2, NULL);
    return frame;
}

void shape_put_places(board* b, const ax_form_view* v, const shape_frame* frame, bool all)
{
    int n = v->linkage->hinge_count;
    board_put_numbers(b, SECTION_FLAT, 2 * n, *v->flat, 2, frame->flat_origin);
    if (all || !v->simulated)
        board_put_numbers(b, SECTION_DEPLOYED, 3 * n, *v->deployed, 3, frame->origin);
    if (v->simulated)
        board_put_numbers(b, SECTION_SIMULATED, 3 * n, *v->simulated, 3, frame->origin);
    else
        board_clear(b, SECTION_SIMULATED, SECTION_F32);
    board_put_numbers(b, SECTION_PRESCRIBED, v->linkage->triangle_count, v->prescribed, 1, NULL);
    board_put_numbers(b, SECTION_REALISED, v->linkage->triangle_count, v->realised, 1, NULL);
}

void shape_put_rest(board* b, const ax_form_view* v, const shape_measures* m)
{
    const ax_linkage* l = v->linkage;
    board_put_numbers(b, SECTION_OPENING, l->hole_count, m->opening, 1, NULL);
    board_put_numbers(b, SECTION_MATERIAL, l->hinge_count, m->material, 1, NULL);
    board_put_numbers(b, SECTION_MOUTH, l->hinge_count, m->mouth, 1, NULL);
    board_put_numbers(b, SECTION_RESIDUAL, l->triangle_count, m->residual, 1, NULL);
    board_put_numbers(b, SECTION_CURVATURE, l->triangle_count, m->curvature, 1, NULL);
}

// The hinges that rim and constraints hold under the load.
static void put_supports(board* b, const ax_linkage* l, const ax_form* form, const ax_design* design)
{
    unsigned char* held = AX_NEW0(unsigned char, l->hinge_count);
    if (design && design->supports)
        memcpy(held, design->supports, (size_t)l->hinge_count);
    const ax_rim_part* parts;
    const ax_form_constraint* constraints;
    int count = design ? 0 : ax_form_rim(form, &parts);
    for (int k = 0; k < count; ++k)
        for (int i = 0; parts[k].kind != AX_RIM_FREE && i < parts[k].count; ++i)
            held[parts[k].hinges[i]] = 1;
    count = design ? 0 : ax_form_constraints(form, &constraints);
    for (int k = 0; k < count; ++k)
        for (int i = 0; constraints[k].support && i < constraints[k].count; ++i)
            held[constraints[k].hinges[i]] = 1;
    board_put_bytes(b, SECTION_SUPPORTS, l->hinge_count, held);
    ax_free(held);
}

void shape_put_exact(board* b, const ax_form_view* v, const ax_form* form, const ax_design* design)
{
    const ax_linkage* l = v->linkage;
    put_supports(b, l, form, design);
    if (!design || !design->simulated || !design->edge_forces || !design->forces) {
        board_clear(b, SECTION_EDGE_FORCES, SECTION_F32);
        board_clear(b, SECTION_REACTIONS, SECTION_F32);
        return;
    }
    typedef const double(*places)[3];
    double(*reaction)[3] =
        ax_measure_unbalanced(l, (places)design->simulated, (places)design->edge_forces, (places)design->forces);
    for (int h = 0; h < l->hinge_count; ++h)
        for (int c = 0; c < 3; ++c)
            reaction[h][c] = design->supports[h] ? -reaction[h][c] : 0;
    board_put_numbers(b, SECTION_EDGE_FORCES, 3 * l->triangle_count, *design->edge_forces, 3, NULL);
    board_put_numbers(b, SECTION_REACTIONS, 3 * l->hinge_count, *reaction, 3, NULL);
    ax_free(reaction);
}
