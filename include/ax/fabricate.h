// From a design to what a machine cuts: joints, real panel outlines, labels and sheets, as a neutral cut plan that writers only
// serialise. Everything here is in millimetres at true size, y up, whatever the document's unit.
#pragma once

#include "ax/design.h"

// --- materials

typedef struct ax_material {
    const char *name, *doc; // "plywood-3"
    double thickness;       // mm
    double density;         // kg/m3
    double kerf;            // mm, typical full width of a laser's cut; a suggestion, applied only when asked for
    double feature;         // mm, least width of what must not break
    double strength;        // MPa, tension across a feature, for ratings
    double stiffness;       // MPa, Young's modulus
    bool bends;             // a narrow ligament by a hundred degrees in its plane, and does not break
} ax_material;
const ax_material* ax_materials(int* count);            // all that are known
const ax_material* ax_material_named(const char* name); // NULL: none

// --- joints

typedef struct ax_joint_parameter {
    const char *name, *unit, *doc; // "hole", "mm"
    double least, most, standard;
} ax_joint_parameter;

// One way of joining panels: a file of its own in src/fabricate/joints.
typedef struct ax_joint_type {
    const char *name, *doc; // "ring"; one sentence
    bool one_piece;         // panels hang together when cut
    bool two_layers;        // neighbours lie on each other
    const ax_joint_parameter* parameters;
    int parameter_count;              // at most 8
    const struct ax_joint_work* work; // how it is done; src/fabricate/joint_work.h
} ax_joint_type;
const ax_joint_type* const* ax_joint_types(int* count); // in order of their names
const ax_joint_type* ax_joint_named(const char* name);  // NULL: none

// --- operations and machine profiles

// What a machine does with a line, in the order of work; notes are for people and are not machined.
typedef enum ax_operation {
    AX_LABEL, // engraved single strokes
    AX_SCORE, // marked lightly: alignment marks
    AX_HOLE,  // closed cuts within a panel
    AX_SLIT,  // cuts between panels of one piece, closed or open
    AX_CUT,   // closed outlines of pieces
    AX_NOTE,  // not machined
    AX_OPERATIONS
} ax_operation;
const char* ax_operation_name(ax_operation operation); // "LABEL"

typedef struct ax_profile_pen {
    char layer[32];
    unsigned char rgb[3];
    int aci;       // AutoCAD colour index, 1 to 255
    double stroke; // mm
    double speed;  // mm/s, for the estimate of time
    bool used;     // false: the machine does not get this operation
} ax_profile_pen;

typedef struct ax_profile {
    char name[32], doc[160];
    ax_profile_pen pens[AX_OPERATIONS];
    double travel_speed; // mm/s
} ax_profile;
const ax_profile* ax_profiles(int* count); // all that are known
// `name` of a profile, or the path of a JSON file (docs/making.md) that ends in .json. AX_USAGE names the known ones,
// AX_BAD_INPUT what is wrong in the file.
ax_status ax_profile_find(const char* name, ax_profile* profile, ax_error* error);

// --- the cut plan

// Vertex of a path. `bulge` shapes the way to the next vertex (from the last one of a closed path: to the first): the tangent of
// a quarter of the arc's angle, positive counter-clockwise, 0 for a straight line. |bulge| <= 1.
typedef struct ax_cut_point {
    double x, y, bulge;
} ax_cut_point;

// A line without a break: points[first .. first + count). Closed paths do not repeat their first point. A full circle is a closed
// path of two opposite points with bulges of 1 (or -1).
typedef struct ax_cut_path {
    int first, count;
    bool closed;
} ax_cut_path;

// What belongs together: an outline, a hole, the strokes of a label. Paths paths[first .. first + count).
typedef struct ax_cut_item {
    ax_operation operation;
    int panel; // index of a triangle, -1: of none
    int first, count;
    char name[28]; // unique on its sheet, letters, digits, '-' and '.': "cut-C14", "label-C14", "hole-C14.0"
} ax_cut_item;

