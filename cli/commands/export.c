// auxshell export: writes a document's states to files of other programs.
#include "fabricate.h"
#include "output.h"
#include "progress.h"

#include "ax/document.h"
#include "ax/export.h"

#include <string.h>

typedef struct arguments {
    const char *document, *out;
    ax_state state;
    fabricate_arguments fabricate;
} arguments;

static void defaults(void* given)
{
    fabricate_defaults(&((arguments*)given)->fabricate);
}

static const char* const states[] = {"flat", "deployed", "simulated"};

static const command_option options[] = {
    {.name = "P.auxshell",
     .text = "the document",
     .kind = OPTION_TEXT,
     .operand = true,
     .required = true,
     .offset = offsetof(arguments, document)},
    {.name = "-o",
     .value = "FILE",
     .text = "the file to write; its ending chooses the format",
     .kind = OPTION_TEXT,
     .required = true,
     .offset = offsetof(arguments, out)},
    {.name = "--state",
     .text = "which state to write",
     .kind = OPTION_CHOICE,
     .choices = states,
     .choice_count = 3,
     .first = AX_STATE_FLAT,
     .fallback = "flat for cut files, deployed otherwise",
     .offset = offsetof(arguments, state)},
    FABRICATE_OPTIONS(arguments, fabricate),
};

// The file's name without folder and ending.
static void title_of(const char* path, char* title, size_t size)
{
    const char* slash = strrchr(path, '/');
    snprintf(title, size, "%s", slash ? slash + 1 : path);
    char* dot = strrchr(title, '.');
    if (dot && dot != title)
        *dot = 0;
}

static ax_status run(const void* given, ax_error* error)
{
    const arguments* a = given;
    ax_design design = {0};
    ax_cut_plan plan = {0};
    ax_fabricate_options chosen;
    ax_profile profile;
    ax_status status = output_check(a->out, NULL, error);
    if (status == AX_OK)
        status = fabricate_choose(&a->fabricate, &chosen, &profile, error);
    if (status == AX_OK)
        status = ax_document_load(a->document, &design, error);
    if (status == AX_OK) {
        char title[256];
        title_of(a->document, title, sizeof title);
        const ax_export_options how = {
            .state = a->state, .title = title, .fabricate = &chosen, .progress = progress_reporter(), .plan = &plan};
        status = ax_export(&design, a->out, &how, error);
        progress_end();
    }
    if (status == AX_OK)
        printf("Wrote %s\n", a->out);
    if (status == AX_OK && plan.sheet_count)
        fabricate_print(&plan, stdout);
    ax_cut_plan_free(&plan);
    ax_design_free(&design);
    return status;
}

static void list_formats(list_row row, FILE* out)
{
    int count;
    const ax_export_type* const* types = ax_export_types(&count);
    for (int k = 0; k < count; ++k) {
        char words[512];
        snprintf(words, sizeof words, "%s: %s", types[k]->name, types[k]->doc);
        row(types[k]->ending, words, out);
    }
}

const command command_export = {
    .name = "export",
    .summary = "write a state to a cut file, a 3D model, a picture or JSON",
    .text =
        "Writes a state of a document to a file, in the format that the file's ending names. Coordinates are those of "
        "the target, in the document's unit; cut files are drawn at true size in millimetres. What fits one sheet gets "
        "the name given; several sheets become NAME-1, NAME-2 and so on beside an overview of that name.",
    .options = options,
    .option_count = sizeof options / sizeof *options,
    .size = sizeof(arguments),
    .defaults = defaults,
    .run = run,
    .list_title = "Formats",
    .list = list_formats,
};
