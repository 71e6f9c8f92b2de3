// From a design to a cut plan: scale to millimetres, panels by the joint's rule, sheets, drawing, order.
#include "ax/fabricate.h"

#include "base/vec.h"
#include "fabricate/openings.h"
#include "fabricate/work.h"
#include "linkage/lattice.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

const ax_joint_type* ax_joint_named(const char* name)
{
    int count;
    const ax_joint_type* const* types = ax_joint_types(&count);
    for (int k = 0; k < count; ++k)
        if (strcmp(types[k]->name, name) == 0)
            return types[k];
    return NULL;
}

ax_fabricate_options ax_fabricate_options_default(void)
{
    ax_fabricate_options o = {
        .joint = ax_joint_named("none"),
        .material = *ax_material_named("card-0.5"),
        .margin = 10,
        .spacing = 2,
        .clearance = true,
        .frames = 7,
    };
    for (int k = 0; k < 8; ++k)
        o.joint_values[k] = NAN;
    return o;
}

static void begin(ax_work* w)
{
    const ax_design* d = w->design;
    const ax_fabricate_options* o = w->options;
    ax_cut_plan* plan = w->plan;
    double mm = 1000 * ax_unit_in_metres(d->unit);
    w->flat = ax_alloc((size_t)w->linkage->hinge_count, sizeof *w->flat);
    for (int h = 0; h < w->linkage->hinge_count; ++h)
        for (int k = 0; k < 2; ++k)
            w->flat[h][k] = mm * d->flat[h][k];
    w->held = ax_linkage_hinge_triangles(w->linkage);
    plan->joint = o->joint;
    plan->material = o->material;
    bool chosen[8] = {false};
    for (int k = 0; k < o->joint->parameter_count; ++k) {
        chosen[k] = !isnan(o->joint_values[k]);
        plan->joint_values[k] = chosen[k] ? o->joint_values[k] : o->joint->parameters[k].standard;
    }
    if (o->joint->work->suit)
        o->joint->work->suit(&plan->material, chosen, plan->joint_values);
    plan->kerf = o->kerf;
    plan->sizes = o->sizes;
    int profiles;
    plan->profile = o->profile ? o->profile : ax_profiles(&profiles);
    ax_plan_set_title(plan, o->title);
    snprintf(plan->date, sizeof plan->date, "%s", o->date ? o->date : "");
    w->joint = (ax_joint_job){plan->joint_values, &plan->material};
}

static void name_panels(ax_work* w)
{
    ax_cut_plan* plan = w->plan;
    plan->panel_count = w->linkage->triangle_count;
    plan->panels = AX_NEW0(ax_cut_panel, plan->panel_count);
    for (int t = 0; t < plan->panel_count; ++t) {
        ax_cut_panel* p = &plan->panels[t];
        ax_panel_name(w->linkage, t, p->name);
        p->row = w->linkage->panels[t][1];
        p->layer = plan->joint->two_layers ? w->linkage->panels[t][2] : 0;
    }
}

// The outline of a loose panel and its holes.
static ax_status put_loose_panel(ax_work* w, int t, ax_error* error)
{
    ax_panel_outline o = ax_work_outline(w, t, 0);
    if (o.slack[o.tight] < 0) {
        const int* corner = w->linkage->triangles[t];
        double edge = ax_distance2(w->flat[corner[o.tight]], w->flat[corner[(o.tight + 1) % 3]]);
        return ax_fail(
            error, AX_CANNOT_REALISE,
            "Panel %s is too small for the joint \"%s\": one of its edges has %.3g mm and needs %.3g mm. Make "
            "the joint smaller, or design with fewer and larger panels.",
            w->plan->panels[t].name, w->plan->joint->name, edge, edge - o.slack[o.tight]);
    }
    ax_panel_put_outline(&w->builder, &o, &ax_stay);
    double middle[2], inner = ax_inscribed_circle(w, t, middle), deepest = w->rule.hole_offset + w->rule.radius;
    for (int k = 0; k < 3 && o.hole_radius > 0; ++k) {
        double reach = ax_distance2(w->flat[w->linkage->triangles[t][k]], middle);
        if (reach < deepest)
            return ax_fail(
                error, AX_CANNOT_REALISE,
                "Panel %s is too small for the joint \"%s\": its holes and their edges reach %.3g mm inward, "
                "beyond its middle, which lies %.3g mm from a corner (inscribed circle of %.3g mm). Make the "
                "joint smaller, or design with fewer and larger panels.",
                w->plan->panels[t].name, w->plan->joint->name, deepest, reach, inner);
        ax_panel_put_hole(&w->builder, &o, k, &ax_stay);
    }
    return AX_OK;
}

static ax_status shape_panels(ax_work* w, ax_error* error)
{
    ax_cut_plan* plan = w->plan;
    bool one_piece = plan->joint->one_piece;
    ax_status status = one_piece ? ax_openings_check(w, error) : AX_OK;
    for (int t = 0; t < plan->panel_count && status == AX_OK; ++t) {
        ax_cut_panel* p = &plan->panels[t];
        p->first = plan->path_count;
        if (one_piece)
            ax_openings_put_panel(w, t);
        else
            status = put_loose_panel(w, t, error);
        p->count = plan->path_count - p->first;
        for (int k = p->first; k < p->first + p->count; ++k)
            p->area += ax_path_area(plan, &plan->paths[k]);
        p->mass = p->area * plan->material.thickness * 1e-9 * plan->material.density;
        plan->area += p->area;
        plan->mass += p->mass;
    }
    return status;
}

