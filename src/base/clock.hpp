// The clock of the times in vox_profile, and that of a thread.
#pragma once

#include <chrono>
#include <cstdint>
#include <time.h>

namespace vox {

inline std::uint64_t nanoseconds() noexcept {
    const auto now = std::chrono::steady_clock::now().time_since_epoch();
    return static_cast<std::uint64_t>(std::chrono::duration_cast<std::chrono::nanoseconds>(now).count());
}

// Nanoseconds in which this thread had a processor; where the system does not count them, those that passed.
inline std::uint64_t thread_nanoseconds() noexcept {
#ifdef CLOCK_THREAD_CPUTIME_ID
    timespec now{};
    if (clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now) == 0)
        return static_cast<std::uint64_t>(now.tv_sec) * 1000000000u + static_cast<std::uint64_t>(now.tv_nsec);
#endif
    return nanoseconds();
}

} // namespace vox
