#include "studio/hub.h"

#include "studio/desk.h"
#include "studio/draft.h"
#include "studio/hello.h"

#include <errno.h>
#include <stdio.h>
#include <string.h>
#include <time.h>

enum { AHEAD_MOST = 8, QUEUED_BYTES = 8 << 20 };

struct hub_client {
    int number;
    desk* shown;
    desk* opening; // a document this client waits for
    desk* before;  // shown before that one, whose states are seen while it is made
    parcel *first, **last;
    size_t queued; // bytes
    int waiting;   // commands without an answer yet
    int ahead;     // state frames that may be on their way; 0: no limit
    int under_way;
    // what of the shown desk was sent already
    unsigned stamp, topology, events[SLOT_COUNT];
    unsigned opening_progress; // number of the last progress event of the document it waits for
};

struct hub {
    pthread_mutex_t lock;
    pthread_cond_t drained; // a client's queue got shorter, or a client left
    size_t before;
    void (*wake)(void* context);
    void* context;
    files* files;
    hub_client* clients[CLIENTS_MOST];
    desk* desks[DESKS_MOST];
    char* start; // id of the first document
    int numbers; // clients so far
};

void hub_lock(hub* h)
{
    pthread_mutex_lock(&h->lock);
}

void hub_unlock(hub* h)
{
    pthread_mutex_unlock(&h->lock);
}

pthread_mutex_t* hub_mutex(hub* h)
{
    return &h->lock;
}

void hub_wake(hub* h)
{
    h->wake(h->context);
}

files* hub_files(hub* h)
{
    return h->files;
}

size_t hub_before(const hub* h)
{
    return h->before;
}

// ---- to clients ---------------------------------------------------------------------------------------------------------------

static hub_client* find_client(const hub* h, int number)
{
    for (int k = 0; k < CLIENTS_MOST; ++k)
        if (h->clients[k] && h->clients[k]->number == number)
            return h->clients[k];
    return NULL;
}

static void push(hub_client* c, bool binary, unsigned char* block, size_t size)
{
    parcel* p = AX_NEW(parcel, 1);
    *p = (parcel){.binary = binary, .size = size, .block = block};
    *c->last = p;
    c->last = &p->next;
    c->queued += size;
}

static parcel text_parcel(const hub* h, const char* text)
{
    size_t size = strlen(text);
    parcel p = {.size = size, .block = ax_alloc(h->before + size, 1)};
    memcpy(p.block + h->before, text, size);
    return p;
}

static void push_text(const hub* h, hub_client* c, const char* text)
{
    parcel p = text_parcel(h, text);
    push(c, false, p.block, p.size);
}

static void push_json(const hub* h, hub_client* c, json_t* value)
{
    char* text = json_dumps(value, JSON_COMPACT);
    if (text)
        push_text(h, c, text);
    free(text);
}

json_t* hub_problem(const ax_error* error)
{
    static const char* const words[] = {"", "failed", "usage", "bad_input", "cannot_realise"};
    const char* word = error->status == AX_CANCELLED ? "cancelled" : words[error->status];
    json_t* problem = json_pack("{s:i, s:s, s:s}", "status", error->status, "word", word, "message", error->message);
    if (!problem) // a message that quotes bytes which are no text
        problem =
            json_pack("{s:i, s:s, s:s}", "status", error->status, "word", word, "message", "The input is no text.");
    return problem;
}

static void answer(hub* h, hub_client* c, int re, json_t* result)
{
    if (c && re) {
        json_t* whole = json_pack("{s:i, s:b}", "re", re, "ok", true);
        json_object_update(whole, result);
        push_json(h, c, whole);
        json_decref(whole);
    }
    json_decref(result);
}

static void refuse(hub* h, hub_client* c, int re, const char* action, const ax_error* error)
{
    if (!c)
        return;
    json_t* whole = re ? json_pack("{s:i, s:b}", "re", re, "ok", false) : json_pack("{s:s}", "event", "problem");
    if (!re && *action)
        json_object_set_new(whole, "do", json_string(action));
    json_object_set_new(whole, "error", hub_problem(error));
    push_json(h, c, whole);
    json_decref(whole);
}

void hub_answer(hub* h, int number, int re, json_t* result)
{
    hub_lock(h);
    hub_client* c = find_client(h, number);
    if (c)
        --c->waiting;
    answer(h, c, re, result);
    hub_unlock(h);
    hub_wake(h);
}

