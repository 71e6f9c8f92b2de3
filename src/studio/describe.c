#include "studio/describe.h"

#include "base/vec.h"

#include <stdio.h>
#include <string.h>

json_t* describe_number(double x)
{
    return isfinite(x) ? json_real(x) : json_null();
}

static json_t* numbers(const double* x, int count)
{
    json_t* list = json_array();
    for (int k = 0; k < count; ++k)
        json_array_append_new(list, describe_number(x[k]));
    return list;
}

json_t* describe_point(const double x[3])
{
    return numbers(x, 3);
}

static json_t* integers(const int* x, int count)
{
    json_t* list = json_array();
    for (int k = 0; k < count; ++k)
        json_array_append_new(list, json_integer(x[k]));
    return list;
}

static json_t* text_or_null(const char* text)
{
    return text ? json_string(text) : json_null();
}

// ---- the document -------------------------------------------------------------------------------------------------------------

static json_t* curve(const ax_curve_shape* shape)
{
    json_t* points = json_array();
    for (int k = 0; k < shape->count; ++k)
        json_array_append_new(points, describe_point(shape->points[k]));
    return json_pack("{s:s, s:b, s:f, s:o}", "kind", ax_curve_kind_name(shape->kind), "closed", shape->closed, "fillet",
                     shape->fillet, "points", points);
}

// `figure`: what came of it, if it was measured.
static json_t* held(const char* name, const char* kind, const int* hinges, int count, json_t* weight,
                    const ax_held_figure* figure)
{
    return json_pack("{s:s, s:s, s:o, s:o, s:o, s:i, s:o}", "name", name, "kind", kind, "hinges",
                     integers(hinges, count), "weight", weight, "residual",
                     describe_number(figure ? figure->residual : NAN), "hinge", figure ? figure->hinge : -1,
                     "multiplier", describe_number(figure ? figure->multiplier : NAN));
}

static json_t* rim_parts(const ax_form* form, const ax_form_report* report)
{
    static const char* const kinds[] = {"free", "fixed", "slide"};
    const ax_rim_part* parts;
    int count = ax_form_rim(form, &parts);
    json_t* list = json_array();
    for (int k = 0, measured = 0; k < count; ++k) {
        char name[24];
        snprintf(name, sizeof name, "rim %d", k + 1);
        bool is =
            parts[k].kind != AX_RIM_FREE && measured < report->held_count; // what holds is measured, in this order
        const ax_held_figure* figure = is ? &report->held[measured++] : NULL;
        json_t* row = held(figure ? figure->name : name, kinds[parts[k].kind], parts[k].hinges, parts[k].count,
                           json_null(), figure);
        if (parts[k].kind == AX_RIM_SLIDE)
            json_object_set_new(row, "curve", curve(&parts[k].curve));
        json_array_append_new(list, row);
    }
    return list;
}

static json_t* constraints(const ax_form* form, const ax_form_report* report)
{
    const ax_form_constraint* all;
    int count = ax_form_constraints(form, &all);
    json_t* list = json_array();
    for (int k = 0; k < count; ++k) {
        const ax_held_figure* figure = NULL;
        for (int i = 0; i < report->held_count && !figure; ++i)
            if (strcmp(report->held[i].name, all[k].name) == 0)
                figure = &report->held[i];
        json_t* row = held(all[k].name, ax_held_kind_name(all[k].kind), all[k].hinges, all[k].count,
                           json_real(all[k].weight), figure);
        if (all[k].kind == AX_HELD_CURVE)
            json_object_set_new(row, "curve", curve(&all[k].curve));
        json_array_append_new(list, row);
    }
    return list;
}

static json_t* underlays(const ax_form* form)
{
    const char** names;
    const ax_mesh* meshes;
    const double* clearances;
    int count = ax_form_underlays(form, &names, &meshes, &clearances);
    json_t* list = json_array();
    for (int k = 0; k < count; ++k)
        json_array_append_new(list,
                              json_pack("{s:s, s:o}", "name", names[k], "clearance", describe_number(clearances[k])));
    return list;
}

