// auxshell design: from a target surface to a linkage that is proven to deploy.
#include "options.h"
#include "output.h"
#include "progress.h"
#include "report.h"

#include "ax/document.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { MOST_CORNERS = 64 };

typedef struct flatten_choice {
    ax_flatten_boundary boundary;
    int corner_count;
    double corner_angles[MOST_CORNERS];
} flatten_choice;

typedef struct angle_choice {
    bool given, edge;
    double degrees;
} angle_choice;

typedef struct arguments {
    const char *target, *out;
    int up;
    bool refine;
    double size;
    ax_design_options design;
    flatten_choice flatten; // go into `design` when it runs
    angle_choice angle;
} arguments;

static void defaults(void* given)
{
    arguments* a = given;
    a->design = ax_design_options_default();
}

static const char* parse_flatten(const char* text, void* value)
{
    static const char expected[] =
        "free, disk or polygon:ANGLES, the corner angles in degrees separated by commas (polygon:90,90,90,90)";
    static const char polygon[] = "polygon:";
    flatten_choice* choice = value;
    *choice = (flatten_choice){.boundary = AX_FLATTEN_FREE};
    if (strcmp(text, "free") == 0)
        return NULL;
    choice->boundary = AX_FLATTEN_DISK;
    if (strcmp(text, "disk") == 0)
        return NULL;
    choice->boundary = AX_FLATTEN_POLYGON;
    if (strncmp(text, polygon, sizeof polygon - 1) != 0)
        return expected;
    double sum = 0;
    for (const char* at = text + sizeof polygon - 1;; ++at) {
        char* end;
        double angle = strtod(at, &end);
        if (end == at || !(angle > 0 && angle < 360) || choice->corner_count == MOST_CORNERS)
            return expected;
        choice->corner_angles[choice->corner_count++] = angle;
        sum += angle;
        at = end;
        if (!*at)
            break;
        if (*at != ',')
            return expected;
    }
    if (choice->corner_count < 3 || fabs(sum - 180 * (choice->corner_count - 2)) > 1e-6)
        return "corner angles of a polygon, three or more that sum to 180 degrees times their number less two";
    return NULL;
}

static const char* parse_angle(const char* text, void* value)
{
    angle_choice* choice = value;
    *choice = (angle_choice){.given = true};
    if (strcmp(text, "edge") == 0) {
        choice->edge = true;
        return NULL;
    }
    char* end;
    choice->degrees = strtod(text, &end);
    bool number = end != text && !*end && fabs(choice->degrees) <= 360;
    return number ? NULL : "an angle of -360 to 360 degrees, or edge";
}

static const char* const loads[] = {"gravity", "inflation"};
static const char* const borders[] = {"equilateral", "released", "inside"};

static const command_option options[] = {
    {.name = "TARGET",
     .text = "the surface: OBJ, STL, PLY, OFF or another mesh format",
     .kind = OPTION_TEXT,
     .operand = true,
     .required = true,
     .offset = offsetof(arguments, target)},
    OPTION_OUT(arguments),
    {.name = "--triangles",
     .value = "N",
     .text = "wanted number of triangles",
     .kind = OPTION_INTEGER,
     .lo = 24,
     .hi = 2000000,
     .offset = offsetof(arguments, design.triangles),
     .excludes = "--edge"},
    {.name = "--edge",
     .value = "LEN",
     .text = "wanted mean edge of the triangles instead, in the target's unit",
     .kind = OPTION_NUMBER,
     .hi = INFINITY,
     .open = true,
     .fallback = "",
     .offset = offsetof(arguments, design.edge)},
    {.name = "--load",
     .text = "what deploys it; its simulation from the flat sheet is the proof",
     .kind = OPTION_CHOICE,
     .choices = loads,
     .choice_count = 2,
     .first = AX_LOAD_GRAVITY,
     .offset = offsetof(arguments, design.load.kind)},
    OPTION_UNITS(arguments, design.unit, .first = AX_MILLIMETRE),
    OPTION_UP(arguments, up),
    {.name = "--size",
     .value = "LEN",
     .text = "scale the target until the longest of its extents in x, y and z is this, in --units",
     .kind = OPTION_NUMBER,
     .hi = INFINITY,
     .open = true,
     .fallback = "as in the file",
     .offset = offsetof(arguments, size)},
    OPTION_SCALE(arguments, design.target.scale_lo),
    {.name = "--mouth-min",
     .value = "DEG",
     .text = "smallest mouth angle allowed at a flat hinge: room for joints and the saw",
     .kind = OPTION_NUMBER,
     .lo = 0,
     .hi = 59,
     .unit = "degrees",
     .offset = offsetof(arguments, design.mouth_min)},
    {.name = "--refine",
     .text = "divide and round the target until its facets are half as wide as the panels (Loop's subdivision): wide "
             "flat facets carry no load",
     .kind = OPTION_FLAG,
     .offset = offsetof(arguments, refine)},
    {.name = "--project",
     .text = "if the surface is not dome-like everywhere, design for the nearest one that is",
     .kind = OPTION_FLAG,
     .offset = offsetof(arguments, design.project)},
    {.name = "--flatten",
     .value = "free|disk|polygon:ANGLES",
     .text = "outline of the flat sheet: as it comes out with least distortion, a disk, or a polygon with these corner "
             "angles in degrees",
     .kind = OPTION_OTHER,
     .parse = parse_flatten,
     .fallback = "free",
     .offset = offsetof(arguments, flatten)},
    {.name = "--border",
     .text = "triangles at the rim: equilateral with hinges on the boundary curve, released from being equilateral, or "
             "whole triangles inside the boundary",
     .kind = OPTION_CHOICE,
     .choices = borders,
     .choice_count = 3,
     .first = AX_BORDER_EQUILATERAL,
     .offset = offsetof(arguments, design.border)},
    {.name = "--angle",
     .value = "DEG|edge",
     .text =
         "direction of the lattice rows against the x axis of the flat sheet, or along the longest straight part of "
         "the rim",
     .kind = OPTION_OTHER,
     .parse = parse_angle,
     .fallback = "searched for the best rim",
     .offset = offsetof(arguments, angle)},
};

