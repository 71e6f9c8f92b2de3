// Recipes as text: what is read, what is refused and where, what is written. Playing them is tested in test_operator.
#include "ax/recipe.h"

#include "recipe/place.h"
#include "support/test.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#define HEAD  "{\"format\": \"auxshell-recipe\", \"version\": 1, \"operators\": ["
#define START "{\"op\": \"start_circle\", \"radius\": 1}"

static void expect_refusal(const char* text, int line, int column, const char* words)
{
    ax_recipe* recipe = (ax_recipe*)&recipe;
    ax_error error = {0};
    char place[64];
    ax_status status = ax_recipe_parse(text, &recipe, &error);
    if (status != AX_BAD_INPUT)
        print_error("not refused: %s\n", text);
    assert_int_equal(status, AX_BAD_INPUT);
    assert_null(recipe);
    if (column) // else the parser's own, wherever in the word it noticed
        snprintf(place, sizeof place, "Line %d, column %d: ", line, column);
    else
        snprintf(place, sizeof place, "Line %d, column ", line);
    if (strncmp(error.message, place, strlen(place)) != 0 || !strstr(error.message, words))
        print_error("wanted %s...%s...\n   got %s\n", place, words, error.message);
    assert_memory_equal(error.message, place, strlen(place));
    assert_non_null(strstr(error.message, words));
    assert_non_null(strchr(".?", error.message[strlen(error.message) - 1]));
}

static void what_is_wrong_is_named_with_its_place(void** state)
{
    (void)state;
    const struct {
        const char *text, *words;
        int line, column;
    } cases[] = {
        {"", "no JSON", 1, 0},
        {"[]", "an object", 1, 1},
        {"nonsense", "no JSON", 1, 0},
        {"{\"format\": \"auxshell-design\", \"version\": 1, \"operators\": []}", "another kind of file", 1, 12},
        {"{\"format\": \"auxshell-recipe\", \"version\": 2, \"operators\": []}", "newer", 1, 42},
        {"{\"format\": \"auxshell-recipe\", \"version\": \"1\", \"operators\": []}", "must be 1", 1, 42},
        {"{\"format\": \"auxshell-recipe\", \"version\": 1}", "lacks \"operators\"", 1, 1},
        {"{\"format\": \"auxshell-recipe\", \"version\": 1, \"operators\": {}}", "takes a list", 1, 58},
        {"{\"format\": \"auxshell-recipe\", \"version\": 1, \"version\": 1}", "duplicate", 1, 0},
        {"{\"format\": \"auxshell-recipe\",\n \"verzion\": 1}", "Did you mean \"version\"", 2, 2},
        {HEAD "7]}", "is an object such as", 1, 59},
        {HEAD "{}]}", "lacks \"op\"", 1, 59},
        {HEAD "{\"op\": 3}]}", "no operator 3", 1, 66},
        {HEAD "\n{\"op\": \"start_circel\"}]}", "Did you mean \"start_circle\"", 2, 8},
        {HEAD "\n{\"op\": \"fill\", \"value\": 1.5}]}", "first operator", 2, 1},
        {HEAD "\n" START ",\n " START "]}", "only be the first", 3, 2},
        {HEAD "\n{\"op\": \"start_circle\"}]}", "needs \"radius\"", 2, 1},
        {HEAD "\n{\"op\": \"start_circle\", \"radus\": 1}]}", "Did you mean \"radius\"", 2, 24},
        {HEAD "\n{\"op\": \"start_circle\", \"colour\": 1}]}", "auxshell operators start_circle", 2, 24},
        {HEAD "\n{\"op\": \"start_circle\", \"radius\": 0}]}", "a number of more than 0", 2, 34},
        {HEAD "\n{\"op\": \"start_circle\", \"radius\": 1e10}]}", "not 10000000000", 2, 34},
        {HEAD "\n{\"op\": \"start_circle\", \"radius\": 1e999}]}", "no JSON", 2, 0},
        {HEAD "\n{\"op\": \"start_circle\", \"radius\": \"1\"}]}", "not \"1\"", 2, 34},
        {HEAD "\n{\"op\": \"start_circle\", \"radius\": null}]}", "not null", 2, 34},
        {HEAD "\n{\"op\": \"start_circle\", \"radius\": 1, \"triangles\": 600.5}]}", "a whole number", 2, 50},
        {HEAD "\n{\"op\": \"start_circle\", \"radius\": 1, \"triangles\": 99999999999}]}", "from 12 to 2000000", 2, 50},
        {HEAD "\n{\"op\": \"start_circle\", \"radius\": 1, \"inside\": 1}]}", "true or false", 2, 47},
        {HEAD "\n{\"op\": \"start_circle\", \"radius\": 1, \"unit\": \"ft\"}]}", "\"mm\", \"cm\" or \"m\"", 2, 45},
        {HEAD "\n{\"op\": \"start_circle\", \"radius\": 1, \"centre\": [0]}]}", "[x, y]", 2, 47},
        {HEAD "\n{\"op\": \"start_circle\", \"radius\": 1, \"note\": 3}]}", "\"note\" takes a text", 2, 45},
        {HEAD "\n{\"op\": \"start_circle\", \"radius\": 1, \"radius\": 2}]}", "duplicate", 2, 0},
        {HEAD START ",\n{\"op\": \"paint\", \"radius\": 1, \"value\": 1.5, \"points\": [[0, 0], [1]]}]}", "[x, y]", 2,
         63},
        {HEAD START ",\n{\"op\": \"paint\", \"radius\": 1, \"value\": 1.5, \"points\": []}]}", "a list of 1 to", 2, 54},
        {HEAD START ",\n{\"op\": \"paint\", \"radius\": 1, \"points\": [[0, 0]]}]}", "\"value\" is needed", 2, 1},
        {HEAD START ",\n{\"op\": \"paint\", \"value\": 0.5, \"radius\": 1, \"points\": [[0, 0]]}]}", "1 to 2", 2, 26},
        {HEAD START ",\n{\"op\": \"clamp\", \"lo\": 1.5, \"hi\": 1.2}]}", "must not be less", 2, 34},
        {HEAD START ",\n{\"op\": \"formula\", \"formula\": \"\"}]}", "not empty", 2, 30},
        // characters, not bytes; and a key that is written with escapes
        {HEAD START ",\n{\"note\": \"größer\", \"op\": \"fill\", \"value\": 3}]}", "from 1 to 2", 2, 43},
        {HEAD START ",\n{\"op\": \"fill\", \"v\\u0061lue\": 1.5, \"a\\\"}[,\": 1}]}", "no field", 2, 35},
    };
    for (size_t k = 0; k < sizeof cases / sizeof *cases; ++k)
        expect_refusal(cases[k].text, cases[k].line, cases[k].column, cases[k].words);
}

