// Variants: named copies of the document, to be compared side by side.
#include "studio/describe.h"
#include "studio/job.h"

#include <string.h>

enum { VARIANTS_MOST = 24, NAME_MOST = 80 };

static void free_variant(variant* v)
{
    ax_free(v->name);
    ax_free(v->recipe);
    ax_free(v->form);
    json_decref(v->checks);
    *v = (variant){0};
}

void desk_free_variants(desk* d)
{
    for (int k = 0; k < d->variant_count; ++k)
        free_variant(&d->variants[k]);
    ax_free(d->variants);
    d->variants = NULL;
    d->variant_count = 0;
}

static int find(const desk* d, const char* name)
{
    for (int k = 0; k < d->variant_count; ++k)
        if (strcmp(d->variants[k].name, name) == 0)
            return k;
    return -1;
}

static ax_status named(const desk* d, const job* j, int* k, ax_error* error)
{
    const char* name;
    ax_status status = message_unpack(&j->message, error, "{s:s}", "name", &name);
    if (status == AX_OK && (*k = find(d, name)) < 0)
        status = ax_fail(error, AX_BAD_INPUT, "There is no variant \"%.80s\".", name);
    return status;
}

json_t* job_variants(const desk* d)
{
    char* present = ax_recipe_text(ax_session_recipe(d->session));
    json_t* list = json_array();
    for (int k = 0; k < d->variant_count; ++k) {
        const variant* v = &d->variants[k];
        json_array_append_new(list, json_pack("{s:s, s:i, s:i, s:b, s:O, s:b}", "name", v->name, "triangles",
                                              v->triangles, "steps", v->steps, "exact", v->exact, "checks", v->checks,
                                              "current", strcmp(present, v->recipe) == 0));
    }
    ax_free(present);
    return json_pack("{s:s, s:o}", "event", "variants", "variants", list);
}

static ax_status keep(desk* d, const job* j, json_t** result, ax_error* error)
{
    (void)result;
    const char* name;
    ax_status status = message_unpack(&j->message, error, "{s:s}", "name", &name);
    if (status != AX_OK)
        return status;
    int k = find(d, name);
    if (!*name || strlen(name) > NAME_MOST || (k < 0 && d->variant_count == VARIANTS_MOST))
        return ax_fail(error, AX_USAGE, "variant: a name has 1 to %d bytes, and there are at most %d variants.",
                       NAME_MOST, VARIANTS_MOST);
    if (k >= 0)
        free_variant(&d->variants[k]);
    else {
        k = d->variant_count++;
        d->variants = ax_realloc(d->variants, (size_t)d->variant_count, sizeof *d->variants);
    }
    ax_form* form = ax_session_form(d->session);
    ax_form_view view = ax_form_look(form);
    ax_form_report report;
    ax_form_measure(form, &report);
    shape_measures measures = shape_measure(&view);
    variant* v = &d->variants[k];
    *v = (variant){.name = ax_copy(name, strlen(name) + 1, 1),
                   .recipe = ax_recipe_text(ax_session_recipe(d->session)),
                   .triangles = view.linkage->triangle_count,
                   .steps = ax_session_at(d->session),
                   .exact = d->exact != NULL,
                   .checks = describe_checks(&report, &view, measures.curvature, d->exact)};
    v->form = ax_form_save(form, &v->size);
    shape_measures_free(&measures);
    ax_form_report_free(&report);
    return AX_OK;
}

static ax_status take(desk* d, const job* j, json_t** result, ax_error* error)
{
    (void)result;
    int k;
    ax_status status = named(d, j, &k, error);
    if (status != AX_OK)
        return status;
    desk_begin_edit(d);
    const ax_progress progress = desk_progress(d);
    ax_recipe* recipe;
    status = ax_recipe_parse(d->variants[k].recipe, &recipe, error);
    if (status == AX_OK)
        status = ax_session_replace(d->session, recipe, &progress, error);
    ax_recipe_free(recipe);
    return status;
}

static ax_status look(desk* d, const job* j, json_t** result, ax_error* error)
{
    (void)result;
    int k;
    ax_form* form = NULL;
    ax_status status = named(d, j, &k, error);
    if (status == AX_OK)
        status = ax_form_load(d->variants[k].form, d->variants[k].size, &form, error);
    if (status != AX_OK)
        return status;
    board b = {0};
    ax_form_view view = ax_form_look(form);
    shape_measures measures = shape_measure(&view);
    shape_frame frame = shape_new_linkage(&b, &view);
    shape_put_places(&b, &view, &frame);
    shape_put_rest(&b, &view, &measures);
    shape_put_exact(&b, &view, form, NULL);
    hub_tell(d->hub, d, j->client,
             describe_linkage(d->id, b.topology, &view, frame.origin, frame.flat_origin, d->variants[k].name));
    size_t size;
    unsigned char* block = board_frame(&b, (frame_header){.kind = FRAME_VARIANT, .re = (unsigned)j->message.id}, 0,
                                       hub_before(d->hub), &size);
    hub_send(d->hub, j->client, block, size, &d->cancel);
    board_free(&b);
    shape_measures_free(&measures);
    ax_form_free(form);
    return AX_OK;
}

static ax_status drop(desk* d, const job* j, json_t** result, ax_error* error)
{
    (void)result;
    int k;
    ax_status status = named(d, j, &k, error);
    if (status != AX_OK)
        return status;
    free_variant(&d->variants[k]);
    --d->variant_count;
    memmove(d->variants + k, d->variants + k + 1, (size_t)(d->variant_count - k) * sizeof *d->variants);
    return AX_OK;
}

const job_type job_types_variants[] = {
    {"variant", false, keep, false},
    {"variant_take", true, take, false},
    {"variant_look", false, look, false},
    {"variant_drop", false, drop, false},
    {0},
};
