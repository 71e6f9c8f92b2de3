#include "operator/rim.h"

#include "operator/selection.h"

static void copy_curve(ax_curve_shape* curve)
{
    curve->points = ax_copy(curve->points, (size_t)curve->count, sizeof *curve->points);
}

ax_rim ax_rim_copy(const ax_form* form)
{
    const ax_rim_part* parts;
    ax_rim rim = {.count = ax_form_rim(form, &parts)};
    rim.parts = AX_NEW(ax_rim_part, rim.count + 1); // room for one more
    for (int k = 0; k < rim.count; ++k) {
        ax_rim_part* part = &rim.parts[k];
        *part = parts[k];
        part->hinges = ax_copy(part->hinges, (size_t)part->count, sizeof *part->hinges);
        part->places =
            part->kind == AX_RIM_FIXED ? ax_copy(part->places, (size_t)part->count, sizeof *part->places) : NULL;
        if (part->kind == AX_RIM_SLIDE)
            copy_curve(&part->curve);
    }
    return rim;
}

static void free_part(ax_rim_part* part)
{
    ax_free((void*)part->hinges);
    ax_free((void*)part->places);
    if (part->kind == AX_RIM_SLIDE)
        ax_free((void*)part->curve.points);
}

void ax_rim_free(ax_rim* rim)
{
    for (int k = 0; k < rim->count; ++k)
        free_part(&rim->parts[k]);
    ax_free(rim->parts);
    *rim = (ax_rim){0};
}

static bool is_among(int hinge, int count, const int* hinges)
{
    for (int k = 0; k < count; ++k)
        if (hinges[k] == hinge)
            return true;
    return false;
}

void ax_rim_take_out(ax_rim* rim, int count, const int* hinges)
{
    int parts = 0;
    for (int p = 0; p < rim->count; ++p) {
        ax_rim_part part = rim->parts[p];
        int *kept = (int*)part.hinges, n = 0;
        double(*places)[3] = (double(*)[3])part.places;
        for (int k = 0; k < part.count; ++k) {
            if (is_among(kept[k], count, hinges))
                continue;
            kept[n] = kept[k];
            if (places)
                memmove(places[n], places[k], sizeof *places);
            ++n;
        }
        part.count = n;
        if (n)
            rim->parts[parts++] = part;
        else
            free_part(&part);
    }
    rim->count = parts;
}

// The part that holds a hinge, NULL if none does.
static ax_rim_part* part_of(ax_rim* rim, int hinge)
{
    for (int p = 0; p < rim->count; ++p)
        if (is_among(hinge, rim->parts[p].count, rim->parts[p].hinges))
            return &rim->parts[p];
    return NULL;
}

static void set_points(ax_rim_part* part, int count, const double (*points)[3])
{
    const double(*copy)[3] = ax_copy(points, (size_t)count, sizeof *points);
    ax_free((void*)part->curve.points);
    part->curve.points = copy;
    part->curve.count = count;
}

ax_status ax_rim_hinges(const ax_operator_context* context, const char* words, int** hinges, int* count,
                        ax_error* error)
{
    ax_status status = ax_operator_hinges(context, words, 1, hinges, count, error);
    if (status != AX_OK)
        return status;
    ax_form_view view = ax_form_look(*context->form);
    ax_hinges rim = ax_hinges_make(view.linkage);
    ax_select_rim(&view, &rim);
    unsigned char* chosen = AX_NEW0(unsigned char, view.linkage->hinge_count);
    for (int k = 0; k < *count && status == AX_OK; ++k) {
        chosen[(*hinges)[k]] = 1;
        if (!rim.in[(*hinges)[k]])
            status =
                ax_fail(error, AX_BAD_INPUT,
                        "\"%s\" chooses hinge %d, which is not on the rim. Inner hinges are held by constraints such "
                        "as hold_curve.",
                        words, (*hinges)[k]);
    }
    // a run that passes the rim's first hinge begins where it begins, not there
    int start = 0, n = 0;
    for (int k = 1; k < rim.count && chosen[rim.hinges[0]] && chosen[rim.hinges[rim.count - 1]]; ++k)
        if (chosen[rim.hinges[k]] && !chosen[rim.hinges[k - 1]])
            start = k;
    for (int k = 0; k < rim.count && status == AX_OK; ++k)
        if (chosen[rim.hinges[(start + k) % rim.count]])
            (*hinges)[n++] = rim.hinges[(start + k) % rim.count];
    if (status != AX_OK) {
        ax_free(*hinges);
        *hinges = NULL;
    }
    ax_free(chosen);
    ax_hinges_free(&rim);
    return status;
}

