// A single-stroke alphabet: one line per stroke, so that a laser or a pen draws letters instead of filling outlines. Capitals,
// digits and some signs; small letters are drawn as capitals, anything else as a box. The zero is crossed.
#pragma once

#include "ax/base.h"

// Lengths are in cap heights: letters stand on y = 0 and reach up to y = 1.
double ax_stroke_width(const char* text); // from the first to the last stroke's end

// Draws `text` (UTF-8) from x = 0 on: calls `pen` for every point, with down = false where a stroke begins.
void ax_stroke_text(const char* text, void (*pen)(void* context, bool down, double x, double y), void* context);