static void places_are_found_in_any_layout(void** state)
{
    (void)state;
    const char text[] = "\n { \"a\" : [ 1 , {\"b\": \"}]\\\"\", \"c\" :\t[[],{} , 5]} ],\r\n\"d\":-1.5e3}";
    const struct {
        ax_json_path path;
        int line, column;
    } cases[] = {
        {{.depth = 0}, 2, 2},
        {{.depth = 1, .steps = {0}, .key = true}, 2, 4},
        {{.depth = 1, .steps = {0}}, 2, 10},
        {{.depth = 2, .steps = {0, 0}}, 2, 12},
        {{.depth = 2, .steps = {0, 1}}, 2, 16},
        {{.depth = 3, .steps = {0, 1, 0}, .key = true}, 2, 17},
        {{.depth = 3, .steps = {0, 1, 0}}, 2, 22},
        {{.depth = 3, .steps = {0, 1, 1}}, 2, 36},
        {{.depth = 4, .steps = {0, 1, 1, 2}}, 2, 45},
        {{.depth = 1, .steps = {1}, .key = true}, 3, 1},
        {{.depth = 1, .steps = {1}}, 3, 5},
    };
    for (size_t k = 0; k < sizeof cases / sizeof *cases; ++k) {
        ax_json_place place = ax_json_find(text, &cases[k].path);
        assert_int_equal(place.line, cases[k].line);
        assert_int_equal(place.column, cases[k].column);
    }
}

static ax_recipe* parse(const char* text)
{
    ax_recipe* recipe;
    ax_error error = {0};
    if (ax_recipe_parse(text, &recipe, &error) != AX_OK)
        fail_msg("%s", error.message);
    return recipe;
}

