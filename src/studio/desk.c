#include "studio/desk.h"

#include "base/clock.h"
#include "base/vec.h"
#include "studio/describe.h"
#include "studio/draft.h"
#include "studio/hello.h"
#include "studio/job.h"
#include "studio/shape.h"

#include <errno.h>
#include <stdio.h>
#include <string.h>
#include <unistd.h>

// A visual update, unless the hand would wait for it longer than `patience`; after what the hand did, than `reaction`.
enum { ITERATIONS = 10 };
static const double patience = 0.02, reaction = 0.004;
static const double quick_report = 0.01; // a longer one waits until the hand rests
static const double frame_seconds = 1.0 / 60, rest_seconds = 1.0 / 15, report_seconds = 0.5, progress_seconds = 0.25;
static const double eye_move = 0.002; // of twice the sheet's size per update: what moves by itself is to be seen moving
static const double rest_move = 1e-4; // of the sheet's spacing per update: nothing a screen shows moves any more
enum { REST_UPDATES = 3 };

// ---- with the hub's lock ------------------------------------------------------------------------------------------------------

const char* desk_id(const desk* d)
{
    return d->id;
}

bool desk_ended(const desk* d)
{
    return d->ended;
}

void desk_command(desk* d, int client, message* m)
{
    job* j = AX_NEW(job, 1);
    *j = (job){.client = client, .message = *m};
    m->parameters = NULL;
    if (job_find(m->action)->edits) {
        json_decref(d->preview.step);
        d->preview.step = NULL;
    }
    *d->last = j;
    d->last = &j->next;
    pthread_cond_signal(&d->work);
}

bool desk_knows(const char* action)
{
    return job_find(action) != NULL;
}

static bool hand_is_free(const desk* d, int client)
{
    return !d->hand || d->hand == client;
}

ax_status desk_preview(desk* d, int client, message* m, ax_error* error)
{
    json_t* step = NULL;
    int serial = 0;
    ax_status status = message_unpack(m, error, "{s:i, s:o}", "serial", &serial, "operator", &step);
    if (status != AX_OK)
        return status;
    if (serial < 1 || (!json_is_object(step) && !json_is_null(step)))
        return ax_fail(error, AX_USAGE, "preview: \"serial\" rises from 1, \"operator\" is an object, or null to end.");
    if (!hand_is_free(d, client))
        return AX_OK;
    json_decref(d->preview.step); // only the newest matters
    d->preview.step = json_incref(step);
    d->preview.client = client;
    d->preview.serial = (unsigned)serial;
    d->preview.came = ax_seconds();
    d->hand = client;
    pthread_cond_signal(&d->work);
    return AX_OK;
}

ax_status desk_grab(desk* d, int client, message* m, ax_error* error)
{
    int hinge = -1, serial = 0;
    double to[3];
    ax_status status = message_unpack(m, error, "{s:i, s:[F, F, F], s?i}", "hinge", &hinge, "to", &to[0], &to[1],
                                      &to[2], "serial", &serial);
    if (status != AX_OK)
        return status;
    if (hinge < 0 || serial < 0)
        return ax_fail(error, AX_USAGE, "grab: \"hinge\" and \"serial\" are not negative.");
    if (!hand_is_free(d, client))
        return AX_OK;
    d->grab = (grab){.wanted = true,
                     .hinge = hinge,
                     .serial = (unsigned)serial,
                     .client = client,
                     .to = {to[0], to[1], to[2]},
                     .came = ax_seconds()};
    d->hand = client;
    pthread_cond_signal(&d->work);
    return AX_OK;
}

void desk_release(desk* d, int client)
{
    if (d->hand != client)
        return;
    d->let_go = true;
    d->grab.wanted = false;
    pthread_cond_signal(&d->work);
}

void desk_pause(desk* d)
{
    d->pause = true;
    pthread_cond_signal(&d->work);
}

