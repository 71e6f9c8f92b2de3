#include "ax/recipe.h"

#include "base/file.h"
#include "input/bytes.h"
#include "recipe/arguments.h"
#include "recipe/writing.h"

#include <assert.h>
#include <errno.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { VERSION = 1, MOST_OPERATORS = 100000 };
static const size_t MOST_BYTES = (size_t)256 << 20;

typedef struct item {
    const ax_operator_type* type;
    char* json;
} item;

struct ax_recipe {
    int count, capacity;
    item* items;
    char* note; // of the whole, NULL: none
    bool based; // goes on from a form: nothing in it starts one
};

ax_recipe* ax_recipe_make(void)
{
    return AX_NEW0(ax_recipe, 1);
}

ax_recipe* ax_recipe_make_based(void)
{
    ax_recipe* recipe = ax_recipe_make();
    recipe->based = true;
    return recipe;
}

void ax_recipe_free(ax_recipe* recipe)
{
    if (!recipe)
        return;
    for (int k = 0; k < recipe->count; ++k)
        ax_free(recipe->items[k].json);
    ax_free(recipe->items);
    ax_free(recipe->note);
    ax_free(recipe);
}

int ax_recipe_count(const ax_recipe* recipe)
{
    return recipe->count;
}

const char* ax_recipe_operator(const ax_recipe* recipe, int k)
{
    assert(k >= 0 && k < recipe->count);
    return recipe->items[k].json;
}

const ax_operator_type* ax_recipe_type(const ax_recipe* recipe, int k)
{
    assert(k >= 0 && k < recipe->count);
    return recipe->items[k].type;
}

// ---- reading -----------------------------------------------------------------------------------------------------------------

// What is being read, for the places in messages.
typedef struct source {
    const char *text, *name; // name: of the file, NULL: none
} source;

static ax_status fail_at(const source* from, int line, int column, ax_status status, const char* words, ax_error* error)
{
    if (from->name)
        return ax_fail(error, status, "%s, line %d, column %d: %s", from->name, line, column, words);
    return ax_fail(error, status, "Line %d, column %d: %s", line, column, words);
}

static ax_status fail_in(const source* from, const ax_json_path* path, const char* words, ax_error* error)
{
    ax_json_place place = ax_json_find(from->text, path);
    return fail_at(from, place.line, place.column, AX_BAD_INPUT, words, error);
}

static ax_status load_json(const source* from, json_t** out, ax_error* error)
{
    json_error_t wrong;
    *out = json_loads(from->text, JSON_REJECT_DUPLICATES, &wrong);
    if (*out)
        return AX_OK;
    char words[256];
    snprintf(words, sizeof words, "this is no JSON: %s.", wrong.text);
    return fail_at(from, wrong.line > 0 ? wrong.line : 1, wrong.column > 0 ? wrong.column : 1, AX_BAD_INPUT, words,
                   error);
}

static char* text_of(const json_t* object)
{
    ax_text text = {0};
    ax_text_add_json(&text, object);
    return text.bytes;
}

// A place that an operator takes in the recipe: starts stand first and nowhere else.
static ax_status check_order(const ax_recipe* recipe, const ax_operator_type* type, int k, ax_error* error)
{
    if (recipe->based && type->starts)
        return ax_fail(error, AX_BAD_INPUT, "%s starts a design, but this one goes on from a finished design.",
                       type->name);
    if (k == 0 && !type->starts && !recipe->based)
        return ax_fail(error, AX_BAD_INPUT,
                       "%s needs a design to work on: the first operator must be one that starts a design, such as "
                       "start_circle.",
                       type->name);
    if (k > 0 && type->starts)
        return ax_fail(error, AX_BAD_INPUT, "%s starts a design, so it can only be the first operator.", type->name);
    return AX_OK;
}

