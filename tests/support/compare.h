// Two designs are the same in every field and bit; NaN equals NaN.
#pragma once

#include "ax/design.h"

void assert_same_design(const ax_design* a, const ax_design* b);
// The same as a question.
bool same_design(const ax_design* a, const ax_design* b);