void desk_cancel(desk* d)
{
    __atomic_store_n(&d->cancel, true, __ATOMIC_RELAXED);
}

// A hand that has gone lets go; what it asked for goes on.
void desk_client_gone(desk* d, int client)
{
    if (d->hand != client)
        return;
    json_decref(d->preview.step);
    d->preview = (preview){.step = json_null(), .client = client};
    d->let_go = true;
    d->grab.wanted = false;
    pthread_cond_signal(&d->work);
}

const board* desk_board(const desk* d)
{
    return &d->board;
}

const char* desk_linkage(const desk* d)
{
    return d->linkage;
}

const char* desk_event(const desk* d, slot s, unsigned* number)
{
    *number = d->event_numbers[s];
    return d->events[s];
}

unsigned desk_serial(const desk* d, int client)
{
    return d->shown_hand == client ? d->shown_serial : 0;
}

// ---- what is shown ------------------------------------------------------------------------------------------------------------

// The newest event of its kind; takes over `event`.
static void post(desk* d, slot s, json_t* event)
{
    char* text = event ? json_dumps(event, JSON_COMPACT) : NULL;
    json_decref(event);
    hub_lock(d->hub);
    bool same = text && d->events[s] && strcmp(text, d->events[s]) == 0;
    if (text && !same) {
        free(d->events[s]);
        d->events[s] = text;
        ++d->event_numbers[s];
    }
    hub_unlock(d->hub);
    if (same)
        free(text);
    hub_wake(d->hub);
}

ax_form* desk_form(const desk* d)
{
    if (d->live_shown || !d->session)
        return d->live_shown ? d->live : NULL;
    ax_form* making = ax_session_making(d->session);
    return making ? making : ax_session_form(d->session);
}

static const ax_design* shown_exact(const desk* d)
{
    return d->live_shown || d->busy ? NULL : d->exact;
}

static bool same_linkage(const board* b, const ax_linkage* l)
{
    const board_section *triangles = &b->sections[SECTION_TRIANGLES], *panels = &b->sections[SECTION_PANELS];
    size_t bytes = 3 * sizeof(int) * (size_t)l->triangle_count;
    return b->topology && triangles->count == 3 * l->triangle_count &&
           memcmp(triangles->data, l->triangles, bytes) == 0 && memcmp(panels->data, l->panels, bytes) == 0;
}