// One operator at place k; `at` is where its message belongs, relative to it.
static ax_status read_item(const ax_recipe* recipe, json_t* object, int k, item* out, ax_json_path* at, ax_error* error)
{
    ax_arguments arguments;
    ax_status status = ax_arguments_read(object, &arguments, at, error);
    if (status != AX_OK)
        return status;
    status = check_order(recipe, arguments.type, k, error);
    if (status == AX_OK)
        *out = (item){arguments.type, text_of(object)};
    ax_arguments_free(&arguments);
    return status;
}

static void put_item(ax_recipe* recipe, int k, item it)
{
    if (recipe->count == recipe->capacity) {
        recipe->capacity = 2 * recipe->capacity + 8;
        recipe->items = ax_realloc(recipe->items, (size_t)recipe->capacity, sizeof *recipe->items);
    }
    memmove(recipe->items + k + 1, recipe->items + k, (size_t)(recipe->count - k) * sizeof *recipe->items);
    recipe->items[k] = it;
    ++recipe->count;
}

static ax_status read_operators(const source* from, int member, const json_t* list, ax_recipe* recipe, ax_error* error)
{
    ax_json_path path = {.depth = 1, .steps = {member}};
    if (!json_is_array(list))
        return fail_in(from, &path, "\"operators\" takes a list of operators.", error);
    if (json_array_size(list) > MOST_OPERATORS)
        return fail_in(from, &path, "a recipe holds at most 100000 operators.", error);
    for (size_t k = 0; k < json_array_size(list); ++k) {
        item it;
        ax_json_path at = {0};
        ax_error inner = {0};
        if (read_item(recipe, json_array_get(list, k), (int)k, &it, &at, &inner) != AX_OK) {
            path = (ax_json_path){
                .depth = 2 + at.depth, .steps = {member, (int)k, at.steps[0], at.steps[1]}, .key = at.key};
            return fail_in(from, &path, inner.message, error);
        }
        put_item(recipe, recipe->count, it);
    }
    return AX_OK;
}

static ax_status read_member(const source* from, int number, const char* key, const json_t* value, ax_recipe* recipe,
                             ax_error* error)
{
    static const char* const known[] = {"format", "version", "note", "operators"};
    ax_json_path path = {.depth = 1, .steps = {number}};
    char words[512];
    if (strcmp(key, "operators") == 0)
        return read_operators(from, number, value, recipe, error);
    if (strcmp(key, "format") == 0) {
        const char* format = json_string_value(value);
        return format && strcmp(format, "auxshell-recipe") == 0
                   ? AX_OK
                   : fail_in(from, &path, "\"format\" must be \"auxshell-recipe\": this is another kind of file.",
                             error);
    }
    if (strcmp(key, "version") == 0) {
        if (json_is_integer(value) && json_integer_value(value) == VERSION)
            return AX_OK;
        snprintf(words, sizeof words, "\"version\" must be %d%s", VERSION,
                 json_is_integer(value) && json_integer_value(value) > VERSION
                     ? ": the recipe was written by a newer Auxshell. Use that one."
                     : ".");
        return fail_in(from, &path, words, error);
    }
    if (strcmp(key, "note") == 0) {
        if (!json_is_string(value))
            return fail_in(from, &path, "\"note\" takes a text.", error);
        recipe->note = ax_copy(json_string_value(value), json_string_length(value) + 1, 1);
        return AX_OK;
    }
    path.key = true;
    const char* nearest = ax_nearest_word(key, sizeof known / sizeof *known, known);
    snprintf(words, sizeof words, "a recipe has no field \"%.100s\". %s%s%s", key,
             nearest ? "Did you mean \"" : "Its fields are \"format\", \"version\", \"note\" and \"operators",
             nearest ? nearest : "", nearest ? "\"?" : "\".");
    return fail_in(from, &path, words, error);
}

