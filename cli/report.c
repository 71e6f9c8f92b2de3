#include "report.h"

#include <math.h>
#include <string.h>

enum { LABEL = 40, VALUE = 22 };

// Units of lengths are the document's.
static void unit_words(const ax_figure* figure, ax_unit unit, char* words, size_t size)
{
    const char* name = ax_unit_name(unit);
    if (strcmp(figure->unit, "length") == 0)
        snprintf(words, size, " %s", name);
    else if (strcmp(figure->unit, "area") == 0)
        snprintf(words, size, " %s2", name);
    else
        snprintf(words, size, "%s%s", *figure->unit ? " " : "", figure->unit);
}

static void number_words(const ax_figure* figure, double x, char* words, size_t size)
{
    if (figure->kind == AX_FIGURE_FLAG)
        snprintf(words, size, "%s", x != 0 ? "yes" : "no");
    else if (figure->kind == AX_FIGURE_COUNT)
        snprintf(words, size, "%.0f", x);
    else if (!isfinite(x))
        snprintf(words, size, "-");
    else if (x != 0 && fabs(x) < 1e-3)
        snprintf(words, size, "%.1e", x);
    else if (strcmp(figure->unit, "deg") == 0 || strcmp(figure->unit, "s") == 0)
        snprintf(words, size, "%.2f", x);
    else if (strcmp(figure->unit, "L") == 0)
        snprintf(words, size, "%.4f", x);
    else
        snprintf(words, size, fabs(x) >= 1e4 ? "%.0f" : "%.4g", x);
}

// Places of what does not exist: "hinge with the smallest mouth" of a design without one.
static bool is_no_place(const ax_figure* figure, const ax_report* report)
{
    return figure->kind == AX_FIGURE_COUNT && ax_figure_value(figure, report, 0) < 0;
}

static void print_figure(const ax_figure* figure, const ax_design* design, FILE* out)
{
    char value[128] = "", number[40], unit[16];
    size_t used = 0;
    for (int k = 0; k < figure->count; ++k) {
        number_words(figure, ax_figure_value(figure, &design->report, k), number, sizeof number);
        used += (size_t)snprintf(value + used, sizeof value - used, "%s%s", k ? ", " : "", number);
    }
    unit_words(figure, design->unit, unit, sizeof unit);
    double limit = ax_figure_limit(figure, design);
    fprintf(out, "  %-*s %*s%s", LABEL, figure->label, VALUE, value, unit);
    if (!isnan(limit)) {
        fprintf(out, "%*s", 4 - (int)strlen(unit), "");
        const char* relation = figure->relation == AX_AT_MOST ? "at most" : "at least";
        number_words(figure, limit, number, sizeof number);
        if (figure->kind == AX_FIGURE_FLAG)
            fprintf(out, "  %-20s", "must be");
        else
            fprintf(out, "  %-8s %-11s", relation, number);
        fputs(ax_figure_holds(figure, design) ? "holds" : "FAILS", out);
    }
    putc('\n', out);
}

// Figures of the fit to a target, or of the simulated state, where there is none.
static bool is_of_nothing(const ax_figure* figure, const ax_design* design)
{
    return (figure->group == AX_GROUP_FIT && design->target.vertex_count == 0) ||
           (figure->group == AX_GROUP_DEPLOYMENT && !design->simulated);
}

void report_print(const ax_design* design, FILE* out)
{
    int count, failing = 0;
    const ax_figure* figures = ax_report_figures(&count);
    bool targeted = design->target.vertex_count > 0;
    for (int k = 0; k < count; ++k) {
        const ax_figure* figure = &figures[k];
        if (figure->group == AX_GROUP_FIT && !targeted)
            continue;
        if (k == 0 || figures[k - 1].group != figure->group)
            fprintf(out, "\n%s\n", ax_figure_group_name(figure->group));
        if (is_no_place(figure, &design->report))
            continue;
        if (is_of_nothing(figure, design) && figure->kind != AX_FIGURE_FLAG)
            continue; // one line says that it is missing
        print_figure(figure, design, out);
        failing += !ax_figure_holds(figure, design);
    }
    if (failing == 0)
        fputs("\nEvery limit holds: the flat sheet deploys to the designed shape.\n", out);
    else if (!design->simulated)
        fputs("\nNot proven: there is no simulated state.\n", out);
    else
        fprintf(out, "\n%d limit%s not kept.\n", failing, failing == 1 ? " is" : "s are");
}

int report_print_failing(const ax_design* design, FILE* out)
{
    int count, failing = 0;
    const ax_figure* figures = ax_report_figures(&count);
    for (int k = 0; k < count; ++k) {
        const ax_figure* figure = &figures[k];
        if (is_of_nothing(figure, design) || ax_figure_holds(figure, design))
            continue;
        if (failing++ == 0)
            fputs("\nNot kept:\n", out);
        print_figure(figure, design, out);
    }
    return failing;
}

