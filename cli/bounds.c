#include "bounds.h"

#include "ax/report.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

static bool ranges_are_well(const json_t* ranges)
{
    const char* key;
    json_t* range;
    json_object_foreach((json_t*)ranges, key, range)
    {
        if (!json_is_array(range) || json_array_size(range) != 2)
            return false;
        for (size_t k = 0; k < 2; ++k)
            if (!json_is_number(json_array_get(range, k)) && !json_is_null(json_array_get(range, k)))
                return false;
    }
    return true;
}

static bool examples_are_well(const json_t* examples)
{
    const char* name;
    json_t* example;
    json_object_foreach((json_t*)examples, name,
                        example) if (!json_is_object(example) ||
                                     !ranges_are_well(json_object_get(example, "bounds"))) return false;
    return json_is_object(examples);
}

ax_status bounds_read(const char* path, bounds* out, ax_error* error)
{
    json_error_t wrong;
    json_t* root = json_load_file(path, JSON_REJECT_DUPLICATES, &wrong);
    *out = (bounds){0};
    if (!root)
        return ax_fail(error, AX_BAD_INPUT, "%s, line %d: %s.", path, wrong.line, wrong.text);
    *out = (bounds){root, json_object_get(root, "every"), json_object_get(root, "examples")};
    const char* format = json_string_value(json_object_get(root, "format"));
    if (format && strcmp(format, "auxshell-bounds") == 0 && ranges_are_well(out->every) &&
        examples_are_well(out->examples))
        return AX_OK;
    bounds_free(out);
    return ax_fail(
        error, AX_BAD_INPUT,
        "%s is no file of bounds: it takes \"format\": \"auxshell-bounds\", ranges [LO, HI] under \"every\", "
        "and \"examples\" with \"bounds\" of the same kind.",
        path);
}

void bounds_free(bounds* b)
{
    json_decref(b->root);
    *b = (bounds){0};
}

const json_t* bounds_of(const bounds* b, const char* example)
{
    return json_object_get(b->examples, example);
}

bool bounds_space(const json_t* example, const ax_design* design, ax_space* space)
{
    json_t* headroom = json_object_get(example, "headroom");
    double metres = json_is_number(headroom) ? json_number_value(headroom) : 2.1;
    return ax_space_measure(design, design->simulated ? AX_STATE_SIMULATED : AX_STATE_DEPLOYED, NAN,
                            metres / ax_unit_in_metres(design->unit), space, NULL) == AX_OK;
}

typedef struct judged {
    const ax_design* design;
    const ax_form_report* form;
    const json_t* example;
    bool loaded;
    json_t* broken;
} judged;

// What several ranges say is said once.
static void add(const judged* j, const char* text)
{
    for (size_t k = 0; k < json_array_size(j->broken); ++k)
        if (strcmp(json_string_value(json_array_get(j->broken, k)), text) == 0)
            return;
    json_array_append_new(j->broken, json_string(text));
}

static void say(const judged* j, const char* key, double value, const char* relation, double limit)
{
    char text[160];
    snprintf(text, sizeof text, "%s is %.4g, %s %.4g is allowed", key, value, relation, limit);
    add(j, text);
}

// NaN: the design has no such figure.
static double value_of(const judged* j, const char* key, bool* known)
{
    int count;
    const ax_figure* figures = ax_report_figures(&count);
    *known = true;
    if (strcmp(key, "triangles") == 0)
        return j->design->linkage.triangle_count;
    if (strcmp(key, "supports") == 0) {
        int supports = 0;
        for (int h = 0; h < j->design->linkage.hinge_count; ++h)
            supports += j->design->supports[h];
        return supports;
    }
    if (strcmp(key, "held_max_over_L") == 0) {
        double worst = 0;
        for (int k = 0; k < j->form->held_count; ++k)
            if (strcmp(j->form->held[k].kind, ax_held_kind_name(AX_HELD_FAIR)) !=
                0) // an even bend is a wish, never exact
                worst = fmax(worst, j->form->held[k].residual / j->design->report.edge_mean);
        return worst;
    }
    bool floor = strcmp(key, "floor") == 0, volume = strcmp(key, "volume") == 0;
    if (floor || volume || strcmp(key, "headroom_share") == 0) {
        ax_space s;
        if (!bounds_space(j->example, j->design, &s))
            return NAN;
        return floor ? s.floor : volume ? s.volume : s.headroom_area / s.floor;
    }
    for (int k = 0; k < count; ++k)
        if (strcmp(figures[k].key, key) == 0)
            return ax_figure_value(&figures[k], &j->design->report, 0);
    *known = false;
    return NAN;
}

static bool is_of_deployment(const char* key)
{
    int count;
    const ax_figure* figures = ax_report_figures(&count);
    for (int k = 0; k < count; ++k)
        if (strcmp(figures[k].key, key) == 0)
            return figures[k].group == AX_GROUP_DEPLOYMENT;
    return false;
}

static void check_ranges(const judged* j, const json_t* ranges)
{
    const char* key;
    json_t* range;
    json_object_foreach((json_t*)ranges, key, range)
    {
        bool known;
        if (!j->loaded && is_of_deployment(key))
            continue;
        double value = value_of(j, key, &known);
        json_t *lo = json_array_get(range, 0), *hi = json_array_get(range, 1);
        if (!known || isnan(value)) {
            char text[160];
            snprintf(text, sizeof text, known ? "%s is missing" : "there is no figure %s", key);
            add(j, text);
            continue;
        }
        if (json_is_number(lo) && value < json_number_value(lo))
            say(j, key, value, "at least", json_number_value(lo));
        if (json_is_number(hi) && value > json_number_value(hi))
            say(j, key, value, "at most", json_number_value(hi));
    }
}

static void check_load(const judged* j, const char* asked)
{
    const char* found = ax_load_kind_name(j->design->load.kind);
    char text[160];
    if (asked ? strcmp(asked, found) == 0 : j->loaded)
        return;
    snprintf(text, sizeof text, "it is deployed by %s, not by %s", found, asked ? asked : "a load");
    add(j, text);
}

json_t* bounds_check(const bounds* b, const json_t* example, const ax_design* design, const ax_form_report* form)
{
    judged j = {design, form, example, design->load.kind != AX_LOAD_NONE, json_array()};
    int count;
    const ax_figure* figures = ax_report_figures(&count);
    for (int k = 0; k < count; ++k)
        if ((j.loaded || figures[k].group != AX_GROUP_DEPLOYMENT) && !ax_figure_holds(&figures[k], design))
            say(&j, figures[k].key, ax_figure_value(&figures[k], &design->report, 0),
                figures[k].relation == AX_AT_MOST ? "at most" : "at least", ax_figure_limit(&figures[k], design));
    check_load(&j, json_string_value(json_object_get(example, "load")));
    check_ranges(&j, b->every);
    check_ranges(&j, json_object_get(example, "bounds"));
    return j.broken;
}