void hub_refuse(hub* h, int number, int re, const char* action, const ax_error* error)
{
    hub_lock(h);
    hub_client* c = find_client(h, number);
    if (c)
        --c->waiting;
    refuse(h, c, re, action, error);
    hub_unlock(h);
    hub_wake(h);
}

void hub_tell(hub* h, const desk* d, int number, json_t* event)
{
    char* text = json_dumps(event, JSON_COMPACT);
    json_decref(event);
    hub_lock(h);
    for (int k = 0; text && k < CLIENTS_MOST; ++k) {
        hub_client* c = h->clients[k];
        if (c && (number ? c->number == number : c->shown == d))
            push_text(h, c, text);
    }
    hub_unlock(h);
    free(text);
    hub_wake(h);
}

bool hub_send(hub* h, int number, unsigned char* block, size_t size, const bool* give_up)
{
    hub_lock(h);
    hub_client* c;
    while ((c = find_client(h, number)) && c->queued > QUEUED_BYTES && !(give_up && *give_up))
        pthread_cond_wait(&h->drained, &h->lock);
    bool sent = c && !(give_up && *give_up);
    if (sent)
        push(c, true, block, size);
    else
        ax_free(block);
    hub_unlock(h);
    hub_wake(h);
    return sent;
}

static void show(hub_client* c, desk* d)
{
    c->shown = d;
    c->stamp = c->topology = 0;
    c->under_way = 0;
    memset(c->events, 0, sizeof c->events);
    if (c->opening_progress)
        c->events[SLOT_PROGRESS] = c->opening_progress; // its end is still to be told
    else
        desk_event(d, SLOT_PROGRESS, &c->events[SLOT_PROGRESS]); // of work that may be long done
    c->opening_progress = 0;
}

void hub_show(hub* h, int number, desk* d)
{
    hub_client* c = find_client(h, number);
    if (!c)
        return;
    if (c->shown && c->shown != d)
        desk_client_gone(c->shown, number);
    c->before = NULL;
    if (c->opening == d) {
        c->opening = NULL;
        if (c->shown == d) // its states were seen while it was made
            return;
    }
    show(c, d);
}

void hub_show_making(hub* h, int number, desk* d)
{
    hub_lock(h);
    hub_client* c = find_client(h, number);
    if (c && c->opening == d && c->shown != d) {
        desk* before = c->shown;
        if (before)
            desk_client_gone(before, number);
        show(c, d);
        c->before = before;
    }
    hub_unlock(h);
    hub_wake(h);
}

void hub_show_before(hub* h, int number, desk* d)
{
    hub_lock(h);
    hub_client* c = find_client(h, number);
    if (c && c->opening == d)
        c->opening = NULL;
    if (c && c->shown == d) {
        c->shown = NULL;
        if (c->before)
            show(c, c->before);
        c->before = NULL;
    }
    hub_unlock(h);
    hub_wake(h);
}

void hub_say_bye(hub* h, const char* words)
{
    json_t* event = json_pack("{s:s, s:s}", "event", "bye", "message", words);
    hub_lock(h);
    for (int k = 0; k < CLIENTS_MOST; ++k)
        if (h->clients[k])
            push_json(h, h->clients[k], event);
    hub_unlock(h);
    json_decref(event);
    hub_wake(h);
}

// The newest events of the shown document, in the order of the enum.
static bool next_event(hub* h, hub_client* c, parcel* out)
{
    for (int s = 0; s < SLOT_COUNT; ++s) {
        unsigned number = 0;
        const char* text = desk_event(c->shown, (slot)s, &number);
        if (text && number != c->events[s]) {
            if (out) {
                c->events[s] = number;
                *out = text_parcel(h, text);
            }
            return true;
        }
    }
    return false;
}

// How far the document is that the client waits for; what it shows meanwhile is another.
static bool next_progress(hub* h, hub_client* c, parcel* out)
{
    unsigned number = 0;
    const char* text = c->opening && c->opening != c->shown ? desk_event(c->opening, SLOT_PROGRESS, &number) : NULL;
    if (!text || number == c->opening_progress)
        return false;
    if (out) {
        c->opening_progress = number;
        *out = text_parcel(h, text);
    }
    return true;
}