// `whole`: with everything that takes time to measure. Returns the largest move since the last time, over the spacing.
static double publish(desk* d, bool whole)
{
    ax_form* form = desk_form(d);
    ax_form_view v = ax_form_look(form);
    shape_measures measures = {0};
    const ax_design* exact = shown_exact(d);
    bool renewed = !same_linkage(&d->board, v.linkage); // only this thread writes the board
    whole |= renewed;
    if (whole) {
        double start = ax_seconds();
        measures = shape_measure(form, &v);
        d->measure_time = ax_seconds() - start;
    }
    hub_lock(d->hub);
    board* b = &d->board;
    unsigned before = b->stamp, flags = b->flags;
    if (renewed) {
        d->frame = shape_new_linkage(b, &v);
        json_t* event = describe_linkage(d->id, b->topology, &v, d->frame.origin, d->frame.flat_origin, NULL);
        free(d->linkage);
        d->linkage = json_dumps(event, JSON_COMPACT);
        json_decref(event);
    }
    shape_put_places(b, &v, &d->frame, whole);
    if (whole) {
        shape_put_rest(b, &v, &measures);
        shape_put_exact(b, &v, form, exact);
    }
    if (b->stamp != before) // flags alone are no other state
        ++b->revision;
    b->flags = (exact ? FRAME_EXACT : 0) |
               (d->moving || d->busy ? FRAME_MOVING
                : d->live_shown      ? 0
                                     : FRAME_SETTLED) |
               (d->previewing ? FRAME_PREVIEW : 0);
    d->shown_hand = d->hand_serial ? d->hand_of_serial : 0;
    if (d->shown_serial != d->hand_serial || flags != b->flags)
        ++b->stamp; // a frame without sections tells it
    if (d->hand_serial && d->shown_serial != d->hand_serial) {
        const double times[] = {1e3 * (d->hand_moved - d->hand_came), 1e3 * (ax_seconds() - d->hand_moved)};
        board_put_numbers(b, SECTION_TIMES, 2, times, 2, NULL);
    }
    d->shown_serial = d->hand_serial;
    hub_unlock(d->hub);
    hub_wake(d->hub);
    shape_measures_free(&measures);

    double move = INFINITY;
    int n = v.linkage->hinge_count;
    const double(*space)[3] = v.simulated ? v.simulated : v.deployed;
    if (!renewed && d->last_count == n && d->last_places) {
        move = 0;
        for (int h = 0; h < n; ++h)
            move =
                fmax(move, fmax(ax_distance3(space[h], d->last_places[h]), ax_distance2(v.flat[h], d->last_flat[h])));
        move /= v.spacing;
    } else {
        d->last_places = ax_realloc(d->last_places, (size_t)n, sizeof *d->last_places);
        d->last_flat = ax_realloc(d->last_flat, (size_t)n, sizeof *d->last_flat);
        d->last_count = n;
    }
    memcpy(d->last_places, space, (size_t)n * sizeof *space);
    memcpy(d->last_flat, v.flat, (size_t)n * sizeof *v.flat);
    d->published = ax_seconds();
    if (whole)
        d->measured = d->published;
    return move;
}

static void post_status(desk* d, const char* solver)
{
    ax_form_report* r = &d->report;
    bool exact = shown_exact(d) != NULL;
    const char* state = exact ? "exact" : d->was_exact ? "edited" : r->settled && !d->moving ? "settled" : "unsettled";
    double residual =
        fmax(isnan(r->deployed_error) ? 0 : r->deployed_error, isnan(r->simulated_error) ? 0 : r->simulated_error);
    char words[96];
    if (d->moving || d->busy)
        residual > 0 ? snprintf(words, sizeof words, "Solving, edges within %.0e", residual)
                     : snprintf(words, sizeof words, "Solving");
    else if (exact)
        snprintf(words, sizeof words, "Exact");
    else if (d->settle_time > 0)
        snprintf(words, sizeof words, "%s, %.0f ms", r->settled ? "Settled" : "At rest", 1e3 * d->settle_time);
    else // nothing has moved since it was opened
        snprintf(words, sizeof words, "%s", r->settled ? "Settled" : "At rest");
    post(d, SLOT_STATUS,
         json_pack("{s:s, s:s, s:s, s:i, s:o, s:o, s:i, s:s}", "event", "status", "solver", solver, "state", state,
                   "iterations", r->iterations, "milliseconds", describe_number(1e3 * d->update_time), "residual",
                   describe_number(residual), "hand", d->hand_of_serial, "words", words));
}

static void measure(desk* d)
{
    ax_form* form = desk_form(d);
    double start = ax_seconds();
    ax_form_report_free(&d->report);
    ax_form_measure(form, &d->report);
    ax_form_view v = ax_form_look(form);
    shape_measures m = shape_measure(form, &v);
    const ax_design* exact = shown_exact(d);
    post(d, SLOT_REPORT, describe_report(d->board.revision, &d->report, &v, &m, exact, !d->moving && !d->busy));
    shape_measures_free(&m);
    d->reported = ax_seconds();
    d->report_time = d->reported - start;
}

static const char* solver_word(const desk* d)
{
    return d->busy ? "working" : d->previewing ? "preview" : d->moving ? "playing" : "idle";
}

static bool measures_due(const desk* d)
{
    return ax_seconds() - d->measured > fmax(rest_seconds, 10 * d->measure_time);
}

