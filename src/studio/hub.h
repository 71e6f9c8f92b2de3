// Where pages and documents meet. The network thread hands in what clients send and takes out what is to be sent to them; each
// document has a desk, a thread of its own that solves. Nothing here knows of sockets.
//
// One lock guards everything that both sides see. It is held for copying, never for solving.
#pragma once

#include "studio/board.h"
#include "studio/files.h"
#include "studio/message.h"

#include <pthread.h>

enum { CLIENTS_MOST = 16, DESKS_MOST = 8, WAITING_MOST = 64 };

typedef struct hub hub;
typedef struct desk desk;
typedef struct hub_client hub_client;

// Events that replace the last one of their name.
typedef enum slot { SLOT_DOCUMENT, SLOT_REPORT, SLOT_STATUS, SLOT_PROGRESS, SLOT_VARIANTS, SLOT_COUNT } slot;

// A message on its way to one client; `before` bytes in front of the data are the transport's.
typedef struct parcel {
    struct parcel* next;
    bool binary;
    size_t size;
    unsigned char* block;
} parcel;

// ---- the network's side: one thread -------------------------------------------------------------------------------------------

// `wake` is called from any thread when a client has something to send. `before`: bytes that the transport wants before each
// message.
ax_status hub_open(const char* folder, size_t before, void (*wake)(void* context), void* context, hub** out,
                   ax_error* error);
// The document that pages show first; NULL: a live example.
ax_status hub_start(hub* h, const char* path, ax_error* error);
void hub_end_desks(hub* h); // with all they do
void hub_close(hub* h);     // clients must be gone
files* hub_files(hub* h);

hub_client* hub_join(hub* h); // NULL when there are too many
void hub_leave(hub* h, hub_client* c);
void hub_receive(hub* h, hub_client* c, const char* bytes, size_t size);
// The next message for the client, owned by the caller (ax_free block); false if there is none.
bool hub_next(hub* h, hub_client* c, parcel* out);
bool hub_waiting(hub* h, hub_client* c); // hub_next would give something
void hub_say_bye(hub* h, const char* words);

// ---- the desks' side ----------------------------------------------------------------------------------------------------------

void hub_lock(hub* h);
void hub_unlock(hub* h);
pthread_mutex_t* hub_mutex(hub* h); // for conditions
void hub_wake(hub* h);

// Answers command `re` of a client (by number; it may have gone): takes over `result`, an object or NULL for an empty one.
void hub_answer(hub* h, int client, int re, json_t* result);
void hub_refuse(hub* h, int client, int re, const char* action, const ax_error* error);
// An event to one client, or (0) to all that show the desk; takes over `event`.
void hub_tell(hub* h, const desk* d, int client, json_t* event);
// Binary, to one client: takes over `block`, made with hub_before bytes in front. Waits while the client has much to read yet;
// false if it has gone or `give_up` came true meanwhile.
size_t hub_before(const hub* h);
bool hub_send(hub* h, int client, unsigned char* block, size_t size, const bool* give_up);
// The client shows this desk from now on; with the lock held.
void hub_show(hub* h, int client, desk* d);
// The client that waits for this desk sees its states while it is made, and what it saw before if nothing comes of it.
void hub_show_making(hub* h, int client, desk* d);
void hub_show_before(hub* h, int client, desk* d);
// A document has another id from now on; with the lock held.
void hub_renamed(hub* h, const char* old, const char* id);
json_t* hub_problem(const ax_error* error);
