// auxshell studio: serves the studio's page until it is interrupted.
#include "options.h"
#include "progress.h"

#include "ax/studio.h"

#include <signal.h>
#include <spawn.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

extern char** environ;

typedef struct arguments {
    const char* document;
    int port;
    bool no_browser;
} arguments;

static const command_option options[] = {
    {.name = "DOCUMENT",
     .operand = true,
     .kind = OPTION_TEXT,
     .offset = offsetof(arguments, document),
     .text =
         "A document, a recipe, or a folder whose files are to be used. Without it, the studio starts on an example.",
     .fallback = "an example, and the files of this folder"},
    {.name = "--port",
     .value = "N",
     .kind = OPTION_INTEGER,
     .offset = offsetof(arguments, port),
     .lo = 1024,
     .hi = 65535,
     .text = "The port of the address.",
     .fallback = "one that is free"},
    {.name = "--no-browser",
     .kind = OPTION_FLAG,
     .offset = offsetof(arguments, no_browser),
     .text = "Print the address only, do not open it."},
};

// A browser is opened where there is a desktop; the address is printed in any case.
static void open_browser(const char* address)
{
    if (!getenv("DISPLAY") && !getenv("WAYLAND_DISPLAY"))
        return;
    char program[] = "xdg-open";
    char* words[] = {program, (char*)address, NULL};
    pid_t child;
    posix_spawnp(&child, program, NULL, NULL, words, environ);
}

static ax_status run(const void* given, ax_error* error)
{
    const arguments* a = given;
    ax_studio_options studio_options = {.port = a->port};
    struct stat about;
    char folder[4096] = ".";
    if (a->document && stat(a->document, &about) == 0 && S_ISDIR(about.st_mode))
        studio_options.folder = a->document;
    else if (a->document) { // its files are those beside it
        const char* slash = strrchr(a->document, '/');
        if (slash &&
            snprintf(folder, sizeof folder, "%.*s", (int)(slash - a->document) + 1, a->document) >= (int)sizeof folder)
            return ax_fail(error, AX_USAGE, "The path of the document is too long.");
        studio_options.folder = folder;
        studio_options.document = slash ? slash + 1 : a->document;
    }
    // Signals are waited for, not handled: the studio's threads never see them.
    sigset_t ends;
    sigemptyset(&ends);
    sigaddset(&ends, SIGINT);
    sigaddset(&ends, SIGTERM);
    sigaddset(&ends, SIGHUP);
    ax_studio* studio;
    ax_status status = ax_studio_start(&studio_options, &studio, error);
    if (status != AX_OK)
        return status;
    pthread_sigmask(SIG_BLOCK, &ends, NULL);
    printf("%s\n", ax_studio_address(studio));
    fflush(stdout);
    if (!a->no_browser)
        open_browser(ax_studio_address(studio));
    int signal;
    sigwait(&ends, &signal);
    ax_studio_stop(studio);
    return AX_OK;
}

const command command_studio = {
    .name = "studio",
    .summary = "design in the browser: paint, pull, and watch it deploy",
    .text = "Serves the studio on this machine only and prints its address, which holds a secret that is new at every "
            "start. Flat and deployed state are solved while the hand moves.\n\nEvery gesture is saved at once. An "
            "interrupt (Ctrl-C) ends the studio.",
    .options = options,
    .option_count = sizeof options / sizeof *options,
    .size = sizeof(arguments),
    .run = run,
};