// While things move: places always, the rest seldom, the report seldomer still. A hand that waits does not wait for the rest, unless
// that would never come.
static double publish_moving(desk* d, bool waited_for)
{
    return publish(d, measures_due(d) && (!waited_for || ax_seconds() - d->measured > report_seconds));
}

static double show_moving(desk* d, bool waited_for)
{
    double now = ax_seconds(), move = publish_moving(d, waited_for);
    bool at_hand = d->report_time > quick_report && now - d->hand_moved < report_seconds;
    if (!at_hand && now - d->reported > fmax(report_seconds, 10 * d->report_time)) {
        measure(d);
        post_status(d, solver_word(d));
    }
    return move;
}

// The finished design, if the state is that of one.
static void find_exact(desk* d)
{
    const ax_progress progress = desk_progress(d);
    if (d->exact || ax_session_design(d->session, &progress, &d->exact, NULL) != AX_OK)
        return;
    if (d->exact)
        d->was_exact = false;
}

static void show_rest(desk* d)
{
    publish(d, true);
    measure(d);
    post_status(d, solver_word(d));
    d->rested = true;
}

static void show_document(desk* d)
{
    ax_form_report* r = &d->report;
    const describe_names names = {
        .id = d->id, .name = d->name, .path = d->draft ? NULL : files_relative(hub_files(d->hub), d->path)};
    post(d, SLOT_DOCUMENT, describe_document(&names, d->session, r));
    post(d, SLOT_VARIANTS, job_variants(d));
}

// ---- long work ----------------------------------------------------------------------------------------------------------------

static bool gives_up(const desk* d)
{
    return __atomic_load_n(&d->cancel, __ATOMIC_RELAXED) || __atomic_load_n(&d->closing, __ATOMIC_RELAXED);
}

static bool report_progress(void* context, const char* stage, double fraction, double residual)
{
    desk* d = context;
    double now = ax_seconds();
    if (desk_form(d) && !d->live_shown && now - d->published >= frame_seconds) {
        publish_moving(d, false);
        d->rested = false;                          // it was shown as moving
        if (!d->opened && d->opener && !d->watched) // once: who looks at something else meanwhile is left alone
            hub_show_making(d->hub, d->opener, d);
        if (!d->watched) {
            hub_lock(d->hub);
            d->watched = true;
            pthread_cond_broadcast(&d->open);
            hub_unlock(d->hub);
        }
    }
    if (now - d->job_start > progress_seconds && now - d->progressed > 0.1) {
        d->progressed = now;
        post(d, SLOT_PROGRESS,
             json_pack("{s:s, s:i, s:s, s:s, s:o, s:o, s:b}", "event", "progress", "re", d->job_id, "job", d->job_name,
                       "stage", stage, "fraction", describe_number(fraction), "residual", describe_number(residual),
                       "done", false));
        if (d->session && desk_form(d))
            post_status(d, "working");
    }
    return !gives_up(d);
}

static void begin_work(desk* d, const char* name, int id)
{
    d->busy = true;
    d->job_name = name;
    d->job_id = id;
    d->job_start = ax_seconds();
    d->progressed = 0;
}

static void end_work(desk* d)
{
    d->busy = false;
    if (d->progressed)
        post(d, SLOT_PROGRESS,
             json_pack("{s:s, s:i, s:s, s:s, s:f, s:n, s:b}", "event", "progress", "re", d->job_id, "job", d->job_name,
                       "stage", "Done", "fraction", 1.0, "residual", "done", true));
}

// ---- the hand -----------------------------------------------------------------------------------------------------------------

// Solving leaves a core to what draws: threads that work in step wait for the slowest.
static int hand_threads(void)
{
    long cores = sysconf(_SC_NPROCESSORS_ONLN);
    return cores > 2 ? (int)cores - 1 : 1;
}