ax_status ax_rim_slide(const ax_operator_context* context, const char* words, const ax_curve_shape* curve,
                       ax_error* error)
{
    int *hinges, count;
    ax_status status = ax_rim_hinges(context, words, &hinges, &count, error);
    if (status != AX_OK)
        return status;
    ax_rim rim = ax_rim_copy(*context->form);
    ax_rim_take_out(&rim, count, hinges);
    rim.parts[rim.count] = (ax_rim_part){.kind = AX_RIM_SLIDE, .count = count, .hinges = hinges, .curve = *curve};
    copy_curve(&rim.parts[rim.count++].curve);
    status = ax_form_set_rim(*context->form, rim.count, rim.parts, error);
    ax_rim_free(&rim);
    return status;
}

// ---- control points ----------------------------------------------------------------------------------------------------------

static ax_status edit_points(ax_rim_part* part, const ax_control* c, ax_control_edit edit, ax_error* error)
{
    int n = part->curve.count, most = edit == AX_CONTROL_ADD ? n : n - 1, fewest = part->curve.closed ? 3 : 2;
    if (c->point > most)
        return ax_fail(error, AX_BAD_INPUT, "The curve has %d control points; \"point\" is 0 to %d.", n, most);
    if (edit == AX_CONTROL_REMOVE && n <= fewest)
        return ax_fail(error, AX_BAD_INPUT, "The curve has only %d control points and needs them.", n);
    double(*points)[3] = ax_alloc((size_t)n + 1, sizeof *points);
    memcpy(points, part->curve.points, (size_t)n * sizeof *points);
    double(*here)[3] = points + c->point;
    size_t beyond = (size_t)(n - c->point) * sizeof *points;
    if (edit == AX_CONTROL_ADD)
        memmove(here + 1, here, beyond);
    if (edit == AX_CONTROL_REMOVE)
        memmove(here, here + 1, beyond - sizeof *points);
    else
        memcpy(*here, c->at, sizeof *here);
    set_points(part, n + (edit == AX_CONTROL_ADD) - (edit == AX_CONTROL_REMOVE), (const double(*)[3])points);
    ax_free(points);
    return AX_OK;
}

ax_status ax_rim_control(const ax_operator_context* context, const ax_control* control, ax_control_edit edit,
                         ax_error* error)
{
    int *hinges, count;
    ax_status status = ax_operator_hinges(context, control->hinges, 1, &hinges, &count, error);
    if (status != AX_OK)
        return status;
    ax_rim rim = ax_rim_copy(*context->form);
    ax_rim_part* part = part_of(&rim, hinges[0]);
    bool controlled = part && part->kind == AX_RIM_SLIDE &&
                      (part->curve.kind == AX_CURVE_SPLINE || part->curve.kind == AX_CURVE_POLYLINE);
    status = controlled ? edit_points(part, control, edit, error)
                        : ax_fail(error, AX_BAD_INPUT,
                                  "Hinge %d does not slide on a curve with control points. rim_spline and rim_polyline "
                                  "make one.",
                                  hinges[0]);
    if (status == AX_OK)
        status = ax_form_set_rim(*context->form, rim.count, rim.parts, error);
    ax_rim_free(&rim);
    ax_free(hinges);
    return status;
}

void ax_rim_through_defaults(void* through)
{
    *(ax_rim_through*)through = (ax_rim_through){.hinges = "rim", .closed = true};
}

const char* ax_rim_through_check(const void* through, int* field)
{
    const ax_rim_through* a = through;
    *field = 1;
    return a->closed && a->points.count < 3 ? "a closed curve needs three points." : NULL;
}

ax_status ax_rim_slide_through(const ax_operator_context* context, const ax_rim_through* through, ax_curve_kind kind,
                               ax_error* error)
{
    const ax_curve_shape curve = {.kind = kind,
                                  .closed = through->closed,
                                  .fillet = through->fillet,
                                  .count = through->points.count,
                                  .points = (const double(*)[3])through->points.values};
    return ax_rim_slide(context, through->hinges, &curve, error);
}