static bool next_frame(hub* h, hub_client* c, parcel* out)
{
    const board* b = desk_board(c->shown);
    if (!b->topology || b->stamp == c->stamp || (c->ahead && c->under_way >= c->ahead))
        return false;
    if (!out)
        return true;
    if (b->topology != c->topology) { // its event goes first, then everything
        c->topology = b->topology;
        c->stamp = 0;
        *out = text_parcel(h, desk_linkage(c->shown));
        return true;
    }
    *out = (parcel){.binary = true};
    frame_header header = {.kind = FRAME_STATE, .serial = desk_serial(c->shown, c->number)};
    out->block = board_frame(b, header, c->stamp, h->before, &out->size);
    c->stamp = b->stamp;
    ++c->under_way;
    return true;
}

// What a command caused goes before its answer, and answers before frames, of which there may be no end.
static bool next(hub* h, hub_client* c, parcel* out)
{
    if (next_progress(h, c, out) || (c->shown && next_event(h, c, out)))
        return true;
    if (c->first) {
        if (out) {
            parcel* p = c->first;
            *out = *p;
            c->queued -= p->size;
            if (!(c->first = p->next))
                c->last = &c->first;
            ax_free(p);
            pthread_cond_broadcast(&h->drained);
        }
        return true;
    }
    return c->shown && next_frame(h, c, out);
}

bool hub_next(hub* h, hub_client* c, parcel* out)
{
    hub_lock(h);
    bool some = next(h, c, out);
    hub_unlock(h);
    return some;
}

bool hub_waiting(hub* h, hub_client* c)
{
    hub_lock(h);
    bool some = next(h, c, NULL);
    hub_unlock(h);
    return some;
}

void hub_renamed(hub* h, const char* old, const char* id)
{
    if (strcmp(h->start, old) == 0) {
        ax_free(h->start);
        h->start = ax_copy_text(id);
    }
}

// ---- desks --------------------------------------------------------------------------------------------------------------------

static desk* find_desk(const hub* h, const char* id)
{
    for (int k = 0; k < DESKS_MOST; ++k)
        if (h->desks[k] && !desk_ended(h->desks[k]) && strcmp(desk_id(h->desks[k]), id) == 0)
            return h->desks[k];
    return NULL;
}

static bool is_shown(const hub* h, const desk* d)
{
    for (int k = 0; k < CLIENTS_MOST; ++k)
        if (h->clients[k] && (h->clients[k]->shown == d || h->clients[k]->opening == d || h->clients[k]->before == d))
            return true;
    return false;
}

// Closes desks that have ended. The lock is held, and let go meanwhile.
static void reap(hub* h)
{
    for (int k = 0; k < DESKS_MOST; ++k) {
        desk* d = h->desks[k];
        if (!d || !desk_ended(d))
            continue;
        h->desks[k] = NULL;
        for (int i = 0; i < CLIENTS_MOST; ++i) {
            hub_client* c = h->clients[i];
            if (c && c->shown == d)
                c->shown = NULL;
            if (c && c->opening == d)
                c->opening = NULL;
            if (c && c->before == d)
                c->before = NULL;
        }
        hub_unlock(h);
        desk_close(d, false);
        hub_lock(h);
    }
}

// Room for one more: a free place, or that of a document which no page shows.
static ax_status find_place(hub* h, int* place, ax_error* error)
{
    reap(h);
    for (int k = 0; k < DESKS_MOST; ++k)
        if (!h->desks[k]) {
            *place = k;
            return AX_OK;
        }
    for (int k = 0; k < DESKS_MOST; ++k)
        if (!is_shown(h, h->desks[k])) {
            desk* d = h->desks[k];
            h->desks[k] = NULL;
            hub_unlock(h);
            desk_close(d, false);
            hub_lock(h);
            *place = k;
            return AX_OK;
        }
    return ax_fail(error, AX_USAGE, "%d documents are open already. Close one of them first.", DESKS_MOST);
}

static void free_source(desk_source* s)
{
    ax_free(s->path);
    ax_free(s->example);
    ax_free(s->draft);
    ax_free(s->name);
    json_decref(s->recipe);
    json_decref(s->files);
    *s = (desk_source){0};
}

// Opens, or shows what is open already. Takes over `source`.
static ax_status open_desk(hub* h, hub_client* c, int re, const char* id, desk_source source, ax_error* error)
{
    desk* open = find_desk(h, id);
    if (open) {
        free_source(&source);
        if (c) {
            hub_show(h, c->number, open);
            answer(h, c, re, json_pack("{s:s}", "document", id));
        }
        return AX_OK;
    }
    int place = -1;
    ax_status status = find_place(h, &place, error);
    if (status != AX_OK) {
        free_source(&source);
        return status;
    }
    h->desks[place] = desk_open(h, id, source, c ? c->number : 0, re);
    if (c) {
        c->opening = h->desks[place];
        c->opening_progress = 0;
        ++c->waiting;
    }
    return AX_OK;
}

