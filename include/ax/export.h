// Writing a design to files of other programs, chosen by ending.
#pragma once

#include "ax/fabricate.h"

typedef enum ax_state { AX_STATE_DEFAULT, AX_STATE_FLAT, AX_STATE_DEPLOYED, AX_STATE_SIMULATED } ax_state;
const char* ax_state_name(ax_state state); // "default", "flat", "deployed", "simulated"

typedef struct ax_export_options {
    ax_state state;                        // AX_STATE_DEFAULT: flat for cut files, deployed otherwise
    const char* title;                     // name shown in drawings, NULL: none
    const ax_fabricate_options* fabricate; // for cut files; its title is replaced by `title`. NULL: defaults
    const ax_progress* progress;           // NULL: none
    ax_cut_plan* plan; // NULL, or takes the plan of a cut file, empty if it was none; freed by the caller
} ax_export_options;

// One exporter: a file of its own in src/export/types.
typedef struct ax_export_type {
    const char* ending; // with the dot: ".svg"
    const char* name;   // "SVG drawing"
    const char* doc;    // one sentence
    ax_state default_state;
    bool states[4]; // which ax_state values it can write
    ax_status (*write)(const ax_design* design, ax_state state, const ax_export_options* options, const char* path,
                       ax_error* error); // writes the whole file to `path` as it is; the caller renames
    // Instead of `write`, for cut files: writes one sheet of the plan, or the overview if `sheet` is plan->sheet_count.
    // With `all_sheets` it is called once, with sheet 0, and writes every sheet and the overview to one file. `design` is
    // NULL for coupons.
    ax_status (*write_sheet)(const ax_design* design, const ax_cut_plan* plan, int sheet, const char* path,
                             ax_error* error);
    bool all_sheets;
} ax_export_type;

// All exporters, in order of their endings.
const ax_export_type* const* ax_export_types(int* count);

// Writes beside `path` and renames, so that no partial file is ever left. Cut files of several sheets become NAME-1.svg,
// NAME-2.svg and so on beside an overview in NAME.svg, unless the format holds them all in one file. NULL options: default
// state, no title. AX_USAGE on an unknown ending (the message lists the known ones) or a state the format does not carry;
// AX_BAD_INPUT when the state is missing (not simulated); AX_FAILED when the disk does not take it.
ax_status ax_export(const ax_design* design, const char* path, const ax_export_options* options, ax_error* error);

// Where sheet 0, 1 ... of a plan was written when the overview went to `path`; NULL if `path` holds everything there is. The caller frees
// it.
char* ax_export_sheet_path(const char* path, const ax_cut_plan* plan, int sheet);

// The same for several files, in several formats if wanted: one plan is made for all cut files, and they are written side by side.
// Either all files are there in the end or none has changed, but for a disk that fails while they are renamed.
ax_status ax_export_files(const ax_design* design, int count, const char* const* paths,
                          const ax_export_options* options, ax_error* error);

// The same for a plan without a design, as ax_fabricate_coupon makes it. AX_USAGE unless the ending is that of a cut file.
ax_status ax_export_plan(const ax_cut_plan* plan, const char* path, ax_error* error);