// Items items[first .. first + count), ordered for the machine: by operation, within one by nearest neighbour, inner before
// outer. The origin is the sheet's lower left corner; all paths lie within the sheet.
typedef struct ax_cut_sheet {
    double width, height;
    int first, count;
    double utilisation; // area of panels / area of the sheet
} ax_cut_sheet;

// One panel per triangle of the linkage, in its order. `shape` paths are the panel as it shall be, without kerf, in millimetres of
// the flat state: first the outline, counter-clockwise, then holes, clockwise. On its sheet the panel lies turned and moved:
// x' = c x - s y + dx, y' = s x + c y + dy with (c, s, dx, dy) = placement.
typedef struct ax_cut_panel {
    char name[16];
    int sheet, piece; // piece: panels that stay together when cut
    int row;          // of the lattice
    int layer;        // of the stack at a hinge: 0, or 1 for the upper of two
    int first, count; // shape
    double placement[4];
    double area, mass;   // mm2, kg
    double label_height; // mm, 0: too small for a label inside
} ax_cut_panel;

// What happens at a hinge where two panels meet.
typedef struct ax_cut_hinge {
    int hinge;
    int panels[2];
    int seam;         // number of the seam that is closed after cutting, 0: none
    double mouth;     // radians, flat; the panels turn from here to the opening of the deployed state
    double clearance; // mm, least distance of the two outlines on this way; negative: they collide. NaN: one piece
    double force;     // N, passed on in the simulated state; NaN unless simulated
    double rated;     // N, what joint and material are taken to bear; an estimate, not a proof
} ax_cut_hinge;

// Two panels that come too close.
typedef struct ax_cut_clash {
    int panels[2];
    int hinge;    // where they meet, -1: they do not
    double angle; // radians, mouth angle at the hinge; NaN for panels that do not meet
    int frame;    // 0 flat, 1 deployed, 2 simulated, 3 between flat and open; -1: turning from flat to open at a hinge
    double opening; // frame 3: of the ax_cut_frame where they overlap most; NaN elsewhere
    double overlap; // mm
} ax_cut_clash;

// A state between flat and open in which all panels were held against each other. Of a simulated design it comes from a simulation in
// time, whose panels are not quite rigid and were made so.
typedef struct ax_cut_frame {
    double opening; // 0 flat, 1 open; of a simulation, its time
    double strain;  // of the simulation: largest relative error of an edge
    double moved;   // mm, that a hinge of it moved by at most when panels were made rigid
    double error;   // largest relative error of an edge then
    bool checked;   // false: panels could not be made rigid within a thousandth
    int clashes;    // pairs of panels that overlap
} ax_cut_frame;

// Loose parts to buy.
typedef struct ax_cut_part {
    char name[64]; // "ring, 16 mm inside"
    int count;
} ax_cut_part;

typedef struct ax_cut_plan {
    int point_count, path_count, item_count, sheet_count, panel_count, hinge_count, clash_count, part_count, seam_count;
    ax_cut_point* points;
    ax_cut_path* paths;
    ax_cut_item* items;
    ax_cut_sheet* sheets; // to be cut
    // All panels in place with name and sheet ("C14/2"), NOTE only; empty (count 0) if there is one sheet.
    ax_cut_sheet overview;
    ax_cut_panel* panels;
    ax_cut_hinge* hinges;
    ax_cut_clash* clashes; // at most AX_CLASHES of them are kept; clash_count counts these
    ax_cut_part* parts;
    int clashes_found;
    // Neighbours folded onto each other, by more than a right angle, in the simulated state (else the deployed one): they share a hinge and so
    // are no clash, but joints do not bend so far. fold: the panels of the first, -1 without.
    int folds, fold[2];
    int frame_count;
    ax_cut_frame* frames;
    bool simulated_way; // frames are of a simulation; else the panels' middles go straight from flat to open
    int frames_checked;
    double frame_error; // mm, by which hinges of these are off at most; what overlaps by less does not count
    const ax_joint_type* joint;
    double joint_values[8]; // as used, by the joint's parameters
    ax_material material;
    const ax_profile* profile;          // borrowed from the options
    double kerf;                        // mm, full width of the beam, by half of which outlines have grown; 0: none
    double cut_length[AX_OPERATIONS];   // mm, over all sheets
    double travel;                      // mm, with the beam off
    double seconds;                     // at the machine, by the profile's speeds, without acceleration
    double area, mass;                  // mm2, kg, all panels
    double utilisation;                 // area of panels / area of all sheets
    int labels_outside, labels_dropped; // named beside the panel with a leader; not named at all
    int sizes;                          // as in the options
    char doubt[256];                    // what speaks against this joint here, a sentence; empty: nothing
    bool in_place;                      // the sheet shows the flat state as it is, moved only
    char title[128], date[32];
} ax_cut_plan;