static bool is_document(const char* path)
{
    size_t length = strlen(path);
    return length > 9 && strcasecmp(path + length - 9, ".auxshell") == 0;
}

// Documents are edited where they are and go by their paths; recipes become new documents.
static ax_status open_path(hub* h, hub_client* c, int re, const char* path, ax_error* error)
{
    char *whole, draft[DRAFT_ID];
    ax_status status = files_within(h->files, path, &whole, error);
    if (status != AX_OK)
        return status;
    bool document = is_document(path);
    if (!document)
        status = draft_new_id(draft, error);
    if (status == AX_OK)
        status = open_desk(h, c, re, document ? files_relative(h->files, whole) : draft,
                           (desk_source){.path = ax_copy_text(whole)}, error);
    ax_free(whole);
    return status;
}

// ---- commands of the hub itself ---------------------------------------------------------------------------------------------

static ax_status join(hub* h, hub_client* c, const message* m, ax_error* error)
{
    const char *id = NULL, *path = NULL;
    int ahead = 0;
    ax_status status = message_unpack(m, error, "{s?s, s?s, s?i}", "document", &id, "path", &path, "ahead", &ahead);
    if (status != AX_OK)
        return status;
    if (ahead < 0 || ahead > AHEAD_MOST)
        return ax_fail(error, AX_USAGE, "join: \"ahead\" is 0 to %d.", AHEAD_MOST);
    c->ahead = ahead;
    if (path)
        return open_path(h, c, m->id, path, error);
    desk* d = find_desk(h, id ? id : h->start);
    if (d) {
        hub_show(h, c->number, d);
        answer(h, c, m->id, json_pack("{s:s}", "document", desk_id(d)));
        return AX_OK;
    }
    if (!id)
        return ax_fail(error, AX_USAGE, "The first document was closed. Open one, or make a new one.");
    if (draft_exists(id))
        return open_desk(h, c, m->id, id, (desk_source){.draft = ax_copy_text(id)}, error);
    if (strchr(id, '.')) // ids of files are their paths
        return open_path(h, c, m->id, id, error);
    return ax_fail(error, AX_BAD_INPUT, "There is no document \"%.100s\" in this run.", id);
}

static ax_status open_document(hub* h, hub_client* c, const message* m, ax_error* error)
{
    const char *path = NULL, *upload = NULL, *draft = NULL;
    ax_status status =
        message_unpack(m, error, "{s?s, s?s, s?s}", "path", &path, "upload", &upload, "recovered", &draft);
    if (status != AX_OK)
        return status;
    if (!!path + !!upload + !!draft != 1)
        return ax_fail(error, AX_USAGE, "open: name one of \"path\", \"upload\" and \"recovered\".");
    if (path)
        return open_path(h, c, m->id, path, error);
    if (draft && !draft_exists(draft))
        return ax_fail(error, AX_BAD_INPUT, "There is no unsaved document \"%.100s\".", draft);
    if (draft)
        return open_desk(h, c, m->id, draft, (desk_source){.draft = ax_copy_text(draft)}, error);
    char *file, name[NAME_LENGTH + 1], id[DRAFT_ID];
    status = files_upload(h->files, upload, &file, name, error);
    if (status == AX_OK)
        status = draft_new_id(id, error);
    if (status != AX_OK)
        return status;
    return open_desk(h, c, m->id, id, (desk_source){.path = file, .uploaded = true, .name = ax_copy_text(name)}, error);
}