void form_print(const ax_form_report* r, ax_unit unit, FILE* out)
{
    if (r->held_count)
        fprintf(out, "\n  %-24s%-14s%8s  %12s\n", "held", "by", "hinges", "off by");
    for (int k = 0; k < r->held_count; ++k)
        fprintf(out, "  %-24s%-14s%8d  %12.3g %s\n", r->held[k].name, r->held[k].kind, r->held[k].count,
                r->held[k].residual, ax_unit_name(unit));
    for (int k = 0; k < r->finding_count; ++k)
        fprintf(out, "%s%s\n", k ? "" : "\n", r->findings[k].text);
}

json_t* form_json(const ax_form_report* r)
{
    json_t *held = json_array(), *findings = json_array();
    for (int k = 0; k < r->held_count; ++k) {
        const ax_held_figure* h = &r->held[k];
        json_array_append_new(held, json_pack("{s:s, s:s, s:i, s:o, s:i, s:o}", "name", h->name, "kind", h->kind,
                                              "count", h->count, "residual", json_number(h->residual), "hinge",
                                              h->hinge, "multiplier", json_number(h->multiplier)));
    }
    for (int k = 0; k < r->finding_count; ++k) {
        const ax_finding* f = &r->findings[k];
        json_array_append_new(
            findings, json_pack("{s:s, s:s, s:i, s:i, s:i, s:o, s:o, s:s}", "severity", ax_severity_name(f->severity),
                                "kind", f->kind, "triangle", f->triangle, "hinge", f->hinge, "other", f->other, "value",
                                json_number(f->value), "limit", json_number(f->limit), "text", f->text));
    }
    return json_pack("{s:o, s:o}", "held", held, "findings", findings);
}

json_t* json_number(double x)
{
    return isfinite(x) ? json_real(x) : json_null();
}

json_t* json_numbers(const double* x, int count)
{
    json_t* array = json_array();
    for (int k = 0; k < count; ++k)
        json_array_append_new(array, json_number(x[k]));
    return array;
}

static json_t* figure_json(const ax_figure* figure, const ax_report* report, int k)
{
    double x = ax_figure_value(figure, report, k);
    if (figure->kind == AX_FIGURE_FLAG)
        return json_boolean(x != 0);
    return figure->kind == AX_FIGURE_COUNT ? json_integer((json_int_t)x) : json_number(x);
}

json_t* report_json(const ax_design* design)
{
    int count;
    const ax_figure* figures = ax_report_figures(&count);
    json_t* report = json_object();
    for (int k = 0; k < count; ++k) {
        json_t* value = figures[k].count == 1 ? figure_json(&figures[k], &design->report, 0) : json_array();
        for (int i = 0; figures[k].count > 1 && i < figures[k].count; ++i)
            json_array_append_new(value, figure_json(&figures[k], &design->report, i));
        json_object_set_new(report, figures[k].key, value);
    }
    return report;
}

void repairs_print(const ax_mesh_repairs* repairs, FILE* out)
{
    const struct {
        int count;
        const char *one, *many;
    } mended[] = {
        {repairs->welded_vertices, "vertex welded", "vertices welded"},
        {repairs->degenerate_faces, "face without area dropped", "faces without area dropped"},
        {repairs->duplicate_faces, "repeated face dropped", "repeated faces dropped"},
        {repairs->unused_vertices, "unused vertex dropped", "unused vertices dropped"},
        {repairs->flipped_faces, "face turned to agree with its neighbours",
         "faces turned to agree with their neighbours"},
    };
    int said = 0;
    for (size_t k = 0; k < sizeof mended / sizeof *mended; ++k)
        if (mended[k].count)
            fprintf(out, "%s%d %s", said++ ? ", " : "", mended[k].count,
                    mended[k].count == 1 ? mended[k].one : mended[k].many);
    if (repairs->turned_outward)
        fprintf(out, "%sall faces turned outward", said++ ? ", " : "");
    fputs(said ? "\n" : "nothing\n", out);
}

json_t* repairs_json(const ax_mesh_repairs* repairs)
{
    return json_pack("{s:i, s:i, s:i, s:i, s:i, s:b}", "welded_vertices", repairs->welded_vertices, "degenerate_faces",
                     repairs->degenerate_faces, "duplicate_faces", repairs->duplicate_faces, "unused_vertices",
                     repairs->unused_vertices, "flipped_faces", repairs->flipped_faces, "turned_outward",
                     (int)repairs->turned_outward);
}

void load_words(const ax_load* load, char* words, size_t size)
{
    const double* d = load->direction;
    if (load->kind == AX_LOAD_INFLATION)
        snprintf(words, size, "inflation at %.6g Pa", load->pressure);
    else if (load->kind == AX_LOAD_GRAVITY && d[0] == 0 && d[1] == 0)
        snprintf(words, size, "gravity on %.6g kg/m2 towards %cz", load->density, d[2] < 0 ? '-' : '+');
    else if (load->kind == AX_LOAD_GRAVITY)
        snprintf(words, size, "gravity on %.6g kg/m2 towards (%.4g, %.4g, %.4g)", load->density, d[0], d[1], d[2]);
    else
        snprintf(words, size, "no load");
}

void json_print(json_t* value, FILE* out)
{
    json_dumpf(value, out, JSON_INDENT(1) | JSON_REAL_PRECISION(17));
    putc('\n', out);
    json_decref(value);
}
