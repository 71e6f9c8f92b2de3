// Variants: named copies of the document, to be compared side by side.
#include "studio/describe.h"
#include "studio/job.h"

#include <string.h>

static ax_status named(const job* j, const char** name, ax_error* error)
{
    return message_unpack(&j->message, error, "{s:s}", "name", name);
}

// Of the document as another program may have written it: only what fits the protocol goes to pages.
static json_t* figures_of(const ax_variant* v)
{
    static const char* const whole[] = {"triangle", "hinge", "other"};
    static const char* const text[] = {"key", "title", "answer", "limit", "severity"};
    json_t *figures = json_loads(v->figures, 0, NULL), *checks = NULL, *check;
    int triangles, exact;
    size_t k;
    bool sound =
        json_unpack(figures, "{s:i, s:b, s:o}", "triangles", &triangles, "exact", &exact, "checks", &checks) == 0 &&
        json_is_array(checks);
    json_array_foreach(checks, k, check)
    {
        for (size_t f = 0; f < sizeof whole / sizeof *whole; ++f)
            sound = sound && json_is_integer(json_object_get(check, whole[f]));
        for (size_t f = 0; f < sizeof text / sizeof *text; ++f)
            sound = sound && json_is_string(json_object_get(check, text[f]));
    }
    if (sound)
        return figures;
    json_decref(figures);
    return json_pack("{s:i, s:b, s:[]}", "triangles", 0, "exact", false, "checks");
}

json_t* job_variants(const desk* d)
{
    const ax_variant* variants;
    int count = ax_session_variants(d->session, &variants);
    json_t* list = json_array();
    for (int k = 0; k < count; ++k) {
        json_t* variant = figures_of(&variants[k]);
        json_object_update_new(variant,
                               json_pack("{s:s, s:i, s:o, s:b}", "name", variants[k].name, "steps", variants[k].at,
                                         "time", describe_number(variants[k].time), "current", variants[k].present));
        json_array_append_new(list, variant);
    }
    return json_pack("{s:s, s:o}", "event", "variants", "variants", list);
}

static ax_status keep(desk* d, const job* j, json_t** result, ax_error* error)
{
    (void)result;
    const char* name;
    ax_status status = named(j, &name, error);
    if (status != AX_OK)
        return status;
    ax_form* form = ax_session_form(d->session);
    ax_form_view view = ax_form_look(form);
    ax_form_report report;
    ax_form_measure(form, &report);
    shape_measures measures = shape_measure(form, &view);
    json_t* figures = json_pack("{s:i, s:b, s:o}", "triangles", view.linkage->triangle_count, "exact", d->exact != NULL,
                                "checks", describe_checks(&report, &view, &measures, d->exact, true));
    char* text = json_dumps(figures, JSON_COMPACT);
    status = ax_session_keep_variant(d->session, name, text, error);
    free(text);
    json_decref(figures);
    shape_measures_free(&measures);
    ax_form_report_free(&report);
    return status;
}

static ax_status take(desk* d, const job* j, json_t** result, ax_error* error)
{
    (void)result;
    const char* name;
    ax_status status = named(j, &name, error);
    if (status != AX_OK)
        return status;
    desk_begin_edit(d);
    const ax_progress progress = desk_progress(d);
    return ax_session_take_variant(d->session, name, &progress, error);
}

static ax_status look(desk* d, const job* j, json_t** result, ax_error* error)
{
    (void)result;
    const char* name;
    ax_form* form = NULL;
    const ax_progress progress = desk_progress(d);
    ax_status status = named(j, &name, error);
    if (status == AX_OK)
        status = ax_session_variant_form(d->session, name, &progress, &form, error);
    if (status != AX_OK)
        return status;
    board b = {0};
    ax_form_view view = ax_form_look(form);
    shape_measures measures = shape_measure(form, &view);
    shape_frame frame = shape_new_linkage(&b, &view);
    shape_put_places(&b, &view, &frame, true);
    shape_put_rest(&b, &view, &measures);
    shape_put_exact(&b, &view, form, NULL);
    hub_tell(d->hub, d, j->client, describe_linkage(d->id, b.topology, &view, frame.origin, frame.flat_origin, name));
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
    const char* name;
    ax_status status = named(j, &name, error);
    return status == AX_OK ? ax_session_drop_variant(d->session, name, error) : status;
}

const job_type job_types_variants[] = {
    {"variant", false, keep, false},
    {"variant_take", true, take, false},
    {"variant_look", false, look, false},
    {"variant_drop", false, drop, false},
    {0},
};