static ax_status read_root(const source* from, json_t* root, ax_recipe* recipe, ax_error* error)
{
    static const char* const needed[] = {"format", "version", "operators"};
    ax_json_path top = {0};
    if (!json_is_object(root))
        return fail_in(from, &top, "a recipe is an object: {\"format\": \"auxshell-recipe\", \"version\": 1, ...}.",
                       error);
    const char* key;
    json_t* value;
    int number = 0;
    json_object_foreach(root, key, value)
    {
        ax_status status = read_member(from, number++, key, value, recipe, error);
        if (status != AX_OK)
            return status;
    }
    for (size_t k = 0; k < sizeof needed / sizeof *needed; ++k)
        if (!json_object_get(root, needed[k])) {
            char words[128];
            snprintf(words, sizeof words, "the recipe lacks \"%s\".", needed[k]);
            return fail_in(from, &top, words, error);
        }
    return AX_OK;
}

static ax_status parse(const source* from, ax_recipe** out, ax_error* error)
{
    *out = NULL;
    json_t* root;
    ax_status status = load_json(from, &root, error);
    if (status != AX_OK)
        return status;
    ax_recipe* recipe = ax_recipe_make();
    status = read_root(from, root, recipe, error);
    json_decref(root);
    if (status == AX_OK)
        *out = recipe;
    else
        ax_recipe_free(recipe);
    return status;
}

ax_status ax_recipe_parse(const char* text, ax_recipe** out, ax_error* error)
{
    return parse(&(source){.text = text}, out, error);
}

ax_status ax_recipe_read(const char* path, ax_recipe** out, ax_error* error)
{
    char* text;
    size_t size;
    *out = NULL;
    ax_status status = ax_bytes_read(path, "a recipe", MOST_BYTES, &text, &size, error);
    if (status != AX_OK)
        return status;
    const source from = {text, path};
    if (strlen(text) == size)
        status = parse(&from, out, error);
    else
        status =
            ax_fail(error, AX_BAD_INPUT, "%s is no recipe: it holds zero bytes. Recipes are JSON text in UTF-8.", path);
    ax_free(text);
    return status;
}

// ---- writing -----------------------------------------------------------------------------------------------------------------

char* ax_recipe_text(const ax_recipe* recipe)
{
    ax_text text = {0};
    char head[80];
    snprintf(head, sizeof head, "{\n  \"format\": \"auxshell-recipe\",\n  \"version\": %d,\n", VERSION);
    ax_text_say(&text, head);
    if (recipe->note) {
        json_t* note = json_string(recipe->note);
        ax_text_say(&text, "  \"note\": ");
        ax_text_add_json(&text, note);
        ax_text_say(&text, ",\n");
        json_decref(note);
    }
    ax_text_say(&text, "  \"operators\": [");
    for (int k = 0; k < recipe->count; ++k) {
        ax_text_say(&text, k ? ",\n    " : "\n    ");
        ax_text_say(&text, recipe->items[k].json);
    }
    ax_text_say(&text, recipe->count ? "\n  ]\n}\n" : "]\n}\n");
    return text.bytes;
}

ax_status ax_recipe_write(const ax_recipe* recipe, const char* path, ax_error* error)
{
    ax_file file;
    ax_status status = ax_file_begin(&file, path, error);
    if (status != AX_OK)
        return status;
    char* text = ax_recipe_text(recipe);
    fputs(text, file.stream);
    ax_free(text);
    return ax_file_commit(&file, error);
}

// Bytes of a text that fit, whole characters of UTF-8.
static size_t whole_characters(const char* text, size_t most)
{
    size_t length = strlen(text);
    if (length <= most)
        return length;
    while (most > 0 && ((unsigned char)text[most] & 0xC0) == 0x80)
        --most;
    return most;
}

