// The two formats behind ax_outline_parse. Each draws a whole file, whose bytes end with a zero, with the pen; `unit` is the length of
// a document unit in metres.
#pragma once

#include "input/pen.h"

void ax_svg_draw(ax_pen* pen, const char* bytes, size_t size, double unit);
void ax_dxf_draw(ax_pen* pen, const char* bytes, size_t size, double unit);