// Selections have names in steps only, so steps are asked for them.
static json_t* selections(const ax_session* s)
{
    json_t* list = json_array();
    for (int k = 0; k < ax_session_at(s); ++k) {
        if (strcmp(ax_recipe_type(ax_session_recipe(s), k)->group, "selection") != 0)
            continue;
        json_t* step = json_loads(ax_recipe_operator(ax_session_recipe(s), k), 0, NULL);
        const char* name = json_string_value(json_object_get(step, "name"));
        int count;
        const int* hinges = name ? ax_form_selection(ax_session_form(s), name, &count) : NULL;
        if (hinges)
            json_array_append_new(list, json_pack("{s:s, s:o}", "name", name, "hinges", integers(hinges, count)));
        json_decref(step);
    }
    return list;
}

static json_t* steps(const ax_session* s)
{
    const ax_recipe* recipe = ax_session_recipe(s);
    const char* why = NULL;
    int failed = ax_session_failed(s, &why);
    json_t* list = json_array();
    for (int k = 0; k < ax_recipe_count(recipe); ++k) {
        char words[160];
        ax_recipe_words(recipe, k, words);
        const char* state = k < ax_session_at(s) ? "applied" : k == failed ? "failed" : "ahead";
        json_t* row = json_pack("{s:o, s:s, s:s, s:s}", "operator", json_loads(ax_recipe_operator(recipe, k), 0, NULL),
                                "words", words, "type", ax_recipe_type(recipe, k)->name, "state", state);
        if (k == failed)
            json_object_set_new(row, "problem", json_string(why));
        json_array_append_new(list, row);
    }
    return list;
}

json_t* describe_document(const describe_names* names, const ax_session* s, const ax_form_report* report)
{
    ax_form* form = ax_session_form(s);
    ax_form_view view = ax_form_look(form);
    const ax_load* load = &ax_form_get_dynamics(form)->load;
    const ax_moment* moments;
    int now, count = ax_session_history(s, &moments, &now);
    json_t* document = json_pack(
        "{s:s, s:s, s:s, s:o, s:o, s:o, s:s, s:i, s:o, s:o, s:o, s:o}", "event", "document", "id", names->id, "name",
        names->name, "path", text_or_null(names->path), "read_only", text_or_null(ax_session_read_only(s)), "autosaved",
        describe_number(moments[now].time), "unit", ax_unit_name(view.unit), "at", ax_session_at(s), "steps", steps(s),
        "undo", text_or_null(now > 0 ? moments[now].words : NULL), "redo",
        text_or_null(now + 1 < count ? moments[now + 1].words : NULL), "selections", selections(s));
    json_object_set_new(document, "constraints", constraints(form, report));
    json_object_set_new(document, "rim", rim_parts(form, report));
    json_object_set_new(document, "underlays", underlays(form));
    json_object_set_new(document, "load",
                        json_pack("{s:s, s:o, s:o, s:o}", "kind", ax_load_kind_name(load->kind), "direction",
                                  describe_point(load->direction), "pressure", describe_number(load->pressure),
                                  "density", describe_number(load->density)));
    return document;
}

json_t* describe_linkage(const char* id, unsigned topology, const ax_form_view* v, const double origin[3],
                         const double flat_origin[2], const char* variant)
{
    json_t* event = json_pack(
        "{s:s, s:s, s:i, s:i, s:i, s:i, s:i, s:o, s:o, s:o, s:s}", "event", "linkage", "document", id, "topology",
        topology, "triangles", v->linkage->triangle_count, "hinges", v->linkage->hinge_count, "holes",
        v->linkage->hole_count, "openings", v->linkage->opening_count, "origin", describe_point(origin), "flat_origin",
        numbers(flat_origin, 2), "spacing", describe_number(v->spacing), "unit", ax_unit_name(v->unit));
    if (variant)
        json_object_set_new(event, "variant", json_string(variant));
    return event;
}

// ---- can it deploy? -----------------------------------------------------------------------------------------------------------

typedef enum verdict { PASS, NOTE, WARNING, FAILURE, UNKNOWN } verdict;
static const char* const verdict_words[] = {"pass", "note", "warning", "failure", "unknown"};

