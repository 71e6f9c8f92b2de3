// Formulas of position: 1.3 + 0.4*exp(-(x^2+y^2)/0.5).
//
// Numbers, pi, the caller's variables; + - * / ^ (binds to the right, tighter than a sign), comparisons < <= > >= == != (1 or 0),
// and && || !, condition ? a : b, parentheses; abs acos asin atan atan2(y,x) ceil clamp(v,lo,hi) cos cosh exp floor hypot if(c,a,b)
// log log10 max min (2 or more) mod pow round sign sin sinh smoothstep(a,b,v) sqrt step(edge,v) tan tanh. Angles in radians.
// A formula has no side effects; both sides of a condition are evaluated, in a time bounded by the length of the text.
#pragma once

#include "ax/base.h"

enum { AX_FORMULA_LENGTH = 4096 }; // characters at most

typedef struct ax_formula ax_formula;

// `variables` are the names of what ax_formula_value is given, in order. AX_BAD_INPUT names the column (from 1) and what was
// expected there.
ax_status ax_formula_parse(const char* text, int variable_count, const char* const* variables, ax_formula** out,
                           ax_error* error);
void ax_formula_free(ax_formula* formula);

// May be NaN or infinite: 1/x at 0, log of a negative number. Allocates nothing; safe to call from several threads.
double ax_formula_value(const ax_formula* formula, const double* variables);
