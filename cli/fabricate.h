// The options that say how a design is made, shared by subcommands, and their report.
#pragma once

#include "options.h"

#include "ax/fabricate.h"

typedef struct fabricate_arguments {
    const char *joint, *material, *sheet, *profile, *date;
    double kerf, margin, spacing;
    int frames;
} fabricate_arguments;

// Rows for a table of options; `arguments` is the struct, `member` its fabricate_arguments.
#define FABRICATE_OPTIONS(arguments, member)                                                                           \
    {.name = "--joint",                                                                                                \
     .value = "J",                                                                                                     \
     .text = "how panels are joined, with parameters if wanted: ring:hole=4,edge=3",                                   \
     .kind = OPTION_TEXT,                                                                                              \
     .fallback = "none",                                                                                               \
     .offset = offsetof(arguments, member.joint)},                                                                     \
        {.name = "--material",                                                                                         \
         .value = "M",                                                                                                 \
         .text = "what is cut, adjusted if wanted: plywood-3:thickness=2.9",                                           \
         .kind = OPTION_TEXT,                                                                                          \
         .fallback = "card-0.5",                                                                                       \
         .offset = offsetof(arguments, member.material)},                                                              \
        {.name = "--sheet",                                                                                            \
         .value = "WxH",                                                                                               \
         .text = "size of the stock in mm, or A4 to A0",                                                               \
         .kind = OPTION_TEXT,                                                                                          \
         .fallback = "one sheet, as large as need be",                                                                 \
         .offset = offsetof(arguments, member.sheet)},                                                                 \
        {.name = "--kerf",                                                                                             \
         .value = "MM",                                                                                                \
         .text = "full width of the beam or knife, by half of which outlines grow and holes shrink",                   \
         .kind = OPTION_NUMBER,                                                                                        \
         .hi = 10,                                                                                                     \
         .unit = "mm",                                                                                                 \
         .offset = offsetof(arguments, member.kerf)},                                                                  \
        {.name = "--profile",                                                                                          \
         .value = "NAME",                                                                                              \
         .text = "colours, layers and speeds of the machine, or a file of one's own that ends in .json",               \
         .kind = OPTION_TEXT,                                                                                          \
         .fallback = "generic",                                                                                        \
         .offset = offsetof(arguments, member.profile)},                                                               \
        {.name = "--margin",                                                                                           \
         .value = "MM",                                                                                                \
         .text = "kept free round each sheet",                                                                         \
         .kind = OPTION_NUMBER,                                                                                        \
         .hi = 1000,                                                                                                   \
         .unit = "mm",                                                                                                 \
         .offset = offsetof(arguments, member.margin)},                                                                \
        {.name = "--date",                                                                                             \
         .value = "DAY",                                                                                               \
         .text = "printed on the sheets: 2026-05-31, today, or none",                                                  \
         .kind = OPTION_TEXT,                                                                                          \
         .fallback = "the day (UTC) of the last change of the document",                                               \
         .offset = offsetof(arguments, member.date)},                                                                  \
        {.name = "--frames",                                                                                           \
         .value = "N",                                                                                                 \
         .text = "states between flat and open in which panels are held against each other",                           \
         .kind = OPTION_INTEGER,                                                                                       \
         .hi = 1000,                                                                                                   \
         .offset = offsetof(arguments, member.frames)},                                                                \
    {                                                                                                                  \
        .name = "--spacing", .value = "MM", .text = "least distance of pieces that are packed on a sheet",             \
        .kind = OPTION_NUMBER, .hi = 1000, .unit = "mm", .offset = offsetof(arguments, member.spacing)                 \
    }

void fabricate_defaults(fabricate_arguments* arguments);
// The options, and what they borrow: not to be copied.
typedef struct fabricate_choice {
    ax_fabricate_options options;
    ax_profile profile;
    char date[32];
} fabricate_choice;
// `document`: whose day is the date unless one is given; NULL: none.
ax_status fabricate_choose(const fabricate_arguments* arguments, const char* document, fabricate_choice* choice,
                           ax_error* error);

// Sheets, material, time, parts, and what collides, in a few lines.
void fabricate_print(const ax_cut_plan* plan, FILE* out);
// All joints with their parameters, materials, sheets and profiles.
void fabricate_list(FILE* out);
