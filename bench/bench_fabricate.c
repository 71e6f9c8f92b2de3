// From a design to cut files: sheets with labels by every joint, written to every cut format.
//
//   bench_fabricate [--json FILE] SURFACE [TRIANGLES ...]        default 2500 5000 10000 20000
//
// Panels have edges of 100 mm on average and go to sheets of 1220 x 2440 mm. Seconds of one run, from the design to all files at once: the
// plan, the proof of clearance, the writing; then every format by itself. Memory is the largest the process has had so far, sizes ascending.
#include "ax/export.h"
#include "base/clock.h"

#include <dirent.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/resource.h>
#include <unistd.h>

enum { MOST_SIZES = 16 };
static const double edge = 0.1; // m

static void require(ax_status status, const ax_error* error)
{
    if (status == AX_OK)
        return;
    fprintf(stderr, "%s\n", error->message);
    exit((int)status);
}

static ax_design make_design(const ax_mesh* surface, int triangles)
{
    ax_design_options options = ax_design_options_default();
    ax_mesh target = ax_mesh_copy(surface);
    ax_design design;
    ax_error error;
    options.triangles = triangles;
    options.project = true;
    for (int pass = 0; pass < 2; ++pass) {
        options.load.kind =
            pass ? AX_LOAD_INFLATION : AX_LOAD_NONE; // the first one tells how large the surface must be
        require(ax_design_from_target(&target, &options, NULL, &design, &error), &error);
        if (pass)
            break;
        for (int v = 0; v < target.vertex_count; ++v)
            for (int d = 0; d < 3; ++d)
                target.positions[v][d] *= edge / design.report.edge_mean;
        ax_design_free(&design);
    }
    ax_mesh_free(&target);
    return design;
}

static double peak_megabytes(void)
{
    struct rusage usage;
    getrusage(RUSAGE_SELF, &usage);
    return (double)usage.ru_maxrss / 1024;
}

// Takes down when the proof of clearance and the writing begin.
typedef struct stages {
    double proving, writing;
} stages;

static bool watch(void* context, const char* stage, double fraction, double residual)
{
    stages* s = context;
    (void)fraction, (void)residual;
    if (strncmp(stage, "Proving clearance", strlen("Proving clearance")) == 0 && s->proving == 0)
        s->proving = ax_seconds();
    if (strcmp(stage, "Writing") == 0)
        s->writing = ax_seconds();
    return true;
}

enum { MOST_FORMATS = 32 };

// The endings of cut files; returns how many.
static int cut_formats(const ax_export_type* formats[MOST_FORMATS])
{
    int all, count = 0;
    const ax_export_type* const* types = ax_export_types(&all);
    for (int k = 0; k < all && count < MOST_FORMATS; ++k)
        if (types[k]->write_sheet)
            formats[count++] = types[k];
    return count;
}

static void remove_folder(const char* folder)
{
    DIR* open = opendir(folder);
    for (struct dirent* e; open && (e = readdir(open));)
        unlinkat(dirfd(open), e->d_name, 0);
    closedir(open);
    rmdir(folder);
}

// Seconds of each stage, from the design to every format on the disk.
typedef struct times {
    double plan, clearance, write;
} times;

static times export_all(const ax_design* design, const ax_fabricate_options* options, ax_cut_plan* plan)
{
    const ax_export_type* formats[MOST_FORMATS];
    char folder[] = "/tmp/bench_fabricate_XXXXXX", names[MOST_FORMATS][64];
    const char* paths[MOST_FORMATS];
    int count = cut_formats(formats);
    stages at = {0};
    const ax_progress progress = {watch, &at};
    ax_error error;
    if (!mkdtemp(folder)) {
        perror(folder);
        exit(1);
    }
    for (int k = 0; k < count; ++k) {
        snprintf(names[k], sizeof names[k], "%s/dome%s", folder, formats[k]->ending);
        paths[k] = names[k];
    }
    const ax_export_options how = {.title = "dome", .fabricate = options, .progress = &progress, .plan = plan};
    double start = ax_seconds();
    require(ax_export_files(design, count, paths, &how, &error), &error);
    double end = ax_seconds();
    remove_folder(folder);
    return (times){at.proving - start, at.writing - at.proving, end - at.writing};
}