// The commonest mistake: a file drawn in another unit.
static void doubt_unit(const ax_design* d)
{
    const double* size = d->report.deployed_bounds;
    double length = fmax(fmax(size[0], size[1]), size[2]);
    ax_unit likely = ax_unit_likely(length, d->unit);
    if (likely != d->unit)
        printf("            %.5g %s long: if the file is in %s, give --units %s\n", length, ax_unit_name(d->unit),
               ax_unit_name(likely), ax_unit_name(likely));
}

// `read` has the vertices and faces of the target as it was read.
static void print_steps(const arguments* a, const int read[2], double factor, const ax_refinement* refinement,
                        const ax_design* d)
{
    const ax_report* r = &d->report;
    const char* unit = ax_unit_name(d->unit);
    char load[96];
    printf("Read        %s: %d vertices, %d faces; mended: ", a->target, read[0], read[1]);
    repairs_print(&d->repairs, stdout);
    if (a->size > 0)
        printf("Scaled      by %.6g: %.5g %s long\n", factor, a->size, unit);
    doubt_unit(d);
    if (refinement->rounds)
        printf("Refined     %d times: %d faces; %.4g %s off its vertices at most\n", refinement->rounds,
               d->target.face_count, refinement->largest_move, unit);
    if (d->projected)
        printf("Projected   %.1f %% of the area moved, by %.4g %s at most; H is now %.4g or more, <= 0 on %.2g %%\n",
               100 * d->projection.moved_area_share, d->projection.largest_move, unit, d->projection.curvature_min,
               100 * d->projection.nonpositive_share);
    printf("Flattened   a scale range of %.4f is needed; %.2f s\n", d->scale_ratio, r->seconds_flatten);
    printf("Laid        %d triangles of mean edge %.4g %s, scale factors %.3f to %.3f\n", d->linkage.triangle_count,
           r->edge_mean, unit, r->scale_min, r->scale_max);
    printf("Solved      flat and deployed congruent to %.1e; %.2f s\n", r->congruence_max, r->seconds_joint);
    load_words(&d->load, load, sizeof load);
    if (d->simulated)
        printf("Deployed    by %s, %s: %.4f L rms, %.3f L at most from the design; %.2f s\n", load,
               ax_report_opening(r), r->simulated_rms_over_L, r->simulated_max_over_L, r->seconds_deploy);
    else
        printf("Deployed    not: %s did not lead to an exact state; %.2f s\n", load, r->seconds_deploy);
}

// A design whose deployment failed is kept: its geometry is sound, and another load or count may deploy it.
static bool is_design(ax_status status, const ax_design* design)
{
    return status == AX_OK || design->linkage.triangle_count > 0;
}

static ax_status run(const void* given, ax_error* error)
{
    const arguments* a = given;
    ax_design_options wanted = a->design;
    wanted.target.flatten = (ax_flatten_options){.boundary = a->flatten.boundary,
                                                 .corner_count = a->flatten.corner_count,
                                                 .corner_angles = a->flatten.corner_angles};
    wanted.angle_given = a->angle.given && !a->angle.edge;
    wanted.align_to_edge = a->angle.edge;
    wanted.angle = a->angle.degrees;

    ax_read_options read = ax_read_options_default();
    read.up = (ax_up)a->up;
    ax_mesh mesh = {0};
    ax_mesh_repairs repairs;
    ax_refinement refinement = {0};
    ax_design design = {0};
    ax_status status = output_check(a->out, ".auxshell", error);
    if (status == AX_OK)
        status = ax_mesh_read(a->target, &read, &mesh, &repairs, error);
    const int counts[2] = {mesh.vertex_count, mesh.face_count};
    const double factor = status == AX_OK && a->size > 0 ? ax_mesh_resize(&mesh, a->size) : 1;
    if (status == AX_OK && a->refine)
        refinement = ax_design_refine_target(&mesh, &wanted);
    if (status == AX_OK)
        status = ax_design_from_target(&mesh, &wanted, progress_reporter(), &design, error);
    progress_end();
    if (progress_cancelled())
        status = AX_CANCELLED;
    else if (is_design(status, &design)) {
        design.repairs = repairs;
        ax_error unsaved;
        ax_status saved = ax_document_save(a->out, &design, &unsaved);
        if (saved == AX_OK) {
            print_steps(a, counts, factor, &refinement, &design);
            report_print(&design, stdout);
            printf("\nWrote %s: %d triangles, %.2f s in all.\n", a->out, design.linkage.triangle_count,
                   design.report.seconds_total);
        } else {
            status = saved;
            *error = unsaved;
        }
    }
    ax_design_free(&design);
    ax_mesh_free(&mesh);
    return status;
}

const command command_design = {
    .name = "design",
    .summary = "turn a target surface into a linkage and prove that it deploys",
    .text = "Lays a linkage of rigid triangles over a target surface, solves its flat and deployed states so that they "
            "are congruent, and deploys the flat state by simulation. Where the deployment does not reach an exact "
            "state, the document is written without one and the exit code is 1.",
    .options = options,
    .option_count = sizeof options / sizeof *options,
    .size = sizeof(arguments),
    .defaults = defaults,
    .run = run,
};
