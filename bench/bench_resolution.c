// Whether shapes depend on the number of panels: forms of bench/forms.json at two numbers, and how far apart they come to rest.
//
//   bench_resolution [--json FILE] [--coarse 600] [--fine 2500] FORMS.json [NAME ...]        all forms unless named
//
// In % of the size, of the deployed and of the loaded state: the same points of the sheet, and from either surface to the other, at most.
// "rests" tells which of the two sheets are settled.
#include "ax/recipe.h"
#include "base/clock.h"

#include <jansson.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static ax_form* make(const json_t* operators, int triangles)
{
    json_t* list = json_deep_copy(operators);
    json_object_set_new(json_array_get(list, 0), "triangles", json_integer(triangles));
    json_t* recipe = json_pack("{s:s, s:i, s:o}", "format", "auxshell-recipe", "version", 1, "operators", list);
    char* text = json_dumps(recipe, 0);
    json_decref(recipe);
    ax_recipe* parsed;
    ax_form* form = NULL;
    ax_error error = {0};
    int done;
    ax_status status = ax_recipe_parse(text, &parsed, &error);
    if (status == AX_OK) {
        status = ax_recipe_play(parsed, -1, ".", NULL, NULL, NULL, &form, &done, &error);
        ax_recipe_free(parsed);
    }
    free(text);
    if (status != AX_OK) {
        fprintf(stderr, "%s\n", error.message);
        exit((int)status);
    }
    return form;
}

static bool rests(ax_form* form)
{
    ax_form_report report;
    ax_form_measure(form, &report);
    bool settled = report.settled;
    ax_form_report_free(&report);
    return settled;
}

static bool wanted(const char* name, int count, char** names)
{
    for (int k = 0; k < count; ++k)
        if (strcmp(name, names[k]) == 0)
            return true;
    return count == 0;
}

int main(int argc, char** argv)
{
    const char* json = "/dev/null";
    int panels[2] = {600, 2500};
    for (; argc > 3 && strncmp(argv[1], "--", 2) == 0; argc -= 2, argv += 2)
        if (strcmp(argv[1], "--json") == 0)
            json = argv[2];
        else if (strcmp(argv[1], "--coarse") == 0)
            panels[0] = atoi(argv[2]);
        else if (strcmp(argv[1], "--fine") == 0)
            panels[1] = atoi(argv[2]);
        else
            break;
    json_error_t problem;
    json_t* forms = argc > 1 ? json_load_file(argv[1], 0, &problem) : NULL;
    FILE* file = fopen(json, "w");
    if (!forms || !file) {
        fprintf(stderr, "usage: bench_resolution [--json FILE] [--coarse 600] [--fine 2500] FORMS.json [NAME ...]\n");
        return 2;
    }
    printf("%-44s points        surfaces      rests     s\n%-44s open   loaded open   loaded\n", "", "");
    size_t k, far[2] = {0, 0}, count = 0;
    json_t* entry;
    const char* separator = "";
    fprintf(file, "[");
    json_array_foreach(forms, k, entry)
    {
        const char* name = json_string_value(json_object_get(entry, "name"));
        if (!wanted(name, argc - 2, argv + 2))
            continue;
        double start = ax_seconds();
        ax_form* form[2];
        for (int i = 0; i < 2; ++i)
            form[i] = make(json_object_get(entry, "operators"), panels[i]);
        ax_form_apart open, loaded;
        ax_form_measure_apart(form[0], form[1], false, AX_FORM_APART_MARGIN, &open);
        ax_form_measure_apart(form[0], form[1], true, AX_FORM_APART_MARGIN, &loaded);
        bool rest[2] = {rests(form[0]), rests(form[1])};
        printf("%-44s %6.2f %6.2f %6.2f %6.2f  %s %s %5.1f\n", name, 100 * open.points_max, 100 * loaded.points_max,
               100 * open.surfaces_max, 100 * loaded.surfaces_max, rest[0] ? "yes" : "no ", rest[1] ? "yes" : "no ",
               ax_seconds() - start);
        fflush(stdout);
        fprintf(file,
                "%s\n  {\"name\": \"%s\", \"points_max\": [%.6g, %.6g], \"points_rms\": [%.6g, %.6g], "
                "\"surfaces_max\": [%.6g, %.6g], \"surfaces_rms\": [%.6g, %.6g], \"rests\": [%s, %s]}",
                separator, name, open.points_max, loaded.points_max, open.points_rms, loaded.points_rms,
                open.surfaces_max, loaded.surfaces_max, open.surfaces_rms, loaded.surfaces_rms,
                rest[0] ? "true" : "false", rest[1] ? "true" : "false");
        separator = ",";
        ++count;
        far[0] += fmax(open.points_max, loaded.points_max) > 0.02;
        far[1] += fmax(open.surfaces_max, loaded.surfaces_max) > 0.02;
        for (int i = 0; i < 2; ++i)
            ax_form_free(form[i]);
    }
    fprintf(file, "\n]\n");
    json_decref(forms);
    printf("%zu forms: %zu further apart than 2 %% by points, %zu by surfaces\n", count, far[0], far[1]);
    if (fclose(file)) {
        perror(json);
        return 1;
    }
    return 0;
}