enum { AX_CLASHES = 100 };

void ax_cut_plan_free(ax_cut_plan* plan); // also resets to an empty plan; NULL allowed

// Centre, radius and signed sweep (radians, counter-clockwise positive) of the arc from `a` to `b`; a->bulge is not 0.
typedef struct ax_cut_arc {
    double centre[2], radius, start, sweep; // start: angle of `a` seen from the centre
} ax_cut_arc;
ax_cut_arc ax_cut_arc_of(const ax_cut_point* a, const ax_cut_point* b);
bool ax_cut_path_is_circle(const ax_cut_plan* plan, const ax_cut_path* path, double centre[2], double* radius);

// --- from design to plan

typedef struct ax_sheet_size {
    const char* name;
    double width, height; // mm
} ax_sheet_size;
const ax_sheet_size* ax_sheet_sizes(int* count); // presets, "600x400"

typedef struct ax_fabricate_options {
    const ax_joint_type* joint;
    double joint_values[8]; // by the joint's parameters; NaN: its standard, or more where the material asks for it
    ax_material material;
    const ax_profile* profile; // borrowed, also by the plan; NULL: generic
    double sheet[2];           // mm, width and height of the stock; 0: one sheet, as large as need be
    double margin;             // mm, kept free round the stock and between a sheet's content and its notes
    double spacing;            // mm, least distance of neighbours that are packed; at least the kerf is kept
    double kerf;               // mm, full width of the beam: outlines grow by half of it, holes shrink. 0: none
    bool clearance;            // prove clearance (takes longer than the rest)
    int frames;                // with it: states between flat and open to prove it in, 0 to 1000
    int sizes;                 // of panels that the schedule proposes, at most; 0: see ax_cluster_within
    const char* title;         // for notes, NULL: none
    // For notes, NULL: none; the recipe's day and never that of the export: the same design gives the same bytes.
    const char* date;
} ax_fabricate_options;
// Bare triangles, card, one sheet, kerf 0, clearance proven, also in 7 states between.
ax_fabricate_options ax_fabricate_options_default(void);

// Reads "ring", or "ring:hole=4,edge=3" with parameters; "plywood-3", or "plywood-3:thickness=2.9" with density (kg/m3), feature (mm)
// and strength (MPa) likewise; "600x400", or a preset's name. AX_USAGE says what is known and what the range is.
ax_status ax_fabricate_set_joint(ax_fabricate_options* options, const char* words, ax_error* error);
ax_status ax_fabricate_set_material(ax_fabricate_options* options, const char* words, ax_error* error);
ax_status ax_fabricate_set_sheet(ax_fabricate_options* options, const char* words, ax_error* error);

// Makes the plan. NULL options: the defaults. AX_CANNOT_REALISE names the panel, the limit and what to try when a joint does not
// fit its panel or a panel its sheet; the plan is then empty. Panels that collide are no failure: they are in plan->clashes.
ax_status ax_fabricate(const ax_design* design, const ax_fabricate_options* options, const ax_progress* progress,
                       ax_cut_plan* plan, ax_error* error);

// A plan of one sheet of trial cuts: slots and tabs to measure the kerf with, or hinges of the chosen joint at several sizes.
typedef enum ax_coupon { AX_COUPON_KERF, AX_COUPON_HINGE } ax_coupon;
ax_status ax_fabricate_coupon(ax_coupon coupon, const ax_fabricate_options* options, ax_cut_plan* plan,
                              ax_error* error);
