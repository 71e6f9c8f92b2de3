#include "recipe/arguments.h"

#include <string.h>

static ax_status read_arguments(const char* json, ax_arguments* out, ax_error* error)
{
    json_t* object = json_loads(json, JSON_REJECT_DUPLICATES, NULL);
    ax_json_path at;
    ax_status status = ax_arguments_read(object, out, &at, error);
    json_decref(object);
    return status;
}

static int steps_of(const ax_arguments* a)
{
    for (int k = 0; k < a->type->field_count; ++k)
        if (strcmp(a->type->fields[k].name, "steps") == 0)
            return *(const int*)((const char*)a->values + a->type->fields[k].offset);
    return 0;
}

// Operators edit last, after all that can fail; settling may still be cancelled, so the form is kept as bytes until then.
static ax_status apply(const ax_arguments* a, const ax_operator_context* context, ax_error* error)
{
    ax_form** form = context->form;
    if (!a->type->starts && !*form)
        return ax_fail(error, AX_BAD_INPUT, "There is no design yet: begin with an operator that starts one.");
    size_t size = 0;
    bool settles = a->type->settles && !context->live;
    void* before = *form && settles ? ax_form_save(*form, &size) : NULL;
    ax_status status = a->type->apply(context, a->values, error);
    if (status == AX_OK && settles) {
        status = ax_form_settle(*form, steps_of(a), context->progress, error);
        if (status != AX_OK) {
            ax_form_free(*form);
            *form = NULL;
            if (before)
                ax_form_load(before, size, form, NULL);
        }
    }
    ax_free(before);
    return status;
}

ax_status ax_recipe_apply(const ax_recipe* recipe, int k, const char* folder, const ax_progress* progress,
                          ax_form** form, ax_error* error)
{
    return ax_recipe_apply_finished(recipe, k, folder, NULL, progress, form, NULL, error);
}

char* ax_recipe_file(const ax_recipe* recipe, int k)
{
    json_t* object = json_loads(ax_recipe_operator(recipe, k), 0, NULL);
    const char* name = json_string_value(json_object_get(object, "file"));
    char* copy = ax_copy_text(name);
    json_decref(object);
    return copy;
}

ax_status ax_recipe_apply_finished(const ax_recipe* recipe, int k, const char* folder, const char* file,
                                   const ax_progress* progress, ax_form** form, ax_finished* finished, ax_error* error)
{
    ax_arguments arguments;
    ax_error inner = {0};
    ax_status status = read_arguments(ax_recipe_operator(recipe, k), &arguments, &inner);
    if (status == AX_OK) {
        const ax_operator_context context = {
            .form = form, .folder = folder, .file = file, .progress = progress, .finished = finished};
        status = apply(&arguments, &context, &inner);
        ax_arguments_free(&arguments);
    }
    if (status == AX_OK)
        return AX_OK;
    if (status == AX_USAGE) // in a recipe, it is the recipe that asks for it
        status = AX_BAD_INPUT;
    return ax_fail(error, status, "Operator %d, %s: %s", k + 1, ax_recipe_type(recipe, k)->name, inner.message);
}

ax_status ax_operator_preview(const char* json, const char* folder, ax_form** form, ax_error* error)
{
    ax_arguments arguments;
    json_error_t wrong;
    ax_json_path at;
    json_t* object = json_loads(json, JSON_REJECT_DUPLICATES, &wrong);
    ax_status status = object
                           ? ax_arguments_read(object, &arguments, &at, error)
                           : ax_fail(error, AX_BAD_INPUT, "Column %d: this is no JSON: %s.", wrong.column, wrong.text);
    if (status == AX_OK) {
        status = apply(&arguments, &(ax_operator_context){.form = form, .folder = folder, .live = true}, error);
        ax_arguments_free(&arguments);
    }
    json_decref(object);
    return status;
}

ax_status ax_recipe_play(const ax_recipe* recipe, int until, const char* folder, const ax_progress* progress,
                         bool (*after)(void* context, int k, ax_form* form), void* context, ax_form** form, int* done,
                         ax_error* error)
{
    int count = ax_recipe_count(recipe);
    if (until >= 0 && until < count)
        count = until;
    *form = NULL;
    *done = 0;
    for (int k = 0; k < count; ++k) {
        ax_progress_part part;
        ax_status status = ax_recipe_apply(
            recipe, k, folder, ax_progress_within(&part, progress, (double)k / count, (k + 1.0) / count), form, error);
        if (status != AX_OK)
            return status;
        ++*done;
        if (after && !after(context, k, *form))
            return AX_OK;
    }
    return AX_OK;
}
