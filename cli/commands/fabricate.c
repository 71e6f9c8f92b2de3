// auxshell fabricate: what a design takes to make, without writing it; or what there is to choose from.
#include "fabricate.h"
#include "progress.h"
#include "report.h"

#include "ax/document.h"

#include <math.h>

typedef struct arguments {
    const char* document;
    fabricate_arguments fabricate;
    bool json;
} arguments;

static void defaults(void* given)
{
    fabricate_defaults(&((arguments*)given)->fabricate);
}

static const command_option options[] = {
    {.name = "P.auxshell",
     .text = "the document; without it, joints, materials, sheets and profiles are listed",
     .kind = OPTION_TEXT,
     .operand = true,
     .offset = offsetof(arguments, document)},
    FABRICATE_OPTIONS(arguments, fabricate),
    {.name = "--json", .text = "print every figure as JSON", .kind = OPTION_FLAG, .offset = offsetof(arguments, json)},
};

static json_t* hinges_json(const ax_cut_plan* p)
{
    json_t* all = json_array();
    for (int i = 0; i < p->hinge_count; ++i) {
        const ax_cut_hinge* h = &p->hinges[i];
        json_array_append_new(all, json_pack("{s:i, s:s, s:s, s:i, s:o, s:o, s:o, s:o}", "hinge", h->hinge, "a",
                                             p->panels[h->panels[0]].name, "b", p->panels[h->panels[1]].name, "seam",
                                             h->seam, "mouth_deg", json_number(h->mouth * 180 / M_PI), "clearance",
                                             json_number(h->clearance), "force", json_number(h->force), "rated",
                                             json_number(h->rated)));
    }
    return all;
}

static json_t* clashes_json(const ax_cut_plan* p)
{
    json_t* all = json_array();
    for (int i = 0; i < p->clash_count; ++i) {
        const ax_cut_clash* c = &p->clashes[i];
        json_array_append_new(all, json_pack("{s:s, s:s, s:i, s:o, s:i, s:o, s:o}", "a", p->panels[c->panels[0]].name,
                                             "b", p->panels[c->panels[1]].name, "hinge", c->hinge, "mouth_deg",
                                             json_number(c->angle * 180 / M_PI), "frame", c->frame, "opening",
                                             json_number(c->opening), "overlap", json_number(c->overlap)));
    }
    return all;
}

static json_t* frames_json(const ax_cut_plan* p)
{
    json_t* all = json_array();
    for (int i = 0; i < p->frame_count; ++i) {
        const ax_cut_frame* f = &p->frames[i];
        json_array_append_new(all, json_pack("{s:f, s:f, s:f, s:f, s:b, s:i}", "opening", f->opening, "strain",
                                             f->strain, "moved", f->moved, "error", f->error, "checked", f->checked,
                                             "clashes", f->clashes));
    }
    return all;
}

static json_t* plan_json(const ax_cut_plan* p)
{
    json_t *sheets = json_array(), *joint = json_object(), *parts = json_array(), *lengths = json_object();
    for (int s = 0; s < p->sheet_count; ++s)
        json_array_append_new(sheets, json_pack("{s:f, s:f, s:f}", "width", p->sheets[s].width, "height",
                                                p->sheets[s].height, "utilisation", p->sheets[s].utilisation));
    json_object_set_new(joint, "name", json_string(p->joint->name));
    for (int k = 0; k < p->joint->parameter_count; ++k)
        json_object_set_new(joint, p->joint->parameters[k].name, json_number(p->joint_values[k]));
    for (int k = 0; k < p->part_count; ++k)
        json_array_append_new(parts, json_pack("{s:s, s:i}", "name", p->parts[k].name, "count", p->parts[k].count));
    for (int k = 0; k < AX_NOTE; ++k)
        json_object_set_new(lengths, ax_operation_name((ax_operation)k), json_number(p->cut_length[k]));
    return json_pack("{s:o, s:s, s:f, s:f, s:s, s:o, s:f, s:i, s:f, s:f, s:f, s:o, s:f, s:f, s:b, s:i, s:i, s:i, s:i, "
                     "s:f, s:b, s:o, s:o, s:o, s:s}",
                     "joint", joint, "material", p->material.name, "thickness", p->material.thickness, "kerf", p->kerf,
                     "profile", p->profile->name, "sheets", sheets, "utilisation", p->utilisation, "panels",
                     p->panel_count, "area_mm2", p->area, "mass_kg", p->mass, "travel_mm", p->travel, "cut_mm", lengths,
                     "seconds", p->seconds, "label_height", p->panel_count ? p->panels[0].label_height : 0, "in_place",
                     p->in_place, "labels_dropped", p->labels_dropped, "seams", p->seam_count, "clashes_found",
                     p->clashes_found, "frames_checked", p->frames_checked, "frame_error", p->frame_error,
                     "simulated_way", p->simulated_way, "frames", frames_json(p), "clashes", clashes_json(p), "hinges",
                     hinges_json(p), "doubt", p->doubt);
}

static ax_status run(const void* given, ax_error* error)
{
    const arguments* a = given;
    ax_design design = {0};
    ax_cut_plan plan = {0};
    fabricate_choice chosen;
    ax_status status = fabricate_choose(&a->fabricate, a->document, &chosen, error);
    if (status == AX_OK && !a->document) {
        fabricate_list(stdout);
        return AX_OK;
    }
    if (status == AX_OK)
        status = ax_document_load(a->document, &design, error);
    if (status == AX_OK)
        status = ax_fabricate(&design, &chosen.options, progress_reporter(), &plan, error);
    progress_end();
    if (status == AX_OK && a->json)
        json_print(plan_json(&plan), stdout);
    else if (status == AX_OK) {
        printf("%s\n", a->document);
        fabricate_print(&plan, stdout);
    }
    ax_cut_plan_free(&plan);
    ax_design_free(&design);
    return status;
}

const command command_fabricate = {
    .name = "fabricate",
    .summary = "what a design takes to make: sheets, time, parts, clearance, forces",
    .text = "Shapes the panels for a joint and a material, lays them on sheets, and proves that they clear each other, "
            "without writing a file; \"auxshell export\" with the same options writes it. Without a document it lists "
            "what there is to choose from.",
    .options = options,
    .option_count = sizeof options / sizeof *options,
    .size = sizeof(arguments),
    .defaults = defaults,
    .run = run,
};
