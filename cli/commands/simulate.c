// auxshell simulate: deploys the flat state of a document again, under another load or other supports.
#include "options.h"
#include "output.h"
#include "progress.h"
#include "report.h"

#include "ax/document.h"
#include "ax/session.h"

#include <math.h>

typedef struct arguments {
    const char* document;
    ax_load_kind load; // AX_LOAD_NONE, 0: as in the document
    double density, pressure;
    const char* support;
} arguments;

static const char* const loads[] = {"gravity", "inflation"};

static const command_option options[] = {
    {.name = "P.auxshell",
     .text = "the document; its simulated state is replaced",
     .kind = OPTION_TEXT,
     .operand = true,
     .required = true,
     .offset = offsetof(arguments, document)},
    {.name = "--load",
     .text = "what deploys it",
     .kind = OPTION_CHOICE,
     .choices = loads,
     .choice_count = 2,
     .first = AX_LOAD_GRAVITY,
     .fallback = "that of the document",
     .offset = offsetof(arguments, load)},
    {.name = "--density",
     .value = "KG_M2",
     .text = "gravity: mass of the panels",
     .kind = OPTION_NUMBER,
     .hi = INFINITY,
     .open = true,
     .unit = "kg/m2",
     .fallback = "that of the document",
     .offset = offsetof(arguments, density)},
    {.name = "--pressure",
     .value = "PA",
     .text = "inflation: pressure",
     .kind = OPTION_NUMBER,
     .hi = INFINITY,
     .open = true,
     .unit = "Pa",
     .fallback = "that of the document",
     .offset = offsetof(arguments, pressure)},
    {.name = "--support",
     .value = "SELECTION",
     .text = "hinges held at their deployed places, in words as in recipes: rim, rim/3, rim:0..90, 0-12,40,77, "
             "rim:corner2, rim:near(2,0), box(-1,0,1,2), #arch and others",
     .kind = OPTION_TEXT,
     .fallback = "that of the document",
     .offset = offsetof(arguments, support)},
};

static ax_load chosen_load(const arguments* a, const ax_load* present)
{
    const ax_load usual = ax_design_options_default().load;
    ax_load load = *present;
    if (load.kind == AX_LOAD_NONE)
        load = usual;
    if (a->load)
        load.kind = a->load;
    if (a->density > 0)
        load.density = a->density;
    if (a->pressure > 0)
        load.pressure = a->pressure;
    return load;
}

static ax_status choose_supports(const char* words, ax_session* session, ax_design* design, ax_error* error)
{
    int *hinges, count;
    ax_error inner = {0};
    if (ax_select(ax_session_form(session), words, &hinges, &count, &inner) != AX_OK)
        return ax_fail(error, AX_USAGE, "--support: %s", inner.message);
    ax_design_set_supports(design, count, hinges);
    ax_free(hinges);
    return AX_OK;
}

// The design as the document has it, with the load and supports that were asked.
static ax_status prepare(const arguments* a, ax_session* session, ax_design* design, ax_load* load, ax_error* error)
{
    const ax_design* finished;
    const char* read_only = ax_session_read_only(session);
    ax_status status = output_check(a->document, NULL, error);
    if (status == AX_OK && read_only)
        status = ax_fail(error, AX_FAILED, "%s", read_only);
    if (status == AX_OK)
        status = ax_session_design(session, progress_reporter(), &finished, error);
    if (status == AX_OK && !finished)
        status = ax_fail(error, AX_BAD_INPUT, "%s is not finished. Finish it first: auxshell finish %s.", a->document,
                         a->document);
    if (status == AX_OK)
        status = ax_document_load(a->document, design, error);
    if (status != AX_OK)
        return status;
    *load = chosen_load(a, &design->load);
    if (a->density > 0 && load->kind != AX_LOAD_GRAVITY)
        return ax_fail(error, AX_USAGE, "--density belongs to --load gravity.");
    if (a->pressure > 0 && load->kind != AX_LOAD_INFLATION)
        return ax_fail(error, AX_USAGE, "--pressure belongs to --load inflation.");
    return a->support ? choose_supports(a->support, session, design, error) : AX_OK;
}

static ax_status run(const void* given, ax_error* error)
{
    const arguments* a = given;
    ax_session* session;
    ax_design design = {0};
    ax_load load;
    ax_status status = ax_session_open(a->document, true, "auxshell simulate", progress_reporter(), &session, error);
    if (status != AX_OK)
        return status;
    status = prepare(a, session, &design, &load, error);
    if (status == AX_OK)
        status = ax_design_simulate(&design, &load, progress_reporter(), error);
    progress_end();
    if (progress_cancelled())
        status = AX_CANCELLED;
    if (status == AX_OK)
        status = ax_session_put_design(session, &design, error);
    if (status == AX_OK) {
        char words[96];
        load_words(&design.load, words, sizeof words);
        printf("Deployed %d triangles by %s, %s: %.4f L rms, %.3f L at most from the design; %.2f s\n",
               design.linkage.triangle_count, words, ax_report_opening(&design.report),
               design.report.simulated_rms_over_L, design.report.simulated_max_over_L, design.report.seconds_deploy);
        report_print(&design, stdout);
    }
    ax_design_free(&design);
    ax_session_close(session);
    return status;
}

const command command_simulate = {
    .name = "simulate",
    .summary = "deploy the flat state of a document again, under another load or other supports",
    .text = "Simulates the deployment from the flat state to an exact rigid equilibrium. It reads the flat state, the "
            "places of the supports and the load, nothing else of the deployed state. If no exact state is reached, "
            "the document stays as it was.",
    .options = options,
    .option_count = sizeof options / sizeof *options,
    .size = sizeof(arguments),
    .run = run,
};
