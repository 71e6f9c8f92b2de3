// Commands that let the solver run.
#include "studio/describe.h"
#include "studio/job.h"

#include "base/vec.h"

#include <string.h>

static ax_status play(desk* d, const job* j, json_t** result, ax_error* error)
{
    (void)j, (void)result, (void)error;
    desk_play(d);
    return AX_OK;
}

static ax_status step(desk* d, const job* j, json_t** result, ax_error* error)
{
    (void)result;
    int iterations = 1;
    ax_status status = message_unpack(&j->message, error, "{s?i}", "iterations", &iterations);
    if (status == AX_OK && (iterations < 1 || iterations > 1000))
        status = ax_fail(error, AX_USAGE, "step: \"iterations\" is 1 to 1000.");
    if (status == AX_OK)
        desk_step(d, iterations);
    return status;
}

static ax_status restart(desk* d, const job* j, json_t** result, ax_error* error)
{
    (void)result;
    double height = 0.1;
    ax_status status = message_unpack(&j->message, error, "{s?F}", "height", &height);
    if (status == AX_OK && !(height >= -2 && height <= 2))
        status = ax_fail(error, AX_USAGE, "restart: \"height\" is -2 to 2, over the sheet's radius.");
    if (status == AX_OK)
        desk_restart(d, height);
    return status;
}

static ax_status settle(desk* d, const job* j, json_t** result, ax_error* error)
{
    (void)j, (void)result, (void)error;
    desk_end_live(d);
    return AX_OK;
}

// ---- from flat to deployed ----------------------------------------------------------------------------------------------------

// One frame of the motion; false when nobody waits for it any more.
static bool send_motion(desk* d, const job* j, int index, int of, double share, int hinges, const double (*places)[3])
{
    board b = {.topology = d->board.topology};
    const int place[2] = {index, of};
    board_put_ints(&b, SECTION_PLACE, 2, place);
    board_put_numbers(&b, SECTION_SHARE, 1, &share, 1, NULL);
    board_put_numbers(&b, SECTION_DEPLOYED, 3 * hinges, *places, 3, d->frame.origin);
    size_t size;
    unsigned char* block = board_frame(&b, (frame_header){.kind = FRAME_MOTION, .re = (unsigned)j->message.id}, 0,
                                       hub_before(d->hub), &size);
    board_free(&b);
    return hub_send(d->hub, j->client, block, size, &d->cancel);
}

// Under load: frames evenly in time, each sent when it is there.
static ax_status move_under_load(desk* d, const job* j, ax_form_motion* m, int hinges, int frames, ax_error* error)
{
    const ax_progress progress = desk_progress(d);
    for (int k = 0; k < frames; ++k) {
        ax_progress_part part;
        double from = k ? (k - 1.0) / (frames - 1) : 0, to = k / (frames - 1.0);
        const double(*places)[3] = ax_form_motion_to(m, to, ax_progress_within(&part, &progress, from, to));
        if (!places || !send_motion(d, j, k, frames, to, hinges, places))
            return ax_fail(error, AX_CANCELLED, "Cancelled.");
    }
    return AX_OK;
}

// States that the solver went through, thinned so that there are at most twice as many as wanted.
typedef struct track {
    int hinges, wanted, count, stride, updates;
    double (**places)[3];
    double* way; // travelled until then, mean over the hinges
    double travelled, (*last)[3];
} track;

static void track_keep(track* t, const double (*places)[3])
{
    double moved = 0;
    for (int h = 0; t->updates && h < t->hinges; ++h)
        moved += ax_distance3(places[h], t->last[h]) / t->hinges;
    t->travelled += moved;
    memcpy(t->last, places, (size_t)t->hinges * sizeof *places);
    if (t->updates++ % t->stride)
        return;
    if (t->count == 2 * t->wanted) { // every other one goes
        for (int k = 0; k < t->count; ++k)
            if (k % 2)
                ax_free(t->places[k]);
            else
                t->places[k / 2] = t->places[k], t->way[k / 2] = t->way[k];
        t->count /= 2;
        t->stride *= 2;
        if ((t->updates - 1) % t->stride)
            return;
    }
    t->way[t->count] = t->travelled;
    t->places[t->count++] = ax_copy(places, (size_t)t->hinges, sizeof *places);
}

