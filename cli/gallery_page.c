#include "gallery_page.h"

#include "bounds.h"
#include "output.h"
#include "report.h"

#include "ax/picture.h"

#include <ctype.h>
#include <errno.h>
#include <limits.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

struct gallery_page {
    char path[PATH_MAX], pictures[PATH_MAX];
    FILE *table, *sections;
    char *table_text, *sections_text;
    size_t table_size, sections_size;
};

ax_status gallery_page_open(const char* path, gallery_page** out, ax_error* error)
{
    char folder[PATH_MAX];
    const char* slash = strrchr(path, '/');
    ax_status status = output_check(path, ".md", error);
    if (status != AX_OK)
        return status;
    gallery_page* p = AX_NEW0(gallery_page, 1);
    snprintf(p->path, sizeof p->path, "%s", path);
    snprintf(folder, sizeof folder, "%.*s", slash ? (int)(slash - path) : 1, slash ? path : ".");
    status = output_join(folder, "pictures", p->pictures, sizeof p->pictures, error);
    if (status == AX_OK)
        status = output_make_folder(p->pictures, error);
    if (status == AX_OK)
        status = output_join(folder, "pictures/gallery", p->pictures, sizeof p->pictures, error);
    if (status == AX_OK)
        status = output_make_folder(p->pictures, error);
    if (status != AX_OK) {
        ax_free(p);
        return status;
    }
    p->table = open_memstream(&p->table_text, &p->table_size);
    p->sections = open_memstream(&p->sections_text, &p->sections_size);
    *out = p;
    return AX_OK;
}

static void title_of(const char* name, char title[NAME_MAX + 1])
{
    snprintf(title, NAME_MAX + 1, "%s", name);
    title[0] = (char)toupper((unsigned char)title[0]);
    for (char* c = title; *c; ++c)
        if (*c == '-')
            *c = ' ';
}

static void write_row(gallery_page* p, const char* name, const ax_design* d, double seconds)
{
    const ax_report* r = &d->report;
    char title[NAME_MAX + 1];
    title_of(name, title);
    fprintf(p->table, "| [%s](#%s) | %d | %s | %.2f to %.2f | %.1f° | %d | ", title, name, d->linkage.triangle_count,
            d->simulated ? ax_load_kind_name(d->load.kind) : "in the plane", r->scale_min, r->scale_max,
            r->mouth_min_deg, r->overlap_pairs);
    if (d->simulated)
        fprintf(p->table, "%.4f, %.4f | %.0e |", r->simulated_rms_over_L, r->simulated_max_over_L, r->force_residual);
    else
        fputs("| |", p->table);
    fprintf(p->table, " %.0e | %.1f s |\n", r->congruence_max, seconds);
}

static void write_forces(gallery_page* p, const ax_design* d)
{
    const ax_report* r = &d->report;
    if (d->load.kind == AX_LOAD_INFLATION)
        fprintf(p->sections, "Pressure %.4g Pa: ", d->load.pressure);
    else
        fprintf(p->sections, "Panels of %.4g kg/m2: ", d->load.density);
    fprintf(p->sections, "edge forces %.3g to %.3g N, hinge forces up to %.3g N, %.3g N of load in all.\n\n",
            r->edge_force_min, r->edge_force_max, r->hinge_force_max, r->load_total);
}

// Of what is blown up, people use the inside.
static void write_space(gallery_page* p, const json_t* example, const ax_design* d)
{
    ax_space s;
    const char* unit = ax_unit_name(d->unit);
    if (d->load.kind == AX_LOAD_INFLATION && d->unit == AX_METRE && bounds_space(example, d, &s))
        fprintf(p->sections, "Inside: %.3g %s3 over %.3g %s2 of floor, %.0f %% of it %.3g %s high or more.\n\n",
                s.volume, unit, s.floor, unit, 100 * s.headroom_area / s.floor, s.headroom, unit);
}

// The note is the recipe's own, which the reader of operators does not keep in a field.
static void write_note(gallery_page* p, const ax_recipe* recipe)
{
    char* text = ax_recipe_text(recipe);
    json_t* root = json_loads(text, 0, NULL);
    const char* note = json_string_value(json_object_get(root, "note"));
    if (note)
        fprintf(p->sections, "%s\n\n", note);
    json_decref(root);
    ax_free(text);
}

