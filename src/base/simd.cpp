#include "base/simd.hpp"

#include <algorithm>
#include <atomic>

namespace vox::simd {

namespace {

Level detect() noexcept {
#if (defined(__x86_64__) || defined(_M_X64)) && defined(__GNUC__)
    __builtin_cpu_init();
    // The features that Highway enables for each target (hwy/ops/set_macros-inl.h). The builtin also checks
    // that the operating system saves the wider registers.
    if (!__builtin_cpu_supports("ssse3") || !__builtin_cpu_supports("sse4.1") ||
        !__builtin_cpu_supports("sse4.2"))
        return Level::portable;
    if (!__builtin_cpu_supports("avx2") || !__builtin_cpu_supports("bmi") ||
        !__builtin_cpu_supports("bmi2") || !__builtin_cpu_supports("fma"))
        return Level::sse4;
    if (!__builtin_cpu_supports("avx512f") || !__builtin_cpu_supports("avx512vl") ||
        !__builtin_cpu_supports("avx512dq") || !__builtin_cpu_supports("avx512bw"))
        return Level::avx2;
    return Level::avx512;
#else
    return Level::portable;
#endif
}

std::atomic<int> forced{-1};

} // namespace

Level best_level() noexcept {
    static const Level best = detect();
    return best;
}

Level level() noexcept {
    const int wanted = forced.load(std::memory_order_relaxed);
    return wanted < 0 ? best_level() : static_cast<Level>(wanted);
}

Level force_level(Level wanted) noexcept {
    const int best = static_cast<int>(best_level());
    forced.store(std::min(best, static_cast<int>(wanted)), std::memory_order_relaxed);
    return level();
}

const char* level_name(Level level) noexcept {
    switch (level) {
    case Level::sse4:
        return "SSE4";
    case Level::avx2:
        return "AVX2";
    case Level::avx512:
        return "AVX-512";
    case Level::portable:
        break;
    }
    return "portable";
}

} // namespace vox::simd
