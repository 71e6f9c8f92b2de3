// splitmix64 (Steele, Lea and Flood 2014): the same sequence everywhere, seeded by a number that can be printed.
#pragma once

#include <stdint.h>

typedef struct ax_random {
    uint64_t state;
} ax_random;

static inline uint64_t ax_random_bits(ax_random* random)
{
    uint64_t z = random->state += 0x9e3779b97f4a7c15u;
    z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9u;
    z = (z ^ (z >> 27)) * 0x94d049bb133111ebu;
    return z ^ (z >> 31);
}

// Uniform in [lo, hi).
static inline double ax_random_uniform(ax_random* random, double lo, double hi)
{
    return lo + (hi - lo) * (double)(ax_random_bits(random) >> 11) * 0x1p-53;
}