typedef struct check {
    const char *key, *title;
    char answer[96], limit[64];
    double value;
    verdict severity;
    int triangle, hinge, other;
} check;

static json_t* check_json(const check* c)
{
    return json_pack("{s:s, s:s, s:s, s:s, s:o, s:s, s:i, s:i, s:i}", "key", c->key, "title", c->title, "answer",
                     c->answer, "limit", c->limit, "value", describe_number(c->value), "severity",
                     verdict_words[c->severity], "triangle", c->triangle, "hinge", c->hinge, "other", c->other);
}

// The worst finding of one of two kinds, NULL: there is none.
static const ax_finding* worst_finding(const ax_form_report* r, const char* kind, const char* other)
{
    const ax_finding* worst = NULL;
    for (int k = 0; k < r->finding_count; ++k) {
        const ax_finding* f = &r->findings[k];
        if ((strcmp(f->kind, kind) == 0 || strcmp(f->kind, other) == 0) && (!worst || f->severity > worst->severity))
            worst = f;
    }
    return worst;
}

// A finding decides, and says where; without one, what the figure itself says.
static verdict taken(const ax_finding* f, check* c)
{
    if (!f)
        return PASS;
    c->triangle = f->triangle;
    c->hinge = f->hinge;
    c->other = f->other;
    return f->severity == AX_SEVERITY_FAILURE ? FAILURE : f->severity == AX_SEVERITY_WARNING ? WARNING : NOTE;
}

static verdict found(const ax_form_report* r, const char* kind, const char* other, check* c)
{
    return taken(worst_finding(r, kind, other), c);
}

static double worst_of(double a, double b)
{
    return isnan(a) ? b : isnan(b) ? a : fmax(a, b);
}

static check scale_check(const ax_form_report* r, const ax_form_view* v)
{
    check c = {"scale",     "Scale factors", .value = r->realised_max, .triangle = r->scale_off_triangle,
               .hinge = -1, .other = -1};
    snprintf(c.answer, sizeof c.answer, "%.2f to %.2f", r->realised_min, r->realised_max);
    snprintf(c.limit, sizeof c.limit, "1 to 2, asked within %.2f on %d panels off the rim", r->scale_off_max,
             r->scale_judged);
    c.severity = found(r, "scale", "scale", &c);
    bool above = r->realised_max > 2 + 1e-6;
    if (r->scale_judged && (above || r->realised_min < 1 - 1e-3)) {
        c.severity = FAILURE;
        for (int t = 0; t < v->linkage->triangle_count; ++t)
            if (v->realised[t] == (above ? r->realised_max : r->realised_min))
                c.triangle = t;
    }
    return c;
}

static check mouth_check(const ax_form_report* r)
{
    double degrees = r->mouth_min * 180 / AX_PI;
    check c = {"mouth", "Mouth angle", .value = r->mouth_min, .triangle = -1, .hinge = r->mouth_hinge, .other = -1};
    snprintf(c.answer, sizeof c.answer, "%.1f deg at the tightest hinge", degrees);
    snprintf(c.limit, sizeof c.limit, "above 0 deg");
    c.severity = found(r, "mouth", "tight", &c);
    if (degrees < 0)
        c.severity = FAILURE;
    return c;
}

// Whatever meets that must not: flat panels, panels folded onto each other, the shell and the site.
static check overlap_check(const ax_form_report* r)
{
    int count = r->overlap_pairs + r->flipped;
    const ax_finding* f = r->overlap_pairs ? worst_finding(r, "overlap", "overlap")
                          : count          ? worst_finding(r, "flipped", "flipped")
                                           : worst_finding(r, "folded", "clearance");
    check c = {"overlap",      "Collisions", .value = count ? count : f ? f->value : 0,
               .triangle = -1, .hinge = -1,  .other = -1};
    snprintf(c.limit, sizeof c.limit, "none may meet");
    if (r->overlap_pairs)
        snprintf(c.answer, sizeof c.answer, "%d pair%s", r->overlap_pairs,
                 r->overlap_pairs == 1 ? " overlaps" : "s overlap");
    else if (count)
        snprintf(c.answer, sizeof c.answer, "%d turned over", count);
    else if (!f)
        snprintf(c.answer, sizeof c.answer, "none");
    else if (strcmp(f->kind, "folded") == 0)
        snprintf(c.answer, sizeof c.answer, "%.0f pair%s folded", f->value, f->value == 1 ? "" : "s");
    else {
        snprintf(c.answer, sizeof c.answer, "%.3g from the site", f->value);
        snprintf(c.limit, sizeof c.limit, "%.3g are asked", f->limit);
    }
    c.severity = taken(f, &c);
    if (f && strcmp(f->kind, "clearance") == 0 && f->value > 1e-3 * r->edge) // too near, but it can be built
        c.severity = WARNING;
    return c;
}

