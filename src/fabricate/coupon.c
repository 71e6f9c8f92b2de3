// Trial cuts: how wide the beam is, and which hinge a material bears.
#include "fabricate/work.h"

#include "base/vec.h"
#include "fabricate/stroke_font.h"

#include <stdio.h>

static const double text_height = 4, text_gap = 3; // mm

static void begin(ax_work* w, ax_cut_plan* plan, const ax_fabricate_options* options, const char* title)
{
    int profiles;
    *plan = (ax_cut_plan){.joint = options->joint, .material = options->material, .sheet_count = 1};
    plan->profile = options->profile ? options->profile : ax_profiles(&profiles);
    plan->sheets = AX_NEW0(ax_cut_sheet, 1);
    snprintf(plan->title, sizeof plan->title, "%s", title);
    *w = (ax_work){.options = options, .plan = plan, .builder = {.plan = plan}};
}

// Once the content lies in [0, size]: moves it above the notes, and closes the sheet.
static void finish(ax_work* w, const double size[2])
{
    ax_cut_plan* plan = w->plan;
    double margin = w->options->margin, width = fmax(size[0], ax_notes_width());
    w->strip = ax_notes_strip(w, width);
    for (int k = 0; k < plan->point_count; ++k)
        plan->points[k].x += margin, plan->points[k].y += 2 * margin + w->strip;
    ax_cut_sheet* sheet = &plan->sheets[0];
    *sheet = (ax_cut_sheet){.width = ceil(width + 2 * margin), .height = ceil(size[1] + 3 * margin + w->strip)};
    ax_put_notes(w, 0);
    sheet->count = plan->item_count;
    ax_order_sheet(plan, sheet);
}

static void put_text(ax_work* w, const char* name, const char* text, double x, double y)
{
    ax_plan_item(&w->builder, AX_LABEL, -1, "%s", name);
    ax_plan_text(&w->builder, text, text_height, &(ax_motion){1, 0, x, y});
}

// Ten rectangles in a row, cut from each other by single lines and from the sheet. Pushed together they are ten kerfs shorter than
// drawn, whatever the machine.
static void draw_kerf(ax_work* w)
{
    enum { PIECES = 10 };
    const double wide = AX_NOTE_BAR / PIECES, high = 20, base = text_height + text_gap;
    ax_plan_builder* b = &w->builder;
    put_text(w, "label", "kerf = (100 - length) / 10", 0, 0);
    for (int k = 1; k < PIECES; ++k) {
        ax_plan_item(b, AX_SLIT, -1, "slit-%d", k);
        ax_plan_path(b, false);
        ax_plan_point(b, k * wide, base);
        ax_plan_point(b, k * wide, base + high);
    }
    ax_plan_item(b, AX_CUT, -1, "cut");
    ax_plan_path(b, true);
    ax_plan_point(b, 0, base);
    ax_plan_point(b, AX_NOTE_BAR, base);
    ax_plan_point(b, AX_NOTE_BAR, base + high);
    ax_plan_point(b, 0, base + high);
    finish(w, (double[2]){AX_NOTE_BAR, base + high});
}

// Two panels of the given edge on one hinge, with a mouth of 20 degrees.
static ax_status make_pair(double edge, const ax_fabricate_options* options, ax_cut_plan* plan, ax_error* error)
{
    int triangles[2][3] = {{0, 1, 2}, {0, 3, 4}}, panels[2][3] = {{0, 0, 0}, {0, 0, 1}};
    int none[] = {0}, start[] = {0, 3, 6}, hinges[] = {3, 0, 2, 1, 0, 4};
    unsigned char on_rim[5] = {0, 1, 1, 1, 1};
    double flat[5][2] = {{0}}, deployed[5][3] = {{0}};
    static const double degrees[5] = {0, 100, 160, 20, 80}, open[5] = {0, 150, 210, -30, 30};
    for (int h = 1; h < 5; ++h) {
        flat[h][0] = edge * cos(degrees[h] * AX_PI / 180), flat[h][1] = edge * sin(degrees[h] * AX_PI / 180);
        deployed[h][0] = edge * cos(open[h] * AX_PI / 180), deployed[h][1] = edge * sin(open[h] * AX_PI / 180);
    }
    const ax_design pair = {.unit = AX_MILLIMETRE,
                            .linkage = {.triangle_count = 2,
                                        .hinge_count = 5,
                                        .triangles = triangles,
                                        .panels = panels,
                                        .hole_start = none,
                                        .opening_count = 2,
                                        .opening_start = start,
                                        .opening_hinges = hinges,
                                        .on_rim = on_rim},
                            .flat = flat,
                            .deployed = deployed};
    return ax_fabricate(&pair, options, NULL, plan, error);
}

