// Progress on stderr and cancellation by signals.
#pragma once

#include "ax/base.h"

// Takes SIGINT, SIGTERM and SIGHUP as a wish to stop; a second one ends the process at once.
void progress_install(const char* command);
// Reports to a rewriting line if stderr is a terminal, else a plain line now and then once a stage takes over a second;
// cancels after a signal.
const ax_progress* progress_reporter(void);
bool progress_cancelled(void);
// Ends the rewriting line. Call before anything else is printed.
void progress_end(void);
