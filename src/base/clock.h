// Wall time in seconds from an arbitrary origin.
#pragma once

#include <time.h>

static inline double ax_seconds(void)
{
    struct timespec t;
    clock_gettime(CLOCK_MONOTONIC, &t);
    return (double)t.tv_sec + 1e-9 * (double)t.tv_nsec;
}