static ax_status new_document(hub* h, hub_client* c, const message* m, ax_error* error)
{
    json_t *recipe = NULL, *uploads = NULL;
    const char *example = NULL, *name = NULL;
    ax_status status = message_unpack(m, error, "{s?o, s?o, s?s, s?s}", "recipe", &recipe, "files", &uploads, "example",
                                      &example, "name", &name);
    if (status != AX_OK)
        return status;
    if (!recipe == !example)
        return ax_fail(error, AX_USAGE, "new: give \"recipe\", a list of steps, or \"example\".");
    if (recipe && (!json_is_array(recipe) || !json_array_size(recipe)))
        return ax_fail(error, AX_USAGE, "new: \"recipe\" is a list of steps, the first of which starts the design.");
    if (uploads && !json_is_object(uploads))
        return ax_fail(error, AX_USAGE, "new: \"files\" is an object: names, and the tokens of uploads.");
    char id[DRAFT_ID];
    status = draft_new_id(id, error);
    if (status != AX_OK)
        return status;
    desk_source source = {.example = ax_copy_text(example),
                          .name = ax_copy_text(name),
                          .recipe = json_incref(recipe),
                          .files = json_incref(uploads)};
    return open_desk(h, c, m->id, id, source, error);
}

static ax_status list_files(hub* h, hub_client* c, const message* m, ax_error* error)
{
    const char* folder = NULL;
    json_t* list = NULL;
    ax_status status = message_unpack(m, error, "{s?s}", "folder", &folder);
    if (status == AX_OK)
        status = files_list(h->files, folder, &list, error);
    if (status == AX_OK)
        answer(h, c, m->id, json_pack("{s:o}", "files", list));
    return status;
}

static ax_status cancel(hub* h, hub_client* c, const message* m, ax_error* error)
{
    (void)error;
    if (c->shown)
        desk_cancel(c->shown);
    if (c->opening)
        desk_cancel(c->opening);
    pthread_cond_broadcast(&h->drained);
    answer(h, c, m->id, NULL);
    return AX_OK;
}

// For everyone who sees it: a document that others look at is not taken from them in silence.
static ax_status close_document(hub* h, hub_client* c, const message* m, ax_error* error)
{
    int discard = 0;
    ax_status status = message_unpack(m, error, "{s?b}", "discard", &discard);
    desk* d = c->shown;
    if (status == AX_OK && !d)
        status = ax_fail(error, AX_USAGE, "close: no document is shown.");
    if (status == AX_OK && d == c->opening)
        status = ax_fail(error, AX_USAGE, "close: the document is being made: cancel that.");
    if (status != AX_OK)
        return status;
    json_t* event =
        json_pack("{s:s, s:s, s:s}", "event", "closed", "document", desk_id(d), "message", "The document was closed.");
    for (int k = 0; k < DESKS_MOST; ++k)
        if (h->desks[k] == d)
            h->desks[k] = NULL;
    for (int k = 0; k < CLIENTS_MOST; ++k) {
        hub_client* other = h->clients[k];
        if (other && other->before == d)
            other->before = NULL;
        if (!other || other->shown != d)
            continue;
        other->shown = NULL;
        if (other != c)
            push_json(h, other, event);
    }
    json_decref(event);
    hub_unlock(h);
    desk_close(d, discard);
    hub_lock(h);
    answer(h, c, m->id, NULL);
    return AX_OK;
}

static ax_status seen(hub* h, hub_client* c, const message* m, ax_error* error)
{
    (void)error;
    if (c->under_way)
        --c->under_way;
    answer(h, c, m->id, NULL);
    return AX_OK;
}

typedef struct hub_action {
    const char* name;
    ax_status (*run)(hub* h, hub_client* c, const message* m, ax_error* error);
} hub_action;

static const hub_action actions[] = {{"join", join},        {"open", open_document}, {"new", new_document},
                                     {"files", list_files}, {"cancel", cancel},      {"close", close_document},
                                     {"seen", seen}};

// Commands that go past the line of those that wait.
static ax_status at_once(hub* h, hub_client* c, message* m, bool* known, ax_error* error)
{
    desk* d = c->shown;
    ax_status status = AX_OK;
    *known = true;
    if (strcmp(m->action, "preview") == 0)
        return desk_preview(d, c->number, m, error);
    if (strcmp(m->action, "grab") == 0)
        return desk_grab(d, c->number, m, error);
    if (strcmp(m->action, "release") == 0)
        desk_release(d, c->number);
    else if (strcmp(m->action, "pause") == 0)
        desk_pause(d);
    else
        *known = false;
    if (*known)
        answer(h, c, m->id, NULL);
    return status;
}

