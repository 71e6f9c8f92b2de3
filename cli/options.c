#include "options.h"

#include <assert.h>
#include <errno.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

const char* const option_units[3] = {"mm", "cm", "m"};

enum { WIDTH = 100, COLUMN = 30 };

static void* place(const command_option* option, void* arguments)
{
    return (char*)arguments + option->offset;
}

static bool parse_number(const char* text, double* value)
{
    char* end;
    *value = strtod(text, &end);
    return end != text && !*end && isfinite(*value);
}

static bool in_range(const command_option* o, double x)
{
    return (o->open ? x > o->lo : x >= o->lo) && x <= o->hi;
}

// "24 to 2000000", "more than 0 Pa"
static void range_words(const command_option* o, char* words, size_t size)
{
    const char* unit = o->unit ? o->unit : "";
    const char* space = o->unit ? " " : "";
    if (isinf(o->hi))
        snprintf(words, size, "%s %.10g%s%s", o->open ? "more than" : "at least", o->lo, space, unit);
    else
        snprintf(words, size, "%.10g to %.10g%s%s", o->lo, o->hi, space, unit);
}

static void choice_words(const command_option* o, const char* separator, const char* last, char* words, size_t size)
{
    size_t used = 0;
    *words = 0;
    for (int k = 0; k < o->choice_count && used < size; ++k)
        used += (size_t)snprintf(words + used, size - used, "%s%s",
                                 k == 0 ? "" : (k == o->choice_count - 1 ? last : separator), o->choices[k]);
}

static ax_status refuse(const command_option* o, const char* text, const char* expected, ax_error* error)
{
    return ax_fail(error, AX_USAGE, "%s takes %s, not \"%s\".", o->name, expected, text);
}

static ax_status parse_value(const command_option* o, const char* text, void* value, ax_error* error)
{
    char range[128], words[256];
    double number, band[2];
    switch (o->kind) {
    case OPTION_FLAG:
        *(bool*)value = true;
        return AX_OK;
    case OPTION_TEXT:
        *(const char**)value = text;
        return *text ? AX_OK : refuse(o, text, "a name that is not empty", error);
    case OPTION_WORDS: {
        word_list* list = value;
        if (list->count == (int)(sizeof list->words / sizeof *list->words))
            return ax_fail(error, AX_USAGE, "\"%s\" is one name too many.", text);
        list->words[list->count++] = text;
        return *text ? AX_OK : refuse(o, text, "names that are not empty", error);
    }
    case OPTION_INTEGER: {
        char* end;
        errno = 0;
        long whole = strtol(text, &end, 10);
        range_words(o, range, sizeof range);
        snprintf(words, sizeof words, "a whole number, %s", range);
        if (end == text || *end || errno || !in_range(o, (double)whole))
            return refuse(o, text, words, error);
        *(int*)value = (int)whole;
        return AX_OK;
    }
    case OPTION_NUMBER:
        range_words(o, range, sizeof range);
        snprintf(words, sizeof words, "a number, %s", range);
        if (!parse_number(text, &number) || !in_range(o, number))
            return refuse(o, text, words, error);
        *(double*)value = number;
        return AX_OK;
    case OPTION_BAND: {
        range_words(o, range, sizeof range);
        snprintf(words, sizeof words, "two numbers %s, the first below the second, both within %s", o->value, range);
        const char* comma = strchr(text, ',');
        char first[64];
        if (!comma || (size_t)(comma - text) >= sizeof first)
            return refuse(o, text, words, error);
        memcpy(first, text, (size_t)(comma - text));
        first[comma - text] = 0;
        if (!parse_number(first, &band[0]) || !parse_number(comma + 1, &band[1]) || !in_range(o, band[0]) ||
            !in_range(o, band[1]) || band[0] >= band[1])
            return refuse(o, text, words, error);
        memcpy(value, band, sizeof band);
        return AX_OK;
    }
    case OPTION_CHOICE:
        for (int k = 0; k < o->choice_count; ++k)
            if (strcmp(text, o->choices[k]) == 0) {
                int chosen = o->first + k;
                memcpy(value, &chosen, sizeof chosen); // the field may be an enum
                return AX_OK;
            }
        choice_words(o, ", ", " or ", words, sizeof words);
        return refuse(o, text, words, error);
    case OPTION_OTHER: {
        const char* expected = o->parse(text, value);
        return expected ? refuse(o, text, expected, error) : AX_OK;
    }
    }
    assert(!"an option kind without a case");
    return AX_FAILED;
}