enum { MOTION_UPDATES = 2000 };
static const double motion_rest = 1e-4; // of the spacing, mean move per iteration

// Without load: the solver's way from the flat sheet to rest.
static ax_status run_free(desk* d, ax_form* form, track* t, ax_error* error)
{
    const ax_progress progress = desk_progress(d);
    ax_form_restart(form, 0.02);
    for (int k = 0; k < MOTION_UPDATES; ++k) {
        ax_form_view v = ax_form_look(form);
        double before = t->travelled;
        track_keep(t, v.deployed);
        double move = (t->travelled - before) / v.spacing;
        if (k > 10 && move < motion_rest)
            break;
        if (!ax_progress_report(&progress, "Deploying from flat", (double)k / MOTION_UPDATES, move))
            return ax_fail(error, AX_CANCELLED, "Cancelled.");
        ax_form_iterate(form, 1);
    }
    return AX_OK;
}

// Frames are sent when the whole way is known: they are spread over it.
static ax_status move_free(desk* d, const job* j, int hinges, int wanted, int* frames, ax_error* error)
{
    size_t size;
    ax_form* form = NULL;
    void* bytes = ax_form_save(ax_session_form(d->session), &size);
    ax_status status = ax_form_load(bytes, size, &form, error);
    ax_free(bytes);
    if (status != AX_OK)
        return status;
    track t = {.hinges = hinges,
               .wanted = wanted,
               .stride = 1,
               .places = ax_calloc(2 * (size_t)wanted, sizeof *t.places),
               .way = AX_NEW0(double, 2 * wanted),
               .last = ax_calloc((size_t)hinges, sizeof *t.last)};
    status = run_free(d, form, &t, error);
    *frames = t.count < wanted ? t.count : wanted;
    for (int i = 0; status == AX_OK && i < *frames; ++i) {
        int k = *frames > 1 ? (int)((double)i * (t.count - 1) / (*frames - 1) + 0.5) : 0;
        double share = t.travelled > 0 ? t.way[k] / t.travelled : 1;
        if (!send_motion(d, j, i, *frames, share, hinges, (const double(*)[3])t.places[k]))
            status = ax_fail(error, AX_CANCELLED, "Cancelled.");
    }
    for (int k = 0; k < t.count; ++k)
        ax_free(t.places[k]);
    ax_free(t.places);
    ax_free(t.way);
    ax_free(t.last);
    ax_form_free(form);
    return status;
}

static ax_status motion(desk* d, const job* j, json_t** result, ax_error* error)
{
    int frames = 60;
    ax_status status = message_unpack(&j->message, error, "{s?i}", "frames", &frames);
    if (status == AX_OK && (frames < 2 || frames > 240))
        status = ax_fail(error, AX_USAGE, "motion: \"frames\" is 2 to 240.");
    if (status != AX_OK)
        return status;
    ax_form* form = ax_session_form(d->session);
    if (ax_form_get_dynamics(form)->kind == AX_DYNAMICS_NONE)
        return ax_fail(error, AX_USAGE,
                       "motion: nothing deploys the sheet yet. Apply gravity, inflation or expand first.");
    int hinges = ax_form_look(form).linkage->hinge_count;
    ax_form_motion* loaded = ax_form_motion_make(form);
    status =
        loaded ? move_under_load(d, j, loaded, hinges, frames, error) : move_free(d, j, hinges, frames, &frames, error);
    ax_form_motion_free(loaded);
    *result = json_pack("{s:i, s:s}", "frames", frames, "state", loaded ? "simulated" : "deployed");
    return status;
}

const job_type job_types_dynamics[] = {
    {"play", false, play, true},    {"step", false, step, false},     {"restart", false, restart, false},
    {"settle", true, settle, true}, {"motion", false, motion, false}, {0},
};
