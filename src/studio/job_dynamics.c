// Commands that let the solver run.
#include "studio/describe.h"
#include "studio/job.h"

#include "base/vec.h"

#include <math.h>
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
    double height = 0.05;
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

static double mean_distance(int hinges, const double (*a)[3], const double (*b)[3])
{
    double sum = 0;
    for (int h = 0; h < hinges; ++h)
        sum += ax_distance3(a[h], b[h]);
    return sum / hinges;
}

enum { MOTION_UPDATES = 2000, FIRST_UPDATES = 30 };
static const double motion_rest = 1e-4; // of the spacing, mean move per iteration

// Without load: the solver's way from the flat sheet to rest. A state is sent where it has come one frame nearer to the document's own, the
// last one at rest.
static ax_status open_free(desk* d, const job* j, ax_form* form, const double (*rest)[3], int hinges, int wanted,
                           int* frames, ax_error* error)
{
    const ax_progress progress = desk_progress(d);
    ax_form_reopen(form, 0.01);
    ax_form_view v = ax_form_look(form);
    double(*last)[3] = ax_copy(v.deployed, (size_t)hinges, sizeof *last);
    double whole = mean_distance(hinges, v.deployed, rest), shown = 0;
    bool going = send_motion(d, j, 0, wanted, 0, hinges, v.deployed), still = false;
    *frames = 1;
    for (int k = 0; going && !still && k < MOTION_UPDATES; ++k) {
        ax_form_iterate(form, 1);
        v = ax_form_look(form);
        double move = mean_distance(hinges, v.deployed, last) / v.spacing;
        memcpy(last, v.deployed, (size_t)hinges * sizeof *last);
        still = k > FIRST_UPDATES && move < motion_rest;
        double share = fmin(1, 1 - mean_distance(hinges, v.deployed, rest) / whole);
        if (share - shown > 1.0 / (wanted - 1) && *frames < wanted - 1) {
            shown = share;
            going = send_motion(d, j, (*frames)++, wanted, share, hinges, v.deployed);
        }
        going = going && ax_progress_report(&progress, "Deploying from flat", shown, move);
    }
    if (going)
        going = send_motion(d, j, (*frames)++, wanted, 1, hinges, (const double(*)[3])last);
    ax_free(last);
    return going ? AX_OK : ax_fail(error, AX_CANCELLED, "Cancelled.");
}

static ax_status move_free(desk* d, const job* j, int hinges, int wanted, int* frames, ax_error* error)
{
    size_t size;
    ax_form *own = ax_session_form(d->session), *form = NULL;
    void* bytes = ax_form_save(own, &size);
    ax_status status = ax_form_load(bytes, size, &form, error);
    ax_free(bytes);
    if (status == AX_OK)
        status = open_free(d, j, form, ax_form_look(own).deployed, hinges, wanted, frames, error);
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