static void text_reads_back_to_the_same_recipe(void** state)
{
    (void)state;
    ax_recipe* recipe =
        parse("{\"operators\": [{\"radius\": 0.1, \"op\": \"start_circle\", \"note\": \"Größe \\\"1\\\"\\n\"}, "
              "{\"op\": \"paint\", \"points\": [[0.30000000000000004, 1e-300], [1, 2.0]], \"radius\": 1e5, "
              "\"value\": 1.1}], \"note\": \"two\", \"version\": 1, \"format\": \"auxshell-recipe\"}");
    char* text = ax_recipe_text(recipe);
    assert_string_equal(
        text, "{\n  \"format\": \"auxshell-recipe\",\n  \"version\": 1,\n  \"note\": \"two\",\n"
              "  \"operators\": [\n"
              "    {\"radius\": 0.1, \"op\": \"start_circle\", \"note\": \"Größe \\\"1\\\"\\n\"},\n"
              "    {\"op\": \"paint\", \"points\": [[0.30000000000000004, 1e-300], [1, 2.0]], \"radius\": 100000.0, "
              "\"value\": 1.1}\n  ]\n}\n");
    ax_recipe* again = parse(text);
    char* text_again = ax_recipe_text(again);
    assert_string_equal(text, text_again);
    assert_int_equal(ax_recipe_count(again), 2);
    assert_string_equal(ax_recipe_type(again, 1)->name, "paint");
    ax_free(text);
    ax_free(text_again);
    ax_recipe_free(recipe);
    ax_recipe_free(again);
}

static void a_recipe_is_edited_by_operators(void** state)
{
    (void)state;
    ax_recipe* recipe = ax_recipe_make();
    ax_error error = {0};
    assert_int_equal(ax_recipe_insert(recipe, 0, "{\"op\": \"fill\", \"value\": 1.2}", &error), AX_BAD_INPUT);
    assert_non_null(strstr(error.message, "first operator"));
    assert_int_equal(ax_recipe_insert(recipe, 0, START, &error), AX_OK);
    assert_int_equal(ax_recipe_insert(recipe, 0, START, &error), AX_BAD_INPUT);
    assert_int_equal(ax_recipe_insert(recipe, 1, START, &error), AX_BAD_INPUT);
    assert_int_equal(ax_recipe_insert(recipe, 1, "{\"op\": \"fill\", \"value\": 1.2}", &error), AX_OK);
    assert_int_equal(ax_recipe_insert(recipe, 1, "{\"op\": \"expand\"}", &error), AX_OK);
    assert_int_equal(ax_recipe_insert(recipe, 1, "{\"op\": \"fill\", \"value\": 12}", &error), AX_BAD_INPUT);
    assert_memory_equal(error.message, "Line 1, column 25: ", 19);
    assert_int_equal(ax_recipe_replace(recipe, 2, "{\"op\": \"fill\", \"value\": 1.7}", &error), AX_OK);
    assert_int_equal(ax_recipe_replace(recipe, 0, "{\"op\": \"fill\", \"value\": 1.7}", &error), AX_BAD_INPUT);
    assert_int_equal(ax_recipe_count(recipe), 3);
    assert_string_equal(ax_recipe_operator(recipe, 2), "{\"op\": \"fill\", \"value\": 1.7}");
    ax_recipe_remove(recipe, 1);
    assert_int_equal(ax_recipe_count(recipe), 2);
    assert_string_equal(ax_recipe_type(recipe, 1)->name, "fill");
    ax_recipe_free(recipe);
}

static void words_tell_an_operator_in_one_line(void** state)
{
    (void)state;
    ax_recipe* recipe =
        parse(HEAD "{\"op\": \"start_circle\", \"radius\": 2.5, \"unit\": \"mm\", \"note\": \"hidden\"},"
                   "{\"op\": \"expand\"},"
                   "{\"op\": \"paint\", \"points\": [[0, 0], [1, 0]], \"radius\": 0.25, \"value\": 1.6},"
                   "{\"op\": \"fill\", \"value\": 1.6, \"hinges\": \"ääääääääääääääääääääääääääääääääääääää"
                   "ääääääääääääääääääääääääääääääääääääääääääääääääääääääääääää\"}]}");
    char words[160];
    ax_recipe_words(recipe, 0, words);
    assert_string_equal(words, "Start from a circle: radius 2.5 mm, mm");
    ax_recipe_words(recipe, 1, words);
    assert_string_equal(words, "Expand");
    ax_recipe_words(recipe, 2, words);
    assert_string_equal(words, "Paint: value 1.6, points 2 points, radius 0.25 mm");
    ax_recipe_words(recipe, 3, words);
    assert_true(strlen(words) < 160 && strlen(words) > 80);
    assert_int_equal((words[strlen(words) - 2] & 0xFF), 0xC3); // ends with a whole letter
    ax_recipe_free(recipe);
}