static check curvature_check(const ax_form_report* r, const ax_form_view* v, const double* curvature)
{
    int known = 0, inward = 0;
    check c = {"curvature", "Bulges everywhere", .triangle = -1, .hinge = -1, .other = -1};
    double least = INFINITY, size = r->edge > 0 ? r->edge * sqrt(v->linkage->triangle_count) : 1; // of the shell
    for (int t = 0; t < v->linkage->triangle_count; ++t)
        if (isfinite(curvature[t])) {
            ++known;
            inward += curvature[t] * size < -0.1; // flat within a tenth of the shell's own size is not inward
            if (curvature[t] < least)
                least = curvature[t], c.triangle = t;
        }
    c.value = known ? (double)inward / known : NAN;
    if (!known)
        snprintf(c.answer, sizeof c.answer, "not known");
    else
        snprintf(c.answer, sizeof c.answer, inward ? "dips inwards on %.1f %%" : "yes", 100 * c.value);
    snprintf(c.limit, sizeof c.limit, "mean curvature above 0 on %d of %d panels", known, v->linkage->triangle_count);
    verdict other = found(r, "overhang", "curvature", &c);
    c.severity = !known ? UNKNOWN : c.value > 0.02 ? WARNING : inward ? NOTE : PASS;
    if (other > c.severity)
        c.severity = other;
    return c;
}

static check rim_check(const ax_form_report* r, const ax_form_view* v)
{
    double residual = 0;
    check c = {"rim", "Rim and constraints", .triangle = -1, .hinge = -1, .other = -1};
    for (int k = 0; k < r->held_count; ++k)
        if (r->held[k].residual >= residual) {
            residual = r->held[k].residual;
            c.hinge = r->held[k].hinge;
        }
    c.value = r->held_count ? residual : NAN;
    if (r->held_count)
        snprintf(c.answer, sizeof c.answer, "largest gap %.3g %s", residual, ax_unit_name(v->unit));
    else
        snprintf(c.answer, sizeof c.answer, "the rim is free");
    snprintf(c.limit, sizeof c.limit, "%.2g %s", 0.05 * r->edge, ax_unit_name(v->unit));
    c.severity = found(r, "held", "held", &c);
    if (r->held_count && residual > 0.05 * r->edge && c.severity < WARNING)
        c.severity = WARNING;
    return c;
}

static check match_check(const ax_form_report* r, const ax_form_view* v)
{
    check c = {"match", "Simulated as designed", .value = r->simulated_rms, .triangle = -1, .hinge = -1, .other = -1};
    bool known = isfinite(r->simulated_rms);
    if (known)
        snprintf(c.answer, sizeof c.answer, "differ by %.3f L rms, %.2f L at most", r->simulated_rms, r->simulated_max);
    else
        snprintf(c.answer, sizeof c.answer, "no load yet");
    snprintf(c.limit, sizeof c.limit, "0.1 L rms");
    double most = -1;
    for (int h = 0; known && h < v->linkage->hinge_count; ++h) {
        double off = ax_distance3(v->simulated[h], v->deployed[h]);
        if (off > most)
            most = off, c.hinge = h;
    }
    const ax_finding* f = worst_finding(r, "tight", "slack");
    c.severity = !known && !f ? UNKNOWN : taken(f, &c);
    if (f) {
        bool slack = strcmp(f->kind, "slack") == 0;
        snprintf(c.answer, sizeof c.answer, slack ? "slack, %.0f %% open" : "taut", 100 * f->value);
        snprintf(c.limit, sizeof c.limit, slack ? "%.0f %% of every hole" : "too little material", 100 * f->limit);
    }
    if (known && r->simulated_rms > 0.1 && c.severity < WARNING)
        c.severity = WARNING;
    return c;
}

