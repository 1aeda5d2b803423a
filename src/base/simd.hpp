// Portable SIMD: Highway's headers (https://github.com/google/highway) with a run-time dispatch of our own,
// so that the core links with the C++ runtime alone. A source file that uses it is compiled once per
// instruction set (hwy/foreach_target.h); VOX_SIMD_DISPATCH(function) picks the version for the machine at
// run time. Functions that are compiled per target have names in UpperCamelCase.
//
// Every target runs the same operations in the same order, without fused multiply-add, so that filters and
// counters give the same bits everywhere. Functions compiled per target work on plain arrays only. If one
// used a template of the standard library, the linker could merge that instance with the one in the rest of
// the program, which must run on any machine.
#pragma once

#include <array>
#include <cstdint>

// Targets better than AVX3, or than NEON, have lower bits. Newer versions of Highway have more of them, for
// instructions that are of no use here, or for vectors of unknown length.
#if defined(__x86_64__) || defined(_M_X64)
// Every x86-64 since 2011 has SSE4.2. Older ones are refused (require_instructions): Highway's emulation for
// them would take gcc longer to compile than all other targets together.
#if !defined(__SSE4_2__) && !defined(__AVX__)
#define HWY_BASELINE_TARGETS HWY_SSE4
#endif
#if defined(__MINGW32__) && !defined(__clang__) && !defined(VOX_UNALIGNED_MOVES)
// gcc for Windows aligns the stack to 16 bytes only, and AVX may crash (gcc bug 54412), unless the assembler
// helps (cmake/vox_target.cmake).
#define HWY_DISABLED_TARGETS (HWY_EMU128 | HWY_SSSE3 | HWY_AVX2 | HWY_AVX3 | (HWY_AVX3 - 1))
#else
#define HWY_DISABLED_TARGETS (HWY_EMU128 | HWY_SSSE3 | (HWY_AVX3 - 1))
#endif
#else
#if defined(__aarch64__)
#define HWY_DISABLED_TARGETS (HWY_NEON - 1)
#endif
#if !defined(HWY_COMPILE_ONLY_STATIC)
#define HWY_COMPILE_ONLY_STATIC // nothing is chosen at run time
#endif
#endif
#define HWY_DISABLE_PCLMUL_AES
#define HWY_DISABLE_F16C
// Where there are no registers of 128 bits, Highway emulates them. It does not for gcc < 12.3, which
// miscompiles products of 16-bit integers (gcc bug 106322). There are none here.
#define HWY_BROKEN_EMU128 0
#define HWY_IS_DEBUG_BUILD 0 // its assertions would need Highway's library

#include <hwy/base.h>

namespace vox::simd {

// `portable`: Highway's code for a machine that is not an x86.
enum class Level : int { portable = 0, sse4 = 1, avx2 = 2, avx512 = 3 };

#if defined(__x86_64__) || defined(_M_X64)
inline constexpr Level least_level = Level::sse4;
#else
inline constexpr Level least_level = Level::portable;
#endif

// The best level of this machine, or the one forced.
Level level() noexcept;

// For tests and measurements. Forces `wanted`, or the nearest level that this machine has, and returns the
// level in force.
Level force_level(Level wanted) noexcept;
Level best_level() noexcept;

// What cpuid (in leaf 7: subleaf 0) and xgetbv return on an x86; all 0 on other machines. For tests.
struct Processor {
    std::uint32_t leaf_1_ecx = 0, leaf_7_ebx = 0;
    std::uint64_t xcr0 = 0;
};
Level level_of(const Processor& processor) noexcept;

// Throws UNSUPPORTED on an x86 without the instructions of the least level. Functions that create objects
// call it.
void require_instructions(Level best = best_level());

// A name for messages, such as "AVX2".
const char* level_name(Level level) noexcept;

template <class Function>
Function* choose(const std::array<Function*, 4>& versions) noexcept {
    int i = static_cast<int>(level());
    while (i > static_cast<int>(least_level) && !versions[static_cast<std::size_t>(i)]) --i;
    return versions[static_cast<std::size_t>(i)];
}

} // namespace vox::simd

// For code after the last target (#if HWY_ONCE).
#define VOX_SIMD_DISPATCH(function)                                                                          \
    ::vox::simd::choose<decltype(HWY_STATIC_DISPATCH(function))>({VOX_SIMD_VERSIONS(function)})

#if defined(__x86_64__) || defined(_M_X64)
#define VOX_SIMD_VERSIONS(function)                                                                          \
    nullptr, HWY_CHOOSE_SSE4(function), HWY_CHOOSE_AVX2(function), HWY_CHOOSE_AVX3(function)
#else
#define VOX_SIMD_VERSIONS(function) &HWY_STATIC_DISPATCH(function), nullptr, nullptr, nullptr
#endif
