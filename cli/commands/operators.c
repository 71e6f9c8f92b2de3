// auxshell operators: what a recipe can do, drawn from the operators' own fields.
#include "options.h"

#include "ax/recipe.h"

#include <string.h>

typedef struct arguments {
    const char* name;
    bool markdown;
} arguments;

static const command_option options[] = {
    {.name = "NAME",
     .text = "an operator to explain",
     .kind = OPTION_TEXT,
     .operand = true,
     .offset = offsetof(arguments, name)},
    {.name = "--markdown",
     .text = "print the page docs/operators.md",
     .kind = OPTION_FLAG,
     .offset = offsetof(arguments, markdown)},
};

typedef struct group {
    const char *name, *title;
} group;
static const group groups[] = {
    {"start", "Starting a design"}, {"scale", "Scale factors"},  {"boundary", "The rim"}, {"dynamics", "Dynamics"},
    {"constraint", "Constraints"},  {"selection", "Selections"}, {"site", "The site"},    {"finish", "Exactness"},
};
enum { GROUPS = sizeof groups / sizeof *groups, INDENT = 20 };

static void unit_words(const ax_field* field, char words[32])
{
    const char* unit = field->unit;
    if (strcmp(unit, "length") == 0)
        unit = "a length";
    else if (strcmp(unit, "deg") == 0)
        unit = "degrees";
    else if (strcmp(unit, "1/length2") == 0)
        unit = "1 / length squared";
    snprintf(words, 32, "%s%s", *unit ? ", " : "", unit);
}

static void range_words(const ax_field* field, char words[64])
{
    if (field->hi >= 1e9 && field->lo <= -1e9)
        *words = 0;
    else if (field->hi >= 1e9)
        snprintf(words, 64, ", %s %.10g", field->open ? "more than" : "at least", field->lo);
    else
        snprintf(words, 64, ", %s%.10g to %.10g", field->open ? "more than " : "", field->lo, field->hi);
}

static void default_words(const ax_field* field, const void* value, char words[128])
{
    if (field->fallback) {
        snprintf(words, 128, "%s", field->fallback);
        return;
    }
    *words = 0;
    int used = 0, chosen;
    switch (field->kind) {
    case AX_FIELD_NUMBER:
        snprintf(words, 128, "%.10g", *(const double*)value);
        break;
    case AX_FIELD_INTEGER:
        snprintf(words, 128, "%d", *(const int*)value);
        break;
    case AX_FIELD_FLAG:
        snprintf(words, 128, *(const bool*)value ? "true" : "false");
        break;
    case AX_FIELD_CHOICE:
        memcpy(&chosen, value, sizeof chosen);
        snprintf(words, 128, "\"%s\"", field->choices[chosen]);
        break;
    case AX_FIELD_TEXT:
        snprintf(words, 128, "\"%s\"", *(const char* const*)value);
        break;
    case AX_FIELD_VECTOR:
        for (int k = 0; k < field->width; ++k)
            used += snprintf(words + used, 128 - (size_t)used, "%s%.10g", k ? ", " : "[", ((const double*)value)[k]);
        snprintf(words + used, 128 - (size_t)used, "]");
        break;
    case AX_FIELD_POINTS:
        break;
    }
}

static void kind_words(const ax_field* field, char words[256])
{
    static const char* const letters[] = {"[x]", "[x, y]", "[x, y, z]"};
    char unit[32], range[64];
    size_t used = 0;
    unit_words(field, unit);
    switch (field->kind) {
    case AX_FIELD_NUMBER:
    case AX_FIELD_INTEGER:
        range_words(field, range);
        snprintf(words, 256, "%s%s%s", field->kind == AX_FIELD_NUMBER ? "number" : "whole number", unit, range);
        break;
    case AX_FIELD_FLAG:
        snprintf(words, 256, "true or false");
        break;
    case AX_FIELD_CHOICE:
        *words = 0;
        for (int k = 0; k < field->choice_count && used < 256; ++k)
            used += (size_t)snprintf(words + used, 256 - used, "%s\"%s\"", k ? ", " : "", field->choices[k]);
        break;
    case AX_FIELD_TEXT:
        snprintf(words, 256, "text");
        break;
    case AX_FIELD_VECTOR:
        snprintf(words, 256, "%s", letters[field->width - 1]);
        break;
    case AX_FIELD_POINTS:
        snprintf(words, 256, "list of %s", letters[field->width - 1]);
        break;
    }
}

