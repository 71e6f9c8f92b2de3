// A desk's insides, and the commands that it carries out in order.
#pragma once

#include "ax/session.h"
#include "studio/desk.h"
#include "studio/shape.h"

typedef struct job {
    struct job* next;
    int client;
    message message;
} job;

typedef struct preview {
    json_t* step; // null: ends it; NULL: there is none
    int client;
    unsigned serial;
    double came; // seconds
} preview;

typedef struct grab {
    bool wanted;
    int hinge, client;
    unsigned serial;
    double to[3], came;
} grab;

struct desk {
    hub* hub;
    pthread_t thread;
    bool threadless; // the thread could not be started
    int opener, opener_re;
    desk_source source;

    // with the hub's lock
    char* id;
    pthread_cond_t work, open;
    bool opened, ended, discard;
    ax_error fault; // why it is not open
    job *first, **last;
    preview preview;
    grab grab;
    bool let_go, pause;
    int hand;             // client whose gesture goes on, 0: none
    bool cancel, closing; // atomic
    board board;
    int shown_hand; // whose serial the board contains
    unsigned shown_serial;
    char* linkage;
    char* events[SLOT_COUNT];
    unsigned event_numbers[SLOT_COUNT];

    // the thread's own
    ax_session* session;
    const ax_design* exact;     // of the present state, if it is finished
    bool draft;                 // it has no name yet
    int beginning;              // moments of its history that nobody edited
    char *name, *path, *folder; // path: of the document's file; folder: where steps find files
    ax_form* live;              // what the hand pulls about, a copy of the session's form
    double* live_scale;         // its prescribed factors before the gesture
    char* live_op;              // the operator that is being previewed
    bool watched;               // it was shown while it was made
    bool live_fresh, live_shown, previewing, holding, moving, busy, rested, ready, was_exact;
    unsigned hand_serial;
    int hand_of_serial;
    int still;  // updates in which nothing moved
    bool swift; // what moves by itself is to be seen moving: one iteration at a time
    shape_frame frame;
    double (*last_places)[3], (*last_flat)[2]; // as published last
    int last_count;
    ax_form_report report;
    double published, measured, measure_time, reported, report_time, iteration_time, update_time, settle_time,
        move_start, hand_came, hand_moved; // what the hand did last came, and was begun on
    const char* job_name;
    int job_id;
    double job_start, progressed;
};

typedef struct job_type {
    const char* name;
    bool edits; // ends what the hand is at
    ax_status (*run)(desk* d, const job* j, json_t** result, ax_error* error);
    bool plain; // takes no parameters
} job_type;

const job_type* job_find(const char* action);
// Opens what the desk was made for, and closes it.
ax_status job_open(desk* d, ax_error* error);
void job_close(desk* d, bool discard);

// For jobs: the desk's own doings.
ax_progress desk_progress(desk* d);
ax_form* desk_form(const desk* d); // what is shown; NULL: nothing yet
void desk_end_live(desk* d);
void desk_play(desk* d);
void desk_step(desk* d, int iterations);
void desk_restart(desk* d, double height);
void desk_rename(desk* d, const char* id);
void desk_begin_edit(desk* d); // before every change of the document
json_t* job_variants(const desk* d);

// The commands of one file, ended by a row without a name.
extern const job_type job_types_steps[], job_types_dynamics[], job_types_files[], job_types_variants[];
