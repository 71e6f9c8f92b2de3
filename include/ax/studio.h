// The studio: a server for one page on this machine, which edits documents over a WebSocket while the solver runs. The page is in
// the program. docs/protocol.md is its whole interface.
#pragma once

#include "ax/base.h"

typedef struct ax_studio ax_studio;

typedef struct ax_studio_options {
    const char* folder;   // files are opened and saved within it; NULL: the working directory
    const char* document; // shown first, a path; NULL: a live example
    int port;             // 1024 to 65535; 0: one that is free
} ax_studio_options;

// Starts serving on the loopback interface, on threads of its own, which block all signals. AX_BAD_INPUT when the document cannot
// be opened, AX_FAILED when the port is taken.
ax_status ax_studio_start(const ax_studio_options* options, ax_studio** out, ax_error* error);
// "http://127.0.0.1:PORT/SECRET/", as long as the studio.
const char* ax_studio_address(const ax_studio* studio);
// Ends long work, tells every page, and frees the studio. What was edited is in its files before this returns.
void ax_studio_stop(ax_studio* studio);
