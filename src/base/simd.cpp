#include "base/simd.hpp"
#include "base/error.hpp"

#include <algorithm>
#include <atomic>

// Not by _M_X64 alone, which MinGW's headers define, too. clang for MSVC compiles what gcc does.
#if defined(_M_X64) && defined(_MSC_VER) && !defined(__clang__)
#define VOX_MSVC_X64 1
#include <intrin.h>
#elif defined(__x86_64__)
#include <cpuid.h>
#endif

namespace vox::simd {

namespace {

// Bits in ecx of cpuid's leaf 1.
constexpr std::uint32_t ssse3 = 1u << 9, fma = 1u << 12, sse4_1 = 1u << 19, sse4_2 = 1u << 20,
                        popcnt = 1u << 23, osxsave = 1u << 27, avx = 1u << 28;
// Bits in ebx of leaf 7.
constexpr std::uint32_t bmi = 1u << 3, avx2 = 1u << 5, bmi2 = 1u << 8, avx512f = 1u << 16,
                        avx512dq = 1u << 17, avx512cd = 1u << 28, avx512bw = 1u << 30, avx512vl = 1u << 31;
// Bits in XCR0: registers of 16 and 32 bytes; masks, registers of 64 bytes and the second 16 registers.
constexpr std::uint64_t avx_state = 0x06, avx512_state = 0xe6;

#if defined(VOX_MSVC_X64)

Processor this_processor() noexcept {
    Processor p;
    int r[4]; // eax, ebx, ecx, edx
    __cpuid(r, 0);
    const int leaves = r[0];
    __cpuid(r, 1);
    p.leaf_1_ecx = static_cast<std::uint32_t>(r[2]);
    if (leaves >= 7) {
        __cpuidex(r, 7, 0);
        p.leaf_7_ebx = static_cast<std::uint32_t>(r[1]);
    }
    if (p.leaf_1_ecx & osxsave) p.xcr0 = _xgetbv(0);
    return p;
}

#elif defined(__x86_64__)

// Not __builtin_cpu_supports, which needs a part of libgcc or compiler-rt that not every tool chain links.
Processor this_processor() noexcept {
    Processor p;
    std::uint32_t eax = 0, ebx = 0, ecx = 0, edx = 0;
    if (__get_cpuid(1, &eax, &ebx, &ecx, &edx)) p.leaf_1_ecx = ecx;
    if (__get_cpuid_count(7, 0, &eax, &ebx, &ecx, &edx)) p.leaf_7_ebx = ebx;
    if (p.leaf_1_ecx & osxsave) {
        asm volatile("xgetbv" : "=a"(eax), "=d"(edx) : "c"(0));
        p.xcr0 = std::uint64_t{edx} << 32 | eax;
    }
    return p;
}

#else

Processor this_processor() noexcept { return {}; }

#endif

std::atomic<int> forced{-1};

} // namespace

// The features that Highway enables for each target (hwy/ops/set_macros-inl.h), and popcnt, which compilers
// take to come with SSE4.2. Intel, Software Developer's Manual, vol. 1, 14.3 and 15.2: the system must save
// the registers, too.
Level level_of(const Processor& p) noexcept {
    const auto has_1 = [&](std::uint32_t features) { return (p.leaf_1_ecx & features) == features; };
    const auto has_7 = [&](std::uint32_t features) { return (p.leaf_7_ebx & features) == features; };
    const auto saves = [&](std::uint64_t state) { return has_1(osxsave) && (p.xcr0 & state) == state; };
    if (!has_1(ssse3 | sse4_1 | sse4_2 | popcnt)) return Level::portable;
    if (!has_1(avx | fma) || !has_7(avx2 | bmi | bmi2) || !saves(avx_state)) return Level::sse4;
    if (!has_7(avx512f | avx512vl | avx512dq | avx512bw | avx512cd) || !saves(avx512_state))
        return Level::avx2;
    return Level::avx512;
}

Level best_level() noexcept {
    static const Level best = level_of(this_processor());
    return best;
}

Level level() noexcept {
    const int wanted = forced.load(std::memory_order_relaxed);
    return wanted < 0 ? best_level() : static_cast<Level>(wanted);
}

Level force_level(Level wanted) noexcept {
    forced.store(static_cast<int>(std::min(std::max(wanted, least_level), best_level())),
                 std::memory_order_relaxed);
    return level();
}

void require_instructions(Level best) {
    if (best < least_level)
        throw Error(VOX_ERROR_UNSUPPORTED, "this processor lacks SSE4.2 or POPCNT, which vox needs");
}

const char* level_name(Level level) noexcept {
    constexpr const char* names[] = {"portable", "SSE4", "AVX2", "AVX-512"};
    return names[static_cast<int>(level)];
}

} // namespace vox::simd
