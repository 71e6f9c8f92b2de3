#include "fabricate.h"

#include "ax/document.h"

#include <ctype.h>
#include <math.h>
#include <string.h>
#include <time.h>

void fabricate_defaults(fabricate_arguments* arguments)
{
    ax_fabricate_options usual = ax_fabricate_options_default();
    arguments->margin = usual.margin;
    arguments->spacing = usual.spacing;
    arguments->frames = usual.frames;
}

// "2026-05-31"
static bool is_day(const char* words)
{
    static const char pattern[] = "dddd-dd-dd";
    for (int k = 0; k < (int)sizeof pattern; ++k)
        if (pattern[k] == 'd' ? !isdigit((unsigned char)words[k]) : words[k] != pattern[k])
            return false;
    return true;
}

static ax_status choose_date(const char* words, const char* document, char date[32], ax_error* error)
{
    *date = '\0';
    if (!words && document)
        ax_day_words(ax_document_time(document), date);
    else if (words && strcmp(words, "today") == 0)
        ax_day_words((double)time(NULL), date);
    else if (words && is_day(words))
        snprintf(date, 32, "%s", words);
    else if (words && strcmp(words, "none") != 0)
        return ax_fail(error, AX_USAGE, "--date takes a day such as 2026-05-31, or today, or none; not \"%s\".", words);
    return AX_OK;
}

ax_status fabricate_choose(const fabricate_arguments* a, const char* document, fabricate_choice* choice,
                           ax_error* error)
{
    ax_fabricate_options* options = &choice->options;
    *options = ax_fabricate_options_default();
    options->kerf = a->kerf, options->margin = a->margin, options->spacing = a->spacing;
    options->frames = a->frames;
    options->profile = &choice->profile;
    options->date = choice->date;
    ax_status status = ax_profile_find(a->profile ? a->profile : "generic", &choice->profile, error);
    if (status == AX_OK && a->joint)
        status = ax_fabricate_set_joint(options, a->joint, error);
    if (status == AX_OK && a->material)
        status = ax_fabricate_set_material(options, a->material, error);
    if (status == AX_OK && a->sheet)
        status = ax_fabricate_set_sheet(options, a->sheet, error);
    return status == AX_OK ? choose_date(a->date, document, choice->date, error) : status;
}

static void print_forces(const ax_cut_plan* p, FILE* out)
{
    double most = 0, rated = p->hinge_count ? p->hinges[0].rated : NAN;
    int over = 0, first = -1;
    for (int i = 0; i < p->hinge_count; ++i) {
        if (isnan(p->hinges[i].force))
            return;
        over += p->hinges[i].force > rated;
        if (p->hinges[i].force > most)
            most = p->hinges[i].force, first = i;
    }
    if (first < 0)
        return;
    fprintf(out, "  Hinge forces    %.4g N at most between panels, %s and %s", most,
            p->panels[p->hinges[first].panels[0]].name, p->panels[p->hinges[first].panels[1]].name);
    if (isnan(rated))
        fputs("; the joint has no rated force\n", out);
    else
        fprintf(out, "; the joint is rated %.4g N (an estimate)%s\n", rated, over ? ":" : "");
    if (over)
        fprintf(out, "                  %d of %d hinges are loaded beyond it\n", over, p->hinge_count);
}

static void print_folds(const ax_cut_plan* p, FILE* out)
{
    if (p->folds)
        fprintf(out,
                "  Folds           %d pair%s of neighbours lie%s folded onto each other when open, %s and %s first:\n"
                "                  no joint bends so far. Paint smaller scale factors there, or tighten to load\n",
                p->folds, p->folds == 1 ? "" : "s", p->folds == 1 ? "s" : "", p->panels[p->fold[0]].name,
                p->panels[p->fold[1]].name);
}