static int largest(const double* values, int count)
{
    int at = -1;
    for (int k = 0; k < count; ++k)
        if (isfinite(values[k]) && (at < 0 || values[k] > values[at]))
            at = k;
    return at;
}

// Leads to the panel that bears most, or whose edges are off most.
static check force_check(const ax_form_report* r, const ax_form_view* v, const double* residual, const ax_design* exact,
                         bool at_rest)
{
    check c = {"force", "Forces in balance", .triangle = -1, .hinge = -1, .other = -1};
    bool known = exact && exact->report.simulated;
    c.value = known ? exact->report.force_residual : worst_of(r->deployed_error, r->simulated_error);
    if (known) {
        bool opened = exact->report.from_flat;
        snprintf(c.answer, sizeof c.answer,
                 opened ? "exact, residual %.0e" : "exact, residual %.0e, but not opened from flat", c.value);
        snprintf(c.limit, sizeof c.limit, "1e-10 of the load");
        c.severity = c.value <= 1e-10 && exact->report.stable && opened ? PASS : WARNING;
        double most = -1;
        for (int t = 0; exact->edge_forces && t < v->linkage->triangle_count; ++t)
            for (int k = 0; k < 3; ++k)
                if (fabs(exact->edge_forces[t][k]) > most)
                    most = fabs(exact->edge_forces[t][k]), c.triangle = t;
    } else {
        snprintf(c.answer, sizeof c.answer, "edges within %.1e", c.value);
        snprintf(c.limit, sizeof c.limit, "Finish makes it exact");
        c.severity = UNKNOWN;
        c.triangle = largest(residual, v->linkage->triangle_count);
        const ax_finding* f = worst_finding(r, "unsettled", "unsettled");
        if (f && at_rest) {
            c.severity = taken(f, &c);
            snprintf(c.answer, sizeof c.answer, "edges off by %.2g %%", 100 * f->value);
            snprintf(c.limit, sizeof c.limit, "%.2g %%", 100 * f->limit);
        }
    }
    return c;
}

json_t* describe_checks(const ax_form_report* r, const ax_form_view* v, const shape_measures* m, const ax_design* exact,
                        bool at_rest)
{
    const check checks[] = {scale_check(r, v),
                            mouth_check(r),
                            overlap_check(r),
                            curvature_check(r, v, m->curvature),
                            rim_check(r, v),
                            match_check(r, v),
                            force_check(r, v, m->residual, exact, at_rest)};
    json_t* list = json_array();
    for (size_t k = 0; k < sizeof checks / sizeof *checks; ++k)
        json_array_append_new(list, check_json(&checks[k]));
    return list;
}

json_t* describe_verdict(const json_t* checks)
{
    bool failure = false, warning = false, match = false;
    size_t k;
    json_t* c;
    json_array_foreach((json_t*)checks, k, c)
    {
        const char* severity = json_string_value(json_object_get(c, "severity"));
        failure |= strcmp(severity, "failure") == 0;
        warning |= strcmp(severity, "warning") == 0;
        match |= strcmp(json_string_value(json_object_get(c, "key")), "match") == 0 && strcmp(severity, "unknown") != 0;
    }
    const char* word = failure ? "No" : !match ? "Not known yet" : warning ? "Yes, with care" : "Yes";
    return json_pack("{s:s, s:s}", "word", word, "severity",
                     failure   ? "failure"
                     : !match  ? "unknown"
                     : warning ? "warning"
                               : "pass");
}

