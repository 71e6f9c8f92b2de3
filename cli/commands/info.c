// auxshell info: every figure of a document.
#include "options.h"
#include "output.h"
#include "progress.h"
#include "report.h"

#include "ax/document.h"
#include "ax/picture.h"
#include "ax/session.h"

#include <limits.h>

typedef struct arguments {
    const char* document;
    bool json;
    const char* png;
} arguments;

static const command_option options[] = {
    OPTION_DOCUMENT(arguments),
    {.name = "--json", .text = "print every figure as JSON", .kind = OPTION_FLAG, .offset = offsetof(arguments, json)},
    {.name = "--png",
     .value = "DIR",
     .text = "write pictures of the states: DIR/flat.png, DIR/deployed.png and, if there is one, DIR/simulated.png",
     .kind = OPTION_TEXT,
     .offset = offsetof(arguments, png)},
};

static int count_supports(const ax_design* d)
{
    int count = 0;
    for (int h = 0; h < d->linkage.hinge_count; ++h)
        count += d->supports[h];
    return count;
}

static void print_design(const char* path, const ax_design* d, const ax_form_report* form)
{
    char load[96];
    load_words(&d->load, load, sizeof load);
    printf("%s\n", path);
    printf("  Linkage         %d triangles, %d hinges, %d holes, border %s; lengths in %s\n", d->linkage.triangle_count,
           d->linkage.hinge_count, d->linkage.hole_count, ax_border_name(d->border), ax_unit_name(d->unit));
    if (d->target.vertex_count) {
        printf("  Target          %d vertices, %d faces; mended: ", d->target.vertex_count, d->target.face_count);
        repairs_print(&d->repairs, stdout);
    } else
        printf("  Target          none: the form was found\n");
    if (d->projected)
        printf("  Projected       %.1f %% of the area moved, by %.4g %s at most; H is now %.4g or more\n",
               100 * d->projection.moved_area_share, d->projection.largest_move, ax_unit_name(d->unit),
               d->projection.curvature_min);
    const char* how = ax_report_opening(&d->report);
    printf("  Deployed by     %s, held at %d hinges%s%s\n", load, count_supports(d), *how ? "; " : "", how);
    report_print(d, stdout);
    if (form->held_count + form->finding_count > 0)
        printf("\nOf the form that was asked for:\n");
    form_print(form, d->unit, stdout);
}

static json_t* design_json(const ax_design* d, const ax_form_report* form)
{
    json_t* load =
        json_pack("{s:s, s:o, s:o, s:o}", "kind", ax_load_kind_name(d->load.kind), "direction",
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
    json_t* found = form_json(form);
    json_t* whole = json_pack(
        "{s:s, s:i, s:i, s:i, s:i, s:i, s:s, s:o, s:o, s:o, s:o, s:o, s:o}", "units", ax_unit_name(d->unit),
        "triangles", d->linkage.triangle_count, "hinges", d->linkage.hinge_count, "holes", d->linkage.hole_count,
        "openings", d->linkage.opening_count, "supports", count_supports(d), "border", ax_border_name(d->border),
        "mouth_min", json_number(d->mouth_min), "scale_ratio", json_number(d->scale_ratio), "load", load, "projection",
        projection, "repairs", repairs_json(&d->repairs), "report", report_json(d));
    json_object_update(whole, found);
    json_decref(found);
    return whole;
}

// What the form that the document holds was asked, and what came of it; none if it began with a finished design. The report borrows names
// from the session.
static ax_status measure_form(const char* path, ax_session** session, ax_form_report* form, ax_error* error)
{
    ax_status status = ax_session_open(path, false, NULL, progress_reporter(), session, error);
    progress_end();
    if (status == AX_OK && !ax_session_from_design(*session) && ax_session_form(*session))
        ax_form_measure(ax_session_form(*session), form);
    return status;
}

static ax_status draw(const char* folder, const ax_design* design, ax_error* error)
{
    ax_status status = output_make_folder(folder, error);
    ax_state last = design->simulated ? AX_STATE_SIMULATED : AX_STATE_DEPLOYED;
    for (ax_state state = AX_STATE_FLAT; state <= last && status == AX_OK; ++state) {
        char name[32], path[PATH_MAX];
        snprintf(name, sizeof name, "%s.png", ax_state_name(state));
        status = output_join(folder, name, path, sizeof path, error);
        if (status == AX_OK)
            status = ax_picture_design(design, state, 1600, 1200, path, error);
    }
    return status;
}

static ax_status run(const void* given, ax_error* error)
{
    const arguments* a = given;
    ax_design design = {0};
    ax_form_report form = {0};
    ax_session* session = NULL;
    ax_status status = a->png ? output_check_folder(a->png, error) : AX_OK;
    if (status == AX_OK)
        status = ax_document_load(a->document, &design, error);
    if (status == AX_OK)
        status = measure_form(a->document, &session, &form, error);
    if (status == AX_OK && a->png)
        status = draw(a->png, &design, error);
    if (status == AX_OK) {
        if (a->json)
            json_print(design_json(&design, &form), stdout);
        else
            print_design(a->document, &design, &form);
    }
    ax_form_report_free(&form);
    ax_session_close(session);
    ax_design_free(&design);
    return status;
}

const command command_info = {
    .name = "info",
    .summary = "print every figure of a document, or draw its states",
    .text = "Prints what a document holds: geometry, fit to the target, flat state, deployment and effort, each figure "
            "with its limit and whether it holds; of a form that was found also what holds it, by how much that is "
            "missed, and every finding. L is the mean edge of the triangles.",
    .options = options,
    .option_count = sizeof options / sizeof *options,
    .size = sizeof(arguments),
    .run = run,
};