static ax_status carry_out(hub* h, hub_client* c, message* m, ax_error* error)
{
    for (size_t k = 0; k < sizeof actions / sizeof *actions; ++k)
        if (strcmp(m->action, actions[k].name) == 0)
            return actions[k].run(h, c, m, error);
    bool known = false;
    if (!c->shown)
        return ax_fail(error, AX_USAGE, "%s: no document is shown: \"join\" comes first.", m->action);
    ax_status status = at_once(h, c, m, &known, error);
    if (known)
        return status;
    if (!desk_knows(m->action))
        return ax_fail(error, AX_USAGE, "There is no command \"%s\".", m->action);
    if (c->waiting >= WAITING_MOST)
        return ax_fail(error, AX_USAGE, "%s: %d commands wait for their answer already.", m->action, WAITING_MOST);
    ++c->waiting;
    desk_command(c->shown, c->number, m);
    return AX_OK;
}

void hub_receive(hub* h, hub_client* c, const char* bytes, size_t size)
{
    message m;
    ax_error error = {0};
    ax_status status = message_read(bytes, size, &m, &error);
    int id = m.id;
    char action[sizeof m.action];
    memcpy(action, m.action, sizeof action);
    hub_lock(h);
    reap(h);
    if (status == AX_OK)
        status = carry_out(h, c, &m, &error);
    if (status != AX_OK)
        refuse(h, c, id, action, &error);
    hub_unlock(h);
    message_free(&m);
    hub_wake(h);
}

// ---- life ---------------------------------------------------------------------------------------------------------------------

ax_status hub_open(const char* folder, size_t before, void (*wake)(void* context), void* context, hub** out,
                   ax_error* error)
{
    files* f;
    *out = NULL;
    ax_status status = files_open(folder, &f, error);
    if (status != AX_OK)
        return status;
    hub* h = AX_NEW0(hub, 1);
    h->files = f;
    h->before = before;
    h->wake = wake;
    h->context = context;
    pthread_mutex_init(&h->lock, NULL);
    pthread_cond_init(&h->drained, NULL);
    *out = h;
    return AX_OK;
}

ax_status hub_start(hub* h, const char* path, ax_error* error)
{
    char id[DRAFT_ID];
    desk_source source = {0};
    ax_status status;
    if (path)
        status = files_within(h->files, path, &source.path, error);
    else {
        source.example = ax_copy_text(hello_first_example());
        status = AX_OK;
    }
    if (status == AX_OK)
        status = draft_new_id(id, error);
    if (status == AX_OK)
        h->start = ax_copy_text(path && is_document(path) ? files_relative(h->files, source.path) : id);
    if (status != AX_OK) {
        free_source(&source);
        return status;
    }
    hub_lock(h);
    h->desks[0] = desk_open(h, h->start, source, 0, 0);
    hub_unlock(h);
    return path ? desk_wait(h->desks[0], error) : AX_OK; // pages may come while the example is being made
}

void hub_end_desks(hub* h)
{
    for (int k = 0; k < DESKS_MOST; ++k) {
        hub_lock(h);
        desk* d = h->desks[k];
        h->desks[k] = NULL;
        for (int i = 0; d && i < CLIENTS_MOST; ++i)
            if (h->clients[i] && h->clients[i]->shown == d)
                h->clients[i]->shown = NULL;
        hub_unlock(h);
        if (d)
            desk_close(d, false);
    }
}

void hub_close(hub* h)
{
    if (!h)
        return;
    hub_end_desks(h);
    files_close(h->files);
    pthread_cond_destroy(&h->drained);
    pthread_mutex_destroy(&h->lock);
    ax_free(h->start);
    ax_free(h);
}

hub_client* hub_join(hub* h)
{
    hub_lock(h);
    hub_client* c = NULL;
    for (int k = 0; k < CLIENTS_MOST && !c; ++k)
        if (!h->clients[k]) {
            c = h->clients[k] = AX_NEW0(hub_client, 1);
            c->number = ++h->numbers;
            c->last = &c->first;
            json_t* hello = hello_event(files_folder(h->files), h->start, c->number);
            push_json(h, c, hello);
            json_decref(hello);
        }
    hub_unlock(h);
    return c;
}

void hub_leave(hub* h, hub_client* c)
{
    hub_lock(h);
    if (c->shown)
        desk_client_gone(c->shown, c->number);
    for (int k = 0; k < CLIENTS_MOST; ++k)
        if (h->clients[k] == c)
            h->clients[k] = NULL;
    pthread_cond_broadcast(&h->drained);
    hub_unlock(h);
    while (c->first) {
        parcel* p = c->first;
        c->first = p->next;
        ax_free(p->block);
        ax_free(p);
    }
    ax_free(c);
}