static json_t* figures(const ax_design* design)
{
    int count;
    const ax_figure* all = ax_report_figures(&count);
    json_t* list = json_array();
    for (int k = 0; k < count; ++k) {
        const ax_figure* f = &all[k];
        json_t* value;
        if (f->count > 1) {
            value = json_array();
            for (int i = 0; i < f->count; ++i)
                json_array_append_new(value, describe_number(ax_figure_value(f, &design->report, i)));
        } else if (f->kind == AX_FIGURE_FLAG)
            value = json_boolean(ax_figure_value(f, &design->report, 0) != 0);
        else
            value = describe_number(ax_figure_value(f, &design->report, 0));
        json_array_append_new(list, json_pack("{s:s, s:s, s:s, s:s, s:o, s:o, s:b}", "key", f->key, "label", f->label,
                                              "unit", f->unit, "group", ax_figure_group_name(f->group), "value", value,
                                              "limit", describe_number(ax_figure_limit(f, design)), "holds",
                                              ax_figure_holds(f, design)));
    }
    return list;
}

json_t* describe_report(unsigned revision, const ax_form_report* r, const ax_form_view* v, const shape_measures* m,
                        const ax_design* exact, bool at_rest)
{
    json_t *checks = describe_checks(r, v, m, exact, at_rest), *findings = json_array(), *all_held = json_array();
    for (int k = 0; k < r->finding_count; ++k) {
        const ax_finding* f = &r->findings[k];
        json_array_append_new(findings,
                              json_pack("{s:s, s:s, s:s, s:o, s:o, s:i, s:i, s:i}", "severity",
                                        ax_severity_name(f->severity), "kind", f->kind, "text", f->text, "value",
                                        describe_number(f->value), "limit", describe_number(f->limit), "triangle",
                                        f->triangle, "hinge", f->hinge, "other", f->other));
    }
    for (int k = 0; k < r->held_count; ++k) {
        const ax_held_figure* f = &r->held[k];
        json_array_append_new(all_held, json_pack("{s:s, s:s, s:i, s:o, s:i, s:o}", "name", f->name, "kind", f->kind,
                                                  "count", f->count, "residual", describe_number(f->residual), "hinge",
                                                  f->hinge, "multiplier", describe_number(f->multiplier)));
    }
    return json_pack("{s:s, s:i, s:o, s:o, s:o, s:o, s:o}", "event", "report", "revision", revision, "verdict",
                     describe_verdict(checks), "checks", checks, "findings", findings, "held", all_held, "figures",
                     exact ? figures(exact) : json_array());
}

// ---- surfaces -----------------------------------------------------------------------------------------------------------------

json_t* describe_screen(const char* name, const ax_mesh* mesh, const ax_mesh_repairs* r, const ax_screen* s)
{
    static const char* const verdicts[] = {"deployable", "deployable_projected", "not_deployable"};
    json_t* out =
        json_pack("{s:s, s:s, s:b, s:b, s:b, s:s, s:i, s:i, s:[o, o], s:o, s:o, s:o}", "verdict", verdicts[s->verdict],
                  "words", s->words, "lies_on_side", s->lies_on_side, "by_inflation", s->by_inflation, "by_gravity",
                  s->by_gravity, "name", name, "vertices", mesh->vertex_count, "faces", mesh->face_count, "bounds",
                  describe_point(s->bounds[0]), describe_point(s->bounds[1]), "area", describe_number(s->area),
                  "diagonal", describe_number(s->diagonal), "rim_length", describe_number(s->rim_length));
    json_object_set_new(out, "repairs",
                        json_pack("{s:i, s:i, s:i, s:i, s:i, s:b}", "welded_vertices", r->welded_vertices,
                                  "degenerate_faces", r->degenerate_faces, "duplicate_faces", r->duplicate_faces,
                                  "unused_vertices", r->unused_vertices, "flipped_faces", r->flipped_faces,
                                  "turned_outward", r->turned_outward));
    json_object_set_new(out, "curvature",
                        json_pack("{s:o, s:o, s:o, s:o, s:o, s:o}", "min", describe_number(s->curvature_min), "q01",
                                  describe_number(s->curvature_q01), "median", describe_number(s->curvature_median),
                                  "q95", describe_number(s->curvature_q95), "nonpositive_share",
                                  describe_number(s->curvature_nonpositive_share), "worst",
                                  describe_point(s->curvature_worst_place)));
    json_object_set_new(out, "height_field", json_boolean(s->height_field));
    json_object_set_new(out, "scale",
                        json_pack("{s:o, s:o, s:o, s:b}", "ratio", describe_number(s->scale_ratio), "lo",
                                  describe_number(s->scale_lo), "hi", describe_number(s->scale_hi), "fits",
                                  s->scale_fits));
    json_object_set_new(out, "projection",
                        s->projection.steps
                            ? json_pack("{s:o, s:o, s:i}", "moved_area_share",
                                        describe_number(s->projection.moved_area_share), "largest_move",
                                        describe_number(s->projection.largest_move), "steps", s->projection.steps)
                            : json_null());
    return out;
}

