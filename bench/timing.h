/* What the benchmarks in C and C++ share: the clock; for C++ medians, for C the end of a run that failed. */
#ifndef VOX_BENCH_TIMING_H
#define VOX_BENCH_TIMING_H

#include <time.h>

/* Seconds of processor time of this process. */
static inline double now(void) {
#if defined(__unix__)
    struct timespec t;
    clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &t);
    return (double)t.tv_sec + 1e-9 * (double)t.tv_nsec;
#else
    return (double)clock() / CLOCKS_PER_SEC;
#endif
}

#ifdef __cplusplus

#include <algorithm>
#include <chrono>
#include <cstddef>
#include <vector>

/* Seconds of a piece of work on one core: wall-clock time, less what other processes took of the core. Where
 * the processor time is the smaller one, another process ran meanwhile. */
template <class Work>
double seconds_of(const Work& work) {
    using Clock = std::chrono::steady_clock;
    const double processor_start = now();
    const Clock::time_point start = Clock::now();
    work();
    const double seconds = std::chrono::duration<double>(Clock::now() - start).count();
    return std::min(seconds, now() - processor_start);
}

inline double median(std::vector<double> values) {
    std::sort(values.begin(), values.end());
    const std::size_t n = values.size();
    return n == 0 ? 0 : (values[(n - 1) / 2] + values[n / 2]) / 2;
}

#else

#include <stdio.h>
#include <stdlib.h>
#include <vox/vox.h>

/* Ends a program in C when a call fails; those in C++ have program.hpp. */
static inline void check(vox_result result) {
    if (result == VOX_OK) return;
    fprintf(stderr, "%s\n", vox_last_error());
    exit(EXIT_FAILURE);
}

#endif

#endif
