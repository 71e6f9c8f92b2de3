#include "recipe/arguments.h"

#include <assert.h>
#include <math.h>
#include <stdio.h>
#include <string.h>

static const double LARGEST = 1e9; // of coordinates: squares and cubes stay finite
enum { MOST_POINTS = 1000000, LONGEST_TEXT = 65536, WIDEST = 16 };

// Members that every operator may have besides its fields: "op", which names it, and "note", words of its author.
static bool is_common(const char* key)
{
    return strcmp(key, "op") == 0 || strcmp(key, "note") == 0;
}

static const ax_field* find_field(const ax_operator_type* type, const char* name)
{
    for (int k = 0; k < type->field_count; ++k)
        if (strcmp(type->fields[k].name, name) == 0)
            return &type->fields[k];
    return NULL;
}

static bool in_range(const ax_field* f, double x)
{
    return (f->open ? x > f->lo : x >= f->lo) && x <= f->hi;
}

static void range_words(const ax_field* f, char words[96])
{
    if (isinf(f->lo) && isinf(f->hi))
        *words = 0;
    else if (isinf(f->hi))
        snprintf(words, 96, " %s %.10g", f->open ? "of more than" : "of at least", f->lo);
    else if (isinf(f->lo))
        snprintf(words, 96, " of at most %.10g", f->hi);
    else
        snprintf(words, 96, " %s %.10g %s %.10g", f->open ? "of more than" : "from", f->lo, f->open ? "up to" : "to",
                 f->hi);
}

// A value for messages, as it stands in the file, cut where it is long.
static void value_words(const json_t* value, char words[64])
{
    char* text = json_dumps(value, JSON_ENCODE_ANY | JSON_COMPACT | JSON_REAL_PRECISION(15));
    snprintf(words, 64, "%s", text ? text : "?");
    if (text && strlen(text) > 63) {
        size_t end = 59;
        while (end > 0 && ((unsigned char)words[end] & 0xC0) == 0x80)
            --end;
        strcpy(words + end, "...");
    }
    free(text);
}

static ax_status refuse(const ax_field* f, const json_t* value, const char* expected, ax_error* error)
{
    char words[64];
    value_words(value, words);
    return ax_fail(error, AX_BAD_INPUT, "\"%s\" takes %s, not %s.", f->name, expected, words);
}

static ax_status read_number(const ax_field* f, const json_t* value, double* out, ax_error* error)
{
    char range[96], expected[128];
    range_words(f, range);
    snprintf(expected, sizeof expected, "a number%s", range);
    double x = json_number_value(value);
    if (!json_is_number(value) || !in_range(f, x) || fabs(x) > LARGEST)
        return refuse(f, value, expected, error);
    *out = x;
    return AX_OK;
}

static ax_status read_integer(const ax_field* f, const json_t* value, int* out, ax_error* error)
{
    char range[96], expected[128];
    range_words(f, range);
    snprintf(expected, sizeof expected, "a whole number%s", range);
    if (!json_is_integer(value) || !in_range(f, (double)json_integer_value(value)))
        return refuse(f, value, expected, error);
    *out = (int)json_integer_value(value);
    return AX_OK;
}

static ax_status read_choice(const ax_field* f, const json_t* value, int* out, ax_error* error)
{
    const char* word = json_string_value(value);
    for (int k = 0; word && k < f->choice_count; ++k)
        if (strcmp(word, f->choices[k]) == 0) {
            *out = k;
            return AX_OK;
        }
    char expected[512];
    int used = 0;
    for (int k = 0; k < f->choice_count && used < (int)sizeof expected; ++k)
        used += snprintf(expected + used, sizeof expected - (size_t)used, "%s\"%s\"",
                         k == 0                    ? ""
                         : k + 1 < f->choice_count ? ", "
                                                   : " or ",
                         f->choices[k]);
    return refuse(f, value, expected, error);
}

static ax_status read_text(const ax_field* f, const json_t* value, const char** out, ax_error* error)
{
    if (!json_is_string(value) || !json_string_length(value))
        return refuse(f, value, "a text that is not empty", error);
    if (json_string_length(value) > LONGEST_TEXT)
        return ax_fail(error, AX_BAD_INPUT, "\"%s\" is longer than %d bytes.", f->name, LONGEST_TEXT);
    *out = json_string_value(value);
    return AX_OK;
}

