// auxshell finish: takes a design to exact states.
#include "options.h"
#include "progress.h"
#include "report.h"

#include "ax/session.h"

typedef struct arguments {
    const char* document;
} arguments;

static const command_option options[] = {
    {.name = "P.auxshell",
     .text = "the document; finishing is one more step of its recipe",
     .kind = OPTION_TEXT,
     .operand = true,
     .required = true,
     .offset = offsetof(arguments, document)},
};

static void print_finish(const ax_finish* f, const ax_design* design)
{
    printf(
        "Finished    %d triangles. The flat state moved by %.4f L rms, %.4f L at most; the deployed one by %.4f L rms, "
        "%.4f L at most\n",
        design->linkage.triangle_count, f->flat_moved_rms, f->flat_moved_max, f->deployed_moved_rms,
        f->deployed_moved_max);
    report_print(design, stdout);
}

static ax_status run(const void* given, ax_error* error)
{
    const arguments* a = given;
    ax_session* session;
    ax_status status = ax_session_open(a->document, true, "auxshell finish", progress_reporter(), &session, error);
    if (status != AX_OK)
        return status;
    const ax_design* design = NULL;
    ax_finish finish;
    status = ax_session_design(session, progress_reporter(), &design, error);
    bool already = design != NULL;
    if (status == AX_OK && !already)
        status = ax_session_finish(session, progress_reporter(), &finish, error);
    if (status == AX_OK && !already)
        status = ax_session_design(session, progress_reporter(), &design, error);
    progress_end();
    if (status == AX_OK && already) {
        printf("It is finished already.\n");
        report_print(design, stdout);
    } else if (status == AX_OK)
        print_finish(&finish, design);
    ax_session_close(session);
    return status;
}

const command command_finish = {
    .name = "finish",
    .summary = "take a design to its exact states",
    .text = "Solves the flat and deployed states exactly and, if the design has a load, deploys it to an exact "
            "equilibrium, as for a target surface; says by how much the states moved. It can be undone.",
    .options = options,
    .option_count = sizeof options / sizeof *options,
    .size = sizeof(arguments),
    .run = run,
};
