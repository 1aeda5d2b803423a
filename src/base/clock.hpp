// The clock for the times in Profile.
#pragma once

#include <chrono>
#include <cstdint>

namespace vox {

inline std::uint64_t nanoseconds() noexcept {
    const auto now = std::chrono::steady_clock::now().time_since_epoch();
    return static_cast<std::uint64_t>(std::chrono::duration_cast<std::chrono::nanoseconds>(now).count());
}

} // namespace vox