// Copies what is cut of a pair, its lower left corner to (x, 0); returns its size.
static void take_pair(ax_work* w, const ax_cut_plan* pair, int trial, double x, double y, double size[2])
{
    ax_plan_builder* b = &w->builder;
    double lo[2] = {INFINITY, INFINITY}, hi[2] = {-INFINITY, -INFINITY};
    for (int pass = 0; pass < 2; ++pass)
        for (int i = 0; i < pair->item_count; ++i) {
            const ax_cut_item* item = &pair->items[i];
            if (item->operation == AX_LABEL || item->operation == AX_NOTE)
                continue;
            if (pass)
                ax_plan_item(b, item->operation, -1, "%d-%.24s", trial + 1, item->name);
            for (int k = item->first; k < item->first + item->count; ++k) {
                const ax_cut_path* path = &pair->paths[k];
                if (!pass) {
                    ax_path_bounds(pair, path, lo, hi);
                    continue;
                }
                ax_plan_path(b, path->closed);
                for (int v = path->first; v < path->first + path->count; ++v) {
                    const ax_cut_point* p = &pair->points[v];
                    ax_plan_point(b, p->x - lo[0] + x, p->y - lo[1] + y);
                    b->plan->points[b->plan->point_count - 1].bulge = p->bulge;
                }
            }
        }
    size[0] = hi[0] - lo[0], size[1] = hi[1] - lo[1];
}

static ax_status draw_hinges(ax_work* w, ax_error* error)
{
    const struct ax_joint_work* work = w->plan->joint->work;
    ax_fabricate_options options = *w->options;
    const ax_joint_parameter* parameter = &options.joint->parameters[work->trial.parameter];
    double chosen = options.joint_values[work->trial.parameter], size[2] = {0, 0};
    chosen = isnan(chosen) ? fmax(parameter->standard, work->trial.factors ? options.material.feature : 0) : chosen;
    options.material.feature = 0; // to be found out
    options.sheet[0] = options.sheet[1] = 0;
    options.clearance = false;
    for (int k = 0; k < 5; ++k) {
        double value = work->trial.value[k] * (work->trial.factors ? chosen : 1), pair_size[2];
        options.joint_values[work->trial.parameter] = value;
        ax_cut_plan pair;
        ax_status status = AX_CANNOT_REALISE;
        for (double edge = 40; status == AX_CANNOT_REALISE && edge < 400; edge *= 1.25)
            status = make_pair(edge, &options, &pair, error);
        if (status != AX_OK)
            return status;
        char text[64], name[28];
        snprintf(text, sizeof text, "%s %.3g", parameter->name, value);
        snprintf(name, sizeof name, "label-%d", k + 1);
        put_text(w, name, text, size[0], 0);
        take_pair(w, &pair, k, size[0], text_height + text_gap, pair_size);
        ax_cut_plan_free(&pair);
        size[0] += fmax(pair_size[0], text_height * ax_stroke_width(text)) + 2 * text_height;
        size[1] = fmax(size[1], text_height + text_gap + pair_size[1]);
    }
    finish(w, size);
    return AX_OK;
}

ax_status ax_fabricate_coupon(ax_coupon coupon, const ax_fabricate_options* options, ax_cut_plan* plan, ax_error* error)
{
    const ax_fabricate_options standard = ax_fabricate_options_default();
    options = options ? options : &standard;
    *plan = (ax_cut_plan){0};
    if (coupon == AX_COUPON_HINGE && options->joint->work->trial.value[4] == 0)
        return ax_fail(error, AX_USAGE, "The joint \"%s\" has nothing to try. Choose another one with --joint.",
                       options->joint->name);
    ax_work w;
    begin(&w, plan, options, coupon == AX_COUPON_KERF ? "kerf coupon" : "hinge coupon");
    if (coupon == AX_COUPON_KERF) {
        draw_kerf(&w);
        return AX_OK;
    }
    plan->kerf = options->kerf;
    ax_status status = draw_hinges(&w, error);
    if (status != AX_OK)
        ax_cut_plan_free(plan);
    return status;
}