// ---- what there is ------------------------------------------------------------------------------------------------------------

static json_t* default_value(const ax_field* f, const char* arguments)
{
    const char* at = arguments + f->offset;
    if (f->required || f->fallback || f->kind == AX_FIELD_POINTS)
        return json_null();
    switch (f->kind) {
    case AX_FIELD_NUMBER:
        return describe_number(*(const double*)at);
    case AX_FIELD_INTEGER:
        return json_integer(*(const int*)at);
    case AX_FIELD_FLAG:
        return json_boolean(*(const bool*)at);
    case AX_FIELD_CHOICE:
        return json_string(f->choices[*(const int*)at]);
    case AX_FIELD_TEXT:
        return text_or_null(*(const char* const*)at);
    case AX_FIELD_VECTOR:
        return numbers((const double*)at, f->width);
    case AX_FIELD_POINTS:
        break;
    }
    return json_null();
}

static json_t* field(const ax_field* f, const char* arguments)
{
    static const char* const kinds[] = {"number", "integer", "flag", "choice", "text", "vector", "points"};
    json_t* choices = json_array();
    for (int k = 0; k < f->choice_count; ++k)
        json_array_append_new(choices, json_string(f->choices[k]));
    bool bounded = f->lo < f->hi;
    return json_pack("{s:s, s:s, s:s, s:s, s:s, s:b, s:o, s:o, s:o, s:o, s:b, s:i, s:o}", "name", f->name, "title",
                     f->title, "doc", f->doc ? f->doc : "", "unit", f->unit ? f->unit : "", "kind", kinds[f->kind],
                     "required", f->required, "default", default_value(f, arguments), "fallback",
                     text_or_null(f->fallback), "lo", describe_number(bounded ? f->lo : NAN), "hi",
                     describe_number(bounded ? f->hi : NAN), "open", f->open, "width",
                     f->kind >= AX_FIELD_VECTOR ? f->width : 0, "choices", choices);
}

json_t* describe_operators(void)
{
    int count;
    const ax_operator_type* const* types = ax_operator_types(&count);
    json_t* list = json_array();
    for (int k = 0; k < count; ++k) {
        const ax_operator_type* t = types[k];
        char* arguments = ax_calloc(t->size ? t->size : 1, 1);
        if (t->defaults)
            t->defaults(arguments);
        json_t* fields = json_array();
        for (int i = 0; i < t->field_count; ++i)
            json_array_append_new(fields, field(&t->fields[i], arguments));
        ax_free(arguments);
        json_array_append_new(list,
                              json_pack("{s:s, s:s, s:s, s:s, s:s, s:b, s:b, s:o}", "name", t->name, "title", t->title,
                                        "doc", t->doc, "reference", t->reference ? t->reference : "", "group", t->group,
                                        "starts", t->starts, "settles", t->settles, "fields", fields));
    }
    return list;
}

json_t* describe_exporters(void)
{
    int count;
    const ax_export_type* const* types = ax_export_types(&count);
    json_t* list = json_array();
    for (int k = 0; k < count; ++k) {
        const ax_export_type* t = types[k];
        json_t* states = json_array();
        for (int s = AX_STATE_FLAT; s <= AX_STATE_SIMULATED; ++s)
            if (t->states[s])
                json_array_append_new(states, json_string(ax_state_name((ax_state)s)));
        json_array_append_new(list,
                              json_pack("{s:s, s:s, s:s, s:o, s:s}", "ending", t->ending, "name", t->name, "doc",
                                        t->doc, "states", states, "default_state", ax_state_name(t->default_state)));
    }
    return list;
}

