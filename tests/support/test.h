// cmocka with the headers it wants before it.
#pragma once

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include <math.h>

// |a - b| <= tolerance, with all three printed when it is not so (NaN fails).
#define assert_near(a, b, tolerance) check_near((a), (b), (tolerance), #a, __FILE__, __LINE__)
// a <= limit (NaN fails).
#define assert_at_most(a, limit) check_at_most((a), (limit), #a, __FILE__, __LINE__)

static inline void check_near(double a, double b, double tolerance, const char* what, const char* file, int line)
{
    if (!(fabs(a - b) <= tolerance)) {
        print_error("%s is %.17g, not %.17g within %g\n", what, a, b, tolerance);
        _fail(file, line);
    }
}

static inline void check_at_most(double a, double limit, const char* what, const char* file, int line)
{
    if (!(a <= limit)) {
        print_error("%s is %.17g, more than %g\n", what, a, limit);
        _fail(file, line);
    }
}