static const command_option* find_option(const command* c, const char* name, size_t length)
{
    for (int k = 0; k < c->option_count; ++k)
        if (!c->options[k].operand && strlen(c->options[k].name) == length &&
            strncmp(c->options[k].name, name, length) == 0)
            return &c->options[k];
    return NULL;
}

static ax_status unknown_option(const command* c, const char* name, ax_error* error)
{
    const char* known[64];
    int count = 0;
    for (int k = 0; k < c->option_count && count < 64; ++k)
        if (!c->options[k].operand)
            known[count++] = c->options[k].name;
    const char* nearest = ax_nearest_word(name, count, known);
    if (nearest)
        return ax_fail(error, AX_USAGE, "There is no option %s. Did you mean %s?", name, nearest);
    return ax_fail(error, AX_USAGE, "There is no option %s. \"auxshell %s --help\" lists them all.", name, c->name);
}

static const command_option* next_operand(const command* c, int used)
{
    for (int k = 0; k < c->option_count; ++k)
        if (c->options[k].operand && (used-- == 0 || c->options[k].kind == OPTION_WORDS))
            return &c->options[k];
    return NULL;
}

bool command_wants_help(int count, char** words)
{
    for (int k = 0; k < count && strcmp(words[k], "--") != 0; ++k)
        if (strcmp(words[k], "--help") == 0 || strcmp(words[k], "-h") == 0)
            return true;
    return false;
}

ax_status command_parse(const command* c, int count, char** words, void* arguments, ax_error* error)
{
    bool* given = AX_NEW0(bool, c->option_count);
    int operands = 0;
    bool options_ended = false;
    ax_status status = AX_OK;
    memset(arguments, 0, c->size);
    if (c->defaults)
        c->defaults(arguments);
    for (int k = 0; k < count && status == AX_OK; ++k) {
        const char* word = words[k];
        if (!options_ended && strcmp(word, "--") == 0) {
            options_ended = true;
            continue;
        }
        const command_option* option;
        const char* text = word;
        if (options_ended || word[0] != '-' || !word[1]) {
            option = next_operand(c, operands++);
            if (!option) {
                status = ax_fail(error, AX_USAGE, "\"%s\" is one name too many.", word);
                break;
            }
        } else {
            const char* equals = strncmp(word, "--", 2) == 0 ? strchr(word, '=') : NULL;
            size_t length = equals ? (size_t)(equals - word) : strlen(word);
            option = find_option(c, word, length);
            if (!option) {
                char name[128];
                snprintf(name, sizeof name, "%.*s", (int)length, word);
                status = unknown_option(c, name, error);
                break;
            }
            if (option->kind == OPTION_FLAG && equals)
                status = ax_fail(error, AX_USAGE, "%s takes no value.", option->name);
            else if (equals)
                text = equals + 1;
            else if (option->kind != OPTION_FLAG) {
                text = k + 1 < count ? words[++k] : NULL;
                if (!text || strncmp(text, "--", 2) == 0 || find_option(c, text, strlen(text)))
                    status =
                        ax_fail(error, AX_USAGE, "%s needs a value: %s %s.", option->name, option->name, option->value);
            }
        }
        if (status == AX_OK)
            status = parse_value(option, text, place(option, arguments), error);
        given[option - c->options] = true;
    }
    for (int k = 0; k < c->option_count && status == AX_OK; ++k) {
        const command_option* o = &c->options[k];
        if (o->required && !given[k])
            status = ax_fail(error, AX_USAGE, "%s%s%s is missing. Usage: \"auxshell %s --help\".", o->name,
                             o->operand ? "" : " ", o->operand ? "" : o->value, c->name);
        const command_option* other = o->excludes ? find_option(c, o->excludes, strlen(o->excludes)) : NULL;
        if (other && given[k] && given[other - c->options])
            status = ax_fail(error, AX_USAGE, "%s and %s cannot be given together.", o->name, other->name);
    }
    ax_free(given);
    return status;
}

void print_wrapped(FILE* out, int column, int indent, const char* text)
{
    bool first_in_line = true;
    while (*text) {
        int length = (int)strcspn(text, " \n");
        if (!first_in_line && column + 1 + length > WIDTH) {
            fprintf(out, "\n%*s", indent, "");
            column = indent;
            first_in_line = true;
        }
        column += fprintf(out, "%s%.*s", first_in_line ? "" : " ", length, text);
        first_in_line = false;
        text += length;
        for (; *text == '\n'; ++text) {
            fprintf(out, "\n%*s", text[1] && text[1] != '\n' ? indent : 0, "");
            column = indent;
            first_in_line = true;
        }
        text += strspn(text, " ");
    }
    putc('\n', out);
}