// The field's sentence with its kind, range and default.
static void field_words(const ax_field* field, const void* defaults, char* words, size_t size)
{
    char kind[256], fallback[128];
    kind_words(field, kind);
    default_words(field, (const char*)defaults + field->offset, fallback);
    const char* need = field->required ? "; required" : *fallback ? "; default " : "";
    snprintf(words, size, "%s (%s%s%s)", field->doc, kind, need, field->required ? "" : fallback);
}

typedef void (*field_row)(const char* name, const char* text);

static void each_field(const ax_operator_type* type, field_row row)
{
    void* defaults = ax_calloc(type->size, 1);
    if (type->defaults)
        type->defaults(defaults);
    for (int f = 0; f < type->field_count; ++f) {
        char words[1024];
        field_words(&type->fields[f], defaults, words, sizeof words);
        row(type->fields[f].name, words);
    }
    ax_free(defaults);
}

static void print_row(const char* name, const char* text)
{
    int used = printf("  %s", name);
    printf("%*s", used < INDENT ? INDENT - used : 1, "");
    print_wrapped(stdout, INDENT, INDENT, text);
}

static void print_cell(const char* text)
{
    for (; *text; ++text)
        printf(*text == '|' ? "\\|" : "%c", *text);
}

static void print_table_row(const char* name, const char* text)
{
    printf("| `%s` | ", name);
    print_cell(text);
    printf(" |\n");
}

static void explain(const ax_operator_type* type)
{
    printf("%s: %s\n\n", type->name, type->title);
    print_wrapped(stdout, 0, 0, type->doc);
    if (type->field_count)
        putchar('\n');
    each_field(type, print_row);
}

static void print_page(int count, const ax_operator_type* const* types)
{
    puts("# Operators\n\n"
         "Written by `auxshell operators --markdown`. What a [recipe](recipes.md) can do, one after the other. Every "
         "operator may\n"
         "also have a `note`, words of its author. Lengths are in the unit that the start gives; *on the sheet* means "
         "the\n"
         "undeformed lattice that was laid over the outline, whose places never change. Fields called `hinges` take a\n"
         "[selection](recipes.md#selections).");
    for (int g = 0; g < GROUPS; ++g) {
        printf("\n## %s\n", groups[g].title);
        for (int k = 0; k < count; ++k)
            if (strcmp(types[k]->group, groups[g].name) == 0) {
                printf("\n### %s\n\n**%s.** %s\n", types[k]->name, types[k]->title, types[k]->doc);
                if (types[k]->reference)
                    printf("%s\n", types[k]->reference);
                if (types[k]->field_count)
                    puts("\n| | |\n|---|---|");
                each_field(types[k], print_table_row);
            }
    }
}

static ax_status refuse(const char* name, int count, const ax_operator_type* const* types, ax_error* error)
{
    const char** names = AX_NEW(const char*, count);
    for (int k = 0; k < count; ++k)
        names[k] = types[k]->name;
    const char* nearest = ax_nearest_word(name, count, names);
    ax_free(names);
    if (nearest)
        return ax_fail(error, AX_USAGE, "There is no operator \"%s\". Did you mean \"%s\"?", name, nearest);
    return ax_fail(error, AX_USAGE, "There is no operator \"%s\". \"auxshell operators\" lists them.", name);
}

static ax_status run(const void* given, ax_error* error)
{
    const arguments* a = given;
    int count;
    const ax_operator_type* const* types = ax_operator_types(&count);
    const ax_operator_type* type = a->name ? ax_operator_find(a->name) : NULL;
    if (a->name && !type)
        return refuse(a->name, count, types, error);
    if (type)
        explain(type);
    else if (a->markdown)
        print_page(count, types);
    for (int g = 0; g < GROUPS && !type && !a->markdown; ++g) {
        printf("%s%s:\n", g ? "\n" : "", groups[g].title);
        for (int k = 0; k < count; ++k)
            if (strcmp(types[k]->group, groups[g].name) == 0)
                print_row(types[k]->name, types[k]->doc);
    }
    return AX_OK;
}

const command command_operators = {
    .name = "operators",
    .summary = "list the operators that recipes are made of, or explain one",
    .text =
        "Lists the design operators that a recipe is made of. With a name: what the operator does, and its fields with "
        "their ranges and defaults.",
    .options = options,
    .option_count = sizeof options / sizeof *options,
    .size = sizeof(arguments),
    .run = run,
};