// "svg 1.23  dxf 2.34": seconds for all sheets and the overview in each format, one after the other.
static void time_formats(const ax_design* design, const ax_cut_plan* plan, char* words, size_t size)
{
    const ax_export_type* formats[MOST_FORMATS];
    int count = cut_formats(formats);
    *words = '\0';
    for (int k = 0; k < count; ++k) {
        char path[] = "/tmp/bench_fabricate_XXXXXX";
        int file = mkstemp(path), last = formats[k]->all_sheets || plan->sheet_count == 1 ? 0 : plan->sheet_count;
        ax_error error;
        double start = ax_seconds();
        for (int s = 0; s <= last; ++s)
            require(formats[k]->write_sheet(design, plan, s, path, &error), &error);
        size_t used = strlen(words);
        snprintf(words + used, size - used, "  %s %.2f", formats[k]->ending, ax_seconds() - start);
        close(file);
        unlink(path);
    }
}

int main(int argc, char** argv)
{
    const char* json = "/dev/null";
    if (argc > 2 && strcmp(argv[1], "--json") == 0)
        json = argv[2], argc -= 2, argv += 2;
    if (argc < 2) {
        fprintf(stderr, "usage: bench_fabricate [--json FILE] SURFACE [TRIANGLES ...]\n");
        return 2;
    }
    FILE* file = fopen(json, "w");
    if (!file) {
        perror(json);
        return 1;
    }
    int sizes[MOST_SIZES] = {2500, 5000, 10000, 20000}, count = 4, joints;
    for (int k = 2; k < argc && k - 2 < MOST_SIZES; ++k)
        sizes[k - 2] = atoi(argv[k]), count = k - 1;
    ax_mesh surface;
    ax_error error;
    require(ax_mesh_read(argv[1], NULL, &surface, NULL, &error), &error);
    const ax_joint_type* const* types = ax_joint_types(&joints);
    fprintf(file, "[");
    const char* separator = "";
    printf("joint           panels  sheets  labels beside/none   plan  clearance   write     all     MB  by format\n");
    for (int s = 0; s < count; ++s) {
        ax_design design = make_design(&surface, sizes[s]);
        for (int j = 0; j < joints; ++j) {
            ax_fabricate_options options = ax_fabricate_options_default();
            ax_cut_plan plan;
            options.joint = types[j];
            options.sheet[0] = 1220, options.sheet[1] = 2440, options.kerf = 0.2;
            times t = export_all(&design, &options, &plan);
            char words[256];
            double megabytes = peak_megabytes(), all = t.plan + t.clearance + t.write;
            time_formats(&design, &plan, words, sizeof words);
            printf("%-14s %7d %7d %12d/%-6d %7.3f %10.3f %7.3f %7.3f %6.0f %s\n", types[j]->name, plan.panel_count,
                   plan.sheet_count, plan.labels_outside, plan.labels_dropped, t.plan, t.clearance, t.write, all,
                   megabytes, words);
            fprintf(
                file,
                "%s\n  {\"joint\": \"%s\", \"panels\": %d, \"sheets\": %d, \"plan_s\": %.6g, \"clearance_s\": %.6g, "
                "\"write_s\": %.6g, \"peak_mb\": %.6g}",
                separator, types[j]->name, plan.panel_count, plan.sheet_count, t.plan, t.clearance, t.write, megabytes);
            separator = ",";
            fflush(stdout);
            ax_cut_plan_free(&plan);
        }
        ax_design_free(&design);
    }
    ax_mesh_free(&surface);
    fprintf(file, "\n]\n");
    if (fclose(file)) {
        perror(json);
        return 1;
    }
    return 0;
}