// "--scale LO,HI", "--json", "TARGET"
static void option_heading(const command_option* o, char* words, size_t size)
{
    char choices[128];
    const char* value = o->value ? o->value : "";
    if (o->kind == OPTION_CHOICE) {
        choice_words(o, "|", "|", choices, sizeof choices);
        value = choices;
    }
    snprintf(words, size, "%s%s%s", o->name, *value ? " " : "", value);
}

static void default_words(const command* c, const command_option* o, char* words, size_t size)
{
    *words = 0;
    if (o->fallback) {
        snprintf(words, size, "%s", o->fallback);
        return;
    }
    void* arguments = ax_calloc(c->size, 1);
    if (c->defaults)
        c->defaults(arguments);
    const void* value = place(o, arguments);
    if (o->kind == OPTION_INTEGER)
        snprintf(words, size, "%d", *(const int*)value);
    else if (o->kind == OPTION_NUMBER)
        snprintf(words, size, "%.10g", *(const double*)value);
    else if (o->kind == OPTION_BAND)
        snprintf(words, size, "%.10g,%.10g", ((const double*)value)[0], ((const double*)value)[1]);
    else if (o->kind == OPTION_CHOICE) {
        int chosen;
        memcpy(&chosen, value, sizeof chosen);
        snprintf(words, size, "%s", o->choices[chosen - o->first]);
    }
    ax_free(arguments);
}

// The option's sentences with its range and default.
static void option_words(const command* c, const command_option* o, char* words, size_t size)
{
    char range[128] = "", fallback[128];
    if (o->kind == OPTION_INTEGER || o->kind == OPTION_NUMBER)
        range_words(o, range, sizeof range);
    default_words(c, o, fallback, sizeof fallback);
    bool bracket = *range || *fallback;
    snprintf(words, size, "%s%s%s%s%s%s%s", o->text, bracket ? " (" : "", range, *range && *fallback ? "; " : "",
             *fallback ? "default " : "", fallback, bracket ? ")" : "");
}

static void usage_words(const command* c, char* words, size_t size)
{
    size_t used = (size_t)snprintf(words, size, "auxshell %s", c->name);
    bool more = false;
    for (int k = 0; k < c->option_count && used < size; ++k) {
        const command_option* o = &c->options[k];
        char heading[160];
        option_heading(o, heading, sizeof heading);
        if (o->required)
            used += (size_t)snprintf(words + used, size - used, " %s", heading);
        else if (o->operand)
            used += (size_t)snprintf(words + used, size - used, " [%s]", heading);
        else
            more = true;
    }
    if (more && used < size)
        snprintf(words + used, size - used, " [options]");
}

static void print_help_row(const char* name, const char* text, FILE* out)
{
    int used = fprintf(out, "  %s", name);
    if (used > COLUMN - 2) {
        putc('\n', out);
        used = 0;
    }
    fprintf(out, "%*s", COLUMN - used, "");
    print_wrapped(out, COLUMN, COLUMN, text);
}

static void print_options(const command* c, list_row row, FILE* out)
{
    char heading[160], words[1024];
    for (int k = 0; k < c->option_count; ++k) {
        option_heading(&c->options[k], heading, sizeof heading);
        option_words(c, &c->options[k], words, sizeof words);
        row(heading, words, out);
    }
}

void command_print_help(const command* c, FILE* out)
{
    char words[1024];
    usage_words(c, words, sizeof words);
    fprintf(out, "usage: %s\n\n", words);
    print_wrapped(out, 0, 0, c->text);
    putc('\n', out);
    print_options(c, print_help_row, out);
    if (c->list) {
        fprintf(out, "\n%s:\n", c->list_title);
        c->list(print_help_row, out);
    }
}

static void print_cell(const char* text, FILE* out)
{
    for (; *text; ++text)
        fprintf(out, *text == '|' ? "\\|" : "%c", *text);
}

static void print_reference_row(const char* name, const char* text, FILE* out)
{
    fputs("| `", out);
    print_cell(name, out);
    fputs("` | ", out);
    print_cell(text, out);
    fputs(" |\n", out);
}

void command_print_reference(const command* c, FILE* out)
{
    char words[1024];
    usage_words(c, words, sizeof words);
    fprintf(out, "## %s\n\n    %s\n\n%s\n\n| | |\n|---|---|\n", c->name, words, c->text);
    print_options(c, print_reference_row, out);
    if (c->list) {
        fprintf(out, "\n%s:\n\n| | |\n|---|---|\n", c->list_title);
        c->list(print_reference_row, out);
    }
}
