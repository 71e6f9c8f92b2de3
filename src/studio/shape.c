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

static void loop_centre(const double (*places)[3], int count, const int* loop, double centre[3])
{
    memset(centre, 0, 3 * sizeof *centre);
    for (int k = 0; k < count; ++k)
        for (int c = 0; c < 3; ++c)
            centre[c] += places[loop[k]][c] / count;
}

// Twice the vector area of a loop of hinges about its centre.
static void loop_normal(const double (*places)[3], int count, const int* loop, const double centre[3], double normal[3])
{
    memset(normal, 0, 3 * sizeof *normal);
    for (int k = 0; k < count; ++k) {
        double a[3], b[3], cross[3];
        ax_sub3(places[loop[k]], centre, a);
        ax_sub3(places[loop[(k + 1) % count]], centre, b);
        ax_cross(a, b, cross);
        for (int c = 0; c < 3; ++c)
            normal[c] += cross[c];
    }
}

// The two holes at each hinge, -1 on the rim.
static int (*holes_at_hinges(const ax_linkage* l))[2]
{
    int(*at)[2] = ax_alloc((size_t)l->hinge_count, sizeof *at);
    for (int h = 0; h < l->hinge_count; ++h)
        at[h][0] = at[h][1] = -1;
    for (int k = 0; k < l->hole_count; ++k)
        for (int i = l->hole_start[k]; i < l->hole_start[k + 1]; ++i) {
            int h = l->hole_hinges[i];
            at[h][at[h][0] >= 0] = k;
        }
    return at;
}

// Mean curvature of the deployed state per triangle. Hole centres are the vertices of the base mesh; with even spokes the Laplacian
// of position is 4 (mean of the neighbours - centre) / their squared distance = -2 H n. NaN where every hole is at the rim.
static double* mean_curvature(const ax_form_view* v)
{
    const ax_linkage* l = v->linkage;
    int(*at)[2] = holes_at_hinges(l);
    double(*centre)[3] = ax_alloc((size_t)l->hole_count + 1, sizeof *centre), total = 0;
    double *sum = AX_NEW0(double, l->hinge_count), *result = AX_NEW(double, l->triangle_count);
    int* holes = AX_NEW0(int, l->hinge_count);
    for (int k = 0; k < l->hole_count; ++k)
        loop_centre(v->deployed, l->hole_start[k + 1] - l->hole_start[k], l->hole_hinges + l->hole_start[k], centre[k]);
    for (int k = 0; k < l->hole_count; ++k) {
        int count = l->hole_start[k + 1] - l->hole_start[k];
        const int* loop = l->hole_hinges + l->hole_start[k];
        double mean[3] = {0}, square = 0, normal[3];
        bool inside = true;
        for (int i = 0; i < count && inside; ++i) {
            int other = at[loop[i]][at[loop[i]][0] == k];
            if ((inside = other >= 0)) {
                double spoke[3];
                ax_sub3(centre[other], centre[k], spoke);
                square += ax_dot3(spoke, spoke) / count;
                for (int c = 0; c < 3; ++c)
                    mean[c] += spoke[c] / count;
            }
        }
        loop_normal(v->deployed, count, loop, centre[k], normal);
        double length = ax_norm3(normal);
        if (!inside || !(length > 0) || !(square > 0))
            continue;
        double curvature = -2 / square * ax_dot3(mean, normal) / length;
        total += curvature * length;
        for (int i = 0; i < count; ++i)
            sum[loop[i]] += curvature, ++holes[loop[i]];
    }
    double side = total < 0 ? -1 : 1; // the side to which it bulges as a whole
    for (int t = 0; t < l->triangle_count; ++t) {
        const int* corner = l->triangles[t];
        int count = holes[corner[0]] + holes[corner[1]] + holes[corner[2]];
        result[t] = count ? side * (sum[corner[0]] + sum[corner[1]] + sum[corner[2]]) / count : NAN;
    }
    ax_free(at);
    ax_free(centre);
    ax_free(sum);
    ax_free(holes);
    return result;
}

shape_measures shape_measure(const ax_form_view* v)
{
    shape_measures m = {.mouth = ax_measure_mouth_angles(v->linkage, v->flat),
                        .residual = edge_residuals(v, v->simulated ? v->simulated : v->deployed),
                        .curvature = mean_curvature(v)};
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

void shape_put_places(board* b, const ax_form_view* v, const shape_frame* frame)
{
    int n = v->linkage->hinge_count;
    board_put_numbers(b, SECTION_FLAT, 2 * n, *v->flat, 2, frame->flat_origin);
    board_put_numbers(b, SECTION_DEPLOYED, 3 * n, *v->deployed, 3, frame->origin);
    if (v->simulated)
        board_put_numbers(b, SECTION_SIMULATED, 3 * n, *v->simulated, 3, frame->origin);
    else
        board_clear(b, SECTION_SIMULATED, SECTION_F32);
    board_put_numbers(b, SECTION_PRESCRIBED, v->linkage->triangle_count, v->prescribed, 1, NULL);
}

void shape_put_rest(board* b, const ax_form_view* v, const shape_measures* m)
{
    const ax_linkage* l = v->linkage;
    board_put_numbers(b, SECTION_REALISED, l->triangle_count, v->realised, 1, NULL);
    board_put_numbers(b, SECTION_OPENING, l->hole_count, v->opening, 1, NULL);
    board_put_numbers(b, SECTION_MATERIAL, l->hinge_count, v->material, 1, NULL);
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
