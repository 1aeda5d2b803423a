// The clock for the times in Profile.
#pragma once

#include <chrono>
#include <cstdint>

namespace vox {

inline std::uint64_t nanoseconds() noexcept {
    const auto now = std::chrono::steady_clock::now().time_since_epoch();
    return static_cast<std::uint64_t>(std::chrono::duration_cast<std::chrono::nanoseconds>(now).count());
}

// Adds the time from its construction to its end to a field of Profile.
class Timed {
public:
    explicit Timed(std::uint64_t& sum) noexcept : sum_(sum), start_(nanoseconds()) {}
    Timed(const Timed&) = delete;
    Timed& operator=(const Timed&) = delete;
    ~Timed() { sum_ += nanoseconds() - start_; }

private:
    std::uint64_t& sum_;
    const std::uint64_t start_;
};

} // namespace vox
