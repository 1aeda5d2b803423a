// Seconds of a piece of work on one core.
#pragma once

#include <algorithm>
#include <chrono>

#if defined(__unix__)
#include <ctime>
#endif

namespace bench {

// Wall-clock time, less what other processes took of the core: where the process's own processor time is the
// smaller one, somebody else ran meanwhile.
template <class Work>
double seconds_of(const Work& work) {
    using Clock = std::chrono::steady_clock;
    using Seconds = std::chrono::duration<double>;
#if defined(__unix__)
    const auto cpu_now = [] {
        timespec t;
        clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &t);
        return static_cast<double>(t.tv_sec) + 1e-9 * static_cast<double>(t.tv_nsec);
    };
    const double cpu_start = cpu_now();
#endif
    const Clock::time_point start = Clock::now();
    work();
    double seconds = Seconds(Clock::now() - start).count();
#if defined(__unix__)
    seconds = std::min(seconds, cpu_now() - cpu_start);
#endif
    return seconds;
}

} // namespace bench
