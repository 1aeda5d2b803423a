// What the kernels compute by themselves, against integers: signs of volumes, weights.
#include "exact/float_weights.hpp"
#include "exact/predicates.hpp"
#include "exact/volume_sign.hpp"
#include "gpu/kernels/look_up.hpp"

#include "scenes/random.h"
#include "support/suite.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <string.h>

using namespace vox;

namespace {

double random_in(std::uint64_t& seed, double low, double high) {
    return low + (high - low) * 0.5 * (random_symmetric(&seed) + 1);
}

// Of like size, of any size, on a small lattice, or zero.
double random_coordinate(std::uint64_t& seed, int kind) {
    const double mantissa = random_symmetric(&seed);
    switch (kind) {
    case 0:
        return mantissa;
    case 1:
        return std::ldexp(mantissa, static_cast<int>(random_in(seed, -1074, 127)));
    case 2:
        return std::ldexp(std::floor(4 * mantissa), static_cast<int>(random_in(seed, -149, 100)));
    case 3:
        return std::floor(3 * mantissa);
    default:
        return static_cast<double>(
            static_cast<float>(std::ldexp(mantissa, static_cast<int>(random_in(seed, -149, 127)))));
    }
}

void check_signs(const std::array<Vec3d, 4>& p) {
    const int expected = exact_orientation(p[0], p[1], p[2], p[3]);
    const auto at = [&p](int i) { return p[static_cast<std::size_t>(i)]; };
    ck_assert_int_eq(sign_by_words(at), expected);
    ck_assert_int_eq(sign_of_volume(at), expected);
}

} // namespace

START_TEST(signs) {
    std::uint64_t seed = 11;
    int of[3] = {};
    for (std::uint64_t round = 0; round < 4000 * test_volume(); ++round) {
        const int kind = static_cast<int>(round % 6);
        std::array<Vec3d, 4> p;
        for (Vec3d& q : p)
            for (double* c : {&q.x, &q.y, &q.z})
                *c = random_coordinate(seed, kind < 5 ? kind : static_cast<int>(random_in(seed, 0, 5)));
        check_signs(p);
        p[3] = Vec3d{(p[0].x + p[1].x) / 2, (p[0].y + p[1].y) / 2,
                     (p[0].z + p[1].z) / 2}; // nearly flat, or flat
        check_signs(p);
        ++of[exact_orientation(p[0], p[1], p[2], p[3]) + 1];
        p[2] = p[0];
        check_signs(p);
    }
    ck_assert_msg(of[0] > 0 && of[1] > 0 && of[2] > 0, "%d %d %d", of[0], of[1], of[2]);
}
END_TEST