// A copy of the settled form that the hand may pull about: the document's own stays as it is.
static bool begin_live(desk* d)
{
    if (!d->live_fresh) {
        size_t size;
        ax_form_free(d->live);
        d->live = NULL;
        void* bytes = ax_form_save(ax_session_form(d->session), &size);
        ax_status status = ax_form_load(bytes, size, &d->live, NULL);
        ax_free(bytes);
        if (status != AX_OK)
            return false;
        ax_form_view v = ax_form_look(d->live);
        ax_free(d->live_scale);
        ax_form_use_threads(d->live, hand_threads());
        d->live_scale = ax_copy(v.prescribed, (size_t)v.linkage->triangle_count, sizeof *d->live_scale);
        d->live_fresh = true;
        free(d->live_op);
        d->live_op = NULL;
    }
    return true;
}

// Several at once take less time than one by one.
static void iterate(desk* d, int count)
{
    double start = ax_seconds();
    ax_form_iterate(d->live, count);
    d->iteration_time = (ax_seconds() - start) / count;
}

// While nothing else is to be done: the copy, with its solvers made, so that the next gesture starts at once.
static void get_ready(desk* d)
{
    d->ready = true;
    if (!d->live_fresh && begin_live(d))
        for (int k = 0; k < 2; ++k) // the second one tells how long one takes
            iterate(d, 1);
}

static void use_live(desk* d)
{
    d->live_shown = true;
    d->rested = false;
}

// Back to the document's own state.
void desk_end_live(desk* d)
{
    hub_lock(d->hub);
    d->hand = 0;
    hub_unlock(d->hub);
    if (d->live_shown)
        d->live_fresh = false;
    d->live_shown = d->previewing = d->moving = d->holding = d->rested = d->ready = false;
    d->hand_serial = 0;
    d->hand_of_serial = 0;
}

void desk_begin_edit(desk* d)
{
    desk_end_live(d);
    d->live_fresh = false;
    d->was_exact |= d->exact != NULL;
    d->exact = NULL;
}

static void start_moving(desk* d)
{
    bool begins = !d->moving;
    d->moving = true;
    d->still = 0;
    d->swift = !d->previewing && !d->holding;
    d->move_start = ax_seconds();
    d->rested = false;
    if (begins)
        post_status(d, solver_word(d));
}

// True when the hand has moved on, or something is to be done: what is solved now is not waited for.
static bool outdated(desk* d)
{
    hub_lock(d->hub);
    bool is = d->preview.step || d->grab.wanted || d->first || d->closing;
    hub_unlock(d->hub);
    return is;
}

// Largest distance of a hinge in space from where it was published last, over the spacing.
static double moved(const desk* d, const ax_form_view* v)
{
    const double(*space)[3] = v->simulated ? v->simulated : v->deployed;
    double move = 0;
    for (int h = 0; h < d->last_count; ++h)
        move = fmax(move, ax_distance3(space[h], d->last_places[h]));
    return move / v->spacing;
}

static bool seen_moving(const desk* d)
{
    ax_form_view v = ax_form_look(d->live);
    return !d->previewing && !d->holding && d->last_count == v.linkage->hinge_count &&
           moved(d, &v) > eye_move * sqrt(v.linkage->triangle_count);
}

// Iterates for about so many seconds, and shows what came of it. `first`: what the hand did last is shown even if it has moved on.
static void advance(desk* d, double seconds, bool first)
{
    double start = ax_seconds();
    bool left = false, seen = false;
    for (int done = 0, count; done < ITERATIONS && !left && !seen && (!done || ax_seconds() - start < seconds);
         done += count) {
        count = d->swift                ? 1
                : d->iteration_time > 0 ? (int)ax_clamp(reaction / d->iteration_time, 1, ITERATIONS - done)
                                        : 1;
        iterate(d, count);
        left = !first && outdated(d);
        seen = seen_moving(d);
    }
    d->swift = seen;
    d->update_time = ax_seconds() - start;
    if (left)
        return;
    double move = show_moving(d, first);
    d->still = move < rest_move ? d->still + 1 : 0;
    if (d->still >= REST_UPDATES) {
        d->moving = false;
        d->settle_time = ax_seconds() - d->move_start;
    }
}

