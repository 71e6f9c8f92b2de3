#include "ax/export.h"

#include "base/file.h"

#include <assert.h>
#include <locale.h>
#include <stdio.h>
#include <string.h>
#include <strings.h>

static const char* const state_names[] = {[AX_STATE_DEFAULT] = "default",
                                          [AX_STATE_FLAT] = "flat",
                                          [AX_STATE_DEPLOYED] = "deployed",
                                          [AX_STATE_SIMULATED] = "simulated"};

const char* ax_state_name(ax_state state)
{
    assert((size_t)state < sizeof state_names / sizeof *state_names);
    return state_names[state];
}

// The longest ending counts, so that one may be the tail of another.
static const ax_export_type* find_type(const char* path)
{
    int count;
    const ax_export_type* const* types = ax_export_types(&count);
    const ax_export_type* found = NULL;
    size_t length = strlen(path), longest = 0;
    for (int k = 0; k < count; ++k) {
        size_t ending = strlen(types[k]->ending);
        if (ending > longest && length >= ending && strcasecmp(path + length - ending, types[k]->ending) == 0)
            found = types[k], longest = ending;
    }
    return found;
}

static ax_status fail_unknown_ending(const char* path, ax_error* error)
{
    int count, used = 0;
    const ax_export_type* const* types = ax_export_types(&count);
    char known[1024] = "";
    for (int k = 0; k < count && used < (int)sizeof known; ++k)
        used += snprintf(known + used, sizeof known - (size_t)used, "%s%s",
                         k == 0          ? ""
                         : k + 1 < count ? ", "
                                         : " or ",
                         types[k]->ending);
    return ax_fail(error, AX_USAGE, "The ending of %s names no known format. End the name in %s.", path, known);
}

static ax_status check_state(const ax_design* design, const ax_export_type* type, ax_state state, ax_error* error)
{
    if (!type->states[state])
        return ax_fail(error, AX_USAGE, "A %s (%s) cannot hold the %s state; it is for the %s state.", type->name,
                       type->ending, ax_state_name(state), ax_state_name(type->default_state));
    if (state == AX_STATE_SIMULATED && !design->simulated)
        return ax_fail(error, AX_BAD_INPUT,
                       "The design has no simulated state to export. Simulate it first, or export the deployed state.");
    return AX_OK;
}

// Exporters know the file beside only; people know the destination.
static void name_destination(const ax_file* file, ax_error* error)
{
    char* place = error ? strstr(error->message, file->path) : NULL;
    if (place) {
        size_t keep = strlen(file->destination), whole = strlen(file->path);
        memmove(place + keep, place + whole, strlen(place + whole) + 1);
    }
}

// What is written: a file as `write` makes it, or one sheet of a plan.
typedef struct job {
    const ax_design* design;
    const ax_export_type* type;
    ax_state state;
    const ax_export_options* options;
    const ax_cut_plan* plan;
} job;

static ax_status write_file(const job* j, int sheet, ax_file* file, ax_error* error)
{
    // numbers have a decimal point whatever the program's locale says
    locale_t plain = newlocale(LC_NUMERIC_MASK, "C", (locale_t)0), before = uselocale(plain);
    ax_status status = j->plan ? j->type->write_sheet(j->design, j->plan, sheet, file->path, error)
                               : j->type->write(j->design, j->state, j->options, file->path, error);
    uselocale(before);
    freelocale(plain);
    if (status != AX_OK)
        name_destination(file, error);
    return status;
}

static ax_status write_one(const job* j, const char* path, ax_error* error)
{
    ax_file file;
    ax_status status = ax_file_begin_path(&file, path, error);
    if (status != AX_OK)
        return status;
    status = write_file(j, 0, &file, error);
    if (status == AX_OK)
        return ax_file_commit(&file, error);
    ax_file_abandon(&file);
    return status;
}

// "dome.svg" and sheet 2 to "dome-3.svg"; the overview keeps the name.
static char* sheet_path(const job* j, const char* path, int sheet)
{
    size_t length = strlen(path), stem = length - strlen(j->type->ending);
    char* name = ax_alloc(length + 16, 1);
    if (sheet == j->plan->sheet_count)
        snprintf(name, length + 16, "%s", path);
    else
        snprintf(name, length + 16, "%.*s-%d%s", (int)stem, path, sheet + 1, path + stem);
    return name;
}

// All sheets are written before the first is renamed.
static ax_status write_sheets(const job* j, const char* path, ax_error* error)
{
    int count = j->plan->sheet_count + 1, begun = 0;
    ax_file* files = AX_NEW0(ax_file, count);
    ax_status status = AX_OK;
    for (; begun < count && status == AX_OK; ++begun) {
        char* name = sheet_path(j, path, begun);
        status = ax_file_begin_path(&files[begun], name, error);
        ax_free(name);
        if (status != AX_OK)
            break;
        status = write_file(j, begun, &files[begun], error);
    }
    for (int k = 0; k < begun; ++k)
        if (status == AX_OK)
            status = ax_file_commit(&files[k], error);
        else
            ax_file_abandon(&files[k]);
    ax_free(files);
    return status;
}

static ax_status write_plan(const job* j, const char* path, ax_error* error)
{
    bool one_file = j->plan->sheet_count == 1 || j->type->all_sheets;
    return one_file ? write_one(j, path, error) : write_sheets(j, path, error);
}

static ax_status fabricate_and_write(job* j, const char* path, ax_error* error)
{
    ax_fabricate_options fabricate = j->options->fabricate ? *j->options->fabricate : ax_fabricate_options_default();
    fabricate.title = j->options->title;
    ax_cut_plan plan;
    ax_status status = ax_fabricate(j->design, &fabricate, j->options->progress, &plan, error);
    if (status != AX_OK)
        return status;
    j->plan = &plan;
    status = write_plan(j, path, error);
    if (status == AX_OK && j->options->plan)
        *j->options->plan = plan;
    else
        ax_cut_plan_free(&plan);
    return status;
}

ax_status ax_export(const ax_design* design, const char* path, const ax_export_options* options, ax_error* error)
{
    const ax_export_options given = options ? *options : (ax_export_options){0};
    if (given.plan)
        *given.plan = (ax_cut_plan){0};
    const ax_export_type* type = find_type(path);
    if (!type)
        return fail_unknown_ending(path, error);
    ax_state state = given.state == AX_STATE_DEFAULT ? type->default_state : given.state;
    ax_status status = check_state(design, type, state, error);
    if (status != AX_OK)
        return status;
    job j = {.design = design, .type = type, .state = state, .options = &given};
    return type->write_sheet ? fabricate_and_write(&j, path, error) : write_one(&j, path, error);
}

ax_status ax_export_plan(const ax_cut_plan* plan, const char* path, ax_error* error)
{
    const ax_export_type* type = find_type(path);
    if (!type)
        return fail_unknown_ending(path, error);
    if (!type->write_sheet)
        return ax_fail(error, AX_USAGE, "A %s (%s) cannot hold a cut plan.", type->name, type->ending);
    job j = {.type = type, .state = AX_STATE_FLAT, .plan = plan};
    return write_plan(&j, path, error);
}