START_TEST(weights) {
    std::uint64_t seed = 12;
    std::uint64_t in_doubles = 0, rough = 0, count = 0;
    for (std::uint64_t round = 0; round < 20000 * test_volume(); ++round) {
        const bool on_lattice = round % 4 == 1, far = round % 4 == 2, thin = round % 4 == 3;
        std::array<Vec3d, 5> p;
        for (Vec3d& q : p)
            for (double* c : {&q.x, &q.y, &q.z}) {
                *c = on_lattice ? std::floor(4 * random_symmetric(&seed)) : random_symmetric(&seed);
                if (far) *c += 1000;
                *c = static_cast<double>(static_cast<float>(*c));
            }
        if (thin)
            p[3].z = static_cast<double>(static_cast<float>(p[3].z * 1e-6)), p[1].z = p[2].z = p[0].z = 0;
        std::uint64_t exact_tests = 0;
        const Containment where = locate(p[4], p[0], p[1], p[2], p[3], exact_tests);
        if (where != Containment::interior && where != Containment::boundary) {
            // As likely as not in it.
            for (double* c : {&p[4].x, &p[4].y, &p[4].z}) *c = 0;
            for (std::size_t k = 0; k < 4; ++k) p[4] = p[4] + 0.25 * p[k];
            p[4] = Vec3d(nearest_floats(p[4]));
            const Containment again = locate(p[4], p[0], p[1], p[2], p[3], exact_tests);
            if (again != Containment::interior && again != Containment::boundary) continue;
        }
        const auto corner = [&p](int i) { return p[static_cast<std::size_t>(i)]; };
        float found[4], quick[4];
        ++count;
        if (!weigh_as_floats(p[4], corner, found)) {
            ++rough;
            continue;
        }
        in_doubles += weigh_in_doubles(corner_volumes(p[4], p[0], p[1], p[2], p[3]), quick);
        const std::array<double, 4> expected = exact_weights(p[4], p[0], p[1], p[2], p[3]);
        for (std::size_t k = 0; k < 4; ++k)
            ck_assert_msg(found[k] == static_cast<float>(expected[k]), "weight %zu is %a, expected %a", k,
                          double{found[k]}, expected[k]);
    }
    ck_assert_msg(count > 5000 && in_doubles > count / 4 && in_doubles < count,
                  "%llu of %llu weighed in doubles", static_cast<unsigned long long>(in_doubles),
                  static_cast<unsigned long long>(count));
    ck_assert_uint_eq(rough, 0);
    // So flat that doubles of twice the digits do not suffice: told, and close nevertheless.
    const Vec3d flat[4] = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0.25, 0.25, 0x1p-130}};
    float found[4];
    ck_assert(!weigh_as_floats(
                  flat[3], [&flat](int i) { return flat[i]; }, found) ||
              found[3] == 1);
}
END_TEST

// Single precision says nothing that is not so, where its products underflow or overflow, too.
START_TEST(separation) {
    std::uint64_t seed = 13;
    std::uint64_t of[3] = {};
    for (int power = -148; power <= 126; power += std::abs(power + 43) < 12 ? 1 : 16)
        for (std::uint64_t round = 0; round < 300 * test_volume(); ++round) {
            float v[4][3], p[3];
            gpu::FloatBox box;
            std::array<Vec3d, 5> q;
            for (int a = 0; a < 3; ++a) {
                for (int k = 0; k < 4; ++k)
                    v[k][a] = static_cast<float>(std::ldexp(random_symmetric(&seed), power));
                p[a] = static_cast<float>(std::ldexp(random_symmetric(&seed), power));
                if (round % 3 == 0) p[a] = 0.5f * (v[0][a] + v[1][a]); // nearly on an edge
                if (round % 3 == 1) p[a] = 0.25f * (v[0][a] + v[1][a]) + 0.25f * (v[2][a] + v[3][a]);
                box.lo[a] = std::min({v[0][a], v[1][a], v[2][a], v[3][a]});
                box.hi[a] = std::max({v[0][a], v[1][a], v[2][a], v[3][a]});
                p[a] = std::min(std::max(p[a], box.lo[a]), box.hi[a]);
            }
            for (std::size_t k = 0; k < 5; ++k) {
                const float* c = k < 4 ? v[k] : p;
                q[k] = Vec3d{double{c[0]}, double{c[1]}, double{c[2]}};
            }
            const gpu::Separation says = gpu::separate(v, p, gpu::underflow_bound(box));
            ++of[static_cast<int>(says)];
            std::uint64_t exact_tests = 0;
            const Containment where = locate(q[4], q[0], q[1], q[2], q[3], exact_tests);
            ck_assert_msg(says != gpu::Separation::apart || where == Containment::outside,
                          "2^%d: is not outside", power);
            ck_assert_msg(says != gpu::Separation::inside || where == Containment::interior,
                          "2^%d: is not inside", power);
        }
    ck_assert_msg(of[0] > 1000 && of[1] > 1000 && of[2] > 1000, "%llu apart, %llu open, %llu inside",
                  static_cast<unsigned long long>(of[0]), static_cast<unsigned long long>(of[1]),
                  static_cast<unsigned long long>(of[2]));
}
END_TEST

SUITE(gpu_exact) {
    TCase* tests = add_case(suite, "against integers");
    tcase_add_each(tests, separation, signs, weights);
}
