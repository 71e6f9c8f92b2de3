// What operators share: fields that many have, hinges and panels by words, files, and reading and writing of the scale factors.
#pragma once

#include "ax/recipe.h"
#include "base/vec.h"

#include <string.h>

#define AX_COUNT(array) ((int)(sizeof(array) / sizeof *(array)))

// Fields for arguments of type T in which the member is called as the field.
#define AX_NUMBER(T, member, title_, unit_, lo_, hi_, ...)                                                             \
    {                                                                                                                  \
        .name = #member, .title = title_, .unit = unit_, .kind = AX_FIELD_NUMBER, .offset = offsetof(T, member),       \
        .lo = lo_, .hi = hi_, __VA_ARGS__                                                                              \
    }
#define AX_INTEGER(T, member, title_, lo_, hi_, ...)                                                                   \
    {                                                                                                                  \
        .name = #member, .title = title_, .unit = "", .kind = AX_FIELD_INTEGER, .offset = offsetof(T, member),         \
        .lo = lo_, .hi = hi_, __VA_ARGS__                                                                              \
    }
// How long operators settle that move the form: arguments have `int steps`.
#define AX_STEPS(T) AX_INTEGER(T, steps, "Steps", 0, 100000, .doc = "Iterations; 0: until the form is at rest.")
// How operators stand a mesh file up: arguments have `int up`.
#define AX_UP(T)                                                                                                       \
    AX_CHOICE(T, up, "Up axis", ax_up_words,                                                                           \
              .doc = "The file's axis that points up: as its format says (y for glTF, z for OBJ), or as given.")
#define AX_FLAG(T, member, title_, ...)                                                                                \
    {                                                                                                                  \
        .name = #member, .title = title_, .unit = "", .kind = AX_FIELD_FLAG, .offset = offsetof(T, member),            \
        __VA_ARGS__                                                                                                    \
    }
#define AX_CHOICE(T, member, title_, words_, ...)                                                                      \
    {                                                                                                                  \
        .name = #member, .title = title_, .unit = "", .kind = AX_FIELD_CHOICE, .offset = offsetof(T, member),          \
        .choices = words_, .choice_count = AX_COUNT(words_), __VA_ARGS__                                               \
    }
#define AX_TEXT(T, member, title_, ...)                                                                                \
    {                                                                                                                  \
        .name = #member, .title = title_, .unit = "", .kind = AX_FIELD_TEXT, .offset = offsetof(T, member),            \
        __VA_ARGS__                                                                                                    \
    }
#define AX_VECTOR(T, member, title_, unit_, width_, ...)                                                               \
    {                                                                                                                  \
        .name = #member, .title = title_, .unit = unit_, .kind = AX_FIELD_VECTOR, .offset = offsetof(T, member),       \
        .width = width_, __VA_ARGS__                                                                                   \
    }
#define AX_POINTS(T, member, title_, width_, fewest_, ...)                                                             \
    {                                                                                                                  \
        .name = #member, .title = title_, .unit = "length", .kind = AX_FIELD_POINTS, .offset = offsetof(T, member),    \
        .width = width_, .lo = fewest_, __VA_ARGS__                                                                    \
    }

// A file that an operator names: relative ones are in the recipe's folder. Owned by the caller.
char* ax_operator_path(const ax_operator_context* context, const char* name);

// Hinges by words, of which at least `fewest` must be there.
ax_status ax_operator_hinges(const ax_operator_context* context, const char* words, int fewest, int** hinges,
                             int* count, ax_error* error);

// The form's panels as operators on scale factors see them.
typedef struct ax_sheet {
    const ax_linkage* linkage;
    double spacing;
    int count;             // panels
    double (*centre)[2];   // on the sheet; owned
    double* scale;         // as prescribed now; owned: changed, then handed back
    unsigned char* chosen; // per panel: 1 where all hinges of the panel are chosen; owned
    double middle[2];      // of the sheet: the mean of its rim's extents
    double lo[2], hi[2];   // extents of the hinges
} ax_sheet;

// `words` choose the region.
ax_status ax_sheet_take(const ax_operator_context* context, const char* words, ax_sheet* sheet, ax_error* error);
void ax_sheet_free(ax_sheet* sheet);
// Prescribes the scale factors and frees the sheet.
void ax_sheet_give(const ax_operator_context* context, ax_sheet* sheet);
