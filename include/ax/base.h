// What every part of the library shares: how a call fails, how long work reports and is cancelled, and where memory comes
// from. Lengths are in the document's unit unless a comment says otherwise, angles in radians, everything in double.
#pragma once

#include <stdbool.h>
#include <stddef.h>

// Outcome of a call. The values are the exit codes of the command, so they never change.
typedef enum ax_status {
    AX_OK = 0,
    AX_FAILED = 1,         // anything else: no disk space, no memory, an iteration that did not converge
    AX_USAGE = 2,          // the request itself is malformed: an unknown option, a value out of its range
    AX_BAD_INPUT = 3,      // a file or mesh that cannot be used; the message says what, where and how to mend it
    AX_CANNOT_REALISE = 4, // sound input whose design cannot exist; the message names the limit, where, and what to try
    AX_CANCELLED = 130,    // the progress callback asked to stop
} ax_status;

// Filled by a call that does not return AX_OK; untouched otherwise. A NULL ax_error* is allowed everywhere.
typedef struct ax_error {
    ax_status status;
    char message[2048]; // complete sentences, no trailing newline
} ax_error;

// Long work calls `report` from the calling thread, at most some hundred times a second. `stage` is a short phrase
// ("Solving the joint system"), `fraction` is in [0, 1] within the whole call, `residual` is the stage's own stopping
// figure or NaN. Returning false cancels: the call then returns AX_CANCELLED and leaves its outputs empty.
typedef struct ax_progress {
    bool (*report)(void* context, const char* stage, double fraction, double residual);
    void* context;
} ax_progress;

// Fills `error` (if not NULL) with a printf-style message and returns `status`.
ax_status ax_fail(ax_error* error, ax_status status, const char* format, ...) __attribute__((format(printf, 3, 4)));

// Reports progress; true when the work should go on. A NULL progress always goes on.
bool ax_progress_report(const ax_progress* progress, const char* stage, double fraction, double residual);

// A part of `progress`: fractions 0..1 of the part are mapped to lo..hi of the whole. `slot` must outlive the result.
typedef struct ax_progress_part {
    const ax_progress* whole;
    double lo, hi;
    ax_progress part;
} ax_progress_part;
const ax_progress* ax_progress_within(ax_progress_part* slot, const ax_progress* whole, double lo, double hi);

// Memory. Allocation never returns NULL: exhaustion is not an input error that a caller could mend, so it goes to the
// handler set here, which must not return; the default aborts. Release with ax_free. Both are thread safe.
void* ax_alloc(size_t count, size_t size);         // uninitialised, count * size checked for overflow
void* ax_calloc(size_t count, size_t size);        // zeroed
void* ax_alloc_aligned(size_t count, size_t size); // uninitialised, on a 64-byte boundary; not for ax_realloc
void* ax_realloc(void* block, size_t count, size_t size);
void* ax_copy(const void* block, size_t count, size_t size); // NULL stays NULL
char* ax_copy_text(const char* text);                        // likewise
void ax_free(void* block);
// Gives freed memory back to the system: after work that held much of it for a short time. Takes milliseconds.
void ax_trim_memory(void);
void ax_set_out_of_memory(void (*handler)(size_t bytes));
// Number of allocations made so far by the library: tests use it to show that a steady state allocates nothing.
size_t ax_allocation_count(void);

// Typed forms, so that no call site repeats a sizeof.
#define AX_NEW(T, n)  ((T*)ax_alloc((size_t)(n), sizeof(T)))
#define AX_NEW0(T, n) ((T*)ax_calloc((size_t)(n), sizeof(T)))

// The candidate that a misspelt word most likely meant, by changed letters; NULL if none is near.
const char* ax_nearest_word(const char* word, int count, const char* const* candidates);

// The day of a time (seconds since 1970) in UTC, "2026-05-31"; empty if it is not finite or not within the years 1 to 9999.
void ax_day_words(double time, char words[16]);

// The folder of the example recipes, as long as the program; empty if they are not there.
const char* ax_examples_folder(void);

// Version of the library, "MAJOR.MINOR.PATCH".
const char* ax_version(void);
