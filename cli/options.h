// Subcommands and their options as data: these tables drive parsing, range errors, --help and docs/command.md.
#pragma once

#include "ax/base.h"
#include "ax/mesh.h"

#include <stdio.h>

typedef enum option_kind {
    OPTION_FLAG,    // bool
    OPTION_INTEGER, // int, lo to hi
    OPTION_NUMBER,  // double, lo to hi
    OPTION_BAND,    // double[2], lo <= first < second <= hi, written FIRST,SECOND
    OPTION_CHOICE,  // int: `first` plus the place of the word in `choices`
    OPTION_TEXT,    // const char*, as given
    OPTION_WORDS,   // word_list: an operand that takes all names from its place on
    OPTION_OTHER,   // what `parse` makes of it
} option_kind;

typedef struct word_list {
    int count;
    const char* words[64];
} word_list;

typedef struct command_option {
    const char* name;  // "--triangles"; an operand has its placeholder here: "TARGET"
    const char* value; // placeholder of the value, NULL for flags and operands
    const char* text;  // sentences; range, unit and default are added when shown
    option_kind kind;
    bool operand, required;
    size_t offset; // of the value in the command's arguments
    double lo, hi; // both belong to the range, but with `open` lo does not; hi INFINITY: no upper end
    bool open;
    const char* unit; // NULL: a pure number
    const char* const* choices;
    int choice_count, first;
    // Writes to `value` and returns NULL, or returns what it expects: "an angle in degrees, or edge".
    const char* (*parse)(const char* text, void* value);
    const char* fallback; // the default in words; NULL: shown from the default arguments; "": none to show
    const char* excludes; // an option that cannot be given together with this one
} command_option;

// The operand that most commands begin with: `document` of their arguments.
#define OPTION_DOCUMENT(arguments)                                                                                     \
    {                                                                                                                  \
        .name = "P.auxshell", .text = "the document", .kind = OPTION_TEXT, .operand = true, .required = true,          \
        .offset = offsetof(arguments, document)                                                                        \
    }

// The document that a command writes: `out` of their arguments.
#define OPTION_OUT(arguments)                                                                                          \
    {                                                                                                                  \
        .name = "-o", .value = "P.auxshell", .text = "the document to write", .kind = OPTION_TEXT, .required = true,   \
        .offset = offsetof(arguments, out)                                                                             \
    }

// How commands stand a mesh file up: an int of their arguments.
#define OPTION_UP(arguments, member)                                                                                   \
    {                                                                                                                  \
        .name = "--up",                                                                                                \
        .text = "the file's axis that points up: as its format says (y for glTF, z for OBJ), or as given",             \
        .kind = OPTION_CHOICE, .choices = ax_up_words, .choice_count = 3, .offset = offsetof(arguments, member)        \
    }

// In which unit a mesh file is drawn: an int of their arguments, `first` for millimetres.
#define OPTION_UNITS(arguments, member, ...)                                                                           \
    {                                                                                                                  \
        .name = "--units", .text = "unit of the target's coordinates", .kind = OPTION_CHOICE, .choices = option_units, \
        .choice_count = 3, .offset = offsetof(arguments, member), __VA_ARGS__                                          \
    }
extern const char* const option_units[3];

// The band of scale factors: a double[2] of their arguments.
#define OPTION_SCALE(arguments, member)                                                                                \
    {                                                                                                                  \
        .name = "--scale", .value = "LO,HI",                                                                           \
        .text = "band of scale factors: how far a triangle's neighbourhood may expand, within 1 to 2",                 \
        .kind = OPTION_BAND, .lo = 1, .hi = 2, .offset = offsetof(arguments, member)                                   \
    }

// Takes one row of a list: a name and what it means.
typedef void (*list_row)(const char* name, const char* text, FILE* out);

typedef struct command {
    const char* name;
    const char* summary; // one line
    const char* text;    // paragraphs, separated by empty lines
    const command_option* options;
    int option_count;
    size_t size;                       // of the arguments
    void (*defaults)(void* arguments); // fills zeroed arguments; NULL: zeros are the defaults
    ax_status (*run)(const void* arguments, ax_error* error);
    // Something to list after the options, or NULL: calls `row` for each entry.
    const char* list_title;
    void (*list)(list_row row, FILE* out);
} command;

// All subcommands, sorted by name; the table is written by the build from the files in commands/.
const command* const* commands(int* count);

// Fills `arguments` (command->size bytes) from the words after the subcommand. AX_USAGE names the word, its range, and the
// nearest known option.
ax_status command_parse(const command* command, int count, char** words, void* arguments, ax_error* error);
// True if --help or -h is among the words before "--".
bool command_wants_help(int count, char** words);

void command_print_help(const command* command, FILE* out);
void command_print_reference(const command* command, FILE* out); // as a section of Markdown

// Prints a text wrapped at 100 columns; lines after the first are indented.
void print_wrapped(FILE* out, int column, int indent, const char* text);