static void show_preview(desk* d, preview p)
{
    ax_error error = {0};
    d->hand_moved = ax_seconds();
    d->hand_came = p.came;
    if (json_is_null(p.step)) {
        desk_end_live(d);
        return;
    }
    const char* op = json_string_value(json_object_get(p.step, "op"));
    // another tool without an end between: what the last one did to rim and constraints must go
    if (d->live_op && op && strcmp(op, d->live_op) != 0)
        d->live_fresh = false;
    if (!begin_live(d))
        return;
    ax_form_prescribe(d->live, d->live_scale); // each preview holds the whole gesture
    char* text = json_dumps(p.step, JSON_COMPACT);
    ax_status status = text ? ax_operator_preview(text, d->folder, &d->live, &error)
                            : ax_fail(&error, AX_USAGE, "preview: the operator is no text.");
    free(text);
    if (status != AX_OK) {
        json_t* event = json_pack("{s:s, s:s, s:i, s:o}", "event", "problem", "do", "preview", "serial", (int)p.serial,
                                  "error", hub_problem(&error));
        hub_tell(d->hub, d, p.client, event);
        return;
    }
    free(d->live_op);
    d->live_op = op ? strdup(op) : NULL;
    use_live(d);
    d->previewing = true;
    d->hand_serial = p.serial;
    d->hand_of_serial = p.client;
    start_moving(d);
    advance(d, reaction, true);
}

static const char hand_name[] = "the hand";

static void follow_grab(desk* d, grab g)
{
    ax_error error = {0};
    d->hand_moved = ax_seconds();
    d->hand_came = g.came;
    if (!begin_live(d))
        return;
    ax_form_view v = ax_form_look(d->live);
    ax_status status = AX_OK;
    if (g.hinge >= v.linkage->hinge_count)
        status = ax_fail(&error, AX_USAGE, "grab: there are %d hinges.", v.linkage->hinge_count);
    else {
        const double places[1][3] = {{g.to[0], g.to[1], g.to[2]}};
        const ax_form_constraint hold = {.name = hand_name,
                                         .kind = AX_HELD_FIXED,
                                         .count = 1,
                                         .hinges = &g.hinge,
                                         .weight = 1,
                                         .places = places,
                                         .support = true};
        status = ax_form_put_constraint(d->live, &hold, &error);
    }
    if (status != AX_OK) {
        hub_tell(d->hub, d, g.client,
                 json_pack("{s:s, s:s, s:o}", "event", "problem", "do", "grab", "error", hub_problem(&error)));
        return;
    }
    use_live(d);
    d->holding = true;
    d->hand_serial = g.serial;
    d->hand_of_serial = g.client;
    start_moving(d);
    advance(d, reaction, true);
}

static void let_go(desk* d)
{
    if (!d->holding)
        return;
    ax_form_drop_constraint(d->live, hand_name);
    d->holding = false;
    d->hand_serial = 0;
    d->hand_of_serial = 0;
    start_moving(d);
}

void desk_play(desk* d)
{
    if (!begin_live(d))
        return;
    use_live(d);
    start_moving(d);
}

void desk_step(desk* d, int iterations)
{
    if (!begin_live(d))
        return;
    use_live(d);
    for (int done = 0; done < iterations && !gives_up(d); done += ITERATIONS) {
        ax_form_iterate(d->live, iterations - done < ITERATIONS ? iterations - done : ITERATIONS);
        show_moving(d, false);
    }
    d->rested = false;
}

void desk_restart(desk* d, double height)
{
    if (!begin_live(d))
        return;
    ax_form_reopen(d->live, height);
    use_live(d);
    d->moving = false;
}