static void draw_loose_panel(ax_work* w, int t)
{
    const ax_cut_panel* p = &w->plan->panels[t];
    ax_motion motion = {p->placement[0], p->placement[1], p->placement[2], p->placement[3]};
    ax_panel_outline o = ax_work_outline(w, t, w->plan->kerf / 2);
    for (int k = 0; k < 3 && o.hole_radius > 0; ++k) {
        ax_plan_item(&w->builder, AX_HOLE, t, "hole-%s.%d", p->name, k);
        ax_panel_put_hole(&w->builder, &o, k, &motion);
    }
    ax_plan_item(&w->builder, AX_CUT, t, "cut-%s", p->name);
    ax_panel_put_outline(&w->builder, &o, &motion);
}

static void draw_sheets(ax_work* w)
{
    ax_cut_plan* plan = w->plan;
    w->met = AX_NEW0(unsigned char, 3 * plan->panel_count);
    for (int s = 0; s < plan->sheet_count; ++s) {
        ax_cut_sheet* sheet = &plan->sheets[s];
        double area = 0;
        sheet->first = plan->item_count;
        for (int i = w->sheet_start[s]; i < w->sheet_start[s + 1]; ++i) {
            int t = w->sheet_panels[i];
            ax_put_label(w, t);
            if (!isnan(w->outside[t][0]))
                ax_put_label_outside(w, t, w->outside[t][0], w->outside[t][1], w->outside[t][2]);
            if (plan->joint->one_piece)
                ax_put_seams(w, t);
            else
                draw_loose_panel(w, t);
            if (!plan->joint->one_piece && !plan->in_place)
                ax_put_neighbours(w, t);
            area += plan->panels[t].area;
        }
        if (plan->joint->one_piece)
            ax_openings_draw(w, s);
        ax_put_notes(w, s);
        sheet->count = plan->item_count - sheet->first;
        sheet->utilisation = area / (sheet->width * sheet->height);
        ax_order_sheet(plan, sheet);
    }
}

static void measure(ax_cut_plan* plan)
{
    double sheets = 0;
    for (int s = 0; s < plan->sheet_count; ++s) {
        const ax_cut_sheet* sheet = &plan->sheets[s];
        sheets += sheet->width * sheet->height;
        for (int i = sheet->first; i < sheet->first + sheet->count; ++i)
            for (int k = plan->items[i].first; k < plan->items[i].first + plan->items[i].count; ++k)
                plan->cut_length[plan->items[i].operation] += ax_path_length(plan, &plan->paths[k]);
    }
    plan->utilisation = plan->area / sheets;
    for (int k = 0; k < AX_NOTE; ++k)
        if (plan->profile->pens[k].used)
            plan->seconds += plan->cut_length[k] / plan->profile->pens[k].speed;
    plan->seconds += plan->travel / plan->profile->travel_speed;
}

static void count_parts(ax_work* w)
{
    const struct ax_joint_work* work = w->plan->joint->work;
    int joints = 0;
    for (int h = 0; h < w->linkage->hinge_count; ++h)
        joints += !w->linkage->on_rim[h];
    if (!work->part)
        return;
    w->plan->parts = AX_NEW0(ax_cut_part, 1);
    w->plan->part_count = 1;
    work->part(&w->joint, joints, &w->plan->parts[0]);
}

static void doubt_joint(ax_work* w)
{
    const struct ax_joint_work* work = w->plan->joint->work;
    double least = INFINITY;
    for (int t = 0; t < w->linkage->triangle_count && work->doubt; ++t) {
        const int* corner = w->linkage->triangles[t];
        for (int k = 0; k < 3; ++k)
            least = fmin(least, ax_distance2(w->flat[corner[k]], w->flat[corner[(k + 1) % 3]]));
    }
    if (work->doubt)
        work->doubt(&w->joint, least, w->plan->doubt, sizeof w->plan->doubt);
}

ax_status ax_fabricate(const ax_design* design, const ax_fabricate_options* options, const ax_progress* progress,
                       ax_cut_plan* plan, ax_error* error)
{
    const ax_fabricate_options standard = ax_fabricate_options_default();
    *plan = (ax_cut_plan){0};
    ax_work w = {.design = design,
                 .linkage = &design->linkage,
                 .options = options ? options : &standard,
                 .progress = progress,
                 .plan = plan,
                 .builder = {.plan = plan}};
    int pieces = 0;
    begin(&w);
    name_panels(&w);
    ax_status status = plan->joint->work->rule(&w.joint, &w.rule, error);
    if (status == AX_OK)
        status = ax_find_pieces(&w, &pieces, error);
    if (status == AX_OK)
        ax_number_seams(&w);
    if (status == AX_OK)
        status = shape_panels(&w, error);
    if (status == AX_OK) {
        ax_choose_labels(&w);
        status = ax_lay_out(&w, pieces, error);
    }
    if (status == AX_OK) {
        draw_sheets(&w);
        measure(plan);
        if (plan->sheet_count > 1)
            ax_draw_overview(&w);
        count_parts(&w);
        doubt_joint(&w);
        status = ax_prove_clearance(&w, progress, error);
    }
    if (status != AX_OK)
        ax_cut_plan_free(plan);
    ax_free(w.flat);
    ax_free(w.held);
    ax_free(w.sheet_start);
    ax_free(w.sheet_panels);
    ax_free(w.met);
    ax_free(w.seam);
    ax_free(w.outside);
    return status;
}