static void every_operator_has_a_whole_schema(void** state)
{
    (void)state;
    static const char* const groups[] = {"start",      "scale",     "boundary", "dynamics",
                                         "constraint", "selection", "site",     "finish"};
    int count;
    const ax_operator_type* const* types = ax_operator_types(&count);
    assert_true(count >= 40);
    for (int k = 0; k < count; ++k) {
        const ax_operator_type* t = types[k];
        bool known = false;
        for (size_t g = 0; g < sizeof groups / sizeof *groups; ++g)
            known |= strcmp(t->group, groups[g]) == 0;
        assert_true(known);
        assert_ptr_equal(ax_operator_find(t->name), t);
        assert_true(k == 0 || strcmp(types[k - 1]->name, t->name) < 0);
        assert_true(strlen(t->title) > 3 && t->doc[strlen(t->doc) - 1] == '.' && t->apply);
        assert_int_equal(t->starts, strcmp(t->group, "start") == 0);
        unsigned char* a = ax_calloc(t->size, 1);
        if (t->defaults)
            t->defaults(a);
        for (int f = 0; f < t->field_count; ++f) {
            const ax_field* field = &t->fields[f];
            assert_true(strlen(field->name) > 0 && strlen(field->title) > 0 && field->unit);
            assert_true(field->doc && field->doc[strlen(field->doc) - 1] == '.');
            assert_true(strcmp(field->name, "op") != 0 && strcmp(field->name, "note") != 0);
            for (int g = 0; g < f; ++g)
                assert_string_not_equal(field->name, t->fields[g].name);
            assert_true(field->offset < t->size);
            void* value = a + field->offset;
            double number = field->kind == AX_FIELD_NUMBER    ? *(double*)value
                            : field->kind == AX_FIELD_INTEGER ? *(int*)value
                            : field->kind == AX_FIELD_CHOICE  ? *(int*)value
                                                              : 0;
            if (field->kind == AX_FIELD_NUMBER || field->kind == AX_FIELD_INTEGER) {
                assert_true(field->lo < field->hi);
                bool inside = (field->open ? number > field->lo : number >= field->lo) && number <= field->hi;
                assert_true(field->required || field->fallback || inside);
            }
            if (field->kind == AX_FIELD_CHOICE)
                assert_true(field->choices && number >= 0 && number < field->choice_count);
            if (field->kind == AX_FIELD_VECTOR || field->kind == AX_FIELD_POINTS)
                assert_true(field->width >= 2 && field->width <= 3);
            if (field->kind == AX_FIELD_TEXT)
                assert_true(field->required || field->fallback || *(const char**)value);
        }
        ax_free(a);
    }
}

static void a_file_is_named_in_its_messages(void** state)
{
    (void)state;
    char path[] = "/tmp/test_recipe_XXXXXX";
    int descriptor = mkstemp(path);
    FILE* out = fdopen(descriptor, "w");
    fputs(HEAD "\n" START ", {\"op\": \"fil\"}]}", out);
    fclose(out);
    ax_recipe* recipe;
    ax_error error = {0};
    assert_int_equal(ax_recipe_read(path, &recipe, &error), AX_BAD_INPUT);
    assert_memory_equal(error.message, path, strlen(path));
    assert_non_null(strstr(error.message, ", line 2, column 45: There is no operator \"fil\". Did you mean \"fill\"?"));
    out = fopen(path, "w");
    fwrite(HEAD "]}\0", 1, sizeof HEAD "]}\0", out);
    fclose(out);
    assert_int_equal(ax_recipe_read(path, &recipe, &error), AX_BAD_INPUT);
    assert_non_null(strstr(error.message, "zero bytes"));
    remove(path);
    assert_int_equal(ax_recipe_read(path, &recipe, &error), AX_BAD_INPUT);
    assert_null(recipe);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(what_is_wrong_is_named_with_its_place), cmocka_unit_test(places_are_found_in_any_layout),
        cmocka_unit_test(text_reads_back_to_the_same_recipe),    cmocka_unit_test(a_recipe_is_edited_by_operators),
        cmocka_unit_test(words_tell_an_operator_in_one_line),    cmocka_unit_test(every_operator_has_a_whole_schema),
        cmocka_unit_test(a_file_is_named_in_its_messages),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
