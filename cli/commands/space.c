// auxshell space: the room under a shell.
#include "options.h"
#include "report.h"

#include "ax/document.h"
#include "ax/space.h"

#include <math.h>

typedef struct arguments {
    const char* document;
    double headroom, ground;
    bool json;
} arguments;

static void defaults(void* given)
{
    arguments* a = given;
    a->headroom = 2.1;
    a->ground = NAN;
}

static const command_option options[] = {
    OPTION_DOCUMENT(arguments),
    {.name = "--headroom",
     .value = "M",
     .text = "clear height that people need, in metres whatever the document's unit",
     .kind = OPTION_NUMBER,
     .hi = 1000,
     .unit = "m",
     .offset = offsetof(arguments, headroom)},
    {.name = "--ground",
     .value = "Z",
     .text = "height of the ground, in the document's unit",
     .kind = OPTION_NUMBER,
     .lo = -1e9,
     .hi = 1e9,
     .fallback = "the lowest support",
     .offset = offsetof(arguments, ground)},
    {.name = "--json", .text = "print it as JSON", .kind = OPTION_FLAG, .offset = offsetof(arguments, json)},
};

static void print(const ax_space* s, const char* unit, FILE* out)
{
    fprintf(out, "  Ground          %.4g %s\n", s->ground, unit);
    fprintf(out, "  Floor           %.4g %s2\n", s->floor, unit);
    fprintf(out, "  Headroom        %.4g %s or more over %.4g %s2, %.1f %% of the floor; %.4g %s at most\n",
            s->headroom, unit, s->headroom_area, unit, 100 * s->headroom_area / s->floor, s->height, unit);
    fprintf(out, "  Volume          %.4g %s3\n", s->volume, unit);
    fprintf(out, "  Surface         %.4g %s2, holes included\n", s->surface, unit);
}

static ax_status run(const void* given, ax_error* error)
{
    const arguments* a = given;
    ax_design design = {0};
    ax_space s;
    ax_status status = ax_document_load(a->document, &design, error);
    if (status == AX_OK)
        status = ax_space_measure(&design, design.simulated ? AX_STATE_SIMULATED : AX_STATE_DEPLOYED, a->ground,
                                  a->headroom / ax_unit_in_metres(design.unit), &s, error);
    if (status == AX_OK && a->json)
        json_print(json_pack("{s:s, s:f, s:f, s:f, s:f, s:f, s:f, s:f}", "units", ax_unit_name(design.unit), "ground",
                             s.ground, "floor", s.floor, "volume", s.volume, "height", s.height, "headroom", s.headroom,
                             "headroom_area", s.headroom_area, "surface", s.surface),
                   stdout);
    else if (status == AX_OK)
        print(&s, ax_unit_name(design.unit), stdout);
    ax_design_free(&design);
    return status;
}

const command command_space = {
    .name = "space",
    .summary = "measure the room under a shell: floor, headroom, volume",
    .text = "Measures the simulated state, or the designed one where there is none: the floor, how much of it has the "
            "headroom asked for, the volume between ground and shell, and the shell's area. Holes count as closed.",
    .options = options,
    .option_count = sizeof options / sizeof *options,
    .size = sizeof(arguments),
    .defaults = defaults,
    .run = run,
};