// Element `k` of the array goes to values[k]; false at the first that is no number or too large.
static bool read_numbers(const json_t* array, int count, double* values)
{
    if (!json_is_array(array) || json_array_size(array) != (size_t)count)
        return false;
    for (int k = 0; k < count; ++k) {
        const json_t* value = json_array_get(array, (size_t)k);
        values[k] = json_number_value(value);
        if (!json_is_number(value) || fabs(values[k]) > LARGEST)
            return false;
    }
    return true;
}

static void point_words(int width, char words[64])
{
    static const char* const letters[] = {"[x]", "[x, y]", "[x, y, z]"};
    if (width <= 3)
        snprintf(words, 64, "%s, numbers of at most 1e9", letters[width - 1]);
    else
        snprintf(words, 64, "%d numbers of at most 1e9", width);
}

static ax_status read_vector(const ax_field* f, const json_t* value, double* out, ax_error* error)
{
    double values[WIDEST];
    char expected[64];
    assert(f->width >= 1 && f->width <= WIDEST);
    point_words(f->width, expected);
    if (!read_numbers(value, f->width, values))
        return refuse(f, value, expected, error);
    memcpy(out, values, (size_t)f->width * sizeof *values);
    return AX_OK;
}

static ax_status read_points(const ax_field* f, const json_t* value, ax_arguments* a, ax_points* out, ax_json_path* at,
                             ax_error* error)
{
    char point[64], expected[160];
    int most = f->hi > 0 ? (int)f->hi : MOST_POINTS, fewest = (int)f->lo;
    assert(f->width >= 1 && f->width <= WIDEST);
    point_words(f->width, point);
    size_t count = json_array_size(value);
    if (!json_is_array(value) || count < (size_t)fewest || count > (size_t)most) {
        snprintf(expected, sizeof expected, "a list of %d to %d points, each %s", fewest, most, point);
        return refuse(f, value, expected, error);
    }
    double* values = AX_NEW(double, count*(size_t)f->width);
    a->lists = ax_realloc(a->lists, (size_t)a->list_count + 1, sizeof *a->lists);
    a->lists[a->list_count++] = values;
    for (size_t k = 0; k < count; ++k) {
        const json_t* element = json_array_get(value, k);
        if (!read_numbers(element, f->width, values + k * (size_t)f->width)) {
            at->steps[at->depth++] = (int)k;
            snprintf(expected, sizeof expected, "points, each %s", point);
            return refuse(f, element, expected, error);
        }
    }
    *out = (ax_points){(int)count, values};
    return AX_OK;
}

static ax_status read_field(const ax_field* f, const json_t* value, ax_arguments* a, ax_json_path* at, ax_error* error)
{
    void* into = (char*)a->values + f->offset;
    switch (f->kind) {
    case AX_FIELD_NUMBER:
        return read_number(f, value, into, error);
    case AX_FIELD_INTEGER:
        return read_integer(f, value, into, error);
    case AX_FIELD_FLAG:
        if (!json_is_boolean(value))
            return refuse(f, value, "true or false", error);
        *(bool*)into = json_is_true(value);
        return AX_OK;
    case AX_FIELD_CHOICE:
        return read_choice(f, value, into, error);
    case AX_FIELD_TEXT:
        return read_text(f, value, into, error);
    case AX_FIELD_VECTOR:
        return read_vector(f, value, into, error);
    case AX_FIELD_POINTS:
        return read_points(f, value, a, into, at, error);
    }
    assert(!"a kind of field without a case");
    return AX_FAILED;
}

static ax_status unknown_field(const ax_operator_type* type, const char* key, ax_error* error)
{
    const char* known[64];
    int count = 0;
    known[count++] = "note";
    for (int k = 0; k < type->field_count && count < 64; ++k)
        known[count++] = type->fields[k].name;
    const char* nearest = ax_nearest_word(key, count, known);
    if (nearest)
        return ax_fail(error, AX_BAD_INPUT, "%s has no field \"%.100s\". Did you mean \"%s\"?", type->name, key,
                       nearest);
    return ax_fail(error, AX_BAD_INPUT, "%s has no field \"%.100s\". \"auxshell operators %s\" lists its fields.",
                   type->name, key, type->name);
}

