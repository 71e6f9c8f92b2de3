// auxshell clusters: what it costs to cut panels in fewer sizes.
#include "options.h"

#include "ax/cluster.h"
#include "ax/document.h"

typedef struct arguments {
    const char* document;
    double within;
} arguments;

static void defaults(void* given)
{
    ((arguments*)given)->within = AX_CLUSTER_TOLERANCE;
}

static const command_option options[] = {
    OPTION_DOCUMENT(arguments),
    {.name = "--within",
     .value = "MM",
     .text = "the error of an edge down to which the table goes",
     .kind = OPTION_NUMBER,
     .lo = 0,
     .hi = 1000,
     .open = true,
     .unit = "mm",
     .offset = offsetof(arguments, within)},
};

static void print_row(const ax_clusters* c)
{
    printf("%7d %12.3f %12.3f %12.3f %12.3f %12.3f\n", c->size_count, c->edge_max, c->edge_rms, c->gap_max, c->gap_rms,
           c->line_max);
}

static ax_status run(const void* given, ax_error* error)
{
    const arguments* a = given;
    ax_design design = {0};
    ax_status status = ax_document_load(a->document, &design, error);
    if (status == AX_OK) {
        static const int steps[] = {1, 2, 3, 5, 7};
        ax_clusters last = ax_cluster_within(&design, a->within);
        printf("%s: %d panels, all lengths in mm\n\n", a->document, last.panel_count);
        printf("%7s %12s %12s %12s %12s %12s\n", "sizes", "edge, max", "edge, rms", "gap, max", "gap, rms",
               "line, max");
        for (int decade = 1, count = 0; count < last.size_count; decade *= 10)
            for (int k = 0; k < 5; ++k) {
                count = decade * steps[k];
                if (count >= last.size_count)
                    break;
                ax_clusters c = ax_cluster_panels(&design, count);
                print_row(&c);
                ax_clusters_free(&c);
            }
        print_row(&last);
        ax_clusters_free(&last);
        puts("\nGap: what joints take up, by their play or by bending. Line: what the frame takes up where a line of "
             "panels ends.");
    }
    ax_design_free(&design);
    return status;
}

const command command_clusters = {
    .name = "clusters",
    .summary = "what it costs to cut panels in fewer sizes",
    .text = "Nearly equal panels can be cut alike: in a table, by the number of sizes, the error of edges, the gaps "
            "that open at hinges if every panel stays where it is, and by how much a line of panels from rim to rim "
            "grows or shrinks. A gap must not be more than the joint's play. export --clusters writes the sizes and "
            "which panel has which to the schedule.",
    .options = options,
    .option_count = sizeof options / sizeof *options,
    .size = sizeof(arguments),
    .defaults = defaults,
    .run = run,
};
