// Tests the arithmetic of the reference engine's grid, from positions to cells and from cells to buckets.
#include "internal/random.hpp"
#include "reference/cell_lists.hpp"
#include "support/suite.h"

using namespace vox;

namespace {

START_TEST(modulus_is_the_remainder) {
    Random random{18};
    for (const std::uint32_t divisor : {1u, 2u, 3u, 7u, 101u, 65537u, 2147483647u, 4294967291u}) {
        const Modulus modulus(divisor);
        for (const std::uint32_t number : {0u, 1u, divisor - 1, divisor, 0xffffffffu})
            ck_assert_uint_eq(modulus(number), number % divisor);
        for (int i = 0; i < 100000; ++i) {
            const auto number = static_cast<std::uint32_t>(random.next());
            ck_assert_uint_eq(modulus(number), number % divisor);
        }
    }
}
END_TEST

START_TEST(primes) {
    const std::uint32_t expected[] = {2, 2, 2, 3, 5, 5, 7, 7, 11, 11, 11, 11, 13};
    for (std::uint32_t n = 0; n < 13; ++n) ck_assert_uint_eq(next_prime(n), expected[n]);
    ck_assert_uint_eq(next_prime(7920), 7927);
    ck_assert_uint_eq(next_prime(2147483647), 2147483647);
    ck_assert_uint_eq(next_prime(std::uint64_t(1) << 40), 4294967291u);
}
END_TEST

START_TEST(cells_are_floors_and_monotone) {
    constexpr std::int32_t far = 1 << 30;
    const Lattice lattice({0, 0, 0}, 0.5, {-far, -far, -far}, {far, far, far});
    ck_assert(lattice.cell_of({0.25f, -0.25f, 0.5f}) == (CellCoord{0, -1, 1}));
    ck_assert(lattice.cell_of({-0.0f, -0.5f, -0.75f}) == (CellCoord{0, -1, -2}));
    ck_assert(lattice.cell_of({1e30f, -1e30f, -1e-45f}) == (CellCoord{far, -far, -1}));
    Random random{19};
    for (const double cell_size : {1e-320, 1e-300, 1e-10, 0.3, 1e10, 1e300, 1.7e308}) {
        const Lattice any({0, random.unit(), -1e6}, cell_size, {-far, -far, 0}, {far, far, 5});
        for (int i = 0; i < 100000; ++i) {
            const float a = random.any_finite(), b = random.any_finite();
            const CellCoord low = any.cell_of({std::min(a, b), std::min(a, b), std::min(a, b)});
            const CellCoord high = any.cell_of({std::max(a, b), std::max(a, b), std::max(a, b)});
            ck_assert(low.i <= high.i && low.j <= high.j && low.k <= high.k);
            ck_assert(low.i >= -far && high.i <= far && low.k >= 0 && high.k <= 5);
        }
    }
}
END_TEST

START_TEST(paper_hash_is_teschners) {
    constexpr std::uint32_t prime = 100003;
    const PaperAddress address{Modulus(prime)};
    for (const CellCoord& at :
         {CellCoord{0, 0, 0}, CellCoord{1, 2, 3}, CellCoord{-1, 5, -7}, CellCoord{1 << 30, -9, 2}}) {
        const std::int64_t full = std::int64_t(at.i) * 73856093 ^ std::int64_t(at.j) * 19349663 ^
                                  std::int64_t(at.k) * 83492791; // its lower 32 bits are the wrapped hash
        ck_assert_uint_eq(address.bucket(address.row(at.j, at.k), at.i),
                          static_cast<std::uint32_t>(full) % prime);
    }
}
END_TEST

} // namespace

SUITE(reference_grid) {
    TCase* tests = add_case(suite, "arithmetic");
    for (const TTest* test :
         {modulus_is_the_remainder, primes, cells_are_floors_and_monotone, paper_hash_is_teschners})
        tcase_add_test(tests, test);
}