static int member_number(const json_t* object, const char* wanted)
{
    const char* key;
    json_t* value;
    int number = 0;
    json_object_foreach((json_t*)object, key, value)
    {
        if (strcmp(key, wanted) == 0)
            return number;
        ++number;
    }
    return -1;
}

static ax_status find_type(json_t* object, const ax_operator_type** type, ax_json_path* at, ax_error* error)
{
    if (!json_is_object(object))
        return ax_fail(error, AX_BAD_INPUT, "An operator is an object such as {\"op\": \"paint\", ...}.");
    const json_t* op = json_object_get(object, "op");
    const char* name = json_string_value(op);
    if (!op)
        return ax_fail(error, AX_BAD_INPUT, "The operator lacks \"op\", its name. \"auxshell operators\" lists them.");
    at->steps[at->depth++] = member_number(object, "op");
    *type = name ? ax_operator_find(name) : NULL;
    if (*type) {
        --at->depth;
        return AX_OK;
    }
    char words[64];
    value_words(op, words);
    int count;
    const ax_operator_type* const* types = ax_operator_types(&count);
    const char** names = AX_NEW(const char*, count);
    for (int k = 0; k < count; ++k)
        names[k] = types[k]->name;
    const char* nearest = name ? ax_nearest_word(name, count, names) : NULL;
    ax_free(names);
    if (nearest)
        return ax_fail(error, AX_BAD_INPUT, "There is no operator %s. Did you mean \"%s\"?", words, nearest);
    return ax_fail(error, AX_BAD_INPUT, "There is no operator %s. \"auxshell operators\" lists them.", words);
}

static ax_status read_members(json_t* object, ax_arguments* a, ax_json_path* at, ax_error* error)
{
    const char* key;
    json_t* value;
    int number = 0;
    json_object_foreach(object, key, value)
    {
        const ax_field* field = find_field(a->type, key);
        *at = (ax_json_path){.depth = 1, .steps = {number++}};
        if (strcmp(key, "note") == 0 && !json_is_string(value))
            return ax_fail(error, AX_BAD_INPUT, "\"note\" takes a text.");
        at->key = !field;
        if (!field && !is_common(key))
            return unknown_field(a->type, key, error);
        ax_status status = field ? read_field(field, value, a, at, error) : AX_OK;
        if (status != AX_OK)
            return status;
    }
    *at = (ax_json_path){0};
    for (int k = 0; k < a->type->field_count; ++k)
        if (a->type->fields[k].required && !json_object_get(object, a->type->fields[k].name))
            return ax_fail(error, AX_BAD_INPUT, "%s needs \"%s\": %s", a->type->name, a->type->fields[k].name,
                           a->type->fields[k].doc);
    int blamed = -1;
    const char* wrong = a->type->check ? a->type->check(a->values, &blamed) : NULL;
    if (!wrong)
        return AX_OK;
    int member = blamed >= 0 ? member_number(object, a->type->fields[blamed].name) : -1;
    if (member >= 0)
        *at = (ax_json_path){.depth = 1, .steps = {member}};
    return ax_fail(error, AX_BAD_INPUT, "%s: %s", a->type->name, wrong);
}

ax_status ax_arguments_read(json_t* object, ax_arguments* out, ax_json_path* at, ax_error* error)
{
    *out = (ax_arguments){0};
    *at = (ax_json_path){0};
    const ax_operator_type* type = NULL;
    ax_status status = find_type(object, &type, at, error);
    if (status != AX_OK)
        return status;
    *out = (ax_arguments){.type = type, .values = ax_calloc(type->size, 1), .texts = json_incref(object)};
    if (type->defaults)
        type->defaults(out->values);
    status = read_members(object, out, at, error);
    if (status != AX_OK)
        ax_arguments_free(out);
    return status;
}

void ax_arguments_free(ax_arguments* arguments)
{
    for (int k = 0; k < arguments->list_count; ++k)
        ax_free(arguments->lists[k]);
    ax_free(arguments->lists);
    ax_free(arguments->values);
    json_decref(arguments->texts);
    *arguments = (ax_arguments){0};
}
