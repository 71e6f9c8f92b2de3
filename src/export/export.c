#include "ax/export.h"

#include "base/file.h"
#include "base/pool.h"

#include <assert.h>
#include <locale.h>
#include <math.h>
#include <stdatomic.h>
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

// One format: a file as `write` makes it, or a plan's sheets.
typedef struct job {
    const ax_design* design;
    const char* path;
    const ax_export_type* type;
    ax_state state;
    const ax_export_options* options;
    const ax_cut_plan* plan; // of cut files
} job;

// One file of a job, for a thread.
typedef struct piece {
    const job* job;
    int sheet;
    ax_file file;
    ax_status status;
    ax_error error;
} piece;

static void write_piece(piece* p)
{
    const job* j = p->job;
    // numbers have a decimal point whatever the program's locale says
    locale_t plain = newlocale(LC_NUMERIC_MASK, "C", (locale_t)0), before = uselocale(plain);
    p->status = j->plan ? j->type->write_sheet(j->design, j->plan, p->sheet, p->file.path, &p->error)
                        : j->type->write(j->design, j->state, j->options, p->file.path, &p->error);
    uselocale(before);
    freelocale(plain);
    if (p->status != AX_OK)
        name_destination(&p->file, &p->error);
}

static bool has_sheet_files(const job* j)
{
    return j->plan && j->plan->sheet_count > 1 && !j->type->all_sheets;
}

// "dome.svg" and sheet 2 to "dome-3.svg"; the overview keeps the name.
static char* sheet_path(const job* j, int sheet)
{
    size_t length = strlen(j->path), stem = length - strlen(j->type->ending);
    char* name = ax_alloc(length + 16, 1);
    if (has_sheet_files(j) && sheet < j->plan->sheet_count)
        snprintf(name, length + 16, "%.*s-%d%s", (int)stem, j->path, sheet + 1, j->path + stem);
    else
        snprintf(name, length + 16, "%s", j->path);
    return name;
}

char* ax_export_sheet_path(const char* path, const ax_cut_plan* plan, int sheet)
{
    const ax_export_type* type = find_type(path);
    const job j = {.path = path, .type = type, .plan = type && type->write_sheet ? plan : NULL};
    return has_sheet_files(&j) ? sheet_path(&j, sheet) : NULL;
}

// Files of all sheets come first: they take longest.
static piece* make_pieces(int job_count, const job* jobs, int* count)
{
    *count = 0;
    for (int k = 0; k < job_count; ++k)
        *count += has_sheet_files(&jobs[k]) ? jobs[k].plan->sheet_count + 1 : 1;
    piece* pieces = AX_NEW0(piece, *count);
    for (int pass = 0, at = 0; pass < 2; ++pass)
        for (int k = 0; k < job_count; ++k) {
            if (has_sheet_files(&jobs[k]) != pass)
                continue;
            for (int sheet = 0; sheet < (pass ? jobs[k].plan->sheet_count + 1 : 1); ++sheet)
                pieces[at++] = (piece){.job = &jobs[k], .sheet = sheet};
        }
    return pieces;
}

typedef struct queue {
    piece* pieces;
    int count;
    atomic_int next;
} queue;

static void work(void* context, int thread)
{
    (void)thread;
    queue* q = context;
    for (int k; (k = atomic_fetch_add(&q->next, 1)) < q->count;)
        write_piece(&q->pieces[k]);
}

// All files are written, by all threads, before the first is renamed.
static ax_status write_jobs(int job_count, const job* jobs, ax_error* error)
{
    queue q = {0};
    int begun = 0;
    ax_status status = AX_OK;
    q.pieces = make_pieces(job_count, jobs, &q.count);
    for (; begun < q.count && status == AX_OK; ++begun) {
        char* name = sheet_path(q.pieces[begun].job, q.pieces[begun].sheet);
        status = ax_file_begin_path(&q.pieces[begun].file, name, error);
        ax_free(name);
        if (status != AX_OK)
            break;
    }
    if (status == AX_OK) {
        ax_pool* pool = ax_pool_make(q.count > 1 ? 0 : 1);
        ax_pool_run(pool, work, &q, ax_pool_threads(pool));
        ax_pool_free(pool);
    }
    for (int k = 0; k < begun && status == AX_OK; ++k)
        if (q.pieces[k].status != AX_OK)
            status = ax_fail(error, q.pieces[k].status, "%s", q.pieces[k].error.message);
    for (int k = 0; k < begun; ++k)
        status = ax_file_end(&q.pieces[k].file, status, error);
    ax_free(q.pieces);
    return status;
}

static ax_status make_plan(const ax_design* design, const ax_export_options* options, ax_cut_plan* plan,
                           ax_error* error)
{
    ax_fabricate_options fabricate = options->fabricate ? *options->fabricate : ax_fabricate_options_default();
    fabricate.title = options->title;
    return ax_fabricate(design, &fabricate, options->progress, plan, error);
}

ax_status ax_export_files(const ax_design* design, int count, const char* const* paths,
                          const ax_export_options* options, ax_error* error)
{
    const ax_export_options given = options ? *options : (ax_export_options){0};
    job* jobs = AX_NEW0(job, count);
    ax_cut_plan plan = {0};
    bool cuts = false;
    ax_status status = AX_OK;
    for (int k = 0; k < count && status == AX_OK; ++k) {
        const ax_export_type* type = find_type(paths[k]);
        jobs[k] = (job){.design = design, .path = paths[k], .type = type, .options = &given};
        if (!type) {
            status = fail_unknown_ending(paths[k], error);
            break;
        }
        jobs[k].state = given.state == AX_STATE_DEFAULT ? type->default_state : given.state;
        status = check_state(design, type, jobs[k].state, error);
        if (type->write_sheet)
            jobs[k].plan = &plan, cuts = true;
    }
    if (status == AX_OK && cuts)
        status = make_plan(design, &given, &plan, error);
    if (status == AX_OK && !ax_progress_report(given.progress, "Writing", 1, NAN))
        status = ax_fail(error, AX_CANCELLED, "Cancelled before writing.");
    if (status == AX_OK)
        status = write_jobs(count, jobs, error);
    if (given.plan)
        *given.plan = status == AX_OK ? plan : (ax_cut_plan){0};
    if (!given.plan || status != AX_OK)
        ax_cut_plan_free(&plan);
    ax_free(jobs);
    return status;
}

ax_status ax_export(const ax_design* design, const char* path, const ax_export_options* options, ax_error* error)
{
    return ax_export_files(design, 1, &path, options, error);
}

ax_status ax_export_plan(const ax_cut_plan* plan, const char* path, ax_error* error)
{
    const ax_export_type* type = find_type(path);
    if (!type)
        return fail_unknown_ending(path, error);
    if (!type->write_sheet)
        return ax_fail(error, AX_USAGE, "A %s (%s) cannot hold a cut plan.", type->name, type->ending);
    return write_jobs(1, &(job){.path = path, .type = type, .state = AX_STATE_FLAT, .plan = plan}, error);
}