static void print_clearance(const ax_cut_plan* p, FILE* out)
{
    static const char* const frames[] = {"flat", "deployed", "simulated"};
    char states[64] = "";
    if (p->frames_checked)
        snprintf(states, sizeof states, " flat, open and in %d %sstates between", p->frames_checked,
                 p->simulated_way ? "simulated " : "");
    double least = INFINITY;
    for (int i = 0; i < p->hinge_count; ++i)
        if (!isnan(p->hinges[i].clearance))
            least = fmin(least, p->hinges[i].clearance);
    if (p->clashes_found == 0) {
        fprintf(out, "  Clearance       no panels collide%s", states);
        if (isfinite(least))
            fprintf(out, "; %.3g mm or more between neighbours from flat to open", least);
        putc('\n', out);
        return;
    }
    fprintf(out, "  Clearance       %d pairs of panels collide%s%s:\n", p->clashes_found, *states ? ", tried" : "",
            states);
    for (int i = 0; i < p->clash_count && i < 5; ++i) {
        const ax_cut_clash* c = &p->clashes[i];
        fprintf(out, "                  %s and %s by %.3g mm, ", p->panels[c->panels[0]].name,
                p->panels[c->panels[1]].name, c->overlap);
        if (c->frame < 0)
            fprintf(out, "turning about hinge %d\n", c->hinge);
        else if (c->frame == 3)
            fprintf(out, "between flat and open, %.0f %% of the way\n", 100 * c->opening);
        else
            fprintf(out, "in the %s state\n", frames[c->frame]);
    }
}

void fabricate_print(const ax_cut_plan* p, FILE* out)
{
    fprintf(out, "  Sheets          %d of %g x %g mm%s, %.0f %% used", p->sheet_count, p->sheets[0].width,
            p->sheets[0].height, p->in_place ? ", panels in place" : "", 100 * p->utilisation);
    if (p->seam_count)
        fprintf(out, "; %d seams to close", p->seam_count);
    fprintf(out, "\n  Panels          %d of %s, %.4g mm thick: %.4g m2, %.4g kg\n", p->panel_count, p->material.name,
            p->material.thickness, 1e-6 * p->area, p->mass);
    double cut = p->cut_length[AX_HOLE] + p->cut_length[AX_SLIT] + p->cut_length[AX_CUT];
    fprintf(out, "  Machine         %.4g m of cuts, %.4g m of marks, %.0f min by profile %s; kerf %g mm\n", 1e-3 * cut,
            1e-3 * (p->cut_length[AX_LABEL] + p->cut_length[AX_SCORE]), ceil(p->seconds / 60), p->profile->name,
            p->kerf);
    fprintf(out, "  Joint           %s", p->joint->name);
    for (int k = 0; k < p->joint->parameter_count; ++k)
        fprintf(out, "%c%s=%g", k ? ',' : ':', p->joint->parameters[k].name, p->joint_values[k]);
    for (int k = 0; k < p->part_count; ++k)
        fprintf(out, "; %d x %s", p->parts[k].count, p->parts[k].name);
    putc('\n', out);
    if (*p->doubt) {
        fputs("                  ", out);
        print_wrapped(out, 18, 18, p->doubt);
    }
    if (p->labels_dropped)
        fprintf(out, "  Labels          %d panels are too small for one\n", p->labels_dropped);
    print_forces(p, out);
    print_clearance(p, out);
    print_folds(p, out);
}

void fabricate_list(FILE* out)
{
    int count;
    fputs("Joints\n", out);
    const ax_joint_type* const* joints = ax_joint_types(&count);
    for (int k = 0; k < count; ++k) {
        fprintf(out, "  %-18s %s\n", joints[k]->name, joints[k]->doc);
        for (int i = 0; i < joints[k]->parameter_count; ++i) {
            const ax_joint_parameter* p = &joints[k]->parameters[i];
            fprintf(out, "    %-16s %s (%g to %g %s; default %g)\n", p->name, p->doc, p->least, p->most, p->unit,
                    p->standard);
        }
    }
    fputs("\nMaterials           thickness  density   usual kerf  least feature\n", out);
    const ax_material* materials = ax_materials(&count);
    for (int k = 0; k < count; ++k)
        fprintf(out, "  %-18s %4g mm   %5g kg/m3  %4g mm     %4g mm   %s\n", materials[k].name, materials[k].thickness,
                materials[k].density, materials[k].kerf, materials[k].feature, materials[k].doc);
    fputs("\nSheets\n ", out);
    const ax_sheet_size* sizes = ax_sheet_sizes(&count);
    for (int k = 0; k < count; ++k)
        fprintf(out, " %s", sizes[k].name);
    fputs("\n\nProfiles\n", out);
    const ax_profile* profiles = ax_profiles(&count);
    for (int k = 0; k < count; ++k)
        fprintf(out, "  %-18s %s\n", profiles[k].name, profiles[k].doc);
}
