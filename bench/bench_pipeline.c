// The main job by stages and sizes: a target surface to a linkage deployed by inflation and by gravity.
//
//   bench_pipeline [--json FILE] SURFACE [TRIANGLES ...]        default 600 2500 10000
//
// Seconds by stage, medians of three, and the growth exponent between neighbouring sizes.
#include "ax/design.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { REPEATS = 3, MOST_SIZES = 16 };

static int ascending(const void* a, const void* b)
{
    double x = *(const double*)a, y = *(const double*)b;
    return (x > y) - (x < y);
}

static double median(double* seconds)
{
    qsort(seconds, REPEATS, sizeof *seconds, ascending);
    return seconds[REPEATS / 2];
}

int main(int argc, char** argv)
{
    const char* json = "/dev/null";
    if (argc > 2 && strcmp(argv[1], "--json") == 0)
        json = argv[2], argc -= 2, argv += 2;
    if (argc < 2) {
        fprintf(stderr, "usage: bench_pipeline [--json FILE] SURFACE [TRIANGLES ...]\n");
        return 2;
    }
    FILE* file = fopen(json, "w");
    if (!file) {
        perror(json);
        return 1;
    }
    fprintf(file, "[");
    const char* separator = "";
    int sizes[MOST_SIZES] = {600, 2500, 10000}, count = 3;
    for (int k = 2; k < argc && k - 2 < MOST_SIZES; ++k)
        sizes[k - 2] = atoi(argv[k]), count = k - 1;
    ax_mesh target;
    ax_error error;
    ax_status status = ax_mesh_read(argv[1], NULL, &target, NULL, &error);
    if (status != AX_OK) {
        fprintf(stderr, "%s\n", error.message);
        return (int)status;
    }
    printf("load       triangles   flatten     joint    deploy     total  steps joint/projective/newton  exponent\n");
    for (int kind = AX_LOAD_INFLATION; kind >= AX_LOAD_GRAVITY; --kind) {
        double before = 0;
        int smaller = 0;
        for (int s = 0; s < count; ++s) {
            ax_design_options options = ax_design_options_default();
            options.triangles = sizes[s];
            options.project = true;
            options.load.kind = (ax_load_kind)kind;
            double flatten[REPEATS], joint[REPEATS], deploy[REPEATS], total[REPEATS];
            ax_report report = {0};
            int triangles = 0;
            for (int r = 0; r < REPEATS; ++r) {
                ax_design design;
                status = ax_design_from_target(&target, &options, NULL, &design, &error);
                if (status != AX_OK) {
                    fprintf(stderr, "%d triangles: %s\n", sizes[s], error.message);
                    return (int)status;
                }
                report = design.report;
                triangles = design.linkage.triangle_count;
                flatten[r] = report.seconds_flatten, joint[r] = report.seconds_joint;
                deploy[r] = report.seconds_deploy, total[r] = report.seconds_total;
                ax_design_free(&design);
            }
            double now = median(total);
            printf("%-9s %10d %9.3f %9.3f %9.3f %9.3f  %d/%d/%d", ax_load_kind_name((ax_load_kind)kind), triangles,
                   median(flatten), median(joint), median(deploy), now, report.joint_steps, report.projective_steps,
                   report.newton_steps);
            fprintf(file,
                    "%s\n  {\"load\": \"%s\", \"triangles\": %d, \"flatten_s\": %.6g, \"joint_s\": %.6g, "
                    "\"deploy_s\": %.6g, \"total_s\": %.6g",
                    separator, ax_load_kind_name((ax_load_kind)kind), triangles, median(flatten), median(joint),
                    median(deploy), now);
            separator = ",";
            if (s) {
                double exponent = log(now / before) / log((double)triangles / smaller);
                printf("  %.2f", exponent);
                fprintf(file, ", \"exponent\": %.3f", exponent);
            }
            fprintf(file, "}");
            printf("\n");
            fflush(stdout);
            before = now, smaller = triangles;
        }
    }
    ax_mesh_free(&target);
    fprintf(file, "\n]\n");
    if (fclose(file)) {
        perror(json);
        return 1;
    }
    return 0;
}
