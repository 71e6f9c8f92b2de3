// Recipes of any bytes: no text may crash the reader, what it reads it writes and reads again to the same text, and operators that are
// read can be applied to a small form, where they succeed or say why not.
#include "ax/recipe.h"

#include <stdint.h>
#include <stdlib.h>
#include <string.h>

int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size);
int LLVMFuzzerInitialize(int* argc, char*** argv);

static void* start;
static size_t start_size;

static void promise(bool kept)
{
    if (!kept)
        abort();
}

int LLVMFuzzerInitialize(int* argc, char*** argv)
{
    (void)argc, (void)argv;
    const double square[4][2] = {{-1, -1}, {1, -1}, {1, 1}, {-1, 1}};
    ax_form* form;
    promise(
        ax_form_make(
            &(ax_form_start){.outline_count = 4, .outline = square, .triangles = 60, .scale = 1.3, .unit = AX_METRE},
            &form, NULL) == AX_OK);
    start = ax_form_save(form, &start_size);
    ax_form_free(form);
    return 0;
}

static void apply(const ax_recipe* recipe)
{
    ax_form* form;
    promise(ax_form_load(start, start_size, &form, NULL) == AX_OK);
    for (int k = 0; k < ax_recipe_count(recipe) && k < 8; ++k) {
        char words[160];
        ax_error error = {0};
        ax_recipe_words(recipe, k, words);
        promise(strlen(words) < sizeof words);
        if (ax_recipe_type(recipe, k)->starts) // large ones would only be slow
            continue;
        if (ax_operator_preview(ax_recipe_operator(recipe, k), "/nonexistent", &form, &error) != AX_OK)
            promise(strlen(error.message) > 10);
        promise(form);
    }
    ax_form_free(form);
}

static void select_hinges(const char* words)
{
    ax_form* form;
    int *hinges, count;
    ax_error error = {0};
    promise(ax_form_load(start, start_size, &form, NULL) == AX_OK);
    if (ax_select(form, words, &hinges, &count, &error) == AX_OK)
        promise(count >= 0 && count <= ax_form_look(form).linkage->hinge_count);
    else
        promise(strlen(error.message) > 10 && !hinges);
    ax_free(hinges);
    ax_form_free(form);
}

int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size)
{
    char* text = malloc(size + 1);
    memcpy(text, data, size);
    text[size] = 0;
    ax_recipe* recipe;
    ax_error error = {0};
    if (size && *text == '~') // the same corpus holds selections
        select_hinges(text + 1);
    else if (ax_recipe_parse(text, &recipe, &error) == AX_OK) {
        char* written = ax_recipe_text(recipe);
        ax_recipe* again;
        promise(ax_recipe_parse(written, &again, &error) == AX_OK);
        char* rewritten = ax_recipe_text(again);
        promise(strcmp(written, rewritten) == 0);
        apply(again);
        ax_free(written);
        ax_free(rewritten);
        ax_recipe_free(recipe);
        ax_recipe_free(again);
    } else
        promise(strncmp(error.message, "Line ", 5) == 0);
    free(text);
    return 0;
}
