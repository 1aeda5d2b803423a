/* Reproducible random numbers for C tests: splitmix64 (Steele, Lea, Flood, "Fast splittable pseudorandom number
 * generators", OOPSLA 2014). */
#ifndef VOX_TESTS_RANDOM_H
#define VOX_TESTS_RANDOM_H

#include <stdint.h>

static inline uint64_t random_next(uint64_t* state) {
    uint64_t z = *state += 0x9e3779b97f4a7c15u;
    z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9u;
    z = (z ^ (z >> 27)) * 0x94d049bb133111ebu;
    return z ^ (z >> 31);
}

static inline uint32_t random_below(uint64_t* state, uint32_t count) { return (uint32_t)(random_next(state) % count); }

/* In [min, max). */
static inline float random_float(uint64_t* state, float min, float max) {
    return min + (max - min) * (float)((double)(random_next(state) >> 40) * 0x1p-24);
}

#endif