// ---- the thread ---------------------------------------------------------------------------------------------------------------

static void free_job(job* j)
{
    message_free(&j->message);
    ax_free(j);
}

static void run_job(desk* d, job* j)
{
    ax_error error = {0};
    json_t* result = NULL;
    const job_type* type = job_find(j->message.action);
    begin_work(d, type->name, j->message.id);
    ax_status status = type->plain ? message_unpack(&j->message, &error, "{}") : AX_OK;
    if (status == AX_OK)
        status = type->run(d, j, &result, &error);
    find_exact(d);
    end_work(d);
    if (!d->moving && !d->rested)
        show_rest(d);
    show_document(d);
    if (status == AX_OK)
        hub_answer(d->hub, j->client, j->message.id, result);
    else {
        json_decref(result);
        hub_refuse(d->hub, j->client, j->message.id, j->message.action, &error);
    }
    free_job(j);
}

void desk_rename(desk* d, const char* id)
{
    json_t* event = d->linkage ? json_loads(d->linkage, 0, NULL) : NULL;
    json_object_set_new(event, "document", json_string(id));
    hub_lock(d->hub);
    hub_renamed(d->hub, d->id, id);
    free(d->id);
    d->id = strdup(id);
    if (event) {
        free(d->linkage);
        d->linkage = json_dumps(event, JSON_COMPACT);
    }
    hub_unlock(d->hub);
    json_decref(event);
}

ax_progress desk_progress(desk* d)
{
    return (ax_progress){.report = report_progress, .context = d};
}

static void end_desk(desk* d)
{
    ax_form_free(d->live);
    d->live = NULL;
    job_close(d, d->discard);
}

// One piece of work; false when the desk is to close. Commands come first, then the hand, then what moves by itself.
static bool work_once(desk* d)
{
    hub_lock(d->hub);
    for (;;) {
        if (d->closing) {
            hub_unlock(d->hub);
            return false;
        }
        if (d->pause) {
            d->pause = false;
            d->moving = false;
            continue;
        }
        job* j = d->first;
        if (j) {
            if (!(d->first = j->next))
                d->last = &d->first;
            __atomic_store_n(&d->cancel, false, __ATOMIC_RELAXED);
            hub_unlock(d->hub);
            run_job(d, j);
            return true;
        }
        if (d->preview.step) {
            preview p = d->preview;
            d->preview = (preview){0};
            d->hand = p.client;
            hub_unlock(d->hub);
            show_preview(d, p);
            json_decref(p.step);
            return true;
        }
        if (d->grab.wanted) {
            grab g = d->grab;
            d->grab.wanted = false;
            hub_unlock(d->hub);
            follow_grab(d, g);
            return true;
        }
        if (d->let_go) {
            d->let_go = false;
            d->hand = 0;
            hub_unlock(d->hub);
            let_go(d);
            return true;
        }
        if (d->moving) {
            double wait = d->published + frame_seconds - ax_seconds();
            if (wait > 1e-4) {
                struct timespec until;
                clock_gettime(CLOCK_MONOTONIC, &until);
                until.tv_nsec += (long)(1e9 * wait);
                if (until.tv_nsec >= 1000000000)
                    until.tv_sec += 1, until.tv_nsec -= 1000000000;
                pthread_cond_timedwait(&d->work, hub_mutex(d->hub), &until);
                continue;
            }
            hub_unlock(d->hub);
            advance(d, patience, false);
            return true;
        }
        if (!d->rested) {
            hub_unlock(d->hub);
            show_rest(d);
            show_document(d);
            return true;
        }
        if (!d->ready) {
            hub_unlock(d->hub);
            get_ready(d);
            return true;
        }
        pthread_cond_wait(&d->work, hub_mutex(d->hub));
    }
}

