// auxshell info: every figure of a document.
#include "options.h"
#include "output.h"
#include "report.h"

#include "ax/document.h"
#include "ax/picture.h"

#include <limits.h>

typedef struct arguments {
    const char* document;
    bool json;
    const char* png;
} arguments;

static const command_option options[] = {
    {.name = "P.auxshell",
     .text = "the document",
     .kind = OPTION_TEXT,
     .operand = true,
     .required = true,
     .offset = offsetof(arguments, document)},
    {.name = "--json", .text = "print every figure as JSON", .kind = OPTION_FLAG, .offset = offsetof(arguments, json)},
    {.name = "--png",
     .value = "DIR",
     .text = "write pictures of the states: DIR/flat.png, DIR/deployed.png and, if there is one, DIR/simulated.png",
     .kind = OPTION_TEXT,
     .offset = offsetof(arguments, png)},
};

static const char* const border_names[] = {
    [AX_BORDER_EQUILATERAL] = "equilateral", [AX_BORDER_RELEASED] = "released", [AX_BORDER_INSIDE] = "inside"};
static const char* const load_names[] = {
    [AX_LOAD_NONE] = "none", [AX_LOAD_GRAVITY] = "gravity", [AX_LOAD_INFLATION] = "inflation"};

static int count_supports(const ax_design* d)
{
    int count = 0;
    for (int h = 0; h < d->linkage.hinge_count; ++h)
        count += d->supports[h];
    return count;
}

static void print_design(const char* path, const ax_design* d)
{
    char load[96];
    load_words(&d->load, load, sizeof load);
    printf("%s\n", path);
    printf("  Linkage         %d triangles, %d hinges, %d holes, border %s; lengths in %s\n", d->linkage.triangle_count,
           d->linkage.hinge_count, d->linkage.hole_count, border_names[d->border], ax_unit_name(d->unit));
    printf("  Target          %d vertices, %d faces; mended: ", d->target.vertex_count, d->target.face_count);
    repairs_print(&d->repairs, stdout);
    if (d->projected)
        printf("  Projected       %.1f %% of the area moved, by %.4g %s at most; H is now %.4g or more\n",
               100 * d->projection.moved_area_share, d->projection.largest_move, ax_unit_name(d->unit),
               d->projection.curvature_min);
    printf("  Deployed by     %s, held at %d hinges\n", load, count_supports(d));
    report_print(d, stdout);
}

static json_t* design_json(const ax_design* d)
{
    json_t* load =
        json_pack("{s:s, s:o, s:o, s:o}", "kind", load_names[d->load.kind], "direction",
                  d->load.kind == AX_LOAD_GRAVITY ? json_numbers(d->load.direction, 3) : json_null(), "pressure",
                  d->load.kind == AX_LOAD_INFLATION ? json_number(d->load.pressure) : json_null(), "density",
                  d->load.kind == AX_LOAD_GRAVITY ? json_number(d->load.density) : json_null());
    const ax_projection* p = &d->projection;
    json_t* projection =
        d->projected
            ? json_pack("{s:o, s:o, s:o, s:o, s:i}", "moved_area_share", json_number(p->moved_area_share),
                        "largest_move", json_number(p->largest_move), "curvature_min", json_number(p->curvature_min),
                        "nonpositive_share", json_number(p->nonpositive_share), "steps", p->steps)
            : json_null();
    return json_pack("{s:s, s:i, s:i, s:i, s:i, s:i, s:s, s:o, s:o, s:o, s:o, s:o, s:o}", "units",
                     ax_unit_name(d->unit), "triangles", d->linkage.triangle_count, "hinges", d->linkage.hinge_count,
                     "holes", d->linkage.hole_count, "openings", d->linkage.opening_count, "supports",
                     count_supports(d), "border", border_names[d->border], "mouth_min", json_number(d->mouth_min),
                     "scale_ratio", json_number(d->scale_ratio), "load", load, "projection", projection, "repairs",
                     repairs_json(&d->repairs), "report", report_json(d));
}

static ax_status draw(const char* folder, const ax_design* design, ax_error* error)
{
    static const struct {
        ax_state state;
        const char* name;
    } pictures[] = {
        {AX_STATE_FLAT, "flat.png"}, {AX_STATE_DEPLOYED, "deployed.png"}, {AX_STATE_SIMULATED, "simulated.png"}};
    ax_status status = output_make_folder(folder, error);
    for (size_t k = 0; k < sizeof pictures / sizeof *pictures && status == AX_OK; ++k) {
        char path[PATH_MAX];
        status = output_join(folder, pictures[k].name, path, sizeof path, error);
        if (status == AX_OK && (pictures[k].state != AX_STATE_SIMULATED || design->simulated))
            status = ax_picture_design(design, pictures[k].state, 1600, 1200, path, error);
    }
    return status;
}

static ax_status run(const void* given, ax_error* error)
{
    const arguments* a = given;
    ax_design design = {0};
    ax_status status = a->png ? output_check_folder(a->png, error) : AX_OK;
    if (status == AX_OK)
        status = ax_document_load(a->document, &design, error);
    if (status == AX_OK && a->png)
        status = draw(a->png, &design, error);
    if (status == AX_OK) {
        if (a->json)
            json_print(design_json(&design), stdout);
        else
            print_design(a->document, &design);
    }
    ax_design_free(&design);
    return status;
}

const command command_info = {
    .name = "info",
    .summary = "print every figure of a document, or draw its states",
    .text = "Prints what a document holds: geometry, fit to the target, flat state, deployment and effort, each figure "
            "with its limit and whether it holds. L is the mean edge of the triangles.",
    .options = options,
    .option_count = sizeof options / sizeof *options,
    .size = sizeof(arguments),
    .run = run,
};