ax_status gallery_page_add(gallery_page* p, const char* name, const ax_recipe* recipe, const json_t* example,
                           const ax_design* d, const ax_form_report* form, double seconds, ax_error* error)
{
    static const ax_state states[] = {AX_STATE_FLAT, AX_STATE_DEPLOYED};
    char title[NAME_MAX + 1], file[NAME_MAX + 1], path[PATH_MAX];
    ax_status status = AX_OK;
    write_row(p, name, d, seconds);
    title_of(name, title);
    fprintf(p->sections, "## %s\n\n", title);
    write_note(p, recipe);
    snprintf(file, sizeof file, "../photo-%s.jpg", name);
    status = output_join(p->pictures, file, path, sizeof path, error);
    if (status == AX_OK && access(path, R_OK) == 0)
        fprintf(p->sections, "![%s](pictures/photo-%s.jpg)\n\n", title, name);
    for (int k = 0; k < 2 && status == AX_OK; ++k) {
        const char* state = ax_state_name(states[k]);
        snprintf(file, sizeof file, "%s-%s.png", name, state);
        status = output_join(p->pictures, file, path, sizeof path, error);
        if (status == AX_OK)
            status = ax_picture_design(d, states[k], 720, 540, path, error);
    }
    fprintf(p->sections,
            "| flat, as it is cut | deployed |\n|---|---|\n"
            "| ![%s, flat](pictures/gallery/%s-flat.png) | ![%s, deployed](pictures/gallery/%s-deployed.png) |\n\n",
            title, name, title, name);
    const ax_report* r = &d->report;
    const char* unit = ax_unit_name(d->unit);
    fprintf(p->sections, "%d panels of mean edge %.3g %s; the sheet measures %.3g by %.3g %s, the shell %.3g by %.3g",
            d->linkage.triangle_count, r->edge_mean, unit, r->flat_bounds[0], r->flat_bounds[1], unit,
            r->deployed_bounds[0], r->deployed_bounds[1]);
    if (d->simulated)
        fprintf(p->sections, " by %.3g", r->deployed_bounds[2]);
    fprintf(p->sections, " %s. ", unit);
    if (d->simulated)
        write_forces(p, d), write_space(p, example, d);
    else
        fputs("It opens in the plane, by hand, under no load.\n\n", p->sections);
    for (int k = 0; k < form->finding_count; ++k)
        fprintf(p->sections, "%s- %s\n", k ? "" : "The report adds:\n\n", form->findings[k].text);
    if (form->finding_count)
        fputc('\n', p->sections);
    fprintf(p->sections, "    ./run run examples/%s.json -o %s.auxshell\n", name, name);
    const json_t* make = json_object_get(example, "make");
    const char *joint = json_string_value(json_object_get(make, "joint")),
               *material = json_string_value(json_object_get(make, "material")),
               *sheet = json_string_value(json_object_get(make, "sheet"));
    if (joint && material && sheet)
        fprintf(p->sections, "    ./run export %s.auxshell --joint %s --material %s --sheet %s -o %s.dxf\n", name,
                joint, material, sheet, name);
    fputc('\n', p->sections);
    return status;
}

ax_status gallery_page_write(gallery_page* p, ax_error* error)
{
    fflush(p->table);
    fflush(p->sections);
    FILE* out = fopen(p->path, "w");
    if (!out)
        return ax_fail(error, AX_FAILED, "%s cannot be written: %s.", p->path, strerror(errno));
    fputs("# Gallery\n\n"
          "Written by `auxshell gallery --page`, which makes every example again from its recipe and holds its figures "
          "against\n"
          "[bounds](../examples/gallery/bounds.json). Opened in the studio, each can be changed anywhere. Distances "
          "are those of\n"
          "the state simulated from flat to the designed one, rms and largest, over the mean edge L; where the load "
          "finds the\n"
          "form and is adopted, both are one. Times are for the whole recipe, on two cores.\n\n"
          "| | panels | deployed by | scale factors | smallest mouth | overlaps | distance / L | force residual | "
          "congruence | "
          "time |\n|---|---|---|---|---|---|---|---|---|---|\n",
          out);
    fputs(p->table_text, out);
    fputc('\n', out);
    p->sections_text[strlen(p->sections_text) - 1] = 0; // the empty line at the end
    fputs(p->sections_text, out);
    bool failed = ferror(out) != 0;
    if (fclose(out) != 0 || failed)
        return ax_fail(error, AX_FAILED, "%s could not be written whole.", p->path);
    return AX_OK;
}

void gallery_page_close(gallery_page* p)
{
    if (!p)
        return;
    fclose(p->table);
    fclose(p->sections);
    free(p->table_text);
    free(p->sections_text);
    ax_free(p);
}
