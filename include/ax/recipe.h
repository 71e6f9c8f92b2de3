// Recipes: the ordered list of design operators with their parameters, the one document of a design. Operators are one file
// each, picked up by the build; their fields drive the reader, its errors, command line help, docs and the studio's panels.
#pragma once

#include "ax/form.h"

typedef enum ax_field_kind {
    AX_FIELD_NUMBER,  // double in [lo, hi]
    AX_FIELD_INTEGER, // int in [lo, hi]
    AX_FIELD_FLAG,    // bool
    AX_FIELD_CHOICE,  // int: place of the word in `choices`
    AX_FIELD_TEXT,    // const char*
    AX_FIELD_VECTOR,  // double[width]
    AX_FIELD_POINTS,  // ax_points: a list of points of `width` numbers
} ax_field_kind;

typedef struct ax_points {
    int count;
    const double* values; // count x width
} ax_points;

typedef struct ax_field {
    const char *name, *title, *unit, *doc; // unit: "", "length", "length2", "deg", "kg/m2", "Pa", "rad/length2", ...
    ax_field_kind kind;
    bool required;
    size_t offset; // in the operator's arguments
    int width;     // numbers in a vector or point
    double lo, hi; // range of numbers (each one of vectors and points); of texts and points: fewest and most
    bool open;     // lo itself is out of range
    const char* const* choices;
    int choice_count;
    const char* fallback; // the default in words, where it is no value: "the centre of the sheet"; NULL: see `defaults`
} ax_field;

// What an operator of the group "finish" made.
typedef struct ax_finished {
    bool made;        // the exact design is there
    ax_design design; // empty unless made; freed by ax_design_free
    ax_finish figures;
} ax_finished;

typedef struct ax_operator_context {
    ax_form** form;     // NULL inside before the first operator; operators that start a design put it there
    const char* folder; // relative file names are within it
    const char* file;   // read in place of the one that the operator names; NULL: that one
    bool live;          // a preview while the hand moves: edit, do not settle
    const ax_progress* progress;
    ax_finished* finished; // where what finishing makes is put; NULL: nowhere
} ax_operator_context;

typedef struct ax_operator_type {
    const char *name, *title, *doc, *reference; // reference: where the method is from, NULL: nowhere in particular
    const char* group; // "start", "scale", "boundary", "dynamics", "constraint", "selection", "site", "finish"
    const ax_field* fields;
    int field_count;
    size_t size;               // of the arguments
    void (*defaults)(void* a); // fills zeroed arguments; NULL: zeros are the defaults. NaN in a number: not given
    // What must hold between fields: NULL, or what is wrong in words, and *field the one to blame (-1: the whole). NULL: nothing.
    const char* (*check)(const void* arguments, int* field);
    bool starts; // makes the form: only at the first place
    // The form is settled after it, for as many iterations as its integer field "steps" says (0: until at rest).
    bool settles;
    // On failure the form is as it was.
    ax_status (*apply)(const ax_operator_context* context, const void* arguments, ax_error* error);
} ax_operator_type;

// All operators, in order of their names; one by name, NULL if there is none.
const ax_operator_type* const* ax_operator_types(int* count);
const ax_operator_type* ax_operator_find(const char* name);

// Hinges by words, the way every field called "hinges" takes them: docs/recipes.md, "Selections". In order, each once; owned by the
// caller (ax_free). AX_BAD_INPUT says what is wrong with the words; an empty set is no error.
ax_status ax_select(ax_form* form, const char* words, int** hinges, int* count, ax_error* error);

// A recipe in memory. Operators are kept as JSON text, one object each: {"op": "paint", ...}.
typedef struct ax_recipe ax_recipe;

ax_recipe* ax_recipe_make(void);
// One that goes on from a form that is there already: no operator of it starts one. Such a recipe is not all of a design.
ax_recipe* ax_recipe_make_based(void);
void ax_recipe_free(ax_recipe* recipe);
// Reads a recipe; every operator is checked against its fields. AX_BAD_INPUT with line and column: unknown fields, values out of
// their range, a start that does not stand first.
ax_status ax_recipe_parse(const char* text, ax_recipe** out, ax_error* error);
ax_status ax_recipe_read(const char* path, ax_recipe** out, ax_error* error);
// As text, owned by the caller (ax_free): indented JSON that reads back to the same recipe.
char* ax_recipe_text(const ax_recipe* recipe);
// The same to a file, whole or not at all.
ax_status ax_recipe_write(const ax_recipe* recipe, const char* path, ax_error* error);
int ax_recipe_count(const ax_recipe* recipe);
const char* ax_recipe_operator(const ax_recipe* recipe, int k); // JSON text, borrowed
const ax_operator_type* ax_recipe_type(const ax_recipe* recipe, int k);
// The file that operator k reads, as it names it; NULL: none. Owned by the caller (ax_free).
char* ax_recipe_file(const ax_recipe* recipe, int k);
// One line for people, "Paint: 1.6 within 0.3 m"; text holds 160 characters.
void ax_recipe_words(const ax_recipe* recipe, int k, char text[160]);
// Inserts at place k (count: at the end) after checking, replaces, or removes.
ax_status ax_recipe_insert(ax_recipe* recipe, int k, const char* json, ax_error* error);
ax_status ax_recipe_replace(ax_recipe* recipe, int k, const char* json, ax_error* error);
void ax_recipe_remove(ax_recipe* recipe, int k);

// Applies operator k to *form, then settles if its type says so. On failure *form is as it was.
ax_status ax_recipe_apply(const ax_recipe* recipe, int k, const char* folder, const ax_progress* progress,
                          ax_form** form, ax_error* error);
// The same, and keeps what an operator that finishes made in *finished. `file` (NULL: none) is read in place of the one it names.
ax_status ax_recipe_apply_finished(const ax_recipe* recipe, int k, const char* folder, const char* file,
                                   const ax_progress* progress, ax_form** form, ax_finished* finished, ax_error* error);
// The same for an operator that stands in no recipe yet, without settling: a preview while the hand moves.
ax_status ax_operator_preview(const char* json, const char* folder, ax_form** form, ax_error* error);
// Plays operators 0 .. until - 1 (until < 0: all) from nothing; `after` (NULL: none) is called after each one and may stop by
// returning false. *form is the last good state even on failure (NULL if there was none), *done how many were applied.
ax_status ax_recipe_play(const ax_recipe* recipe, int until, const char* folder, const ax_progress* progress,
                         bool (*after)(void* context, int k, ax_form* form), void* context, ax_form** form, int* done,
                         ax_error* error);
