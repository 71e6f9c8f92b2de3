// Profiles as text.
#pragma once

#include "ax/fabricate.h"

// Reads a profile from JSON (docs/making.md). AX_BAD_INPUT with the fault and its place, for a sentence about the file.
ax_status ax_profile_parse(const char* text, size_t length, ax_profile* profile, ax_error* error);