static json_t* named(const char* name, const char* doc)
{
    return json_pack("{s:s, s:s}", "name", name, "doc", doc ? doc : "");
}

json_t* describe_making(void)
{
    int count;
    json_t *joints = json_array(), *materials = json_array(), *sheets = json_array(), *profiles = json_array();
    const ax_joint_type* const* joint = ax_joint_types(&count);
    for (int k = 0; k < count; ++k) {
        json_t *row = named(joint[k]->name, joint[k]->doc), *parameters = json_array();
        for (int i = 0; i < joint[k]->parameter_count; ++i) {
            const ax_joint_parameter* p = &joint[k]->parameters[i];
            json_array_append_new(parameters,
                                  json_pack("{s:s, s:s, s:s, s:o, s:o, s:o}", "name", p->name, "unit", p->unit, "doc",
                                            p->doc, "lo", describe_number(p->least), "hi", describe_number(p->most),
                                            "default", describe_number(p->standard)));
        }
        json_object_set_new(row, "parameters", parameters);
        json_array_append_new(joints, row);
    }
    const ax_material* material = ax_materials(&count);
    for (int k = 0; k < count; ++k) {
        json_t* row = named(material[k].name, material[k].doc);
        json_object_set_new(row, "thickness", describe_number(material[k].thickness));
        json_object_set_new(row, "kerf", describe_number(material[k].kerf));
        json_array_append_new(materials, row);
    }
    const ax_sheet_size* size = ax_sheet_sizes(&count);
    for (int k = 0; k < count; ++k)
        json_array_append_new(sheets,
                              json_pack("{s:s, s:o, s:o}", "name", size[k].name, "width",
                                        describe_number(size[k].width), "height", describe_number(size[k].height)));
    const ax_profile* profile = ax_profiles(&count);
    for (int k = 0; k < count; ++k)
        json_array_append_new(profiles, named(profile[k].name, profile[k].doc));
    return json_pack("{s:o, s:o, s:o, s:o}", "joints", joints, "materials", materials, "sheets", sheets, "profiles",
                     profiles);
}

json_t* describe_plan(const ax_cut_plan* p)
{
    if (!p->sheet_count)
        return json_null();
    double cut = p->cut_length[AX_HOLE] + p->cut_length[AX_SLIT] + p->cut_length[AX_CUT];
    json_t* parts = json_array();
    for (int k = 0; k < p->part_count; ++k)
        json_array_append_new(parts, json_pack("{s:s, s:i}", "name", p->parts[k].name, "count", p->parts[k].count));
    static const char* const when[] = {"turning", "flat", "deployed", "simulated", "between"}; // by frame + 1
    json_t* collisions = json_array();
    for (int k = 0; k < p->clash_count; ++k) {
        const ax_cut_clash* c = &p->clashes[k];
        json_array_append_new(collisions,
                              json_pack("{s:[i, i], s:i, s:s, s:o, s:o}", "panels", c->panels[0], c->panels[1], "hinge",
                                        c->hinge, "when", when[c->frame + 1], "opening", describe_number(c->opening),
                                        "overlap", describe_number(c->overlap)));
    }
    json_t* fold = p->folds ? json_pack("[i, i]", p->fold[0], p->fold[1]) : json_null();
    return json_pack("{s:i, s:o, s:o, s:o, s:o, s:i, s:o, s:i, s:o, s:i, s:o, s:s}", "sheets", p->sheet_count,
                     "cut_length", describe_number(1e-3 * cut), "seconds", describe_number(p->seconds), "mass",
                     describe_number(p->mass), "utilisation", describe_number(p->utilisation), "clashes",
                     p->clashes_found, "collisions", collisions, "seams", p->seam_count, "parts", parts, "folds",
                     p->folds, "fold", fold, "doubt", p->doubt);
}