static void* work(void* context)
{
    desk* d = context;
    ax_error error = {0};
    begin_work(d, "open", d->opener_re);
    ax_status status = job_open(d, &error);
    if (status == AX_OK)
        find_exact(d);
    end_work(d);
    if (status == AX_OK) {
        show_rest(d);
        show_document(d);
    }
    if (status != AX_OK && d->opener)
        hub_show_before(d->hub, d->opener, d);
    else if (status != AX_OK) // pages may have come meanwhile
        hub_tell(d->hub, d, 0,
                 json_pack("{s:s, s:s, s:s}", "event", "closed", "document", d->id, "message", error.message));
    hub_lock(d->hub);
    d->opened = status == AX_OK;
    d->fault = error;
    d->ended = status != AX_OK;
    if (d->opened && d->opener)
        hub_show(d->hub, d->opener, d);
    pthread_cond_broadcast(&d->open);
    hub_unlock(d->hub);
    if (d->opener && status == AX_OK)
        hub_answer(d->hub, d->opener, d->opener_re, json_pack("{s:s}", "document", d->id));
    else if (d->opener)
        hub_refuse(d->hub, d->opener, d->opener_re, "open", &error);
    if (status == AX_OK)
        while (work_once(d))
            ;
    end_desk(d);
    hub_lock(d->hub);
    d->ended = true;
    hub_unlock(d->hub);
    return NULL;
}

desk* desk_open(hub* h, const char* id, desk_source source, int client, int re)
{
    desk* d = AX_NEW0(desk, 1);
    pthread_condattr_t clock;
    pthread_condattr_init(&clock);
    pthread_condattr_setclock(&clock, CLOCK_MONOTONIC);
    pthread_cond_init(&d->work, &clock);
    pthread_condattr_destroy(&clock);
    pthread_cond_init(&d->open, NULL);
    d->hub = h;
    d->id = strdup(id);
    d->source = source;
    d->opener = client;
    d->opener_re = re;
    d->last = &d->first;
    if (pthread_create(&d->thread, NULL, work, d) != 0) {
        ax_fail(&d->fault, AX_FAILED, "A thread for the document cannot be started: %s.", strerror(errno));
        d->ended = d->threadless = true;
    }
    return d;
}

ax_status desk_wait(desk* d, ax_error* error)
{
    hub_lock(d->hub);
    while (!d->opened && !d->ended && !d->watched)
        pthread_cond_wait(&d->open, hub_mutex(d->hub));
    if (d->ended && error)
        *error = d->fault;
    ax_status status = d->ended ? d->fault.status : AX_OK;
    hub_unlock(d->hub);
    return status;
}

void desk_close(desk* d, bool discard)
{
    hub_lock(d->hub);
    d->discard = discard;
    __atomic_store_n(&d->closing, true, __ATOMIC_RELAXED);
    pthread_cond_signal(&d->work);
    hub_unlock(d->hub);
    if (!d->threadless)
        pthread_join(d->thread, NULL);
    while (d->first) {
        job* j = d->first;
        d->first = j->next;
        ax_error error;
        ax_fail(&error, AX_CANCELLED, "The document was closed.");
        hub_refuse(d->hub, j->client, j->message.id, j->message.action, &error);
        free_job(j);
    }
    json_decref(d->preview.step);
    ax_form_report_free(&d->report);
    board_free(&d->board);
    for (int s = 0; s < SLOT_COUNT; ++s)
        free(d->events[s]);
    free(d->linkage);
    free(d->live_op);
    ax_free(d->live_scale);
    ax_free(d->last_places);
    ax_free(d->last_flat);
    ax_free(d->source.path);
    ax_free(d->source.example);
    ax_free(d->source.draft);
    ax_free(d->source.name);
    json_decref(d->source.recipe);
    json_decref(d->source.files);
    ax_free(d->path);
    ax_free(d->folder);
    ax_free(d->name);
    free(d->id);
    pthread_cond_destroy(&d->work);
    pthread_cond_destroy(&d->open);
    ax_free(d);
}