// "0.3 m", "12 points", "rim/3"
static void value_words(const ax_field* field, const json_t* value, const char* length_unit, char words[80])
{
    const char* unit = strcmp(field->unit, "length") == 0 ? length_unit : field->unit;
    const char* space = *unit ? " " : "";
    int used = 0;
    switch (field->kind) {
    case AX_FIELD_NUMBER:
    case AX_FIELD_INTEGER:
        snprintf(words, 80, "%.5g%s%s", json_number_value(value), space, unit);
        return;
    case AX_FIELD_POINTS:
        snprintf(words, 80, "%zu point%s", json_array_size(value), json_array_size(value) == 1 ? "" : "s");
        return;
    case AX_FIELD_VECTOR:
        for (size_t k = 0; k < json_array_size(value) && used < 64; ++k)
            used += snprintf(words + used, 80 - (size_t)used, "%s%.4g", k ? ", " : "(",
                             json_number_value(json_array_get(value, k)));
        snprintf(words + used, 80 - (size_t)used, ")%s%s", space, unit);
        return;
    case AX_FIELD_FLAG:
        snprintf(words, 80, "%s", json_is_true(value) ? "yes" : "no");
        return;
    case AX_FIELD_CHOICE:
    case AX_FIELD_TEXT:
        snprintf(words, 80, "%.*s", (int)whole_characters(json_string_value(value), 79), json_string_value(value));
    }
}

void ax_recipe_words(const ax_recipe* recipe, int k, char text[160])
{
    const ax_operator_type* type = ax_recipe_type(recipe, k);
    json_t* first = json_loads(recipe->items[0].json, 0, NULL);
    json_t* object = json_loads(recipe->items[k].json, 0, NULL);
    const char* unit = json_string_value(json_object_get(first, "unit"));
    size_t used = (size_t)snprintf(text, 160, "%s", type->title);
    bool any = false;
    for (int f = 0; f < type->field_count; ++f) {
        const ax_field* field = &type->fields[f];
        const json_t* value = json_object_get(object, field->name);
        char words[80], piece[160];
        if (!value)
            continue;
        value_words(field, value, unit ? unit : "m", words);
        bool plain = field->kind == AX_FIELD_TEXT || field->kind == AX_FIELD_CHOICE;
        snprintf(piece, sizeof piece, "%s%s%s%s", any ? ", " : ": ", plain ? "" : field->name, plain ? "" : " ", words);
        size_t fits = whole_characters(piece, 159 - used);
        memcpy(text + used, piece, fits);
        text[used += fits] = 0;
        any = true;
    }
    json_decref(first);
    json_decref(object);
}

// ---- editing -----------------------------------------------------------------------------------------------------------------

static ax_status read_one(const ax_recipe* recipe, const char* json, int k, item* out, ax_error* error)
{
    const source from = {.text = json};
    json_t* object;
    ax_json_path at = {0};
    ax_error inner = {0};
    ax_status status = load_json(&from, &object, error);
    if (status != AX_OK)
        return status;
    status = read_item(recipe, object, k, out, &at, &inner);
    json_decref(object);
    return status == AX_OK ? AX_OK : fail_in(&from, &at, inner.message, error);
}

ax_status ax_recipe_insert(ax_recipe* recipe, int k, const char* json, ax_error* error)
{
    assert(k >= 0 && k <= recipe->count);
    if (recipe->count == MOST_OPERATORS)
        return ax_fail(error, AX_USAGE, "A recipe holds at most %d operators.", MOST_OPERATORS);
    item it;
    ax_status status = read_one(recipe, json, k, &it, error);
    if (status != AX_OK)
        return status;
    if (k == 0 && recipe->count && recipe->items[0].type->starts) {
        ax_free(it.json);
        return ax_fail(error, AX_BAD_INPUT, "%s starts the design already. Replace it instead.",
                       recipe->items[0].type->name);
    }
    put_item(recipe, k, it);
    return AX_OK;
}

ax_status ax_recipe_replace(ax_recipe* recipe, int k, const char* json, ax_error* error)
{
    assert(k >= 0 && k < recipe->count);
    item it;
    ax_status status = read_one(recipe, json, k, &it, error);
    if (status != AX_OK)
        return status;
    ax_free(recipe->items[k].json);
    recipe->items[k] = it;
    return AX_OK;
}

void ax_recipe_remove(ax_recipe* recipe, int k)
{
    assert(k >= 0 && k < recipe->count);
    ax_free(recipe->items[k].json);
    --recipe->count;
    memmove(recipe->items + k, recipe->items + k + 1, (size_t)(recipe->count - k) * sizeof *recipe->items);
}
