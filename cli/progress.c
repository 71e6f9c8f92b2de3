#include "progress.h"

#include <math.h>
#include <signal.h>
#include <stdio.h>
#include <string.h>
#include <sys/ioctl.h>
#include <time.h>
#include <unistd.h>

static const double REWRITE_SECONDS = 0.1, PLAIN_SECONDS = 5;

static volatile sig_atomic_t cancelled;
static struct {
    const char* command;
    bool terminal, line_open;
    char stage[96];
    double stage_start, last_shown;
} state;

static double now(void)
{
    struct timespec t;
    clock_gettime(CLOCK_MONOTONIC, &t);
    return (double)t.tv_sec + 1e-9 * (double)t.tv_nsec;
}

static void stop(int signal_number)
{
    (void)signal_number;
    cancelled = 1;
}

void progress_install(const char* command)
{
    state.command = command;
    state.terminal = isatty(STDERR_FILENO);
    struct sigaction action = {.sa_handler = stop, .sa_flags = SA_RESTART | (int)SA_RESETHAND};
    sigaction(SIGINT, &action, NULL);
    sigaction(SIGTERM, &action, NULL);
    sigaction(SIGHUP, &action, NULL);
}

bool progress_cancelled(void)
{
    return cancelled;
}

static int terminal_width(void)
{
    struct winsize size;
    return ioctl(STDERR_FILENO, TIOCGWINSZ, &size) == 0 && size.ws_col > 20 ? size.ws_col : 80;
}

static bool report(void* context, const char* stage, double fraction, double residual)
{
    (void)context;
    double time = now();
    if (strncmp(stage, state.stage, sizeof state.stage - 1) != 0) {
        snprintf(state.stage, sizeof state.stage, "%s", stage);
        state.stage_start = time;
    }
    bool due = state.terminal ? time - state.last_shown > REWRITE_SECONDS
                              : time - state.stage_start > 1 && time - state.last_shown > PLAIN_SECONDS;
    if (due) {
        char figure[48] = "", line[256];
        if (isfinite(residual))
            snprintf(figure, sizeof figure, ", residual %.1e", residual);
        snprintf(line, sizeof line, "%3.0f %%  %s%s", 100 * fraction, stage, figure);
        if (state.terminal)
            fprintf(stderr, "\r\033[K%.*s", terminal_width() - 1, line);
        else
            fprintf(stderr, "auxshell %s: %s\n", state.command, line);
        fflush(stderr);
        state.line_open = state.terminal;
        state.last_shown = time;
    }
    return !cancelled;
}

const ax_progress* progress_reporter(void)
{
    static const ax_progress reporter = {.report = report};
    return &reporter;
}

void progress_end(void)
{
    if (state.line_open)
        fputs("\r\033[K", stderr);
    state.line_open = false;
}
