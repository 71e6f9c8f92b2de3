// One open document: a thread that carries out its commands in order, follows the hand meanwhile, and rests when nothing moves.
#pragma once

#include "studio/hub.h"

// What is opened: exactly one is given; owned by the desk.
typedef struct desk_source {
    char* path;     // a document or recipe on disk, absolute
    bool uploaded;  // with path: it is a copy that goes with the studio
    char* example;  // by name
    char* draft;    // an unsaved document of an earlier run, by name
    json_t* recipe; // steps of a new document
    json_t* files;  // with recipe: uploads by the names under which steps refer to them
    char* name;     // of a new document; NULL: untitled
} desk_source;

// Opens a document on a new thread. When it is open, `client` (if any) is shown it and its command `re` answered; if it cannot be,
// the command is refused and the desk ends. `id` is copied.
desk* desk_open(hub* h, const char* id, desk_source source, int client, int re);
// Waits until it is open, or its first state is there to be watched while it is made. AX_OK, or what came instead.
ax_status desk_wait(desk* d, ax_error* error);
// Ends long work and waits for the thread; without the lock held. `discard`: a document without a name is not kept.
void desk_close(desk* d, bool discard);

// The rest is called with the hub's lock held.
const char* desk_id(const desk* d);
bool desk_ended(const desk* d); // its thread has nothing more to do: to be closed
// A command that the desk knows waits its turn, and is answered then; takes over the message's parameters.
bool desk_knows(const char* action);
void desk_command(desk* d, int client, message* m);
// These do not wait behind other commands.
ax_status desk_preview(desk* d, int client, message* m, ax_error* error);
ax_status desk_grab(desk* d, int client, message* m, ax_error* error);
void desk_release(desk* d, int client);
void desk_pause(desk* d);
void desk_cancel(desk* d);
void desk_client_gone(desk* d, int client);

const board* desk_board(const desk* d);
const char* desk_linkage(const desk* d); // the event that goes before frames of the board's topology; NULL: none yet
// The newest event of a kind, and its number, which rises; NULL: none yet.
const char* desk_event(const desk* d, slot s, unsigned* number);
// Newest preview of this client that the board contains.
unsigned desk_serial(const desk* d, int client);
