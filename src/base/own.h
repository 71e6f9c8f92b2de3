// Where the files are that belong to the program.
#pragma once

#include <stdbool.h>

enum { AX_OWN_PATH = 4096 }; // bytes

// The first that is there of: `beside`, relative to the folder of the running program; `built`, where the build has it; `installed`,
// where it was to be installed. False if none is; `out` is empty then.
bool ax_own_path(const char* beside, const char* built, const char* installed, char out[AX_OWN_PATH]);
