// Which instructions the library takes a machine to have.
#include "base/error.hpp"
#include "base/simd.hpp"
#include "support/suite.h"

using namespace vox::simd;

namespace {

START_TEST(levels_of_processors) {
    constexpr Processor nehalem{0x0098e3bd, 0, 0}, haswell{0x7ffafbbf, 0x000037ab, 0x07},
        skylake_server{0x7ffefbff, 0xd39ffffb, 0xe7}, zen_4{0x7efa320b, 0xf1bf97a9, 0x2e7};
    const auto check = [](Processor p, Level level) { ck_assert_int_eq(int(level_of(p)), int(level)); };
    const auto without_1 = [&](Processor p, std::uint32_t bits, Level level) {
        p.leaf_1_ecx &= ~bits;
        check(p, level);
    };
    const auto without_7 = [&](Processor p, std::uint32_t bits, Level level) {
        p.leaf_7_ebx &= ~bits;
        check(p, level);
    };
    check({}, Level::portable);
    check({0x0000e3bd, 0, 0}, Level::portable); // a Core 2: SSSE3 and no more
    check(nehalem, Level::sse4);
    check(haswell, Level::avx2);
    check(skylake_server, Level::avx512);
    check(zen_4, Level::avx512);
    for (const std::uint32_t bit : {9u, 19u, 20u, 23u}) without_1(zen_4, 1u << bit, Level::portable);
    for (const std::uint32_t bit : {12u, 27u, 28u}) without_1(zen_4, 1u << bit, Level::sse4);
    for (const std::uint32_t bit : {3u, 5u, 8u}) without_7(zen_4, 1u << bit, Level::sse4);
    for (const std::uint32_t bit : {16u, 17u, 28u, 30u, 31u}) without_7(zen_4, 1u << bit, Level::avx2);
    // What the system does not save cannot be used.
    for (const std::uint64_t xcr0 : {0x01u, 0x02u, 0x03u, 0x05u, 0xe1u, 0xe3u, 0xe5u})
        check({zen_4.leaf_1_ecx, zen_4.leaf_7_ebx, xcr0}, Level::sse4);
    for (const std::uint64_t xcr0 : {0x07u, 0x27u, 0x47u, 0x87u, 0x67u, 0xa7u, 0xc7u})
        check({zen_4.leaf_1_ecx, zen_4.leaf_7_ebx, xcr0}, Level::avx2);
}
END_TEST

START_TEST(this_machine) {
#if defined(__x86_64__) && defined(__GNUC__)
    Level expected = Level::portable;
    if (__builtin_cpu_supports("sse4.2") && __builtin_cpu_supports("popcnt")) expected = Level::sse4;
    if (__builtin_cpu_supports("avx2") && __builtin_cpu_supports("bmi") && __builtin_cpu_supports("bmi2") &&
        __builtin_cpu_supports("fma"))
        expected = Level::avx2;
    if (expected == Level::avx2 && __builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512vl") &&
        __builtin_cpu_supports("avx512dq") && __builtin_cpu_supports("avx512bw") &&
        __builtin_cpu_supports("avx512cd"))
        expected = Level::avx512;
    ck_assert_str_eq(level_name(best_level()), level_name(expected));
#else
    ck_assert_int_eq(int(best_level()), int(Level::portable));
#endif
    ck_assert_int_eq(int(level()), int(best_level()));
    ck_assert_int_eq(int(force_level(Level::portable)), int(least_level));
    ck_assert_int_eq(int(force_level(Level::avx512)), int(best_level()));
}
END_TEST

#if defined(__x86_64__)
// A processor without SSE4.2 is refused in words, rather than by an illegal instruction.
START_TEST(older_processors) {
    require_instructions(Level::sse4);
    try {
        require_instructions(level_of({0x0000e3bd, 0, 0})); // a Core 2
        ck_abort_msg("a Core 2 is taken");
    } catch (const vox::Error& error) {
        ck_assert_int_eq(error.result(), VOX_ERROR_UNSUPPORTED);
        ck_assert_ptr_nonnull(strstr(error.what(), "SSE4.2"));
    }
}
END_TEST
#endif

} // namespace

SUITE(simd) {
    TCase* tests = add_case(suite, "levels");
    tcase_add_test(tests, levels_of_processors);
    tcase_add_test(tests, this_machine);
#if defined(__x86_64__)
    tcase_add_test(tests, older_processors);
#endif
}
